//! Hemi-ellipsoids: the meridian is a quarter ellipse with its true tangent.

use std::f64::consts::FRAC_PI_2;

use super::{MeridianCurve, MeridianPoint, TargetError};
use crate::numerics::quadrature::gauss_legendre;

const TABLE_INTERVALS: usize = 256;

/// Least and largest ratio of the semi-axes that is accepted.
pub const ASPECT_RATIO_RANGE: (f64, f64) = (0.05, 20.0);

/// A quarter ellipse `(a cos q, b sin q)` from the rim (`q = 0`, vertical tangent) to the hub (`q = pi/2`, horizontal).
///
/// With `g = a^2 sin^2 q + b^2 cos^2 q`:
///
/// - `ds = sqrt(g) dq`, `x = a (1 - cos q)`, `z = b sin q`;
/// - `tan(theta) = b cos q / (a sin q)`;
/// - `theta' = -a b / g^(3/2)`, `theta'' = 3 a b (a^2 - b^2) sin q cos q / g^3`.
///
/// `a` is the horizontal semi-axis; the dome's rim radius is the hub radius plus `a`.
#[derive(Debug, Clone)]
pub struct EllipseMeridian {
    length: f64,
    a: f64,
    b: f64,
    /// Arc length at evenly spaced `q`.
    arc: Vec<f64>,
}

impl EllipseMeridian {
    /// The quarter ellipse of arc length `length_mm` with `a/b = aspect_ratio`.
    ///
    /// # Errors
    /// [`TargetError::OutOfRange`] for a length that is not positive and finite, or a ratio outside
    /// [`ASPECT_RATIO_RANGE`].
    pub fn new(aspect_ratio: f64, length_mm: f64) -> Result<Self, TargetError> {
        super::require_length(length_mm)?;
        if !(ASPECT_RATIO_RANGE.0..=ASPECT_RATIO_RANGE.1).contains(&aspect_ratio) {
            return Err(TargetError::OutOfRange {
                name: "the aspect ratio",
                value: aspect_ratio,
                allowed: "between 0.05 and 20",
            });
        }
        let unit = arc_table(aspect_ratio, 1.0);
        let scale = length_mm / unit[TABLE_INTERVALS];
        let mut arc: Vec<f64> = unit.iter().map(|s| s * scale).collect();
        arc[TABLE_INTERVALS] = length_mm;
        Ok(Self { length: length_mm, a: aspect_ratio * scale, b: scale, arc })
    }

    /// Horizontal and vertical semi-axis, mm.
    #[must_use]
    pub fn semi_axes(&self) -> (f64, f64) {
        (self.a, self.b)
    }

    fn speed_squared(&self, q: f64) -> f64 {
        let (sin, cos) = q.sin_cos();
        (self.a * sin).powi(2) + (self.b * cos).powi(2)
    }

    /// The parameter `q` at arc length `s`: Newton's method on the tabulated piece that holds `s`.
    fn parameter(&self, s: f64) -> f64 {
        let dq = FRAC_PI_2 / TABLE_INTERVALS as f64;
        let piece = self.arc.partition_point(|&arc| arc <= s).clamp(1, TABLE_INTERVALS) - 1;
        let (start, end) = (self.arc[piece], self.arc[piece + 1]);
        let q0 = piece as f64 * dq;
        let mut q = q0 + dq * ((s - start) / (end - start)).clamp(0.0, 1.0);
        for _ in 0..8 {
            let [arc] = gauss_legendre(q0, q, |q| [self.speed_squared(q).sqrt()]);
            let correction = (start + arc - s) / self.speed_squared(q).sqrt();
            q -= correction;
            if correction.abs() < 1e-15 {
                break;
            }
        }
        q.clamp(0.0, FRAC_PI_2)
    }
}

fn arc_table(a: f64, b: f64) -> Vec<f64> {
    let dq = FRAC_PI_2 / TABLE_INTERVALS as f64;
    let mut total = 0.0;
    let mut table = Vec::with_capacity(TABLE_INTERVALS + 1);
    table.push(total);
    for piece in 0..TABLE_INTERVALS {
        let [arc] = gauss_legendre(piece as f64 * dq, (piece + 1) as f64 * dq, |q| {
            let (sin, cos) = q.sin_cos();
            [(a * sin).hypot(b * cos)]
        });
        total += arc;
        table.push(total);
    }
    table
}

impl MeridianCurve for EllipseMeridian {
    fn length(&self) -> f64 {
        self.length
    }

    fn at(&self, s: f64) -> MeridianPoint {
        let s = s.clamp(0.0, self.length);
        // The hub end is exact: a rounded pi/2 would leave an inclination of 1e-17.
        if s == self.length {
            let curvature = -self.b / self.a.powi(2);
            return MeridianPoint { s, inclination: 0.0, curvature, curvature_gradient: 0.0, x: self.a, z: self.b };
        }
        let (sin, cos) = self.parameter(s).sin_cos();
        let (a, b) = (self.a, self.b);
        let g = (a * sin).powi(2) + (b * cos).powi(2);
        MeridianPoint {
            s,
            inclination: (b * cos).atan2(a * sin),
            curvature: -a * b / (g * g.sqrt()),
            curvature_gradient: 3.0 * a * b * (a * a - b * b) * sin * cos / g.powi(3),
            x: a * (1.0 - cos),
            z: b * sin,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_axes_give_the_circle() {
        let meridian = EllipseMeridian::new(1.0, 100.0).unwrap();
        let radius = 200.0 / std::f64::consts::PI;
        assert!((meridian.semi_axes().0 - radius).abs() < 1e-12);
        for point in meridian.stations(57) {
            let expected = FRAC_PI_2 * (1.0 - point.s / 100.0);
            assert!((point.inclination - expected).abs() < 1e-13);
            assert!((point.curvature + 1.0 / radius).abs() < 1e-15);
        }
    }

    #[test]
    fn points_lie_on_the_ellipse_and_derivatives_agree_with_differences() {
        for ratio in [0.05, 0.5, 2.0, 20.0] {
            let meridian = EllipseMeridian::new(ratio, 100.0).unwrap();
            let (a, b) = meridian.semi_axes();
            let h = 1e-4;
            for s in [5.0, 31.0, 64.0, 97.0] {
                let (before, here, after) = (meridian.at(s - h), meridian.at(s), meridian.at(s + h));
                let on_ellipse = ((a - here.x) / a).powi(2) + (here.z / b).powi(2);
                assert!((on_ellipse - 1.0).abs() < 1e-12, "{ratio} {s} {on_ellipse}");
                assert!(((after.x - before.x) / (2.0 * h) - here.inclination.cos()).abs() < 1e-6);
                let slope = (after.inclination - before.inclination) / (2.0 * h);
                assert!((here.curvature - slope).abs() < 1e-6 * slope.abs().max(1.0), "{ratio} {s}");
                let gradient = (after.curvature - before.curvature) / (2.0 * h);
                assert!((here.curvature_gradient - gradient).abs() < 1e-5 * gradient.abs().max(1e-3), "{ratio} {s}");
            }
        }
    }

    #[test]
    fn a_ratio_out_of_range_is_refused() {
        assert!(EllipseMeridian::new(0.0, 1.0).is_err());
        assert!(EllipseMeridian::new(f64::NAN, 1.0).is_err());
    }
}
