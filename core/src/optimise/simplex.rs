//! A search of its own around a place, by the simplex of Nelder and Mead ([`argmin`]).

use std::cell::RefCell;
use std::collections::HashMap;

use argmin::core::{CostFunction, Executor};
use argmin::solver::neldermead::NelderMead;

use super::record::{Evaluation, Goal, Record, Stage, key};
use super::space::Space;
use crate::error::Error;

/// Steps of the simplex for every design that may be computed: most steps that meet known designs cost nothing.
const STEPS: u64 = 4;
/// Cost of being beyond the ends of a variable, by the whole of it.
const OUTSIDE: f64 = 10.0;

/// A search that is to be done.
#[derive(Debug, Clone)]
pub struct Job {
    /// Where it starts.
    pub start: Vec<f64>,
    /// Variables that it moves; none to compute the start alone.
    pub free: Vec<usize>,
    /// Size of the first simplex, share of a variable's range.
    pub edge: f64,
    /// Designs that it may compute.
    pub quota: u64,
    /// What it is for.
    pub stage: Stage,
}

/// Computes the design of a place.
pub type Compute<'a> = &'a (dyn Fn(&[f64], Stage) -> Result<Evaluation, Error> + Sync);

/// Searches; returns what it computed, in order.
///
/// # Errors
/// What `compute` returns.
pub fn search(
    job: &Job,
    space: &Space,
    goal: &Goal,
    record: &Record,
    compute: Compute<'_>,
) -> Result<Vec<Evaluation>, Error> {
    let scale = |k: usize| space.variables()[k].count().map_or(1.0, |count| (count - 1).max(1) as f64);
    let state = RefCell::new(State::default());
    let problem = Problem { job, space, goal, record, compute, scale: &scale, state: &state };
    let origin: Vec<f64> = job.free.iter().map(|k| job.start[*k] / scale(*k)).collect();
    let mut corners = vec![origin.clone()];
    for (j, k) in job.free.iter().enumerate() {
        let mut corner = origin.clone();
        // Less than a step is no other design.
        let edge = job.edge.max(space.variables()[*k].count().map_or(0.0, |_| 1.0 / scale(*k)));
        corner[j] += if corner[j] + edge <= 1.0 { edge } else { -edge };
        corners.push(corner);
    }
    state.borrow_mut().opening = corners.len() as u64;
    if job.free.is_empty() {
        let _ = problem.cost(&origin);
    } else {
        // An error is how the search ends when its quota is used up; one of a design's own is kept in the state.
        let _ = Executor::new(problem, NelderMead::new(corners))
            .configure(|s| s.max_iters(STEPS * job.quota))
            .timer(false)
            .run();
    }
    let state = state.into_inner();
    state.failure.map_or(Ok(state.computed), Err)
}

#[derive(Default)]
struct State {
    computed: Vec<Evaluation>,
    costs: HashMap<String, f64>,
    failure: Option<Error>,
    asked: u64,
    opening: u64,
}

struct Problem<'a> {
    job: &'a Job,
    space: &'a Space,
    goal: &'a Goal,
    record: &'a Record,
    compute: Compute<'a>,
    scale: &'a dyn Fn(usize) -> f64,
    state: &'a RefCell<State>,
}

impl CostFunction for Problem<'_> {
    type Param = Vec<f64>;
    type Output = f64;

    fn cost(&self, shares: &Self::Param) -> Result<f64, argmin::core::Error> {
        let mut place = self.job.start.clone();
        for (k, share) in self.job.free.iter().zip(shares) {
            place[*k] = share * (self.scale)(*k);
        }
        let place = self.space.snap(&place);
        let outside: f64 = shares.iter().map(|s| (s - s.clamp(0.0, 1.0)).abs()).sum();
        let key = key(&self.space.values(&place));
        let mut state = self.state.borrow_mut();
        state.asked += 1;
        let known = self.record.get(&key).map(|e| self.goal.cost(&e.outcome));
        if let Some(cost) = known.or_else(|| state.costs.get(&key).copied()) {
            return Ok(cost + OUTSIDE * outside);
        }
        if state.computed.len() as u64 >= self.job.quota || state.failure.is_some() {
            // The first simplex may not fail: its corners are then merely bad.
            let opening = state.asked <= state.opening;
            return if opening { Ok(f64::MAX) } else { Err(argmin::core::Error::msg("the quota is used up")) };
        }
        match (self.compute)(&place, self.job.stage) {
            Ok(evaluation) => {
                let cost = self.goal.cost(&evaluation.outcome);
                state.costs.insert(key, cost);
                state.computed.push(evaluation);
                Ok(cost + OUTSIDE * outside)
            }
            Err(error) => {
                state.failure = Some(error);
                Ok(f64::MAX)
            }
        }
    }
}
