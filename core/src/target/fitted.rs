//! Measured meridians, points or mesh, as smooth curves of the strip's length.

use rayon::prelude::*;

use super::error::{Row, TargetError};
use super::ordering::{self, OrderedPoints, distance};
use super::revolution::RevolutionFit;
use super::scale::{self, Span};
use super::smoothing::{self, PiecewiseCurve, Sample};
use super::spline_curve::{SplineMeridian, arc};

/// A meridian fitted to measured points, scaled and cut so that it runs from the rim to the hub.
///
/// ```
/// use voxelastica_core::target::{FittedMeridian, MeridianCurve};
///
/// // A quarter circle of radius 7.5 in any unit, 61 points from the rim to the axis.
/// let points: Vec<[f64; 2]> = (0..=60)
///     .map(|i| f64::to_radians(1.5 * i as f64))
///     .map(|q| [7.5 * q.cos(), 7.5 * q.sin()])
///     .collect();
/// let meridian = FittedMeridian::from_points(&points, 100.0, 10.0)?;
/// assert!((meridian.curve.length() - 100.0).abs() < 1e-9);
/// // The radius r in mm satisfies r cos(100 mm / r) = 10 mm: 69.997 mm.
/// let radius = 1.0 / meridian.curve.at(50.0).curvature.abs();
/// assert!((radius * (100.0 / radius).cos() - 10.0).abs() < 1e-4);
/// # Ok::<(), voxelastica_core::target::TargetError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct FittedMeridian {
    /// The meridian, from the rim to the hub radius.
    pub curve: SplineMeridian,
    /// What the source's lengths were multiplied by, mm a unit.
    pub scale: f64,
    /// Root mean square distance of the points between rim and cut from the curve, mm.
    pub residual_rms_mm: f64,
    /// Largest distance of one of them, mm.
    pub residual_max_mm: f64,
    /// Axis and roundness, for meshes.
    pub revolution: Option<RevolutionFit>,
    /// Number of points (mesh: rings or groups of vertices) the curve was fitted to.
    pub source_points: usize,
}

impl FittedMeridian {
    /// Fits points `[rho, z]` in any one unit, in the order of the curve, either end first.
    ///
    /// The end with the larger radius is the rim. The curve is scaled by the one factor for which its arc length from
    /// the rim to the radius `hub_radius_mm` is `length_mm`, both above 0; what lies inside the hub is cut off.
    ///
    /// # Errors
    ///
    /// Lengths out of range; a point that is not finite or has a negative radius; fewer than 5 different points; a curve
    /// that doubles back, crosses itself, or ends outside the hub radius.
    pub fn from_points(points: &[[f64; 2]], length_mm: f64, hub_radius_mm: f64) -> Result<Self, TargetError> {
        let span = Span::new(length_mm, hub_radius_mm)?;
        if points.len() > super::points::MAX_POINTS {
            return Err(TargetError::TooManyPoints { limit: super::points::MAX_POINTS });
        }
        let ordered = ordering::order(points, |i| Row::Point(i + 1))?;
        let weights = vec![1.0; ordered.points.len()];
        let profile = Profile::fit(&ordered, &weights, Some(span))?;
        profile.meridian(span)
    }
}

/// A smooth profile in the source's unit, and the points it follows.
#[derive(Debug, Clone)]
pub(super) struct Profile {
    pub curve: PiecewiseCurve,
    /// Parameter of the profile's end, the apex if it reaches the axis.
    pub end: f64,
    samples: Vec<Sample>,
}

impl Profile {
    /// Fits a profile. With `span`, points past a corner at or beyond the hub, a lid say, are left out.
    pub fn fit(ordered: &OrderedPoints, weights: &[f64], span: Option<Span>) -> Result<Self, TargetError> {
        let mut samples: Vec<Sample> = ordered
            .points
            .iter()
            .zip(&ordered.parameters)
            .zip(weights)
            .map(|((&position, &t), &weight)| Sample { t, position, weight })
            .collect();
        let full = samples.last().map_or(0.0, |s| s.t);
        if let Some(corner) = span.and_then(|span| lid_corner(&samples, span)) {
            samples.truncate(corner);
        }
        let mut end = samples.last().map_or(full, |s| s.t);
        let apex = apex(&samples);
        if let Some(apex) = apex {
            end = apex;
        }
        // Scatter makes the polygon's arc length a poor parameter; the fitted curve's own is a good one.
        let mut curve = smoothing::fit(&samples, end, apex.is_some())?.curve;
        for _ in 0..REPARAMETRISATIONS {
            end = reparametrise(&mut samples, &curve, end, apex.is_some());
            curve = smoothing::fit(&samples, end, apex.is_some())?.curve;
        }
        Ok(Self { curve, end, samples })
    }

