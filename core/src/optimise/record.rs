//! What has been computed, and how good it is.

use std::collections::HashMap;

use serde_json::Value;

use super::figures::Outcome;
use super::limits::Limit;
use super::objective::Objective;

/// What a share of excess costs in a search, in logarithms of the objective.
const WEIGHT: f64 = 20.0;
/// Costs of designs that cannot be compared by their objective.
const USELESS: f64 = 1e3;
const UNREACHED: f64 = 1e6;
const REFUSED: f64 = 1e9;

/// When a design was computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// Spread over everything.
    Explore,
    /// Branches against each other.
    Branches,
    /// Around the best.
    Refine,
    /// With a limit relaxed.
    Confirm,
}

impl Stage {
    /// The word in the table.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Explore => "explore",
            Self::Branches => "branches",
            Self::Refine => "refine",
            Self::Confirm => "confirm",
        }
    }
}

/// A design that was computed.
#[derive(Debug, Clone)]
pub struct Evaluation {
    /// Where it is.
    pub place: Vec<f64>,
    /// Its values.
    pub values: Vec<Value>,
    /// What became of it.
    pub outcome: Outcome,
    /// When.
    pub stage: Stage,
}

/// What is wanted, and under which limits.
#[derive(Debug, Clone)]
pub struct Goal {
    /// What is maximised.
    pub objective: Objective,
    /// What must be kept.
    pub limits: Vec<Limit>,
}

impl Goal {
    /// The objective of a design that keeps every limit.
    #[must_use]
    pub fn achieved(&self, outcome: &Outcome) -> Option<f64> {
        let Outcome::Designed(figures) = outcome else { return None };
        let value = self.objective.of(figures);
        (value > 0.0 && value.is_finite() && self.limits.iter().all(|l| l.excess(outcome) == 0.0)).then_some(value)
    }

    /// What a search makes small. Excess costs more than it can gain, so that the least cost is on a limit, not beyond.
    #[must_use]
    pub fn cost(&self, outcome: &Outcome) -> f64 {
        let excess: f64 = self.limits.iter().map(|l| l.excess(outcome)).sum();
        match outcome {
            Outcome::Designed(figures) => match self.objective.of(figures) {
                value if value > 0.0 && value.is_finite() && excess.is_finite() => -value.ln() + WEIGHT * excess,
                _ => USELESS + excess.min(USELESS),
            },
            Outcome::Contrast { share, .. } => UNREACHED * (1.0 + share.min(USELESS)),
            Outcome::Refused { .. } => REFUSED * 10.0,
        }
    }

    /// Whether the first is better: designs that keep the limits by their objective, before all others by their cost.
    #[must_use]
    pub fn better(&self, a: &Outcome, b: &Outcome) -> bool {
        match (self.achieved(a), self.achieved(b)) {
            (Some(a), Some(b)) => a > b,
            (None, None) => self.cost(a) < self.cost(b),
            (a, _) => a.is_some(),
        }
    }

    /// Number of the best design of a list that keeps every limit; the earlier of equals.
    #[must_use]
    pub fn best_of(&self, all: &[Evaluation]) -> Option<usize> {
        let achieved = all.iter().enumerate().filter_map(|(i, e)| Some((i, self.achieved(&e.outcome)?)));
        achieved.reduce(|best, next| if next.1 > best.1 { next } else { best }).map(|(i, _)| i)
    }

    /// Why a design is ruled out: its own reason, or the limits that it does not keep. Nothing where it is not.
    #[must_use]
    pub fn refusals(&self, outcome: &Outcome) -> Vec<String> {
        let beyond = self.limits.iter().filter(|l| l.excess(outcome) > 0.0);
        match outcome {
            Outcome::Designed(_) => beyond.map(|l| format!("limits.{}", l.name())).collect(),
            Outcome::Contrast { .. } => vec!["the phases do not reach the contrast".to_owned()],
            Outcome::Refused { reason } => vec![reason.clone()],
        }
    }

    /// The best of a list; the earlier of equals.
    pub fn best<'a>(&self, all: impl IntoIterator<Item = &'a Evaluation>) -> Option<&'a Evaluation> {
        all.into_iter().reduce(|best, next| if self.better(&next.outcome, &best.outcome) { next } else { best })
    }
}

/// All designs that were computed, in an order that does not depend on the number of cores.
#[derive(Debug, Default)]
pub struct Record {
    all: Vec<Evaluation>,
    known: HashMap<String, usize>,
}

/// Values as a key of a map.
#[must_use]
pub fn key(values: &[Value]) -> String {
    Value::from(values.to_vec()).to_string()
}

impl Record {
    /// All of them, given away.
    #[must_use]
    pub fn into_all(self) -> Vec<Evaluation> {
        self.all
    }

    /// All of them.
    #[must_use]
    pub fn all(&self) -> &[Evaluation] {
        &self.all
    }

    /// What is known of some values.
    #[must_use]
    pub fn get(&self, key: &str) -> Option<&Evaluation> {
        self.known.get(key).map(|i| &self.all[*i])
    }

    /// Takes a design in.
    pub fn push(&mut self, evaluation: Evaluation) {
        self.known.entry(key(&evaluation.values)).or_insert(self.all.len());
        self.all.push(evaluation);
    }
}
