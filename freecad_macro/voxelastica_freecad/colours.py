# SPDX-License-Identifier: MIT OR Apache-2.0
"""Colours from soft (light) to stiff (dark), those of the report."""

from __future__ import annotations

_RAMP = ("f6e055", "b5d945", "5ec366", "28a880", "218f8c", "2c728e", "3b528b", "462f7c", "3d044e")
#: The flat sheet, whose colour says nothing.
SHEET = (0.702, 0.796, 0.910)
#: The hub.
HUB = (0.227, 0.271, 0.333)


def ramp(share: float) -> tuple[float, float, float]:
    """Red, green and blue from 0 to 1 of a share from soft (0) to stiff (1)."""
    at = min(max(share, 0.0), 1.0) * (len(_RAMP) - 1)
    i = min(int(at), len(_RAMP) - 2)
    low, high = ([int(_RAMP[k][c : c + 2], 16) / 255 for c in (0, 2, 4)] for k in (i, i + 1))
    red, green, blue = (a + (at - i) * (b - a) for a, b in zip(low, high))
    return red, green, blue


def shade(modulus_mpa: float, softest: float, stiffest: float) -> tuple[float, float, float]:
    """The colour of a modulus between two others."""
    return ramp((modulus_mpa - softest) / (stiffest - softest) if stiffest > softest else 1.0)
