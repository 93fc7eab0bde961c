"""The add-on's logic, which needs no Blender."""

from __future__ import annotations

import sys
import time
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "blender_addon"), str(ROOT / "ffi" / "python")]

from logic import (  # noqa: E402
    colours,
    inputs,
    job,
    library,
    lines,
    mesh_target,
    messages,
    parameters,
    presets,
    results,
    states,
    voxel_mesh,
)


@pytest.fixture(scope="module")
def api():
    assert library.load(), library.problem()
    return library.api()


@pytest.mark.parametrize(
    ("name", "unit", "label"),
    [
        ("hub_radius_mm", "mm", "Hub Radius (mm)"),
        ("conductivity_w_mk", "W/(m K)", "Conductivity (W/(m K))"),
        ("density_kg_m3", "kg/m^3", "Density (kg/m^3)"),
        ("three_mf_geometry", None, "3MF Geometry"),
        ("calculix_graded_elements", None, "CalculiX Graded Elements"),
        ("count", None, "Count"),
    ],
)
def test_labels_are_keys_with_units(name: str, unit: str | None, label: str) -> None:
    assert parameters.label(name, unit) == label


def test_choices_read_as_words() -> None:
    words = {"gltf": "glTF", "hemi-ellipsoid": "Hemi-Ellipsoid", "voxel_solid": "Voxel Solid", "C3D8R": "C3D8R"}
    assert {word: parameters.title(word) for word in words} == words


@pytest.mark.parametrize("number", [0.7, 7.3, 100.0, 1e-6, -116.3, 11340.0, 0.1, 123.4567, 0.0])
def test_single_precision_is_read_as_the_decimal_number_that_was_typed(number: float) -> None:
    assert inputs.shortest(inputs.single(number)) == number
    assert inputs.restored(inputs.single(number), None) == number


def test_digits_that_do_not_fit_come_back_while_the_slider_is_not_moved() -> None:
    exact = 10.123456789012
    assert inputs.restored(inputs.single(exact), exact) == exact
    assert inputs.restored(inputs.single(11.5), exact) == 11.5


def test_a_form_and_a_design_are_the_same(api) -> None:
    known = parameters.fields(api.parameters())
    for path in presets.bundled().values():
        keys = presets.read(path)
        again = inputs.assemble(inputs.flatten(keys, known), known)
        assert api.Design.from_dict({"name": "x"} | again).hash == api.Design.from_dict({"name": "x"} | keys).hash


def test_voxels_are_shown_without_what_hides_itself(api) -> None:
    keys = presets.read(presets.bundled()["hemisphere"])
    keys["voxels"]["size_mm"] = 2.0  # One layer.
    design = api.Design.from_dict(keys)
    faces = voxel_mesh.exposed(design.voxels, design.voxels.slices)
    half = np.asarray(design.voxels.half_widths).astype(int)
    # Above and below every voxel, both ends, both sides, and the steps between slices.
    steps = 2 * np.abs(np.diff(half)).sum()
    assert len(faces.quads) == 2 * faces.count + 2 * half[0] + 2 * half[-1] + 2 * len(half) + steps
    assert faces.count == len(design.voxels.phases)
    assert voxel_mesh.slices_within(design.voxels.offsets, 2 * half[0]) == 1
    for fraction in (0.0, 1.0):
        points = voxel_mesh.placed(faces, design, fraction, 0)
        edges = np.linalg.norm(points[faces.quads] - points[np.roll(faces.quads, 1, axis=1)], axis=2)
        assert edges.min() > 1.9 and edges.max() < 2.1, fraction


def test_blends_are_as_good_as_they_say() -> None:
    def circle(fraction: float) -> np.ndarray:
        angles = np.linspace(0, 1, 50) * fraction * np.pi
        return np.stack([np.cos(angles), np.sin(angles), 0 * angles], axis=1)

    count, off = states.enough(circle, 0.01)
    assert off <= 0.01 < states.deviation(circle, count - 2)
    with pytest.raises(ValueError, match="64 states"):
        states.enough(circle, 1e-9)
    weights = [eval(states.expression(k, 4), {"morph": 0.6, "max": max, "abs": abs}) for k in range(5)]
    assert weights == pytest.approx([0, 0, 0.6, 0.4, 0])


