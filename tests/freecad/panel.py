"""Runs in FreeCAD with a window: fills the panel in, builds, makes a mistake, takes pictures, and writes what was seen as JSON."""

import json
import os
import sys
import time
import traceback

import FreeCAD as App
import FreeCADGui as Gui
from PySide import QtCore, QtGui


def wait(seconds: float) -> None:
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        QtGui.QApplication.processEvents()
        time.sleep(0.02)


def colours(file: str) -> int:
    """Number of different colours of a picture, coarsely."""
    image = QtGui.QImage(file)
    seen = set()
    for x in range(0, image.width(), 4):
        for y in range(0, image.height(), 4):
            seen.add(image.pixel(x, y) & 0xF0F0F0)
    return len(seen)


def look() -> dict:
    from voxelastica_freecad import gui

    folder = os.environ["VOXELASTICA_PICTURES"]
    Gui.getMainWindow().showMaximized()
    panel = gui.show()
    found: dict = {"title": panel.form.windowTitle(), "buttons": panel.getStandardButtons()}
    panel._design.setText(os.environ["PANEL_DESIGN"])
    panel._folder.setText(folder)
    panel._exports["step"].setChecked(True)
    panel.build()
    found["message"] = panel._message.text()
    document = App.ActiveDocument
    found["objects"] = len(document.Objects)
    found["solve"] = panel._solve.isEnabled()
    wait(1.0)
    os.system(f"import -window root {folder}/panel.png 2>/dev/null")
    view = Gui.ActiveDocument.ActiveView
    pictures = {"flower": ("Spoke_", "Hub", "Morphed_"), "phases": ("Phase_",), "analysis": ("FEM_bodies",)}
    for name, shown in pictures.items():
        for item in document.Objects:
            hidden = item.TypeId in ("Sketcher::SketchObject", "Part::Face") or "constraint" in item.Name
            if item.ViewObject is not None and item.TypeId != "App::DocumentObjectGroup":
                item.ViewObject.Visibility = item.Name.startswith(shown) and not hidden
        view.viewTop() if name == "phases" else view.viewIsometric()
        Gui.SendMsgToActiveView("ViewFit")
        wait(0.5)
        file = os.path.join(folder, f"{name}.png")
        view.saveImage(file, 1000, 700, "White")
        found[name] = colours(file)
    panel._design.setText(os.path.join(folder, "nowhere.toml"))
    panel.build()
    found["error"] = panel._message.text()
    found["documents"] = len(App.listDocuments())
    panel._design.setText(os.environ["PANEL_DESIGN"])
    panel._new_document.setChecked(False)
    panel.build()
    found["taken"] = panel._message.text()
    found["objects_after"] = len(document.Objects)
    if os.environ.get("PANEL_SOLVE"):
        panel._new_document.setChecked(True)
        for part in ("flat", "morphed", "phases"):
            panel._parts[part].setChecked(False)
        panel._exports["step"].setChecked(False)
        panel.build()
        panel.solve()
        found["solved"] = panel._message.text()
    panel.reject()
    return found


def main() -> None:
    code = 3
    try:
        sys.path.insert(0, os.environ["VOXELASTICA_MACRO"])
        with open(os.environ["VOXELASTICA_FACTS"], "w", encoding="utf-8") as out:
            json.dump(look(), out)
        code = 0
    except BaseException:
        traceback.print_exc()
    sys.stdout.flush()
    os._exit(code)


QtCore.QTimer.singleShot(2000, main)
