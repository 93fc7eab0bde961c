//! Force-displacement curves and the figures taken from them.

use serde::Serialize;

/// One point of a curve, for one spoke.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct LoadPoint {
    /// Depth `D` of the hub below its place, mm.
    pub depth_mm: f64,
    /// Force `F` above that before pressing, N; positive where it pushes down.
    pub force_n: f64,
    /// The part of it that the indenter puts on the spoke beside the hub, N.
    pub contact_force_n: f64,
    /// Extent of the contact along the spoke, mm.
    pub contact_length_mm: f64,
    /// Strain energy gained, N mm.
    pub strain_energy_nmm: f64,
    /// Largest principal strain (elastica: bending strain of the faces).
    pub largest_strain: f64,
    /// Iterations spent.
    pub iterations: usize,
}

/// Force at a depth, linear between points.
pub(super) fn force_at(curve: &[LoadPoint], depth_mm: f64) -> Option<f64> {
    let next = curve.iter().position(|p| p.depth_mm >= depth_mm * (1.0 - 1e-12))?;
    let b = &curve[next];
    let Some(a) = next.checked_sub(1).map(|i| &curve[i]) else { return Some(b.force_n) };
    let share = (depth_mm - a.depth_mm) / (b.depth_mm - a.depth_mm);
    Some(a.force_n + share * (b.force_n - a.force_n))
}

/// Force over depth, N/mm; `None` beyond the curve or at no depth.
#[must_use]
pub fn secant(curve: &[LoadPoint], depth_mm: f64) -> Option<f64> {
    (depth_mm > 0.0).then(|| force_at(curve, depth_mm)).flatten().map(|force| force / depth_mm)
}

/// Slope at no depth, N/mm: that of the parabola through the first three points.
#[must_use]
pub fn tangent(curve: &[LoadPoint]) -> f64 {
    let [a, b, c, ..] = curve else { return 0.0 };
    let [near, far] = [b, c].map(|p| p.depth_mm - a.depth_mm);
    let [first, second] = [(b.force_n - a.force_n) / near, (c.force_n - a.force_n) / far];
    (first * far - second * near) / (far - near)
}

/// Work `int F dD` of the piecewise linear curve, N mm.
#[must_use]
pub fn work(curve: &[LoadPoint]) -> f64 {
    curve.windows(2).map(|p| 0.5 * (p[0].force_n + p[1].force_n) * (p[1].depth_mm - p[0].depth_mm)).sum()
}

/// Rigidity: slope `K = 3/d^3 int_0^d F D dD` of the line through the origin that is closest to the piecewise linear
/// curve (least squares) over depths of at most `d`, N/mm. It does not depend on how densely the curve is sampled.
///
/// ```
/// # use voxelastica_core::indentation::{LoadPoint, rigidity};
/// let point = |depth_mm: f64, force_n: f64| LoadPoint {
///     depth_mm, force_n, contact_force_n: 0.0, contact_length_mm: 0.0, strain_energy_nmm: 0.0, largest_strain: 0.0,
///     iterations: 0,
/// };
/// let line = [point(0.0, 0.0), point(1.0, 3.0), point(4.0, 12.0)];
/// assert!((rigidity(&line, 2.0) - 3.0).abs() < 1e-12);
/// ```
#[must_use]
pub fn rigidity(curve: &[LoadPoint], depth_mm: f64) -> f64 {
    let reach = curve.last().map_or(0.0, |p| p.depth_mm).min(depth_mm);
    if reach <= 0.0 {
        return 0.0;
    }
    let mut moment = 0.0;
    for pair in curve.windows(2) {
        let (a, b) = (pair[0].depth_mm, pair[1].depth_mm.min(reach));
        if b <= a {
            break;
        }
        let end = force_at(pair, b).unwrap_or(pair[1].force_n);
        let slope = (end - pair[0].force_n) / (b - a);
        let offset = pair[0].force_n - slope * a;
        moment += slope * (b.powi(3) - a.powi(3)) / 3.0 + 0.5 * offset * (b * b - a * a);
    }
    3.0 * moment / reach.powi(3)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(n: usize, force: impl Fn(f64) -> f64) -> Vec<LoadPoint> {
        let point = |i: usize| {
            let depth_mm = 10.0 * i as f64 / n as f64;
            let force_n = force(depth_mm);
            LoadPoint {
                depth_mm,
                force_n,
                contact_force_n: 0.0,
                contact_length_mm: 0.0,
                strain_energy_nmm: 0.0,
                largest_strain: 0.0,
                iterations: 0,
            }
        };
        (0..=n).map(point).collect()
    }

    #[test]
    fn figures_of_a_cubic_curve() {
        // F = 3 D - 0.1 D^2: K over d is 3 - 0.1 * 3/4 d.
        let force = |d: f64| 3.0 * d - 0.1 * d * d;
        let fine = curve(4000, force);
        assert!((rigidity(&fine, 2.0) - 2.85).abs() < 1e-5);
        assert!((rigidity(&fine, 2.0013) - (3.0 - 0.075 * 2.0013)).abs() < 1e-5);
        assert!((work(&fine) - (150.0 - 100.0 / 3.0)).abs() < 1e-4);
        assert!((secant(&fine, 5.0).unwrap() - 2.5).abs() < 1e-9);
        assert_eq!(secant(&fine, 10.5), None);
        assert_eq!(secant(&fine, 0.0), None);
        assert!((tangent(&fine) - 3.0).abs() < 1e-9);
        assert!((tangent(&[fine[0], fine[3], fine[10]]) - 3.0).abs() < 1e-9);
        // A curve that ends before the thickness is taken as far as it goes.
        let short = &fine[..=400];
        assert!((rigidity(short, 2.0) - 2.925).abs() < 1e-5);
    }
}
