//! How the two ends of a spoke are moved, as a solver is told: final values and their course over the step's time.
//!
//! Time is the fraction of the morph. Along the target scaled by that fraction the strip needs the least force, so the
//! displacements follow this path and not a straight line; between the samples of an amplitude a solver interpolates
//! linearly.

use crate::design::Design;
use crate::elastica::morph::Guide;

/// Samples of an amplitude.
const SAMPLES: usize = 41;
/// Stretch of a strip that is not pushed together.
pub(crate) const STRETCH: f64 = 0.01;

/// One prescribed motion.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Motion {
    /// Name of its amplitude.
    pub amplitude: &'static str,
    /// Value by which the amplitude is multiplied: the final one, unless the motion ends where it began.
    pub value: f64,
    /// Time and value relative to `value`; empty where nothing moves.
    pub course: Vec<[f64; 2]>,
}

impl Motion {
    fn new(amplitude: &'static str, at: impl Fn(f64) -> f64) -> Self {
        let times: Vec<f64> = (0..SAMPLES).map(|i| i as f64 / (SAMPLES - 1) as f64).collect();
        let values: Vec<f64> = times.iter().map(|t| at(*t)).collect();
        let largest = values.iter().fold(0.0_f64, |m, v| if v.abs() > m.abs() { *v } else { m });
        let last = values[SAMPLES - 1];
        let value = if last.abs() < 1e-6 * largest.abs() { largest } else { last };
        if value.abs() < 1e-12 {
            return Self { amplitude, value: 0.0, course: Vec::new() };
        }
        let course = times.iter().zip(&values).map(|(t, v)| [*t, v / value]).collect();
        Self { amplitude, value, course }
    }

    /// Whether anything moves.
    pub(crate) fn moves(&self) -> bool {
        !self.course.is_empty()
    }
}

/// The motion of both ends; what is not listed is held at zero, except the hub's height where `hub_height` is `None`.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Schedule {
    /// Displacement of the rim along x, mm: `L - span`.
    pub rim_travel: Motion,
    /// Rotation of the rim about y, rad: `-theta(0)`.
    pub rim_rotation: Motion,
    /// Rotation of the hub about y, rad: `-theta(L)`.
    pub hub_rotation: Motion,
    /// Displacement of the hub along z, mm; `None` where it is free.
    pub hub_height: Option<Motion>,
    /// What happens, for the heading.
    pub description: &'static str,
}

impl Schedule {
    /// The schedule of a design.
    pub(crate) fn of(design: &Design) -> Self {
        let length = design.input().strips.length_mm;
        let Some(guide) = design.guide() else {
            return Self {
                rim_travel: Motion::new("RIM-TRAVEL", |t| -STRETCH * length * t),
                rim_rotation: Motion::new("RIM-ROTATION", |_| 0.0),
                hub_rotation: Motion::new("HUB-ROTATION", |_| 0.0),
                hub_height: Some(Motion::new("HUB-HEIGHT", |_| 0.0)),
                description: "the strip is stretched by 1 % of its length, both ends rigid and level",
            };
        };
        let held = guide.ends(1.0).height.is_some();
        Self {
            rim_travel: Motion::new("RIM-TRAVEL", |t| if t == 0.0 { 0.0 } else { length - guide.hub_position(t)[0] }),
            rim_rotation: Motion::new("RIM-ROTATION", |t| -guide.ends(t).rim_angle),
            hub_rotation: Motion::new("HUB-ROTATION", |t| -guide.ends(t).hub_angle),
            hub_height: held.then(|| Motion::new("HUB-HEIGHT", |t| guide.hub_position(t)[1])),
            description: match (guide, held) {
                (Guide::Clamped { .. }, _) => {
                    "level ends are pushed together; time squared is the share of the shortening"
                }
                (_, true) => "the morph, hub held at its height; time is the share of the target's inclination",
                (_, false) => "the morph, hub free to rise; time is the share of the target's inclination",
            },
        }
    }

    /// The motions in the order in which their amplitudes are written.
    pub(crate) fn motions(&self) -> impl Iterator<Item = &Motion> {
        [Some(&self.rim_travel), Some(&self.rim_rotation), Some(&self.hub_rotation), self.hub_height.as_ref()]
            .into_iter()
            .flatten()
    }
}
