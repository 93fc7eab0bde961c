//! The closed strip.
//!
//! The design knows about where the strip will be: cross-sections are placed on the shape that the elastica predicts,
//! normal to it, and Newton's method starts there. Where it does not arrive, or arrives on an unstable branch, the strip is
//! led from flat to closed in steps; each starts from the last equilibrium, moved by as much as the prediction moves.

use super::FemError;
use super::assembly::State;
use super::element::MODES;
use super::mesh::Mesh;
use super::model::Model;
use super::newton::{Equilibrium, Solver, Stop, TOLERANCE};
use super::recovery::{ElementResults, Reactions, midline, reactions};
use crate::elastica::forward;
use crate::elastica::morph::{Guide, MorphPath};
use crate::progress::Share;

/// First step of a path.
const FIRST_STEP: f64 = 0.125;
/// Step below which a path is given up.
const SMALLEST_STEP: f64 = 1.0 / 512.0;

/// What a solution may do.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct MorphOptions {
    /// Bytes that may be taken; by default most of what the system has left.
    pub memory_limit: Option<u64>,
    /// Follow the path from flat at once, without trying the prediction first.
    pub from_flat: bool,
}

/// How a strip is led: its ends, and the shape predicted at any fraction of the morph.
#[derive(Debug, Clone)]
pub struct Lead<'a> {
    guide: &'a Guide,
    path: Option<&'a MorphPath>,
}

impl<'a> Lead<'a> {
    /// Leads along a prediction; without one, along the guide's own target.
    #[must_use]
    pub fn new(guide: &'a Guide, path: Option<&'a MorphPath>) -> Self {
        Self { guide, path }
    }

    /// How the ends are moved.
    #[must_use]
    pub fn guide(&self) -> &Guide {
        self.guide
    }

    /// The predicted mid-line at a fraction of the morph.
    #[must_use]
    pub fn predicted(&self, fraction: f64) -> forward::Equilibrium {
        self.path.and_then(|path| path.at(fraction).ok()).unwrap_or_else(|| self.guide.scaled_shape(fraction))
    }
}

/// The closed strip.
#[derive(Debug, Clone)]
pub struct MorphSolution {
    /// Displacements, mm, in the frame in which the hub keeps its `x`.
    pub state: State,
    /// Mid-line `[s, x, z]`, mm, rim first and seen from it.
    pub midline: Vec<[f64; 3]>,
    /// What the two ends are held by.
    pub reactions: Reactions,
    /// Strains and stresses.
    pub elements: ElementResults,
    /// Iterations of all steps.
    pub iterations: usize,
    /// Steps from flat; one where the prediction led to the solution at once.
    pub steps: usize,
    /// Residual, relative to the elements' forces.
    pub residual: f64,
    /// Negative eigenvalues of the tangent: directions in which the strip would leave this equilibrium by itself.
    pub negative: usize,
    /// Unknowns of the mesh.
    pub unknowns: usize,
}

impl MorphSolution {
    /// Whether the strip would leave this equilibrium by itself.
    #[must_use]
    pub fn is_unstable(&self) -> bool {
        self.negative > 0
    }
}

/// Solves the closed strip.
///
/// # Errors
/// [`FemError::Memory`] before any large memory is taken, [`FemError::Diverged`] saying where and what was tried,
/// [`FemError::Cancelled`].
pub fn solve(
    model: &Model,
    path: &Lead<'_>,
    options: &MorphOptions,
    progress: Share<'_>,
) -> Result<MorphSolution, FemError> {
    let lift = path.guide().ends(1.0).height.is_none();
    let limit = options.memory_limit.or_else(super::memory::default_limit);
    if !progress(0.0) {
        return Err(FemError::Cancelled);
    }
    let mut solver = Solver::new(model, lift, limit, &|| !progress(0.0))?;
    let mut tried = Vec::new();
    let mut direct = None;
    if !options.from_flat {
        match straight(model, path, &mut solver, progress) {
            Ok((state, found)) if found.negative == 0 => {
                return finish(model, path, solver, state, found, 1, progress);
            }
            Ok(unstable) => direct = Some(unstable),
            Err(Stop::Diverged { iterations, residual }) => {
                tried.push(format!("the design's prediction ({iterations} iterations, residual {residual:.1e})"));
            }
            Err(Stop::Final(error)) => return Err(error),
        }
    }
    tried.push(format!("steps from flat, halved down to {SMALLEST_STEP:.4} of the path"));
    match (follow(model, path, &mut solver, progress), direct) {
        (Ok((state, found, steps)), None) => finish(model, path, solver, state, found, steps, progress),
        (Ok((state, found, steps)), Some(_)) if found.negative == 0 => {
            finish(model, path, solver, state, found, steps, progress)
        }
        (Err(Stop::Final(FemError::Cancelled)), _) => Err(FemError::Cancelled),
        (_, Some((state, found))) => finish(model, path, solver, state, found, 1, progress),
        (Err(Stop::Final(FemError::Diverged { fraction, iterations, residual, .. })), None) => {
            Err(FemError::Diverged { fraction, iterations, residual, tried: tried.join("; ") })
        }
        (Err(Stop::Final(error)), None) => Err(error),
        (Err(Stop::Diverged { iterations, residual }), None) => {
            Err(FemError::Diverged { fraction: 1.0, iterations, residual, tried: tried.join("; ") })
        }
    }
}

