//! Finite-element decks for ABAQUS and CalculiX.
//!
//! A deck is a table of contents over one writer a keyword group (`keywords/`): heading, nodes, elements, sets, sections,
//! materials, amplitudes, initial conditions, constraints, step, boundary conditions, output. It is streamed through a sink
//! that renders long blocks in parallel and holds only a few megabytes of them; the same pass over a counting sink estimates
//! its size. ABAQUS decks come as parts, instances and an assembly or flat, CalculiX decks flat.
//!
//! Units are mm, N, MPa, tonne, s, K. Solids are one strip along x, its rim at `x = 0`, its mid-plane at `z = 0`; shells are
//! the whole flower, hub at the origin, spoke 1 along +x, z up.

mod conduction;
mod graded_shell;
mod graded_solid;
mod graded_solid_indentation;
pub(crate) mod keywords;
mod layout;
mod nastran;
pub(crate) mod number;
mod pressing;
pub(crate) mod schedule;
mod shell;
mod shell_press;
mod sink;
pub(crate) mod solid;
pub mod unit_cell;
mod voxel_shell;
mod voxel_solid;

use std::io::{self, Write};

use crate::design::Design;
use crate::input::IndentationInput;
use crate::input::model::{DeckKind, DeckSolver};
use crate::output::Provenance;
use crate::progress::{Cancelled, Progress, never};
use conduction::{Carrier, Conduction};
use graded_solid_indentation::GradedSolidIndentation;
use sink::Sink;

/// A deck that can be written, and how large it will be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DeckPlan {
    /// What it models.
    pub kind: DeckKind,
    /// The solver it is for.
    pub solver: DeckSolver,
    /// Number of nodes, reference nodes included.
    pub nodes: u64,
    /// Number of elements.
    pub elements: u64,
    /// Estimated size, bytes; within a few percent.
    pub bytes: u64,
}

impl DeckPlan {
    /// Where the deck goes in the design's folder.
    #[must_use]
    pub fn relative_path(&self) -> String {
        let (folder, ending) = self.solver.folder_and_ending();
        format!("{folder}/{}.{ending}", self.kind.name())
    }
}

/// Why a deck was not written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum DeckError {
    /// The writer failed.
    #[error(transparent)]
    Io(#[from] io::Error),
    /// [`Progress`] asked to stop.
    #[error("cancelled")]
    Cancelled,
    /// [`plan`] does not offer this deck for this design.
    #[error("{path} does not exist for this design: {reason}")]
    NotOffered {
        /// Where the deck would go.
        path: String,
        /// Why not.
        reason: &'static str,
    },
}

/// The decks that a design asks for and that make sense for it: shells for ABAQUS only, flowers for domes only.
#[must_use]
pub fn plan(design: &Design) -> Vec<DeckPlan> {
    // Counting fails only where it is cancelled.
    plan_unless(design, &never).unwrap_or_default()
}

/// As [`plan`], but gives up once `cancelled` says so: sampling the sizes of millions of elements takes a while.
///
/// # Errors
/// [`DeckError::Cancelled`].
pub fn plan_unless(design: &Design, cancelled: Cancelled<'_>) -> Result<Vec<DeckPlan>, DeckError> {
    offered(design).into_iter().map(|(kind, solver)| plan_one(design, kind, solver, cancelled)).collect()
}

/// Kinds and solvers of the decks that a design asks for and that make sense for it, each once.
pub(crate) fn offered(design: &Design) -> Vec<(DeckKind, DeckSolver)> {
    let decks = &design.input().decks;
    let mut found: Vec<(DeckKind, DeckSolver)> = Vec::new();
    for solver in &decks.solvers {
        for kind in &decks.write {
            let pair = (*kind, *solver);
            if !found.contains(&pair) && prepare(design, *kind, *solver).is_ok() {
                found.push(pair);
            }
        }
    }
    found
}

/// Decks under load that a design asks for and that none of its solvers gets, with the reason.
pub(crate) fn refused_indentations(design: &Design) -> impl Iterator<Item = (DeckKind, &'static str)> {
    let decks = &design.input().decks;
    decks.write.iter().filter(|kind| kind.is_indentation()).filter_map(|kind| {
        let mut reasons = decks.solvers.iter().map(|solver| prepare(design, *kind, *solver).err());
        let first = reasons.next().flatten()?;
        reasons.all(|reason| reason.is_some()).then_some((*kind, first))
    })
}

fn plan_one(
    design: &Design,
    kind: DeckKind,
    solver: DeckSolver,
    cancelled: Cancelled<'_>,
) -> Result<DeckPlan, DeckError> {
    let input = design.input();
    // A hash has one length, so a stand-in gives the size.
    let provenance = Provenance {
        version: env!("CARGO_PKG_VERSION").to_owned(),
        seed: input.voxels.seed,
        design_sha256: "0".repeat(64),
    };
    let mut plan = DeckPlan { kind, solver, nodes: 0, elements: 0, bytes: 0 };
    let deck =
        prepare(design, kind, solver).map_err(|reason| DeckError::NotOffered { path: plan.relative_path(), reason })?;
    let mut sink = Sink::counting(cancelled);
    deck.write(&provenance, &mut sink)?;
    (plan.nodes, plan.elements, plan.bytes) = (deck.nodes(), deck.elements(), sink.written());
    Ok(plan)
}

