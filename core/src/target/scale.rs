//! Scale and cut of a measured meridian: one root.
//!
//! With `S(t)` the arc length from the rim and `rho(t)` the radius in the source's unit, the strip has the length `L` and
//! the hub the radius `r_h` in mm where `sigma S(t) = L` and `sigma rho(t) = r_h`. The scale `sigma` drops out:
//!
//! `f(t) = L rho(t) - r_h S(t) = 0`,
//!
//! positive at the rim. The cut is its first zero; then `sigma = L / S`.

use super::error::TargetError;
use super::smoothing::PiecewiseCurve;
use super::spline_curve::{arc, speed};

/// A meridian that ends outside the hub by at most this share of its length is continued to it. A file cut exactly at
/// the hub radius ends a little outside or inside after smoothing.
pub(super) const CONTINUATION: f64 = 5e-3;

/// Steps a knot interval in which the first zero is looked for.
const STEPS_PER_INTERVAL: f64 = 4.0;

/// The strip's length and hub radius, mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Span {
    pub length_mm: f64,
    pub hub_radius_mm: f64,
}

impl Span {
    /// Checks both lengths: the strip's positive, the hub's too, both finite.
    pub fn new(length_mm: f64, hub_radius_mm: f64) -> Result<Self, TargetError> {
        for (name, value) in [("length_mm", length_mm), ("hub_radius_mm", hub_radius_mm)] {
            if !(value > 0.0 && value <= 1e9) {
                return Err(TargetError::OutOfRange { name, value, allowed: "above 0 mm and at most 1e9 mm" });
            }
        }
        Ok(Self { length_mm, hub_radius_mm })
    }

    /// The function whose zero is the cut, for a radius and an arc length in the source's unit.
    pub fn excess(self, radius: f64, arc: f64) -> f64 {
        self.length_mm * radius - self.hub_radius_mm * arc
    }

    pub fn ends_outside(self, radius: f64, arc: f64) -> TargetError {
        TargetError::EndsOutsideHub {
            length_mm: self.length_mm,
            end_radius_mm: radius * self.length_mm / arc,
            hub_radius_mm: self.hub_radius_mm,
        }
    }
}

/// Where a curve is cut and by what it is multiplied.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cut {
    pub parameter: f64,
    pub scale: f64,
}

/// Finds the cut of a curve known for parameters from 0 to `end`.
pub(super) fn cut(curve: &PiecewiseCurve, end: f64, span: Span) -> Result<Cut, TargetError> {
    let step = curve.step() / STEPS_PER_INTERVAL;
    let radius = |t: f64| curve.at(t)[0][0];
    let (mut t, mut s) = (0.0, 0.0);
    let mut reach = end;
    let mut full = 0.0;
    loop {
        let next = (t + step).min(reach);
        let s_next = s + arc(curve, t, next);
        if span.excess(radius(next), s_next) <= 0.0 {
            let (parameter, s) = root(curve, span, (t, s), next);
            return Ok(Cut { parameter, scale: span.length_mm / s });
        }
        (t, s) = (next, s_next);
        if t >= reach {
            if reach > end {
                return Err(span.ends_outside(radius(end), full));
            }
            full = s;
            let v = speed(curve, end);
            reach = end + CONTINUATION * s / v.max(f64::MIN_POSITIVE);
            if !(reach > end && reach.is_finite()) {
                return Err(span.ends_outside(radius(end), s));
            }
        }
    }
}

/// Newton's method kept inside the bracket by bisection; returns parameter and arc length.
fn root(curve: &PiecewiseCurve, span: Span, start: (f64, f64), end: f64) -> (f64, f64) {
    let (mut low, mut high) = (start.0, end);
    let mut t = 0.5 * (low + high);
    for _ in 0..80 {
        let [position, first, ..] = curve.at(t);
        let s = start.1 + arc(curve, start.0, t);
        let value = span.excess(position[0], s);
        if value > 0.0 {
            low = t;
        } else {
            high = t;
        }
        let newton = t - value / span.excess(first[0], first[0].hypot(first[1]));
        let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        if (next - t).abs() <= 1e-15 * end {
            break;
        }
        t = next;
    }
    (t, start.1 + arc(curve, start.0, t))
}
