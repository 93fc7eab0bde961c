//! Newton's method for the equilibrium of a strip whose ends are where they should be.
//!
//! Each step solves `K du = -r` and is shortened where the residual's work on it, `du . r`, would turn round: for a stable
//! strip this is a line search for the least energy, and it holds for unstable branches as well.

use super::FemError;
use super::assembly::{Forces, State, forces, tangent};
use super::contact::Contact;
use super::error::go_on;
use super::factorisation::Factorisation;
use super::model::Model;
use super::pattern::Pattern;
use crate::progress::Cancelled;

/// Most iterations from one start.
pub const MAX_ITERATIONS: usize = 30;
/// Residual, relative to the elements' forces, at which an equilibrium counts as found.
pub const TOLERANCE: f64 = 1e-6;
/// Residual, relative to the elements' forces, below which the tangent is factored once more: those factors count the
/// negative eigenvalues at the equilibrium.
const CLOSE: f64 = 1e-3;
/// Residual to which a step is solved with older factors, and the steps that may take.
const NEARBY_TOLERANCE: f64 = 1e-2;
const NEARBY_STEPS: usize = 15;
/// Change, relative to the strip's length, that is below what rounding allows to improve.
const SMALLEST_STEP: f64 = 1e-12;
/// Work of the residual on a step that is accepted, relative to that at its beginning.
const ACCEPTED_WORK: f64 = 0.9;
/// Trials of a line search.
const TRIALS: usize = 6;

/// Matrices of a mesh, kept over all iterations.
#[derive(Debug)]
pub struct Solver<'a> {
    model: &'a Model,
    pattern: Pattern,
    factors: Factorisation,
    tangent: Vec<f64>,
    /// What nodes may touch.
    pub contact: Contact,
}

/// An equilibrium.
#[derive(Debug, Clone)]
pub struct Equilibrium {
    /// The forces that hold it.
    pub forces: Forces,
    /// Iterations spent.
    pub iterations: usize,
    /// Residual, relative to the elements' forces.
    pub residual: f64,
    /// Negative eigenvalues of the last tangent: zero for a stable equilibrium.
    pub negative: usize,
}

/// Why Newton's method stopped.
#[derive(Debug, Clone, PartialEq)]
pub enum Stop {
    /// No equilibrium from this start.
    Diverged {
        /// Iterations spent.
        iterations: usize,
        /// Last residual, relative to the elements' forces.
        residual: f64,
    },
    /// A reason not to try again.
    Final(FemError),
}

impl From<FemError> for Stop {
    fn from(error: FemError) -> Self {
        Self::Final(error)
    }
}

impl<'a> Solver<'a> {
    /// Sets up the matrices of a strip whose hub is free to rise where `lift` says so, unless they take more than `limit`
    /// bytes.
    ///
    /// # Errors
    /// [`FemError::Memory`], [`FemError::Sparse`], [`FemError::Cancelled`].
    pub fn new(model: &'a Model, lift: bool, limit: Option<u64>, cancelled: Cancelled<'_>) -> Result<Self, FemError> {
        let pattern = Pattern::new(&model.mesh, lift, cancelled)?;
        go_on(cancelled)?;
        let factors = Factorisation::new(&pattern, limit, cancelled)?;
        let tangent = vec![0.0; pattern.rows.len()];
        Ok(Self { model, pattern, factors, tangent, contact: Contact::default() })
    }

    /// Unknowns of the mesh.
    #[must_use]
    pub fn unknowns(&self) -> usize {
        self.pattern.unknowns()
    }

    /// Entries of the tangent's factors.
    #[must_use]
    pub fn factor_entries(&self) -> usize {
        self.factors.entries()
    }

