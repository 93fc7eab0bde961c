//! Steady conduction: `div(kappa grad u) = 0` with values given at some nodes and flux entering at others.

use std::sync::atomic::AtomicBool;

use super::components::{ASK_EVERY, Components, NONE};
use super::contrast;
use super::mesh::{BrickMesh, VOID};
use super::multigrid::Multigrid;
use super::operator::Operator;
use super::pcg::{self, Iterations, System, Tolerance, Watch, combine, latched};
use super::{ConductionError, memory};

/// Largest contrast of conductivities that is solved in one system.
pub const LARGEST_CONTRAST: f64 = 1e4;

/// Largest share by which the flux through cross-sections may differ.
const BALANCE: f64 = 1e-4;

/// What is prescribed at the nodes of a mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct Boundary {
    /// Nodes whose value is given.
    pub given: Vec<bool>,
    /// Their values; zero elsewhere.
    pub values: Vec<f64>,
    /// Flux that enters at the other nodes.
    pub loads: Vec<f64>,
}

impl Boundary {
    /// Nothing prescribed: insulated all around.
    #[must_use]
    pub fn insulated(mesh: &BrickMesh) -> Self {
        let n = mesh.nodes();
        Self { given: vec![false; n], values: vec![0.0; n], loads: vec![0.0; n] }
    }

    /// Gives all nodes of a plane across the strip one value.
    pub fn give_plane(&mut self, mesh: &BrickMesh, plane: usize, value: f64) {
        for node in plane_nodes(mesh, plane) {
            self.given[node] = true;
            self.values[node] = value;
        }
    }

    /// Lets a total flux enter evenly over the cross-section at the rim, void cells left out.
    pub fn load_rim(&mut self, mesh: &BrickMesh, total: f64) {
        let [_, layers, across] = mesh.cells();
        let solid = |k: usize, j: usize| mesh.materials()[k * across + j] != VOID;
        let cells: Vec<[usize; 3]> =
            (0..layers).flat_map(|k| (0..across).filter(move |j| solid(k, *j)).map(move |j| [0, k, j])).collect();
        let area = |cell: &[usize; 3]| {
            let p = mesh.cell_nodes(*cell).map(|n| {
                let [_, levels, wide] = mesh.node_counts();
                mesh.position([n / (levels * wide), n / wide % levels, n % wide])
            });
            // Face at the rim: nodes 0 to 3; area by its diagonals.
            let (a, b) = (difference(p[3], p[0]), difference(p[2], p[1]));
            0.5 * cross(a, b).iter().map(|c| c * c).sum::<f64>().sqrt()
        };
        let whole: f64 = cells.iter().map(area).sum();
        for cell in &cells {
            let share = total * area(cell) / whole / 4.0;
            for node in &mesh.cell_nodes(*cell)[..4] {
                self.loads[*node] += share;
            }
        }
    }
}

fn difference(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|i| a[i] - b[i])
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Nodes of a plane across the strip.
pub fn plane_nodes(mesh: &BrickMesh, plane: usize) -> std::ops::Range<usize> {
    let per_plane = (mesh.cells()[1] + 1) * (mesh.cells()[2] + 1);
    plane * per_plane..(plane + 1) * per_plane
}

/// How a steady problem is solved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SteadyOptions {
    /// When conjugate gradients stop: the error's energy norm relative to the solution's is about the square root of that of the
    /// conductance.
    pub tolerance: Tolerance,
    /// Memory that may be used, bytes; what the machine has free where `None`.
    pub memory: Option<u64>,
    /// Temperature or potential, for messages.
    pub quantity: &'static str,
}

impl Default for SteadyOptions {
    fn default() -> Self {
        Self { tolerance: Tolerance { relative: 1e-9, iterations: 500 }, memory: None, quantity: "temperature" }
    }
}

/// The solution of a steady problem.
#[derive(Debug, Clone, PartialEq)]
pub struct Steady {
    /// Value at every node; zero at nodes of no cell.
    pub values: Vec<f64>,
    /// Flux through every slice, from the rim to the far end positive.
    pub slice_flux: Vec<f64>,
    /// Largest difference between the flux through neighbouring slices and what enters between them, as a share of the largest.
    pub imbalance: f64,
    /// Iterations of conjugate gradients, over all systems solved.
    pub iterations: Iterations,
    /// Levels of the multigrid hierarchy.
    pub levels: usize,
    /// Largest over smallest conductivity.
    pub contrast: f64,
    /// Where phases of extreme contrast were solved apart: how.
    pub apart: Option<Apart>,
}

