//! The rigid placement that fits a scan to a dome best.
//!
//! With `p' = R p + t` and signed distances `r_i` from the dome, the sum of Tukey's biweight of `r_i` is made least by
//! iteratively reweighted Gauss-Newton steps with Levenberg's damping. A small turn `w` about the points' centre `c` and a shift `u`
//! change `r_i` by `g_i . u + ((p'_i - c) x g_i) . w`, where `g_i` is the direction in which the distance grows. The scale of the
//! biweight follows the median distance, so that stray points - a table, a stand - end up without weight.

use nalgebra::{DMatrix, DVector, Rotation3, Unit, Vector3};

use super::dome::Dome;
use crate::progress::Cancelled;

/// Tukey's constant: 95 % efficiency for normal noise.
const TUKEY: f64 = 4.685;
/// Median absolute deviation to standard deviation.
const MAD: f64 = 1.4826;
const MOST_ITERATIONS: usize = 200;

/// From a scan's coordinates to the dome's: `p' = rotation p + shift`, mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Placement {
    pub rotation: Rotation3<f64>,
    pub shift: Vector3<f64>,
}

impl Placement {
    pub const IDENTITY: Self = Self {
        rotation: Rotation3::from_matrix_unchecked(nalgebra::Matrix3::new(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)),
        shift: Vector3::new(0.0, 0.0, 0.0),
    };

    pub fn apply(&self, p: &Vector3<f64>) -> Vector3<f64> {
        self.rotation * p + self.shift
    }

    /// Turned by the vector `turn` about `centre` (in the dome's frame) and then shifted.
    fn moved(&self, turn: &Vector3<f64>, centre: &Vector3<f64>, by: &Vector3<f64>) -> Self {
        let more = Rotation3::from_scaled_axis(*turn);
        Self { rotation: more * self.rotation, shift: more * (self.shift - centre) + centre + by }
    }

    /// Axis of the rotation (z where there is none) and angle, rad.
    pub fn axis_angle(&self) -> (Unit<Vector3<f64>>, f64) {
        self.rotation.axis_angle().unwrap_or((Vector3::z_axis(), 0.0))
    }
}

/// Motions that a fit may use: turns about x, y, z and shifts along x, y, z.
pub(super) type Freedom = [bool; 6];

/// All that a surface of revolution can tell: a turn about its own axis changes nothing.
pub(super) const ROUND: Freedom = [true, true, false, true, true, true];
/// All that spokes can tell.
pub(super) const FACETED: Freedom = [true; 6];
/// Along the axis.
pub(super) const AXIAL: Freedom = [false, false, false, false, false, true];
/// In the plane of a meridian.
pub(super) const PLANAR: Freedom = [false, true, false, true, false, true];

/// A fitted placement.
#[derive(Debug, Clone)]
pub(super) struct Fit {
    pub placement: Placement,
    /// Spread of the distances: 1.4826 times their median, mm.
    pub spread: f64,
    /// Standard uncertainty of the turn, rad, and of the shift of the points' centre, mm; infinite where the points leave
    /// the placement open.
    pub uncertainty: [f64; 2],
}

/// How far a fit goes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Limits {
    /// Iterations.
    pub iterations: usize,
    /// Scale of the biweight, mm; found from the distances where there is none.
    pub scale: Option<f64>,
}

impl Limits {
    pub const FINE: Self = Self { iterations: MOST_ITERATIONS, scale: None };
    /// Far enough to tell placements apart.
    pub const NEAR: Self = Self { iterations: 25, scale: None };
}

/// Least spread, as a share of the dome's size: the accuracy of the polyline.
const LEAST_SPREAD: f64 = 1e-6;

