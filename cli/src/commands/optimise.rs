//! `voxelastica optimise`.

use std::path::PathBuf;

use voxelastica_core::Error;
use voxelastica_core::optimise::output::write;
use voxelastica_core::optimise::{Optimisation, Optimum};

use super::{INFEASIBLE, figures};
use crate::args::OptimiseOptions;
use crate::console::Console;

/// Reasons that are shown where no design keeps the limits.
const REASONS: usize = 5;

/// Looks for the best design.
pub fn run(options: &OptimiseOptions, console: &Console) -> Result<u8, Error> {
    let optimisation = Optimisation::read(&options.file)?;
    let folder = options.output.clone().unwrap_or_else(|| PathBuf::from("out").join(&optimisation.input().name));
    let bar = console.bar(optimisation.input().evaluations, "{msg} {bar:30} {pos} of {len}, {eta} left", "designs");
    let progress = |done: u64, _: u64| {
        bar.set_position(done);
        !console.is_cancelled()
    };
    let cancelled = || console.is_cancelled();
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let optimum = optimisation.run(options.threads.map_or(cores, usize::from), &progress, &cancelled);
    bar.finish_and_clear();
    let optimum = optimum?;
    report(&optimisation, &optimum, console);
    for file in write(&optimisation, &optimum, &folder)? {
        console.say(format!("written   {}", folder.join(file).display()));
    }
    Ok(if optimum.best.is_some() { 0 } else { INFEASIBLE })
}

fn report(optimisation: &Optimisation, optimum: &Optimum, console: &Console) {
    let goal = optimisation.goal();
    let feasible = optimum.evaluations.iter().filter(|e| goal.achieved(&e.outcome).is_some()).count();
    console.say(format!("computed  {} designs, {feasible} of them keep all limits", optimum.evaluations.len()));
    let Some((best, achieved)) = optimum.best().and_then(|best| Some((best, goal.achieved(&best.outcome)?))) else {
        eprintln!("error: {}: no design keeps all limits; what rules designs out:", optimisation.input().name);
        for (reason, count) in optimum.refusals(goal).into_iter().take(REASONS) {
            eprintln!("  {count} designs: {reason}");
        }
        eprintln!("  widen the limits or the ranges, or let other phases in");
        return;
    };
    console.say(format!("best      {} = {}", goal.objective.name(), figures(achieved)));
    for (variable, value) in optimisation.space().variables().iter().zip(&best.values) {
        let end = optimum.ends.iter().find(|(key, _)| key == variable.key());
        let end = end.map_or_else(String::new, |(_, end)| format!("  (the {end} end of its range)"));
        console.say(format!("          {} = {value}{end}", variable.key()));
    }
    for limit in &optimum.limits {
        let binds = match (limit.binds, limit.gain_if_relaxed, limit.gain_beyond) {
            (false, _, _) => String::new(),
            (true, Some(gain), _) if gain > 0.0 => format!("  binds: 5 % more of it gives {:.2} % more", 100.0 * gain),
            (true, _, Some(gain)) => format!("  binds: a design beyond it has {:.1} % more", 100.0 * gain),
            (true, _, None) => "  binds".to_owned(),
        };
        console.say(format!("limit     {} {} of {}{binds}", limit.limit, figures(limit.value), figures(limit.most)));
    }
}
