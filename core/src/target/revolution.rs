//! Axis, outer meridian and roundness of a mesh.
//!
//! Each candidate axis gives an outline; the vertices on its outer piece, in radius and height, are fitted by a smooth
//! profile. The signed distances `r` of the vertices from the profile tell how far the mesh is from a surface of
//! revolution, and how the axis must move: a shift `d` across the axis and a small turn `w` change them by
//! `-n_rho (d . e_rho) + n_rho z (w x e_z) . e_rho - n_z rho (w x e_z) . e_rho`, with `n` the profile's outward normal and
//! `e_rho` the radial direction of the vertex. Gauss and Newton's steps follow; since the profile follows the vertices,
//! means along each ring are taken off both sides first. Directions that change nothing, turns about a sphere's centre,
//! are left alone: there the moments of area decide.

use nalgebra::{Matrix4, SymmetricEigen, Vector4};
use rayon::prelude::*;

use super::axis::{Axis, Frame, Surface};
use super::error::TargetError;
use super::fitted::FittedMeridian;
use super::ordering::MIN_POINTS;
use super::outline::{Cylindrical, Outline};
use super::profile::{Profile, distance_to, rim_parameter};
use super::scale::Span;
use super::smoothing::{PiecewiseCurve, Sample};
use crate::progress::Cancelled;

/// Largest accepted rms distance from the surface of revolution, share of the rim radius.
const MAX_SHARE: f64 = 0.02;
/// An axis this good needs no rival.
const GOOD_SHARE: f64 = 1e-3;
/// A mesh goes all the way round if no gap between its vertices' azimuths is larger, degrees.
const MAX_GAP_DEG: f64 = 150.0;
/// Vertices the axis is looked for with, at most.
const SEARCH_VERTICES: usize = 20_000;
/// Vertices the profile is fitted to and held against, at most: a pass over them can be cancelled before and after it only.
const FINAL_VERTICES: usize = 500_000;
/// Slices tried in the search and in the end.
const SEARCH_SLICES: usize = 4;
const FINAL_SLICES: usize = 12;
/// Groups of vertices with the same place along the outline.
const GROUPS: f64 = 2000.0;
/// Share of the outline's length that a group may take to go round.
const WIDEST_GROUP: f64 = 0.05;
/// Fewest vertices on the outer surface: fewer, a cube's eight, lie near many a surface of revolution.
const MIN_VERTICES: usize = 30;
/// Gauss-Newton steps.
const STEPS: usize = 10;
/// Directions whose eigenvalue is below this share of the largest are not determined by the distances.
const DETERMINED: f64 = 1e-3;

/// The axis of a mesh and how far the mesh is from a surface of revolution about it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RevolutionFit {
    /// Unit vector along the axis, from rim to apex.
    pub axis_direction: [f64; 3],
    /// A point of the axis, in the mesh's unit: the centre of the rim.
    pub axis_point: [f64; 3],
    /// Root mean square distance of the vertices of the outer surface from the fitted surface of revolution, as a share
    /// of the rim radius.
    pub rms_share: f64,
}

/// How the sense of an axis is chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Sense {
    /// The wider end of the outline is the lower one.
    WideEndBelow,
    /// As given.
    Given,
}

/// A profile about one axis.
struct Attempt {
    frame: Frame,
    profile: Profile,
    /// Numbers of the vertices of the outer surface; their samples are the profile's.
    vertices: Vec<usize>,
    share: f64,
}

/// The meridian of a mesh that passed the checks.
pub(super) fn meridian(
    vertices: &[[f64; 3]],
    triangles: &[[u32; 3]],
    axis: Axis,
    span: Span,
    cancelled: Cancelled<'_>,
) -> Result<FittedMeridian, TargetError> {
    let direction = axis.direction()?;
    let surface = Surface::new(vertices, triangles, cancelled)?;
    let sense = if matches!(axis, Axis::Vector(_)) { Sense::Given } else { Sense::WideEndBelow };
    let frame = match direction {
        Some(direction) => directed(&surface, direction, sense)?,
        None => free(&surface)?,
    };
    let last = attempt(&surface, &frame, sense, FINAL_SLICES, FINAL_VERTICES, Some(span))?;
    if last.share.is_nan() || last.share > MAX_SHARE {
        return Err(TargetError::NotARevolution {
            share_percent: 100.0 * last.share,
            limit_percent: 100.0 * MAX_SHARE,
        });
    }
    let mut fitted = last.profile.meridian(span)?;
    let rim = last.profile.curve.at(0.0)[0];
    let centre = last.frame.point + last.frame.direction * rim[1];
    fitted.scale /= surface.size;
    fitted.revolution = Some(RevolutionFit {
        axis_direction: last.frame.direction.into(),
        axis_point: (surface.centre + centre * surface.size).into(),
        rms_share: last.share,
    });
    Ok(fitted)
}

