//! Confirming a design with a solver.

use std::path::{Path, PathBuf};

use serde::Serialize;
use serde_json::{Map, Value};

use super::ccx_dat::{NodePrint, Quantity, parse};
use super::comparison::{MidlinePoint, compare};
use crate::design::Design;
use crate::elastica::morph::Guide;
use crate::error::Error;
use crate::input::model::{DeckKind, DeckSolver};
use crate::output::Provenance;
use crate::solver::ccx::{Ccx, Run, Status};

/// Which deck is solved.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Model {
    /// Smooth width, graded modulus.
    Graded,
    /// Every voxel its phase.
    Voxel,
}

impl Model {
    /// The deck, relative to the design's folder.
    #[must_use]
    pub fn deck(self) -> &'static str {
        match self {
            Self::Graded => "calculix/graded_solid.inp",
            Self::Voxel => "calculix/voxel_solid.inp",
        }
    }

    fn kind(self) -> DeckKind {
        match self {
            Self::Graded => DeckKind::GradedSolid,
            Self::Voxel => DeckKind::VoxelSolid,
        }
    }
}

/// Contents of `verification.json`.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Verification {
    /// Version, seed and hash of the design that was verified; a design computed anew has another hash.
    #[serde(flatten)]
    pub provenance: Provenance,
    /// Which model was solved.
    pub model: Model,
    /// The solver.
    pub solver: SolverRecord,
    /// Largest distance of the mid-line from the target at equal arc lengths, percent of the length.
    pub max_error_percent: f64,
    /// Root mean square of that distance.
    pub rms_error_percent: f64,
    /// Largest distance from the nearest point of the target.
    pub max_shape_error_percent: f64,
    /// Largest distance that the forward model predicts for the strip that was solved, percent of the length.
    pub predicted_error_percent: Option<f64>,
    /// Wall time of the solver, s.
    pub seconds: f64,
    /// Increments that converged.
    pub increments: usize,
    /// Iterations over all increments.
    pub iterations: usize,
    /// What only the solver inside the library tells.
    #[serde(flatten)]
    pub embedded: Option<EmbeddedRecord>,
    /// `[s, x, z]` of the deformed mid-line, rim first, seen from the rim.
    pub midline_mm: Vec<MidlinePoint>,
}

/// A solver by name and version.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct SolverRecord {
    /// Name.
    pub name: String,
    /// Version.
    pub version: String,
}

/// What the solver inside the library tells besides.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct EmbeddedRecord {
    /// Elements of the strip.
    pub elements: usize,
    /// Unknown displacements.
    pub unknowns: usize,
    /// Residual of the equilibrium, relative to the elements' forces.
    pub residual: f64,
    /// The strip would leave this equilibrium by itself.
    pub unstable_branch: bool,
    /// Negative eigenvalues of the tangent: directions in which it would.
    pub negative_eigenvalues: usize,
    /// What the ends of one spoke are held by.
    pub reactions: ReactionRecord,
    /// Largest principal strain of every phase, by its label; of a graded strip there is one of the mixture.
    pub largest_principal_strain: Map<String, Value>,
    /// What the user should know.
    pub warnings: Vec<String>,
}

/// Reactions of one spoke, in the signs of `summary.thrust` of `design.json`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ReactionRecord {
    /// Horizontal force at the rim, N.
    pub rim_horizontal_n: f64,
    /// Horizontal force at the hub, N; the same in equilibrium.
    pub hub_horizontal_n: f64,
    /// Vertical force at the rim, N.
    pub rim_vertical_n: f64,
    /// Vertical force at the hub, N.
    pub hub_vertical_n: f64,
    /// Moment at the rim, N mm.
    pub rim_moment_nmm: f64,
    /// Moment at the hub, N mm.
    pub hub_moment_nmm: f64,
}

