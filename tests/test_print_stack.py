"""Print stacks and their container, decoded by Pillow."""

from __future__ import annotations

import csv
import io
import math
import os
import signal
import subprocess
import time
import xml.etree.ElementTree as ET
import zipfile
from pathlib import Path

import numpy as np
import pytest
from conftest import PROGRAM, design, read_json, run
from PIL import Image

SMALL = """
[target]
kind = "hemi-ellipsoid"
[strips]
count = 6
length_mm = 20.0
hub_radius_mm = 3.0
thickness_mm = 1.0
[materials]
phases = ["FLX9070", "FLX9095"]
[voxels]
size_mm = 0.5
pattern = "{pattern}"
[decks]
write = []
[fabrication]
"""
SOFT, STIFF = 1, 2


def made(folder: Path, settings: str, *kinds: str, pattern: str = "one-edge", name: str = "test") -> tuple[Path, dict]:
    """A small design with `[fabrication]` settings, and the record of what was made."""
    out = design(SMALL.format(pattern=pattern) + settings, folder, name)
    result = run("fabricate", out, *(f"--only={kind}" for kind in kinds))
    assert result.code == 0, result.err
    return out, read_json(out / "fabrication" / "fabrication.json")


def pixels(image: Image.Image, entry: dict) -> np.ndarray:
    """Phases (from one, softest first; zero is void) of a picture, by the colours that the record states."""
    rgba = np.asarray(image.convert("RGBA"))
    found = np.full(rgba.shape[:2], 255, dtype=np.uint8)
    found[(rgba == 0).all(axis=2)] = 0
    for value, colour in enumerate(entry["colours_rgba"].values(), start=1):
        found[(rgba == colour).all(axis=2)] = value
    assert found.max() < 255, "a colour that is none of the phases'"
    return found


def stack(out: Path, record: dict) -> tuple[np.ndarray, dict]:
    """All slices of a folder: slice, row, column."""
    entry = record["kinds"]["print_stack"]
    slices = []
    for file in entry["files"]:
        if file.endswith(".png"):
            image = Image.open(out / file)
            assert image.mode == "P" and image.size == (entry["columns"], entry["rows"])
            slices.append(pixels(image, entry))
            dpi = [25400 / pitch for pitch in entry["pitch_um"][:2]]
            assert image.info["dpi"] == pytest.approx(dpi, rel=1e-4)
    assert len(slices) == entry["slices"]
    return np.array(slices), entry


def counts_agree(found: np.ndarray, entry: dict) -> None:
    assert [int((found == value).sum()) for value in (SOFT, STIFF)] == list(entry["voxels"].values())
    assert int((found == 0).sum()) == entry["void"]


