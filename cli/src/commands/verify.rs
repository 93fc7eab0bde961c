//! `voxelastica verify`.

use std::path::Path;

use voxelastica_core::output::folder::Staging;
use voxelastica_core::output::json;
use voxelastica_core::report::{VerificationPicture, verification_svg};
use voxelastica_core::results::verification::Model;
use voxelastica_core::results::{Verification, compare, verify};
use voxelastica_core::solver::ccx::{Ccx, Status};
use voxelastica_core::{Design, Error};

use super::designed;
use crate::args::{ModelChoice, SolverChoice, VerifyOptions};
use crate::console::Console;

/// Exit code where `--target-error` is missed.
const MISSED: u8 = 6;

/// Solves a deck of a design and says how far the result is from the target.
pub fn run(options: &VerifyOptions, console: &Console) -> Result<u8, Error> {
    let SolverChoice::Ccx = options.solver;
    let design = designed(&options.folder)?;
    let mut ccx = Ccx { executable: options.ccx.clone(), ..Ccx::default() };
    if let Some(threads) = options.threads {
        ccx.threads = usize::from(threads);
    }
    let model = match options.model {
        ModelChoice::Graded => Model::Graded,
        ModelChoice::Voxel => Model::Voxel,
    };
    let verification = solve(&design, options, model, &ccx, console)?;
    write(&design, &options.folder, &verification)?;
    console.say(format!(
        "solved    {} in {:.1} s with {} {}: {} increments, {} iterations",
        model.deck(),
        verification.seconds,
        verification.solver.name,
        verification.solver.version,
        verification.increments,
        verification.iterations
    ));
    console.say(format!(
        "error     {:.3} % of the length at most, {:.3} % rms; as a shape {:.3} %",
        verification.max_error_percent, verification.rms_error_percent, verification.max_shape_error_percent
    ));
    if let Some(predicted) = verification.predicted_error_percent {
        console.detail(format!("predicted {predicted:.3} % by the elastica"));
    }
    console.say(format!("written   {}", options.folder.join("verification.json").display()));
    match options.target_error {
        Some(limit) if verification.max_error_percent > limit => {
            eprintln!(
                "error: {}: the error of {:.3} % exceeds --target-error {limit} %",
                design.input().name,
                verification.max_error_percent
            );
            Ok(MISSED)
        }
        _ => Ok(0),
    }
}

fn solve(
    design: &Design,
    options: &VerifyOptions,
    model: Model,
    ccx: &Ccx,
    console: &Console,
) -> Result<Verification, Error> {
    let temporary = tempfile::tempdir().map_err(|e| Error::output(std::env::temp_dir(), &e))?;
    let work = match &options.keep {
        Some(folder) => {
            std::fs::create_dir_all(folder).map_err(|e| Error::output(folder, &e))?;
            folder.as_path()
        }
        None => temporary.path(),
    };
    let bar = console.bar(1000, "{msg} [{wide_bar}] {percent} % {elapsed}", "solving");
    let progress = |status: Status| {
        bar.set_position((1000.0 * status.share) as u64);
        !console.is_cancelled()
    };
    let result = verify(design, &options.folder, model, ccx, work, &progress);
    bar.finish_and_clear();
    result
}

fn write(design: &Design, folder: &Path, verification: &Verification) -> Result<(), Error> {
    let profile = design.profile();
    let points = |x: &[f64], z: &[f64]| x.iter().zip(z).map(|(x, z)| [*x, *z]).collect::<Vec<[f64; 2]>>();
    let picture = VerificationPicture {
        name: design.input().name.clone(),
        target: points(&profile.x, &profile.z),
        prediction: match verification.model {
            Model::Voxel => design.voxel_path(),
            Model::Graded => design.graded_path().ok().flatten(),
        }
        .map(|p| points(&p.final_shape().x, &p.final_shape().z)),
        solver: verification.midline_mm.iter().map(|[_, x, z]| [*x, *z]).collect(),
        solver_name: format!("{} {}", verification.solver.name, verification.solver.version),
        max_error_percent: verification.max_error_percent,
        rms_error_percent: verification.rms_error_percent,
        length_mm: design.input().strips.length_mm,
        error_along: compare(profile, &verification.midline_mm).map(|c| {
            let length = design.input().strips.length_mm;
            verification.midline_mm.iter().zip(&c.distances_mm).map(|(p, d)| [p[0], 100.0 * d / length]).collect()
        }),
    };
    let text = json::to_text(verification).map_err(|e| Error::Internal(format!("verification.json: {e}")))?;
    let mut staging = Staging::new(folder)?;
    staging.write_text("verification.svg", &verification_svg(&picture))?;
    staging.write_text("verification.json", &text)?;
    staging.commit()
}
