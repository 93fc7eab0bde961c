//! The outline of a mesh about an axis: the curve its outer surface sweeps.
//!
//! Vertices are taken to the half-plane of radius and height, and a half-plane through the axis picks the triangles whose
//! images follow one another. Between two vertices the radius is interpolated, not the position: the chord between two
//! vertices of one ring then stays on the ring instead of cutting inside it. The chain of images is split at corners, at
//! the axis and at the widest place of a surface closed at both ends; the piece that has all others inside is the outer
//! one. Bases, lids, rims of thick domes and inner surfaces are pieces of their own.

use std::collections::HashMap;

use super::axis::{Frame, Surface};
use super::error::TargetError;
use super::ordering::{distance, extent, scatter};
use crate::progress::stops_at;

/// Turn that ends a piece, degrees: a belly at 120 degrees on a flat base still has it.
const CORNER_DEG: f64 = 55.0;
/// A corner happens within this share of the outline's extent; scatter widens it up to the second share.
const CORNER_WINDOW: [f64; 2] = [0.02, 0.15];
/// Ends of chains nearer than this share of the extent are joined: meshes from CAD have seams that do not match.
const SEAM: f64 = 0.005;
/// More chains than this are a soup that joining does not mend.
const MAX_CHAINS: usize = 64;
/// Points a piece is reduced to.
const MAX_CORNERS: usize = 256;
/// Pieces this much shorter than the longest are no candidates for the outer one.
const SHORT: f64 = 0.4;

/// A mesh in the coordinates of an axis.
pub(super) struct Cylindrical<'a> {
    pub surface: &'a Surface<'a>,
    /// Coordinates across the axis and along it.
    pub local: Vec<[f64; 3]>,
    /// `[rho, z]`.
    pub plane: Vec<[f64; 2]>,
}

/// The pieces of one slice.
#[derive(Debug, Clone)]
pub(super) struct Outline {
    /// The outer piece comes first, from its wide end, the rim, to the other.
    pieces: Vec<Vec<[f64; 2]>>,
    /// Whether the rim is above the other end.
    pub upside_down: bool,
    pub length: f64,
}

impl<'a> Cylindrical<'a> {
    /// The mesh seen from an axis.
    ///
    /// # Errors
    ///
    /// [`TargetError::Cancelled`].
    pub fn new(surface: &'a Surface<'a>, frame: &Frame) -> Result<Self, TargetError> {
        let mut local = Vec::with_capacity(surface.vertices.len());
        let mut plane = Vec::with_capacity(surface.vertices.len());
        for (i, p) in surface.vertices.iter().enumerate() {
            if stops_at(i, surface.cancelled) {
                return Err(TargetError::Cancelled);
            }
            let [x, y, z] = frame.local(p);
            local.push([x, y, z]);
            plane.push([x.hypot(y), z]);
        }
        Ok(Self { surface, local, plane })
    }

    /// The outline with the longest outer piece among `count` slices.
    ///
    /// # Errors
    ///
    /// [`TargetError::Cancelled`].
    pub fn outline(&self, count: usize) -> Result<Option<Outline>, TargetError> {
        let triangles = &self.surface.triangles;
        // Through triangles, so that a part of a turn is met; the steps are uneven to avoid meeting one ring again.
        let directions = (0..count)
            .filter_map(|i| triangles.get((((i as f64 + 0.5) * 0.618_034).fract() * triangles.len() as f64) as usize))
            .filter_map(|triangle| {
                let sum = triangle
                    .iter()
                    .filter_map(|&i| self.local.get(i as usize))
                    .fold([0.0; 2], |s, p| [s[0] + p[0], s[1] + p[1]]);
                let norm = sum[0].hypot(sum[1]);
                (norm > 0.0).then(|| [sum[0] / norm, sum[1] / norm])
            });
        let mut longest: Option<Outline> = None;
        for across in directions {
            let found = Outline::new(self.chains(across)?);
            // Of equals the last one, as `max_by` takes it.
            longest = match (longest, found) {
                (Some(old), Some(new)) if new.length.total_cmp(&old.length).is_lt() => Some(old),
                (old, new) => new.or(old),
            };
        }
        Ok(longest)
    }

