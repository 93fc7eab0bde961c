//! The files of a pressed dome, in the folder `indentation` of its design: a table and a record a curve, and one picture of all.

use std::io::{self, Write};
use std::path::Path;

use serde::Serialize;
use serde_json::Value;

use super::{BandSource, Indentation};
use crate::design::Design;
use crate::error::Error;
use crate::input::IndentationInput;
use crate::output::folder::Staging;
use crate::output::tables::number;
use crate::output::{Provenance, json};
use crate::report::indentation::{IndentationCurve, IndentationPicture, indentation_svg};
use crate::report::number as rounded;

/// Name and version of the format of a record.
pub const SCHEMA: &str = "voxelastica/indentation/1";

/// Folder of all files.
pub const FOLDER: &str = "indentation";

/// Largest record that is read back for the picture, bytes.
const LARGEST_RECORD: u64 = 16 << 20;

#[derive(Serialize)]
struct Document<'a> {
    schema: &'static str,
    #[serde(flatten)]
    provenance: Provenance,
    name: &'a str,
    parameters: &'a IndentationInput,
    indenter_diameter_mm: Option<f64>,
    secant_0_005_l_n_mm: Option<f64>,
    #[serde(flatten)]
    indentation: &'a Indentation,
}

/// Beginning of a curve's file names.
#[must_use]
pub fn stem(indentation: &Indentation) -> String {
    format!("{}_{}", indentation.model.name(), indentation.indenter.name())
}

/// Writes the files of some curves into a design's folder; all of them appear together. The picture also shows the curves of
/// the same design that are there already. Returns their names.
///
/// # Errors
/// [`Error::Output`].
pub fn write(
    design: &Design,
    input: &IndentationInput,
    curves: &[Indentation],
    folder: &Path,
) -> Result<Vec<String>, Error> {
    let provenance = Provenance::of(design.input());
    let mut staging = Staging::new(folder)?;
    let mut files = Vec::new();
    for curve in curves {
        let name = format!("{FOLDER}/{}", stem(curve));
        let press = super::Press::new(design, &IndentationInput { indenter: curve.indenter, ..input.clone() })?;
        // A band that follows from the materials is no parameter.
        let given = curve.modulus_band_from == BandSource::ModulusBandPercent;
        let parameters =
            IndentationInput { modulus_band_percent: given.then_some(curve.modulus_band_percent), ..input.clone() };
        let document = Document {
            schema: SCHEMA,
            provenance: provenance.clone(),
            name: &design.input().name,
            parameters: &parameters,
            indenter_diameter_mm: press.radius_mm.map(|r| 2.0 * r),
            secant_0_005_l_n_mm: curve.secant(0.005 * design.input().strips.length_mm),
            indentation: curve,
        };
        let text = json::to_text(&document).map_err(|e| Error::Internal(format!("{name}.json: {e}")))?;
        staging.write_text(&format!("{name}.json"), &text)?;
        staging.write(&format!("{name}.csv"), |out| table(curve, out))?;
        files.extend([format!("{name}.json"), format!("{name}.csv")]);
    }
    let mut all: Vec<IndentationCurve> = curves.iter().map(drawn).collect();
    let written: Vec<String> = curves.iter().map(stem).collect();
    all.extend(earlier(&folder.join(FOLDER), &provenance, &written));
    let picture = IndentationPicture {
        title: format!("{}: one spoke under load", design.input().name),
        caption: vec![match curves.first() {
            Some(curve) => format!(
                "Force above that before pressing. Shaded: all moduli {} % lower and higher{}.",
                rounded(curve.modulus_band_percent, 3),
                if curve.modulus_band_from == BandSource::ModulusScatterPercent {
                    " (scatter of the phases)"
                } else {
                    ""
                }
            ),
            None => "Force above that before pressing.".to_owned(),
        }],
        curves: all,
    };
    let svg = indentation_svg(&picture).map_err(|e| Error::Internal(format!("the curves: {e}")))?;
    staging.write_text(&format!("{FOLDER}/curves.svg"), &svg)?;
    files.push(format!("{FOLDER}/curves.svg"));
    staging.commit()?;
    Ok(files)
}

fn table(curve: &Indentation, out: &mut dyn Write) -> io::Result<()> {
    let mut rows = csv::Writer::from_writer(out);
    rows.write_record([
        "depth_mm",
        "force_n",
        "force_low_n",
        "force_high_n",
        "contact_force_n",
        "contact_length_mm",
        "strain_energy_nmm",
        "largest_strain",
    ])?;
    let band = curve.modulus_band_percent / 100.0;
    for p in &curve.curve {
        let values = [
            p.depth_mm,
            p.force_n,
            p.force_n * (1.0 - band),
            p.force_n * (1.0 + band),
            p.contact_force_n,
            p.contact_length_mm,
            p.strain_energy_nmm,
            p.largest_strain,
        ];
        rows.write_record(values.map(number))?;
    }
    rows.flush()
}

fn drawn(curve: &Indentation) -> IndentationCurve {
    IndentationCurve {
        name: stem(curve).replace('_', ", "),
        points: curve.curve.iter().map(|p| [p.depth_mm, p.force_n]).collect(),
        band: curve.modulus_band_percent / 100.0,
    }
}

/// Curves of the same design that an earlier run left, in the order of their names.
fn earlier(folder: &Path, provenance: &Provenance, written: &[String]) -> Vec<IndentationCurve> {
    let Ok(entries) = std::fs::read_dir(folder) else { return Vec::new() };
    let mut paths: Vec<_> = entries.flatten().map(|e| e.path()).collect();
    paths.sort();
    paths
        .iter()
        .filter_map(|path| {
            let name = path.file_stem()?.to_str()?.to_owned();
            let is_record = path.extension().is_some_and(|e| e == "json") && !written.contains(&name);
            if !is_record || path.metadata().ok()?.len() > LARGEST_RECORD {
                return None;
            }
            let record: Value = serde_json::from_str(&std::fs::read_to_string(path).ok()?).ok()?;
            if record["design_sha256"].as_str()? != provenance.design_sha256 {
                return None;
            }
            let point = |p: &Value| Some([p["depth_mm"].as_f64()?, p["force_n"].as_f64()?]);
            Some(IndentationCurve {
                name: name.replace('_', ", "),
                points: record["curve"].as_array()?.iter().filter_map(point).collect(),
                band: record["modulus_band_percent"].as_f64().unwrap_or(0.0) / 100.0,
            })
        })
        .collect()
}
