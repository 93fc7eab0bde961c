"""Settings of the workflow, and how many jobs a sweep becomes."""

from __future__ import annotations

import json
import math
import shutil
import sys
import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

#: More jobs than that are a burden to a scheduler.
MOST_BATCHES = 1000
#: Points a second: a job of a minute is the least that a scheduler should be asked for, so quick points come in large batches.
LEAST_SECONDS = 1e-4


@dataclass(frozen=True)
class Settings:
    """What `--config` and `--configfile` may say; see docs/cluster.md."""

    sweep: Path
    output: Path
    program: str
    threads: int
    batch_minutes: float
    batches: int
    runtime_minutes: int
    memory_mb: int
    ccx: str
    abaqus: str
    abaqus_deck: str
    tokens_per_job: int
    is_external: bool

    @classmethod
    def of(cls, config: dict[str, Any]) -> Settings:
        """Reads and checks the settings; ends with a message where one is wrong."""
        known = {
            "sweep": "",
            "output": "",
            "program": "voxelastica",
            "threads": 1,
            "batch_minutes": 15.0,
            "batches": 0,
            "runtime_minutes": 120,
            "memory_mb": 4000,
            "ccx": "ccx",
            "abaqus": "abaqus",
            "abaqus_deck": "graded_shell",
            "tokens_per_job": 5,
        }
        for key in config:
            if key not in known:
                stop(f"config: {key} is no setting; there are {', '.join(known)}")
        values = {**known, **config}
        for key, value in known.items():
            if isinstance(value, (int, float)):
                try:
                    values[key] = type(value)(values[key])
                except (TypeError, ValueError):
                    stop(f"config: {key} = {values[key]} is not a number")
                if values[key] < 0 or (values[key] == 0 and key not in ("batches", "tokens_per_job")):
                    stop(f"config: {key} = {values[key]} must be greater than 0")
        if not values["sweep"]:
            stop("config: sweep is missing; give --config sweep=SWEEP.toml")
        sweep = Path(values["sweep"])
        try:
            text = sweep.read_text(encoding="utf-8")
            table = json.loads(text) if sweep.suffix == ".json" else tomllib.loads(text)
        except OSError as error:
            stop(f"config: sweep = {sweep}: {error.strerror}")
        except ValueError as error:
            stop(f"{sweep}: {error}")
        if shutil.which(values["program"]) is None:
            stop(f"config: program = {values['program']} is not there; give its path with --config program=PATH")
        values["sweep"] = sweep
        values["output"] = Path(values["output"] or Path("out") / str(table.get("name") or sweep.stem))
        values["is_external"] = table.get("model") == "external"
        return cls(**values)


def require_scheduler(executor: Any) -> None:
    """Ends with a message where jobs are to go to Slurm and its commands are not there."""
    if getattr(executor, "name", None) == "slurm":
        missing = [name for name in ("sbatch", "squeue", "scancel") if shutil.which(name) is None]
        if missing:
            stop(
                f"the profile sends jobs to Slurm, but {', '.join(missing)} cannot be found; run this on a login node of the "
                "cluster, or use --profile workflow/profiles/local. What is computed already is kept"
            )


def batch_count(plan: str | Path, settings: Settings) -> int:
    """Jobs of a sweep: as many as make each take `batch_minutes` on its threads, or the number that is asked for."""
    with open(plan, encoding="utf-8") as file:
        planned = json.load(file)
    points = int(planned["points"])
    if settings.batches:
        return min(settings.batches, max(points, 1))
    seconds = points * max(float(planned["seconds_per_point"]), LEAST_SECONDS) / settings.threads
    return max(1, min(math.ceil(seconds / (60.0 * settings.batch_minutes)), points, MOST_BATCHES))


def stop(message: str) -> None:
    """Ends with a message instead of a traceback."""
    sys.exit(f"error: {message}")
