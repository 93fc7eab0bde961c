"""Solids to print and assembly parts, read by lib3mf and trimesh."""

from __future__ import annotations

import io
import math
from pathlib import Path

import lib3mf
import numpy as np
import pytest
import trimesh
from conftest import EXAMPLES, design, read_json, run

WRAPPER = lib3mf.get_wrapper()
DECKLESS = "\n[decks]\nwrite = []\n"


def coarse(name: str, size_mm: float, **replaced: str) -> str:
    """An example with larger voxels and without decks."""
    text = (EXAMPLES / f"{name}.toml").read_text(encoding="utf-8")
    lines = [f"size_mm = {size_mm}" if line.startswith("size_mm") else line for line in text.splitlines()]
    for key, line in replaced.items():
        lines = [other for other in lines if not other.startswith(key)]
        lines.insert(lines.index("[voxels]") + 1, line)
    return "\n".join(lines) + DECKLESS


def fabricated(folder: Path, *kinds: str) -> dict:
    """Makes files of a design; returns their record."""
    result = run("fabricate", folder, "--only", ",".join(kinds))
    assert result.code == 0, result.err
    return read_json(folder / "fabrication" / "fabrication.json")["kinds"]


def strictly(path: Path) -> lib3mf.Model:
    """Reads a file strictly and without a warning; every mesh must be a manifold."""
    model = WRAPPER.CreateModel()
    reader = model.QueryReader(path.suffix.removeprefix("."))
    reader.SetStrictModeActive(True)
    reader.ReadFromFile(str(path))
    assert reader.GetWarningCount() == 0, path
    for mesh in meshes(model):
        assert mesh.IsManifoldAndOriented(), f"{path.name}: {mesh.GetName()}"
    return model


def meshes(model: lib3mf.Model) -> list:
    """The mesh objects of a model."""
    found, objects = [], model.GetMeshObjects()
    while objects.MoveNext():
        found.append(objects.GetCurrentMeshObject())
    return found


def volume(mesh: lib3mf.MeshObject) -> float:
    """Enclosed volume."""
    points = np.array([list(v.Coordinates) for v in mesh.GetVertices()], dtype=np.float64)
    corners = points[np.array([list(t.Indices) for t in mesh.GetTriangleIndices()])]
    return float(np.linalg.det(corners).sum() / 6)


def check_stl(folder: Path, record: dict, spokes: int = 1) -> None:
    """Every STL is a volume, and each phase has that of its voxels but for what the record says contacts took."""
    total = 0.0
    for phase, figures in record["per_spoke"].items():
        cubes, share = figures["voxel_volume_mm3"], figures["contact_share_mm3"]
        assert figures["volume_mm3"] == pytest.approx(cubes + share, rel=1e-12)
        assert abs(share) < 1e-5 * cubes
        total += share
        files = [f for f in record["files"] if f.endswith(f"_{phase}.stl")]
        assert files
        for file in files:
            strictly(folder / file)
            solid = trimesh.load(folder / file)
            assert solid.is_volume, file
            # Turned spokes have vertices that single precision rounds.
            rel = 1e-6 if spokes == 1 else 2e-5
            assert solid.volume == pytest.approx(spokes * figures["volume_mm3"], rel=rel), file
            assert len(solid.faces) == spokes * figures["triangles"], file
    # What some phases lose others gain.
    assert abs(total) < 1e-9 * sum(f["voxel_volume_mm3"] for f in record["per_spoke"].values())
    assert record["contacts"]["parted_by_mm"] <= record["contacts"]["limit_mm"] == 1e-3


def check_3mf(folder: Path, record: dict) -> lib3mf.Model:
    """Every phase once (twice where spokes alternate), with its volume and its material."""
    (file,) = record["files"]
    model = strictly(folder / file)
    for phase, figures in record["per_spoke"].items():
        group, index = None, None
        found = [m for m in meshes(model) if _label(m.GetName()).endswith(phase)]
        assert found, phase
        for mesh in found:
            assert volume(mesh) == pytest.approx(figures["volume_mm3"], rel=1e-6)
            group, index, has = mesh.GetObjectLevelProperty()
            assert has
        materials = model.GetBaseMaterialGroupByID(group)
        assert _label(materials.GetName(index)) == phase
    return model


def _label(name: str) -> str:
    words = "".join(c if c.isascii() and c.isalnum() else "_" for c in name.upper())
    return "_".join(word for word in words.split("_") if word)


def placed(model: lib3mf.Model) -> int:
    """How many spokes the items and their components place, through all levels."""

    def count(item: lib3mf.Object) -> int:
        if not item.IsComponentsObject():
            return 0
        parts = model.GetComponentsObjectByID(item.GetUniqueResourceID())
        below = [parts.GetComponent(i).GetObjectResource() for i in range(parts.GetComponentCount())]
        return 1 if item.GetName().startswith("spoke") else sum(count(part) for part in below)

    items, total = model.GetBuildItems(), 0
    while items.MoveNext():
        total += count(items.GetCurrent().GetObjectResource())
    return total