/// Improves a placement. `None` where cancelled.
pub(super) fn refine(
    dome: &Dome,
    points: &[Vector3<f64>],
    start: Placement,
    freedom: Freedom,
    limits: Limits,
    cancelled: Cancelled<'_>,
) -> Option<Fit> {
    let [low, high] = dome.heights();
    let size = (high - low).hypot(dome.curve.points()[0][0]);
    let free: Vec<usize> = (0..6).filter(|k| freedom[*k]).collect();
    let mut placement = start;
    let mut damping = 1e-3;
    let mut normal = DMatrix::<f64>::zeros(free.len(), free.len());
    let mut spread = spread_of(dome, points, &placement, size);
    for _ in 0..limits.iterations {
        if cancelled() {
            return None;
        }
        let scale = limits.scale.unwrap_or(TUKEY * spread);
        let placed: Vec<Vector3<f64>> = points.iter().map(|p| placement.apply(p)).collect();
        let centre = placed.iter().sum::<Vector3<f64>>() / placed.len().max(1) as f64;
        let mut slope = DVector::<f64>::zeros(free.len());
        normal.fill(0.0);
        let mut cost = 0.0;
        for p in &placed {
            let d = dome.distance(p);
            cost += biweight(d.signed, scale);
            let weight = weight(d.signed, scale);
            if weight == 0.0 {
                continue;
            }
            let turn = (p - centre).cross(&d.gradient);
            let row = [turn.x, turn.y, turn.z, d.gradient.x, d.gradient.y, d.gradient.z];
            for (i, &a) in free.iter().enumerate() {
                slope[i] -= weight * row[a] * d.signed;
                for (j, &b) in free.iter().enumerate().take(i + 1) {
                    normal[(i, j)] += weight * row[a] * row[b];
                }
            }
        }
        normal.fill_upper_triangle_with_lower_triangle();
        let mut better = None;
        for _ in 0..12 {
            let mut damped = normal.clone();
            for (i, &k) in free.iter().enumerate() {
                // Directions that change nothing must not move at all.
                let floor = if k < 3 { size * size } else { 1.0 } * 1e-9 * points.len() as f64;
                damped[(i, i)] += damping * normal[(i, i)] + floor;
            }
            let step = damped.cholesky().map(|c| c.solve(&slope)).filter(|s| s.iter().all(|v| v.is_finite()));
            if let Some(step) = step {
                let mut full = [0.0; 6];
                for (i, &k) in free.iter().enumerate() {
                    full[k] = step[i];
                }
                let (turn, by) = (Vector3::new(full[0], full[1], full[2]), Vector3::new(full[3], full[4], full[5]));
                let trial = placement.moved(&turn, &centre, &by);
                let there: f64 = points.iter().map(|p| biweight(dome.distance(&trial.apply(p)).signed, scale)).sum();
                if there <= cost {
                    better = Some((trial, turn.norm() * size + by.norm(), there));
                    break;
                }
            }
            damping *= 6.0;
        }
        let Some((trial, moved, there)) = better else { break };
        placement = trial;
        damping = (damping / 8.0).max(1e-9);
        spread = spread_of(dome, points, &placement, size);
        if moved < 1e-9 * size || (moved < 1e-6 * size && cost - there <= 1e-10 * cost) {
            break;
        }
    }
    Some(Fit { placement, spread, uncertainty: uncertainty(&normal, &free, spread, size, points.len()) })
}

/// Mean over the points of the squared distance, at most `limit` squared.
pub(super) fn clipped_cost(dome: &Dome, points: &[Vector3<f64>], placement: &Placement, limit: f64) -> f64 {
    let sum: f64 = points.iter().map(|p| dome.distance(&placement.apply(p)).signed.abs().min(limit).powi(2)).sum();
    sum / points.len().max(1) as f64
}

fn spread_of(dome: &Dome, points: &[Vector3<f64>], placement: &Placement, size: f64) -> f64 {
    let mut distances: Vec<f64> = points.iter().map(|p| dome.distance(&placement.apply(p)).signed.abs()).collect();
    (MAD * median(&mut distances)).max(LEAST_SPREAD * size)
}

/// The median; 0 of nothing. Reorders the values.
pub(super) fn median(values: &mut [f64]) -> f64 {
    if values.is_empty() {
        return 0.0;
    }
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}

fn biweight(r: f64, scale: f64) -> f64 {
    let u = (r / scale).powi(2);
    scale * scale / 6.0 * if u < 1.0 { 1.0 - (1.0 - u).powi(3) } else { 1.0 }
}

fn weight(r: f64, scale: f64) -> f64 {
    let u = (r / scale).powi(2);
    if u < 1.0 { (1.0 - u).powi(2) } else { 0.0 }
}

/// Standard uncertainties from the normal matrix.
fn uncertainty(normal: &DMatrix<f64>, free: &[usize], spread: f64, size: f64, points: usize) -> [f64; 2] {
    if free.is_empty() {
        return [0.0; 2];
    }
    // Turns are scaled by the size, so that all entries are alike.
    let unit = |k: usize| if k < 3 { size } else { 1.0 };
    let scaled = DMatrix::from_fn(free.len(), free.len(), |i, j| normal[(i, j)] / (unit(free[i]) * unit(free[j])));
    let eigen = scaled.symmetric_eigen();
    let least = 1e-7 * points as f64;
    let mut sums = [0.0; 2];
    for (value, vector) in eigen.eigenvalues.iter().zip(eigen.eigenvectors.column_iter()) {
        for (i, &k) in free.iter().enumerate() {
            let share = vector[i] * vector[i];
            if share > 1e-6 {
                let variance = if *value > least { share * spread * spread / value } else { f64::INFINITY };
                sums[usize::from(k >= 3)] += variance / unit(k).powi(2);
            }
        }
    }
    sums.map(f64::sqrt)
}
