"""Plug-ins > Voxelastica: CAE finds this file by its name in a folder of abaqus_plugins and runs it at start.

The form is sent to the kernel as one call of voxelastica_cae.dialogs; the kernel does all the work. Two more buttons ask
by the kernel's own boxes and need no form.
"""

import inspect
import os

from abaqusConstants import ALL
from abaqusGui import (
    AFXSELECTFILE_ANY,
    FXMAPFUNC,
    AFXBoolKeyword,
    AFXComboBox,
    AFXDataDialog,
    AFXFileSelectorDialog,
    AFXForm,
    AFXGuiCommand,
    AFXIntKeyword,
    AFXIntTarget,
    AFXMode,
    AFXStringKeyword,
    AFXTextField,
    AFXVerticalAligner,
    FXButton,
    FXHorizontalFrame,
    FXObject,
    getAFXApp,
)
from abaqusGui import SEL_COMMAND  # pyright: ignore[reportAttributeAccessIssue]  the stubs forgot it

_FOLDER = os.path.dirname(os.path.abspath(inspect.getfile(inspect.currentframe())))  # type: ignore[arg-type]
_INIT = "import sys; sys.path.insert(0, %r); import voxelastica_cae.dialogs" % _FOLDER
_KERNEL = "voxelastica_cae.dialogs"
_VERSION, _AUTHOR = "0.1.0", "Voxelastica"
_KINDS = ("auto", "geometry", "mesh", "shell")


class Chooser(FXObject):
    """Lets the user pick a file for a form's keyword."""

    def __init__(self, keyword, patterns):
        self.keyword, self.patterns = keyword, patterns
        self.pattern = AFXIntTarget(0)
        self.read_only = AFXBoolKeyword(None, "readOnly", AFXBoolKeyword.TRUE_FALSE)  # pyright: ignore[reportArgumentType]
        FXObject.__init__(self)
        FXMAPFUNC(self, SEL_COMMAND, AFXMode.ID_ACTIVATE, Chooser.choose)

    def choose(self, sender, selector, data):
        """Opens CAE's file dialog; what is picked goes into the keyword."""
        window = getAFXApp().getAFXMainWindow()
        dialog = AFXFileSelectorDialog(
            window,
            "Voxelastica: choose a file",
            self.keyword,
            self.read_only,
            AFXSELECTFILE_ANY,
            self.patterns,
            self.pattern,
        )
        dialog.create()
        dialog.showModal()
        return 1


def file_field(fields, label, keyword, patterns):
    """A text field for a path with a button that opens a file dialog; returns what must outlive the dialog."""
    line = FXHorizontalFrame(fields)
    AFXTextField(line, 50, label, keyword)
    chooser = Chooser(keyword, patterns)
    FXButton(line, "Choose...", None, chooser, AFXMode.ID_ACTIVATE)
    return chooser


class BuildForm(AFXForm):
    """The form that builds a model: its keywords are the arguments of dialogs.build_model."""

    def __init__(self, owner):
        AFXForm.__init__(self, owner)
        self.command = AFXGuiCommand(self, "build_model", _KERNEL, False)
        self.design = AFXStringKeyword(self.command, "design", True, "")
        self.kind = AFXStringKeyword(self.command, "kind", True, "auto")
        self.model = AFXStringKeyword(self.command, "model", True, "")
        self.cores = AFXIntKeyword(self.command, "cores", True, 1)
        self.memory = AFXIntKeyword(self.command, "memory", True, 90)

    def getFirstDialog(self):  # pyright: ignore[reportIncompatibleMethodOverride]
        """The form's dialog."""
        return BuildDialog(self)


class BuildDialog(AFXDataDialog):
    """Fields of the form."""

    def __init__(self, form):
        window = getAFXApp().getAFXMainWindow()
        AFXDataDialog.__init__(self, form, window, "Voxelastica: build a model", self.OK | self.CANCEL)
        fields = AFXVerticalAligner(self)
        self.chooser = file_field(fields, "Design (design.json):", form.design, "Designs (*.json)\nAll files (*)")
        kinds = AFXComboBox(fields, 12, len(_KINDS), "Kind:", form.kind)
        for kind in _KINDS:
            kinds.appendItem(kind)
        AFXTextField(fields, 30, "Model (empty: the design's name):", form.model)
        AFXTextField(fields, 8, "Cores:", form.cores)
        AFXTextField(fields, 8, "Memory, percent:", form.memory)


class ExtractForm(AFXForm):
    """The form that extracts results: its keywords are the arguments of dialogs.extract_results."""

    def __init__(self, owner):
        AFXForm.__init__(self, owner)
        self.command = AFXGuiCommand(self, "extract_results", _KERNEL, False)
        self.odb = AFXStringKeyword(self.command, "odb", True, "")
        self.design = AFXStringKeyword(self.command, "design", True, "")
        self.folder = AFXStringKeyword(self.command, "folder", True, "")
        self.spoke = AFXIntKeyword(self.command, "spoke", True, 1)

    def getFirstDialog(self):  # pyright: ignore[reportIncompatibleMethodOverride]
        """The form's dialog."""
        return ExtractDialog(self)


class ExtractDialog(AFXDataDialog):
    """Fields of the form."""

    def __init__(self, form):
        window = getAFXApp().getAFXMainWindow()
        AFXDataDialog.__init__(self, form, window, "Voxelastica: extract results", self.OK | self.CANCEL)
        fields = AFXVerticalAligner(self)
        self.choosers = (
            file_field(fields, "Output database:", form.odb, "Output databases (*.odb)"),
            file_field(fields, "Design (may be empty):", form.design, "Designs (*.json)\nAll files (*)"),
        )
        AFXTextField(fields, 60, "Folder (empty: the database's):", form.folder)
        AFXTextField(fields, 8, "Spoke:", form.spoke)


toolset = getAFXApp().getAFXMainWindow().getPluginToolset()
toolset.registerGuiMenuButton(
    object=BuildForm(toolset),  # pyright: ignore[reportArgumentType]  a toolset is such an owner
    buttonText="Voxelastica|Build model...",
    kernelInitString=_INIT,
    description="Builds a model from a design.json: strip as geometry or mesh, or the flower of shells.",
    applicableModules=ALL,
    version=_VERSION,
    author=_AUTHOR,
)
toolset.registerGuiMenuButton(
    object=ExtractForm(toolset),  # pyright: ignore[reportArgumentType]  a toolset is such an owner
    buttonText="Voxelastica|Extract results...",
    kernelInitString=_INIT,
    description="Writes the morphed mid-line and the reactions of a job for voxelastica compare.",
    applicableModules=ALL,
    version=_VERSION,
    author=_AUTHOR,
)
toolset.registerKernelMenuButton(
    moduleName=_KERNEL,
    functionName="ask_build()",
    buttonText="Voxelastica|Build model (simple boxes)",
    applicableModules=ALL,
    version=_VERSION,
    author=_AUTHOR,
)
toolset.registerKernelMenuButton(
    moduleName=_KERNEL,
    functionName="ask_extract()",
    buttonText="Voxelastica|Extract results (simple boxes)",
    applicableModules=ALL,
    version=_VERSION,
    author=_AUTHOR,
)
