"""Recordings of the plug-in's scripts on the stand-in, and what they say of the model that CAE would hold."""

from __future__ import annotations

import json
import math
import subprocess
from dataclasses import dataclass
from pathlib import Path

HERE = Path(__file__).resolve().parent
SCRIPTS = HERE.parent.parent / "abaqus_scripts" / "voxelastica"
COMPONENTS = ("u1", "u2", "u3", "ur1", "ur2", "ur3")


@dataclass
class Run:
    """What a scenario recorded: one entry an action, sizes of all sets at the end, what was printed."""

    actions: list[dict]
    sizes: dict[str, tuple[str, int]]
    out: str

    @property
    def calls(self) -> list:
        """All calls in order: [path, arguments]."""
        return [call for action in self.actions for call in action["calls"]]


@dataclass
class Recorder:
    """Runs scenarios on the stand-in in one Python."""

    table: Path
    python: str
    folder: Path
    scripts: Path
    count: int = 0

    def __call__(self, *actions: dict, replies: list | None = None, scripts: Path | None = None) -> Run:
        """Runs a scenario; raises where the stand-in itself cannot be started."""
        self.count += 1
        plan, out = self.folder / f"{self.count}.json", self.folder / f"{self.count}-out.json"
        content = {"scripts": str(scripts or self.scripts), "actions": list(actions), "replies": replies or []}
        plan.write_text(json.dumps(content), encoding="utf-8")
        command = [self.python, "-B", str(HERE / "run_fake.py"), str(self.table), str(plan), str(out)]
        done = subprocess.run(command, check=False, capture_output=True, text=True, timeout=600, cwd=self.folder)
        if done.returncode:
            raise RuntimeError(done.stderr[-3000:])
        found = json.loads(out.read_text(encoding="utf-8"))
        return Run(found["actions"], {k: tuple(v) for k, v in found["sizes"].items()}, done.stdout)

    def build(self, folder: Path, kind: str, **options: object) -> Model:
        """Builds a design's model; fails where it was refused."""
        run = self({"do": "build", "design": str(folder / "design.json"), "options": {"kind": kind, **options}})
        assert "error" not in run.actions[0], run.actions[0]["error"]
        return Model(run, run.actions[0]["result"])


@dataclass
class Model:
    """The model that a recording describes."""

    run: Run
    name: str

    def called(self, method: str) -> list[dict]:
        """Arguments of all calls of a method, in order."""
        return [arguments for path, arguments in self.run.calls if path.rsplit(".", 1)[-1] == method]

    def count(self, method: str) -> int:
        return len(self.called(method))

    def sets(self, owner: str) -> dict[str, tuple[str, int]]:
        """Kind and number of members of the sets of "rootAssembly" or of a part, by name."""
        found = {}
        for key, size in self.run.sizes.items():
            model, of, name = key.split("|")
            if model == self.name and of in (owner, f"parts['{owner}']"):
                found[name] = size
        return found

    def boundary_values(self) -> dict[tuple[str, int], tuple[float, str | None]]:
        """Value at the end and amplitude of every prescribed degree of freedom, by set and number."""
        found = {}
        for of in self.called("DisplacementBC"):
            name = of["region"].split("sets['")[1].rstrip("']")
            for dof, component in enumerate(COMPONENTS, 1):
                if of[component] != "UNSET" if component in of else False:
                    assert (name, dof) not in found, f"{name} {dof} is prescribed twice"
                    found[name, dof] = (float(of[component]), of.get("amplitude"))
        return found

    def amplitudes(self) -> dict[str, list[tuple[float, float]]]:
        return {of["name"]: [(float(t), float(v)) for t, v in of["data"]] for of in self.called("TabularAmplitude")}

    def systems(self) -> dict[str, tuple[tuple[float, ...], tuple[float, float]]]:
        """Origin and direction of X of the assembly's datum systems, by the path of their datum."""
        found = {}
        for action in self.run.actions:
            made = [call for call in action["calls"] if "rootAssembly" in call[0]]
            number = 0
            for path, of in made:
                method = path.rsplit(".", 1)[-1]
                # Features of the assembly count on: systems and reference points.
                number += method in ("DatumCsysByThreePoints", "DatumCsysByDefault", "ReferencePoint")
                if method != "DatumCsysByThreePoints":
                    continue
                origin, along = ([float(v) for v in of[key]] for key in ("origin", "point1"))
                length = math.dist(origin, along)
                direction = tuple((b - a) / length for a, b in zip(origin, along, strict=True))
                found[f"{path.rsplit('.', 1)[0]}.datums[{number}]"] = (tuple(origin), direction[:2])
        return found
