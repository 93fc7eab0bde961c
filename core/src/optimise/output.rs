//! What an optimisation leaves behind: `optimum.toml`, `evaluations.csv` and `optimise.json`.

use std::io::{self, Write};
use std::path::Path;

use serde::Serialize;
use serde_json::{Map, Value};

use super::binding::LimitRecord;
use super::figures::{Figures, Outcome};
use super::input::OptimiseInput;
use super::record::Evaluation;
use super::{Optimisation, Optimum};
use crate::error::Error;
use crate::output::folder::Staging;
use crate::output::json;
use crate::output::tables::number;

/// Name and version of the record's format.
pub const SCHEMA: &str = "voxelastica/optimise/1";
/// Reasons that the record lists.
const MOST_REASONS: usize = 20;

#[derive(Serialize)]
struct Document<'a> {
    schema: &'static str,
    version: &'static str,
    input: &'a OptimiseInput,
    evaluations: usize,
    feasible: usize,
    best: Option<Best<'a>>,
    refusals: Vec<Refusal>,
}

#[derive(Serialize)]
struct Best<'a> {
    evaluation: usize,
    objective: f64,
    values: Map<String, Value>,
    figures: &'a Figures,
    limits: &'a [LimitRecord],
    at_ends: Map<String, Value>,
}

#[derive(Serialize)]
struct Refusal {
    reason: String,
    designs: usize,
}

/// Writes the files into a folder; all appear together. Returns their names. Without a design that keeps the limits there is no
/// `optimum.toml`.
///
/// # Errors
/// [`Error::Output`].
pub fn write(optimisation: &Optimisation, optimum: &Optimum, folder: &Path) -> Result<Vec<String>, Error> {
    let goal = optimisation.goal();
    let keys: Vec<&str> = optimisation.space().variables().iter().map(super::space::Variable::key).collect();
    let best = optimum.best.zip(optimum.best()).and_then(|(evaluation, best)| {
        let Outcome::Designed(figures) = &best.outcome else { return None };
        Some(Best {
            evaluation,
            objective: goal.objective.of(figures),
            values: keys.iter().map(|k| (*k).to_owned()).zip(best.values.iter().cloned()).collect(),
            figures,
            limits: &optimum.limits,
            at_ends: optimum.ends.iter().map(|(key, end)| (key.clone(), (*end).into())).collect(),
        })
    });
    let refusals = optimum.refusals(goal).into_iter().take(MOST_REASONS);
    let document = Document {
        schema: SCHEMA,
        version: env!("CARGO_PKG_VERSION"),
        input: optimisation.input(),
        evaluations: optimum.evaluations.len(),
        feasible: optimum.evaluations.iter().filter(|e| goal.achieved(&e.outcome).is_some()).count(),
        best,
        refusals: refusals.map(|(reason, designs)| Refusal { reason, designs }).collect(),
    };
    let internal = |what: &str, error: &dyn std::fmt::Display| Error::Internal(format!("{what}: {error}"));
    let mut staging = Staging::new(folder)?;
    let mut files = Vec::new();
    if let Some(best) = optimum.best() {
        let input = optimisation.design(&best.place)?;
        let table = toml::Value::try_from(&input).map_err(|e| internal("optimum.toml", &e))?;
        let text = toml::to_string(&table).map_err(|e| internal("optimum.toml", &e))?;
        staging.write_text("optimum.toml", &text)?;
        files.push("optimum.toml".to_owned());
    }
    staging.write("evaluations.csv", |out| table(optimisation, &keys, optimum, out))?;
    let text = json::to_text(&document).map_err(|e| internal("optimise.json", &e))?;
    staging.write_text("optimise.json", &text)?;
    staging.commit()?;
    files.extend(["evaluations.csv".to_owned(), "optimise.json".to_owned()]);
    Ok(files)
}

/// A column of the table: its name, and how it is taken from the figures.
type Column = (&'static str, fn(&Figures) -> f64);

/// Figures of the table.
const FIGURES: [Column; 8] = [
    ("rigidity_n_mm", |f| f.rigidity_n_mm),
    ("specific_energy_nmm_mm3", |f| f.specific_energy_nmm_mm3),
    ("printability", super::objective::printability),
    ("contrast_share", |f| f.contrast / f.contrast_reach),
    ("largest_strain", |f| f.largest_strain),
    ("hub_force_n", |f| f.hub_force_n),
    ("predicted_error_percent", |f| f.predicted_error_percent),
    ("narrowest_voxels", |f| f.narrowest_voxels),
];

fn table(optimisation: &Optimisation, keys: &[&str], optimum: &Optimum, out: &mut dyn Write) -> io::Result<()> {
    let mut rows = csv::Writer::from_writer(out);
    let names = FIGURES.iter().map(|(name, _)| *name);
    rows.write_record(["evaluation", "stage"].into_iter().chain(keys.iter().copied()).chain(names).chain(["refused"]))?;
    for (i, evaluation) in optimum.evaluations.iter().enumerate() {
        rows.write_record(row(optimisation, i, evaluation))?;
    }
    rows.flush()
}

fn row(optimisation: &Optimisation, i: usize, evaluation: &Evaluation) -> Vec<String> {
    let plain = |value: &Value| value.as_str().map_or_else(|| value.to_string(), str::to_owned);
    let figure = |pick: fn(&Figures) -> f64| match &evaluation.outcome {
        Outcome::Designed(figures) if pick(figures).is_finite() => number(pick(figures)),
        _ => String::new(),
    };
    let mut row = vec![i.to_string(), evaluation.stage.name().to_owned()];
    row.extend(evaluation.values.iter().map(plain));
    row.extend(FIGURES.iter().map(|(_, pick)| figure(*pick)));
    row.push(optimisation.goal().refusals(&evaluation.outcome).join("; "));
    row
}
