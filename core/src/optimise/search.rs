//! The search: spread, choose branches, refine, confirm.
//!
//! 1. A Latin hypercube over all variables, a third of the designs.
//! 2. Successive halving: every branch (combination of choices) is searched by a simplex from its best design; the better half
//!    goes on, with twice as many designs each and a smaller simplex.
//! 3. Around the best design: other choices and single steps, each with a short search of the ranges, and simplices of falling
//!    size. Where that ends, another hypercube.
//! 4. With limits: whether the limits that the best design nearly reaches cost anything ([`super::binding`]).
//!
//! The searches of a round run at once, each with its own quota, and are recorded in their order: what is found does not depend
//! on the number of cores.

use std::collections::HashSet;
use std::sync::atomic::{AtomicU64, Ordering};

use rayon::prelude::*;

use super::record::{Evaluation, Goal, Record, Stage, key};
use super::simplex::{Compute, Job, search as simplex};
use super::space::Space;
use crate::error::Error;
use crate::sweep::sampling::hypercube;

/// Share of designs that are spread.
const SPREAD: f64 = 0.35;
/// Share of designs for choosing branches.
const CHOOSING: f64 = 0.35;
/// Share kept to confirm limits.
const CONFIRMING: f64 = 0.1;
/// Most branches that are searched.
const MOST_BRANCHES: usize = 8;
/// Size of the first simplex of a branch, and around the best design.
const BRANCH_EDGE: f64 = 0.2;
const BEST_EDGE: f64 = 0.08;
/// Size below which a simplex finds nothing new.
const LEAST_EDGE: f64 = 1e-5;
/// Rounds without a new design after which everything is known.
const IDLE: u32 = 6;

/// A search on its way.
pub struct Search<'a> {
    space: &'a Space,
    goal: &'a Goal,
    compute: Compute<'a>,
    progress: &'a (dyn Fn(u64, u64) -> bool + Sync),
    seed: u64,
    budget: u64,
    done: AtomicU64,
    record: Record,
}

impl<'a> Search<'a> {
    /// A search of at most `budget` designs. `progress` is told designs done and to do; `false` stops.
    #[must_use]
    pub fn new(
        space: &'a Space,
        goal: &'a Goal,
        compute: Compute<'a>,
        progress: &'a (dyn Fn(u64, u64) -> bool + Sync),
        [budget, seed]: [u64; 2],
    ) -> Self {
        Self { space, goal, compute, progress, seed, budget, done: AtomicU64::new(0), record: Record::default() }
    }

    /// What was computed.
    #[must_use]
    pub fn record(&self) -> &Record {
        &self.record
    }

    /// The record, when the search is over.
    #[must_use]
    pub fn into_record(self) -> Record {
        self.record
    }

