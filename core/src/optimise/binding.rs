//! Which limits bind: those that keep a better design from being taken. Either the best design reaches the limit and a wider one
//! lets it gain, or a design that was computed is better and ruled out by this limit alone.

use serde::Serialize;

use super::figures::Outcome;
use super::limits::Limit;
use super::record::{Goal, Stage};
use super::search::Search;
use super::simplex::Job;
use crate::error::Error;

/// Slack below which a limit may bind, share of the limit.
pub const NEAR: f64 = 0.02;
/// By how much a limit is relaxed to see whether that helps.
const RELAXED: f64 = 0.05;
/// Least gain that counts, share of the objective.
const GAIN: f64 = 1e-3;
/// Size of the simplex that looks for it.
const EDGE: f64 = 0.05;

/// A limit at the best design.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LimitRecord {
    /// Its key.
    pub limit: &'static str,
    /// Largest value.
    pub most: f64,
    /// What the design has.
    pub value: f64,
    /// What is left, share of the limit.
    pub slack: f64,
    /// Whether it keeps the objective from being larger.
    pub binds: bool,
    /// Relative gain found with the limit relaxed by a twentieth; absent where that was not tried.
    pub gain_if_relaxed: Option<f64>,
    /// Relative gain of the best computed design that this limit alone rules out; absent where there is none.
    pub gain_beyond: Option<f64>,
}

/// Holds the best design against all limits, with the designs that are left.
///
/// # Errors
/// Those of [`Search::jobs`].
pub fn confirm(search: &mut Search<'_>, goal: &Goal) -> Result<Vec<LimitRecord>, Error> {
    let mut share = near(search, goal).len() as u64;
    for limit in near(search, goal) {
        let (Some(wider), Some(best)) = (limit.relaxed(RELAXED), search.best()) else { continue };
        let ordered = search.space().ordered();
        let job = Job {
            start: best.place.clone(),
            free: ordered,
            edge: EDGE,
            quota: search.left() / share,
            stage: Stage::Confirm,
        };
        share = share.saturating_sub(1).max(1);
        if job.quota > 0 {
            search.jobs(vec![job], &with(goal, &wider))?;
        }
    }
    let Some(best) = search.best() else { return Ok(Vec::new()) };
    let (Outcome::Designed(figures), Some(achieved)) = (&best.outcome, goal.achieved(&best.outcome)) else {
        return Ok(Vec::new());
    };
    let record = |limit: &Limit| {
        let value = limit.value(figures);
        let slack = 1.0 - value / limit.most;
        let gain = limit.relaxed(RELAXED).filter(|_| slack <= NEAR).map(|wider| {
            let wider = with(goal, &wider);
            let most = search.record().all().iter().filter_map(|e| wider.achieved(&e.outcome)).fold(achieved, f64::max);
            most / achieved - 1.0
        });
        // Steps of whole voxels or spokes may leave slack at a limit that rules the next step out.
        let beyond = ruled_out(search, goal, limit).map(|most| most / achieved - 1.0);
        let binds = (slack <= NEAR && gain.is_none_or(|gain| gain > GAIN)) || beyond.is_some_and(|gain| gain > GAIN);
        LimitRecord {
            limit: limit.name(),
            most: limit.most,
            value,
            slack,
            binds,
            gain_if_relaxed: gain,
            gain_beyond: beyond,
        }
    };
    Ok(goal.limits.iter().map(record).collect())
}

/// The largest objective of the designs that a limit alone rules out.
fn ruled_out(search: &Search<'_>, goal: &Goal, limit: &Limit) -> Option<f64> {
    let others = Goal {
        objective: goal.objective,
        limits: goal.limits.iter().filter(|l| l.name() != limit.name()).copied().collect(),
    };
    let all = search.record().all().iter().filter(|e| limit.excess(&e.outcome) > 0.0);
    all.filter_map(|e| others.achieved(&e.outcome)).reduce(f64::max)
}

fn with(goal: &Goal, wider: &Limit) -> Goal {
    let limit = |l: &Limit| if l.name() == wider.name() { *wider } else { *l };
    Goal { objective: goal.objective, limits: goal.limits.iter().map(limit).collect() }
}

/// Limits that the best design nearly reaches.
pub(super) fn near(search: &Search<'_>, goal: &Goal) -> Vec<Limit> {
    let Some(Outcome::Designed(figures)) = search.best().map(|e| e.outcome.clone()) else { return Vec::new() };
    goal.limits.iter().filter(|l| 1.0 - l.value(&figures) / l.most <= NEAR).copied().collect()
}