/// The best axis parallel to a given direction.
fn directed(surface: &Surface, direction: nalgebra::Vector3<f64>, sense: Sense) -> Result<Frame, TargetError> {
    let mut best: Option<Attempt> = None;
    let mut problem = TargetError::AxisUndetermined;
    for frame in surface.directed_candidates(direction)? {
        match refined(surface, &frame, sense, 2) {
            Ok(found) if best.as_ref().is_none_or(|b| found.share < b.share) => best = Some(found),
            Ok(_) => {}
            Err(TargetError::Cancelled) => return Err(TargetError::Cancelled),
            Err(error) => problem = error,
        }
    }
    best.map(|b| b.frame).ok_or(problem)
}

/// The best axis of a mesh that goes all the way round.
fn free(surface: &Surface) -> Result<Frame, TargetError> {
    let mut best: Option<Attempt> = None;
    let mut problem = TargetError::AxisUndetermined;
    for frame in surface.free_candidates()? {
        match refined(surface, &frame, Sense::WideEndBelow, 4) {
            // Later candidates are less trustworthy: they must be clearly better.
            Ok(found) if largest_gap_deg(surface, &found) <= MAX_GAP_DEG => {
                if best.as_ref().is_none_or(|b| found.share < 0.7 * b.share - 1e-6) {
                    best = Some(found);
                }
            }
            Ok(_) => {}
            Err(TargetError::Cancelled) => return Err(TargetError::Cancelled),
            Err(error) => problem = error,
        }
        if best.as_ref().is_some_and(|b| b.share < GOOD_SHARE) {
            break;
        }
    }
    best.map(|b| b.frame).ok_or(problem)
}

/// An axis improved as long as the vertices come nearer; `freedoms` is 2 for shifts alone, 4 for shifts and turns.
fn refined(surface: &Surface, frame: &Frame, sense: Sense, freedoms: usize) -> Result<Attempt, TargetError> {
    let search = |frame: &Frame| attempt(surface, frame, sense, SEARCH_SLICES, SEARCH_VERTICES, None);
    let mut best = search(frame)?;
    for _ in 0..STEPS {
        let Some(next) = step(surface, &best, freedoms) else { break };
        match search(&next) {
            Ok(found) if found.share < 0.999 * best.share => best = found,
            Err(TargetError::Cancelled) => return Err(TargetError::Cancelled),
            _ => break,
        }
    }
    Ok(best)
}

/// Outline, profile and distances about one axis.
fn attempt(
    surface: &Surface,
    frame: &Frame,
    sense: Sense,
    slices: usize,
    most_vertices: usize,
    span: Option<Span>,
) -> Result<Attempt, TargetError> {
    let mut frame = *frame;
    let mut cylindrical = Cylindrical::new(surface, &frame)?;
    let no_outline = TargetError::TooFewRings { found: 0, needed: MIN_POINTS };
    let mut outline = cylindrical.outline(slices)?.ok_or(no_outline.clone())?;
    if outline.upside_down {
        if sense == Sense::Given {
            let (lower, upper) = outline.end_radii();
            return Err(TargetError::AxisReversed { lower: lower * surface.size, upper: upper * surface.size });
        }
        frame = Frame::new(frame.point, -frame.direction);
        cylindrical = Cylindrical::new(surface, &frame)?;
        outline = cylindrical.outline(slices)?.ok_or(no_outline)?;
    }
    let (vertices, mut samples) = on_outline(&cylindrical, &outline, most_vertices);
    if samples.len() < MIN_VERTICES {
        return Err(TargetError::TooFewVertices { found: samples.len(), needed: MIN_VERTICES });
    }
    let sectors: Vec<u8> = vertices.iter().map(|&i| cylindrical.local.get(i).map_or(0, |p| sector(*p))).collect();
    surface.go_on()?;
    let first = Profile::fit(grouped(&mut samples, &sectors, None)?, 1, None, &mut samples)?;
    surface.go_on()?;
    // What lies within the scatter of the lowest vertices is the rim.
    let scatter = root_mean_square(&first, &samples);
    let groups = grouped(&mut samples, &sectors, Some(&first.curve))?;
    let rim = groups.iter().take_while(|s| s.t <= 4.0 * scatter).count().max(1);
    let start = rim_parameter(&groups, rim);
    // The curve's own rim means nothing about a wrong axis, where the curve may be wild.
    let (sum, weight) =
        groups.iter().take(rim).fold((0.0, 0.0), |(r, w), s| (r + s.weight * s.position[0], w + s.weight));
    let rim_radius = sum / weight;
    surface.go_on()?;
    let groups = groups.into_iter().map(|s| Sample { t: s.t - start, ..s }).collect();
    samples.iter_mut().for_each(|s| s.t -= start);
    let mut profile = Profile::fit(groups, rim, span, &mut samples)?;
    let share = root_mean_square(&profile, &samples) / rim_radius;
    profile.samples = samples;
    Ok(Attempt { frame, profile, vertices, share })
}

