//! One point: its design, what the model finds, and how that is kept.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::Sweep;
use super::outputs::SweepModel;
use crate::conduction::case::{Problem, Regimes, solve};
use crate::conduction::pcg::Watch;
use crate::conduction::strip::{Model as Strips, Shape, Strip};
use crate::design::{Design, Limits};
use crate::error::Error;
use crate::indentation::{Indentation, elastica, smooth_volume};
use crate::input::DesignInput;
use crate::input::model::{DeckKind, DeckSolver};
use crate::output::write::{OutputKind, WriteOptions, write_outputs};
use crate::progress::{Cancelled, ignore};
use crate::results::verification::{Model, verify};
use crate::results::{EmbeddedOptions, verify_embedded};
use crate::solver::ccx::Ccx;

/// What became of a point.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "status", rename_all = "lowercase")]
pub enum Outcome {
    /// Its figures.
    Ok {
        /// By name; a figure that it does not have is absent.
        outputs: BTreeMap<String, f64>,
    },
    /// Mechanics, the materials or its values rule the design out.
    Infeasible {
        /// Why.
        reason: String,
    },
    /// A solver failed.
    Failed {
        /// How.
        reason: String,
    },
}

/// Figures that need no more than the rigidity's depths.
const RIGIDITY_ONLY: [&str; 2] = ["tangent_n_mm", "rigidity_n_mm"];
/// Figures that need the whole curve.
const WHOLE_CURVE: [&str; 5] = ["force_n", "work_nmm", "specific_energy_nmm_mm3", "bending_strain", "contact_depth_mm"];

/// Computes a point. Infeasible designs and failing solvers are outcomes, not errors.
///
/// # Errors
/// [`Error::Cancelled`], and what is no fault of the point: [`Error::Output`], [`Error::Internal`].
pub fn compute(sweep: &Sweep, point: u64, ccx: &Ccx, cancelled: Cancelled<'_>) -> Result<Outcome, Error> {
    let found =
        sweep.design_input(point).map_err(Error::Input).and_then(|input| figures(sweep, &input, ccx, cancelled));
    match found {
        Ok(outputs) => Ok(Outcome::Ok { outputs }),
        Err(Error::Input(error)) => Ok(Outcome::Infeasible { reason: one_line(&error.to_string(), point) }),
        Err(error @ Error::Infeasible { .. }) => {
            let Error::Infeasible { reason, .. } = &error else { return Err(error) };
            Ok(Outcome::Infeasible { reason: one_line(&reason.to_string(), point) })
        }
        Err(Error::Solver(reason)) => Ok(Outcome::Failed { reason: one_line(&reason, point) }),
        Err(error) => Err(error),
    }
}

/// A reason on one line, without the point's own name.
fn one_line(text: &str, point: u64) -> String {
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    text.strip_prefix(&format!("point {point}: ")).map_or(text.clone(), str::to_owned)
}

fn figures(
    sweep: &Sweep,
    input: &DesignInput,
    ccx: &Ccx,
    cancelled: Cancelled<'_>,
) -> Result<BTreeMap<String, f64>, Error> {
    let design = Design::compute_unless(input, Limits::default(), cancelled)?;
    let wanted = &sweep.input.outputs;
    let mut all = of_design(&design);
    let share = |_: f64| !cancelled();
    match sweep.input.model {
        SweepModel::Design | SweepModel::External => {}
        SweepModel::Elastica => pressed(&design, wanted, &share, &mut all)?,
        SweepModel::Graded | SweepModel::Voxel => {
            let model = if sweep.input.model == SweepModel::Voxel { Model::Voxel } else { Model::Graded };
            let options = EmbeddedOptions { model, ..EmbeddedOptions::default() };
            let solved = verify_embedded(&design, &options, &share)?;
            let verification = &solved.verification;
            all.push(("max_error_percent", verification.max_error_percent));
            all.push(("rms_error_percent", verification.rms_error_percent));
            if let Some(record) = &verification.embedded {
                let strains = record.largest_principal_strain.values().filter_map(serde_json::Value::as_f64);
                all.push(("rim_horizontal_n", record.reactions.rim_horizontal_n));
                all.push(("rim_moment_nmm", record.reactions.rim_moment_nmm));
                all.push(("largest_strain", strains.fold(0.0, f64::max)));
                all.push(("unstable", f64::from(u8::from(record.unstable_branch))));
            }
        }
        SweepModel::Ccx => by_calculix(&design, ccx, cancelled, &mut all)?,
        SweepModel::Conduct => conducted(&design, wanted, cancelled, &mut all)?,
    }
    let kept = all.into_iter().filter(|(name, value)| value.is_finite() && wanted.iter().any(|w| w == name));
    Ok(kept.map(|(name, value)| (name.to_owned(), value)).collect())
}

