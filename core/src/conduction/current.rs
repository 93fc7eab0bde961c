//! Current from the rim through the strip to the grounded far end.
//!
//! Steady: `div(sigma grad phi) = 0`. In time charges gather where conductivities change: `div(sigma grad phi + epsilon d(grad
//! phi)/dt) = 0`, from no potential at all when the current is switched on at t = 0. A phase relaxes with `epsilon / sigma`: 0.3 ms
//! at 1e-7 S/m, tens of thousands of years at 1e-23 S/m; the potential after milliseconds is then that of a conductor between
//! perfect dielectrics, which need not be near the steady one.

use super::ConductionError;
use super::case::{SteadyAnswer, Task, TransientAnswer, at, bounds, crossing};
use super::heat::{STEP_SOLVER, unit_strip};
use super::pcg::Watch;
use super::steady::{self, Boundary, Steady, SteadyOptions, plane_nodes};
use super::strip::Property;
use super::transient::{Drive, Effort, Storage, Transient, TransientOptions, integrate};
use crate::input::Electrode;
use crate::report::number;

/// A run may last so many times longer than asked: narrow paths beside dielectrics relax more slowly than the phase alone.
const PATIENCE: f64 = 1e3;

/// The same where no path of the conducting phase reaches through, so that no plateau is to be expected.
const PATIENCE_WITHOUT_PATH: f64 = 10.0;

/// Fields in air break down at 3 MV/m, in polymers at some 100 MV/m.
const BREAKDOWN_V_MM: f64 = 1e5;

pub(super) fn solve(
    task: &Task<'_>,
    notes: &mut Vec<String>,
    watch: Watch<'_>,
) -> Result<(Option<SteadyAnswer>, Option<TransientAnswer>), ConductionError> {
    let share = if task.regimes.transient { 0.3 } else { 1.0 };
    let sigma = task.strip.property(Property::ElectricalConductivity)?;
    let (found, potential) = drive(task, &sigma, watch.part(0.0, 0.5 * share))?;
    let (resistance, uniform) = unit_resistance(task, watch.part(0.5 * share, share))?;
    let current = task.input.current_a;
    let effective = |potential: f64| 1e3 * resistance * current / potential;
    let bounds = bounds(task.strip, &sigma, &uniform, watch)?.map(|s| 1e3 * s);
    if potential / task.strip.length_mm > BREAKDOWN_V_MM {
        notes.push(format!(
            "{} V over {} mm are far beyond what any material stands: read potentials as resistances times {current} A.",
            number(potential, 4),
            task.strip.length_mm
        ));
    }
    if found.apart.is_some_and(|apart| !apart.percolates) {
        notes.push(
            "No path of the conducting phase reaches from the rim to the far end: all current crosses the insulating phase."
                .to_owned(),
        );
    }
    let patience = if found.apart.is_some_and(|apart| !apart.percolates) { PATIENCE_WITHOUT_PATH } else { PATIENCE };
    let flow = found.slice_flux[0];
    let steady = SteadyAnswer::new(found, [flow, potential], effective(potential), bounds, task.points);
    let transient = if task.regimes.transient {
        let mut answer = relax(task, &sigma, potential, patience, watch.part(share, 1.0))?;
        let last = answer.history[0].last().copied().unwrap_or(potential);
        if answer.critical_times_s[0].is_some() {
            answer.effective_conductivities = vec![Some(effective(last))];
        } else {
            notes.push(format!(
                "The potential had not come to its plateau after {} s: it was {} V and still rising, the steady one is {} V.",
                number(answer.end_s, 3),
                number(last, 4),
                number(potential, 4)
            ));
        }
        Some(answer)
    } else {
        None
    };
    Ok((task.regimes.steady.then_some(steady), transient))
}

/// Grounds the far end and lets the current in.
fn boundary(task: &Task<'_>) -> Boundary {
    let mesh = &task.strip.mesh;
    let mut boundary = Boundary::insulated(mesh);
    boundary.give_plane(mesh, mesh.cells()[0], 0.0);
    boundary.load_rim(mesh, task.input.current_a);
    boundary
}

/// Mean potential of the rim, weighted as the current enters.
fn rim_potential(boundary: &Boundary, nodes: std::ops::Range<usize>, field: &[f64], current: f64) -> f64 {
    nodes.map(|n| boundary.loads[n] * field[n]).sum::<f64>() / current
}

