//! The way from the flat strip to its final shape.
//!
//! A dome's ends are guided along the target scaled by `lambda` in `[0, 1]`: the end inclinations are
//! `lambda theta(0)` and `lambda theta(L)`, the span is `int cos(lambda theta) ds`, and a held hub is at
//! `int sin(lambda theta) ds`. The strip in between takes its own equilibrium, which at `lambda = 1` is the target.
//! A clamped strip keeps level ends and is shortened by `lambda^2` of its final shortening, so that its height grows
//! about linearly.

use std::f64::consts::PI;

use super::forward::{EndConditions, EndForces, Equilibrium, StripStiffness, solve};
use super::{ElasticaError, HubSupport};
use crate::target::MeridianPoint;

/// Below this fraction the shape is taken proportional to the one here: it is the linear regime, and the equations
/// degenerate at zero.
const LINEAR_FRACTION: f64 = 1e-3;

/// How the ends of a strip are moved.
#[derive(Debug, Clone)]
pub enum Guide {
    /// The ends follow the target's inclination scaled by the fraction; evenly spaced stations, rim first, an odd
    /// number of them.
    Target {
        /// The target.
        stations: Vec<MeridianPoint>,
        /// Whether the hub's height is prescribed as well.
        support: HubSupport,
    },
    /// Level ends at one height, pushed together.
    Clamped {
        /// Arc length, mm.
        length_mm: f64,
        /// Final shortening as a share of the length.
        shortening: f64,
    },
}

impl Guide {
    /// Arc length of the strip, mm.
    #[must_use]
    pub fn length(&self) -> f64 {
        match self {
            Self::Target { stations, .. } => stations.last().map_or(0.0, |p| p.s),
            Self::Clamped { length_mm, .. } => *length_mm,
        }
    }

    /// Horizontal distance and height of the hub end at a fraction of the morph, mm.
    #[must_use]
    pub fn hub_position(&self, fraction: f64) -> [f64; 2] {
        match self {
            Self::Target { stations, .. } => {
                if fraction == 1.0 {
                    return stations.last().map_or([0.0; 2], |p| [p.x, p.z]);
                }
                simpson(stations, |p| {
                    let (sin, cos) = (fraction * p.inclination).sin_cos();
                    [cos, sin]
                })
            }
            Self::Clamped { length_mm, shortening } => [length_mm * (1.0 - shortening * fraction * fraction), 0.0],
        }
    }

    /// The target with its inclination scaled by the fraction; of clamped ends the straight line between them.
    #[must_use]
    pub fn scaled_shape(&self, fraction: f64) -> Equilibrium {
        match self {
            Self::Target { stations, .. } => on_target(stations, fraction, EndForces::default()),
            Self::Clamped { length_mm, .. } => {
                let share = self.hub_position(fraction)[0] / length_mm;
                Equilibrium {
                    s: vec![0.0, *length_mm],
                    inclination: vec![0.0; 2],
                    x: vec![0.0, share * length_mm],
                    z: vec![0.0; 2],
                    forces: EndForces::default(),
                    iterations: 0,
                }
            }
        }
    }

    /// Conditions at both ends at a fraction of the morph.
    #[must_use]
    pub fn ends(&self, fraction: f64) -> EndConditions {
        let [span, height] = self.hub_position(fraction);
        match self {
            Self::Target { stations, support } => EndConditions {
                rim_angle: fraction * stations.first().map_or(0.0, |p| p.inclination),
                hub_angle: fraction * stations.last().map_or(0.0, |p| p.inclination),
                span,
                height: (*support == HubSupport::Held).then_some(height),
            },
            Self::Clamped { .. } => EndConditions { rim_angle: 0.0, hub_angle: 0.0, span, height: Some(height) },
        }
    }
}

/// Composite Simpson rule over evenly spaced stations.
fn simpson(stations: &[MeridianPoint], f: impl Fn(&MeridianPoint) -> [f64; 2]) -> [f64; 2] {
    let last = stations.len().saturating_sub(1);
    let step = stations.last().map_or(0.0, |p| p.s) / last.max(1) as f64;
    let mut sum = [0.0; 2];
    for (i, point) in stations.iter().enumerate() {
        let weight = if i == 0 || i == last { 1.0 } else { 2.0 + 2.0 * (i % 2) as f64 };
        let value = f(point);
        sum[0] += weight * value[0];
        sum[1] += weight * value[1];
    }
    sum.map(|s| s * step / 3.0)
}

/// A strip on its way from flat to its final shape.
#[derive(Debug, Clone)]
pub struct MorphPath {
    stiffness: StripStiffness,
    guide: Guide,
    last: Equilibrium,
}

impl MorphPath {
    /// Solves the final shape. `guess` are the forces expected there (the inverse problem gives them); a clamped strip
    /// needs none, since it starts from its buckling mode.
    ///
    /// # Errors
    /// [`ElasticaError::NoEquilibrium`] where the final shape is not found.
    pub fn new(stiffness: StripStiffness, guide: Guide, guess: EndForces) -> Result<Self, ElasticaError> {
        let last = match &guide {
            Guide::Target { stations, .. } => {
                solve(&stiffness, guide.length(), &guide.ends(1.0), &on_target(stations, 1.0, guess))?
            }
            Guide::Clamped { .. } => {
                let start = 0.1;
                let mode = buckling_mode(&stiffness, &guide, start);
                let first = solve(&stiffness, guide.length(), &guide.ends(start), &mode)?;
                follow(&stiffness, &guide, start, first, 1.0)?
            }
        };
        Ok(Self { stiffness, guide, last })
    }

