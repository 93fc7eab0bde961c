"""What is in the paper or its scripts and is not repeated here."""

from __future__ import annotations

import math

from .page import Section


def aspect_of_dome(a: float, b: float, published: bool, steps: int = 20000) -> float:
    """x(L)/z(L) of a dome whose inclination is the ellipse's true one, or the published script's 90 degrees less the polar angle."""
    x = z = 0.0
    for i in range(steps):
        q = (i + 0.5) * 0.5 * math.pi / steps
        length = math.hypot(a * math.sin(q), b * math.cos(q))
        if published:
            angle = 0.5 * math.pi - math.atan2(b * math.sin(q), a * math.cos(q))
        else:
            angle = math.atan2(b * math.cos(q), a * math.sin(q))
        x += length * math.cos(angle)
        z += length * math.sin(angle)
    return x / z


def section(_program: object) -> Section:
    """The list, with the one that changes results worked out."""
    rows = []
    for a, b in [(0.5, 1.0), (1.0, 1.0), (2.0, 1.0)]:
        rows.append([f"{a / b:g}", f"{aspect_of_dome(a, b, True):.3f}", f"{aspect_of_dome(a, b, False):.3f}"])
    return Section(
        title="Errata",
        stated="a script published with it makes hemi-ellipsoids with an inclination of 90° less the polar angle.",
        model="the tangent of the ellipse, `tan θ = b cos q / (a sin q)`. Width over height of the dome that each makes:",
        header=["a/b meant", "a/b by the script", "a/b here"],
        rows=rows,
        difference="the two agree for the hemisphere only; the script's dome for a/b = 2 is one of 1.3, for 0.5 one of 0.77. Results over the aspect ratio "
        "shift accordingly.",
        more="""\
Also different here, on purpose:

- the body of the text calls FLX9095 the soft and FLX9070 the rigid phase; the appendix is right;
- the scripts take the fractions at the edges of slices, both ends included; here they are those at the slices' centres;
- in the script α is measured from the vertical, and the parametric y should be b cos φ;
- the number of voxels in a slice is w t/η², not w t/η; "y(1)" is z(1); H₀ and V₀ are meant per unit width; Ê is normalised in two ways;
- the count of bricks of the discretised solid (above);
- the threshold of the critical time is 99.9 % in the text and 99.99 % in a caption, without saying whether of the temperature or of its rise: here both
  are parameters.
""",
    )
