//! How the two ends of a spoke are moved, as a solver is told: final values and their course over the step's time.
//!
//! Time is the fraction of the morph. Along the target scaled by that fraction the strip needs the least force, so the
//! displacements follow this path and not a straight line; between the samples of an amplitude a solver interpolates
//! linearly.

use crate::design::Design;
use crate::elastica::morph::Guide;

/// Samples of an amplitude.
const SAMPLES: usize = 41;
/// Samples of an amplitude in explicit dynamics, which feels its kinks.
const SMOOTH_SAMPLES: usize = 201;
/// Stretch of a strip that is not pushed together.
pub(crate) const STRETCH: f64 = 0.01;

/// How fast the morph goes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Pace {
    /// Time is the fraction of the morph.
    Fraction,
    /// In a time, s, from rest to rest: the fraction is `10 x^3 - 15 x^4 + 6 x^5` of the share `x` of it.
    Smooth(f64),
}

impl Pace {
    /// Time and fraction of the morph at a share of the samples.
    fn at(self, share: f64) -> [f64; 2] {
        match self {
            Self::Fraction => [share, share],
            Self::Smooth(duration) => [duration * share, share * share * share * (10.0 + share * (6.0 * share - 15.0))],
        }
    }

    fn samples(self) -> usize {
        match self {
            Self::Fraction => SAMPLES,
            Self::Smooth(_) => SMOOTH_SAMPLES,
        }
    }
}

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
    fn new(amplitude: &'static str, pace: Pace, at: impl Fn(f64) -> f64) -> Self {
        let last = pace.samples() - 1;
        let (times, values): (Vec<f64>, Vec<f64>) =
            (0..=last).map(|i| pace.at(i as f64 / last as f64)).map(|[time, fraction]| (time, at(fraction))).unzip();
        let largest = values.iter().fold(0.0_f64, |m, v| if v.abs() > m.abs() { *v } else { m });
        let last = values[last];
        let value = if last.abs() < 1e-6 * largest.abs() { largest } else { last };
        if value.abs() < 1e-12 {
            return Self { amplitude, value: 0.0, course: Vec::new() };
        }
        let course = times.iter().zip(&values).map(|(t, v)| [*t, v / value]).collect();
        Self { amplitude, value, course }
    }

    /// The hub going down by `depth` in `duration`, from rest to rest: its velocity, or its height where it starts at one.
    pub(crate) fn pressing(duration: f64, depth: f64, start: Option<f64>) -> Self {
        let pace = Pace::Smooth(duration);
        let Some(start) = start else {
            // The derivative of the smooth pace.
            let course = (0..SMOOTH_SAMPLES)
                .map(|i| i as f64 / (SMOOTH_SAMPLES - 1) as f64)
                .map(|x| [duration * x, 30.0 * (x * (1.0 - x)).powi(2)])
                .collect();
            return Self { amplitude: "PRESS", value: -depth / duration, course };
        };
        // It must not begin at zero: a jump would be ignored, and the depth with it.
        let course = (0..SMOOTH_SAMPLES)
            .map(|i| pace.at(i as f64 / (SMOOTH_SAMPLES - 1) as f64))
            .map(|[time, share]| [time, 1.0 - share * depth / start])
            .collect();
        Self { amplitude: "PRESS", value: start, course }
    }

    /// The value at the end.
    pub(crate) fn last(&self) -> f64 {
        self.course.last().map_or(0.0, |[_, share]| share * self.value)
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
    /// The schedule of a design; time is the fraction of the morph.
    pub(crate) fn of(design: &Design) -> Self {
        Self::paced(design, Pace::Fraction)
    }

    /// The schedule of a design at a pace.
    pub(crate) fn paced(design: &Design, pace: Pace) -> Self {
        let length = design.input().strips.length_mm;
        let Some(guide) = design.guide() else {
            return Self {
                rim_travel: Motion::new("RIM-TRAVEL", pace, |t| -STRETCH * length * t),
                rim_rotation: Motion::new("RIM-ROTATION", pace, |_| 0.0),
                hub_rotation: Motion::new("HUB-ROTATION", pace, |_| 0.0),
                hub_height: Some(Motion::new("HUB-HEIGHT", pace, |_| 0.0)),
                description: "the strip is stretched by 1 % of its length, both ends rigid and level",
            };
        };
        let held = guide.ends(1.0).height.is_some();
        Self {
            rim_travel: Motion::new(
                "RIM-TRAVEL",
                pace,
                |t| if t == 0.0 { 0.0 } else { length - guide.hub_position(t)[0] },
            ),
            rim_rotation: Motion::new("RIM-ROTATION", pace, |t| -guide.ends(t).rim_angle),
            hub_rotation: Motion::new("HUB-ROTATION", pace, |t| -guide.ends(t).hub_angle),
            hub_height: held.then(|| Motion::new("HUB-HEIGHT", pace, |t| guide.hub_position(t)[1])),
            description: match (guide, held) {
                (Guide::Target { .. }, true) if pace != Pace::Fraction => {
                    "the morph, hub held at its height, from rest to rest along the target's shares"
                }
                (Guide::Target { .. }, false) if pace != Pace::Fraction => {
                    "the morph, hub free to rise, from rest to rest along the target's shares"
                }
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
