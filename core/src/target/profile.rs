//! A smooth profile through measured points, in their own unit.

use rayon::prelude::*;

use super::error::TargetError;
use super::fitted::FittedMeridian;
use super::ordering::{self, distance};
use super::scale::{self, Span};
use super::smoothing::{self, PiecewiseCurve, Sample};
use super::spline_curve::{SplineMeridian, arc};

/// A smooth profile in the source's unit, and the points it follows.
#[derive(Debug, Clone)]
pub(super) struct Profile {
    pub curve: PiecewiseCurve,
    /// Parameter of the profile's end, the apex if it reaches the axis.
    pub end: f64,
    /// The points whose distances from the curve are its residual.
    pub samples: Vec<Sample>,
}

impl Profile {
    /// Fits a profile to samples in the order of their parameters. The first `rim` of them lie on the rim and have the
    /// parameter 0 on average. With `span`, samples past a corner at or beyond the hub, a lid say, are left out. The
    /// parameters of `followers`, points that the samples stand for, are kept in step with theirs.
    pub fn fit(
        mut samples: Vec<Sample>,
        rim: usize,
        span: Option<Span>,
        followers: &mut [Sample],
    ) -> Result<Self, TargetError> {
        if let Some(corner) = span.and_then(|span| lid_corner(&samples, span)) {
            samples.truncate(corner);
        }
        let apex = apex(&samples);
        let mut end = apex.or(samples.last().map(|s| s.t)).unwrap_or(0.0);
        // Scatter makes the polygon's arc length a poor parameter; the fitted curve's own is a good one.
        let mut curve = smoothing::fit(&samples, end, apex.is_some())?.curve;
        for _ in 0..REPARAMETRISATIONS {
            end = reparametrise(&mut samples, followers, rim, &curve, end, apex.is_some());
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

/// Replaces every parameter by the arc length of the foot point on the curve, from the rim on; returns the new end.
fn reparametrise(
    samples: &mut [Sample],
    followers: &mut [Sample],
    rim: usize,
    curve: &PiecewiseCurve,
    end: f64,
    apex: bool,
) -> f64 {
    let lengths = ArcLengths::new(curve, end);
    let own = |s: &mut Sample| s.t = lengths.at(curve, foot(curve, s.t, s.position));
    samples.par_iter_mut().for_each(own);
    followers.par_iter_mut().for_each(own);
    let start = rim_parameter(samples, rim);
    samples.iter_mut().chain(followers).for_each(|s| s.t -= start);
    if apex { lengths.at(curve, end) - start } else { samples.last().map_or(end, |s| s.t) }
}

/// The mean parameter of the samples on the rim.
pub(super) fn rim_parameter(samples: &[Sample], rim: usize) -> f64 {
    let (sum, weight) =
        samples.iter().take(rim.max(1)).fold((0.0, 0.0), |(s, w), x| (s + x.weight * x.t, w + x.weight));
    if weight > 0.0 { sum / weight } else { 0.0 }
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
pub(super) fn foot(curve: &PiecewiseCurve, start: f64, p: [f64; 2]) -> f64 {
    let limit = 2.0 * curve.step();
    let mut t = start;
    for _ in 0..4 {
        let [r, d] = curve.position_and_velocity(t);
        let v2 = (d[0] * d[0] + d[1] * d[1]).max(f64::MIN_POSITIVE);
        let step = ((p[0] - r[0]) * d[0] + (p[1] - r[1]) * d[1]) / v2;
        t = curve.clamped((t + step).clamp(start - limit, start + limit));
        if step.abs() < 1e-12 * limit {
            break;
        }
    }
    t
}

/// Signed distance of a point from the curve near parameter `t`, positive on the outside: left of the way from rim to
/// hub in the plane of `x = -rho` and `z`.
pub(super) fn distance_to(curve: &PiecewiseCurve, t: f64, p: [f64; 2]) -> f64 {
    let [r, d] = curve.position_and_velocity(foot(curve, t, p));
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
    // Samples end on the axis or a step before it.
    if radius > (last.t - before.t).max(0.02 * last.t) || radius > 0.05 * rim {
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
