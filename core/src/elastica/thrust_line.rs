//! The line of thrust and the modulus it implies.

use super::inflection;
use crate::target::MeridianPoint;

/// `m(x, z) = m_a - h (z - z_a) - v (x - x_a)`: moment of one strip, divided by `E_max t^3 / 12`.
///
/// In these units `m = (E/E_max) w theta'` is dimensionless and `h`, `v` are in 1/mm. The anchor `(x_a, z_a)` is a point
/// where the moment is known; at an inflection `m_a = 0`, which keeps the quotient `m / theta'` accurate close to it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ThrustLine {
    /// Position of the anchor, mm.
    pub anchor: [f64; 2],
    /// Moment at the anchor.
    pub anchor_moment: f64,
    /// Horizontal force `h`, 1/mm.
    pub horizontal: f64,
    /// Vertical force `v`, 1/mm.
    pub vertical: f64,
}

impl ThrustLine {
    /// Moment at a point of the strip.
    #[must_use]
    pub fn moment(&self, x: f64, z: f64) -> f64 {
        self.anchor_moment - self.horizontal * (z - self.anchor[1]) - self.vertical * (x - self.anchor[0])
    }

    /// Derivative of the moment along the strip: `-(h sin(theta) + v cos(theta))`.
    #[must_use]
    pub fn moment_gradient(&self, inclination: f64) -> f64 {
        let (sin, cos) = inclination.sin_cos();
        -(self.horizontal * sin + self.vertical * cos)
    }

    /// The same line with all forces multiplied by `factor`.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        Self {
            anchor: self.anchor,
            anchor_moment: self.anchor_moment * factor,
            horizontal: self.horizontal * factor,
            vertical: self.vertical * factor,
        }
    }

    /// `m / (w theta')` at a point of the target, with the limit `m' / (w theta'')` next to the given inflections.
    #[must_use]
    pub fn modulus_at(&self, point: &MeridianPoint, width: f64, length: f64, inflections: &[MeridianPoint]) -> f64 {
        match inflection::nearest(inflections, point.s, length) {
            Some(at) => self.moment_gradient(at.inclination) / (width * at.curvature_gradient),
            None => self.moment(point.x, point.z) / (width * point.curvature),
        }
    }
}