/// How phases of extreme contrast were solved.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
pub struct Apart {
    /// Parts of the conducting phase that touch neither end.
    pub floating: usize,
    /// Whether a part of it reaches from one given value to another.
    pub percolates: bool,
    /// Alternations between the phases.
    pub sweeps: usize,
}

/// Solves a steady problem for one conductivity a material.
///
/// # Errors
/// [`ConductionError::Range`] for conductivities that are negative or not finite, [`ConductionError::Isolated`] for parts
/// that nothing holds, [`ConductionError::Contrast`], [`ConductionError::Memory`], [`ConductionError::NotConverged`],
/// [`ConductionError::Unbalanced`], [`ConductionError::Cancelled`].
pub fn solve(
    mesh: &BrickMesh,
    conductivities: &[f64],
    boundary: &Boundary,
    options: &SteadyOptions,
    watch: Watch<'_>,
) -> Result<Steady, ConductionError> {
    let stopped = AtomicBool::new(false);
    let progress = latched(watch, &stopped);
    let watch = Watch { progress: &progress, ..watch };
    check(mesh, boundary)?;
    memory::require(mesh, options.memory)?;
    let present = present(mesh, conductivities)?;
    watch.at(0.0)?;
    refuse_isolated(mesh, conductivities, &boundary.given, options.quantity, watch)?;
    watch.at(0.0)?;
    let (least, most) = (present[0], present[present.len() - 1]);
    let mut steady = if most / least <= LARGEST_CONTRAST {
        together(mesh, conductivities, [least, most], boundary, options, watch)?
    } else {
        contrast::solve(mesh, conductivities, &present, boundary, options, watch)?
    };
    watch.at(1.0)?;
    steady.contrast = most / least;
    steady.imbalance = imbalance(mesh, boundary, &steady.slice_flux)?;
    Ok(steady)
}

fn check(mesh: &BrickMesh, boundary: &Boundary) -> Result<(), ConductionError> {
    let lengths = [boundary.given.len(), boundary.values.len(), boundary.loads.len()];
    match lengths.iter().find(|n| **n != mesh.nodes()) {
        Some(found) => {
            Err(ConductionError::Size { what: "boundary values of nodes", found: *found, expected: mesh.nodes() })
        }
        None => Ok(()),
    }
}

/// The different conductivities that cells have, ascending, zero left out.
pub(super) fn present(mesh: &BrickMesh, conductivities: &[f64]) -> Result<Vec<f64>, ConductionError> {
    if let Some(value) = conductivities.iter().find(|k| !k.is_finite() || **k < 0.0) {
        return Err(ConductionError::Range { what: "a conductivity", value: *value, range: "finite and not negative" });
    }
    let mut used = vec![false; conductivities.len()];
    for material in mesh.materials().iter().filter(|m| **m != VOID) {
        match used.get_mut(usize::from(*material)) {
            Some(used) => *used = true,
            None => {
                let (found, expected) = (conductivities.len(), usize::from(*material) + 1);
                return Err(ConductionError::Size { what: "conductivities", found, expected });
            }
        }
    }
    let mut values: Vec<f64> =
        conductivities.iter().zip(&used).filter(|(k, used)| **used && **k > 0.0).map(|(k, _)| *k).collect();
    values.sort_by(f64::total_cmp);
    values.dedup();
    if values.is_empty() { Err(ConductionError::NoPath { quantity: "field" }) } else { Ok(values) }
}

/// Refuses parts of the mesh that touch no node whose value is given.
fn refuse_isolated(
    mesh: &BrickMesh,
    conductivities: &[f64],
    given: &[bool],
    quantity: &'static str,
    watch: Watch<'_>,
) -> Result<(), ConductionError> {
    let conducts = |m: u16| m != VOID && conductivities[usize::from(m)] > 0.0;
    let cells = || mesh.materials().iter().enumerate().filter(|(_, m)| conducts(**m)).map(|(n, _)| mesh.cell(n));
    let parts = Components::new(mesh.nodes(), cells().map(|c| mesh.cell_nodes(c)), watch)?;
    let roots = parts.roots();
    let mut held = vec![false; mesh.nodes()];
    for (node, root) in roots.iter().enumerate() {
        if *root != NONE && given[node] {
            held[*root as usize] = true;
        }
    }
    watch.at(0.0)?;
    let root = |cell: [usize; 3]| roots[mesh.cell_nodes(cell)[0]] as usize;
    let mut first = None;
    for (n, cell) in cells().enumerate() {
        if n.is_multiple_of(ASK_EVERY) {
            watch.at(0.0)?;
        }
        if !held[root(cell)] {
            first = Some(cell);
            break;
        }
    }
    let Some(first) = first else { return Ok(()) };
    let voxels = cells().filter(|cell| root(*cell) == root(first)).count();
    let [slice, layer, across] = first.map(|i| i + 1);
    Err(ConductionError::Isolated { voxels, slice, layer, across, quantity })
}