    /// Cuts and scales the profile.
    pub fn meridian(&self, span: Span) -> Result<FittedMeridian, TargetError> {
        let cut = scale::cut(&self.curve, self.end, span)?;
        let curve = SplineMeridian::new(self.curve.scaled(cut.scale), cut.parameter);
        let distances: Vec<f64> = self
            .samples
            .par_iter()
            .filter(|s| s.t <= cut.parameter)
            .map(|s| cut.scale * distance_to(&self.curve, s.t, s.position).abs())
            .collect();
        let squares: f64 = distances.iter().map(|d| d * d).sum();
        Ok(FittedMeridian {
            curve,
            scale: cut.scale,
            residual_rms_mm: (squares / distances.len().max(1) as f64).sqrt(),
            residual_max_mm: distances.iter().copied().fold(0.0, f64::max),
            revolution: None,
            source_points: self.samples.len(),
        })
    }
}

/// How often parameters are taken from the curve fitted before.
const REPARAMETRISATIONS: usize = 2;

/// Replaces every parameter by the arc length of the foot point on the curve, from the first sample's on; returns the
/// new end.
fn reparametrise(samples: &mut [Sample], curve: &PiecewiseCurve, end: f64, apex: bool) -> f64 {
    let lengths = ArcLengths::new(curve, end);
    samples.par_iter_mut().for_each(|s| s.t = lengths.at(curve, foot(curve, s.t, s.position)));
    let start = samples.first().map_or(0.0, |s| s.t);
    samples.iter_mut().for_each(|s| s.t -= start);
    if apex { lengths.at(curve, end) - start } else { samples.last().map_or(end, |s| s.t) }
}

/// Arc lengths at even parameters.
struct ArcLengths {
    step: f64,
    table: Vec<f64>,
}

impl ArcLengths {
    fn new(curve: &PiecewiseCurve, end: f64) -> Self {
        let count = ((end / curve.step()).ceil() as usize).max(1);
        let step = end / count as f64;
        let mut table = vec![0.0];
        let mut s = 0.0;
        for i in 0..count {
            s += arc(curve, step * i as f64, step * (i + 1) as f64);
            table.push(s);
        }
        Self { step, table }
    }

    /// Arc length from parameter 0 to `t`, also slightly outside the curve.
    fn at(&self, curve: &PiecewiseCurve, t: f64) -> f64 {
        let index = ((t / self.step).max(0.0) as usize).min(self.table.len() - 1);
        let base = self.table.get(index).copied().unwrap_or(0.0);
        base + arc(curve, self.step * index as f64, t)
    }
}

/// The parameter of the curve's point nearest to `p`, looked for near `start`.
fn foot(curve: &PiecewiseCurve, start: f64, p: [f64; 2]) -> f64 {
    let limit = 2.0 * curve.step();
    let mut t = start;
    for _ in 0..4 {
        let [r, d, ..] = curve.at(t);
        let v2 = (d[0] * d[0] + d[1] * d[1]).max(f64::MIN_POSITIVE);
        t = (t + ((p[0] - r[0]) * d[0] + (p[1] - r[1]) * d[1]) / v2).clamp(start - limit, start + limit);
    }
    t
}

/// Signed distance of a point from the curve near parameter `t`, positive on the outside: left of the way from rim to
/// hub in the plane of `x = -rho` and `z`.
pub(super) fn distance_to(curve: &PiecewiseCurve, t: f64, p: [f64; 2]) -> f64 {
    let [r, d, ..] = curve.at(foot(curve, t, p));
    let away = distance(p, r);
    // d = (rho', z'): the outward normal is (z', -rho').
    away.copysign((p[0] - r[0]) * d[1] - (p[1] - r[1]) * d[0])
}

/// Turn that makes a corner, degrees, and the share of the strip's length it happens in.
const CORNER_DEG: f64 = 20.0;
const CORNER_WINDOW: f64 = 0.02;
/// Corners are looked for among at most this many averages of neighbours.
const CORNER_GROUPS: usize = 1000;

