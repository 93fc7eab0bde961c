"""Cut patterns read by ezdxf and as XML, and previews read by trimesh."""

from __future__ import annotations

import math
import re
import xml.etree.ElementTree as ET
from pathlib import Path

import ezdxf
import numpy as np
import pytest
import trimesh
from conftest import EXAMPLES, read_json, run

SHAPES = ["hemisphere", "nose_cone", "rectangular_2"]


def area(points: np.ndarray) -> float:
    x, y = points.T
    return 0.5 * float(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1)))


def made(folder: Path, name: str, settings: str = "") -> tuple[Path, dict]:
    """Pattern and preview of an example with coarse voxels and without decks."""
    text = (EXAMPLES / f"{name}.toml").read_text(encoding="utf-8")
    text = re.sub(r"size_mm = .*", "size_mm = 1.0", text)
    assert "[decks]" not in text
    file = folder / f"{name}.toml"
    file.write_text(f"{text}\n[decks]\nwrite = []\n[fabrication]\n{settings}", encoding="utf-8")
    out = folder / f"out-{name}"
    result = run("design", file, "-o", out)
    assert result.code == 0, result.err
    result = run("fabricate", out, "--only=dxf", "--only=svg", "--only=gltf")
    assert result.code == 0, result.err
    return out, read_json(out / "design.json")


def polylines(path: Path) -> dict[str, list[np.ndarray]]:
    """Closed outlines of a DXF by layer."""
    drawing = ezdxf.readfile(path)
    assert drawing.header["$INSUNITS"] == 4
    assert not drawing.audit().has_errors
    found: dict[str, list[np.ndarray]] = {"OUTLINE": [], "HUB": []}
    for line in drawing.modelspace().query("LWPOLYLINE"):
        assert line.closed
        found[line.dxf.layer].append(np.array([(x, y) for x, y in line.get_points("xy")]))
    layers = {layer.dxf.name for layer in drawing.layers}
    assert {"OUTLINE", "HUB", "MARKS", "LABELS"} <= layers
    assert {entity.dxf.layer for entity in drawing.modelspace().query("TEXT")} == {"LABELS"}
    return found


@pytest.mark.parametrize("name", SHAPES)
def test_areas_are_the_designs(program: Path, tmp_path: Path, name: str) -> None:
    out, document = made(tmp_path, name)
    strips, summary = document["design"]["strips"], document["summary"]
    thickness, count = strips["thickness_mm"], strips.get("count", 1)
    volume = summary["volume_mm3"]
    found = polylines(out / "fabrication" / "pattern.dxf")
    outline = sum(area(part) for part in found["OUTLINE"])
    if name == "nose_cone":
        # Its spokes leave the hub at an angle: separate pieces around a separate hub.
        assert abs(summary["hub_angle_deg"]) > 10
        assert (len(found["OUTLINE"]), len(found["HUB"])) == (count, 1)
        assert outline * thickness == pytest.approx(count * volume["spoke_smooth"], rel=1e-3)
        assert area(found["HUB"][0]) * thickness == pytest.approx(volume["hub"], rel=1e-3)
    else:
        assert (len(found["OUTLINE"]), len(found["HUB"])) == (1, 0)
        assert outline * thickness == pytest.approx(volume["flower"], rel=1e-3)
        if name == "rectangular_2":
            assert len(found["OUTLINE"][0]) == 4
    # The drawing says the same, in millimetres.
    root = ET.fromstring((out / "fabrication" / "pattern.svg").read_text(encoding="utf-8"))
    width, height = (float(root.get(side).removesuffix("mm")) for side in ("width", "height"))
    assert root.get("viewBox") == f"0 0 {width:g} {height:g}" or root.get("viewBox").split()[2:] == [
        root.get("width").removesuffix("mm"),
        root.get("height").removesuffix("mm"),
    ]
    drawn = {"OUTLINE": 0.0, "HUB": 0.0}
    for group in root.iter("{http://www.w3.org/2000/svg}g"):
        for path in group:
            data = path.get("d", "")
            if data.endswith("Z"):
                points = np.array([[float(c) for c in pair.split()] for pair in data[1:-1].split("L")])
                drawn[group.get("id")] -= area(points)
    assert drawn["OUTLINE"] == pytest.approx(outline, rel=1e-5)
    assert drawn["HUB"] == pytest.approx(sum(area(part) for part in found["HUB"]), rel=1e-5, abs=1e-9)


