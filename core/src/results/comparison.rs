//! How far a mid-line is from the target.

use serde::Serialize;

use crate::profile::Profile;

/// A point of a mid-line: flat arc length from the rim, distance from the rim, height above it, mm.
pub type MidlinePoint = [f64; 3];

/// Distances of a mid-line from the target at equal arc lengths.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Comparison {
    /// Largest distance, percent of the length.
    pub max_error_percent: f64,
    /// Root mean square distance, percent of the length.
    pub rms_error_percent: f64,
    /// Largest distance from the nearest point of the target, percent of the length: what the eye sees of the error,
    /// with sliding along the curve left out.
    pub max_shape_error_percent: f64,
    /// Distance at every point, mm.
    #[serde(skip)]
    pub distances_mm: Vec<f64>,
}

/// Compares a mid-line, rim first, with the profile of a design. `None` for an empty mid-line.
///
/// The error at a point is the distance between where its material is and where the target has it (equal `s`), which is
/// never less than the distance from the curve.
#[must_use]
pub fn compare(profile: &Profile, midline: &[MidlinePoint]) -> Option<Comparison> {
    let length = *profile.s.last()?;
    distances(|s| profile.position(s), |p| distance_from_curve(profile, p), length, midline)
}

/// Compares a mid-line with a shape, given by its position at an arc length and the distance from its nearest point.
pub(super) fn distances(
    position: impl Fn(f64) -> [f64; 2],
    nearest: impl Fn(&MidlinePoint) -> f64,
    length: f64,
    midline: &[MidlinePoint],
) -> Option<Comparison> {
    if midline.is_empty() {
        return None;
    }
    let distances_mm: Vec<f64> = midline
        .iter()
        .map(|[s, x, z]| {
            let [tx, tz] = position(*s);
            (x - tx).hypot(z - tz)
        })
        .collect();
    let largest = distances_mm.iter().fold(0.0_f64, |m, d| m.max(*d));
    let mean_square = distances_mm.iter().map(|d| d * d).sum::<f64>() / distances_mm.len() as f64;
    let shape = midline.iter().map(nearest).fold(0.0_f64, f64::max);
    Some(Comparison {
        max_error_percent: 100.0 * largest / length,
        rms_error_percent: 100.0 * mean_square.sqrt() / length,
        max_shape_error_percent: 100.0 * shape / length,
        distances_mm,
    })
}

fn distance_from_curve(profile: &Profile, point: &MidlinePoint) -> f64 {
    let segments = profile.x.windows(2).zip(profile.z.windows(2));
    segments
        .map(|(x, z)| {
            let (dx, dz) = (x[1] - x[0], z[1] - z[0]);
            let (px, pz) = (point[1] - x[0], point[2] - z[0]);
            let along = ((px * dx + pz * dz) / (dx * dx + dz * dz).max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
            (px - along * dx).hypot(pz - along * dz)
        })
        .fold(f64::INFINITY, f64::min)
}

impl Profile {
    /// Position at arc length `s`: linear between stations, which is exact to `kappa h^2 / 8`.
    #[must_use]
    pub fn position(&self, s: f64) -> [f64; 2] {
        let last = self.s.len().saturating_sub(1);
        let length = self.s.last().copied().unwrap_or(0.0);
        if last == 0 || length <= 0.0 {
            return [0.0; 2];
        }
        let at = (s / length * last as f64).clamp(0.0, last as f64);
        let i = (at as usize).min(last - 1);
        let u = at - i as f64;
        [self.x[i] + u * (self.x[i + 1] - self.x[i]), self.z[i] + u * (self.z[i + 1] - self.z[i])]
    }
}
