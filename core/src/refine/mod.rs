//! Correcting the modulus until the strip of voxels takes the target's shape.
//!
//! A mixture of voxels does not bend with the stiffness that its mean modulus gives it: random mixtures are softer, at high
//! contrast the difference varies along the strip, and wide strips bend as plates. The finite elements know what the strip
//! does; the elastica knows, in milliseconds, how a change of stiffness along the strip changes its shape. From the misfit
//! `r` of a solution's mid-line and the elastica's sensitivity `J = d(mid-line)/d(ln B)` the change of the stiffness is
//!
//! ```text
//! min over d of |r + J d|^2 + (a s)^2 |d|^2          s: largest singular value of J, a = 0.05
//! ```
//!
//! The voxels' modulus is multiplied by `exp(d)`, the voxels are filled again in the same order, and the strip is solved
//! again. (Mending a fine model by the inverse of a coarse one is known as space mapping.) Unlike the quotient of moment and
//! curvature, the sensitivity is defined at inflections, where both vanish, and it knows that what is changed at one place
//! moves the line of thrust everywhere. Voxels are whole, so steps of several lengths are weighed by what the elastica,
//! corrected by what the solved strips taught, says of the voxels they lead to (`proposal.rs`); the most promising is solved,
//! of small strips several. The best strip solved is kept.

mod mapping;
mod proposal;

use proposal::Best;

use crate::design::{Design, Limits};
use crate::error::Error;
use crate::input::DesignInput;
use crate::input::model::RefineInput;
use crate::progress::Share;
use crate::results::verification::Model;
use crate::results::{EmbeddedOptions, EmbeddedVerification, verify_embedded};

/// Factors of a correction, evenly spaced.
const FACTORS: usize = 101;
/// Share by which a step must bring the strip closer to count.
const WORTHWHILE: f64 = 0.95;
/// Steps in a row that may fail to come closer.
const PATIENCE: usize = 3;
/// Voxels up to which a step solves several promising strips, and how many of every kind of correction: whole voxels answer erratically, small strips are
/// solved in a fraction of a second.
const SMALL: usize = 5_000;
const TRIALS: usize = 2;

/// A refined design.
#[derive(Debug)]
pub struct Refinement {
    /// The best design; its input holds the correction.
    pub design: Design,
    /// The solution of the best design.
    pub verification: EmbeddedVerification,
    /// Largest distance from the target, percent of the length: before, and after every step.
    pub errors_percent: Vec<f64>,
}

/// Refines a design with at most `iterations` corrections, starting from the one its input has. Every voxel is resolved.
///
/// # Errors
/// Those of [`Design::compute`] and of [`verify_embedded`] for the design as it is. A correction that cannot be solved ends
/// the refinement and is not kept.
pub fn refine(
    input: &DesignInput,
    limits: Limits,
    iterations: usize,
    options: &EmbeddedOptions,
    progress: Share<'_>,
) -> Result<Refinement, Error> {
    let options = EmbeddedOptions { model: Model::Voxel, ..*options };
    let part = 1.0 / (iterations + 1) as f64;
    let design = Design::compute(input, limits)?;
    let verification = verify_embedded(&design, &options, &|share| progress(part * share))?;
    let mut errors = vec![rounded_error(&verification)];
    let mut factors: Vec<f64> = (0..FACTORS).map(|i| factor(input, i)).collect();
    let mut lines: Vec<_> = proposal::lines(&design, &verification.verification.midline_mm).into_iter().collect();
    let mut solved = vec![design.grid().clone()];
    let mut best = (design, verification);
    let (mut index, mut failures) = (0, 0);
    for step in 0..iterations {
        let (design, midline) = (&best.0, best.1.verification.midline_mm.as_slice());
        let small = design.grid().phases().len() <= SMALL;
        let known =
            Best { design, factors: &factors, midline, lines: &lines, index, solved: &solved, limits, iterations };
        let mut proposals = known.next(if small { TRIALS } else { 1 });
        if !small {
            proposals.truncate(1);
        }
        let (mut helped, share_of_each) = (false, part / proposals.len().max(1) as f64);
        for (trial, next) in proposals.into_iter().enumerate() {
            let started = part * (step + 1) as f64 + share_of_each * trial as f64;
            let told = |share: f64| progress(started + share_of_each * share);
            let verification = match verify_embedded(&next.design, &options, &told) {
                Ok(verification) => verification,
                Err(Error::Solver(_)) => continue,
                Err(error) => return Err(error),
            };
            let error = rounded_error(&verification);
            let so_far = errors.iter().copied().fold(f64::INFINITY, f64::min);
            errors.push(error);
            let Some(both) = proposal::lines(&next.design, &verification.verification.midline_mm) else { continue };
            lines.push(both);
            solved.push(next.design.grid().clone());
            helped |= error < WORTHWHILE * so_far;
            if error < so_far {
                (factors, best, index) = (next.factors, (next.design, verification), lines.len() - 1);
            }
        }
        failures = if helped { 0 } else { failures + 1 };
        if failures == PATIENCE {
            break;
        }
    }
    recorded(best, limits, iterations, errors)
}

/// The factors after a change of their logarithm.
fn corrected(design: &Design, factors: &[f64], change: impl Fn(f64) -> f64) -> Vec<f64> {
    let [least, most] = RefineInput::FACTORS;
    let value = |(i, factor): (usize, &f64)| {
        let share = i as f64 / (FACTORS - 1) as f64;
        let (low, high) = reach(design, share);
        // Rounded, so that the design and its hash do not hang on the last digits of a sum.
        round(factor.clamp(low, high) * change(share).exp(), 1e-6).clamp(least, most)
    };
    factors.iter().enumerate().map(value).collect()
}

/// The best design with the history in its input, so that it can be computed again.
fn recorded(
    (design, mut verification): (Design, EmbeddedVerification),
    limits: Limits,
    iterations: usize,
    errors_percent: Vec<f64>,
) -> Result<Refinement, Error> {
    let mut input = design.input().clone();
    let correction = input.refine.take().map(|r| r.correction).unwrap_or_default();
    input.refine = Some(RefineInput { iterations, correction, errors_percent: errors_percent.clone() });
    let design = Design::compute(&input, limits)?;
    verification.verification.provenance = crate::output::Provenance::of(design.input());
    Ok(Refinement { design, verification, errors_percent })
}

/// Smallest and largest factor that the phases can follow at a share of the length: beyond it a correction would grow
/// without any effect.
fn reach(design: &Design, share: f64) -> (f64, f64) {
    let (_, modulus) = design.width_and_modulus(share * design.input().strips.length_mm);
    (design.phases().softest() / modulus, design.phases().stiffest() / modulus)
}

fn factor(input: &DesignInput, i: usize) -> f64 {
    input.refine.as_ref().map_or(1.0, |refine| refine.factor(i as f64 / (FACTORS - 1) as f64))
}

fn rounded_error(verification: &EmbeddedVerification) -> f64 {
    round(verification.verification.max_error_percent, 1e-4)
}

fn round(value: f64, unit: f64) -> f64 {
    // Dividing by the whole inverse gives the decimal that is nearest.
    let inverse = (1.0 / unit).round();
    (value * inverse).round() / inverse
}