@pytest.mark.parametrize(
    ("name", "size_mm"), [("hemisphere", 1.0), ("three_phases", 1.0), ("roof", 1.0), ("coupon_0.5", 1.0)]
)
def test_a_spoke_is_a_pair_of_solids(program: Path, tmp_path: Path, name: str, size_mm: float) -> None:
    folder = design(coarse(name, size_mm), tmp_path)
    record = fabricated(folder, "stl", "3mf")
    check_stl(folder, record["stl"])
    assert placed(check_3mf(folder, record["3mf"])) == 1


@pytest.mark.parametrize("name", ["hemisphere", "nose_cone"])
def test_the_flower_is_its_spokes_and_where_it_is_level_its_hub(program: Path, tmp_path: Path, name: str) -> None:
    text = coarse(name, 2.0, pattern='pattern = "random"') + '[fabrication]\nscope = "flower"\n'
    folder = design(text, tmp_path)
    document = read_json(folder / "design.json")
    spokes, level = document["design"]["strips"]["count"], abs(document["summary"]["hub_angle_deg"]) < 1
    record = fabricated(folder, "stl", "3mf")
    check_stl(folder, record["stl"], spokes)
    model = check_3mf(folder, record["3mf"])
    assert placed(model) == spokes
    assert record["stl"]["hub_in_one_piece"] is level is (name == "hemisphere")
    assert len(meshes(model)) == len(record["stl"]["per_spoke"]) + level
    hub = folder / "fabrication" / "flower_hub.stl"
    assert hub.exists() is level
    if level:
        strictly(hub)
        assert trimesh.load(hub).volume == pytest.approx(document["summary"]["volume_mm3"]["hub"], rel=1e-5)
    # Spoke 1 lies along +x, its rim outermost.
    solid = trimesh.load(folder / "fabrication" / f"flower_{next(iter(record['stl']['per_spoke']))}.stl")
    reach = record["stl"]["hub_ends_radius_mm"] + document["design"]["strips"]["length_mm"]
    widest = solid.vertices[np.abs(solid.vertices[:, 0] - reach) < 0.01]
    assert len(widest) and np.abs(widest[:, 1]).max() < 40


def test_alternating_spokes_are_stored_twice_and_are_mirror_images(program: Path, tmp_path: Path) -> None:
    text = coarse("hemisphere", 2.0, pattern='pattern = "one-edge"') + '[fabrication]\nscope = "flower"\n'
    folder = design(text, tmp_path)
    record = fabricated(folder, "3mf")
    model = check_3mf(folder, record["3mf"])
    assert placed(model) == 8
    spokes = {m.GetName(): m for m in meshes(model)}
    phases = list(record["3mf"]["per_spoke"])
    assert len(spokes) == 2 * len(phases) + 1
    one, other = (
        np.array([list(v.Coordinates) for v in spokes[f"spoke{which} FLX9095"].GetVertices()])
        for which in ("", " mirrored")
    )
    assert np.allclose(one * [1, -1, 1], other, atol=1e-6)


def test_an_image_stack_says_the_same_as_the_voxels(program: Path, tmp_path: Path) -> None:
    image = pytest.importorskip("PIL.Image")
    text = coarse("hemisphere", 1.0) + '[fabrication]\nthree_mf_geometry = "image-stack"\n'
    folder = design(text, tmp_path)
    record = fabricated(folder, "3mf")["3mf"]
    model = WRAPPER.CreateModel()
    reader = model.QueryReader("3mf")
    reader.ReadFromFile(str(folder / record["files"][0]))
    # lib3mf 2.5 calls every image sheet an invalid element, those it wrote itself as well, and does not know composites;
    # it reads the rest.
    said = {reader.GetWarning(i)[1] for i in range(reader.GetWarningCount())}
    assert said <= {"Invalid Element in namespace."}
    (mesh,) = meshes(model)
    assert mesh.IsManifoldAndOriented()
    total = sum(figures["voxel_volume_mm3"] for figures in record["per_spoke"].values())
    assert volume(mesh) == pytest.approx(total, rel=1e-6)
    stacks = model.GetImage3Ds()
    assert stacks.MoveNext()
    stack = model.GetImageStackByID(stacks.GetCurrentImage3D().GetUniqueResourceID())
    assert stack.GetSheetCount() == 2
    counts = np.zeros(3)
    for sheet in range(stack.GetSheetCount()):
        data = bytes(stack.GetSheet(sheet).WriteToBuffer())
        pixels = np.asarray(image.open(io.BytesIO(data)).convert("RGB"))
        assert set(np.unique(pixels)) <= {0, 255}
        assert np.all(pixels.sum(axis=2) == 255)
        counts += (pixels == 255).sum(axis=(0, 1))
    stiff = record["per_spoke"]["FLX9095"]["voxels"]
    assert counts[1] == stiff


