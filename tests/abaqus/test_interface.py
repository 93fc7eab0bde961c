"""The scripts against the interface: pyright with abqpy's stubs, the syntax of Python 2.7, the stand-in in both Pythons."""

from __future__ import annotations

import ast
import json
import re
import shutil
import subprocess
from pathlib import Path

import pytest

from .recording import SCRIPTS, Recorder

#: A mistake a script might hold: file, what stands there, what stands there instead, and whether pyright must see it
#: too. It does not see into calls on objects whose class it cannot know.
MUTATIONS = [
    ("voxel_strip.py", "part.BaseSolidExtrude(", "part.BaseSolidExtrud(", True),
    ("voxel_strip.py", "cells.getByBoundingBox", "cells.getByBoundingBx", True),
    ("voxel_strip.py", "xMin=x[0] * edge", "xmin=x[0] * edge", True),
    ("voxel_strip.py", "datumPlane=part.datums", "plane=part.datums", True),
    ("voxel_strip.py", "technique=STRUCTURED", "technique=HEX", True),
    ("voxel_strip.py", "import CARTESIAN,", "import CARTESIAN, CARTESAIN,", True),
    ("voxel_strip.py", "depth=design.thickness", "depth=str(design.thickness)", True),
    ("voxel_strip.py", "part.generateMesh()", "part.generateMesh(1, 2, 3, 4, 5, 6)", True),
    ("materials.py", "temperatureDependency=ON, table=elastic", "temperatureDependancy=ON, table=elastic", True),
    ("materials.py", "hourglassControl=ENHANCED", "hourglasControl=ENHANCED", True),
    ("morph.py", "nlgeom=ON", "nlGeom=ON", True),
    ("morph.py", "amplitude=motion.amplitude", "amplitud=motion.amplitude", True),
    ("ends.py", "refPointRegion=sets", "referenceRegion=sets", True),
    ("build.py", "numCpus=options.cores", "cpus=options.cores", False),
    ("shell_flower.py", "expression=design.expression", "expresion=design.expression", False),
    ("shell_flower.py", "model.Equation(", "model.Equations(", True),
    ("shell_flower.py", "magnitudes=(magnitude,)", "magnitude=(magnitude,)", True),
    ("shell_flower.py", "part.setSweepPath(", "part.setSweepPaths(", True),
    ("shell_flower.py", "orientationType=SYSTEM", "orientationType=SWEEP", True),
]


def mutant(folder: Path, file: str, old: str, new: str) -> Path:
    """A copy of the scripts with one mistake."""
    shutil.copytree(SCRIPTS, folder, ignore=shutil.ignore_patterns("__pycache__"))
    path = folder / "voxelastica_cae" / file
    text = path.read_text(encoding="utf-8")
    assert text.count(old) >= 1, f"{file} has no {old}"
    path.write_text(text.replace(old, new), encoding="utf-8")
    return folder


def pyright(tools: Path, project: Path) -> list[dict]:
    """Errors that pyright finds."""
    command = [tools / "pyright", "--outputjson", "-p", project]
    done = subprocess.run(command, check=False, capture_output=True, text=True, timeout=600)
    report = json.loads(done.stdout)
    assert report["summary"]["filesAnalyzed"] >= 10, done.stdout[:2000]
    return [found for found in report["generalDiagnostics"] if found["severity"] == "error"]


def test_pyright_finds_nothing(tools: Path) -> None:
    found = pyright(tools, SCRIPTS.parent)
    assert not found, "\n".join(f"{f['file']}:{f['range']['start']['line'] + 1}: {f['message'][:300]}" for f in found)


def test_pyright_finds_mistakes(tools: Path, site: Path, tmp_path: Path) -> None:
    """Every mistake in a copy of its own, all copies in one run."""
    for i, (file, old, new, _) in enumerate(MUTATIONS):
        mutant(tmp_path / f"m{i}", file, old, new)
    settings = json.loads((SCRIPTS.parent / "pyrightconfig.json").read_text(encoding="utf-8"))
    venv = site.parent.parent.parent
    files = [f"m{i}/voxelastica_cae/{mutation[0]}" for i, mutation in enumerate(MUTATIONS)]
    settings |= {"include": files, "venvPath": str(venv.parent), "venv": venv.name}
    (tmp_path / "pyrightconfig.json").write_text(json.dumps(settings), encoding="utf-8")
    found = {Path(f["file"]).relative_to(tmp_path).parts[0] for f in pyright(tools, tmp_path)}
    missed = [MUTATIONS[i][:3] for i in range(len(MUTATIONS)) if MUTATIONS[i][3] and f"m{i}" not in found]
    assert not missed, missed


