//! Conduction in time: `M du/dt + K u = f`, by TR-BDF2.
//!
//! With `g = 2 - sqrt(2)` and `d = g/2` both stages of a step `h` have the matrix `A = M/(d h) + K` (Bank et al. 1985; the
//! error estimate of Hosea and Shampine 1996):
//!
//! ```text
//! A (u_g - u_0) = 2 (f - K u_0)                            trapezoidal rule to g h
//! A (u_1 - v)   = f - K v,  v = c u_g - (c - 1) u_0         second-order BDF to h,  c = 1/(g (2 - g))
//! A e           = (1/d) sum of e_i (f - K u_i)              third-order error, damped where the problem is stiff
//! ```
//!
//! The scheme is of second order and L-stable: the jump of a temperature that is switched on does not ring. `M` itself is never
//! applied, so it may be a diagonal (lumped heat capacities) or, for the relaxation of charges, the operator of the
//! permittivities: then `A` is the operator of `sigma + epsilon/(d h)`.

use std::sync::atomic::AtomicBool;

use super::ConductionError;
use super::mesh::BrickMesh;
use super::operator::Operator;
use super::pcg::{self, Tolerance, Watch, combine, dot, latched};
use super::steady::{Boundary, Plain, mask};

const SQRT_2: f64 = std::f64::consts::SQRT_2;
/// Length of the first stage, relative to the step.
const G: f64 = 2.0 - SQRT_2;
/// Weight of the implicit slope in both stages.
const D: f64 = 0.5 * G;
/// Weights of the error estimate at the start, the middle and the end.
const ERROR: [f64; 3] = [(SQRT_2 - 1.0) / 3.0, -1.0 / 3.0, 2.0 * D / 3.0];

/// Most steps, rejected ones included.
const MOST_STEPS: usize = 20_000;

/// What resists change.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Storage {
    /// Lumped capacities: `M` is diagonal (heat).
    Lumped,
    /// `M` is the conduction operator with capacities in place of conductivities (displacement currents).
    Gradient,
}

/// How flux enters at the rim.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Drive {
    /// As the boundary says: given values and loads.
    Boundary,
    /// The rim, whose nodes are given, is one conductor: its loads enter together and its value is unknown.
    Electrode,
}

/// A transient problem.
#[derive(Debug, Clone, Copy)]
pub struct Transient<'a> {
    /// The mesh.
    pub mesh: &'a BrickMesh,
    /// Conductivity of every material.
    pub conductivities: &'a [f64],
    /// Capacity of every material: per volume ([`Storage::Lumped`]) or permittivity ([`Storage::Gradient`]).
    pub capacities: &'a [f64],
    /// What the capacities are.
    pub storage: Storage,
    /// Given values and loads, from t = 0 on.
    pub boundary: &'a Boundary,
    /// How flux enters.
    pub drive: Drive,
    /// Value of the other nodes at t = 0.
    pub start: f64,
}

/// How a transient is solved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TransientOptions {
    /// Largest error of a step, relative to `range`.
    pub tolerance: f64,
    /// The range of values that the tolerance refers to; the largest value so far where `None`.
    pub range: Option<f64>,
    /// First step, s.
    pub first_step: f64,
    /// The latest time, s.
    pub end: f64,
    /// When conjugate gradients stop.
    pub solver: Tolerance,
}

/// One accepted step.
#[derive(Debug, Clone, Copy)]
pub struct StepView<'a> {
    /// Time at its start, s.
    pub from: f64,
    /// Time at its end, s.
    pub to: f64,
    values: [&'a [f64]; 3],
}

impl StepView<'_> {
    /// Weights of start, middle and end at a time within the step: a parabola through the three.
    fn weights(&self, time: f64) -> [f64; 3] {
        let x = if self.to > self.from { (time - self.from) / (self.to - self.from) } else { 1.0 };
        [(x - G) * (x - 1.0) / G, x * (x - 1.0) / (G * (G - 1.0)), x * (x - G) / (1.0 - G)]
    }

    /// Value of a node at a time within the step.
    #[must_use]
    pub fn at_node(&self, node: usize, time: f64) -> f64 {
        let w = self.weights(time);
        (0..3).map(|i| w[i] * self.values[i][node]).sum()
    }

    /// The field at a time within the step.
    #[must_use]
    pub fn field(&self, time: f64) -> Vec<f64> {
        let w = self.weights(time);
        let mut field = vec![0.0; self.values[0].len()];
        blend(w, self.values, &mut field);
        field
    }

    /// The field at its end.
    #[must_use]
    pub fn last(&self) -> &[f64] {
        self.values[2]
    }

    /// A linear functional of the field at start, middle and end, as a parabola in time.
    pub fn functional(&self, f: impl Fn(&[f64]) -> f64) -> impl Fn(f64) -> f64 {
        let values = self.values.map(&f);
        let view = StepView { from: self.from, to: self.to, values: [&[], &[], &[]] };
        move |time| {
            let w = view.weights(time);
            (0..3).map(|i| w[i] * values[i]).sum()
        }
    }
}

