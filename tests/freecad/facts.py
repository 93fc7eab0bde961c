"""Runs in FreeCAD: builds what the environment says and writes what came out as JSON. An exception ends with code 3."""

import json
import os
import sys
import traceback


def facts() -> dict:
    import FreeCAD as App
    import Part

    from voxelastica_freecad import core, solve
    from voxelastica_freecad.settings import Settings

    built = core.build(Settings.from_environment(os.environ))
    found: dict = {"freecad": ".".join(App.Version()[:3]), "files": [str(file) for file in built.files]}
    found["tree"] = {item.Name: [item.Label, item.TypeId] for item in built.document.Objects}
    if flat := built.parts.get("flat"):
        shapes = [Part.getShape(solid) for solid in flat["solids"]]
        found["solids"] = [
            [solid.Label, len(s.Solids), s.isValid(), s.isClosed(), s.Volume]
            for solid, s in zip(flat["solids"], shapes)
        ]
        first = flat["solids"][0]
        sketch = built.document.getObject("Spoke_outline")
        found["wires"] = [len(sketch.Shape.Wires), sketch.Shape.Wires[0].isClosed(), sketch.FullyConstrained]
        found["face_area"] = built.document.getObject("Spoke_face").Shape.Area
        sheet = built.document.getObject("Parameters")
        before = first.Shape.Volume
        # The thickness is a parameter: twice of it, twice the volume.
        sheet.set("thickness", f"={2 * sheet.thickness.Value!r} mm")
        built.document.recompute()
        found["volume_ratio_at_twice_the_thickness"] = first.Shape.Volume / before
        sheet.set("thickness", f"={sheet.thickness.Value / 2!r} mm")
        built.document.recompute()
    if morphed := built.parts.get("morphed"):
        box = morphed["shell"].Shape.BoundBox
        found["shell"] = [morphed["shell"].Shape.isValid(), morphed["shell"].Shape.Area, box.ZMin, box.ZMax, box.XMax]
        found["hub_height"] = morphed["hub"].Shape.BoundBox.ZMax if morphed["hub"] else None
    if phases := built.parts.get("phases"):
        found["phases"] = []
        for item in phases["phases"]:
            mesh = getattr(item, "Mesh", None)
            shape = mesh if mesh is not None else item.Shape
            closed = mesh.isSolid() if mesh is not None else item.Shape.isValid()
            box = shape.BoundBox
            found["phases"].append([item.Label, item.Voxels, shape.Volume, closed, [box.XMin, box.XMax]])
    if analysis := built.parts.get("analysis"):
        mesh = analysis["mesh"].FemMesh
        if modulus := os.environ.get("EDIT_MATERIAL"):
            first = analysis["materials"][0]
            first.Material = {**first.Material, "YoungsModulus": modulus}
        materials = solve.materials(analysis["analysis"])
        found["mesh"] = [mesh.NodeCount, mesh.HexaCount]
        found["element_type"] = analysis["mesh"].ElementType
        found["materials"] = [[m.name, m.modulus_mpa, m.poisson, m.density_kg_m3, len(m.elements)] for m in materials]
        found["elements"] = sorted(number for m in materials for number in m.elements)
        found["bodies"] = [len(analysis["bodies"].Shape.Solids), analysis["bodies"].Shape.Volume]
        found["constraints"] = [[c.TypeId, c.Label, len(c.References)] for c in analysis["constraints"]]
        folder = os.environ["VOXELASTICA_FOLDER"]
        found["input"] = str(solve.write_input(analysis["analysis"], os.path.join(folder, "input")))
        if os.environ.get("CHECK_OWN_WRITER"):
            found["own_writer"] = own_writer(analysis)
    if built.solution:
        found["max_error_percent"] = built.solution["max_error_percent"]
        found["midline"] = built.solution["file"]
        found["results"] = len(built.solution["results"])
    for file in built.files:
        if file.suffix == ".step":
            found.setdefault("step", {})[file.name] = reimported(file)
        if file.suffix == ".FCStd":
            found["reopened"] = reopened(file)
    return found


def own_writer(analysis: dict) -> list:
    """What FreeCAD's own writer makes of the analysis: the section of every element."""
    from femtools import ccxtools

    folder = os.path.join(os.environ["VOXELASTICA_FOLDER"], "own")
    os.makedirs(folder, exist_ok=True)
    tools = ccxtools.FemToolsCcx(analysis["analysis"], analysis["solver"])
    tools.update_objects()
    tools.setup_working_dir(folder)
    problems = tools.check_prerequisites()
    tools.write_inp_file()
    return [problems, tools.inp_file_name]


def reimported(file) -> list:
    """Solids, their volume, the area, and the names in the file. (Import.insert crashes without a window in 0.20.2, on any file of two
    boxes.)"""
    import re

    import Part

    shape = Part.read(str(file))
    names = re.findall(r"PRODUCT\('([^']*)'", file.read_text(encoding="utf-8"))
    return [len(shape.Solids), sum(solid.Volume for solid in shape.Solids), shape.Area, sorted(set(names))]


def reopened(file) -> list:
    import FreeCAD as App

    document = App.openDocument(str(file))
    solid = document.getObject("Spoke_1") or document.getObject("Strip")
    found = [len(document.Objects), solid.Shape.Volume, os.path.getsize(document.Analysis.Deck)]
    App.closeDocument(document.Name)
    return found


try:
    sys.path.insert(0, os.environ["VOXELASTICA_MACRO"])
    with open(os.environ["VOXELASTICA_FACTS"], "w", encoding="utf-8") as out:
        json.dump(facts(), out)
except BaseException:
    traceback.print_exc()
    sys.stdout.flush()
    sys.exit(3)
