//! `voxelastica conduct`.

use voxelastica_core::conduction::ashby;
use voxelastica_core::conduction::case::{Answer, Problem, Regimes, solve};
use voxelastica_core::conduction::output::{Results, WriteOptions, stem, write};
use voxelastica_core::conduction::pcg::Watch;
use voxelastica_core::conduction::strip::{Model, Property, Shape, Strip};
use voxelastica_core::input::{ConductionInput, Electrode, ThresholdOf};
use voxelastica_core::{Design, Error};

use super::{designed, figures};
use crate::args::{ConductModel, ConductOptions, ConductShape, ElectrodeChoice, Flow, Regime, ThresholdChoice};
use crate::console::Console;

/// Solves heat and current on a design's strip.
pub fn run(options: &ConductOptions, console: &Console) -> Result<u8, Error> {
    let design = designed(&options.folder, console)?;
    let shown = options.folder.join("design.json").display().to_string();
    let located = |error: Error| error.in_file(&shown);
    let input = parameters(&design, options);
    input.validate().map_err(|e| located(Error::Input(e)))?;

    let mut strips = Vec::new();
    for model in models(options) {
        for shape in shapes(options) {
            let going = |_: f64| !console.is_cancelled();
            let watch = Watch { progress: &going, span: [0.0, 1.0] };
            let strip = Strip::new_unless(&design, model, shape, input.graded_elements, watch);
            let strip = strip.map_err(|e| located(e.into()))?;
            strips.push(strip);
        }
    }
    let regimes = Regimes { steady: options.regime != Regime::Transient, transient: options.regime != Regime::Steady };
    let tasks: Vec<(&Strip, Problem)> =
        strips.iter().flat_map(|strip| problems(options).into_iter().map(move |p| (strip, p))).collect();
    let charts = if options.ashby { problems(options).len() } else { 0 };
    let whole = (tasks.len() + charts) as f64;

    let bar = console.bar(1000, "{msg} [{wide_bar}] {percent} % {elapsed}", "solving");
    let progress = |share: f64| {
        bar.set_position((1000.0 * share) as u64);
        !console.is_cancelled()
    };
    let watch = Watch { progress: &progress, span: [0.0, 1.0] };
    let part = |n: usize| watch.part(n as f64 / whole, (n + 1) as f64 / whole);
    let mut cases = Vec::new();
    for (n, (strip, problem)) in tasks.iter().enumerate() {
        cases.push((*strip, solve(strip, *problem, regimes, &input, part(n)).map_err(|e| located(e.into()))?));
    }
    let mut diagrams = Vec::new();
    if options.ashby {
        for (n, problem) in problems(options).into_iter().enumerate() {
            let property = match problem {
                Problem::Heat => Property::Conductivity,
                Problem::Current => Property::ElectricalConductivity,
            };
            diagrams.push(ashby::chart(design.input(), property, part(tasks.len() + n)).map_err(located)?);
        }
    }
    bar.finish_and_clear();

    let results = Results { design: &design, input: &input, cases: &cases, charts: &diagrams };
    let folder = options.output.as_deref().unwrap_or(&options.folder);
    let files = write(&results, folder, WriteOptions { vtu: !options.no_vtu, allow_large: options.yes })?;
    for (_, answer) in &cases {
        report(answer, console);
    }
    let mut lines: Vec<String> = cases.iter().flat_map(|(_, a)| a.assumptions.iter().map(|a| a.line())).collect();
    lines.dedup();
    let mut told: Vec<String> = Vec::new();
    for line in lines.into_iter().chain(cases.iter().flat_map(|(_, a)| a.notes.clone())) {
        if !told.contains(&line) {
            console.warn(&line);
            told.push(line);
        }
    }
    console.say(format!("written   {}", folder.join("conduct.json").display()));
    for file in &files {
        console.detail(format!("          {file}"));
    }
    Ok(0)
}

/// The design's parameters with what the command line says instead.
fn parameters(design: &Design, options: &ConductOptions) -> ConductionInput {
    let mut input = design.input().conduction.clone().unwrap_or_default();
    let set = |value: Option<f64>, target: &mut f64| {
        if let Some(value) = value {
            *target = value;
        }
    };
    set(options.rim_temperature, &mut input.rim_temperature_k);
    set(options.start_temperature, &mut input.start_temperature_k);
    set(options.current, &mut input.current_a);
    set(options.threshold, &mut input.threshold);
    set(options.plateau, &mut input.plateau);
    set(options.time_tolerance, &mut input.time_tolerance);
    for (given, target) in [
        (&options.heat_times, &mut input.heat_times_s),
        (&options.current_times, &mut input.current_times_s),
        (&options.measure_at, &mut input.measure_at),
    ] {
        if let Some(given) = given {
            target.clone_from(given);
        }
    }
    if let Some(electrode) = options.electrode {
        input.electrode = match electrode {
            ElectrodeChoice::Equipotential => Electrode::Equipotential,
            ElectrodeChoice::Uniform => Electrode::Uniform,
        };
    }
    if let Some(of) = options.threshold_of {
        input.threshold_of = match of {
            ThresholdChoice::Rise => ThresholdOf::Rise,
            ThresholdChoice::Value => ThresholdOf::Value,
        };
    }
    input
}

fn problems(options: &ConductOptions) -> Vec<Problem> {
    match options.flow {
        Flow::Heat => vec![Problem::Heat],
        Flow::Current => vec![Problem::Current],
        Flow::Both => vec![Problem::Heat, Problem::Current],
    }
}

fn models(options: &ConductOptions) -> Vec<Model> {
    match options.model {
        ConductModel::Voxel => vec![Model::Voxel],
        ConductModel::Graded => vec![Model::Graded],
        ConductModel::Both => vec![Model::Voxel, Model::Graded],
    }
}

fn shapes(options: &ConductOptions) -> Vec<Shape> {
    match options.shape {
        ConductShape::Flat => vec![Shape::Flat],
        ConductShape::Morphed => vec![Shape::Morphed],
        ConductShape::Both => vec![Shape::Flat, Shape::Morphed],
    }
}

fn report(answer: &Answer, console: &Console) {
    let unit = match answer.problem {
        Problem::Heat => "W/(m K)",
        Problem::Current => "S/m",
    };
    console.say(format!("case      {}, {} bricks", stem(answer).replace('_', " "), answer.bricks));
    if let Some(steady) = &answer.steady {
        let flow = match answer.problem {
            Problem::Heat => format!("{} W under {} K", figures(steady.flow), figures(steady.difference)),
            Problem::Current => format!("{} V under {} A", figures(steady.difference), figures(steady.flow)),
        };
        console.say(format!(
            "steady    {flow}: {} {unit}, between {} in series and {} in parallel",
            figures(steady.effective_conductivity),
            figures(steady.series_bound),
            figures(steady.parallel_bound)
        ));
        console.detail(format!(
            "          {} iterations on {} levels; flows through cross-sections differ by {:.1e}; contrast {:.1e}",
            steady.iterations, steady.levels, steady.imbalance, steady.contrast
        ));
    }
    if let Some(transient) = &answer.transient {
        let critical = transient.critical_times_s.last().copied().flatten();
        let by_time = transient.effective_conductivities.last().copied().flatten();
        let of = |v: Option<f64>, unit: &str| v.map_or_else(|| "-".to_owned(), |v| format!("{} {unit}", figures(v)));
        console.say(format!("transient critical time {}: {}", of(critical, "s"), of(by_time, unit)));
        let effort = &transient.effort;
        console.detail(format!("          {} steps, {} iterations", effort.steps, effort.iterations));
    }
}
