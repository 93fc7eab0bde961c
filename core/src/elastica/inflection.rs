//! Where the curvature of a meridian vanishes.

use super::ElasticaError;
use crate::numerics::root::bracketed_root;
use crate::target::{MeridianCurve, MeridianPoint};

/// Curvatures below this share of the largest one count as zero.
const ZERO_SHARE: f64 = 1e-9;

/// Within this share of the length from an inflection the quotient `M / theta'` is replaced by its limit.
const LIMIT_SHARE: f64 = 1e-7;

/// Curvatures that come this close to zero without crossing it are looked at as possible touching zeros.
const NEAR_SHARE: f64 = 1e-3;

/// All simple zeros of the curvature, rim first, ends included.
///
/// # Errors
/// [`ElasticaError::Straight`] for a meridian without curvature, [`ElasticaError::StraightPart`] where two neighbouring
/// stations have none, [`ElasticaError::TouchingZero`] where the curvature reaches zero but keeps its sign: near such a
/// point `theta' ~ (s - s_i)^2`, and no line of thrust leaves the quotient `M / theta'` finite and positive.
pub fn inflections(curve: &dyn MeridianCurve, stations: &[MeridianPoint]) -> Result<Vec<MeridianPoint>, ElasticaError> {
    let length = curve.length();
    let largest = stations.iter().fold(0.0_f64, |m, p| m.max(p.curvature.abs()));
    if largest * length < 1e-9 {
        return Err(ElasticaError::Straight { largest_curvature: largest, length_mm: length });
    }
    let zero = ZERO_SHARE * largest;
    let is_zero = |p: &MeridianPoint| p.curvature.abs() <= zero;
    let mut found: Vec<MeridianPoint> = Vec::new();
    for (i, point) in stations.iter().enumerate() {
        let (before, after) = (i.checked_sub(1).map(|k| &stations[k]), stations.get(i + 1));
        if is_zero(point) {
            if let Some(next) = after.filter(|p| is_zero(p)) {
                return Err(ElasticaError::StraightPart { from_mm: point.s, to_mm: next.s });
            }
            let simple = point.curvature_gradient.abs() * length > 1e-6 * largest;
            let keeps_sign = match (before, after) {
                (Some(b), Some(a)) => b.curvature.signum() == a.curvature.signum(),
                _ => false,
            };
            if !simple || keeps_sign {
                return Err(ElasticaError::TouchingZero { at_mm: point.s });
            }
            found.push(*point);
        } else if let Some(next) = after.filter(|p| !is_zero(p)) {
            if point.curvature.signum() != next.curvature.signum() {
                let s = bracketed_root(point.s, next.s, |s| curve.at(s).curvature);
                found.push(curve.at(s));
            } else if let Some(touching) = touching_zero(curve, point, next, largest) {
                return Err(ElasticaError::TouchingZero { at_mm: touching });
            }
        }
    }
    Ok(found)
}

/// The inflection so close to `s` that quotients there are replaced by their limits.
pub(crate) fn nearest(inflections: &[MeridianPoint], s: f64, length: f64) -> Option<&MeridianPoint> {
    inflections.iter().find(|i| (i.s - s).abs() <= LIMIT_SHARE * length)
}

/// A zero between two stations at which the curvature has the same sign: the extremum of the curvature between them
/// reaches zero.
fn touching_zero(curve: &dyn MeridianCurve, a: &MeridianPoint, b: &MeridianPoint, largest: f64) -> Option<f64> {
    let approaches = a.curvature.abs().min(b.curvature.abs()) < NEAR_SHARE * largest
        && a.curvature * a.curvature_gradient < 0.0
        && b.curvature * b.curvature_gradient > 0.0;
    if !approaches {
        return None;
    }
    let s = bracketed_root(a.s, b.s, |s| curve.at(s).curvature_gradient);
    let extremum = curve.at(s).curvature;
    (extremum.abs() <= ZERO_SHARE * largest || extremum.signum() != a.curvature.signum()).then_some(s)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::target::PolynomialMeridian;

    fn of(coefficients: &[f64]) -> Result<Vec<f64>, ElasticaError> {
        let curve = PolynomialMeridian::new(coefficients, 100.0).unwrap();
        inflections(&curve, &curve.stations(1001)).map(|points| points.iter().map(|p| p.s).collect())
    }

    #[test]
    fn zeros_of_the_curvature_are_found_between_at_stations_and_at_ends() {
        assert_eq!(of(&[-90.0, 90.0]).unwrap(), Vec::<f64>::new());
        // theta' = 2 (xi - 0.3): between stations after scaling by an odd count, here on one
        assert!((of(&[100.0, -60.0, 0.0]).unwrap()[0] - 30.0).abs() < 1e-12);
        assert!((of(&[100.0, -60.02, 0.0]).unwrap()[0] - 30.01).abs() < 1e-12);
        assert_eq!(of(&[50.0, 0.0, 10.0]).unwrap(), vec![0.0]);
        assert_eq!(of(&[50.0, -100.0, 10.0]).unwrap(), vec![100.0]);
    }

    #[test]
    fn straight_meridians_and_touching_zeros_are_refused() {
        assert!(matches!(of(&[45.0]), Err(ElasticaError::Straight { .. })));
        // theta' = 3 (xi - 0.5)^2 and the same touched between stations
        assert!(matches!(of(&[100.0, -150.0, 75.0, 0.0]), Err(ElasticaError::TouchingZero { .. })));
        let c = 0.500_37;
        let between = [100.0, -300.0 * c, 300.0 * c * c, 0.0];
        assert!(matches!(of(&between), Err(ElasticaError::TouchingZero { .. })));
    }
}
