//! `E(X) = sum_k A_k exp(-((X - b_k) / c_k)^2)`: the paper's family.
//!
//! Amplitudes, centres and widths are found by Levenberg and Marquardt's method on relative residuals, from several
//! starting points. Least squares leaves a largest error above the typical one, so the fit is repeated with weights that
//! grow where the error is large (Lawson's iteration), which nearly equalises it. Negative amplitudes are allowed as long
//! as the sum is certainly positive all along the strip.

use serde::Serialize;

use super::exponential_polynomial::minimax;
use super::expression::{self, round_significant};
use super::least_squares::{Points, equalised, largest, screened, sum};
use super::samples::Samples;

/// From this many terms on, data is given up as noise or a corner where the error would have to more than halve with each
/// further term up to [`LAST_HALVING`] to reach the target.
const FIRST_HALVING: usize = 4;
const LAST_HALVING: usize = 7;
/// Largest slope of `exp(-t^2)`: `sqrt(2 / e)`.
const STEEPEST: f64 = 0.857_763_884_960_706_8;

/// One term `A exp(-((X - b) / c)^2)`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Gaussian {
    /// `A`, MPa; negative where the term takes away.
    pub amplitude_mpa: f64,
    /// `b`, mm from the rim; outside the strip for a term that is monotonic along it.
    pub centre_mm: f64,
    /// `c > 0`, mm.
    pub width_mm: f64,
}

impl Gaussian {
    fn evaluate(&self, x_mm: f64) -> f64 {
        let t = (x_mm - self.centre_mm) / self.width_mm;
        self.amplitude_mpa * (-(t * t)).exp()
    }
}

/// The modulus in MPa at `x_mm` from the rim.
pub(super) fn evaluate(terms: &[Gaussian], x_mm: f64) -> f64 {
    terms.iter().map(|g| g.evaluate(x_mm)).sum()
}

pub(super) fn expression(terms: &[Gaussian], variable: &str) -> String {
    expression::gaussian_sum(variable, terms.iter().map(|g| (g.amplitude_mpa, g.centre_mm, g.width_mm)))
}

/// The fewest Gaussians whose error, rounded coefficients included, is below `target`.
///
/// Where `max_terms` are too few, the most accurate sum that was found. Returns the largest relative error with it;
/// `None` if no sum is positive all along the strip.
pub(super) fn fit(samples: &Samples, target: f64, max_terms: usize) -> Option<(Vec<Gaussian>, f64)> {
    let mut closest: Option<(Vec<Gaussian>, f64)> = None;
    let mut fewer: Option<Vec<f64>> = None;
    for terms in 1..=max_terms {
        let mut best: Option<(Vec<f64>, f64)> = None;
        for (parameters, at_points) in sums(samples, fewer.as_deref(), terms, target) {
            if best.as_ref().is_some_and(|(_, e)| at_points >= *e) {
                continue;
            }
            let exact = in_millimetres(&parameters, samples);
            let error = largest_error(&exact, samples);
            if error <= target
                && let Some(found) = rounded(&exact, samples, error, target)
            {
                return Some(found);
            }
            if error.is_finite() && closest.as_ref().is_none_or(|(_, e)| error < *e) {
                closest = Some((exact, error));
            }
            best = Some((parameters, at_points));
        }
        let error = closest.as_ref().map_or(f64::INFINITY, |(_, error)| *error);
        let halvings = LAST_HALVING.saturating_sub(terms) as i32;
        if terms >= FIRST_HALVING && error > target * 2.0_f64.powi(halvings) {
            break;
        }
        fewer = best.map(|(parameters, _)| parameters);
    }
    closest.and_then(|(exact, error)| rounded(&exact, samples, error, target))
}

/// Sums of so many Gaussians, the promising starts first, each with its largest relative error at the points of its fit.
fn sums(
    samples: &Samples,
    fewer: Option<&[f64]>,
    terms: usize,
    target: f64,
) -> Box<dyn Iterator<Item = (Vec<f64>, f64)>> {
    let points = Points::new(samples, terms);
    if terms == 1 {
        let measured = single(samples).map(|parameters| {
            let error = largest(&points.errors(&parameters));
            (parameters, error)
        });
        return Box::new(measured.into_iter());
    }
    let mut candidates: Vec<(Vec<f64>, f64)> =
        starts(&points, fewer, terms).into_iter().filter_map(|start| screened(&points, start)).collect();
    candidates.sort_by(|(_, a), (_, b)| a.total_cmp(b));
    Box::new(candidates.into_iter().filter_map(move |(start, _)| equalised(&points, start, target)))
}