    /// What is searched.
    #[must_use]
    pub fn space(&self) -> &'a Space {
        self.space
    }

    /// Designs that may still be computed.
    #[must_use]
    pub fn left(&self) -> u64 {
        self.budget - self.record.all().len() as u64
    }

    /// Searches with all but the designs that are kept for [`super::binding`].
    ///
    /// # Errors
    /// [`Error::Cancelled`], [`Error::Internal`].
    pub fn run(&mut self) -> Result<(), Error> {
        let kept = (CONFIRMING * self.budget as f64) as u64;
        let all = self.budget - kept;
        if let Some(size) = self.space.size().filter(|size| *size <= all) {
            let places = (0..size).map(|number| self.space.numbered(number)).collect();
            return self.places(places, Stage::Explore);
        }
        self.spread(((SPREAD * all as f64) as u64).max(4), 0)?;
        self.branches((CHOOSING * all as f64) as u64)?;
        self.refine(kept)
    }

    /// Computes places, those that are known left out.
    fn places(&mut self, places: Vec<Vec<f64>>, stage: Stage) -> Result<(), Error> {
        let job = |start| Job { start, free: Vec::new(), edge: 0.0, quota: 1, stage };
        let mut seen = HashSet::new();
        let fresh = |place: &Vec<f64>| seen.insert(key(&self.space.values(place)));
        let jobs = places.into_iter().filter(fresh).map(job).collect();
        self.jobs(jobs, self.goal)
    }

    fn spread(&mut self, count: u64, round: u64) -> Result<(), Error> {
        let count = count.min(self.left());
        let shares = hypercube(self.space.variables().len(), count, self.seed.wrapping_add(round));
        let place = |i: usize| self.space.at_shares(shares.iter().map(|axis| axis[i]));
        self.places((0..count as usize).map(place).collect(), Stage::Explore)
    }

    /// Does searches at once and records what they find, in their order.
    ///
    /// # Errors
    /// Those of [`simplex`].
    pub fn jobs(&mut self, jobs: Vec<Job>, goal: &Goal) -> Result<(), Error> {
        let budget = self.budget;
        let compute = |place: &[f64], stage: Stage| {
            let evaluation = (self.compute)(place, stage)?;
            let done = self.done.fetch_add(1, Ordering::Relaxed) + 1;
            if (self.progress)(done, budget) { Ok(evaluation) } else { Err(Error::Cancelled) }
        };
        let found: Vec<Vec<Evaluation>> = jobs
            .par_iter()
            .map(|job| simplex(job, self.space, goal, &self.record, &compute))
            .collect::<Result<_, _>>()?;
        found.into_iter().flatten().for_each(|evaluation| self.record.push(evaluation));
        Ok(())
    }

    /// Branches by the best design of each, best first.
    fn ranked(&self) -> Vec<&Evaluation> {
        let mut best: Vec<&Evaluation> = Vec::new();
        for evaluation in self.record.all() {
            let branch = self.space.branch(&evaluation.place);
            match best.iter_mut().find(|other| self.space.branch(&other.place) == branch) {
                Some(other) if self.goal.better(&evaluation.outcome, &other.outcome) => *other = evaluation,
                Some(_) => {}
                None => best.push(evaluation),
            }
        }
        let better = |a: &Evaluation, b: &Evaluation| self.goal.better(&a.outcome, &b.outcome);
        best.sort_by(|a, b| better(b, a).cmp(&better(a, b)));
        best
    }

    fn branches(&mut self, budget: u64) -> Result<(), Error> {
        let free = self.space.ordered();
        if free.is_empty() {
            return Ok(());
        }
        let least = 2 * (free.len() as u64 + 1);
        let rounds = |count: u64| u64::from(count.ilog2()) + 1;
        let mut count = self.ranked().len().clamp(1, MOST_BRANCHES) as u64;
        while count > 1 && budget / (rounds(count) * count) < least {
            count -= 1;
        }
        let per_round = budget / rounds(count);
        let mut edge = BRANCH_EDGE;
        while count >= 1 {
            let quota = (per_round / count).min(self.left() / count);
            let job = |e: &&Evaluation| Job {
                start: e.place.clone(),
                free: free.clone(),
                edge,
                quota,
                stage: Stage::Branches,
            };
            let jobs = self.ranked().iter().take(count as usize).map(job).collect();
            self.jobs(jobs, self.goal)?;
            (count, edge) = (count / 2, 0.6 * edge);
        }
        Ok(())
    }

    /// The best design so far.
    #[must_use]
    pub fn best(&self) -> Option<&Evaluation> {
        self.goal.best(self.record.all())
    }

    /// Searches around the best design with all but `kept` designs.
    ///
    /// # Errors
    /// [`Error::Cancelled`], [`Error::Internal`].
    pub fn refine(&mut self, kept: u64) -> Result<(), Error> {
        let (ordered, ranges) = (self.space.ordered(), self.space.ranges());
        let mut tried = HashSet::new();
        let (mut edge, mut idle, mut round) = (BEST_EDGE, 0, 0);
        while self.left() > kept && idle < IDLE {
            let left = self.left() - kept;
            let Some(best) = self.best().map(|e| e.place.clone()) else { return Ok(()) };
            let before = self.record.all().len();
            let discrete = |place: &[f64]| -> Vec<u64> {
                let index = |k: &usize| !ranges.contains(k);
                (0..place.len()).filter(index).map(|k| place[k] as u64).collect()
            };
            let quota = if ranges.is_empty() { 1 } else { ranges.len() as u64 + 3 };
            let neighbours: Vec<Vec<f64>> =
                self.space.neighbours(&best).into_iter().filter(|p| !tried.contains(&discrete(p))).collect();
            if !neighbours.is_empty() {
                let some = neighbours.into_iter().take((left / quota).max(1) as usize);
                let jobs: Vec<Job> = some
                    .map(|start| {
                        tried.insert(discrete(&start));
                        let free = ranges.clone();
                        Job { start, free, edge: BEST_EDGE, quota: quota.min(left), stage: Stage::Refine }
                    })
                    .collect();
                self.jobs(jobs, self.goal)?;
            } else if !ordered.is_empty() && edge > LEAST_EDGE {
                let quota = left.min(15 * (ordered.len() as u64 + 1));
                let free = if edge > 0.02 || ranges.is_empty() { ordered.clone() } else { ranges.clone() };
                self.jobs(vec![Job { start: best.clone(), free, edge, quota, stage: Stage::Refine }], self.goal)?;
                edge *= 0.4;
            } else {
                round += 1;
                self.spread((left / 2).max(4).min(left), round)?;
                (edge, idle) = (BEST_EDGE, idle + 1);
            }
            if self.best().is_some_and(|now| now.place != best) && edge < BEST_EDGE {
                edge = (2.0 * edge).min(BEST_EDGE);
            }
            if self.record.all().len() > before {
                idle = 0;
            }
        }
        Ok(())
    }
}
