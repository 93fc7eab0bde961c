"""Materials, sections and element types of a design."""

from __future__ import division

from abaqusConstants import (
    C3D8,
    C3D8I,
    C3D8R,
    ENHANCED,
    MIDDLE_SURFACE,
    ON,
    S4,
    S4R,
    STANDARD,
)
from mesh import ElemType

from . import VoxelasticaError

TYPE_CHECKING = False
if TYPE_CHECKING:  # type comments only: ABAQUS has no such modules
    from typing import Any  # novm

    from abaqus.Mesh.ElemType import ElemType
    from abaqus.Model.Model import Model
    from abaqus.Part.Part import Part

    from .design import Design

_CODES = {"C3D8R": C3D8R, "C3D8I": C3D8I, "C3D8": C3D8, "S4R": S4R, "S4": S4}

#: Simpson points through a shell's thickness, as in the decks.
SHELL_POINTS = 5


def density(phase):
    # type: (dict) -> float | None
    """Density in tonne/mm^3, or None where the phase has none."""
    value = phase.get("density_kg_m3")
    return None if value is None else float(value) * 1e-12


def plain(model, name, modulus, poisson, rho):
    # type: (Model, str, float, float, float | None) -> None
    """A material that depends on nothing: modulus in MPa, density in tonne/mm^3 or None."""
    material = model.Material(name=name)
    material.Elastic(table=((modulus, poisson),))
    if rho is not None:
        material.Density(table=((rho,),))


def phase(model, of):
    # type: (Model, dict) -> str
    """The material of a phase; returns its name."""
    plain(model, of["material"], float(of["modulus_mpa"]), float(of["poisson"]), density(of))
    return of["material"]


def graded(model, design, name):
    # type: (Model, Design, str) -> None
    """A material whose modulus is the temperature itself.

    CAE has predefined fields of temperature but none of field variables, so the temperature carries the modulus in MPa;
    nothing expands. The table's rows are the design's; between them everything is linear, so that it is exact.
    """
    rows = design.rows
    material = model.Material(name=name, description="The temperature is the modulus in MPa")
    elastic = tuple((row["modulus_mpa"], row["poisson"], row["modulus_mpa"]) for row in rows)
    material.Elastic(temperatureDependency=ON, table=elastic)
    if all(row["density_tonne_mm3"] is not None for row in rows):
        densities = tuple((row["density_tonne_mm3"], row["modulus_mpa"]) for row in rows)
        material.Density(temperatureDependency=ON, table=densities)


def solid_element(design, layers):
    # type: (Design, int) -> str
    """Element type of a solid with this many layers of elements.

    One integration point an element and fewer than four layers would have no bending stiffness: C3D8I then.
    """
    code = design.decks["solid_element"]
    return "C3D8I" if code == "C3D8R" and layers < 4 else code


def element_type(code):
    # type: (str) -> ElemType
    """The type as setElementType takes it, with enhanced control of the hourglass modes where it has any."""
    if code not in _CODES:
        raise VoxelasticaError("decks: element %s is not known here; use %s" % (code, ", ".join(sorted(_CODES))))
    element = _CODES[code]  # type: Any
    if code in ("C3D8R", "S4R"):
        return ElemType(elemCode=element, elemLibrary=STANDARD, hourglassControl=ENHANCED)
    return ElemType(elemCode=element, elemLibrary=STANDARD)


def solid_section(model, part, set_name, material):
    # type: (Model, Part, str, str) -> None
    """One solid section and one assignment for all cells of a set of the part."""
    model.HomogeneousSolidSection(name=set_name, material=material)
    part.SectionAssignment(region=part.sets[set_name], sectionName=set_name)


def shell_section(model, part, set_name, section, material, thickness):
    # type: (Model, Part, str, str, str, float) -> None
    """One shell section and one assignment for all faces of a set of the part."""
    model.HomogeneousShellSection(name=section, material=material, thickness=thickness, numIntPts=SHELL_POINTS)
    part.SectionAssignment(region=part.sets[set_name], sectionName=section, offsetType=MIDDLE_SURFACE)
