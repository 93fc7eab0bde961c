//! `voxelastica sweep`.

use std::path::PathBuf;

use serde_json::json;
use voxelastica_core::Error;
use voxelastica_core::solver::ccx::Ccx;
use voxelastica_core::sweep::run::{
    Batch, DESIGNS, RunOptions, known, record, run as compute, seconds_per_point, write_designs,
};
use voxelastica_core::sweep::table::Status;
use voxelastica_core::sweep::{Sweep, gather};

use super::figures;
use crate::args::SweepOptions;
use crate::console::Console;

/// Exit code where points failed.
const FAILED: u8 = 4;

/// Computes a sweep, or a part of it.
pub fn run(options: &SweepOptions, console: &Console) -> Result<u8, Error> {
    let sweep = Sweep::read(&options.file)?;
    let folder = options.output.clone().unwrap_or_else(|| PathBuf::from("out").join(&sweep.input().name));
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let run_options = RunOptions {
        batch: options.batch.unwrap_or(Batch::WHOLE),
        threads: options.threads.map_or(cores, usize::from),
        allow_large: options.yes,
        ccx: Ccx { executable: options.ccx.clone(), threads: 1 },
    };
    if options.plan {
        return plan(&sweep, &folder, &run_options, console);
    }
    if options.designs {
        let cancelled = || console.is_cancelled();
        let count = write_designs(&sweep, &folder, run_options.batch, &cancelled)?;
        console.say(format!("written   {count} designs into {}", folder.join(DESIGNS).display()));
        return Ok(0);
    }
    if let Some(results) = &options.record {
        let count = record(&sweep, &folder, results)?;
        console.say(format!("recorded  {count} points of {}", sweep.points()));
        return Ok(0);
    }
    let mut failed = 0;
    if !options.gather {
        failed = points(&sweep, &folder, &run_options, console)?;
    }
    if options.gather || options.batch.is_none() {
        write(&sweep, &folder, options, console)?;
    }
    Ok(if failed > 0 { FAILED } else { 0 })
}

/// What there is to do, as JSON.
fn plan(sweep: &Sweep, folder: &std::path::Path, options: &RunOptions, console: &Console) -> Result<u8, Error> {
    let cancelled = || console.is_cancelled();
    let done = known(sweep, folder)?.iter().filter(|k| **k).count();
    let seconds = seconds_per_point(sweep, &options.ccx, &cancelled)?;
    let plan = json!({
        "sweep": sweep.hash(),
        "name": sweep.input().name,
        "model": sweep.input().model.name(),
        "points": sweep.points(),
        "done": done,
        "seconds_per_point": seconds,
    });
    console.answer(format!("{plan:#}"));
    Ok(0)
}

/// Computes the points that are missing; returns how many failed.
fn points(sweep: &Sweep, folder: &std::path::Path, options: &RunOptions, console: &Console) -> Result<u64, Error> {
    let bar = console.bar(sweep.points(), "{msg} {bar:30} {pos} of {len}, {eta} left", "points");
    let progress = |done: u64, total: u64| {
        if total > 0 {
            bar.set_length(total);
            bar.set_position(done);
        }
        !console.is_cancelled()
    };
    let tally = compute(sweep, folder, options, &progress);
    bar.finish_and_clear();
    let tally = tally?;
    console.say(format!(
        "computed  {} points, {} of them infeasible, {} failed; {} were known",
        tally.computed, tally.infeasible, tally.failed, tally.known
    ));
    if tally.failed > 0 {
        console.warn(format!("{} points failed; the table says why; run again to try them again", tally.failed));
    }
    Ok(tally.failed)
}

/// Gathers the journals.
fn write(sweep: &Sweep, folder: &std::path::Path, options: &SweepOptions, console: &Console) -> Result<(), Error> {
    let table = gather::read(sweep, folder)?;
    let files = gather::write(&table, folder, options.partial)?;
    let counted = |status: Status| table.count(status);
    console.say(format!(
        "table     {} points: {} ok, {} infeasible, {} failed, {} missing",
        sweep.points(),
        counted(Status::Ok),
        counted(Status::Infeasible),
        counted(Status::Failed),
        counted(Status::Missing)
    ));
    for (k, name) in sweep.input().outputs.iter().enumerate() {
        let values = (0..sweep.points()).map(|p| table.figure(k, p)).filter(|v| v.is_finite());
        let [low, high] = values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| [low.min(v), high.max(v)]);
        if low <= high {
            console.detail(format!("          {name}: {} to {}", figures(low), figures(high)));
        }
    }
    for file in files {
        console.say(format!("written   {}", folder.join(file).display()));
    }
    Ok(())
}
