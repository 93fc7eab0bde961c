//! Checking and parametrising a sequence of meridian points.
//!
//! Points come in the order of the curve. They are turned so that the rim, the end with the larger radius, is first, and
//! get the arc length of the polygon through them as parameter. Measured points lie closer together than their scatter
//! at times; such a polygon zigzags. So directions and lengths are taken on a thinned polygon, whose points are at least
//! eight standard deviations of the scatter apart.

use super::error::{Row, TargetError};

/// Fewest different points of a meridian.
pub const MIN_POINTS: usize = 5;

/// Largest turn between consecutive segments, degrees. A right angle passes, also one that is slightly off.
const MAX_TURN_DEG: f64 = 100.0;
/// Points at most this share of the extent apart are one point.
const SAME_POINT: f64 = 1e-9;
/// Thinning never takes steps above this share of the extent.
const COARSEST_STEP: f64 = 0.05;
/// Segments the crossing test looks at, at most; the test takes their square.
const MAX_CROSSING_SEGMENTS: usize = 4000;

/// A meridian's points from rim to hub, each with its arc-length parameter.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct OrderedPoints {
    /// `[rho, z]`, in the source's unit.
    pub points: Vec<[f64; 2]>,
    /// Arc length of the thinned polygon up to each point, in the source's unit; the first is 0.
    pub parameters: Vec<f64>,
}

/// Orders points from rim to hub and gives them parameters; `row` names the i-th point in errors.
pub(super) fn order(points: &[[f64; 2]], row: impl Fn(usize) -> Row) -> Result<OrderedPoints, TargetError> {
    check_values(points, &row)?;
    let extent = extent(points);
    let mut indices: Vec<usize> = Vec::with_capacity(points.len());
    let mut previous: Option<[f64; 2]> = None;
    for (i, &p) in points.iter().enumerate() {
        if previous.is_none_or(|q| distance(p, q) > SAME_POINT * extent) {
            indices.push(i);
            previous = Some(p);
        }
    }
    if indices.len() < MIN_POINTS {
        return Err(TargetError::TooFewPoints { found: indices.len(), needed: MIN_POINTS });
    }
    let mut ordered: Vec<[f64; 2]> = indices.iter().filter_map(|&i| points.get(i).copied()).collect();
    if let (Some(first), Some(last)) = (ordered.first(), ordered.last())
        && first[0] < last[0]
    {
        ordered.reverse();
        indices.reverse();
    }
    let source = |k: usize| row(indices.get(k).copied().unwrap_or(0));
    let kept = thinned(&ordered, (8.0 * scatter(&ordered)).min(COARSEST_STEP * extent));
    check_turns(&ordered, &kept, &source)?;
    check_crossings(&ordered, &kept, &source)?;
    let parameters = parameters(&ordered, &kept);
    Ok(OrderedPoints { points: ordered, parameters })
}

pub(super) fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// The diagonal of the bounding box.
pub(super) fn extent(points: &[[f64; 2]]) -> f64 {
    let mut low = [f64::INFINITY; 2];
    let mut high = [f64::NEG_INFINITY; 2];
    for p in points {
        for k in 0..2 {
            low[k] = low[k].min(p[k]);
            high[k] = high[k].max(p[k]);
        }
    }
    if points.is_empty() { 0.0 } else { (high[0] - low[0]).hypot(high[1] - low[1]) }
}

fn check_values(points: &[[f64; 2]], row: &impl Fn(usize) -> Row) -> Result<(), TargetError> {
    for (i, p) in points.iter().enumerate() {
        for (value, column) in [(p[0], "rho"), (p[1], "z")] {
            // Squares and products of coordinates must stay finite too.
            if !value.is_finite() || value.abs() > 1e100 {
                return Err(TargetError::NotFinite { row: row(i), column, value });
            }
        }
        if p[0] < 0.0 {
            return Err(TargetError::NegativeRadius { row: row(i), value: p[0] });
        }
    }
    Ok(())
}

/// Standard deviation of the points about a smooth curve, from the median second difference: of normal scatter `sigma`
/// in both coordinates it has the Rayleigh scale `sqrt(6) sigma` and the median `1.1774 sqrt(6) sigma`.
pub(super) fn scatter(points: &[[f64; 2]]) -> f64 {
    let mut differences: Vec<f64> = points
        .windows(3)
        .filter_map(|w| match w {
            [a, b, c] => Some((a[0] - 2.0 * b[0] + c[0]).hypot(a[1] - 2.0 * b[1] + c[1])),
            _ => None,
        })
        .collect();
    if differences.is_empty() {
        return 0.0;
    }
    let middle = differences.len() / 2;
    let (_, median, _) = differences.select_nth_unstable_by(middle, f64::total_cmp);
    *median / (1.177_41 * 6.0_f64.sqrt())
}