/// The steady field under the current, and the rim's potential.
fn drive(task: &Task<'_>, sigma: &[f64], watch: Watch<'_>) -> Result<(Steady, f64), ConductionError> {
    let mesh = &task.strip.mesh;
    let current = task.input.current_a;
    let options = SteadyOptions { quantity: "potential", ..SteadyOptions::default() };
    let mut boundary = boundary(task);
    match task.input.electrode {
        Electrode::Uniform => {
            let found = steady::solve(mesh, sigma, &boundary, &options, watch)?;
            let potential = rim_potential(&boundary, plane_nodes(mesh, 0), &found.values, current);
            Ok((found, potential))
        }
        Electrode::Equipotential => {
            // One volt lets some current through; the problem is linear.
            boundary.loads.fill(0.0);
            boundary.give_plane(mesh, 0, 1.0);
            let mut found = steady::solve(mesh, sigma, &boundary, &options, watch)?;
            let potential = current / found.slice_flux[0];
            found.values.iter_mut().for_each(|v| *v *= potential);
            found.slice_flux.iter_mut().for_each(|f| *f *= potential);
            Ok((found, potential))
        }
    }
}

/// Resistance of a strip of unit conductivity between the same electrodes, 1/mm, and its field.
fn unit_resistance(task: &Task<'_>, watch: Watch<'_>) -> Result<(f64, Vec<f64>), ConductionError> {
    match task.input.electrode {
        Electrode::Equipotential => {
            unit_strip(task.strip, watch).map(|(conductance, field)| (1.0 / conductance, field))
        }
        Electrode::Uniform => {
            let ones = vec![1.0; task.strip.mixtures.len()];
            let (found, potential) = drive(task, &ones, watch)?;
            Ok((potential / task.input.current_a, found.values))
        }
    }
}

/// Runs until the rim's potential is on its plateau and every field was taken.
fn relax(
    task: &Task<'_>,
    sigma: &[f64],
    plateau: f64,
    patience: f64,
    watch: Watch<'_>,
) -> Result<TransientAnswer, ConductionError> {
    let (mesh, input) = (&task.strip.mesh, task.input);
    let epsilon = task.strip.property(Property::Permittivity)?;
    let relaxation =
        sigma.iter().zip(&epsilon).filter(|(s, _)| **s > 0.0).map(|(s, e)| e / s).fold(f64::INFINITY, f64::min);
    let times = &input.current_times_s;
    let longest = times.last().copied().unwrap_or(0.0).max(3.0 * relaxation);
    let mut boundary = boundary(task);
    let rim = plane_nodes(mesh, 0);
    let drive = match input.electrode {
        Electrode::Uniform => Drive::Boundary,
        Electrode::Equipotential => {
            boundary.give_plane(mesh, 0, 0.0);
            Drive::Electrode
        }
    };
    let problem = Transient {
        mesh,
        conductivities: sigma,
        capacities: &epsilon,
        storage: Storage::Gradient,
        boundary: &boundary,
        drive,
        start: 0.0,
    };
    let options = TransientOptions {
        tolerance: input.time_tolerance,
        range: None,
        first_step: 1e-4 * relaxation.min(longest),
        end: patience * longest,
        solver: STEP_SOLVER,
    };
    let mut answer = TransientAnswer {
        times: vec![0.0],
        history: vec![vec![0.0]; task.points.len() + 1],
        critical_times_s: vec![None],
        effective_conductivities: vec![None],
        field_times_s: Vec::new(),
        fields: Vec::new(),
        end_s: 0.0,
        effort: Effort::default(),
    };
    let at_rim = |field: &[f64]| rim_potential(&boundary, rim.clone(), field, input.current_a);
    answer.effort = integrate(
        &problem,
        &options,
        &mut |step| {
            let potential = step.functional(at_rim);
            let excess = |time: f64| potential(time) / plateau - (1.0 - input.plateau);
            if answer.critical_times_s[0].is_none() && excess(step.to) >= 0.0 {
                answer.critical_times_s[0] = Some(crossing(step.from, step.to, excess));
            }
            answer.times.push(step.to);
            answer.history[0].push(potential(step.to));
            for (history, point) in answer.history[1..].iter_mut().zip(task.points) {
                history.push(at(point, step.last()));
            }
            for time in times.iter().filter(|t| **t > step.from && **t <= step.to) {
                answer.field_times_s.push(*time);
                answer.fields.push(step.field(*time));
            }
            answer.end_s = step.to;
            answer.critical_times_s[0].is_none() || answer.fields.len() < times.len()
        },
        watch,
    )?;
    Ok(answer)
}