def test_a_spoke_at_the_printers_pitch_has_its_size_its_corner_and_its_counts(program: Path, tmp_path: Path) -> None:
    out, record = made(tmp_path, 'printer = "J750"\n', "print_stack", "gcvf")
    found, entry = stack(out, record)
    counts_agree(found, entry)
    document = read_json(out / "design.json")
    profile = document["profile"]
    filled = np.argwhere(found.any(axis=0))
    rows, columns = np.ptp(filled, axis=0) + 1
    # Length, widest place and thickness, from dots per inch, within a pixel.
    assert abs(columns * 25.4 / 600 - 20) <= 25.4 / 600
    widest = 2 * max(document["slices"]["half_width_voxels"]) * 0.5
    assert abs(rows * 25.4 / 300 - widest) <= 25.4 / 300
    assert abs(len(found) * 0.027 - 1) <= 0.027
    assert abs(widest - profile["width_mm"][0]) <= 0.5
    # The broad rim is at the left; one-edge puts soft at negative y, which is the bottom of the picture.
    for picture in found:
        assert (picture[:, 0] > 0).sum() > 2 * (picture[:, -1] > 0).sum()
        middle = picture[:, entry["columns"] // 2]
        middle = middle[middle > 0]
        assert middle[0] == STIFF and middle[-1] == SOFT
    # Voxels of the design, counted at the printer's: shares within what cutting voxels into pixels allows.
    voxels = document["summary"]["voxels"]
    for name, count in voxels.items():
        share = entry["voxels"][name] / sum(entry["voxels"].values())
        assert share == pytest.approx(count / sum(voxels.values()), rel=0.02)

    container = zipfile.ZipFile(out / "fabrication" / "spoke.gcvf")
    assert all(info.date_time == (1980, 1, 1, 0, 0, 0) for info in container.infolist())
    root = ET.fromstring(container.read("ConfigFile.xml"))
    text = {element.tag: element.text for element in root.iter()}
    assert root.tag == "GCVF" and text["Version"] == "2"
    assert (text["XDpi"], text["YDpi"], text["SliceThicknessNanoMeter"]) == ("600", "300", "27000")
    assert (int(text["SliceWidth"]), int(text["SliceHeight"])) == (entry["columns"], entry["rows"])
    assert (text["StartIndex"], int(text["NumberOfSlices"])) == ("0", entry["slices"])
    assert (text["BitDepth"], text["BackGroundMaterialRGBA"]) == ("4", "0 0 0 0")
    for index, picture in enumerate(found):
        image = Image.open(io.BytesIO(container.read(f"{text['ImageFilePrefix']}{index}.png")))
        assert image.mode == "RGBA"
        assert (pixels(image, record["kinds"]["gcvf"]) == picture).all()
    for material, (name, colour) in zip(root.iter("Material"), entry["colours_rgba"].items(), strict=True):
        assert material.findtext("Name") == name
        assert material.findtext("RGBA") == " ".join(map(str, colour))
        assert int(material.findtext("VoxelCount")) == entry["voxels"][name]


def test_a_flower_turns_counter_clockwise_and_slices_rise(program: Path, tmp_path: Path) -> None:
    settings = 'scope = "flower"\nprinter = "custom"\npitch_um = [100.0, 80.0, 120.0]\n'
    out, record = made(tmp_path, settings, "print_stack")
    found, entry = stack(out, record)
    counts_agree(found, entry)
    left, low = entry["origin_mm"][:2]

    def at(picture: np.ndarray, radius: float, azimuth: float) -> int:
        x, y = radius * math.cos(math.radians(azimuth)), radius * math.sin(math.radians(azimuth))
        return picture[entry["rows"] - 1 - int((y - low) / 0.08), int((x - left) / 0.1)]

    for spoke in range(6):
        # Seen from the rim, soft is at the right of spokes 1, 3, 5 and at the left of the others.
        soft = 22 if spoke % 2 == 0 else -22
        assert at(found[0], 13, 60 * spoke + soft) == SOFT
        assert at(found[0], 13, 60 * spoke - soft) == STIFF
        assert at(found[0], 22, 60 * spoke + 30) == 0
    # The level hub belongs to the piece, in the stiffest phase.
    assert at(found[0], 1, 13) == STIFF
    area = (found[0] > 0).sum() * 0.1 * 0.08
    volume = read_json(out / "design.json")["summary"]["volume_mm3"]
    assert area == pytest.approx((6 * volume["spoke_voxels"] + volume["hub"]) / 1.0, rel=0.01)

    # Soft fills the lower face first.
    out, record = made(tmp_path, settings, "print_stack", pattern="through-thickness", name="layers")
    found, entry = stack(out, record)
    shares = [(picture == SOFT).sum() / (picture > 0).sum() for picture in found]
    assert shares[0] > shares[-1] + 0.2, shares


@pytest.mark.parametrize("scope", ["spoke", "flower"])
def test_a_dithered_modulus_has_exact_counts_in_every_cross_section(program: Path, tmp_path: Path, scope: str) -> None:
    settings = f'scope = "{scope}"\nsource = "field"\nprinter = "custom"\npitch_um = [120.0, 90.0, 110.0]\n'
    out, record = made(tmp_path, settings, "print_stack", pattern="random")
    found, entry = stack(out, record)
    counts_agree(found, entry)
    with (out / "fabrication" / "print_stack" / "cross_sections.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    for row in rows:
        for phase in entry["voxels"]:
            assert abs(float(row[f"target_{phase}"]) - int(row[f"count_{phase}"])) <= 0.5 + 1e-6
    if scope == "flower":
        assert len(rows) == 6 * math.ceil(20 / 0.12)
        return
    # Along a single spoke a cross-section is a column of all slices; its target follows from the profile.
    assert len(rows) == entry["columns"]
    profile = read_json(out / "design.json")["profile"]
    for column, row in enumerate(rows):
        cut = found[:, :, column]
        assert int((cut > 0).sum()) == int(row["voxels"])
        assert int((cut == STIFF).sum()) == int(row["count_FLX9095"])
        s = entry["origin_mm"][0] + (column + 0.5) * 0.12
        width, modulus = (np.interp(s, profile["s_mm"], profile[key]) for key in ("width_mm", "modulus_mpa"))
        drawn = int((cut > 0).sum()) / entry["slices"] * 0.09
        share = min(max((modulus * width / drawn - 3.1) / (12.6 - 3.1), 0), 1)
        # Interpolating the profile is good to a few parts in a hundred thousand.
        assert int((cut == STIFF).sum()) == pytest.approx(share * (cut > 0).sum(), abs=0.5 + 2e-4 * (cut > 0).sum())


def test_the_same_design_gives_the_same_stacks(program: Path, tmp_path: Path) -> None:
    settings = 'source = "field"\nprinter = "custom"\npitch_um = [150.0, 150.0, 150.0]\n'
    first, record = made(tmp_path, settings, "print_stack", "gcvf", name="one")
    again = tmp_path / "copy"
    again.mkdir()
    (again / "design.json").write_bytes((first / "design.json").read_bytes())
    assert run("fabricate", again, "--only=print_stack,gcvf").code == 0
    for file in [*record["files"], "fabrication/fabrication.json"]:
        assert (again / file).read_bytes() == (first / file).read_bytes(), file


def test_design_makes_what_it_is_asked_for_and_the_next_one_clears_it_away(program: Path, tmp_path: Path) -> None:
    settings = 'printer = "custom"\npitch_um = [200.0, 200.0, 200.0]\n'
    out = design(SMALL.format(pattern="random") + settings + 'write = ["print_stack", "dxf"]\n', tmp_path)
    record = read_json(out / "fabrication" / "fabrication.json")
    assert list(record["kinds"]) == ["print_stack", "dxf"]
    files = read_json(out / "design.json")["files"]
    assert {*record["files"], "fabrication/fabrication.json"} <= set(files)
    assert all((out / file).is_file() for file in files)
    page = (out / "report.html").read_text(encoding="utf-8")
    assert "Print slices" in page and "data:image/png;base64," in page
    ET.fromstring(page.replace("<!DOCTYPE html>", ""))
    # Another kind later: what is there stays.
    (out / "fabrication" / "print_stack" / "mine.txt").write_text("mine", encoding="utf-8")
    assert run("fabricate", out, "--only=svg").code == 0
    record = read_json(out / "fabrication" / "fabrication.json")
    assert list(record["kinds"]) == ["print_stack", "dxf", "svg"]
    assert all((out / file).is_file() for file in record["files"])
    # A new stack replaces the old one as a whole, but for what is not ours.
    assert run("fabricate", out, "--only=print_stack").code == 0
    assert (out / "fabrication" / "print_stack" / "mine.txt").exists()
    # Another design: its predecessor's files go, strangers stay.
    design(SMALL.format(pattern="random").replace("length_mm = 20.0", "length_mm = 22.0") + settings, tmp_path)
    left = [str(p.relative_to(out / "fabrication")) for p in (out / "fabrication").rglob("*") if p.is_file()]
    assert left == ["print_stack/mine.txt"]


def test_what_is_wrong_or_too_much_is_refused_before_anything_is_written(program: Path, tmp_path: Path) -> None:
    def refused(settings: str, *words: str, kinds: tuple[str, ...] = ("print_stack",), code: int = 2) -> None:
        out = design(SMALL.format(pattern="random") + settings, tmp_path)
        result = run("fabricate", out, *(f"--only={kind}" for kind in kinds))
        assert result.code == code, (result.code, result.err)
        for word in words:
            assert word in result.err, (word, result.err)
        assert not (out / "fabrication").exists()

    fine = 'printer = "custom"\npitch_um = [1.0, 1.0, 1.0]\n'
    refused(fine, "fabrication.printer", "voxels of 1 x 1 x 1 um", "limit", "--yes")
    refused(fine, "--yes", kinds=("gcvf",))
    for bad, words in [
        ('printer = "custom"\n', ["fabrication.pitch_um", "needs its pitch"]),
        ('printer = "custom"\npitch_um = [0.5, 10.0, 10.0]\n', ["fabrication.pitch_um.0", "at least 1 um"]),
        ("pitch_um = [50.0, 50.0, 50.0]\n", ["fabrication.pitch_um", "custom"]),
        ('printer = "J570"\n', ["fabrication.printer", '"J750"']),
        ('write = ["print_stak"]\n', ["fabrication.write.0", '"print_stack"']),
        ("kerf = 0.1\n", ["fabrication.kerf", '"kerf_mm"']),
    ]:
        file = tmp_path / "bad.toml"
        file.write_text(SMALL.format(pattern="random") + bad, encoding="utf-8")
        result = run("design", file, "-o", tmp_path / "bad")
        assert result.code == 2 and all(word in result.err for word in words), result.err
    assert run("fabricate", tmp_path).code == 2
    assert run("fabricate", tmp_path, "--only=pizza").code == 2


def test_a_full_disk_leaves_nothing_behind(program: Path, tmp_path: Path) -> None:
    if os.geteuid() != 0:
        pytest.skip("only root can mount a small disk")
    disk = tmp_path / "disk"
    disk.mkdir()
    command = ["mount", "-t", "tmpfs", "-o", "size=2m", "tmpfs", str(disk)]
    if subprocess.run(command, check=False, capture_output=True).returncode != 0:
        pytest.skip("a tmpfs cannot be mounted here")
    try:
        out = design(SMALL.format(pattern="random") + 'scope = "flower"\nsource = "field"\n', tmp_path)
        (disk / "design.json").write_bytes((out / "design.json").read_bytes())
        for kind in ["print_stack", "gcvf"]:
            foreseen = run("fabricate", disk, f"--only={kind}")
            assert foreseen.code == 5 and "MB" in foreseen.err and "--yes" in foreseen.err
            insisted = run("fabricate", disk, f"--only={kind}", "--yes")
            assert insisted.code == 5 and "disk is full" in insisted.err, insisted.err
            assert [p.name for p in disk.rglob("*")] == ["design.json"]
    finally:
        subprocess.run(["umount", str(disk)], check=True)


def test_an_interrupt_leaves_nothing_behind(program: Path, tmp_path: Path) -> None:
    text = SMALL.format(pattern="random").replace("length_mm = 20.0", "length_mm = 60.0")
    out = design(text + 'scope = "flower"\nsource = "field"\nprinter = "Objet260"\n', tmp_path)
    process = subprocess.Popen(
        [PROGRAM, "fabricate", out, "--only=print_stack"], stderr=subprocess.PIPE, text=True, stdout=subprocess.DEVNULL
    )
    deadline = time.monotonic() + 60
    while not list(out.rglob("*.png")) and process.poll() is None and time.monotonic() < deadline:
        time.sleep(0.01)
    process.send_signal(signal.SIGINT)
    _, err = process.communicate(timeout=60)
    assert process.returncode == 130, err
    assert "cancelled" in err
    assert not (out / "fabrication").exists()