/// Effort of a transient.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize)]
pub struct Effort {
    /// Accepted steps.
    pub steps: usize,
    /// Rejected ones.
    pub rejected: usize,
    /// Iterations of conjugate gradients.
    pub iterations: usize,
}

/// Integrates until `on_step` says to stop (`false`) or the end is reached; it is shown every accepted step.
///
/// # Errors
/// [`ConductionError::NotConverged`], [`ConductionError::StepTooSmall`], [`ConductionError::Cancelled`].
pub fn integrate(
    problem: &Transient<'_>,
    options: &TransientOptions,
    on_step: &mut dyn FnMut(&StepView<'_>) -> bool,
    watch: Watch<'_>,
) -> Result<Effort, ConductionError> {
    let stopped = AtomicBool::new(false);
    let progress = latched(watch, &stopped);
    let watch = Watch { progress: &progress, ..watch };
    let mesh = problem.mesh;
    let n = mesh.nodes();
    let most = problem.conductivities.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    let stiff = Operator::new(mesh, problem.conductivities, &[], &problem.boundary.given, watch)?;
    let mut effort = Effort::default();
    let (mut time, mut step) = (0.0, options.first_step);
    let mut stage: Option<Stage<'_>> = None;
    let mut start: Vec<f64> =
        (0..n).map(|i| if problem.boundary.given[i] { problem.boundary.values[i] } else { problem.start }).collect();
    let (mut middle, mut end) = (start.clone(), start.clone());
    let mut force = vec![0.0; n];
    let residual = |u: &[f64], out: &mut Vec<f64>| {
        stiff.flux(u, out, &|| watch.goes_on());
        for (r, b) in out.iter_mut().zip(&problem.boundary.loads) {
            *r = b - *r;
        }
    };
    residual(&start, &mut force);
    let (mut force_middle, mut force_end) = (vec![0.0; n], vec![0.0; n]);
    let (mut load, mut change) = (vec![0.0; n], vec![0.0; n]);
    watch.at(0.0)?;
    while time < options.end * (1.0 - 1e-12) {
        if effort.steps + effort.rejected >= MOST_STEPS || step.is_nan() || step <= 1e-14 * time.max(options.first_step)
        {
            return Err(ConductionError::StepTooSmall { time_s: time, step_s: step, tolerance: options.tolerance });
        }
        // Solves only ask whether to go on; steps tell how far they are.
        let now = watch.part(time / options.end, time / options.end);
        if stage.as_ref().is_none_or(|s| s.step != step) {
            stage = Some(Stage::new(problem, step, most, options, &mut effort, now)?);
        }
        let Some(system) = stage.as_mut() else { continue };

        load.iter_mut().zip(&force).for_each(|(l, f)| *l = 2.0 * f);
        system.solve(&load, &mut change, options.solver, &mut effort, now)?;
        middle.copy_from_slice(&start);
        combine(1.0, &change, 1.0, &mut middle);
        residual(&middle, &mut force_middle);

        let c = 1.0 / (G * (2.0 - G));
        blend([1.0 - c, c, 0.0], [&force, &force_middle, &force_end], &mut load);
        blend([1.0 - c, c, 0.0], [&start, &middle, &start], &mut end);
        system.solve(&load, &mut change, options.solver, &mut effort, now)?;
        combine(1.0, &change, 1.0, &mut end);
        residual(&end, &mut force_end);

        blend(ERROR.map(|e| e / D), [&force, &force_middle, &force_end], &mut load);
        let loose = Tolerance { relative: 1e-2, ..options.solver };
        system.solve(&load, &mut change, loose, &mut effort, now)?;
        let largest = |v: &[f64]| v.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let range = options.range.unwrap_or_else(|| largest(&end)).max(f64::MIN_POSITIVE);
        let error = largest(&change) / (range * options.tolerance);
        if error > 1.0 || !error.is_finite() {
            effort.rejected += 1;
            step *= if error > 8.0 || !error.is_finite() { 0.25 } else { 0.5 };
            continue;
        }
        effort.steps += 1;
        let view = StepView { from: time, to: time + step, values: [&start, &middle, &end] };
        let go_on = on_step(&view);
        time += step;
        watch.at(time / options.end)?;
        std::mem::swap(&mut start, &mut end);
        std::mem::swap(&mut force, &mut force_end);
        if !go_on {
            break;
        }
        // Of third order: twice the step makes eight times the error. A new matrix costs about a solve, so steps only double.
        if error < 0.08 {
            step *= 2.0;
        }
    }
    Ok(effort)
}

/// `out = sum of w_i v_i`.
fn blend(w: [f64; 3], [a, b, c]: [&[f64]; 3], out: &mut [f64]) {
    for (((o, a), b), c) in out.iter_mut().zip(a).zip(b).zip(c) {
        *o = w[0] * a + w[1] * b + w[2] * c;
    }
}

/// The system of one step size.
struct Stage<'a> {
    step: f64,
    system: Plain<'a>,
    electrode: Option<Electrode>,
    /// Unit of the matrix.
    unit: f64,
}