fn of_design(design: &Design) -> Vec<(&'static str, f64)> {
    let (profile, forces) = (design.profile(), design.forces());
    let last = profile.s.len() - 1;
    let counts = design.grid().counts(design.phases().phases().len());
    let voxels = counts.iter().sum::<u64>();
    let [volume, modulus] = smooth_volume(design);
    vec![
        ("contrast", design.contrast()),
        ("peak_modulus_mpa", design.peak_modulus()),
        ("mean_modulus_mpa", modulus),
        ("compression", 1.0 - profile.x[last] / design.input().strips.length_mm),
        ("height_mm", profile.z[last]),
        ("rim_radius_mm", profile.rho[0]),
        ("horizontal_n", forces.horizontal),
        ("vertical_n", forces.vertical),
        ("volume_mm3", volume),
        ("voxels", voxels as f64),
        ("rigid_share", counts.last().map_or(0.0, |n| *n as f64 / voxels.max(1) as f64)),
        ("predicted_error_percent", design.predicted_error().map_or(f64::NAN, |e| 100.0 * e)),
    ]
}

fn pressed(
    design: &Design,
    wanted: &[String],
    share: crate::progress::Share<'_>,
    all: &mut Vec<(&'static str, f64)>,
) -> Result<(), Error> {
    let wants = |names: &[&str]| wanted.iter().any(|w| names.contains(&w.as_str()));
    let input = design.input().indentation.clone().unwrap_or_default();
    let found: Indentation = if wants(&WHOLE_CURVE) {
        elastica::indent(design, &input, share)?
    } else if wants(&RIGIDITY_ONLY) {
        elastica::indent_for_rigidity(design, &input, share)?
    } else {
        return Ok(());
    };
    let first = found.curve.iter().find(|p| p.contact_force_n > 0.0);
    all.extend([
        ("tangent_n_mm", found.tangent_n_mm),
        ("rigidity_n_mm", found.rigidity_n_mm),
        ("force_n", found.curve.last().map_or(f64::NAN, |p| p.force_n)),
        ("work_nmm", found.work_nmm),
        ("specific_energy_nmm_mm3", found.specific_energy_nmm_mm3),
        ("bending_strain", found.largest_strain.iter().fold(0.0, |m, s| s.strain.max(m))),
        ("contact_depth_mm", first.map_or(f64::NAN, |p| p.depth_mm)),
    ]);
    Ok(())
}

fn by_calculix(
    design: &Design,
    ccx: &Ccx,
    cancelled: Cancelled<'_>,
    all: &mut Vec<(&'static str, f64)>,
) -> Result<(), Error> {
    let mut input = design.input().clone();
    input.decks.write = vec![DeckKind::VoxelSolid];
    input.decks.solvers = vec![DeckSolver::Calculix];
    let design = Design::compute_unless(&input, Limits::default(), cancelled)?;
    let folder = tempfile::tempdir().map_err(|e| Error::output(std::env::temp_dir(), &e))?;
    let kinds = [OutputKind::Deck(DeckKind::VoxelSolid)];
    write_outputs(&design, folder.path(), &kinds, WriteOptions::default(), &|_| {}, &ignore)?;
    let work = folder.path().join("work");
    let found = verify(&design, folder.path(), Model::Voxel, ccx, &work, &|_| !cancelled())?;
    all.push(("max_error_percent", found.max_error_percent));
    all.push(("rms_error_percent", found.rms_error_percent));
    Ok(())
}

fn conducted(
    design: &Design,
    wanted: &[String],
    cancelled: Cancelled<'_>,
    all: &mut Vec<(&'static str, f64)>,
) -> Result<(), Error> {
    let input = design.input().conduction.clone().unwrap_or_default();
    let going = |_: f64| !cancelled();
    let watch = Watch { progress: &going, ..Watch::silent() };
    let strip = Strip::new_unless(design, Strips::Voxel, Shape::Flat, input.graded_elements, watch)?;
    let regimes = Regimes { steady: true, transient: false };
    for (name, problem) in [("conductivity_w_mk", Problem::Heat), ("electrical_conductivity_s_m", Problem::Current)] {
        if !wanted.iter().any(|w| w == name) {
            continue;
        }
        let answer = solve(&strip, problem, regimes, &input, watch)?;
        all.push((name, answer.steady.map_or(f64::NAN, |s| s.effective_conductivity)));
    }
    Ok(())
}
