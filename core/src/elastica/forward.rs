//! The shape that a strip of given stiffness takes: the forward problem.
//!
//! For the mid-line position `(x, z)` and inclination `theta` over the flat arc length `s`:
//!
//! ```text
//! theta' = M_n / B,   x' = (1 + theta' z_n) cos(theta),   z' = (1 + theta' z_n) sin(theta)
//! M_n    = M_0 - H (z + z_n cos(theta)) - V (x - z_n sin(theta))
//! ```
//!
//! `B(s)` is the bending stiffness about the section's neutral axis, which lies `z_n(s)` above the mid-plane; the line
//! through the neutral axes is the one that keeps its length. With `z_n = 0` this is the classical elastica with
//! variable stiffness. `M_0` is the moment about the rim's mid-line point.
//!
//! The three unknowns `(M_0, H, V)` follow from the conditions at the hub by multiple shooting: fourth-order Runge-Kutta
//! along the strip together with the exact sensitivities of that scheme, Newton's method with step halving around it.

use nalgebra::{Matrix3, Vector3};

use super::ElasticaError;

/// Bending properties of one cross-section.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Section {
    /// Bending stiffness `B` about the neutral axis, N mm^2, positive.
    pub stiffness: f64,
    /// Height `z_n` of the neutral axis above the mid-plane, mm.
    pub neutral_offset: f64,
}

/// The stiffness along a strip.
#[derive(Debug, Clone)]
pub enum StripStiffness {
    /// Smooth: sections at `2 n + 1` evenly spaced arc lengths (ends and middles of `n` integration steps).
    Smooth(Vec<Section>),
    /// One section a slice, all slices equally long.
    Slices(Vec<Section>),
}

/// Integration steps that a strip of slices gets at least.
const LEAST_STEPS: usize = 400;

impl StripStiffness {
    /// Steps of the integration.
    fn steps(&self) -> usize {
        match self {
            Self::Smooth(sections) => sections.len().saturating_sub(1) / 2,
            Self::Slices(sections) => sections.len() * self.steps_per_slice(),
        }
    }

    fn steps_per_slice(&self) -> usize {
        match self {
            Self::Smooth(_) => 1,
            Self::Slices(sections) => LEAST_STEPS.div_ceil(sections.len().max(1)),
        }
    }

    /// Mean of `1/B` along the strip, 1/(N mm^2).
    pub(super) fn mean_flexibility(&self) -> f64 {
        let (Self::Smooth(sections) | Self::Slices(sections)) = self;
        sections.iter().map(|s| 1.0 / s.stiffness).sum::<f64>() / sections.len().max(1) as f64
    }

    fn largest(&self) -> f64 {
        let (Self::Smooth(sections) | Self::Slices(sections)) = self;
        sections.iter().fold(0.0, |m, s| m.max(s.stiffness))
    }

    /// The sections at the start, middle and end of a step.
    fn sections(&self, step: usize) -> [Section; 3] {
        match self {
            Self::Smooth(sections) => [sections[2 * step], sections[2 * step + 1], sections[2 * step + 2]],
            Self::Slices(sections) => [sections[step / self.steps_per_slice()]; 3],
        }
    }
}

/// What is prescribed at the two ends. The rim's mid-line point is the origin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EndConditions {
    /// Inclination at the rim, rad.
    pub rim_angle: f64,
    /// Inclination at the hub, rad.
    pub hub_angle: f64,
    /// Horizontal distance of the hub from the rim, mm.
    pub span: f64,
    /// Height of the hub, mm; `None` where no vertical force acts (`V = 0`).
    pub height: Option<f64>,
}

/// Forces that one strip carries: `M_0` in N mm, `H` and `V` in N.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct EndForces {
    /// Moment at the rim, N mm.
    pub rim_moment: f64,
    /// Horizontal force, N; positive when the seat pushes the rim inward.
    pub horizontal: f64,
    /// Vertical force, N; positive when the hub is pushed up.
    pub vertical: f64,
}