/// The number of samples up to the first corner at or beyond the hub, if there is one.
///
/// A dome closed by a flat lid, or a strip's shape continued straight to the axis, has such a corner; a smooth curve
/// through it would be wrong just where the strip ends.
fn lid_corner(samples: &[Sample], span: Span) -> Option<usize> {
    let cut = samples.iter().find(|s| s.t > 0.0 && span.excess(s.position[0], s.t) <= 0.0).or(samples.last())?.t;
    let size = samples.len().div_ceil(CORNER_GROUPS).max(1);
    let groups: Vec<Sample> = samples.chunks(size).map(mean).collect();
    let window = CORNER_WINDOW * cut;
    // Three scattered points, the middle one counting twice, turn by this much for nothing.
    let points: Vec<[f64; 2]> = groups.iter().map(|s| s.position).collect();
    let noise_deg = (6.0_f64.sqrt() * ordering::scatter(&points) / window).to_degrees();
    let turn = |i: usize| turn_deg(&groups, i, window);
    let first = groups.partition_point(|s| s.t < cut * (1.0 - scale::CONTINUATION)).max(1);
    let last = groups.len().checked_sub(1)?;
    let found = (first..last).find(|&i| turn(i) > CORNER_DEG + 5.0 * noise_deg.min(CORNER_DEG))?;
    // The corner is the sharpest place within a window of the first one that turns enough.
    let until = groups.get(found)?.t + window;
    let corner = (found..last)
        .take_while(|&i| groups.get(i).is_some_and(|s| s.t <= until))
        .max_by(|&a, &b| turn(a).total_cmp(&turn(b)))?;
    Some(corner * size + 1)
}

fn mean(samples: &[Sample]) -> Sample {
    let count = samples.len().max(1) as f64;
    let sum = |value: fn(&Sample) -> f64| samples.iter().map(value).sum::<f64>() / count;
    Sample { t: sum(|s| s.t), position: [sum(|s| s.position[0]), sum(|s| s.position[1])], weight: 1.0 }
}

/// Angle between the chords before and after a sample, each a `window` long or one segment.
fn turn_deg(samples: &[Sample], i: usize, window: f64) -> f64 {
    let Some(here) = samples.get(i) else { return 0.0 };
    let before = samples.get(..i).unwrap_or_default().iter().rev().find(|s| here.t - s.t >= window);
    let after = samples.get(i + 1..).unwrap_or_default().iter().find(|s| s.t - here.t >= window);
    let (Some(a), Some(b)) = (before.or(samples.first()), after.or(samples.last())) else { return 0.0 };
    let u = [here.position[0] - a.position[0], here.position[1] - a.position[1]];
    let v = [b.position[0] - here.position[0], b.position[1] - here.position[1]];
    (u[0] * v[1] - u[1] * v[0]).atan2(u[0] * v[0] + u[1] * v[1]).abs().to_degrees()
}

/// The parameter at which samples that reach the axis meet it at a right angle; `None` for a hole or a pointed tip.
fn apex(samples: &[Sample]) -> Option<f64> {
    const STEEPEST_DEG: f64 = 12.0;
    let (last, before) = (samples.last()?, samples.get(samples.len().checked_sub(2)?)?);
    let rim = samples.first()?.position[0];
    let radius = last.position[0];
    // Rings end at the axis, or half a step before it.
    if radius > (1.0 * (last.t - before.t)).max(1e-6 * rim) || radius > 0.05 * rim {
        return None;
    }
    // The slope at the axis from parabolas through the last samples, over a few points or two hundredths of the length.
    let reach = last.t - (0.02 * last.t).max(last.t - samples.get(samples.len().saturating_sub(4))?.t);
    let tail: Vec<&Sample> = samples.iter().rev().take_while(|s| s.t >= reach).collect();
    let slope = slope_at(&tail, last.t)?;
    (slope[1].abs() <= STEEPEST_DEG.to_radians().tan() * slope[0].abs()).then_some(last.t + radius)
}

/// Derivative at `t` of the least-squares parabola through samples.
fn slope_at(samples: &[&Sample], t: f64) -> Option<[f64; 2]> {
    let mut normal = nalgebra::Matrix3::zeros();
    let mut right = nalgebra::Matrix3x2::zeros();
    let span = samples.iter().map(|s| (s.t - t).abs()).fold(0.0, f64::max);
    for s in samples {
        let u = (s.t - t) / span;
        let row = nalgebra::Vector3::new(1.0, u, u * u);
        normal += row * row.transpose();
        right += row * nalgebra::RowVector2::new(s.position[0], s.position[1]);
    }
    let solution = normal.cholesky()?.solve(&right);
    Some([solution[(1, 0)], solution[(1, 1)]])
}
