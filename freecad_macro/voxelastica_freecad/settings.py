# SPDX-License-Identifier: MIT OR Apache-2.0
"""What is to be built, from a panel or from environment variables."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping

PARTS = ("flat", "morphed", "phases", "analysis")
EXPORTS = ("fcstd", "step", "stl")
PHASES = ("meshes", "bodies")
MODELS = ("graded", "voxel")

#: Modulus bands of the analysis unless said otherwise.
BANDS = 12


class MacroError(Exception):
    """What the user can put right. ``code`` is the exit code without a window: 2 wrong input, 4 solver, 5 output."""

    def __init__(self, message: str, code: int = 2) -> None:
        super().__init__(message)
        self.code = code


@dataclass
class Settings:
    """What is to be built.

    :ivar design: design file (TOML or JSON), ``design.json``, or the folder that holds one
    :ivar folder: where exports and the solver's files go; needed for both
    :ivar parts: some of :data:`PARTS`
    :ivar fraction: fraction of the morph of the shell, 0 flat, 1 closed
    :ivar phases: ``"meshes"`` (exact surfaces of any number of voxels) or ``"bodies"`` (solids of some thousand)
    :ivar model: strip of the analysis, ``"graded"`` or ``"voxel"``
    :ivar bands: modulus bands of the graded strip; 0 keeps the nodal field of the deck
    :ivar solve: whether the analysis is solved at once
    :ivar export: some of :data:`EXPORTS`
    :ivar document: name of an open document; empty makes a new one
    :ivar replace: whether an earlier tree of the same name is replaced
    :ivar ccx: the CalculiX program; empty lets FreeCAD find it
    """

    design: str
    folder: str = ""
    parts: tuple[str, ...] = PARTS
    fraction: float = 1.0
    phases: str = "meshes"
    model: str = "graded"
    bands: int = BANDS
    solve: bool = False
    export: tuple[str, ...] = field(default_factory=tuple)
    document: str = ""
    replace: bool = False
    ccx: str = ""

    def check(self) -> None:
        """Raises :class:`MacroError` for a setting that does not exist, naming it, its value and what would help."""
        if not self.design:
            raise MacroError("VOXELASTICA_DESIGN is empty: name a design file, a design.json or its folder")
        _among("VOXELASTICA_PARTS", self.parts, PARTS)
        _among("VOXELASTICA_EXPORT", self.export, EXPORTS)
        _among("VOXELASTICA_PHASES", (self.phases,), PHASES)
        _among("VOXELASTICA_MODEL", (self.model,), MODELS)
        if not 0.0 <= self.fraction <= 1.0:
            raise MacroError(f"VOXELASTICA_FRACTION = {self.fraction}: it must be between 0 (flat) and 1 (closed)")
        if not 0 <= self.bands <= 200:
            raise MacroError(f"VOXELASTICA_BANDS = {self.bands}: it must be between 0 (nodal field) and 200")
        if self.solve and "analysis" not in self.parts:
            raise MacroError("VOXELASTICA_SOLVE = 1 needs analysis among VOXELASTICA_PARTS")
        if (self.export or self.solve) and not self.folder:
            raise MacroError("VOXELASTICA_FOLDER is empty: name the folder for exports and the solver's files")

    @classmethod
    def from_environment(cls, environment: Mapping[str, str]) -> Settings:
        """Settings of ``VOXELASTICA_DESIGN``, ``_FOLDER``, ``_PARTS``, ``_FRACTION``, ``_PHASES``, ``_MODEL``, ``_BANDS``,
        ``_SOLVE``, ``_EXPORT``, ``_DOCUMENT``, ``_REPLACE`` and ``_CCX``; lists are separated by commas."""

        def text(name: str, default: str = "") -> str:
            return environment.get(f"VOXELASTICA_{name}", "").strip() or default

        def words(name: str, default: tuple[str, ...]) -> tuple[str, ...]:
            value = text(name)
            if value == "none":
                return ()
            return tuple(word.strip() for word in value.split(",") if word.strip()) if value else default

        def number(name: str, kind: type, default: float) -> float:
            value = text(name, str(default))
            try:
                return kind(value)
            except ValueError:
                raise MacroError(f"VOXELASTICA_{name} = {value}: it must be a number") from None

        def flag(name: str) -> bool:
            value = text(name, "0")
            if value not in ("0", "1"):
                raise MacroError(f"VOXELASTICA_{name} = {value}: it must be 0 or 1")
            return value == "1"

        settings = cls(
            design=text("DESIGN"),
            folder=text("FOLDER"),
            parts=words("PARTS", PARTS),
            fraction=number("FRACTION", float, 1.0),
            phases=text("PHASES", "meshes"),
            model=text("MODEL", "graded"),
            bands=int(number("BANDS", int, BANDS)),
            solve=flag("SOLVE"),
            export=words("EXPORT", ()),
            document=text("DOCUMENT"),
            replace=flag("REPLACE"),
            ccx=text("CCX"),
        )
        settings.check()
        return settings


def _among(name: str, values: tuple[str, ...], known: tuple[str, ...]) -> None:
    for value in values:
        if value not in known:
            raise MacroError(f"{name} = {value}: known are {', '.join(known)}")
