//! Where the search for a placement starts: which way a scanned dome's axis points.
//!
//! Directions all over the sphere are tried on a few hundred points; the best are improved on more of them.

use std::f64::consts::{PI, TAU};

use nalgebra::{Matrix3, Rotation3, Vector3};

use super::dome::Dome;
use super::placement::{FACETED, Freedom, Limits, Placement, ROUND, clipped_cost, refine};
use crate::progress::Cancelled;

/// Directions all over the sphere.
const DIRECTIONS: usize = 60;
const COARSE_POINTS: usize = 250;
const COARSE_ITERATIONS: usize = 12;
const MIDDLE_POINTS: usize = 2000;
/// Starts that are improved.
const BEST: usize = 5;
/// Turns about the axis of a scan that lies beside it.
const SPINS: usize = 6;
/// Distance, as a share of the length, above which a fit is poor.
const POOR: f64 = 0.003;
/// Turns of a faceted dome about its axis that are tried within one facet.
const PHASES: usize = 8;
/// Scale of the biweight while the placement is only guessed, and largest distance that tells placements apart, as
/// shares of the length.
const COARSE: f64 = 0.2;
const CLIP: f64 = 0.03;

/// A placement with its mean squared distance, mm^2.
pub(super) type Found = (f64, Placement);

/// The best placement of a scan that goes round the axis on a surface of revolution.
pub(super) fn round(dome: &Dome, points: &[Vector3<f64>], length: f64, cancelled: Cancelled<'_>) -> Option<Found> {
    let search = Search::new(dome, points, ROUND, length, cancelled);
    let starts = directions(&search.some).iter().map(|d| along(dome, &search.some, d)).collect();
    search.best(search.coarsely(starts)?)
}

/// The best placement of a scan on a dome of spokes, from the best one on its surface of revolution.
pub(super) fn faceted(
    dome: &Dome,
    points: &[Vector3<f64>],
    round: &Placement,
    length: f64,
    cancelled: Cancelled<'_>,
) -> Option<Found> {
    let count = dome.spokes.unwrap_or(1).max(1);
    let search = Search::new(dome, points, FACETED, length, cancelled);
    let starts = (0..PHASES).map(|phase| spun(round, TAU * phase as f64 / (PHASES * count) as f64)).collect();
    search.best(starts)
}

/// The best placement of a part of a dome, all of it on one side of the axis: six times the work.
pub(super) fn beside(dome: &Dome, points: &[Vector3<f64>], length: f64, cancelled: Cancelled<'_>) -> Option<Found> {
    let freedom = if dome.spokes.is_some() { FACETED } else { ROUND };
    let search = Search::new(dome, points, freedom, length, cancelled);
    let rho = dome.curve.points().iter().map(|p| p[0]);
    let aside = Vector3::new(rho.sum::<f64>() / dome.curve.points().len() as f64, 0.0, 0.0);
    let mut starts = Vec::new();
    for direction in directions(&search.some) {
        let upright = along(dome, &search.some, &direction);
        for spin in 0..SPINS {
            let turned = spun(&upright, TAU * spin as f64 / SPINS as f64);
            starts.push(Placement { shift: turned.shift + aside, ..turned });
        }
    }
    search.best(search.coarsely(starts)?)
}

/// Whether a placement fits so poorly that another is worth looking for.
pub(super) fn is_poor(found: &Found, length: f64) -> bool {
    found.0 > (POOR * length).powi(2)
}

/// Turned about the dome's axis.
fn spun(placement: &Placement, angle: f64) -> Placement {
    let turn = Rotation3::from_axis_angle(&Vector3::z_axis(), angle);
    Placement { rotation: turn * placement.rotation, shift: turn * placement.shift }
}

/// A search from many starts.
struct Search<'a> {
    dome: &'a Dome,
    few: Vec<Vector3<f64>>,
    some: Vec<Vector3<f64>>,
    freedom: Freedom,
    length: f64,
    cancelled: Cancelled<'a>,
}

