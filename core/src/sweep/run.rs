//! Computing the points that the journals lack.
//!
//! Every worker computes whole points, and parallel parts of a point run on the worker alone: points do not wait for each
//! other, and figures do not depend on the number of cores.

use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc;
use std::time::Instant;

use super::journal::{Entry, Journal, read_all};
use super::outputs::SweepModel;
use super::point::{Outcome, compute};
use super::{MANY_POINTS, Sweep, SweepError};
use crate::error::Error;
use crate::output::folder::Staging;
use crate::output::json;
use crate::progress::Cancelled;
use crate::solver::ccx::Ccx;

/// Expected computing time above which a sweep is refused unless it was asked for explicitly, s.
const LONG: f64 = 86_400.0;

/// A part of a sweep: the points whose number leaves `index - 1` when divided by `count`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Batch {
    /// From 1.
    pub index: u64,
    /// Number of batches.
    pub count: u64,
}

impl Batch {
    /// All points.
    pub const WHOLE: Self = Self { index: 1, count: 1 };

    /// Whether a point belongs to it.
    #[must_use]
    pub fn holds(self, point: u64) -> bool {
        point % self.count == self.index - 1
    }

    fn journal(self) -> String {
        format!("batch-{}-of-{}", self.index, self.count)
    }
}

/// How a sweep is computed.
#[derive(Debug, Clone)]
pub struct RunOptions {
    /// The points to compute.
    pub batch: Batch,
    /// Points at once.
    pub threads: usize,
    /// Compute however long it takes.
    pub allow_large: bool,
    /// CalculiX, for the model that needs it.
    pub ccx: Ccx,
}

/// What a run did.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Tally {
    /// Points that were known before.
    pub known: u64,
    /// Points computed.
    pub computed: u64,
    /// Of those, infeasible.
    pub infeasible: u64,
    /// Of those, failed.
    pub failed: u64,
}

/// Which points the journals have; failed ones are tried again.
///
/// # Errors
/// Those of [`read_all`].
pub fn known(sweep: &Sweep, folder: &Path) -> Result<Vec<bool>, Error> {
    let mut known = vec![false; usize::try_from(sweep.points()).unwrap_or(usize::MAX)];
    read_all(folder, sweep.hash(), sweep.points(), |entry| {
        if !matches!(entry.outcome, Outcome::Failed { .. }) {
            known[entry.point as usize] = true;
        }
    })?;
    Ok(known)
}

/// Seconds that a point takes, measured on the first one that is feasible of a few; nothing is kept.
///
/// # Errors
/// Those of [`compute`].
pub fn seconds_per_point(sweep: &Sweep, ccx: &Ccx, cancelled: Cancelled<'_>) -> Result<f64, Error> {
    let mut seconds = 0.0_f64;
    for k in 0..4 {
        let start = Instant::now();
        let outcome = compute(sweep, k * sweep.points() / 4, ccx, cancelled)?;
        seconds = seconds.max(start.elapsed().as_secs_f64());
        if matches!(outcome, Outcome::Ok { .. }) {
            break;
        }
    }
    Ok(seconds)
}

/// Refuses sweeps that nobody would wait for.
///
/// # Errors
/// [`SweepError::Many`] as [`Error::Input`].
pub fn require_bearable(sweep: &Sweep, options: &RunOptions, cancelled: Cancelled<'_>) -> Result<(), Error> {
    if options.allow_large || sweep.points() < 1000 {
        return Ok(());
    }
    let points = sweep.points() / options.batch.count;
    let seconds = seconds_per_point(sweep, &options.ccx, cancelled)?;
    if points <= MANY_POINTS && points as f64 * seconds / options.threads as f64 <= LONG {
        return Ok(());
    }
    let columns = 3 + sweep.input().axes.len() + sweep.input().outputs.len();
    let bytes = points * columns as u64 * 40;
    Err(SweepError::Many { points, seconds_per_point: seconds, threads: options.threads, bytes }.into())
}

