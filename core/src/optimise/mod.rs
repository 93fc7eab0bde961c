//! Choosing: the design that has most of one figure and keeps all limits.
//!
//! - [`input`] is the file; [`space`] which values the keys may take;
//! - [`figures`] computes what objective and limits are made of, by the way of `voxelastica design`;
//! - [`objective`] and [`limits`] say how good a design is; [`record`] keeps what was computed;
//! - [`search`] looks for the best, with the simplex of [`simplex`]; [`binding`] asks which limits cost something;
//! - [`output`] writes the best design, the table of all and a record.
//!
//! The same file gives the same optimum, whatever the number of cores.

pub mod binding;
pub mod figures;
pub mod input;
pub mod limits;
pub mod objective;
pub mod output;
pub mod record;
pub mod search;
pub mod simplex;
pub mod space;

use std::path::Path;

pub use input::{OptimiseInput, VariableInput};
pub use objective::Objective;

use crate::error::Error;
use crate::input::{DesignInput, InputError};
use crate::progress::Cancelled;
use crate::sweep::base::Base;
use crate::sweep::input::line_of;
use binding::LimitRecord;
use figures::{Outcome, Press};
use record::{Evaluation, Goal};
use search::Search;
use space::Space;

/// An optimisation that is ready to run.
#[derive(Debug, Clone)]
pub struct Optimisation {
    input: OptimiseInput,
    space: Space,
    base: Base,
    goal: Goal,
    press: Press,
}

/// What was found.
#[derive(Debug, Clone)]
pub struct Optimum {
    /// All designs that were computed, in order.
    pub evaluations: Vec<Evaluation>,
    /// Number of the best one that keeps every limit; `None` where none does.
    pub best: Option<usize>,
    /// The limits at the best design.
    pub limits: Vec<LimitRecord>,
    /// Variables that are at an end of their range there, and at which.
    pub ends: Vec<(String, &'static str)>,
}

impl Optimisation {
    /// Reads the file, and the design file that it starts from.
    ///
    /// # Errors
    /// [`Error::Input`] naming file, line, key and value.
    pub fn read(path: &Path) -> Result<Self, Error> {
        let (input, folder, lines) = OptimiseInput::read(path)?;
        let shown = path.display().to_string();
        let located = |mut error: InputError| {
            error.line = error.line.or_else(|| line_of(&lines, &error.key));
            Error::Input(error.in_file(&shown))
        };
        let base = Base::read(&folder.join(&input.base))?;
        let space = Space::new(&input.variables, &base).map_err(located)?;
        let goal = Goal { objective: input.maximise, limits: input.limits.all() };
        let press = limits::press(input.maximise, &goal.limits);
        let mut found = Self { input, space, base, goal, press };
        let mut settled = found.base.clone();
        let keys = found.space.variables().iter().map(space::Variable::key);
        settled.settle_target(keys, |_| found.design(&found.space.at_shares(std::iter::repeat(0.0))))?;
        found.base = settled;
        Ok(found)
    }

    /// The file.
    #[must_use]
    pub fn input(&self) -> &OptimiseInput {
        &self.input
    }

    /// What may vary.
    #[must_use]
    pub fn space(&self) -> &Space {
        &self.space
    }

    /// What is wanted.
    #[must_use]
    pub fn goal(&self) -> &Goal {
        &self.goal
    }

    /// The design of a place.
    ///
    /// # Errors
    /// [`InputError`] where its values do not go together.
    pub fn design(&self, place: &[f64]) -> Result<DesignInput, InputError> {
        let keys = self.space.variables().iter().map(space::Variable::key);
        self.base.design(keys.zip(self.space.values(place)), self.input.name.clone(), &self.input.name)
    }

    /// What becomes of a place.
    ///
    /// # Errors
    /// [`Error::Cancelled`], [`Error::Internal`].
    pub fn outcome(&self, place: &[f64], cancelled: Cancelled<'_>) -> Result<Outcome, Error> {
        match self.design(place) {
            Ok(input) => figures::compute(&input, self.press, cancelled),
            Err(error) => Ok(Outcome::Refused { reason: figures::one_line(&error.to_string()) }),
        }
    }

    /// Searches on some threads. `progress` is told designs done and to do; `false` stops.
    ///
    /// # Errors
    /// [`Error::Cancelled`], [`Error::Internal`].
    pub fn run(
        &self,
        threads: usize,
        progress: &(dyn Fn(u64, u64) -> bool + Sync),
        cancelled: Cancelled<'_>,
    ) -> Result<Optimum, Error> {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .map_err(|e| Error::Internal(format!("threads cannot be started: {e}")))?;
        pool.install(|| self.search(progress, cancelled))
    }

    fn search(&self, progress: &(dyn Fn(u64, u64) -> bool + Sync), cancelled: Cancelled<'_>) -> Result<Optimum, Error> {
        let compute = |place: &[f64], stage| {
            let outcome = self.outcome(place, cancelled)?;
            Ok(Evaluation { place: place.to_vec(), values: self.space.values(place), outcome, stage })
        };
        let sizes = [self.input.evaluations, self.input.seed];
        let mut search = Search::new(&self.space, &self.goal, &compute, progress, sizes);
        search.run()?;
        if binding::near(&search, &self.goal).is_empty() {
            search.refine(0)?;
        }
        let limits = binding::confirm(&mut search, &self.goal)?;
        let evaluations = search.into_record().into_all();
        let best = self.goal.best_of(&evaluations);
        let ends = best.map_or_else(Vec::new, |best| self.ends(&evaluations[best].place));
        Ok(Optimum { evaluations, best, limits: if best.is_some() { limits } else { Vec::new() }, ends })
    }

    fn ends(&self, place: &[f64]) -> Vec<(String, &'static str)> {
        let end = |(v, p): (&space::Variable, &f64)| Some((v.key().to_owned(), v.end(*p)?));
        self.space.variables().iter().zip(place).filter_map(end).collect()
    }
}

impl Optimum {
    /// The best design.
    #[must_use]
    pub fn best(&self) -> Option<&Evaluation> {
        self.best.and_then(|best| self.evaluations.get(best))
    }

    /// Why designs were ruled out and how many each, the commonest first.
    #[must_use]
    pub fn refusals(&self, goal: &Goal) -> Vec<(String, usize)> {
        let mut counts: Vec<(String, usize)> = Vec::new();
        for evaluation in &self.evaluations {
            for reason in goal.refusals(&evaluation.outcome) {
                match counts.iter_mut().find(|(known, _)| *known == reason) {
                    Some((_, count)) => *count += 1,
                    None => counts.push((reason, 1)),
                }
            }
        }
        counts.sort_by(|a, b| b.1.cmp(&a.1).then_with(|| a.0.cmp(&b.0)));
        counts
    }
}