    /// Chains of points where the half-plane from the axis towards `across` cuts the mesh.
    fn chains(&self, across: [f64; 2]) -> Result<Vec<Vec<[f64; 2]>>, TargetError> {
        let side: Vec<f64> = self.local.iter().map(|p| across[0] * p[1] - across[1] * p[0]).collect();
        let forward = |i: u32| self.local.get(i as usize).map_or(0.0, |p| across[0] * p[0] + across[1] * p[1]);
        let side_of = |i: u32| side.get(i as usize).copied().unwrap_or(0.0);
        let mut nodes: Vec<[f64; 2]> = Vec::new();
        let mut known: HashMap<(u32, u32), usize> = HashMap::new();
        let mut links: Vec<Vec<usize>> = Vec::new();
        let mut node = |a: u32, b: u32| -> Option<usize> {
            let (a, b) = (a.min(b), a.max(b));
            let (da, db) = (side_of(a), side_of(b));
            let w = da / (da - db);
            // An apex on the axis is on the half-plane to rounding.
            if (1.0 - w) * forward(a) + w * forward(b) < -1e-9 {
                return None;
            }
            let (p, q) = (self.plane.get(a as usize)?, self.plane.get(b as usize)?);
            Some(*known.entry((a, b)).or_insert_with(|| {
                nodes.push([(1.0 - w) * p[0] + w * q[0], (1.0 - w) * p[1] + w * q[1]]);
                nodes.len() - 1
            }))
        };
        for (i, &[a, b, c]) in self.surface.triangles.iter().enumerate() {
            if stops_at(i, self.surface.cancelled) {
                return Err(TargetError::Cancelled);
            }
            let [sa, sb, sc] = [a, b, c].map(|i| side_of(i) >= 0.0);
            if sa == sb && sb == sc {
                continue;
            }
            // The corner on its own side is cut off from the other two.
            let (alone, m, n) = if sb == sc {
                (a, b, c)
            } else if sa == sc {
                (b, a, c)
            } else {
                (c, a, b)
            };
            if let (Some(i), Some(j)) = (node(alone, m), node(alone, n)) {
                links.resize(links.len().max(i.max(j) + 1), Vec::new());
                for (from, to) in [(i, j), (j, i)] {
                    if let Some(list) = links.get_mut(from) {
                        list.push(to);
                    }
                }
            }
        }
        links.resize(nodes.len(), Vec::new());
        Ok(walk(&nodes, &links))
    }
}

/// Follows links from ends and branchings first, then round the loops.
fn walk(nodes: &[[f64; 2]], links: &[Vec<usize>]) -> Vec<Vec<[f64; 2]>> {
    let mut used = vec![false; nodes.len()];
    let mut chains = Vec::new();
    let degree = |i: usize| links.get(i).map_or(0, Vec::len);
    let ends = (0..nodes.len()).filter(|&i| degree(i) == 1);
    for start in ends.chain(0..nodes.len()) {
        let mut chain: Vec<[f64; 2]> = Vec::new();
        let mut next = Some(start);
        let mut last = start;
        while let Some(i) = next {
            match used.get_mut(i) {
                Some(used) if !*used => *used = true,
                _ => break,
            }
            last = i;
            chain.extend(nodes.get(i));
            next = links.get(i).and_then(|l| l.iter().copied().find(|&j| used.get(j) == Some(&false)));
        }
        // A loop is closed by its first point.
        if chain.len() > 2 && links.get(last).is_some_and(|l| l.contains(&start)) {
            chain.extend(nodes.get(start));
        }
        if chain.len() > 1 {
            chains.push(chain);
        }
    }
    chains
}

impl Outline {
    fn new(chains: Vec<Vec<[f64; 2]>>) -> Option<Self> {
        let all: Vec<[f64; 2]> = chains.iter().flatten().copied().collect();
        let size = extent(&all);
        let chains = joined(chains, SEAM * size);
        let mut pieces: Vec<Vec<[f64; 2]>> = Vec::new();
        for chain in &chains {
            pieces.extend(split_at_corners(&without_repeats(chain, 1e-9 * size), size));
        }
        let mut pieces: Vec<Vec<[f64; 2]>> = pieces.into_iter().flat_map(split_if_closed).map(reduced).collect();
        pieces.retain(|p| p.len() > 1);
        for piece in &mut pieces {
            // From the wide end on.
            if let (Some(first), Some(last)) = (piece.first(), piece.last())
                && first[0] < last[0]
            {
                piece.reverse();
            }
        }
        let longest = pieces.iter().map(|p| polygon_length(p)).fold(0.0, f64::max);
        let candidates: Vec<usize> = (0..pieces.len())
            .filter(|&i| pieces.get(i).is_some_and(|p| polygon_length(p) >= SHORT * longest))
            .collect();
        let rise = |i: usize| pieces.get(i).map_or(0.0, |p| rise(p));
        // The pieces that climb most tell up from down; the halves of a sphere are equal, and up stays up.
        let highest = candidates.iter().map(|&i| rise(i).abs()).fold(0.0, f64::max);
        let upside_down = !candidates.iter().any(|&i| rise(i) >= 0.9 * highest);
        let up = if upside_down { -1.0 } else { 1.0 };
        // Outside is where no other candidate lies; the least offence wins where pieces interleave.
        let offence = |i: usize| {
            candidates
                .iter()
                .filter(|&&j| j != i)
                .filter_map(|&j| Some(mean_offset(pieces.get(i)?, pieces.get(j)?) * up))
                .fold(f64::NEG_INFINITY, f64::max)
        };
        let outer = candidates.iter().copied().min_by(|&i, &j| offence(i).total_cmp(&offence(j)))?;
        pieces.swap(0, outer);
        let length = pieces.first().map_or(0.0, |p| polygon_length(p));
        Some(Self { pieces, upside_down, length })
    }