/// One Gaussian is a parabola of `ln E` that opens downwards, and the best parabola needs no iteration from a start.
fn single(samples: &Samples) -> Option<Vec<f64>> {
    let (parabola, deviation) = minimax(&samples.u, &samples.log_modulus, 2, f64::INFINITY)?;
    let &[constant, slope, bend] = parabola.as_slice() else { return None };
    if bend >= 0.0 {
        return None;
    }
    let centre = -0.5 * slope / bend;
    let peak = constant + 0.5 * slope * centre - deviation.cosh().ln() - largest(&samples.modulus).ln();
    let parameters = vec![peak.exp(), centre, -0.5 * (-bend).ln()];
    parameters.iter().all(|p| p.is_finite()).then_some(parameters)
}

/// Starting parameters, three a term: relative amplitude, centre in `u`, logarithm of the width in `u`.
fn starts(points: &Points, fewer: Option<&[f64]>, terms: usize) -> Vec<Vec<f64>> {
    let mut starts = Vec::new();
    // One more Gaussian where the best sum with one fewer misses most.
    if let Some(fewer) = fewer {
        let miss = |i: usize| points.modulus[i] - sum(fewer, points.u[i]);
        let share = |i: usize| (miss(i) / points.modulus[i]).abs();
        if let Some(i) = (0..points.u.len()).max_by(|&a, &b| share(a).total_cmp(&share(b))) {
            let mut start = fewer.to_vec();
            start.extend([miss(i), points.u[i], (0.7 / terms as f64).ln()]);
            starts.push(start);
        }
    }
    // Evenly spread: over the strip with little and with much overlap, and reaching beyond both ends.
    let count = terms as f64;
    for (first, spacing, width) in [
        (1.0 / count - 1.0, 2.0 / count, 1.2 / count),
        (1.0 / count - 1.0, 2.0 / count, 2.0 / count),
        (-1.3, 2.6 / (count - 1.0), 2.1 / (count - 1.0)),
    ] {
        let term = |k: usize| {
            let centre = first + spacing * k as f64;
            [0.6 * points.at(centre), centre, width.ln()]
        };
        starts.push((0..terms).flat_map(term).collect());
    }
    starts
}

/// The terms in mm and MPa, from rim to hub, what is taken away last: the text then never begins with a sign.
fn in_millimetres(parameters: &[f64], samples: &Samples) -> Vec<Gaussian> {
    let scale = largest(&samples.modulus);
    let half = 0.5 * samples.length;
    let mut terms: Vec<Gaussian> = parameters
        .chunks_exact(3)
        .map(|p| Gaussian { amplitude_mpa: scale * p[0], centre_mm: half * (1.0 + p[1]), width_mm: half * p[2].exp() })
        .collect();
    terms.sort_by(|a, b| {
        (a.amplitude_mpa < 0.0).cmp(&(b.amplitude_mpa < 0.0)).then(a.centre_mm.total_cmp(&b.centre_mm))
    });
    terms
}

/// Largest relative error along the strip; infinite where the sum is not certainly positive.
fn largest_error(terms: &[Gaussian], samples: &Samples) -> f64 {
    let error = samples.largest_error(|x| evaluate(terms, x));
    if error.is_finite() && certainly_positive(terms, samples) { error } else { f64::INFINITY }
}

/// The terms with as few digits as keep the largest error near `exact_error`; `None` if none do.
fn rounded(exact: &[Gaussian], samples: &Samples, exact_error: f64, target: f64) -> Option<(Vec<Gaussian>, f64)> {
    let allowed = super::error_allowed_after_rounding(exact_error, target);
    (3..=15).find_map(|digits| {
        let terms: Vec<Gaussian> = exact
            .iter()
            .map(|g| Gaussian {
                amplitude_mpa: round_significant(g.amplitude_mpa, digits),
                centre_mm: round_significant(g.centre_mm, digits),
                width_mm: round_significant(g.width_mm, digits),
            })
            .filter(|g| g.amplitude_mpa != 0.0)
            .collect();
        let error = largest_error(&terms, samples);
        (error <= allowed).then_some((terms, error))
    })
}

/// Whether the sum is positive between the points of the grid too: its slope nowhere exceeds
/// `sum |A_k| / c_k sqrt(2 / e)`, so half an interval cannot take it from its least value on the grid to zero.
fn certainly_positive(terms: &[Gaussian], samples: &Samples) -> bool {
    if terms.iter().all(|g| g.amplitude_mpa > 0.0) {
        return !terms.is_empty();
    }
    let slope: f64 = terms.iter().map(|g| g.amplitude_mpa.abs() / g.width_mm * STEEPEST).sum();
    let half_interval = 0.5 * samples.length / (samples.u.len() - 1) as f64;
    (0..samples.u.len()).all(|i| evaluate(terms, samples.position(i)) > slope * half_interval)
}