impl EndForces {
    /// Moment about a point of the mid-line, N mm.
    #[must_use]
    pub fn moment(&self, x: f64, z: f64) -> f64 {
        self.rim_moment - self.horizontal * z - self.vertical * x
    }
}

/// A strip in equilibrium: the state at the ends of all integration steps, rim first.
#[derive(Debug, Clone)]
pub struct Equilibrium {
    /// Flat arc length, mm.
    pub s: Vec<f64>,
    /// Inclination, rad.
    pub inclination: Vec<f64>,
    /// Horizontal distance from the rim, mm.
    pub x: Vec<f64>,
    /// Height above the rim, mm.
    pub z: Vec<f64>,
    /// The forces that hold it.
    pub forces: EndForces,
    /// Newton iterations spent.
    pub iterations: usize,
}

impl Equilibrium {
    /// Inclination at arc length `s`, linear between steps, rad.
    #[must_use]
    pub fn inclination_at(&self, s: f64) -> f64 {
        let last = self.s.len() - 1;
        if last == 0 {
            return self.inclination[0];
        }
        let at = (s / self.s[last] * last as f64).clamp(0.0, last as f64);
        let i = (at as usize).min(last - 1);
        self.inclination[i] + (at - i as f64) * (self.inclination[i + 1] - self.inclination[i])
    }

    /// Mid-line position at arc length `s`, by cubic Hermite interpolation between steps.
    #[must_use]
    pub fn position(&self, s: f64) -> [f64; 2] {
        let last = self.s.len() - 1;
        if last == 0 {
            return [self.x[0], self.z[0]];
        }
        let step = self.s[last] / last as f64;
        let i = ((s / step).floor().max(0.0) as usize).min(last - 1);
        let u = ((s - self.s[i]) / step).clamp(0.0, 1.0);
        let hermite = |p0: f64, p1: f64, d0: f64, d1: f64| {
            let (a, b) = (u * u * (3.0 - 2.0 * u), u * (1.0 - u));
            p0 + a * (p1 - p0) + step * b * ((1.0 - u) * d0 - u * d1)
        };
        // Chord over flat length: the mid-line stretches where the neutral axis is off mid-plane.
        let chord = (self.x[i + 1] - self.x[i]).hypot(self.z[i + 1] - self.z[i]);
        let half_turn = 0.5 * (self.inclination[i + 1] - self.inclination[i]);
        let sinc = if half_turn.abs() < 1e-6 { 1.0 } else { half_turn.sin() / half_turn };
        let stretch = chord / (step * sinc);
        let (sin0, cos0) = self.inclination[i].sin_cos();
        let (sin1, cos1) = self.inclination[i + 1].sin_cos();
        [
            hermite(self.x[i], self.x[i + 1], stretch * cos0, stretch * cos1),
            hermite(self.z[i], self.z[i + 1], stretch * sin0, stretch * sin1),
        ]
    }
}

/// Residual below which an equilibrium counts as found, as a share of the length (and in rad).
const TOLERANCE: f64 = 1e-11;
const MAX_ITERATIONS: usize = 60;

/// Pieces of the multiple shooting.
const SEGMENTS: usize = 24;