/// Computes the points of a batch that no journal has. `progress` is told points done and points to do; `false` stops: what was
/// computed is kept.
///
/// # Errors
/// Those of [`Journal`] and [`compute`]; [`Error::Cancelled`].
pub fn run(
    sweep: &Sweep,
    folder: &Path,
    options: &RunOptions,
    progress: &(dyn Fn(u64, u64) -> bool + Sync),
) -> Result<Tally, Error> {
    let stop = AtomicBool::new(false);
    let cancelled = || stop.load(Ordering::Relaxed) || !progress(0, 0);
    require_bearable(sweep, options, &cancelled)?;
    let mut journal = Journal::open(folder, &options.batch.journal(), sweep.hash())?;
    let known = known(sweep, folder)?;
    let missing: Vec<u64> = (0..sweep.points()).filter(|p| options.batch.holds(*p) && !known[*p as usize]).collect();
    let of_batch = (0..sweep.points()).filter(|p| options.batch.holds(*p)).count() as u64;
    let mut tally = Tally { known: of_batch - missing.len() as u64, ..Tally::default() };
    if sweep.input().model == SweepModel::External || missing.is_empty() {
        return Ok(tally);
    }
    let (next, total) = (AtomicU64::new(0), missing.len() as u64);
    let mut first_error = None;
    std::thread::scope(|scope| {
        let (send, receive) = mpsc::channel::<Result<Entry, Error>>();
        for _ in 0..options.threads.clamp(1, missing.len()) {
            let (send, next, missing, cancelled) = (send.clone(), &next, &missing, &cancelled);
            scope.spawn(move || {
                let work = || loop {
                    let Some(point) = missing.get(next.fetch_add(1, Ordering::Relaxed) as usize) else { return };
                    if cancelled() {
                        let _ = send.send(Err(Error::Cancelled));
                        return;
                    }
                    let outcome = compute(sweep, *point, &options.ccx, cancelled);
                    let ends = outcome.is_err();
                    let _ = send.send(outcome.map(|outcome| Entry { point: *point, outcome }));
                    if ends {
                        return;
                    }
                };
                match rayon::ThreadPoolBuilder::new().num_threads(1).build() {
                    Ok(pool) => pool.install(work),
                    Err(error) => {
                        let _ = send.send(Err(Error::Internal(format!("a thread: {error}"))));
                    }
                }
            });
        }
        drop(send);
        for result in receive {
            let kept = result.and_then(|entry| journal.append(&entry).map(|()| entry));
            match kept {
                Ok(entry) => {
                    tally.computed += 1;
                    tally.infeasible += u64::from(matches!(entry.outcome, Outcome::Infeasible { .. }));
                    tally.failed += u64::from(matches!(entry.outcome, Outcome::Failed { .. }));
                    progress(tally.computed, total);
                }
                Err(error) => {
                    stop.store(true, Ordering::Relaxed);
                    // What ended the work comes before what followed from it.
                    if first_error.is_none() || matches!(first_error, Some(Error::Cancelled)) {
                        first_error = Some(error);
                    }
                }
            }
        }
    });
    journal.sync()?;
    first_error.map_or(Ok(tally), Err)
}

/// Folder of the design files that [`write_designs`] writes.
pub const DESIGNS: &str = "designs";

/// Writes the design of every point of a batch, for solvers elsewhere: `designs/point_3.json`. Points whose values do not go
/// together have none. Returns how many were written.
///
/// # Errors
/// [`Error::Output`], [`Error::Cancelled`].
pub fn write_designs(sweep: &Sweep, folder: &Path, batch: Batch, cancelled: Cancelled<'_>) -> Result<u64, Error> {
    let mut staging = Staging::new(folder)?;
    let mut count = 0;
    for point in (0..sweep.points()).filter(|p| batch.holds(*p)) {
        if cancelled() {
            return Err(Error::Cancelled);
        }
        let Ok(input) = sweep.design_input(point) else { continue };
        let name = format!("{DESIGNS}/point_{point}.json");
        let text = json::to_text(&input).map_err(|e| Error::Internal(format!("{name}: {e}")))?;
        staging.write_text(&name, &text)?;
        count += 1;
    }
    staging.commit()?;
    Ok(count)
}

/// Takes results of another solver into a journal: one JSON object a line, `{"point": 3, "outputs": {...}}` or
/// `{"point": 3, "failure": "..."}`.
///
/// # Errors
/// [`SweepError::Journal`] naming file and line, as [`Error::Input`]; those of [`Journal`].
pub fn record(sweep: &Sweep, folder: &Path, results: &Path) -> Result<u64, Error> {
    let text = crate::input::files::read_text(results, 1 << 30)
        .map_err(|problem| crate::InputError::new("", "", problem).in_file(&results.display().to_string()))?;
    let mut entries = Vec::new();
    for (number, line) in text.lines().enumerate().filter(|(_, l)| !l.trim().is_empty()) {
        let wrong = |problem: String| SweepError::Journal { path: results.to_owned(), line: number + 1, problem };
        let result: External = serde_json::from_str(line).map_err(|e| wrong(e.to_string()))?;
        if result.point >= sweep.points() {
            return Err(wrong(format!("point {} of {}", result.point, sweep.points())).into());
        }
        if let Some(name) = result.outputs.iter().flatten().map(|(n, _)| n).find(|n| !sweep.input().outputs.contains(n))
        {
            let known = sweep.input().outputs.join(", ");
            return Err(wrong(format!("the sweep does not keep a figure \"{name}\"; it keeps {known}")).into());
        }
        let outcome = match (result.outputs, result.failure) {
            (Some(outputs), None) => of_external(sweep, result.point, outputs)?,
            (None, Some(reason)) => Outcome::Failed { reason },
            _ => return Err(wrong("a result has either outputs or a failure".to_owned()).into()),
        };
        entries.push(Entry { point: result.point, outcome });
    }
    let mut journal = Journal::open(folder, "recorded", sweep.hash())?;
    entries.iter().try_for_each(|entry| journal.append(entry))?;
    journal.sync()?;
    Ok(entries.len() as u64)
}

/// A result of another solver, with the figures of the design itself.
fn of_external(sweep: &Sweep, point: u64, outputs: std::collections::BTreeMap<String, f64>) -> Result<Outcome, Error> {
    Ok(match compute(sweep, point, &Ccx::default(), &crate::progress::never)? {
        Outcome::Ok { outputs: mut all } if sweep.input().model == SweepModel::External => {
            all.extend(outputs);
            Outcome::Ok { outputs: all }
        }
        Outcome::Ok { .. } => Outcome::Ok { outputs },
        other => other,
    })
}

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct External {
    point: u64,
    #[serde(default)]
    outputs: Option<std::collections::BTreeMap<String, f64>>,
    #[serde(default)]
    failure: Option<String>,
}
