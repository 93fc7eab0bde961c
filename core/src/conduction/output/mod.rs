//! The files of a conduction run: `conduct.json`, and tables, pictures and fields in `conduction/`.

mod figures;
mod tables;
pub mod vtu;

use std::path::Path;

use serde::Serialize;

use super::ashby::Ashby;
use super::case::{Answer, Problem};
use super::mesh::VOID;
use super::strip::{Model, Shape, Strip};
use crate::design::Design;
use crate::error::Error;
use crate::input::ConductionInput;
use crate::materials::Assumption;
use crate::output::folder::{Staging, free_bytes};
use crate::output::{Provenance, json};
use crate::report::ReportError;

/// Name and version of the format of `conduct.json`.
pub const SCHEMA: &str = "voxelastica/conduction/1";

/// Folder of all other files.
const FOLDER: &str = "conduction";

/// What a run computed.
#[derive(Debug, Clone, Copy)]
pub struct Results<'a> {
    /// The design.
    pub design: &'a Design,
    /// The parameters.
    pub input: &'a ConductionInput,
    /// Strips and the answers to their cases.
    pub cases: &'a [(&'a Strip, Answer)],
    /// Charts of modulus against conductivity.
    pub charts: &'a [Ashby],
}

/// What may be written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct WriteOptions {
    /// Fields for ParaView.
    pub vtu: bool,
    /// Write even where the estimate exceeds the free disk.
    pub allow_large: bool,
}

#[derive(Serialize)]
struct Document<'a> {
    schema: &'static str,
    #[serde(flatten)]
    provenance: Provenance,
    name: &'a str,
    parameters: &'a ConductionInput,
    /// Whether any figure rests on a value that nobody measured on these materials.
    rests_on_assumptions: bool,
    assumptions: Vec<Assumption>,
    cases: Vec<&'a Answer>,
    ashby: &'a [Ashby],
    files: Vec<String>,
}

/// Writes the files into a design's folder; all of them appear together. Returns their names.
///
/// # Errors
/// [`Error::Output`].
pub fn write(results: &Results<'_>, folder: &Path, options: WriteOptions) -> Result<Vec<String>, Error> {
    require_room(results, folder, options)?;
    let provenance = Provenance::of(results.design.input());
    let mut staging = Staging::new(folder)?;
    let mut files = Vec::new();
    let drawn = |e: ReportError| Error::Internal(format!("a picture of conduction: {e}"));
    if !results.cases.is_empty() {
        let name = format!("{FOLDER}/cases.csv");
        staging.write(&name, |out| tables::cases(results.cases, out))?;
        files.push(name);
    }
    for (strip, answer) in results.cases {
        let stem = format!("{FOLDER}/{}", stem(answer));
        let title = title(results.design, answer);
        if let Some(svg) = figures::fields(strip, answer, &title).map_err(drawn)? {
            staging.write_text(&format!("{stem}_fields.svg"), &svg)?;
            files.push(format!("{stem}_fields.svg"));
        }
        staging.write(&format!("{stem}_profile.csv"), |out| tables::profile(strip, answer, out))?;
        files.push(format!("{stem}_profile.csv"));
        if let Some(svg) = figures::history(results.input, answer, &title).map_err(drawn)? {
            staging.write_text(&format!("{stem}_history.svg"), &svg)?;
            staging.write(&format!("{stem}_history.csv"), |out| tables::history(answer, out))?;
            files.extend([format!("{stem}_history.svg"), format!("{stem}_history.csv")]);
        }
        if options.vtu {
            let name = format!("{stem}.vtu");
            staging.write(&name, |out| write_vtu(strip, answer, &provenance, out))?;
            files.push(name);
        }
    }
    for chart in results.charts {
        let stem = format!("{FOLDER}/ashby_{}", chart.quantity.split(' ').next().unwrap_or_default());
        let svg = figures::ashby(chart).map_err(drawn)?;
        staging.write_text(&format!("{stem}.svg"), &svg)?;
        staging.write(&format!("{stem}.csv"), |out| tables::ashby(chart, out))?;
        files.extend([format!("{stem}.svg"), format!("{stem}.csv")]);
    }
    let assumptions = assumptions(results.cases);
    let document = Document {
        schema: SCHEMA,
        provenance,
        name: &results.design.input().name,
        parameters: results.input,
        rests_on_assumptions: !assumptions.is_empty(),
        assumptions,
        cases: results.cases.iter().map(|(_, answer)| answer).collect(),
        ashby: results.charts,
        files: files.clone(),
    };
    let text = json::to_text(&document).map_err(|e| Error::Internal(format!("conduct.json: {e}")))?;
    staging.write_text("conduct.json", &text)?;
    files.push("conduct.json".to_owned());
    staging.commit()?;
    Ok(files)
}

