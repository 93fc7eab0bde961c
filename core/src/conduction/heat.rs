//! Heat from the rim into the strip.
//!
//! Transient: the strip is at the start temperature, the rim jumps to its own at t = 0, all other faces are insulated. The
//! critical time of a point is when it has got to the threshold. A uniform strip of the same shape gets there after
//! `t_1 alpha_1 / alpha`, so its diffusivity is known from one run with `alpha_1 = 1 mm^2/s`, and with the mean heat capacity of the
//! strip its conductivity: the effective conductivity by time. Steady: the far end is kept at the start temperature, and the
//! effective conductivity is that of the uniform strip that lets the same heat through.

use super::ConductionError;
use super::case::{SteadyAnswer, Task, TransientAnswer, at, bounds, crossing};
use super::pcg::{Tolerance, Watch};
use super::steady::{self, Boundary, SteadyOptions};
use super::strip::{Property, Strip};
use super::transient::{Drive, Effort, Storage, Transient, TransientOptions, integrate};

/// Conjugate gradients in a time step.
pub(super) const STEP_SOLVER: Tolerance = Tolerance { relative: 1e-5, iterations: 300 };

/// A run ends after so many times `L^2 / alpha` of the phase that conducts worst.
const PATIENCE: f64 = 20.0;

pub(super) fn solve(
    task: &Task<'_>,
    watch: Watch<'_>,
) -> Result<(Option<SteadyAnswer>, Option<TransientAnswer>), ConductionError> {
    let share = if task.regimes.transient { 0.1 } else { 1.0 };
    let steady = task.regimes.steady.then(|| steady(task, watch.part(0.0, share))).transpose()?;
    let transient = task.regimes.transient.then(|| transient(task, watch.part(share.min(0.1), 1.0))).transpose()?;
    Ok((steady, transient))
}

/// Flux through a strip of unit conductivity whose ends differ by one, mm, and the field.
pub(super) fn unit_strip(strip: &Strip, watch: Watch<'_>) -> Result<(f64, Vec<f64>), ConductionError> {
    let mesh = &strip.mesh;
    let mut boundary = Boundary::insulated(mesh);
    boundary.give_plane(mesh, 0, 1.0);
    boundary.give_plane(mesh, mesh.cells()[0], 0.0);
    let ones = vec![1.0; strip.mixtures.len()];
    let found = steady::solve(mesh, &ones, &boundary, &SteadyOptions::default(), watch)?;
    Ok((found.slice_flux[0], found.values))
}

fn steady(task: &Task<'_>, watch: Watch<'_>) -> Result<SteadyAnswer, ConductionError> {
    let (mesh, input) = (&task.strip.mesh, task.input);
    let conductivities = task.strip.property(Property::Conductivity)?;
    let mut boundary = Boundary::insulated(mesh);
    boundary.give_plane(mesh, 0, input.rim_temperature_k);
    boundary.give_plane(mesh, mesh.cells()[0], input.start_temperature_k);
    let found = steady::solve(mesh, &conductivities, &boundary, &SteadyOptions::default(), watch.part(0.0, 0.5))?;
    let difference = input.rim_temperature_k - input.start_temperature_k;
    let flow = found.slice_flux[0];
    let (conductance, uniform) = unit_strip(task.strip, watch.part(0.5, 1.0))?;
    let effective = flow / (difference * conductance);
    let bounds = bounds(task.strip, &conductivities, &uniform, watch)?.map(|k| 1e3 * k);
    Ok(SteadyAnswer::new(found, [flow, difference], 1e3 * effective, bounds, task.points))
}

fn transient(task: &Task<'_>, watch: Watch<'_>) -> Result<TransientAnswer, ConductionError> {
    let strip = task.strip;
    let conductivities = strip.property(Property::Conductivity)?;
    let capacities = strip.property(Property::HeatCapacity)?;
    let times = &task.input.heat_times_s;
    let mut answer = warm_up(task, &conductivities, &capacities, times, watch.part(0.0, 0.65))?;
    let ones = vec![1e-3; conductivities.len()];
    let uniform = warm_up(task, &ones, &ones, &[], watch.part(0.65, 1.0))?;
    let volumes = strip.mesh.volumes(capacities.len());
    let mean = volumes.iter().zip(&capacities).map(|(v, c)| v * c).sum::<f64>() / volumes.iter().sum::<f64>();
    let both = answer.critical_times_s.iter().zip(&uniform.critical_times_s);
    answer.effective_conductivities = both.map(|(own, unit)| Some(1e3 * mean * (*unit)? / (*own)?)).collect();
    Ok(answer)
}