/// Writes a deck, streaming. `progress` is told the bytes written so far.
///
/// # Errors
/// [`DeckError::Io`] where `out` fails, [`DeckError::Cancelled`] where `progress` says so, [`DeckError::NotOffered`] for a
/// plan of another design.
pub fn write(
    design: &Design,
    plan: &DeckPlan,
    provenance: &Provenance,
    out: &mut dyn Write,
    progress: Progress<'_>,
) -> Result<(), DeckError> {
    let deck = prepare(design, plan.kind, plan.solver)
        .map_err(|reason| DeckError::NotOffered { path: plan.relative_path(), reason })?;
    let mut sink = Sink::new(out, progress);
    deck.write(provenance, &mut sink)?;
    sink.finish()
}

/// Writes the CalculiX deck of one spoke under load with parameters that need not be the design's own.
///
/// # Errors
/// As [`write()`].
pub fn write_pressed_solid(
    design: &Design,
    input: &IndentationInput,
    provenance: &Provenance,
    out: &mut dyn Write,
    progress: Progress<'_>,
) -> Result<(), DeckError> {
    let refuse = |reason| DeckError::NotOffered { path: DeckKind::GradedSolidIndentation.name().to_owned(), reason };
    let deck = GradedSolidIndentation::new(design, input.clone()).map_err(refuse)?;
    let mut sink = Sink::new(out, progress);
    deck.write(provenance, &mut sink)?;
    sink.finish()
}

/// Undeformed nodes of the set `MIDLINE` of a deck of one spoke, `[x, y, z]` in mm, in the set's order; `x` is the arc
/// length. They are level unless the deck has an imperfection.
///
/// # Errors
/// [`DeckError::NotOffered`] for a deck that [`plan`] does not offer or that has no single mid-line.
pub fn midline(design: &Design, kind: DeckKind, solver: DeckSolver) -> Result<Vec<[f64; 3]>, DeckError> {
    let plan = DeckPlan { kind, solver, nodes: 0, elements: 0, bytes: 0 };
    let refuse = |reason| DeckError::NotOffered { path: plan.relative_path(), reason };
    let deck = prepare(design, kind, solver).map_err(refuse)?;
    deck.midline().ok_or_else(|| refuse("it models all spokes"))
}

/// A kind of deck, prepared for one design.
trait Deck {
    /// Number of nodes, reference nodes included.
    fn nodes(&self) -> u64;
    /// Number of elements.
    fn elements(&self) -> u64;
    /// Nodes of the mid-line, where there is a single one.
    fn midline(&self) -> Option<Vec<[f64; 3]>> {
        None
    }
    /// Writes it: the table of contents.
    fn write(&self, provenance: &Provenance, sink: &mut Sink<'_>) -> Result<(), DeckError>;
}

/// The deck of a kind, or why there is none.
fn prepare<'a>(design: &'a Design, kind: DeckKind, solver: DeckSolver) -> Result<Box<dyn Deck + 'a>, &'static str> {
    match (kind, solver) {
        (DeckKind::GradedSolid, DeckSolver::Nastran) => Ok(Box::new(nastran::NastranMesh::graded(design))),
        (DeckKind::VoxelSolid, DeckSolver::Nastran) => Ok(Box::new(nastran::NastranMesh::voxels(design))),
        (_, DeckSolver::Nastran) => Err("only the meshes of the solids are written as NASTRAN bulk data"),
        (DeckKind::GradedSolid, _) => Ok(Box::new(graded_solid::GradedSolid::new(design, solver))),
        (DeckKind::VoxelSolid, _) => Ok(Box::new(voxel_solid::VoxelSolid::new(design, solver))),
        (DeckKind::VoxelHeat, _) => Ok(Box::new(Conduction::voxels(design, solver, Carrier::Heat)?)),
        (DeckKind::GradedHeat, _) => Ok(Box::new(Conduction::graded(design, solver, Carrier::Heat)?)),
        (DeckKind::VoxelCurrent, _) => Ok(Box::new(Conduction::voxels(design, solver, Carrier::Current)?)),
        (DeckKind::GradedCurrent, _) => Ok(Box::new(Conduction::graded(design, solver, Carrier::Current)?)),
        (DeckKind::GradedSolidIndentation, DeckSolver::Calculix) => {
            Ok(Box::new(GradedSolidIndentation::new(design, pressing::parameters(design))?))
        }
        (DeckKind::GradedSolidIndentation, _) => Err("in ABAQUS the whole flower is pressed, as shells"),
        (_, DeckSolver::Calculix) => Err("its shells diverge in large rotations"),
        (_, _) if design.input().is_strip() => Err("a rectangular strip is no flower"),
        (DeckKind::GradedShell, DeckSolver::Abaqus) => Ok(Box::new(graded_shell::GradedShell::new(design))),
        (DeckKind::GradedShellIndentation, DeckSolver::Abaqus) => {
            Ok(Box::new(graded_shell::GradedShell::pressed(design)?))
        }
        (DeckKind::VoxelShellIndentation, DeckSolver::Abaqus) => {
            Ok(Box::new(voxel_shell::VoxelShell::pressed(design)?))
        }
        (DeckKind::VoxelShell, DeckSolver::Abaqus) => Ok(Box::new(voxel_shell::VoxelShell::new(design))),
    }
}