/// Finds the equilibrium of a strip of arc length `length_mm`, starting Newton's method from the shape and the forces of
/// `guess`, which may be sampled differently.
///
/// # Errors
/// [`ElasticaError::NoEquilibrium`] where Newton's method does not get there from that guess.
pub fn solve(
    stiffness: &StripStiffness,
    length_mm: f64,
    ends: &EndConditions,
    guess: &Equilibrium,
) -> Result<Equilibrium, ElasticaError> {
    let shooting = Shooting::new(stiffness, length_mm, ends);
    let mut unknowns = shooting.first_guess(guess);
    let mut linearisation = shooting.linearise(&unknowns);
    let mut iterations = 0;
    let failure = |iterations, error: f64| ElasticaError::NoEquilibrium {
        fraction: 1.0,
        iterations,
        residual_mm: error * length_mm,
    };
    while linearisation.error.is_nan() || linearisation.error > TOLERANCE {
        let error = linearisation.error;
        let Some(step) = linearisation.newton_step().filter(|_| iterations < MAX_ITERATIONS) else {
            return Err(failure(iterations, error));
        };
        iterations += 1;
        let mut share = 1.0;
        loop {
            let candidate = unknowns.moved(&step, share);
            let next = shooting.linearise(&candidate);
            if next.error < error {
                (unknowns, linearisation) = (candidate, next);
                break;
            }
            share *= 0.5;
            if share < 1e-6 {
                // Close to the solution rounding decides whether the residual still falls.
                if error <= 1e3 * TOLERANCE {
                    return Ok(shooting.path(&unknowns, iterations));
                }
                return Err(failure(iterations, error));
            }
        }
    }
    Ok(shooting.path(&unknowns, iterations))
}

/// Multiple shooting: the strip is cut into segments whose start states are unknowns of their own, so that a good first
/// shape is used along the whole strip and errors do not grow from one end to the other. The linear systems are condensed
/// onto the three force unknowns.
struct Shooting<'a> {
    stiffness: &'a StripStiffness,
    length: f64,
    ends: &'a EndConditions,
    /// First step of every segment, and the end.
    bounds: Vec<usize>,
    /// Units of the unknowns `(M_0, H, V)`: `B/L`, `B/L^2`, `B/L^2`.
    units: Vector3<f64>,
}

/// Force unknowns in their units, and `(x/L, z/L, theta)` at the segments' starts.
#[derive(Clone)]
struct Unknowns {
    forces: Vector3<f64>,
    starts: Vec<Vector3<f64>>,
}

impl Unknowns {
    fn moved(&self, step: &Self, share: f64) -> Self {
        Self {
            forces: self.forces + step.forces * share,
            starts: self.starts.iter().zip(&step.starts).map(|(a, b)| a + b * share).collect(),
        }
    }
}

/// End state of one segment and its derivatives with respect to the forces and the start state.
struct Segment {
    end: Vector3<f64>,
    by_forces: Matrix3<f64>,
    by_start: Matrix3<f64>,
}

struct Linearisation {
    segments: Vec<Segment>,
    /// Gaps between segments.
    defects: Vec<Vector3<f64>>,
    /// Residual at the hub, and its derivatives with respect to the end state and the forces.
    residual: Vector3<f64>,
    by_end: Matrix3<f64>,
    by_forces: Matrix3<f64>,
    /// Euclidean norm of all of them.
    error: f64,
}

impl<'a> Shooting<'a> {
    fn new(stiffness: &'a StripStiffness, length: f64, ends: &'a EndConditions) -> Self {
        let steps = stiffness.steps();
        let count = SEGMENTS.min(steps.max(1));
        let reference = stiffness.largest().max(f64::MIN_POSITIVE);
        Self {
            stiffness,
            length,
            ends,
            bounds: (0..=count).map(|i| i * steps / count).collect(),
            units: Vector3::new(reference / length, reference / length.powi(2), reference / length.powi(2)),
        }
    }

    fn first_guess(&self, guess: &Equilibrium) -> Unknowns {
        let forces = &guess.forces;
        let values = Vector3::new(forces.rim_moment, forces.horizontal, forces.vertical);
        let steps = self.stiffness.steps().max(1) as f64;
        let mut starts: Vec<Vector3<f64>> =
            self.bounds[..self.bounds.len() - 1].iter().map(|&b| self.sample(guess, b as f64 / steps)).collect();
        starts[0] = Vector3::new(0.0, 0.0, self.ends.rim_angle);
        Unknowns { forces: values.component_div(&self.units), starts }
    }