    /// Radii of the lower and the upper end of the outer piece.
    pub fn end_radii(&self) -> (f64, f64) {
        let ends = self.pieces.first().and_then(|p| Some((p.first()?[0], p.last()?[0])));
        let (rim, hub) = ends.unwrap_or_default();
        if self.upside_down { (hub, rim) } else { (rim, hub) }
    }

    /// The place of a point on the outer piece; `None` if another piece is nearer.
    pub fn place(&self, p: [f64; 2]) -> Option<f64> {
        let (outer, others) = self.pieces.split_first()?;
        let (d, t, _) = nearest(outer, p)?;
        let other = others.iter().filter_map(|piece| nearest(piece, p)).map(|n| n.0).fold(f64::INFINITY, f64::min);
        // A rim's vertices belong to the dome and to its base.
        (d <= other + 1e-6 * self.length).then_some(t)
    }
}

fn polygon_length(piece: &[[f64; 2]]) -> f64 {
    piece.windows(2).map(|w| if let [a, b] = w { distance(*a, *b) } else { 0.0 }).sum()
}

fn rise(piece: &[[f64; 2]]) -> f64 {
    piece.first().zip(piece.last()).map_or(0.0, |(a, b)| b[1] - a[1])
}

fn without_repeats(chain: &[[f64; 2]], same: f64) -> Vec<[f64; 2]> {
    let mut out: Vec<[f64; 2]> = Vec::new();
    for &p in chain {
        if out.last().is_none_or(|&q| distance(p, q) > same) {
            out.push(p);
        }
    }
    out
}

/// Joins chains whose ends nearly meet.
fn joined(mut chains: Vec<Vec<[f64; 2]>>, seam: f64) -> Vec<Vec<[f64; 2]>> {
    if chains.len() > MAX_CHAINS {
        return chains;
    }
    let near = |p: Option<&[f64; 2]>, q: Option<&[f64; 2]>| p.zip(q).is_some_and(|(p, q)| distance(*p, *q) <= seam);
    let mut done = Vec::new();
    while let Some(mut chain) = chains.pop() {
        loop {
            let matches = |other: &Vec<[f64; 2]>| {
                [(chain.last(), other.first()), (chain.last(), other.last()), (chain.first(), other.first())]
                    .into_iter()
                    .chain([(chain.first(), other.last())])
                    .any(|(p, q)| near(p, q))
            };
            let Some(i) = chains.iter().position(matches) else { break };
            let mut other = chains.swap_remove(i);
            if !near(chain.last(), other.first()) && !near(chain.last(), other.last()) {
                chain.reverse();
            }
            if !near(chain.last(), other.first()) {
                other.reverse();
            }
            chain.append(&mut other);
        }
        done.push(chain);
    }
    done
}

