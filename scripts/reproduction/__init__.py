"""The paper beside what this project computes: one module a subject, each giving a section of docs/reproduction.md."""

from . import aspect_ratio, cells, conduction, counts, errata, indentation, materials, patterns, phases, shapes, strips

SECTIONS = {
    "materials": materials.section,
    "cells": cells.section,
    "strips": strips.section,
    "patterns": patterns.section,
    "shapes": shapes.section,
    "phases": phases.section,
    "counts": counts.section,
    "indentation": indentation.section,
    "aspect_ratio": aspect_ratio.section,
    "conduction": conduction.section,
    "errata": errata.section,
}