/// A rim that is one conductor: the field with 1 there and no other drive, and the flux that then enters.
struct Electrode {
    nodes: Vec<usize>,
    field: Vec<f64>,
    flux: f64,
}

impl<'a> Stage<'a> {
    fn new(
        problem: &Transient<'a>,
        step: f64,
        most: f64,
        options: &TransientOptions,
        effort: &mut Effort,
        watch: Watch<'_>,
    ) -> Result<Self, ConductionError> {
        let over = |c: f64| c / (D * step);
        let mesh = problem.mesh;
        let (conductivities, capacities, unit): (Vec<f64>, Vec<f64>, f64) = match problem.storage {
            Storage::Lumped => {
                let capacities = problem.capacities.iter().map(|c| over(*c) / most).collect();
                (problem.conductivities.iter().map(|k| k / most).collect(), capacities, most)
            }
            Storage::Gradient => {
                let both: Vec<f64> =
                    problem.conductivities.iter().zip(problem.capacities).map(|(k, c)| k + over(*c)).collect();
                let unit = both.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
                (both.iter().map(|k| k / unit).collect(), Vec::new(), unit)
            }
        };
        let operator = Operator::new(mesh, &conductivities, &capacities, &problem.boundary.given, watch)?;
        let mut system = Plain::new(operator, watch)?;
        let electrode = match problem.drive {
            Drive::Boundary => None,
            Drive::Electrode => {
                let per_plane = super::steady::plane_nodes(mesh, 0);
                let nodes: Vec<usize> = per_plane.filter(|n| problem.boundary.given[*n]).collect();
                let mut field = vec![0.0; mesh.nodes()];
                nodes.iter().for_each(|n| field[*n] = 1.0);
                let mut load = vec![0.0; mesh.nodes()];
                system.operator.flux(&field, &mut load, &|| watch.goes_on());
                load.iter_mut().for_each(|l| *l = -*l);
                mask(&mut load, system.operator.inverse_diagonal());
                let mut inner = vec![0.0; mesh.nodes()];
                run(&mut system, &load, &mut inner, options.solver, effort, watch)?;
                combine(1.0, &inner, 1.0, &mut field);
                system.operator.flux(&field, &mut load, &|| watch.goes_on());
                let flux = nodes.iter().map(|n| load[*n]).sum();
                Some(Electrode { nodes, field, flux })
            }
        };
        Ok(Self { step, system, electrode, unit })
    }

    /// `A x = load`; at the rim of an electrode loads are added up and the values are one.
    fn solve(
        &mut self,
        load: &[f64],
        x: &mut [f64],
        tolerance: Tolerance,
        effort: &mut Effort,
        watch: Watch<'_>,
    ) -> Result<(), ConductionError> {
        let mut inner = load.to_vec();
        inner.iter_mut().for_each(|l| *l /= self.unit);
        let at_rim: f64 = self.electrode.as_ref().map_or(0.0, |e| e.nodes.iter().map(|n| inner[*n]).sum());
        mask(&mut inner, self.system.operator.inverse_diagonal());
        x.fill(0.0);
        run(&mut self.system, &inner, x, tolerance, effort, watch)?;
        if let Some(electrode) = &self.electrode {
            // By symmetry the flux at the rim of the inner solution is minus the inner loads weighted with the unit field.
            let value = (at_rim + dot(&electrode.field, &inner)) / electrode.flux;
            combine(value, &electrode.field, 1.0, x);
        }
        Ok(())
    }
}

fn run(
    system: &mut Plain<'_>,
    load: &[f64],
    x: &mut [f64],
    tolerance: Tolerance,
    effort: &mut Effort,
    watch: Watch<'_>,
) -> Result<(), ConductionError> {
    let (done, reached) = pcg::solve(system, load, x, tolerance, None, watch)?;
    effort.iterations += done.count;
    if reached {
        return Ok(());
    }
    Err(ConductionError::NotConverged {
        stage: "a time step",
        iterations: done.count,
        residual: done.residual,
        tolerance: tolerance.relative,
        least: 0.0,
        most: 0.0,
    })
}