/// The vertices on the outer piece, at most about `most`, and their places along it.
fn on_outline(cylindrical: &Cylindrical, outline: &Outline, most: usize) -> (Vec<usize>, Vec<Sample>) {
    let stride = cylindrical.plane.len().div_ceil(most).max(1);
    cylindrical
        .plane
        .par_iter()
        .enumerate()
        .filter(|(i, _)| i % stride == 0)
        .filter_map(|(i, &position)| Some((i, Sample { t: outline.place(position)?, position, weight: 1.0 })))
        .unzip()
}

/// One of eight sectors about the axis.
fn sector([x, y, _]: [f64; 3]) -> u8 {
    let eighth = (y.atan2(x) / std::f64::consts::FRAC_PI_4).floor();
    eighth.rem_euclid(8.0) as u8
}

/// Means of neighbouring samples, the lowest at parameter 0; the samples' parameters are moved along.
///
/// A group ends where it holds samples from all round: else a curve could wind through the deviations of a mesh that is
/// not round, from one side's vertices to the other's. With a `curve` near the samples, means are taken of their
/// distances from it, not of their positions, so that wide groups do not flatten the profile.
fn grouped(samples: &mut [Sample], sectors: &[u8], curve: Option<&PiecewiseCurve>) -> Result<Vec<Sample>, TargetError> {
    let mut ordered: Vec<(Sample, u8)> = samples.iter().copied().zip(sectors.iter().copied()).collect();
    ordered.par_sort_by(|a, b| a.0.t.total_cmp(&b.0.t));
    let bit = |sector: u8| 1_u32 << (sector % 8);
    // Part of a turn fills some sectors; those with hardly a vertex are not waited for.
    let mut counts = [0_usize; 8];
    ordered.iter().for_each(|s| counts[usize::from(s.1 % 8)] += 1);
    let filled = counts.iter().copied().max().unwrap_or(0) / 4;
    let all = (0..8).filter(|&k| counts[k] > filled).fold(0, |bits, k| bits | bit(k as u8));
    let length = ordered.first().zip(ordered.last()).map_or(0.0, |(a, b)| b.0.t - a.0.t);
    let widest = ordered.iter().map(|s| s.0.position[0]).fold(0.0, f64::max);
    let mut groups: Vec<Sample> = Vec::new();
    let mut open: Vec<Sample> = Vec::new();
    let mut bits = 0_u32;
    for &(sample, sector) in &ordered {
        let width = open.first().map_or(0.0, |first| sample.t - first.t);
        let round = bits & all == all || width > WIDEST_GROUP * length;
        // An apex stands for all sides at once.
        let apex = sample.position[0] < 1e-3 * widest;
        if !open.is_empty() && width > length / GROUPS && (round || apex) {
            groups.push(mean(&open, curve));
            open.clear();
            bits = 0;
        }
        open.push(sample);
        bits |= if apex { u32::MAX } else { bit(sector) };
    }
    // The last ones, from some sides only, would pull the end aside.
    if bits & all == all || groups.is_empty() {
        groups.push(mean(&open, curve));
    }
    if groups.len() < MIN_POINTS {
        return Err(TargetError::TooFewRings { found: groups.len(), needed: MIN_POINTS });
    }
    let start = groups.first().map_or(0.0, |s| s.t);
    groups.iter_mut().chain(samples).for_each(|s| s.t -= start);
    Ok(groups)
}