impl<'a> Search<'a> {
    fn new(dome: &'a Dome, points: &[Vector3<f64>], freedom: Freedom, length: f64, cancelled: Cancelled<'a>) -> Self {
        let (few, some) = (spread_out(points, COARSE_POINTS), spread_out(points, MIDDLE_POINTS));
        Self { dome, few, some, freedom, length, cancelled }
    }

    /// The starts that a few points fit best after some steps.
    fn coarsely(&self, starts: Vec<Placement>) -> Option<Vec<Placement>> {
        let limits = Limits { iterations: COARSE_ITERATIONS, scale: Some(COARSE * self.length) };
        let mut tried = Vec::with_capacity(starts.len());
        for start in starts {
            let fit = refine(self.dome, &self.few, start, self.freedom, limits, self.cancelled)?;
            tried.push((clipped_cost(self.dome, &self.few, &fit.placement, COARSE * self.length), fit.placement));
        }
        tried.sort_by(|a, b| a.0.total_cmp(&b.0));
        Some(tried.into_iter().take(BEST).map(|t| t.1).collect())
    }

    /// The best placement from these starts, with its mean squared distance.
    fn best(&self, starts: Vec<Placement>) -> Option<Found> {
        let mut best: Option<Found> = None;
        for start in starts {
            let fit = refine(self.dome, &self.some, start, self.freedom, Limits::NEAR, self.cancelled)?;
            let cost = clipped_cost(self.dome, &self.some, &fit.placement, CLIP * self.length);
            if best.as_ref().is_none_or(|b| cost < b.0) {
                best = Some((cost, fit.placement));
            }
        }
        best
    }
}

/// At most `most` of the points, from all over the list whatever its order.
pub(super) fn spread_out(points: &[Vector3<f64>], most: usize) -> Vec<Vector3<f64>> {
    if points.len() <= most {
        return points.to_vec();
    }
    // Multiples of the golden section fall evenly between 0 and 1 and into step with no raster.
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    (1..=most).map(|i| points[((i as f64 * golden).fract() * points.len() as f64) as usize % points.len()]).collect()
}

/// Principal axes of the points, both ways, and directions all over the sphere.
fn directions(points: &[Vector3<f64>]) -> Vec<Vector3<f64>> {
    let centre = points.iter().sum::<Vector3<f64>>() / points.len().max(1) as f64;
    let moments: Matrix3<f64> = points.iter().map(|p| (p - centre) * (p - centre).transpose()).sum();
    let axes = moments.symmetric_eigen().eigenvectors;
    let mut directions: Vec<Vector3<f64>> =
        (0..3).flat_map(|k| [1.0, -1.0].map(|sign| sign * axes.column(k))).collect();
    let golden = PI * (3.0 - 5.0_f64.sqrt());
    directions.extend((0..DIRECTIONS).map(|i| {
        let z = 1.0 - (2 * i + 1) as f64 / DIRECTIONS as f64;
        let (sin, cos) = (golden * i as f64).sin_cos();
        let r = (1.0 - z * z).sqrt();
        Vector3::new(r * cos, r * sin, z)
    }));
    directions
}

/// The placement that takes a direction for the axis and the middle of the points for that of the dome.
fn along(dome: &Dome, points: &[Vector3<f64>], direction: &Vector3<f64>) -> Placement {
    let upside_down = || Rotation3::from_axis_angle(&Vector3::x_axis(), PI);
    let rotation = Rotation3::rotation_between(direction, &Vector3::z()).unwrap_or_else(upside_down);
    let turned: Vec<Vector3<f64>> = points.iter().map(|p| rotation * p).collect();
    let middle = |k: usize| {
        let mut values: Vec<f64> = turned.iter().map(|p| p[k]).collect();
        values.sort_by(f64::total_cmp);
        let cut = values.len() / 50;
        values.get(cut).zip(values.get(values.len() - 1 - cut)).map_or(0.0, |(a, b)| 0.5 * (a + b))
    };
    let [low, high] = dome.heights();
    Placement { rotation, shift: Vector3::new(-middle(0), -middle(1), 0.5 * (low + high) - middle(2)) }
}