    fn sample(&self, guess: &Equilibrium, share: f64) -> Vector3<f64> {
        let last = guess.s.len() - 1;
        let at = share * last as f64;
        let i = (at as usize).min(last.saturating_sub(1));
        let u = at - i as f64;
        let blend = |v: &[f64]| v[i] + u * (v[(i + 1).min(last)] - v[i]);
        Vector3::new(blend(&guess.x) / self.length, blend(&guess.z) / self.length, blend(&guess.inclination))
    }

    fn linearise(&self, unknowns: &Unknowns) -> Linearisation {
        let forces = unknowns.forces.component_mul(&self.units);
        let segments: Vec<Segment> = unknowns
            .starts
            .iter()
            .zip(self.bounds.windows(2))
            .map(|(start, bounds)| self.shoot(start, bounds[0]..bounds[1], &forces))
            .collect();
        let defects: Vec<Vector3<f64>> =
            segments.iter().zip(&unknowns.starts[1..]).map(|(segment, next)| segment.end - next).collect();
        let end = segments.last().map_or_else(Vector3::zeros, |s| s.end);
        let mut residual = Vector3::new(end[0] - self.ends.span / self.length, 0.0, end[2] - self.ends.hub_angle);
        let (mut by_end, mut by_forces) = (Matrix3::identity(), Matrix3::zeros());
        match self.ends.height {
            Some(height) => residual[1] = end[1] - height / self.length,
            None => {
                residual[1] = unknowns.forces[2];
                by_end[(1, 1)] = 0.0;
                by_forces[(1, 2)] = 1.0;
            }
        }
        let error = (residual.norm_squared() + defects.iter().map(Vector3::norm_squared).sum::<f64>()).sqrt();
        Linearisation { segments, defects, residual, by_end, by_forces, error }
    }

    fn shoot(&self, start: &Vector3<f64>, steps: std::ops::Range<usize>, forces: &Vector3<f64>) -> Segment {
        let mut state: State = [0.0; 21];
        state[0] = start[0] * self.length;
        state[1] = start[1] * self.length;
        state[2] = start[2];
        // Columns 0 to 2: derivatives by the forces; columns 3 to 5: by the start state.
        for k in 0..3 {
            state[3 + 3 * (3 + k) + k] = if k < 2 { self.length } else { 1.0 };
        }
        let end = self.integrate(state, steps, forces, |_| {});
        let column = |k: usize, unit: f64| {
            let c = &end[3 + 3 * k..6 + 3 * k];
            Vector3::new(c[0] / self.length, c[1] / self.length, c[2]) * unit
        };
        Segment {
            end: Vector3::new(end[0] / self.length, end[1] / self.length, end[2]),
            by_forces: Matrix3::from_columns(&[0, 1, 2].map(|k| column(k, self.units[k]))),
            by_start: Matrix3::from_columns(&[3, 4, 5].map(|k| column(k, 1.0))),
        }
    }

    /// Integrates over some steps, calling `visit` after every one.
    fn integrate(
        &self,
        mut state: State,
        steps: std::ops::Range<usize>,
        forces: &Vector3<f64>,
        mut visit: impl FnMut(&State),
    ) -> State {
        let h = self.length / self.stiffness.steps().max(1) as f64;
        for i in steps {
            let [start, middle, end] = self.stiffness.sections(i);
            let k1 = rates(&state, &start, forces);
            let k2 = rates(&shifted(&state, &k1, 0.5 * h), &middle, forces);
            let k3 = rates(&shifted(&state, &k2, 0.5 * h), &middle, forces);
            let k4 = rates(&shifted(&state, &k3, h), &end, forces);
            for (j, value) in state.iter_mut().enumerate() {
                *value += h / 6.0 * (k1[j] + 2.0 * (k2[j] + k3[j]) + k4[j]);
            }
            visit(&state);
        }
        state
    }