    /// Finds the equilibrium near `state`, whose prescribed nodes stay where they are. `step` is told the iteration and the
    /// relative residual.
    ///
    /// # Errors
    /// [`Stop::Diverged`], [`Stop::Final`] where it was cancelled.
    pub fn solve(
        &mut self,
        state: &mut State,
        cancelled: Cancelled<'_>,
        step: &dyn Fn(usize, f64),
    ) -> Result<Equilibrium, Stop> {
        let length = self.model.mesh.nodes.last().map_or(1.0, |n| n[0].abs().max(1e-9));
        let mut iterations = 0;
        // Whether the factors are those of a tangent close to the equilibrium's.
        let mut close = false;
        let diverged = |iterations, residual| Stop::Diverged { iterations, residual };
        let Some(mut held) = self.forces(state, cancelled)? else { return Err(diverged(0, f64::INFINITY)) };
        let mut residual = self.pattern.gather(&held.of_nodes);
        loop {
            let relative = norm(&residual) / held.scale.max(f64::MIN_POSITIVE);
            step(iterations, relative);
            if iterations == MAX_ITERATIONS || !relative.is_finite() {
                return Err(diverged(iterations, relative));
            }
            if !tangent(self.model, &self.pattern, state, &mut self.tangent, cancelled)? {
                return Err(diverged(iterations, relative));
            }
            self.contact.add_tangent(&self.model.mesh, state, &self.pattern, &mut self.tangent);
            let near = relative <= CLOSE;
            let nearby = if near && !close {
                None
            } else {
                let (factors, tolerance) = (&mut self.factors, NEARBY_TOLERANCE);
                factors.solve_nearby(&self.pattern, &self.tangent, &residual, tolerance, NEARBY_STEPS, cancelled)?
            };
            let solved = match nearby {
                Some(change) => Some(change),
                None => {
                    close = near;
                    self.factors.solve(&self.pattern, &self.tangent, &residual, cancelled)?
                }
            };
            let Some(mut change) = solved else {
                return Err(diverged(iterations, relative));
            };
            iterations += 1;
            change.iter_mut().for_each(|c| *c = -*c);
            let searched = self.search(state, &change, &residual, cancelled)?;
            let Some((next, next_held)) = searched else { return Err(diverged(iterations, relative)) };
            (*state, held) = (next, next_held);
            residual = self.pattern.gather(&held.of_nodes);
            let relative = norm(&residual) / held.scale.max(f64::MIN_POSITIVE);
            let largest = change.iter().fold(0.0_f64, |m, c| m.max(c.abs()));
            if close && (relative <= TOLERANCE || largest <= SMALLEST_STEP * length) {
                step(iterations, relative);
                return Ok(Equilibrium {
                    forces: held,
                    iterations,
                    residual: relative,
                    negative: self.factors.negative(),
                });
            }
        }
    }

    /// Forces of the strip and of what it touches.
    fn forces(&self, state: &mut State, cancelled: Cancelled<'_>) -> Result<Option<Forces>, FemError> {
        let mut held = forces(self.model, state, cancelled)?;
        if let Some(held) = &mut held {
            self.contact.add_forces(&self.model.mesh, state, &mut held.of_nodes);
        }
        Ok(held)
    }

    /// The state after a step or the part of it that is accepted; `None` where even a small part turns elements inside out.
    fn search(
        &self,
        state: &State,
        change: &[f64],
        residual: &[f64],
        cancelled: Cancelled<'_>,
    ) -> Result<Option<(State, Forces)>, FemError> {
        let before = dot(change, residual);
        let mut share = 1.0;
        let mut best: Option<(f64, State, Forces)> = None;
        for _ in 0..TRIALS {
            let mut moved = state.clone();
            self.pattern.spread(change, share, &mut moved.displacements);
            let Some(held) = self.forces(&mut moved, cancelled)? else {
                share *= 0.4;
                continue;
            };
            let after = dot(change, &self.pattern.gather(&held.of_nodes));
            let ratio = (after / before).abs();
            if !ratio.is_finite() {
                share *= 0.4;
                continue;
            }
            if ratio <= ACCEPTED_WORK || before == 0.0 {
                return Ok(Some((moved, held)));
            }
            if best.as_ref().is_none_or(|b| ratio < b.0) {
                best = Some((ratio, moved, held));
            }
            // Where the work would vanish if it changed linearly.
            share *= (before / (before - after)).clamp(0.15, 0.6);
        }
        Ok(best.map(|(_, state, held)| (state, held)))
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}