def test_a_kerf_moves_outlines_outward_by_half_of_it(program: Path, tmp_path: Path) -> None:
    kerf = 0.3
    for name in SHAPES:
        (tmp_path / name).mkdir()
        out, document = made(tmp_path, name)
        exact = polylines(out / "fabrication" / "pattern.dxf")
        wide, _ = made(tmp_path / name, name, f"kerf_mm = {kerf}\n")
        found = polylines(wide / "fabrication" / "pattern.dxf")
        if name == "hemisphere":
            # One piece: every cut is half a kerf from the design's edge, but in the slits, which are narrower than that.
            edge, moved = exact["OUTLINE"][0], found["OUTLINE"][0]
            count, hub = document["design"]["strips"]["count"], document["design"]["strips"]["hub_radius_mm"]
            distances = np.array([distance(point, edge) for point in moved])
            in_notch = np.isclose(
                np.mod(np.degrees(np.arctan2(moved[:, 1], moved[:, 0])), 360 / count), 180 / count, atol=1e-6
            )
            corner = np.hypot(*np.abs(moved).max(axis=0))
            assert np.all(distances[~in_notch] < kerf / 2 * math.sqrt(2) + 1e-3) and corner > 0
            assert np.median(distances[~in_notch]) == pytest.approx(kerf / 2, abs=2e-3)
            slits = [
                line
                for line in ezdxf.readfile(wide / "fabrication" / "pattern.dxf").modelspace().query("LINE")
                if line.dxf.layer == "OUTLINE"
            ]
            assert len(slits) == count
            for slit in slits:
                inner = math.hypot(slit.dxf.end.x, slit.dxf.end.y)
                assert inner == pytest.approx(hub / math.cos(math.pi / count) + kerf / 2, abs=1e-6)
        else:
            for layer in ("OUTLINE", "HUB"):
                for one, other in zip(exact[layer], found[layer], strict=True):
                    perimeter = np.hypot(*(one - np.roll(one, -1, axis=0)).T).sum()
                    grown = area(other) - area(one)
                    assert grown == pytest.approx(kerf / 2 * perimeter, rel=0.02)


def distance(point: np.ndarray, polygon: np.ndarray) -> float:
    a, b = polygon, np.roll(polygon, -1, axis=0)
    along = b - a
    t = np.clip(((point - a) * along).sum(axis=1) / (along**2).sum(axis=1), 0, 1)
    return float(np.hypot(*(point - a - t[:, None] * along).T).min())


def test_files_do_not_depend_on_time_or_place(program: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    out, _ = made(tmp_path, "hemisphere")
    files = ["pattern.dxf", "pattern.svg", "flat.glb", "morphed.glb", "fabrication.json"]
    before = [(out / "fabrication" / file).read_bytes() for file in files]
    monkeypatch.setenv("TZ", "Asia/Tokyo")
    assert run("fabricate", out, "--only=dxf,svg,gltf").code == 0
    for file, old in zip(files, before, strict=True):
        assert (out / "fabrication" / file).read_bytes() == old, file
    assert str(tmp_path).encode() not in b"".join(before)


@pytest.mark.parametrize("name", SHAPES)
def test_previews_are_closed_solids_of_the_designs_size(program: Path, tmp_path: Path, name: str) -> None:
    out, document = made(tmp_path, name)
    summary, strips = document["summary"], document["design"]["strips"]
    for state in ("flat", "morphed"):
        scene = trimesh.load(out / "fabrication" / f"{state}.glb")
        spokes = scene.geometry["spokes"]
        assert spokes.is_watertight and spokes.is_winding_consistent
        assert spokes.volume == pytest.approx(strips.get("count", 1) * summary["volume_mm3"]["spoke_smooth"], rel=2e-3)
        colours = np.unique(spokes.visual.vertex_attributes["color"], axis=0)
        assert (len(colours) > 20) == (summary["contrast"] > 1.001)
        # glTF: metres, y up.
        low, high = scene.bounds
        height = 1e3 * (high[1] - low[1])
        if state == "flat":
            assert height == pytest.approx(strips["thickness_mm"], rel=1e-3)
        elif name != "rectangular_2":
            assert height > summary["height_mm"]
            rim = summary["rim_radius_mm"]
            thick = strips["thickness_mm"]
            widest = document["profile"]["width_mm"][0]
            assert 1e3 * high[0] == pytest.approx(math.hypot(rim, 0.0), abs=thick + 0.1 * widest)
        if name == "rectangular_2":
            assert list(scene.geometry) == ["spokes"]
        else:
            hub = scene.geometry["hub"]
            assert hub.is_volume
            assert hub.volume == pytest.approx(summary["volume_mm3"]["hub"], rel=1e-4)
