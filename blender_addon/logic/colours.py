# SPDX-License-Identifier: GPL-3.0-or-later
"""Colours of figures, and the legend that says what they mean."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

#: From low or soft (light) to high or stiff (dark), told apart by the colour-blind, sRGB: the ramp of the reports and of FreeCAD.
_SEQUENTIAL = ("f6e055", "b5d945", "5ec366", "28a880", "218f8c", "2c728e", "3b528b", "462f7c", "3d044e")
#: Two directions from a light middle.
_DIVERGING = ("2166ac", "67a9cf", "d1e5f0", "f7f7f7", "fddbc7", "ef8a62", "b2182b")
#: Phases from softest to stiffest, on the same ramp.
_PHASES = (_SEQUENTIAL[0], _SEQUENTIAL[4], _SEQUENTIAL[8])
_GREY = "8c8c8c"
_STEPS = 256


def linear(srgb: np.ndarray) -> np.ndarray:
    """Linear light of sRGB values from 0 to 1, as Blender's float colours are kept."""
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)


def _rgb(words: tuple[str, ...]) -> np.ndarray:
    return np.array([[int(word[i : i + 2], 16) / 255 for i in (0, 2, 4)] for word in words])


def _table(words: tuple[str, ...]) -> np.ndarray:
    stops = _rgb(words)
    at = np.linspace(0, len(words) - 1, _STEPS)
    srgb = np.stack([np.interp(at, np.arange(len(words)), stops[:, i]) for i in range(3)], axis=1)
    return np.hstack([linear(srgb), np.ones((_STEPS, 1))]).astype(np.float32)


_TABLES = {"sequential": _table(_SEQUENTIAL), "diverging": _table(_DIVERGING)}
PHASES = np.hstack([linear(_rgb(_PHASES)), np.ones((3, 1))]).astype(np.float32)
GREY = tuple(float(x) for x in linear(_rgb((_GREY,)))[0]) + (1.0,)


#: The solver's mid-line.
MIDLINE = tuple(float(x) for x in linear(_rgb(("ff3b1f",)))[0]) + (1.0,)


@dataclass(frozen=True)
class Scale:
    """What colours stand for: a range of figures, or names."""

    title: str
    low: float = 0.0
    high: float = 1.0
    names: tuple[str, ...] = ()
    map: str = "sequential"

    def colours(self, values: np.ndarray) -> np.ndarray:
        """Linear RGBA of figures (or of the numbers of names); (n, 4), float32."""
        if self.names:
            return phase_colours(len(self.names))[values.astype(np.int64)]
        span = self.high - self.low
        share = (values - self.low) / span if span > 0 else np.full(len(values), 0.5)
        return _TABLES[self.map][np.clip(share * (_STEPS - 1) + 0.5, 0, _STEPS - 1).astype(np.int64)]

    def marks(self, count: int = 5) -> list[str]:
        """Figures beside the legend, highest first, or the names, stiffest first."""
        if self.names:
            return list(reversed(self.names))
        if not self.high > self.low:
            return [_figure(self.low, abs(self.low))]
        largest = max(abs(self.low), abs(self.high))
        return [_figure(value, largest) for value in np.linspace(self.high, self.low, count)]


def phase_colours(count: int) -> np.ndarray:
    """Colours of two or three phases, softest first."""
    return PHASES[[0, 2]] if count == 2 else PHASES


def _figure(value: float, largest: float) -> str:
    """A number with three significant digits of the largest one."""
    if largest <= 0:
        return "0"
    decimals = max(0, 2 - int(np.floor(np.log10(largest))))
    text = f"{value:.{decimals}f}"
    return text.lstrip("-") if float(text) == 0 else text


def scale(low: float, high: float, name: str) -> Scale:
    """A scale from the smallest to the largest figure; one that changes sign is the same on both sides of zero."""
    if low < 0 < high:
        most = max(-low, high)
        return Scale(name, -most, most, map="diverging")
    return Scale(name, low, high)
