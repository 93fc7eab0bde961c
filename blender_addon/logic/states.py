# SPDX-License-Identifier: GPL-3.0-or-later
"""How many states of the morph make linear blending between them good enough."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

#: More states than this are never made.
MOST = 64


def deviation(shape: Callable[[float], np.ndarray], states: int) -> float:
    """Largest distance of blended points from the true ones, half-way between ``states + 1`` even fractions."""
    worst = 0.0
    before = shape(0.0)
    for k in range(states):
        after = shape((k + 1) / states)
        true = shape((k + 0.5) / states)
        worst = max(worst, float(np.linalg.norm(0.5 * (before + after) - true, axis=1).max()))
        before = after
    return worst


def enough(shape: Callable[[float], np.ndarray], limit: float) -> tuple[int, float]:
    """The fewest states after the flat one whose blends stay within ``limit``, and how far off they are, mm.

    :param shape: points, mm, at a fraction of the morph; (n, 3)
    :param limit: largest distance from the true path, mm
    :raises ValueError: where :data:`MOST` states are not enough
    """
    states = 2
    while True:
        found = deviation(shape, states)
        if found <= limit:
            return states, found
        if states >= MOST:
            raise ValueError(
                f"blending {MOST} states is {found:.3g} mm off the true path; allow more than {limit:.3g} mm"
            )
        # A blend's error falls with the square of the number of states.
        states = min(MOST, max(states + 1, int(states * np.sqrt(found / limit))))


def expression(state: int, states: int) -> str:
    """Weight of a state's shape at the fraction ``morph``: 1 at its own fraction, 0 at its neighbours'."""
    return f"max(0, 1 - abs(morph * {states} - {state}))"