/// Pieces between corners.
fn split_at_corners(chain: &[[f64; 2]], size: f64) -> Vec<Vec<[f64; 2]>> {
    let mut arc = vec![0.0];
    for w in chain.windows(2) {
        if let [a, b] = w {
            arc.push(arc.last().copied().unwrap_or(0.0) + distance(*a, *b));
        }
    }
    let [narrow, wide] = CORNER_WINDOW;
    let window = (14.0 * scatter(chain)).clamp(narrow * size, wide * size);
    let turn_between = |before: usize, i: usize, after: usize| -> f64 {
        let (Some(a), Some(here), Some(b)) = (chain.get(before), chain.get(i), chain.get(after)) else { return 0.0 };
        let (u, v) = ([here[0] - a[0], here[1] - a[1]], [b[0] - here[0], b[1] - here[1]]);
        (u[0] * v[1] - u[1] * v[0]).atan2(u[0] * v[0] + u[1] * v[1]).abs().to_degrees()
    };
    let turn = |i: usize| -> f64 {
        let s = arc.get(i).copied().unwrap_or(0.0);
        // The first points at least a window away; partition_point keeps long chains cheap.
        let before = arc.partition_point(|&a| a <= s - window).saturating_sub(1);
        let after = arc.partition_point(|&a| a < s + window).min(chain.len().saturating_sub(1));
        turn_between(before, i, after)
    };
    let turns: Vec<f64> = (0..chain.len()).map(turn).collect();
    let mut pieces = Vec::new();
    let mut start = 0;
    let mut i = 1;
    while i + 1 < chain.len() {
        if turns.get(i).copied().unwrap_or(0.0) <= CORNER_DEG {
            i += 1;
            continue;
        }
        // In the run about a corner the piece ends at every sharp point, two for a thin rim; in a rounded corner there is
        // none, and it ends in the middle.
        let reach = arc.get(i).copied().unwrap_or(0.0) + 2.0 * window;
        let run: Vec<usize> = (i..chain.len() - 1)
            .take_while(|&j| turns.get(j).is_some_and(|&t| t > CORNER_DEG) && arc.get(j).is_some_and(|&a| a <= reach))
            .collect();
        let last = run.last().copied().unwrap_or(i);
        let mut corners: Vec<usize> =
            run.iter().copied().filter(|&j| turn_between(j - 1, j, j + 1) > CORNER_DEG).collect();
        if corners.is_empty() {
            let value = |j: &usize| turns.get(*j).copied().unwrap_or(0.0);
            corners.extend(run.into_iter().max_by(|a, b| value(a).total_cmp(&value(b))));
        }
        for corner in corners {
            pieces.push(chain.get(start..=corner).unwrap_or_default().to_vec());
            start = corner;
        }
        i = last + 1;
    }
    pieces.push(chain.get(start..).unwrap_or_default().to_vec());
    pieces
}

/// A piece from axis to axis, cut at its widest place.
fn split_if_closed(piece: Vec<[f64; 2]>) -> Vec<Vec<[f64; 2]>> {
    let Some(widest) = (0..piece.len()).max_by(|&i, &j| {
        let radius = |k: usize| piece.get(k).map_or(0.0, |p| p[0]);
        radius(i).total_cmp(&radius(j))
    }) else {
        return Vec::new();
    };
    let radius = piece.get(widest).map_or(0.0, |p| p[0]);
    let on_axis = |p: Option<&[f64; 2]>| p.is_some_and(|p| p[0] < 0.1 * radius);
    if on_axis(piece.first()) && on_axis(piece.last()) {
        let (lower, upper) = (piece.get(..=widest), piece.get(widest..));
        return vec![lower.unwrap_or_default().to_vec(), upper.unwrap_or_default().to_vec()];
    }
    vec![piece]
}

/// A long piece on fewer points.
fn reduced(piece: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    if piece.len() <= MAX_CORNERS {
        return piece;
    }
    let last = piece.len() - 1;
    (0..MAX_CORNERS).filter_map(|i| piece.get(i * last / (MAX_CORNERS - 1)).copied()).collect()
}

/// Distance, arc length and signed offset (positive to the outside of a piece that climbs) of the nearest place. The
/// arc length runs on past both ends.
fn nearest(piece: &[[f64; 2]], p: [f64; 2]) -> Option<(f64, f64, f64)> {
    let last = piece.len().checked_sub(2)?;
    // Squares until the segment is known: this runs for every vertex and segment.
    let (mut least, mut found) = (f64::INFINITY, 0);
    for (i, (a, b)) in piece.iter().zip(piece.iter().skip(1)).enumerate() {
        let (d, r) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
        let w = ((r[0] * d[0] + r[1] * d[1]) / (d[0] * d[0] + d[1] * d[1])).clamp(0.0, 1.0);
        let away = [r[0] - w * d[0], r[1] - w * d[1]];
        let square = away[0] * away[0] + away[1] * away[1];
        if square < least {
            (least, found) = (square, i);
        }
    }
    let (a, b) = (piece.get(found)?, piece.get(found + 1)?);
    let length = distance(*a, *b);
    let (d, r) = ([(b[0] - a[0]) / length, (b[1] - a[1]) / length], [p[0] - a[0], p[1] - a[1]]);
    let low = if found == 0 { f64::NEG_INFINITY } else { 0.0 };
    let high = if found == last { f64::INFINITY } else { length };
    let start = polygon_length(piece.get(..=found)?);
    let along = (r[0] * d[0] + r[1] * d[1]).clamp(low, high);
    let away = least.sqrt();
    Some((away, start + along, away.copysign(r[0] * d[1] - r[1] * d[0])))
}

/// Mean offset of one piece's points from another, positive to its outside.
fn mean_offset(piece: &[[f64; 2]], other: &[[f64; 2]]) -> f64 {
    let step = other.len().div_ceil(32).max(1);
    let offsets: Vec<f64> = other.iter().step_by(step).filter_map(|&p| nearest(piece, p)).map(|n| n.2).collect();
    offsets.iter().sum::<f64>() / offsets.len().max(1) as f64
}