    /// The shape at the end of the morph.
    #[must_use]
    pub fn final_shape(&self) -> &Equilibrium {
        &self.last
    }

    /// How the ends are moved.
    #[must_use]
    pub fn guide(&self) -> &Guide {
        &self.guide
    }

    /// The equilibrium at a fraction of the morph, clamped to `[0, 1]`.
    ///
    /// # Errors
    /// [`ElasticaError::NoEquilibrium`] where the path could not be followed.
    pub fn at(&self, fraction: f64) -> Result<Equilibrium, ElasticaError> {
        let fraction = if fraction.is_finite() { fraction.clamp(0.0, 1.0) } else { 1.0 };
        if fraction == 1.0 {
            return Ok(self.last.clone());
        }
        let solved = fraction.max(LINEAR_FRACTION);
        let shape = self.solve_at(solved)?;
        Ok(if fraction < solved { linear(&shape, fraction / solved) } else { shape })
    }

    fn solve_at(&self, fraction: f64) -> Result<Equilibrium, ElasticaError> {
        let length = self.guide.length();
        let forces = scaled(&self.last.forces, fraction);
        let guess = match &self.guide {
            Guide::Target { stations, .. } => on_target(stations, fraction, forces),
            Guide::Clamped { .. } => turned(&self.last, fraction, forces),
        };
        solve(&self.stiffness, length, &self.guide.ends(fraction), &guess)
            .or_else(|_| follow(&self.stiffness, &self.guide, 1.0, self.last.clone(), fraction))
    }
}

/// Forces at a fraction of the morph, guessed from those at the end of it.
fn scaled(forces: &EndForces, fraction: f64) -> EndForces {
    EndForces {
        rim_moment: forces.rim_moment * fraction,
        horizontal: forces.horizontal,
        vertical: forces.vertical * fraction,
    }
}

/// A first shape: the target with all inclinations multiplied by `fraction`.
fn on_target(stations: &[MeridianPoint], fraction: f64, forces: EndForces) -> Equilibrium {
    let s = stations.iter().map(|p| p.s).collect();
    from_inclinations(s, stations.iter().map(|p| p.inclination * fraction).collect(), forces)
}

/// A first shape: a known one with all inclinations multiplied by `fraction`.
fn turned(shape: &Equilibrium, fraction: f64, forces: EndForces) -> Equilibrium {
    from_inclinations(shape.s.clone(), shape.inclination.iter().map(|t| t * fraction).collect(), forces)
}

/// Positions by the trapezoidal rule: good enough to start from.
fn from_inclinations(s: Vec<f64>, inclination: Vec<f64>, forces: EndForces) -> Equilibrium {
    let (mut x, mut z) = (vec![0.0; s.len()], vec![0.0; s.len()]);
    for i in 1..s.len() {
        let (step, middle) = (s[i] - s[i - 1], 0.5 * (inclination[i] + inclination[i - 1]));
        x[i] = x[i - 1] + step * middle.cos();
        z[i] = z[i - 1] + step * middle.sin();
    }
    Equilibrium { s, inclination, x, z, forces, iterations: 0 }
}

/// Follows the path from a known equilibrium to another fraction, halving the step where Newton's method fails.
fn follow(
    stiffness: &StripStiffness,
    guide: &Guide,
    from: f64,
    start: Equilibrium,
    to: f64,
) -> Result<Equilibrium, ElasticaError> {
    let (mut at, mut shape, mut step) = (from, start, (to - from) / 8.0);
    while at != to {
        let next = if (to - at).abs() <= step.abs() * 1.000_001 { to } else { at + step };
        let guess = turned(&shape, next / at, scaled(&shape.forces, next / at));
        match solve(stiffness, guide.length(), &guide.ends(next), &guess) {
            Ok(found) => (at, shape) = (next, found),
            Err(_) if step.abs() > 1e-4 => step *= 0.5,
            Err(ElasticaError::NoEquilibrium { iterations, residual_mm, .. }) => {
                return Err(ElasticaError::NoEquilibrium { fraction: next, iterations, residual_mm });
            }
            Err(other) => return Err(other),
        }
    }
    Ok(shape)
}

/// First shape of a clamped strip: `theta = A sin(2 pi s / L)`, whose shortening is `A^2 / 4`, held by the buckling load.
fn buckling_mode(stiffness: &StripStiffness, guide: &Guide, fraction: f64) -> Equilibrium {
    let flexibility = stiffness.mean_flexibility();
    let length = guide.length();
    let shortening = 1.0 - guide.hub_position(fraction)[0] / length;
    let amplitude = 2.0 * shortening.sqrt();
    let wave = 2.0 * PI / length;
    let forces =
        EndForces { rim_moment: amplitude * wave / flexibility, horizontal: wave * wave / flexibility, vertical: 0.0 };
    let s: Vec<f64> = (0..=200).map(|i| length * f64::from(i) / 200.0).collect();
    let inclination = s.iter().map(|s| amplitude * (wave * s).sin()).collect();
    from_inclinations(s, inclination, forces)
}

/// The shape at `share` of a small one: heights and inclinations scale linearly, shortenings quadratically.
fn linear(shape: &Equilibrium, share: f64) -> Equilibrium {
    Equilibrium {
        s: shape.s.clone(),
        inclination: shape.inclination.iter().map(|t| t * share).collect(),
        x: shape.s.iter().zip(&shape.x).map(|(s, x)| s - (s - x) * share * share).collect(),
        z: shape.z.iter().map(|z| z * share).collect(),
        forces: EndForces {
            rim_moment: shape.forces.rim_moment * share,
            horizontal: shape.forces.horizontal,
            vertical: shape.forces.vertical * share,
        },
        iterations: shape.iterations,
    }
}