/// All assumptions, each once.
fn assumptions(cases: &[(&Strip, Answer)]) -> Vec<Assumption> {
    let mut all: Vec<Assumption> = Vec::new();
    for assumption in cases.iter().flat_map(|(_, answer)| &answer.assumptions) {
        if !all.contains(assumption) {
            all.push(assumption.clone());
        }
    }
    all
}

/// Beginning of a case's file names.
#[must_use]
pub fn stem(answer: &Answer) -> String {
    let problem = match answer.problem {
        Problem::Heat => "heat",
        Problem::Current => "current",
    };
    let model = match answer.model {
        Model::Voxel => "voxel",
        Model::Graded => "graded",
    };
    let shape = match answer.shape {
        Shape::Flat => "flat",
        Shape::Morphed => "morphed",
    };
    format!("{problem}_{model}_{shape}")
}

fn title(design: &Design, answer: &Answer) -> String {
    let model = match answer.model {
        Model::Voxel => "voxels",
        Model::Graded => "graded strip",
    };
    let shape = match answer.shape {
        Shape::Flat => "flat",
        Shape::Morphed => "morphed",
    };
    format!("{}: {}, {model}, {shape}", design.input().name, answer.problem.field()[0])
}

fn write_vtu(
    strip: &Strip,
    answer: &Answer,
    provenance: &Provenance,
    out: &mut dyn std::io::Write,
) -> std::io::Result<()> {
    let [field, unit] = answer.problem.field();
    let mut comment = vec![provenance.line()];
    comment.extend(answer.assumptions.iter().map(Assumption::line));
    let named = |time: &f64| format!("{field}_{unit}_at_{time}_s");
    let names: Vec<String> = answer.transient.iter().flat_map(|t| t.field_times_s.iter().map(named)).collect();
    let steady_name = format!("{field}_{unit}_steady");
    let mut fields: Vec<vtu::NodeField<'_>> = Vec::new();
    if let Some(transient) = &answer.transient {
        let pairs = names.iter().zip(&transient.fields);
        fields.extend(pairs.map(|(name, values)| vtu::NodeField { name, values }));
    }
    if let Some(steady) = &answer.steady {
        fields.push(vtu::NodeField { name: &steady_name, values: &steady.field });
    }
    // Fraction of the stiffest phase: 0 or 1 in voxels.
    let rigid: Vec<f64> = strip.mixtures.iter().map(|mix| mix.last().copied().unwrap_or(0.0)).collect();
    vtu::write(out, &strip.mesh, &format!("\n{}\n", comment.join("\n")), &fields, ("rigid_fraction", &rigid))
}

/// Refuses to fill the disk.
fn require_room(results: &Results<'_>, folder: &Path, options: WriteOptions) -> Result<(), Error> {
    let bytes = |(strip, answer): &(&Strip, Answer)| {
        let cells = strip.mesh.materials().iter().filter(|m| **m != VOID).count() as u64;
        let fields = answer.transient.as_ref().map_or(0, |t| t.fields.len() as u64) + 1;
        let vtu = if options.vtu { strip.mesh.nodes() as u64 * 8 * (3 + fields) + cells * 49 } else { 0 };
        vtu * 4 / 3 + (8 << 20)
    };
    let needed: u64 = results.cases.iter().map(bytes).sum();
    match free_bytes(folder) {
        Some(free) if needed > free && !options.allow_large => Err(Error::Output {
            path: folder.to_owned(),
            problem: format!("about {} MB are to be written, but only {} MB are free", needed >> 20, free >> 20),
            help: "leave out the fields for ParaView (--no-vtu), or insist with --yes".to_owned(),
        }),
        _ => Ok(()),
    }
}