@pytest.mark.parametrize(("file", "old", "new"), [m[:3] for m in MUTATIONS], ids=[m[2][:30] for m in MUTATIONS])
def test_the_stand_in_finds_mistakes(
    record: Recorder, designs: dict[str, Path], tmp_path: Path, file: str, old: str, new: str
) -> None:
    scripts = mutant(tmp_path / "scripts", file, old, new)
    path = str(designs["held"] / "design.json")
    run = record(
        {"do": "build", "design": path, "options": {"kind": "geometry"}},
        {"do": "build", "design": path, "options": {"kind": "shell"}},
        scripts=scripts,
    )
    errors = [action["error"] for action in run.actions if "error" in action]
    assert errors and re.match("(Strict|TypeError|ImportError|AttributeError)", errors[0]), errors


def test_no_mistake_no_error(record: Recorder, designs: dict[str, Path]) -> None:
    """What the mutations start from is right."""
    assert record.build(designs["held"], "geometry") and record.build(designs["held"], "shell")


def test_the_syntax_is_that_of_python_27(tools: Path) -> None:
    command = [tools / "vermin", "-t=2.7-", "-t=3.10-", "--violations", "--no-tips", SCRIPTS]
    done = subprocess.run(command, check=False, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout
    assert "Minimum required versions: 2.7" in done.stdout, done.stdout


def test_vermin_finds_newer_syntax(tools: Path, tmp_path: Path) -> None:
    (tmp_path / "new.py").write_text('a = 1\nprint(f"{a}")\n', encoding="utf-8")
    command = [tools / "vermin", "-t=2.7-", "-t=3.10-", "--violations", "--no-tips", tmp_path]
    assert subprocess.run(command, check=False, capture_output=True).returncode != 0


@pytest.mark.parametrize("name", ["hemisphere", "three_phases", "held", "odd", "through"])
def test_both_pythons_record_the_same(
    record: Recorder, record27: Recorder, designs: dict[str, Path], name: str
) -> None:
    path = str(designs[name] / "design.json")
    kinds = ["mesh", "shell"] + (["geometry"] if name != "three_phases" else [])
    actions = [{"do": "build", "design": path, "options": {"kind": kind}} for kind in kinds]
    three, two = record(*actions), record27(*actions)
    assert not [a["error"] for a in three.actions if "error" in a]
    assert len(three.calls) > 100
    assert two.calls == three.calls
    assert two.sizes == three.sizes
    assert two.out == three.out


def test_both_pythons_load_the_plug_in_alike(record: Recorder, record27: Recorder) -> None:
    action = {"do": "plugin", "script": str(SCRIPTS / "voxelastica_plugin.py")}
    three, two = record(action), record27(action)
    assert "error" not in three.actions[0] and len(three.calls) > 60
    assert two.calls == three.calls


def test_scripts_stand_on_the_standard_library_and_abaqus_alone() -> None:
    """No import of anything else, no path, no unicode."""
    allowed = {"abaqus", "abaqusConstants", "abaqusGui", "mesh", "odbAccess", "voxelastica_cae", "typing"}
    allowed |= {"__future__", "argparse", "inspect", "io", "json", "math", "os", "sys"}
    for path in SCRIPTS.rglob("*.py"):
        text = path.read_text(encoding="ascii")
        for node in ast.walk(ast.parse(text)):
            names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
            if isinstance(node, ast.ImportFrom) and not node.level:
                names = [node.module or ""]
            for name in names:
                assert name.split(".")[0] in allowed, f"{path.name} imports {name}"
        assert not re.search(r"[\"'](?:/(?:home|usr|tmp|opt)|[A-Z]:\\)", text), path
