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
//! of small strips several. Where that brings nothing, small strips are solved with another modulus about one knot after the
//! other. The best strip solved is kept.

mod mapping;
mod proposal;

use proposal::{Best, Proposal};

use crate::design::{Design, Limits};
use crate::error::Error;
use crate::input::DesignInput;
use crate::input::model::RefineInput;
use crate::progress::{Cancelled, Share};
use crate::results::verification::Model;
use crate::results::{EmbeddedOptions, EmbeddedVerification, verify_embedded};
use crate::voxel::VoxelGrid;

/// Factors of a correction, evenly spaced.
const FACTORS: usize = 101;
/// Share by which a step must bring the strip closer to count.
const WORTHWHILE: f64 = 0.95;
/// Steps in a row that may fail to come closer.
const PATIENCE: usize = 3;
/// Voxels up to which a step solves several promising strips, and how many by every penalty: whole voxels answer erratically,
/// and small strips are solved in a fraction of a second. Where that fails, single knots are touched.
const SMALL: usize = 5_000;
const TRIALS: usize = 2;

/// A refined design.
#[derive(Debug)]
pub struct Refinement {
    /// The best design; its input holds the correction.
    pub design: Design,
    /// The solution of the best design.
    pub verification: EmbeddedVerification,
    /// Largest distance from the target, percent of the length: before, and of every strip solved after.
    pub errors_percent: Vec<f64>,
}

/// Refines a design with at most `iterations` corrections, starting from the one its input has. Every voxel is resolved.
///
/// # Errors
/// Those of [`Design::compute`] and of [`verify_embedded`] for the design as it is. A correction that cannot be solved is
/// not kept.
pub fn refine(
    input: &DesignInput,
    limits: Limits,
    iterations: usize,
    options: &EmbeddedOptions,
    progress: Share<'_>,
) -> Result<Refinement, Error> {
    let options = EmbeddedOptions { model: Model::Voxel, ..*options };
    let part = 1.0 / (iterations + 1) as f64;
    let design = Design::compute_unless(input, limits, &|| !progress(0.0))?;
    let verification = verify_embedded(&design, &options, &|share| progress(part * share))?;
    let mut search = Search {
        limits,
        iterations,
        options,
        progress,
        errors: vec![rounded_error(&verification)],
        factors: (0..FACTORS).map(|i| factor(input, i)).collect(),
        lines: proposal::lines(&design, &verification.verification.midline_mm).into_iter().collect(),
        solved: vec![design.grid().clone()],
        best: (design, verification),
        index: 0,
    };
    let mut failures = 0;
    for step in 0..iterations {
        let (before, span) = (search.lowest(), [part * (step + 1) as f64, part]);
        if search.is_small() && failures > 0 {
            search.touch(span)?;
        } else {
            search.advance(span)?;
        }
        failures = if search.lowest() < WORTHWHILE * before { 0 } else { failures + 1 };
        if failures == PATIENCE {
            break;
        }
    }
    recorded(search.best, limits, iterations, search.errors, progress)
}

/// The strips solved so far.
struct Search<'a> {
    limits: Limits,
    iterations: usize,
    options: EmbeddedOptions,
    progress: Share<'a>,
    /// Of all of them, percent of the length.
    errors: Vec<f64>,
    /// The best one's correction, itself, and its place in `lines`.
    factors: Vec<f64>,
    best: (Design, EmbeddedVerification),
    index: usize,
    /// Mid-lines by the finite elements and by the elastica.
    lines: Vec<[nalgebra::DVector<f64>; 2]>,
    solved: Vec<VoxelGrid>,
}

impl Search<'_> {
    fn is_small(&self) -> bool {
        self.best.0.grid().phases().len() <= SMALL
    }

    fn lowest(&self) -> f64 {
        self.errors.iter().copied().fold(f64::INFINITY, f64::min)
    }

    fn known<'b>(&'b self, cancelled: Cancelled<'b>) -> Best<'b> {
        Best {
            design: &self.best.0,
            factors: &self.factors,
            midline: &self.best.1.verification.midline_mm,
            lines: &self.lines,
            index: self.index,
            solved: &self.solved,
            limits: self.limits,
            iterations: self.iterations,
            cancelled,
        }
    }

    /// Solves the most promising corrections.
    fn advance(&mut self, [start, part]: [f64; 2]) -> Result<(), Error> {
        let progress = self.progress;
        let cancelled = || !progress(start);
        let mut proposals = self.known(&cancelled).next(if self.is_small() { TRIALS } else { 1 })?;
        if !self.is_small() {
            proposals.truncate(1);
        }
        let each = part / proposals.len().max(1) as f64;
        for (trial, next) in proposals.into_iter().enumerate() {
            self.solve(next, [start + each * trial as f64, each])?;
        }
        Ok(())
    }

    /// Solves changes at one knot after another.
    fn touch(&mut self, [start, part]: [f64; 2]) -> Result<(), Error> {
        let each = part / Best::TURNS as f64;
        for turn in 0..Best::TURNS {
            let at = start + each * turn as f64;
            let progress = self.progress;
            if let Some(next) = self.known(&|| !progress(at)).touched(turn)? {
                self.solve(next, [at, each])?;
            }
        }
        Ok(())
    }

    /// Solves a strip and keeps it if it is the best. One that is not solved counts as solved in vain.
    fn solve(&mut self, next: Proposal, [start, part]: [f64; 2]) -> Result<(), Error> {
        let told = |share: f64| (self.progress)(start + part * share);
        let verification = match verify_embedded(&next.design, &self.options, &told) {
            Ok(verification) => verification,
            Err(Error::Solver(_)) => return Ok(()),
            Err(error) => return Err(error),
        };
        let Some(both) = proposal::lines(&next.design, &verification.verification.midline_mm) else { return Ok(()) };
        let (error, lowest) = (rounded_error(&verification), self.lowest());
        self.errors.push(error);
        self.lines.push(both);
        self.solved.push(next.design.grid().clone());
        if error < lowest {
            (self.factors, self.best, self.index) = (next.factors, (next.design, verification), self.lines.len() - 1);
        }
        Ok(())
    }
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
    progress: Share<'_>,
) -> Result<Refinement, Error> {
    let mut input = design.input().clone();
    let correction = input.refine.take().map(|r| r.correction).unwrap_or_default();
    input.refine = Some(RefineInput { iterations, correction, errors_percent: errors_percent.clone() });
    let design = Design::compute_unless(&input, limits, &|| !progress(1.0))?;
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