def slot(solid: trimesh.Trimesh, slant_deg: float, outwards: np.ndarray) -> np.ndarray:
    """Offsets of the planes of spoke 1 whose normal is `outwards` or its opposite, by area."""
    aligned = np.abs(solid.face_normals @ outwards) > math.cos(math.radians(0.05))
    near = np.abs(solid.triangles_center[:, 1]) < 0.45 * np.abs(solid.triangles_center[:, 0])
    chosen = aligned & near & (solid.triangles_center[:, 0] > 0)
    return np.unique(np.round(solid.triangles_center[chosen] @ outwards, 3))


@pytest.mark.parametrize("held", [False, True])
def test_assembly_parts_are_solids_with_slots_where_the_design_says(program: Path, tmp_path: Path, held: bool) -> None:
    text = coarse("hemisphere", 2.0)
    folder = design(text + ('[thrust]\nhub = "held"\n' if held else ""), tmp_path)
    document = read_json(folder / "design.json")
    summary, thickness = document["summary"], document["design"]["strips"]["thickness_mm"]
    record = fabricated(folder, "assembly")["assembly"]
    names = ["base", "hub", "post"] if held else ["base", "hub"]
    assert [Path(f).name for f in record["files"]] == [f"{n}.stl" for n in names] + ["assembly.3mf"]
    solids = {}
    for name in names:
        path = folder / "fabrication" / f"{name}.stl"
        strictly(path)
        solids[name] = trimesh.load(path)
        assert solids[name].is_volume, name
    packed = strictly(folder / "fabrication" / "assembly.3mf")
    assert sorted(m.GetName() for m in meshes(packed)) == sorted(names)

    angle = math.radians(summary["rim_angle_deg"])
    normal = np.array([math.sin(angle), 0, math.cos(angle)])
    rim = summary["rim_radius_mm"] * math.sin(angle)
    offsets = slot(solids["base"], summary["rim_angle_deg"], normal)
    for side in (-1, 1):
        wall = rim + side * 0.5 * (thickness + 0.2)
        assert np.abs(offsets - wall).min() < 0.01, offsets
    width = document["profile"]["width_mm"][0] + 0.2
    across = slot(solids["base"], 0, np.array([0.0, 1.0, 0.0]))
    assert np.abs(across - 0.5 * width).min() < 0.01 and np.abs(across + 0.5 * width).min() < 0.01
    height = summary["height_mm"]
    level = slot(solids["hub"], 0, np.array([0.0, 0.0, 1.0]))
    for side in (-1, 1):
        assert np.abs(level - (height + side * 0.5 * (thickness + 0.2))).min() < 0.01
    if held:
        vertical = summary["thrust"]["total"]["beam"]["vertical_n"]
        assert record["post"]["force_on_hub_n"]["beam"] == pytest.approx(vertical)
        top = solids["post"].bounds[1][2]
        assert top == pytest.approx(record["post"]["top_mm"], abs=1e-3)
        assert solids["post"].bounds[0][2] == pytest.approx(solids["base"].bounds[0][2], abs=1e-3)


def test_a_strip_has_no_assembly_and_a_flower_too_large_for_single_precision_is_refused(
    program: Path, tmp_path: Path
) -> None:
    folder = design(coarse("coupon_0.5", 1.0), tmp_path)
    result = run("fabricate", folder, "--only", "assembly")
    assert result.code == 2 and "strip" in result.err
    large = coarse("hemisphere", 20.0).replace("length_mm = 100.0", "length_mm = 9000.0")
    large = large.replace("thickness_mm = 2.0", "thickness_mm = 20.0").replace(
        "hub_radius_mm = 10.0", "hub_radius_mm = 900.0"
    )
    folder = design(large, tmp_path, "large")
    result = run("fabricate", folder, "--only", "stl")
    assert result.code == 2 and "single precision" in result.err
    assert not (folder / "fabrication").exists()


@pytest.mark.parametrize("name", sorted(path.stem for path in EXAMPLES.glob("*.toml")))
def test_every_example_is_printable(examples: dict[str, Path], name: str) -> None:
    folder = examples[name]
    record = fabricated(folder, "stl", "3mf")
    check_stl(folder, record["stl"])
    check_3mf(folder, record["3mf"])
    if read_json(folder / "design.json")["design"]["target"]["kind"] != "strip":
        for file in fabricated(folder, "assembly")["assembly"]["files"]:
            strictly(folder / file)
            if file.endswith(".stl"):
                assert trimesh.load(folder / file).is_volume, file
