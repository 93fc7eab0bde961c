"""Properties are the library's table: names, ranges, defaults, descriptions; and a design from them is the command line's."""

from __future__ import annotations

import json
import subprocess
import sys
import tomllib
from pathlib import Path

import bpy
import host

program, examples = sys.argv[1], Path(sys.argv[2])
host.install()
import voxelastica  # noqa: E402 - it comes with the extension

root = host.new()
settings = root.voxelastica
seen = 0
for row in voxelastica.parameters():
    table, _, name = row["key"].rpartition(".")
    if table not in ("target", "strips", "thrust", "voxels", "decks", "fabrication") or row["type"] in (
        "recorded",
        "pairs",
    ):
        continue
    if row["targets"] == ["strip"]:
        continue
    property = type(getattr(settings, table)).bl_rna.properties[name]
    assert property.description == row["description"].rstrip("."), row["key"]
    if row["unit"]:
        assert f"({row['unit']})" in property.name, (row["key"], property.name)
    if row["type"] in ("number", "integer"):
        assert property.hard_min >= row["least"] - 1e-6 and property.hard_min <= row["least"] * 1.001 + 2e-6, row["key"]
        assert abs(property.hard_max - min(row["most"], 2**31 - 1)) <= 1e-6 * row["most"], row["key"]
    if "choices" in row:
        items = [item.identifier for item in property.enum_items if item.identifier != "automatic"]
        assert items == [choice for choice in row["choices"] if choice != "strip"], row["key"]
    seen += 1
assert seen > 35, seen

# Every preset is the example's design, digit by digit.
host.empty()
for preset in ("hemisphere", "nose_cone", "roof", "trumpet"):
    root = host.new(preset)
    assert root.voxelastica.problem == "", root.voxelastica.problem
    root.voxelastica.design_name = preset
    assert host.design(root).hash == voxelastica.Design.from_file(examples / f"{preset}.toml").hash, preset

# Sliders keep single precision; the design gets the decimal number that was typed.
root = host.new()
settings = root.voxelastica
settings.target.aspect_ratio = 0.7
settings.strips.length_mm = 80.0
settings.strips.hub_radius_mm = 7.3
settings.strips.count = 10
settings.thrust.hub = "held"
settings.voxels.pattern = "centred"
settings.design_name = "typed"
found = host.design(root).input
assert found["target"]["aspect_ratio"] == 0.7 and found["strips"]["hub_radius_mm"] == 7.3, found
assert found["thrust"] == {"hub": "held", "choice": "least-contrast"}
settings.fabrication.write = {"gltf", "svg"}
settings.folder = str(host.scratch() / "from blender")
assert bpy.ops.voxelastica.export() == {"FINISHED"}, settings.export_note
print(settings.export_note)
ours = host.scratch() / "from blender" / "typed"
text = """
name = "typed"
[target]
kind = "hemi-ellipsoid"
aspect_ratio = 0.7
[strips]
count = 10
length_mm = 80.0
hub_radius_mm = 7.3
thickness_mm = 2.0
[thrust]
hub = "held"
[materials]
phases = ["FLX9070", "FLX9095"]
[voxels]
size_mm = 0.5
pattern = "centred"
[fabrication]
write = ["svg", "gltf"]
"""
tomllib.loads(text)
(host.scratch() / "typed.toml").write_text(text)
theirs = host.scratch() / "from the command line"
subprocess.run([program, "design", "typed.toml", "-o", theirs, "--quiet"], check=True)
names = sorted(path.relative_to(theirs) for path in theirs.rglob("*") if path.is_file())
assert names == sorted(path.relative_to(ours) for path in ours.rglob("*") if path.is_file())
assert sum(name.suffix == ".inp" for name in names) == 6 and Path("fabrication/morphed.glb") in names, names
for name in names:
    assert (theirs / name).read_bytes() == (ours / name).read_bytes(), name

# Custom materials, three phases, coefficients: lists of the panel.
settings.target.kind = "inclination-polynomial"
assert settings.problem == "" and host.design(root).input["target"]["coefficients_deg"] == [-90.0, 90.0]
bpy.ops.voxelastica.list(what="coefficients", add=True)
assert host.design(root).input["target"]["coefficients_deg"] == [0.0, -90.0, 90.0]
settings.target.coefficients_deg[0].value = 5.0
assert host.design(root).input["target"]["coefficients_deg"] == [5.0, -90.0, 90.0]
bpy.ops.voxelastica.list(what="coefficients", add=False)
assert settings.problem == "" and host.design(root).input["target"]["coefficients_deg"] == [-90.0, 90.0]
bpy.ops.voxelastica.list(what="materials", add=True)
custom = settings.materials.custom[0]
custom.name, custom.modulus_mpa, custom.poisson = "my resin", 7.5, 0.35
custom.use_density_kg_m3, custom.density_kg_m3 = True, 1100.0
bpy.ops.voxelastica.list(what="phases", add=True)
settings.materials.phases[1].material = "my resin"
settings.materials.phases[2].material = "FLX9095"
assert settings.problem == "", settings.problem
materials = host.design(root).input["materials"]
assert materials["phases"] == ["FLX9070", "my resin", "FLX9095"]
assert materials["custom"] == [{"name": "my resin", "modulus_mpa": 7.5, "poisson": 0.35, "density_kg_m3": 1100.0}]
settings.colour_by = "phase"
assert host.part(root, "LABELS").data.body.splitlines() == ["phase", "FLX9095", "my resin", "FLX9070"]
bpy.ops.voxelastica.list(what="phases", add=False)
settings.materials.phases[1].material = "FLX9095"
assert settings.problem == "" and len(host.design(root).phases) == 2

# A design file with more digits than a slider holds stays itself.
keys = json.loads(json.dumps(host.design(root).input))
keys["strips"]["hub_radius_mm"] = 10.123456789012
keys["voxels"]["seed"] = 2**40 + 1
(host.scratch() / "exact.json").write_text(json.dumps(keys))
assert bpy.ops.voxelastica.import_design(filepath=str(host.scratch() / "exact.json")) == {"FINISHED"}
exact = host.design(bpy.context.object).input
assert exact["strips"]["hub_radius_mm"] == 10.123456789012 and exact["voxels"]["seed"] == 2**40 + 1
host.done()
