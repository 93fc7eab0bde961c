"""FreeCAD hosts: the system's, and one in a chroot. A missing one is a counted skip."""

from __future__ import annotations

import json
import os
import shlex
import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path

import pytest
from conftest import ROOT, Result

MACRO = ROOT / "freecad_macro"
FACTS = Path(__file__).parent / "facts.py"
CHROOT = Path(os.environ.get("VOXELASTICA_FREECAD_CHROOT", ROOT / ".freecad-1.0"))


@dataclass
class Host:
    """A FreeCAD."""

    version: str
    chroot: Path | None
    home: Path

    def run(
        self,
        script: Path,
        timeout: float = 900,
        prefix: tuple[str, ...] = (),
        window: bool = False,
        **variables: object,
    ) -> Result:
        """Runs a script with environment variables, in a window if so asked, and returns what it said."""
        environment = {
            "PATH": "/usr/local/bin:/usr/bin:/bin",
            "HOME": str(self.home),
            "VOXELASTICA_MACRO": str(MACRO),
            "VOXELASTICA_LIBRARY": str(ROOT / "target" / "release" / "libvoxelastica.so"),
            "OMP_NUM_THREADS": "2",
            **{name: str(value) for name, value in variables.items()},
        }
        command = [*prefix, "freecad" if window else "freecadcmd", str(script)]
        if self.chroot is not None:
            inner = " ".join(map(shlex.quote, command))
            steps = [f"mount -t proc proc {self.chroot}/proc"]
            for place in (ROOT, self.home):
                steps += [f"mkdir -p {self.chroot}{place}", f"mount --bind {place} {self.chroot}{place}"]
            if window:
                display = "/tmp/.X11-unix"
                steps += [f"mkdir -p {self.chroot}{display}", f"mount --bind {display} {self.chroot}{display}"]
            steps.append(f"exec chroot {self.chroot} {inner}")
            command = ["unshare", "--mount", "sh", "-ec", "; ".join(steps)]
            # The mounts need the system's own programs.
            environment["PATH"] = "/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin"
        if window:
            environment.update(QTWEBENGINE_DISABLE_SANDBOX="1", LIBGL_ALWAYS_SOFTWARE="1")
            command = ["xvfb-run", "-a", "-s", "-screen 0 1400x950x24 -ac", *command]
        done = subprocess.run(
            command,
            check=False,
            capture_output=True,
            text=True,
            errors="replace",
            timeout=timeout,
            stdin=subprocess.DEVNULL,
            env=environment,
        )
        return Result(done.returncode, done.stdout, done.stderr)

    def facts(self, folder: Path, **variables: object) -> dict:
        """Builds a design as the variables say and returns what came out."""
        file = folder / "facts.json"
        result = self.run(FACTS, VOXELASTICA_FACTS=file, VOXELASTICA_FOLDER=folder, **variables)
        assert result.code == 0, result.out[-3000:] + result.err[-3000:]
        return json.loads(file.read_text(encoding="utf-8"))


@pytest.fixture(scope="session", params=["0.20", "1.0"])
def host(request: pytest.FixtureRequest, program: Path, tmp_path_factory: pytest.TempPathFactory) -> Host:
    """Every FreeCAD there is."""
    return found(request.param, tmp_path_factory)


@pytest.fixture(scope="session")
def system(program: Path, tmp_path_factory: pytest.TempPathFactory) -> Host:
    """The system's FreeCAD."""
    return found("0.20", tmp_path_factory)


def found(version: str, tmp_path_factory: pytest.TempPathFactory) -> Host:
    # The chroot sees what is below this folder.
    home = tmp_path_factory.getbasetemp()
    if version == "1.0":
        if not (CHROOT / "usr/bin/freecadcmd").exists():
            pytest.skip(f"FreeCAD 1.0 is not in {CHROOT}: scripts/setup-freecad-1.0, or VOXELASTICA_FREECAD_CHROOT")
        if os.geteuid() != 0 or not shutil.which("unshare"):
            pytest.skip("FreeCAD 1.0 in a chroot needs root and unshare")
        return Host(version, CHROOT, home)
    if not shutil.which("freecadcmd"):
        pytest.skip("freecadcmd is not installed: scripts/setup-freecad")
    return Host(version, None, home)