/// Indices of points at least `step` apart, the two ends included.
fn thinned(points: &[[f64; 2]], step: f64) -> Vec<usize> {
    let mut kept = vec![0];
    let mut last = points.first().copied().unwrap_or_default();
    for (i, &p) in points.iter().enumerate().skip(1) {
        if distance(p, last) >= step {
            kept.push(i);
            last = p;
        }
    }
    let end = points.len().saturating_sub(1);
    if kept.last() != Some(&end) {
        // The end is closer than a step to the last kept point and takes its place.
        if kept.len() > 2 {
            kept.pop();
        }
        kept.push(end);
    }
    kept
}

fn check_turns(points: &[[f64; 2]], kept: &[usize], row: &impl Fn(usize) -> Row) -> Result<(), TargetError> {
    for w in kept.windows(3) {
        let &[i, j, k] = w else { continue };
        let (Some(a), Some(b), Some(c)) = (points.get(i), points.get(j), points.get(k)) else { continue };
        let (u, v) = ([b[0] - a[0], b[1] - a[1]], [c[0] - b[0], c[1] - b[1]]);
        let turn = (u[0] * v[1] - u[1] * v[0]).atan2(u[0] * v[0] + u[1] * v[1]).abs().to_degrees();
        if turn > MAX_TURN_DEG {
            return Err(TargetError::DoublesBack { row: row(j), angle_deg: turn, limit_deg: MAX_TURN_DEG });
        }
    }
    Ok(())
}

fn check_crossings(points: &[[f64; 2]], kept: &[usize], row: &impl Fn(usize) -> Row) -> Result<(), TargetError> {
    let stride = kept.len().div_ceil(MAX_CROSSING_SEGMENTS).max(1);
    let mut corners: Vec<(usize, [f64; 2])> =
        kept.iter().step_by(stride).filter_map(|&i| points.get(i).map(|&p| (i, p))).collect();
    if let (Some(&end), Some(&p)) = (kept.last(), points.last())
        && corners.last().map(|c| c.0) != Some(end)
    {
        corners.push((end, p));
    }
    let segments: Vec<_> = corners.iter().zip(corners.iter().skip(1)).collect();
    for (n, &(a, b)) in segments.iter().enumerate() {
        for &(c, d) in segments.iter().skip(n + 2) {
            if boxes_touch(a.1, b.1, c.1, d.1) && cross(a.1, b.1, c.1, d.1) {
                return Err(TargetError::CrossesItself { row: row(c.0), other: row(a.0) });
            }
        }
    }
    Ok(())
}

fn boxes_touch(a: [f64; 2], b: [f64; 2], c: [f64; 2], d: [f64; 2]) -> bool {
    (0..2).all(|k| a[k].min(b[k]) <= c[k].max(d[k]) && c[k].min(d[k]) <= a[k].max(b[k]))
}

fn cross(a: [f64; 2], b: [f64; 2], c: [f64; 2], d: [f64; 2]) -> bool {
    let side = |p: [f64; 2], q: [f64; 2], r: [f64; 2]| (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
    side(a, b, c) * side(a, b, d) <= 0.0 && side(c, d, a) * side(c, d, b) <= 0.0
}

/// Arc length along the thinned polygon; points in between are projected on their segment.
fn parameters(points: &[[f64; 2]], kept: &[usize]) -> Vec<f64> {
    let mut parameters = vec![0.0; points.len()];
    let mut start = 0.0;
    for w in kept.windows(2) {
        let &[i, j] = w else { continue };
        let (Some(&a), Some(&b)) = (points.get(i), points.get(j)) else { continue };
        let length = distance(a, b);
        for (k, parameter) in parameters.iter_mut().enumerate().take(j + 1).skip(i) {
            let p = points.get(k).copied().unwrap_or(a);
            let along = ((p[0] - a[0]) * (b[0] - a[0]) + (p[1] - a[1]) * (b[1] - a[1])) / length;
            *parameter = start + along.clamp(0.0, length);
        }
        start += length;
    }
    parameters
}