/// Runs until every measuring point has got to the threshold and every field was taken.
fn warm_up(
    task: &Task<'_>,
    conductivities: &[f64],
    capacities: &[f64],
    times: &[f64],
    watch: Watch<'_>,
) -> Result<TransientAnswer, ConductionError> {
    let (mesh, input) = (&task.strip.mesh, task.input);
    let diffusivities = || conductivities.iter().zip(capacities).filter(|(_, c)| **c > 0.0).map(|(k, c)| k / c);
    let fastest = diffusivities().fold(0.0, f64::max);
    let slowest = diffusivities().filter(|a| *a > 0.0).fold(f64::INFINITY, f64::min);
    let shortest = mesh.mean_edges().into_iter().fold(f64::INFINITY, f64::min);
    let (start, rim) = (input.start_temperature_k, input.rim_temperature_k);
    let latest = PATIENCE * task.strip.length_mm.powi(2) / slowest;
    let options = TransientOptions {
        tolerance: input.time_tolerance,
        range: Some((rim - start).abs()),
        first_step: 0.05 * shortest * shortest / fastest,
        end: times.last().map_or(latest, |last| latest.max(*last)),
        solver: STEP_SOLVER,
    };
    let mut boundary = Boundary::insulated(mesh);
    boundary.give_plane(mesh, 0, rim);
    let problem = Transient {
        mesh,
        conductivities,
        capacities,
        storage: Storage::Lumped,
        boundary: &boundary,
        drive: Drive::Boundary,
        start,
    };
    let threshold = input.rise_at_threshold();
    // Progress: the last point's rise on its way to the threshold, on a logarithmic scale.
    let span = (1.0 - threshold).max(1e-9).ln();
    let points = task.points;
    let mut answer = TransientAnswer {
        times: vec![0.0],
        history: points.iter().map(|_| vec![start]).collect(),
        critical_times_s: vec![None; points.len()],
        effective_conductivities: vec![None; points.len()],
        field_times_s: Vec::new(),
        fields: Vec::new(),
        end_s: 0.0,
        effort: Effort::default(),
    };
    let done = std::sync::atomic::AtomicU64::new(0);
    let progress = |_: f64| {
        let share = f64::from_bits(done.load(std::sync::atomic::Ordering::Relaxed));
        watch.at(share).is_ok()
    };
    let inner = Watch { progress: &progress, span: [0.0, 1.0] };
    answer.effort = integrate(
        &problem,
        &options,
        &mut |step| {
            let mut slowest_rise = 1.0_f64;
            for (p, point) in points.iter().enumerate() {
                let value = step.functional(|field| at(point, field));
                let excess = |time: f64| (value(time) - start) / (rim - start) - threshold;
                if answer.critical_times_s[p].is_none() && excess(step.to) >= 0.0 {
                    answer.critical_times_s[p] = Some(crossing(step.from, step.to, excess));
                }
                answer.history[p].push(value(step.to));
                slowest_rise = slowest_rise.min(excess(step.to) + threshold);
            }
            answer.times.push(step.to);
            for time in times.iter().filter(|t| **t > step.from && **t <= step.to) {
                answer.field_times_s.push(*time);
                answer.fields.push(step.field(*time));
            }
            answer.end_s = step.to;
            let share = (1.0 - slowest_rise).clamp(1e-12, 1.0).ln() / span;
            done.store(share.clamp(0.0, 1.0).to_bits(), std::sync::atomic::Ordering::Relaxed);
            answer.critical_times_s.iter().any(Option::is_none) || answer.fields.len() < times.len()
        },
        inner,
    )?;
    Ok(answer)
}
