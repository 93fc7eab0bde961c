# SPDX-License-Identifier: MIT OR Apache-2.0
"""The task panel: which design, which parts, which files; and solving the analysis."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import FreeCAD as App
import FreeCADGui as Gui
from PySide import QtCore, QtGui

from . import core
from .library import PREFERENCES
from .settings import BANDS, EXPORTS, MODELS, PARTS, PHASES, MacroError, Settings

_PART_LABELS = {
    "flat": "Flat flower",
    "morphed": "Morphed shell",
    "phases": "Phases of a spoke",
    "analysis": "FEM analysis",
}
_EXPORT_LABELS = {"fcstd": "FCStd", "step": "STEP", "stl": "STL"}


def _preferences() -> Any:
    return App.ParamGet(PREFERENCES)


class Panel:
    """The panel that FreeCAD shows; :attr:`form` is its widget, Close its only standard button."""

    def __init__(self) -> None:
        self._built: core.Built | None = None
        self.form = QtGui.QWidget()
        self.form.setWindowTitle("Voxelastica")
        icon = Path(__file__).resolve().parent.parent / "icon.svg"
        if icon.is_file():
            self.form.setWindowIcon(QtGui.QIcon(str(icon)))
        layout = QtGui.QVBoxLayout(self.form)
        # The task view otherwise squeezes what is in the boxes once there is a message.
        layout.setSizeConstraint(QtGui.QLayout.SetMinimumSize)
        self._design = self._path(layout, "Design file, design.json or its folder", "Design", self._choose_design)
        layout.addWidget(self._parts_box())
        layout.addWidget(self._analysis_box())
        layout.addWidget(self._files_box())
        self._new_document = QtGui.QCheckBox("Into a new document")
        self._new_document.setChecked(True)
        self._replace = QtGui.QCheckBox("Replace an earlier tree")
        layout.addWidget(self._new_document)
        layout.addWidget(self._replace)
        row = QtGui.QHBoxLayout()
        self._build = QtGui.QPushButton("Build")
        self._build.setDefault(True)
        self._build.clicked.connect(self.build)
        self._solve = QtGui.QPushButton("Solve")
        self._solve.setEnabled(False)
        self._solve.setToolTip("Runs CalculiX on the project's deck with the materials of the document")
        self._solve.clicked.connect(self.solve)
        row.addWidget(self._build)
        row.addWidget(self._solve)
        layout.addLayout(row)
        self._message = QtGui.QLabel("")
        self._message.setWordWrap(True)
        self._message.setTextInteractionFlags(QtCore.Qt.TextSelectableByMouse)
        layout.addWidget(self._message)
        layout.addStretch(1)

    # Parts of the form.

    def _path(self, layout: Any, hint: str, key: str, choose: Any) -> Any:
        row = QtGui.QHBoxLayout()
        line = QtGui.QLineEdit(_preferences().GetString(key, ""))
        line.setPlaceholderText(hint)
        line.setObjectName(key)
        button = QtGui.QPushButton("...")
        button.setMaximumWidth(32)
        button.clicked.connect(choose)
        row.addWidget(line)
        row.addWidget(button)
        layout.addLayout(row)
        return line

    def _parts_box(self) -> Any:
        box = QtGui.QGroupBox("Build")
        form = QtGui.QFormLayout(box)
        self._parts = {}
        for part in PARTS:
            self._parts[part] = QtGui.QCheckBox(_PART_LABELS[part])
            self._parts[part].setChecked(True)
            form.addRow(self._parts[part])
        self._fraction = QtGui.QDoubleSpinBox()
        self._fraction.setRange(0.0, 1.0)
        self._fraction.setSingleStep(0.1)
        self._fraction.setValue(1.0)
        self._fraction.setToolTip("Fraction of the morph: 0 flat, 1 closed")
        form.addRow("Morphed by", self._fraction)
        self._phases = QtGui.QComboBox()
        self._phases.addItems(list(PHASES))
        form.addRow("Phases as", self._phases)
        box.setSizePolicy(QtGui.QSizePolicy.Preferred, QtGui.QSizePolicy.Fixed)
        return box

    def _analysis_box(self) -> Any:
        box = QtGui.QGroupBox("Analysis")
        form = QtGui.QFormLayout(box)
        self._model = QtGui.QComboBox()
        self._model.addItems(list(MODELS))
        form.addRow("Strip", self._model)
        self._bands = QtGui.QSpinBox()
        self._bands.setRange(0, 200)
        self._bands.setValue(BANDS)
        self._bands.setSpecialValueText("nodal field")
        form.addRow("Modulus bands", self._bands)
        box.setSizePolicy(QtGui.QSizePolicy.Preferred, QtGui.QSizePolicy.Fixed)
        return box

    def _files_box(self) -> Any:
        box = QtGui.QGroupBox("Files")
        layout = QtGui.QVBoxLayout(box)
        self._folder = self._path(layout, "Folder for files and the solver", "Folder", self._choose_folder)
        row = QtGui.QHBoxLayout()
        self._exports = {}
        for kind in EXPORTS:
            self._exports[kind] = QtGui.QCheckBox(_EXPORT_LABELS[kind])
            row.addWidget(self._exports[kind])
        layout.addLayout(row)
        box.setSizePolicy(QtGui.QSizePolicy.Preferred, QtGui.QSizePolicy.Fixed)
        return box

    # What the buttons do.

    def _choose_design(self) -> None:
        kinds = "Designs (*.toml *.json);;All files (*)"
        name = QtGui.QFileDialog.getOpenFileName(self.form, "Design", self._design.text(), kinds)[0]
        if name:
            self._design.setText(name)

    def _choose_folder(self) -> None:
        name = QtGui.QFileDialog.getExistingDirectory(self.form, "Folder", self._folder.text())
        if name:
            self._folder.setText(name)

    def settings(self) -> Settings:
        """What the form says."""
        document = App.ActiveDocument
        return Settings(
            design=self._design.text().strip(),
            folder=self._folder.text().strip(),
            parts=tuple(part for part, box in self._parts.items() if box.isChecked()),
            fraction=self._fraction.value(),
            phases=self._phases.currentText(),
            model=self._model.currentText(),
            bands=self._bands.value(),
            export=tuple(kind for kind, box in self._exports.items() if box.isChecked()),
            document="" if self._new_document.isChecked() or document is None else document.Name,
            replace=self._replace.isChecked(),
        )

    def build(self) -> None:
        """Builds what the form says; errors go to the report view and below the buttons."""
        _preferences().SetString("Design", self._design.text().strip())
        _preferences().SetString("Folder", self._folder.text().strip())
        self._attempt(self._do_build)

    def _do_build(self) -> None:
        self._built = core.build(self.settings(), self._say)
        self._solve.setEnabled("analysis" in self._built.parts)
        self._tell(core.report(self._built))
        if view := Gui.ActiveDocument and Gui.ActiveDocument.ActiveView:
            view.viewIsometric()
            Gui.SendMsgToActiveView("ViewFit")

    def solve(self) -> None:
        """Solves the analysis that was built."""
        self._attempt(self._do_solve)

    def _do_solve(self) -> None:
        from . import export, solve

        place = self._folder.text().strip()
        if not place:
            raise MacroError("choose a folder for the solver's files")
        folder = export.require_writable(place) / "analysis"
        self._say("CalculiX is running")
        self._built.solution = solve.solve(self._built.parts["analysis"]["analysis"], str(folder))
        self._tell(core.report(self._built))

    def _attempt(self, action: Any) -> None:
        QtGui.QApplication.setOverrideCursor(QtCore.Qt.WaitCursor)
        try:
            action()
        except Exception as error:  # noqa: BLE001 - everything is told
            message, _ = core.explain(error)
            App.Console.PrintError(f"Voxelastica: {message}\n")
            self._message.setStyleSheet("color: #b3261e")
            self._message.setText(message)
        finally:
            QtGui.QApplication.restoreOverrideCursor()

    def _say(self, text: str) -> None:
        self._message.setStyleSheet("")
        self._message.setText(text + " ...")
        QtGui.QApplication.processEvents(QtCore.QEventLoop.ExcludeUserInputEvents)

    def _tell(self, lines: list[str]) -> None:
        for line in lines:
            App.Console.PrintMessage(f"Voxelastica: {line}\n")
        self._message.setStyleSheet("")
        self._message.setText("\n".join(lines))

    def getStandardButtons(self) -> int:
        """Close only: Build leaves the panel open."""
        button = QtGui.QDialogButtonBox.Close
        # PySide 6 has enumerations of Python here, PySide 2 numbers.
        return int(getattr(button, "value", button))

    def reject(self) -> bool:
        """Close."""
        Gui.Control.closeDialog()
        return True


def show() -> Panel:
    """Shows the panel in the task view."""
    if Gui.Control.activeDialog():
        Gui.Control.closeDialog()
    panel = Panel()
    Gui.Control.showDialog(panel)
    return panel