def test_legends_say_what_colours_are() -> None:
    scale = colours.scale(0.0, 12.6, "modulus")
    assert scale.marks() == ["12.6", "9.4", "6.3", "3.2", "0.0"]
    rgba = scale.colours(np.array([0.0, 12.6, 99.0]))
    assert np.array_equal(rgba[1], rgba[2]) and rgba[0, 0] > rgba[0, 2] and rgba[1, 2] > rgba[1, 1]
    both = colours.scale(-0.01, 0.04, "curvature")
    assert both.low == -0.04 and both.colours(np.array([0.0]))[0, :3].min() > 0.85
    assert colours.scale(5.0, 5.0, "modulus").marks() == ["5.00"]
    # Soft is light and stiff is dark, as in the reports: of moduli as of phases.
    for shades in (scale.colours(np.array([0.0, 6.3, 12.6])), colours.phase_colours(3)):
        light = shades[:, :3] @ [0.2126, 0.7152, 0.0722]
        assert light[0] > light[1] > light[2]
    assert colours.Scale("phase", names=("soft", "stiff")).marks() == ["stiff", "soft"]


def test_meridians_of_meshes_are_in_the_meshs_size(api) -> None:
    polar, turn = np.meshgrid(np.linspace(0.02, np.pi / 2, 40), np.linspace(0, 2 * np.pi, 64, endpoint=False))
    rho, z = 60 * np.sin(polar), 30 * np.cos(polar)
    vertices = np.stack([rho * np.cos(turn), rho * np.sin(turn), z], axis=2).reshape(-1, 3) + [1e4, -5e3, 0]
    i, j = np.meshgrid(np.arange(64), np.arange(39), indexing="ij")
    a, b, c, d = (x.ravel() for x in (i * 40 + j, i * 40 + j + 1, (i + 1) % 64 * 40 + j + 1, (i + 1) % 64 * 40 + j))
    triangles = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    # It is open at the top: the meridian goes as near to the axis as the mesh does.
    found = mesh_target.extract(vertices, triangles, "auto", 0.1)
    assert found.rim_radius_mm == pytest.approx(60, abs=0.05) and found.meridian[-1][0] < 2.5
    assert found.meridian[-1][1] - found.meridian[0][1] == pytest.approx(30, abs=0.1)
    with pytest.raises(ValueError, match="no faces"):
        mesh_target.extract(vertices, triangles[:0], "auto", 0.1)


def test_tubes_go_round_their_line() -> None:
    line = np.stack([np.linspace(10, 2, 20), np.zeros(20), np.linspace(0, 5, 20) ** 1.5], axis=1)
    points, quads = lines.tube(line, 0.1)
    rings = points.reshape(20, 6, 3)
    assert np.allclose(rings.mean(axis=1), line) and np.allclose(np.linalg.norm(rings - line[:, None], axis=2), 0.1)
    assert quads.max() == len(points) - 1 and len(quads) == 19 * 6


def test_jobs_report_fail_and_are_cancelled() -> None:
    def work(progress: job.Progress) -> str:
        while progress(1, 4):
            time.sleep(0.001)
        return "stopped"

    running = job.Job("test", work)
    running.cancel()
    assert running.wait(10) and running.cancelled and running.result == "stopped" and running.share == 0.25
    failed = job.Job("test", lambda progress: 1 / 0)
    assert failed.wait(10) and isinstance(failed.error, ZeroDivisionError)


def test_results_go_where_a_user_expects() -> None:
    assert results.destination("/x", "dome", saved=False) == Path("/x/dome")
    with pytest.raises(ValueError, match="Save the .blend"):
        results.destination("//", "dome", saved=False)
    with pytest.raises(ValueError, match="Choose a folder"):
        results.destination("", "dome", saved=True)


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("design: voxels.size_mm = 3: too large", "voxels.size_mm = 3: too large"),
        ("/x: no permission; choose another folder with -o", "/x: no permission; choose another folder"),
        ("use larger voxels, or insist with --yes", "use larger voxels"),
        ("install it or name it with --ccx PATH", "install it or name it in the add-on's preferences"),
    ],
)
def test_messages_do_not_speak_of_the_command_line(text: str, shown: str) -> None:
    assert messages.said(ValueError(text)) == shown


def test_presets_are_files_that_a_user_keeps(tmp_path: Path) -> None:
    path = presets.save(tmp_path / "presets", "my dome", {"target": {"kind": "points"}})
    assert presets.saved(tmp_path / "presets") == {"my dome": path}
    assert presets.read(path)["target"]["kind"] == "points"
    presets.remove(tmp_path / "presets", "my dome")
    assert presets.saved(tmp_path / "presets") == {}
    (tmp_path / "broken.json").write_text("{")
    with pytest.raises(ValueError, match="broken.json"):
        presets.read(tmp_path / "broken.json")
