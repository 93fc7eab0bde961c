"""Runs the scripts on the stand-in and writes what was recorded; Python 2.7 and 3.

    python run_fake.py TABLE.json SCENARIO.json OUT.json

The scenario: ``scripts`` (folder of the plug-in), ``replies`` to CAE's boxes and ``actions``, each ``{"do": "build" |
"dialog" | "extract" | "plugin" | "occupy" | "names" | "script", ...}``. The result holds all calls, what was printed and what the
database holds after every action.
"""

from __future__ import print_function

import io
import json
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

from fake import odb as fake_odb
from fake.install import install


def native(value):
    """Native strings in Python 2 too, as a user of CAE would type them."""
    if isinstance(value, dict):
        return dict((native(k), native(v)) for k, v in value.items())
    if isinstance(value, list):
        return [native(v) for v in value]
    return str(value) if not isinstance(value, (str, int, float, type(None))) else value


def contents(world):
    """Names in the database: models with their repositories, jobs."""
    found = {"jobs": world.mdb.jobs.keys()}
    for name, model in world.mdb.models.items():
        assembly = model.rootAssembly
        kinds = (
            "parts",
            "materials",
            "sections",
            "amplitudes",
            "steps",
            "boundaryConditions",
            "constraints",
            "analyticalFields",
            "predefinedFields",
            "fieldOutputRequests",
            "historyOutputRequests",
            "sketches",
        )
        found[name] = dict((kind, sorted(getattr(model, kind).keys())) for kind in kinds)
        found[name]["sets"] = sorted(assembly.sets.keys())
        found[name]["instances"] = sorted(assembly.instances.keys())
        found[name]["features"] = sorted(assembly.features.keys())
    return found


def sizes(world):
    """Members of every set of every part and assembly, and elements of every part."""
    found = {}
    for name, model in world.mdb.models.items():
        for owner in [model.rootAssembly] + model.parts.values():
            for key, of in owner.sets.items():
                for kind in ("cells", "faces", "edges", "nodes", "elements", "referencePoints"):
                    if of._values.get(kind) is not None:
                        found["%s|%s|%s" % (name, owner._path.rsplit(".", 1)[-1], key)] = [kind, len(of._values[kind])]
    return found


def act(world, action):
    """One action; returns its result."""
    do = action["do"]
    if do == "build":
        from voxelastica_cae.build import Options, build

        return build(action["design"], Options(**action.get("options", {})))
    if do == "dialog":
        from voxelastica_cae import dialogs

        return getattr(dialogs, action["call"])(*action.get("arguments", []))
    if do == "extract":
        from voxelastica_cae.extract import extract

        for path, data in action.get("databases", {}).items():
            world.odbs[path] = fake_odb.database(world, path, data)
        return extract(*action["arguments"])
    if do == "occupy":
        model = world.mdb.models[action["model"]]
        return model.Part(
            name=action["part"],
            dimensionality=world.constant("THREE_D"),
            type=world.constant("DEFORMABLE_BODY"),
        )._plain()
    if do == "names":
        from voxelastica_cae import design as designs, shell_flower, voxel_strip

        module = voxel_strip if action["kind"] == "geometry" else shell_flower
        return module.names(designs.read(action["design"]))
    if do == "plugin":
        return plugin(world, action)
    if do == "coarse":
        # A swept mesh that does not heed the seeds.
        original = world.behaviours["MeshPart", "setMeshControls"]

        def control(self, result, technique=None, **given):
            self._values["_geometry"].ignored = technique.name == "SWEEP"
            return original(self, result, technique=technique, **given)

        world.behaviours["MeshPart", "setMeshControls"] = control
        return None
    if do == "fail":
        # The interface itself refuses in the middle of the work.
        def refuse(*_, **__):
            raise RuntimeError("the interface refused")

        world.behaviours[tuple(action["method"])] = refuse
        return None
    sys.argv = ["abaqus", "cae", "-noGUI", action["script"], "--"] + action["arguments"]
    with io.open(action["script"], encoding="utf-8") as file_:
        code = compile(file_.read().encode("utf-8"), action["script"], "exec")
    try:
        exec(code, {"__name__": "__main__"})
    except SystemExit as end:
        return end.code
    return 0


def plugin(world, action):
    """Loads the plug-in as CAE does and opens every form's dialog; returns the buttons."""
    before = len(world.calls)
    path = action["script"]
    with io.open(path, encoding="utf-8") as file_:
        code = compile(file_.read().encode("utf-8"), path, "exec")
    scope = {"__name__": "voxelastica_plugin", "__file__": path}
    exec(code, scope)
    for name in ("BuildForm", "ExtractForm"):
        dialog = scope[name](scope["toolset"]).getFirstDialog()
        for chooser in dialog.__dict__.get("choosers") or [dialog.chooser]:
            chooser.choose(None, 0, None)
    return len(world.calls) - before


def main():
    """Runs the scenario."""
    table, scenario, out = sys.argv[1:]
    with io.open(scenario, encoding="utf-8") as file_:
        plan = native(json.load(file_))
    world = install(table)
    names = {"YES": world.constant("YES"), "NO": world.constant("NO")}
    world.replies += [names.get(r, r) if not isinstance(r, list) else tuple(r) for r in plan.get("replies", [])]
    sys.path.insert(0, plan["scripts"])
    results = []
    for action in plan["actions"]:
        first = len(world.calls)
        entry = {"before": contents(world)}
        try:
            entry["result"] = act(world, action)
        except Exception as error:
            entry["error"] = "%s: %s" % (type(error).__name__, error)
        entry["after"], entry["calls"] = contents(world), world.calls[first:]
        results.append(entry)
    text = json.dumps({"actions": results, "sizes": sizes(world)}, indent=0, sort_keys=True)
    with io.open(out, "wb") as file_:
        file_.write(text.encode("utf-8"))


if __name__ == "__main__":
    main()