fn mean(group: &[Sample], curve: Option<&PiecewiseCurve>) -> Sample {
    let count = group.len() as f64;
    let mean = |value: &dyn Fn(&Sample) -> f64| group.iter().map(value).sum::<f64>() / count;
    let t = mean(&|s| s.t);
    let position = match curve {
        None => [mean(&|s| s.position[0]), mean(&|s| s.position[1])],
        Some(curve) => {
            let away = mean(&|s| distance_to(curve, s.t, s.position));
            let [p, d, ..] = curve.at(t);
            let speed = d[0].hypot(d[1]).max(f64::MIN_POSITIVE);
            [p[0] + away * d[1] / speed, p[1] - away * d[0] / speed]
        }
    };
    Sample { t, position, weight: count }
}

fn root_mean_square(profile: &Profile, samples: &[Sample]) -> f64 {
    let squares: f64 = samples.par_iter().map(|s| distance_to(&profile.curve, s.t, s.position).powi(2)).sum();
    (squares / samples.len().max(1) as f64).sqrt()
}

/// The largest gap between the azimuths of the outer surface's vertices, degrees.
fn largest_gap_deg(surface: &Surface, attempt: &Attempt) -> f64 {
    let samples = &attempt.profile.samples;
    let widest = samples.iter().map(|s| s.position[0]).fold(0.0, f64::max);
    let mut azimuths: Vec<f64> = attempt
        .vertices
        .iter()
        .zip(samples)
        .filter(|(_, s)| s.position[0] > 0.3 * widest)
        .filter_map(|(&i, _)| surface.vertices.get(i))
        .map(|p| attempt.frame.local(p))
        .map(|[x, y, _]| y.atan2(x).to_degrees())
        .collect();
    azimuths.sort_by(f64::total_cmp);
    let (Some(first), Some(last)) = (azimuths.first(), azimuths.last()) else { return 360.0 };
    let gaps = azimuths.windows(2).map(|w| if let [a, b] = w { b - a } else { 0.0 });
    gaps.fold(360.0 - (last - first), f64::max)
}

/// One Gauss-Newton step of the axis; `None` if nothing is determined.
fn step(surface: &Surface, attempt: &Attempt, freedoms: usize) -> Option<Frame> {
    const RINGS: usize = 40;
    let row = |(i, s): (&usize, &Sample)| -> Option<(f64, Vector4<f64>, f64)> {
        let [x, y, z] = attempt.frame.local(surface.vertices.get(*i)?);
        let (rho, d) = (x.hypot(y), attempt.profile.curve.at(s.t)[1]);
        if rho == 0.0 {
            return None;
        }
        let speed = d[0].hypot(d[1]);
        let (n_rho, n_z) = (d[1] / speed, -d[0] / speed);
        let (c, s_) = (x / rho, y / rho);
        let row = Vector4::new(-n_rho * c, -n_rho * s_, n_rho * s_ * z - n_z * y, -n_rho * c * z + n_z * x);
        Some((s.t, row, distance_to(&attempt.profile.curve, s.t, s.position)))
    };
    let mut rows: Vec<(f64, Vector4<f64>, f64)> =
        attempt.vertices.iter().zip(&attempt.profile.samples).filter_map(row).collect();
    rows.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (mut normal, mut right) = (Matrix4::zeros(), Vector4::zeros());
    for ring in rows.chunks(rows.len().div_ceil(RINGS).max(1)) {
        let count = ring.len() as f64;
        let mean_row = ring.iter().fold(Vector4::zeros(), |sum, r| sum + r.1) / count;
        let mean = ring.iter().map(|r| r.2).sum::<f64>() / count;
        for (_, row, distance) in ring {
            let row = row - mean_row;
            normal += row * row.transpose();
            right -= row * (distance - mean);
        }
    }
    for k in freedoms..4 {
        normal.row_mut(k).fill(0.0);
        normal.column_mut(k).fill(0.0);
        right[k] = 0.0;
    }
    let eigen = SymmetricEigen::new(normal);
    let largest = eigen.eigenvalues.max();
    let mut x = Vector4::zeros();
    for (k, &value) in eigen.eigenvalues.iter().enumerate() {
        if value > DETERMINED * largest {
            let v: Vector4<f64> = eigen.eigenvectors.column(k).into();
            x += v * (v.dot(&right) / value);
        }
    }
    let Frame { point, direction, u, v } = attempt.frame;
    let next = Frame::new(point + u * x[0] + v * x[1], direction + u * x[3] - v * x[2]);
    (x.iter().all(|c| c.is_finite()) && x.norm() > 1e-12).then_some(next)
}