/// Newton's method from the prediction.
fn straight(
    model: &Model,
    path: &Lead<'_>,
    solver: &mut Solver<'_>,
    progress: Share<'_>,
) -> Result<(State, Equilibrium), Stop> {
    let mut state = State::new(model, placed(&model.mesh, path, 1.0));
    let first = std::cell::Cell::new(0.0);
    let share = std::sync::atomic::AtomicU64::new(0);
    let told = || f64::from_bits(share.load(std::sync::atomic::Ordering::Relaxed));
    let cancelled = || !progress(told());
    let step = |iteration: usize, residual: f64| {
        if iteration == 0 {
            first.set(residual.max(TOLERANCE * 10.0));
        }
        // The residual falls ever faster; its logarithm is a fair measure of what is done.
        let done = (first.get() / residual.max(TOLERANCE)).ln() / (first.get() / TOLERANCE).ln();
        let done = done.clamp(told(), 0.99);
        share.store(done.to_bits(), std::sync::atomic::Ordering::Relaxed);
    };
    let found = solver.solve(&mut state, &cancelled, &step)?;
    Ok((state, found))
}

/// Newton's method in steps from flat.
fn follow(
    model: &Model,
    path: &Lead<'_>,
    solver: &mut Solver<'_>,
    progress: Share<'_>,
) -> Result<(State, Equilibrium, usize), Stop> {
    let nodes = model.mesh.nodes.len();
    let mut here = State::new(model, vec![[0.0; 3]; nodes]);
    let mut guess = here.displacements.clone();
    let (mut at, mut step) = (0.0, FIRST_STEP);
    let (mut iterations, mut steps) = (0, 0);
    loop {
        let to = if at + 1.001 * step >= 1.0 { 1.0 } else { at + step };
        let ahead = placed(&model.mesh, path, to);
        let mut state = here.clone();
        for ((u, new), old) in state.displacements.iter_mut().zip(&ahead).zip(&guess) {
            for k in 0..3 {
                u[k] += new[k] - old[k];
            }
        }
        prescribe(&model.mesh, path, to, &mut state.displacements);
        let cancelled = || !progress(0.99 * at);
        match solver.solve(&mut state, &cancelled, &|_, _| {}) {
            Ok(mut found) => {
                steps += 1;
                iterations += found.iterations;
                if to == 1.0 {
                    found.iterations = iterations;
                    return Ok((state, found, steps));
                }
                (here, guess, at) = (state, ahead, to);
                step = (step * if found.iterations <= 6 { 1.5 } else { 1.0 }).min(0.5);
            }
            Err(Stop::Diverged { .. }) if step > SMALLEST_STEP => step *= 0.5,
            Err(Stop::Diverged { iterations, residual }) => {
                let error = FemError::Diverged { fraction: to, iterations, residual, tried: String::new() };
                return Err(Stop::Final(error));
            }
            Err(stop) => return Err(stop),
        }
    }
}

/// Displacements that place every cross-section on the predicted mid-line, normal to it, with the end sections where they
/// are prescribed.
fn placed(mesh: &Mesh, path: &Lead<'_>, fraction: f64) -> Vec<[f64; 3]> {
    let mut displacements = vec![[0.0; 3]; mesh.nodes.len()];
    let (ends, length) = (path.guide().ends(fraction), path.guide().length());
    let shape = path.predicted(fraction);
    // A misfit of the prediction's span is spread along the strip.
    let misfit = ends.span - shape.x.last().copied().unwrap_or(ends.span);
    for plane in 0..mesh.plane_count() {
        let s = mesh.nodes[mesh.planes[plane]][0];
        let ([x, z], angle) = (shape.position(s), shape.inclination_at(s));
        place(mesh, plane, [x + misfit * s / length + length - ends.span, z], angle, &mut displacements);
    }
    prescribe(mesh, path, fraction, &mut displacements);
    displacements
}

/// Puts the two end sections where the guide wants them; a free hub keeps its height.
fn prescribe(mesh: &Mesh, path: &Lead<'_>, fraction: f64, displacements: &mut [[f64; 3]]) {
    let (ends, length) = (path.guide().ends(fraction), path.guide().length());
    let hub = mesh.plane_count() - 1;
    let height = ends.height.unwrap_or_else(|| {
        let [a, b] = mesh.midline_nodes(hub);
        0.5 * (displacements[a][2] + displacements[b][2])
    });
    place(mesh, 0, [length - ends.span, 0.0], ends.rim_angle, displacements);
    place(mesh, hub, [length, height], ends.hub_angle, displacements);
}

/// Moves a plane of nodes to a position and turns it.
fn place(mesh: &Mesh, plane: usize, [x, z]: [f64; 2], angle: f64, displacements: &mut [[f64; 3]]) {
    let (sin, cos) = angle.sin_cos();
    for node in mesh.plane(plane) {
        let [flat_x, _, up] = mesh.nodes[node];
        displacements[node] = [x - up * sin - flat_x, 0.0, z + up * cos - up];
    }
}

fn finish(
    model: &Model,
    path: &Lead<'_>,
    solver: Solver<'_>,
    mut state: State,
    found: Equilibrium,
    steps: usize,
    progress: Share<'_>,
) -> Result<MorphSolution, FemError> {
    let length = path.guide().length();
    let ends = path.guide().ends(1.0);
    // The factors are most of the memory: releasing it takes a while, so questions follow.
    let unknowns = solver.unknowns();
    drop(solver);
    let elements = ElementResults::of(model, &state, &|| !progress(1.0))?;
    if !model.law.needs_modes() {
        state.modes = Vec::<[f64; MODES]>::new();
    }
    Ok(MorphSolution {
        midline: midline(&model.mesh, &state.displacements),
        reactions: reactions(&model.mesh, &state.displacements, &found.forces, length - ends.span),
        elements,
        iterations: found.iterations,
        steps,
        residual: found.residual,
        negative: found.negative,
        unknowns,
        state,
    })
}