    fn path(&self, unknowns: &Unknowns, iterations: usize) -> Equilibrium {
        let steps = self.stiffness.steps();
        let forces = unknowns.forces.component_mul(&self.units);
        let mut path = Equilibrium {
            s: (0..=steps).map(|i| self.length * i as f64 / steps as f64).collect(),
            inclination: Vec::with_capacity(steps + 1),
            x: Vec::with_capacity(steps + 1),
            z: Vec::with_capacity(steps + 1),
            forces: EndForces { rim_moment: forces[0], horizontal: forces[1], vertical: forces[2] },
            iterations,
        };
        let mut push = |state: &State| {
            path.x.push(state[0]);
            path.z.push(state[1]);
            path.inclination.push(state[2]);
        };
        let mut state: State = [0.0; 21];
        state[2] = self.ends.rim_angle;
        push(&state);
        for (start, bounds) in unknowns.starts.iter().zip(self.bounds.windows(2)) {
            (state[0], state[1], state[2]) = (start[0] * self.length, start[1] * self.length, start[2]);
            self.integrate(state, bounds[0]..bounds[1], &forces, &mut push);
        }
        path
    }
}

impl Linearisation {
    /// The Newton step: start states expressed by the forces, segment after segment, then the hub's conditions.
    fn newton_step(&self) -> Option<Unknowns> {
        let (mut by_forces, mut constant) = (Matrix3::zeros(), Vector3::zeros());
        let mut condensed = vec![(by_forces, constant)];
        for (segment, defect) in self.segments.iter().zip(self.defects.iter().chain([&Vector3::zeros()])) {
            by_forces = segment.by_start * by_forces + segment.by_forces;
            constant = segment.by_start * constant + defect;
            condensed.push((by_forces, constant));
        }
        let matrix = self.by_end * by_forces + self.by_forces;
        let forces = matrix.lu().solve(&-(self.residual + self.by_end * constant))?;
        let starts: Vec<Vector3<f64>> = condensed[..self.segments.len()]
            .iter()
            .map(|(by_forces, constant)| by_forces * forces + constant)
            .collect();
        let finite = forces.iter().chain(starts.iter().flatten()).all(|c| c.is_finite());
        finite.then_some(Unknowns { forces, starts })
    }
}

/// `(x, z, theta)` and six columns of their sensitivities.
type State = [f64; 21];

fn shifted(state: &State, rate: &State, h: f64) -> State {
    let mut moved = *state;
    for (value, r) in moved.iter_mut().zip(rate) {
        *value += h * r;
    }
    moved
}

/// Right-hand side of the equations and of their derivatives by `(M_0, H, V)` and by the start state.
fn rates(state: &State, section: &Section, forces: &Vector3<f64>) -> State {
    let [x, z, theta] = [state[0], state[1], state[2]];
    let (sin, cos) = theta.sin_cos();
    let offset = section.neutral_offset;
    let flexibility = 1.0 / section.stiffness;
    let (moment, horizontal, vertical) = (forces[0], forces[1], forces[2]);
    // Position of the neutral line, about which the moment is taken.
    let (xn, zn) = (x - offset * sin, z + offset * cos);
    let curvature = (moment - horizontal * zn - vertical * xn) * flexibility;
    let stretch = 1.0 + curvature * offset;
    let mut rate = [0.0; 21];
    rate[0] = stretch * cos;
    rate[1] = stretch * sin;
    rate[2] = curvature;
    let direct = [1.0, -zn, -xn, 0.0, 0.0, 0.0];
    for (k, direct) in direct.into_iter().enumerate() {
        let [dx, dz, dtheta] = [state[3 + 3 * k], state[4 + 3 * k], state[5 + 3 * k]];
        let (dxn, dzn) = (dx - offset * cos * dtheta, dz - offset * sin * dtheta);
        let dcurvature = (direct - horizontal * dzn - vertical * dxn) * flexibility;
        rate[3 + 3 * k] = dcurvature * offset * cos - stretch * sin * dtheta;
        rate[4 + 3 * k] = dcurvature * offset * sin + stretch * cos * dtheta;
        rate[5 + 3 * k] = dcurvature;
    }
    rate
}
