//! Conjugate gradients with sums that do not depend on threads.

use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;

use super::ConductionError;

/// Entries that are summed one after the other; their sums are added in order.
const CHUNK: usize = 4096;

/// Where work stops when asked to, and tells how far it is.
#[derive(Clone, Copy)]
pub struct Watch<'a> {
    /// Told the share of the work that is done, 0 to 1; `false` cancels.
    pub progress: &'a (dyn Fn(f64) -> bool + Sync),
    /// Part of the whole that this piece of work is: from, to.
    pub span: [f64; 2],
}

impl Watch<'_> {
    /// Never cancels and shows nothing.
    #[must_use]
    pub fn silent() -> Watch<'static> {
        Watch { progress: &|_| true, span: [0.0, 1.0] }
    }

    /// A part of this piece of work.
    #[must_use]
    pub fn part(&self, from: f64, to: f64) -> Self {
        let [start, end] = self.span;
        let at = |share: f64| start + share * (end - start);
        Self { progress: self.progress, span: [at(from), at(to)] }
    }

    /// Whether to go on, asked without progress.
    #[must_use]
    pub fn goes_on(&self) -> bool {
        (self.progress)(self.span[0])
    }

    /// Reports a share of this piece of work.
    ///
    /// # Errors
    /// [`ConductionError::Cancelled`].
    pub fn at(&self, share: f64) -> Result<(), ConductionError> {
        let [start, end] = self.span;
        let share = if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.0 };
        if (self.progress)(start + share * (end - start)) { Ok(()) } else { Err(ConductionError::Cancelled) }
    }
}

/// A watch's progress that stays at no once it said so: work that was left out on the way is never taken for done.
pub(super) fn latched<'a>(watch: Watch<'a>, stopped: &'a AtomicBool) -> impl Fn(f64) -> bool + Sync + 'a {
    move |share| {
        let goes_on = !stopped.load(Ordering::Relaxed) && (watch.progress)(share);
        if !goes_on {
            stopped.store(true, Ordering::Relaxed);
        }
        goes_on
    }
}

impl std::fmt::Debug for Watch<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Watch").field("span", &self.span).finish_non_exhaustive()
    }
}

/// `sum a_i b_i`, always added in the same order.
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let part = |(a, b): (&[f64], &[f64])| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    if a.len() < 8 * CHUNK {
        a.chunks(CHUNK).zip(b.chunks(CHUNK)).map(part).sum()
    } else {
        let parts: Vec<f64> = a.par_chunks(CHUNK).zip(b.par_chunks(CHUNK)).map(part).collect();
        parts.iter().sum()
    }
}

/// `y = a x + b y`.
pub(super) fn combine(a: f64, x: &[f64], b: f64, y: &mut [f64]) {
    super::operator::for_rows(y, CHUNK, |n, row| {
        for (y, x) in row.iter_mut().zip(&x[n * CHUNK..]) {
            *y = a * x + b * *y;
        }
    });
}

/// A symmetric, positive semi-definite system and its preconditioner.
pub(super) trait System {
    /// `out = A u`; may stop early where `go_on` says no.
    fn apply(&mut self, u: &[f64], out: &mut [f64], go_on: &(dyn Fn() -> bool + Sync));
    /// `out = M^-1 r`; may stop early where `go_on` says no.
    fn precondition(&mut self, r: &[f64], out: &mut [f64], go_on: &(dyn Fn() -> bool + Sync));
}

/// When to stop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tolerance {
    /// Residual in the preconditioner's norm relative to that of the load.
    pub relative: f64,
    /// Most iterations.
    pub iterations: usize,
}

/// How a solve ended.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Iterations {
    /// Iterations spent.
    pub count: usize,
    /// Residual relative to the load.
    pub residual: f64,
}

/// Solves `A u = b` from the `u` given. `scale` is the norm that the residual is measured against, squared; that of `b` where
/// it is `None`. Returns whether the tolerance was reached.
///
/// # Errors
/// [`ConductionError::Cancelled`].
pub(super) fn solve(
    system: &mut dyn System,
    b: &[f64],
    u: &mut [f64],
    tolerance: Tolerance,
    scale: Option<f64>,
    watch: Watch<'_>,
) -> Result<(Iterations, bool), ConductionError> {
    let n = b.len();
    let go_on = || watch.goes_on();
    let (mut r, mut z) = (b.to_vec(), vec![0.0; n]);
    let mut product = vec![0.0; n];
    let from_zero = u.iter().all(|v| *v == 0.0);
    if from_zero || scale.is_none() {
        system.precondition(b, &mut z, &go_on);
    }
    let scale = scale.unwrap_or_else(|| dot(b, &z));
    if !from_zero {
        system.apply(u, &mut product, &go_on);
        combine(-1.0, &product, 1.0, &mut r);
        system.precondition(&r, &mut z, &go_on);
    }
    watch.at(0.0)?;
    let mut energy = dot(&r, &z);
    let target = tolerance.relative * tolerance.relative * scale;
    let mut direction = z.clone();
    let mut done = Iterations { count: 0, residual: relative(energy, scale) };
    while energy > target && done.count < tolerance.iterations {
        system.apply(&direction, &mut product, &go_on);
        if !go_on() {
            return Err(ConductionError::Cancelled);
        }
        let curvature = dot(&direction, &product);
        if curvature <= 0.0 || !curvature.is_finite() {
            break;
        }
        let step = energy / curvature;
        combine(step, &direction, 1.0, u);
        combine(-step, &product, 1.0, &mut r);
        if !go_on() {
            return Err(ConductionError::Cancelled);
        }
        system.precondition(&r, &mut z, &go_on);
        let next = dot(&r, &z);
        combine(1.0, &z, next / energy, &mut direction);
        energy = next;
        done = Iterations { count: done.count + 1, residual: relative(energy, scale) };
        let share = done.residual.max(f64::MIN_POSITIVE).ln() / tolerance.relative.ln();
        watch.at(share)?;
    }
    Ok((done, energy <= target))
}

fn relative(energy: f64, scale: f64) -> f64 {
    if scale > 0.0 { (energy.max(0.0) / scale).sqrt() } else { 0.0 }
}
