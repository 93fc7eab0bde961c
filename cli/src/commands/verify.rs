//! `voxelastica verify`.

use voxelastica_core::output::folder::Staging;
use voxelastica_core::output::json;
use voxelastica_core::report::{VerificationPicture, verification_svg};
use voxelastica_core::results::verification::Model;
use voxelastica_core::results::{
    EmbeddedOptions, EmbeddedVerification, Verification, compare, verify, verify_embedded,
};
use voxelastica_core::solver::ccx::{Ccx, Status};
use voxelastica_core::{Design, Error};

use super::work_folder::WorkFolder;
use super::{MISSED, designed, require_unchanged};
use crate::args::{ModelChoice, SolverChoice, VerifyOptions};
use crate::console::Console;

/// What was solved, and by what.
enum Solved {
    /// CalculiX read a deck.
    Deck(Box<Verification>),
    /// The finite elements inside solved the design itself.
    Inside(Box<EmbeddedVerification>),
}

impl Solved {
    fn verification(&self) -> &Verification {
        match self {
            Self::Deck(verification) => verification,
            Self::Inside(solved) => &solved.verification,
        }
    }
}

/// Solves a strip of a design and says how far the result is from the target.
pub fn run(options: &VerifyOptions, console: &Console) -> Result<u8, Error> {
    let path = options.folder.join("design.json");
    let design = designed(&options.folder, console)?;
    require_unchanged(&design, &path)?;
    let model = match options.model {
        ModelChoice::Graded => Model::Graded,
        ModelChoice::Voxel => Model::Voxel,
    };
    let solved = match options.solver {
        SolverChoice::Embedded => inside(&design, options, model, console)
            .map(|solved| Solved::Inside(Box::new(solved)))
            .map_err(|error| error.in_file(&path.display().to_string())),
        SolverChoice::Ccx => deck(&design, options, model, console).map(|solved| Solved::Deck(Box::new(solved))),
    }?;
    write(&design, options, &solved)?;
    tell(options, &solved, console);
    let verification = solved.verification();
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

fn tell(options: &VerifyOptions, solved: &Solved, console: &Console) {
    let verification = solved.verification();
    match &verification.embedded {
        Some(record) => console.say(format!(
            "solved    {} elements, {} unknowns in {:.1} s: {} iterations in {} step{}",
            record.elements,
            record.unknowns,
            verification.seconds,
            verification.iterations,
            verification.increments,
            if verification.increments == 1 { "" } else { "s" }
        )),
        None => console.say(format!(
            "solved    {} in {:.1} s with {} {}: {} increments, {} iterations",
            verification.model.deck(),
            verification.seconds,
            verification.solver.name,
            verification.solver.version,
            verification.increments,
            verification.iterations
        )),
    }
    console.say(format!(
        "error     {:.3} % of the length at most, {:.3} % rms; as a shape {:.3} %",
        verification.max_error_percent, verification.rms_error_percent, verification.max_shape_error_percent
    ));
    if let Some(predicted) = verification.predicted_error_percent {
        console.detail(format!("predicted {predicted:.3} % by the elastica"));
    }
    if let Some(record) = &verification.embedded {
        let reactions = record.reactions;
        console.say(format!(
            "forces    H = {:.4} N, V = {:.4} N a spoke; {:.4} N mm at the rim, {:.4} N mm at the hub",
            reactions.rim_horizontal_n, reactions.hub_vertical_n, reactions.rim_moment_nmm, reactions.hub_moment_nmm
        ));
        let strains: Vec<String> = record
            .largest_principal_strain
            .iter()
            .filter_map(|(phase, strain)| Some(format!("{:.2} % in {phase}", 100.0 * strain.as_f64()?)))
            .collect();
        console.say(format!("strain    at most {}", strains.join(", ")));
        for warning in &record.warnings {
            console.warn(warning);
        }
    }
    console.say(format!("written   {}", options.folder.join("verification.json").display()));
}

/// Solves with the finite elements inside.
fn inside(
    design: &Design,
    options: &VerifyOptions,
    model: Model,
    console: &Console,
) -> Result<EmbeddedVerification, Error> {
    let mut how = EmbeddedOptions {
        model,
        elements_per_voxel_edge: usize::from(options.elements_per_voxel_edge),
        threads: options.threads.map(usize::from),
        ..EmbeddedOptions::default()
    };
    if options.yes {
        how.morph.memory_limit = Some(u64::MAX);
    }
    let bar = console.bar(1000, "{msg} [{wide_bar}] {percent} % {elapsed}", "solving");
    let progress = |share: f64| {
        bar.set_position((1000.0 * share) as u64);
        !console.is_cancelled()
    };
    let result = verify_embedded(design, &how, &progress);
    bar.finish_and_clear();
    result
}

/// Solves the deck in the folder with CalculiX.
fn deck(design: &Design, options: &VerifyOptions, model: Model, console: &Console) -> Result<Verification, Error> {
    let mut ccx = Ccx { executable: options.ccx.clone(), ..Ccx::default() };
    if let Some(threads) = options.threads {
        ccx.threads = usize::from(threads);
    }
    let work = WorkFolder::new(options.keep.as_deref())?;
    let bar = console.bar(1000, "{msg} [{wide_bar}] {percent} % {elapsed}", "solving");
    let progress = |status: Status| {
        bar.set_position((1000.0 * status.share) as u64);
        !console.is_cancelled()
    };
    let result = verify(design, &options.folder, model, &ccx, work.path(), &progress);
    bar.finish_and_clear();
    result
}

fn write(design: &Design, options: &VerifyOptions, solved: &Solved) -> Result<(), Error> {
    let (profile, verification) = (design.profile(), solved.verification());
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
        solver_name: match solved {
            Solved::Deck(_) => format!("{} {}", verification.solver.name, verification.solver.version),
            Solved::Inside(_) => "finite elements".to_owned(),
        },
        max_error_percent: verification.max_error_percent,
        rms_error_percent: verification.rms_error_percent,
        length_mm: design.input().strips.length_mm,
        error_along: compare(profile, &verification.midline_mm).map(|c| {
            let length = design.input().strips.length_mm;
            verification.midline_mm.iter().zip(&c.distances_mm).map(|(p, d)| [p[0], 100.0 * d / length]).collect()
        }),
        cloud: Vec::new(),
    };
    let text = json::to_text(verification).map_err(|e| Error::Internal(format!("verification.json: {e}")))?;
    let mut staging = Staging::new(&options.folder)?;
    staging.write_text("verification.svg", &verification_svg(&picture))?;
    if let Solved::Inside(solved) = solved {
        staging.write("verification.vtu", |out| solved.write_vtu(out))?;
    }
    staging.write_text("verification.json", &text)?;
    staging.commit()
}
