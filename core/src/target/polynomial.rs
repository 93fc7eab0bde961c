//! Meridians given by their inclination as a polynomial of the normalised arc length.

use super::{MeridianCurve, MeridianPoint, TargetError};
use crate::numerics::arc_table::ArcTable;

/// Pieces of the position table; with five Gauss points each, positions are exact to rounding for the paper's shapes.
const TABLE_INTERVALS: usize = 256;

/// Highest degree accepted; higher ones are ill-conditioned in powers of `xi`.
pub const MAX_DEGREE: usize = 20;

/// `theta(xi) = sum_k c_k xi^(n-k)`, highest power first, `xi = s/L`, from rim (`xi = 0`) to hub (`xi = 1`).
///
/// This is the form in which Kansara et al. (2023) publish the hemisphere, nose cone, trumpet and roof.
#[derive(Debug, Clone)]
pub struct PolynomialMeridian {
    length: f64,
    /// Radians, highest power first.
    coefficients: Vec<f64>,
    table: ArcTable,
}

impl PolynomialMeridian {
    /// A meridian of arc length `length_mm` whose inclination has the given coefficients in degrees, highest power
    /// first.
    ///
    /// # Errors
    /// [`TargetError::OutOfRange`] for a length that is not positive and finite, and for coefficients that are missing,
    /// too many or not finite.
    pub fn new(coefficients_deg: &[f64], length_mm: f64) -> Result<Self, TargetError> {
        super::require_length(length_mm)?;
        let count = coefficients_deg.len();
        if count == 0 || count > MAX_DEGREE + 1 {
            return Err(TargetError::OutOfRange {
                name: "the number of coefficients",
                value: count as f64,
                allowed: "between 1 and 21",
            });
        }
        if let Some(&value) = coefficients_deg.iter().find(|c| !c.is_finite() || c.abs() > 1e7) {
            return Err(TargetError::OutOfRange {
                name: "a coefficient",
                value,
                allowed: "finite and at most 1e7 degrees in size",
            });
        }
        let coefficients: Vec<f64> = coefficients_deg.iter().map(|c| c.to_radians()).collect();
        let table = ArcTable::new(length_mm, TABLE_INTERVALS, |s| horner(&coefficients, s / length_mm)[0]);
        Ok(Self { length: length_mm, coefficients, table })
    }
}

impl MeridianCurve for PolynomialMeridian {
    fn length(&self) -> f64 {
        self.length
    }

    fn at(&self, s: f64) -> MeridianPoint {
        let s = s.clamp(0.0, self.length);
        let [inclination, slope, half_second] = horner(&self.coefficients, s / self.length);
        let [x, z] = self.table.position(s, |s| horner(&self.coefficients, s / self.length)[0]);
        MeridianPoint {
            s,
            inclination,
            curvature: slope / self.length,
            curvature_gradient: 2.0 * half_second / self.length.powi(2),
            x,
            z,
        }
    }
}

/// Value, first derivative and half the second derivative of a polynomial (highest power first), by Horner's rule.
fn horner(coefficients: &[f64], xi: f64) -> [f64; 3] {
    let mut p = [0.0; 3];
    for &c in coefficients {
        p[2] = p[2] * xi + p[1];
        p[1] = p[1] * xi + p[0];
        p[0] = p[0] * xi + c;
    }
    p
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_hemisphere_is_a_quarter_circle() {
        let meridian = PolynomialMeridian::new(&[-90.0, 90.0], 100.0).unwrap();
        let radius = 200.0 / std::f64::consts::PI;
        for point in meridian.stations(101) {
            let angle = point.s / radius;
            assert!((point.x - radius * (1.0 - angle.cos())).abs() < 1e-11);
            assert!((point.z - radius * angle.sin()).abs() < 1e-11);
            assert!((point.curvature + 1.0 / radius).abs() < 1e-15);
            assert_eq!(point.curvature_gradient, 0.0);
        }
    }

    #[test]
    fn derivatives_agree_with_central_differences() {
        let coefficients = [26.52, -116.3, 162.3, -132.0, 63.5, -47.14, 18.64, 41.56];
        let meridian = PolynomialMeridian::new(&coefficients, 80.0).unwrap();
        let h = 1e-4;
        for s in [3.0, 20.0, 41.7, 77.0] {
            let (before, here, after) = (meridian.at(s - h), meridian.at(s), meridian.at(s + h));
            assert!((here.curvature - (after.inclination - before.inclination) / (2.0 * h)).abs() < 1e-9);
            assert!((here.curvature_gradient - (after.curvature - before.curvature) / (2.0 * h)).abs() < 1e-9);
        }
    }

    #[test]
    fn unusable_coefficients_are_refused_with_their_value() {
        assert!(PolynomialMeridian::new(&[], 1.0).is_err());
        assert!(PolynomialMeridian::new(&[f64::NAN], 1.0).is_err());
        let error = PolynomialMeridian::new(&[1e9], 1.0).unwrap_err().to_string();
        assert!(error.contains("1000000000"), "{error}");
        assert!(PolynomialMeridian::new(&[1.0], f64::INFINITY).is_err());
    }
}