/// Solves one of a design's decks with CalculiX in `work` and compares the deformed mid-line with the target.
///
/// # Errors
/// [`Error::Input`] for a deck that is missing or belongs to another design, [`Error::Solver`], [`Error::Cancelled`].
pub fn verify(
    design: &Design,
    folder: &Path,
    model: Model,
    ccx: &Ccx,
    work: &Path,
    progress: &dyn Fn(Status) -> bool,
) -> Result<Verification, Error> {
    let provenance = Provenance::of(design.input());
    require_shape(design).map_err(|e| e.in_file(&folder.join("design.json").display().to_string()))?;
    let deck = folder.join(model.deck());
    check_deck(&deck, &provenance)?;
    let run = ccx.run(&deck, work, progress)?;
    let midline = midline(design, model, &run, &deck)?;
    let comparison = compare(design.profile(), &midline)
        .ok_or_else(|| Error::Solver(format!("{}: the solver printed no mid-line", deck.display())))?;
    Ok(Verification {
        provenance,
        model,
        solver: SolverRecord { name: "CalculiX".to_owned(), version: run.version },
        max_error_percent: comparison.max_error_percent,
        rms_error_percent: comparison.rms_error_percent,
        max_shape_error_percent: comparison.max_shape_error_percent,
        predicted_error_percent: predicted(design, model).map(|e| 100.0 * e),
        seconds: run.seconds,
        increments: run.increments,
        iterations: run.iterations,
        embedded: None,
        midline_mm: midline,
    })
}

/// Refuses a design that takes no shape.
pub(super) fn require_shape(design: &Design) -> Result<&Guide, Error> {
    design.guide().ok_or_else(|| {
        let problem = "a strip that is only stretched takes no shape to verify";
        Error::Input(crate::InputError::new("target.shortening", "", problem))
    })
}

/// What the forward model predicts for a model's strip, as a share of the length.
pub(super) fn predicted(design: &Design, model: Model) -> Option<f64> {
    match model {
        Model::Voxel => design.predicted_error(),
        Model::Graded => {
            let shape = design.graded_path().ok()??.final_shape();
            Some(design.profile().largest_distance(shape) / design.input().strips.length_mm)
        }
    }
}

/// Refuses a deck that is missing or was written for another design.
fn check_deck(deck: &Path, provenance: &Provenance) -> Result<(), Error> {
    use std::io::Read;
    let wrong = |problem: &str, help: &str| {
        let error = crate::InputError::new("", "", problem).help(help).in_file(&deck.display().to_string());
        Err(Error::Input(error))
    };
    let mut start = Vec::new();
    match std::fs::File::open(deck).and_then(|file| file.take(8192).read_to_end(&mut start)) {
        Ok(_) => {}
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
            return wrong(
                "this deck is not there",
                "design with decks.solvers holding \"calculix\" and decks.write holding the model to verify",
            );
        }
        Err(error) => return wrong(&format!("this deck cannot be read: {error}"), ""),
    }
    if String::from_utf8_lossy(&start).contains(&provenance.design_sha256) {
        Ok(())
    } else {
        wrong("this deck belongs to another design than the design.json beside it", "run design again")
    }
}

/// The deformed mid-line at the end of the step, seen from the rim.
fn midline(design: &Design, model: Model, run: &Run, deck: &Path) -> Result<Vec<MidlinePoint>, Error> {
    let broken = |what: String| Error::Solver(format!("{}: {what}", deck.display()));
    let prints = parse(&run.dat).map_err(|e| broken(format!("the solver's result cannot be read: {e}")))?;
    let is_midline = |p: &&NodePrint| p.set == "MIDLINE" && p.quantity == Quantity::Displacement;
    let last = prints
        .iter()
        .filter(is_midline)
        .max_by(|a, b| a.time.total_cmp(&b.time))
        .ok_or_else(|| broken("the solver printed no displacements of MIDLINE".to_owned()))?;
    if last.time < 1.0 - 1e-6 {
        return Err(broken(format!("the last mid-line is that at {:.1} % of the step", 100.0 * last.time)));
    }
    let flat = crate::deck::midline(design, model.kind(), DeckSolver::Calculix)
        .map_err(|e| broken(format!("the deck's mid-line: {e}")))?;
    if flat.len() != last.rows.len() {
        return Err(broken(format!("the solver printed {} nodes of a mid-line of {}", last.rows.len(), flat.len())));
    }
    let Some(((rim, _), (_, pushed))) = flat.first().map(|p| (p[0], p[2])).zip(last.rows.first()) else {
        return Err(broken("the solver printed an empty mid-line".to_owned()));
    };
    let points: Vec<MidlinePoint> =
        flat.iter().zip(&last.rows).map(|([x, _, z], (_, u))| [*x, x + u[0] - (rim + pushed[0]), z + u[2]]).collect();
    match points.iter().flatten().find(|c| !c.is_finite()) {
        Some(value) => Err(broken(format!("the solver's mid-line holds {value}"))),
        None => Ok(points),
    }
}

/// Where a verification's picture and figures are written, relative to the design's folder.
#[must_use]
pub fn output_files(folder: &Path) -> (PathBuf, PathBuf) {
    (folder.join("verification.json"), folder.join("verification.svg"))
}