/// A mesh's operator with its multigrid preconditioner.
pub(super) struct Plain<'a> {
    pub(super) operator: Operator<'a>,
    pub(super) multigrid: Multigrid,
}

impl<'a> Plain<'a> {
    pub(super) fn new(operator: Operator<'a>, watch: Watch<'_>) -> Result<Self, ConductionError> {
        let multigrid = Multigrid::new(&operator, &|| watch.goes_on()).ok_or(ConductionError::Cancelled)?;
        Ok(Self { operator, multigrid })
    }
}

impl System for Plain<'_> {
    fn apply(&mut self, u: &[f64], out: &mut [f64], go_on: &(dyn Fn() -> bool + Sync)) {
        self.operator.apply(u, out, go_on);
    }

    fn precondition(&mut self, r: &[f64], out: &mut [f64], go_on: &(dyn Fn() -> bool + Sync)) {
        self.multigrid.apply(&self.operator, r, out, go_on);
    }
}

/// Solves all phases in one system.
fn together(
    mesh: &BrickMesh,
    conductivities: &[f64],
    [least, most]: [f64; 2],
    boundary: &Boundary,
    options: &SteadyOptions,
    watch: Watch<'_>,
) -> Result<Steady, ConductionError> {
    let scaled: Vec<f64> = conductivities.iter().map(|k| k / most).collect();
    let mut system = Plain::new(Operator::new(mesh, &scaled, &[], &boundary.given, watch)?, watch)?;
    watch.at(0.0)?;
    let mut values = boundary.values.clone();
    let mut load = vec![0.0; mesh.nodes()];
    system.operator.apply(&values, &mut load, &|| watch.goes_on());
    watch.at(0.0)?;
    combine(1.0 / most, &boundary.loads, -1.0, &mut load);
    mask(&mut load, system.operator.inverse_diagonal());
    let mut correction = vec![0.0; mesh.nodes()];
    let (iterations, reached) = pcg::solve(&mut system, &load, &mut correction, options.tolerance, None, watch)?;
    if !reached {
        return Err(ConductionError::NotConverged {
            stage: "steady conduction",
            iterations: iterations.count,
            residual: iterations.residual,
            tolerance: options.tolerance.relative,
            least,
            most,
        });
    }
    watch.at(1.0)?;
    combine(1.0, &correction, 1.0, &mut values);
    let slice_flux = system.operator.slice_fluxes(&values, watch)?.iter().map(|f| f * most).collect();
    watch.at(1.0)?;
    let levels = system.multigrid.levels();
    Ok(Steady { values, slice_flux, imbalance: 0.0, iterations, levels, contrast: 1.0, apart: None })
}

/// Zeroes a vector where nothing is unknown.
pub(super) fn mask(vector: &mut [f64], inverse_diagonal: &[f64]) {
    for (v, d) in vector.iter_mut().zip(inverse_diagonal) {
        if *d == 0.0 {
            *v = 0.0;
        }
    }
}

/// Largest difference between fluxes of neighbouring slices beyond what enters between them; planes where values are given
/// may give or take anything.
fn imbalance(mesh: &BrickMesh, boundary: &Boundary, flux: &[f64]) -> Result<f64, ConductionError> {
    let largest = flux.iter().fold(0.0_f64, |m, f| m.max(f.abs()));
    if largest == 0.0 {
        return Ok(0.0);
    }
    let (mut worst, mut at, mut drift) = (0.0_f64, 0, 0.0);
    for plane in 1..flux.len() {
        let nodes = plane_nodes(mesh, plane);
        if boundary.given[nodes.clone()].iter().any(|g| *g) {
            drift = 0.0;
            continue;
        }
        drift += flux[plane] - flux[plane - 1] - boundary.loads[nodes].iter().sum::<f64>();
        if drift.abs() > worst {
            (worst, at) = (drift.abs(), plane);
        }
    }
    let share = worst / largest;
    if share > BALANCE || !share.is_finite() {
        return Err(ConductionError::Unbalanced { plane: at, share, limit: BALANCE });
    }
    Ok(share)
}
