//! How a morphed dome is pressed, as the decks tell it: depth, indenter, times.
//!
//! The indenter is a flat rigid plate that moves with the hub from the start, so that it need not be found after the morph.
//! It begins over the highest point of what it covers in the closed dome, a little above it. Its edge is straight across
//! each spoke, at the indenter's radius from the axis.

use super::number::real;
use crate::design::Design;
use crate::elastica::morph::Guide;
use crate::indentation::Press;
use crate::input::IndentationInput;

/// Gap between the plate and what it covers, as a share of the thickness: nothing touches before the dome is pressed.
const GAP: f64 = 0.0025;

/// How far beyond the plate's edge the spoke's face may come into contact, as a share of the covered arc.
const BEYOND: f64 = 0.5;

/// The parameters of a design.
pub(crate) fn parameters(design: &Design) -> IndentationInput {
    design.input().indentation.clone().unwrap_or_default()
}

/// A dome about to be pressed.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Pressing {
    /// The design's parameters.
    pub input: IndentationInput,
    /// How far the hub goes down, mm.
    pub depth_mm: f64,
    /// The plate, where one reaches beyond the hub.
    pub plate: Option<Plate>,
    /// Height of the hub when the dome is closed, mm above the rim.
    pub hub_height_mm: f64,
    /// Height of the dome, mm.
    pub height_mm: f64,
    /// Whether the morph holds the hub at that height.
    pub held: bool,
    /// Largest share of its length that a spoke's rim travels.
    pub travel: f64,
}

/// The plate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Plate {
    /// Distance of its edge from the dome's axis, mm.
    pub radius_mm: f64,
    /// Distance of its edge from the hub's, mm.
    pub reach_mm: f64,
    /// Its lower face above the mid-surface of the hub, mm.
    pub height_mm: f64,
    /// Length of spoke, from the hub, that may touch it, mm.
    pub contact_mm: f64,
}

impl Pressing {
    /// The pressing of a design whose spokes touch the plate `face_mm` above their mid-surface.
    ///
    /// # Errors
    /// Why the design cannot be pressed.
    pub(crate) fn new(design: &Design, input: IndentationInput, face_mm: f64) -> Result<Self, &'static str> {
        let press =
            Press::new(design, &input).map_err(|_| "the dome cannot be pressed as deep as indentation.depth_mm")?;
        let guide = design.guide().ok_or("there is no dome to press")?;
        let length = design.input().strips.length_mm;
        let [span, height] = guide.hub_position(1.0);
        let radius = press.radius_mm.filter(|radius| *radius > design.input().hub_radius());
        Ok(Self {
            depth_mm: press.depth_mm,
            plate: radius.map(|radius| Plate::over(design, radius, face_mm)),
            hub_height_mm: height,
            height_mm: press.height_mm,
            held: guide.ends(1.0).height.is_some(),
            travel: Self::largest_travel(guide, length).max(1.0 - span / length),
            input,
        })
    }

    fn largest_travel(guide: &Guide, length: f64) -> f64 {
        (1..=20)
            .map(|i| 1.0 - guide.hub_position(f64::from(i) / 20.0)[0] / length)
            .fold(0.0, |most, t| most.max(t.abs()))
    }

    /// Share of the time that an increment takes.
    pub(crate) fn increment(&self) -> f64 {
        1.0 / self.input.steps as f64
    }

    /// Time in which spokes that travel at the loading rate take their shape, s.
    pub(crate) fn morph_time_s(&self) -> f64 {
        self.travel / self.input.loading_rate_per_s
    }

    /// Time in which the dome loses height at the loading rate, s.
    pub(crate) fn press_time_s(&self) -> f64 {
        self.depth_mm / self.height_mm / self.input.loading_rate_per_s
    }

    /// What the heading says. A free hub may go down from where the solver's morph leaves it, or to the designed height less
    /// the depth; `from_design` says which.
    pub(crate) fn paragraph(&self, from_design: bool) -> String {
        let depth = real(self.depth_mm);
        let from = if from_design && !self.held { " below its designed height" } else { "" };
        let plate = self.plate.map_or_else(
            || "; no plate reaches beyond it.".to_owned(),
            |plate| {
                format!(
                    " and takes a flat rigid plate with it, without friction, whose edge is {} mm from the axis and straight \
                     across each spoke. Its lower face is {} mm above the mid-surface of the hub, a little above the highest \
                     point of what it covers.",
                    real(plate.radius_mm),
                    real(plate.height_mm)
                )
            },
        );
        format!("Indentation: after the morph the hub goes down by {depth} mm{from}{plate}")
    }
}

impl Plate {
    fn over(design: &Design, radius_mm: f64, face_mm: f64) -> Self {
        let (profile, strips) = (design.profile(), &design.input().strips);
        let hub = profile.z.last().copied().unwrap_or(0.0);
        let covered = (0..profile.s.len()).filter(|i| profile.rho[*i] <= radius_mm);
        // Heights above the hub's mid-surface; the hub itself is level.
        let face = |i: usize| profile.z[i] - hub + face_mm * profile.inclination[i].cos();
        let highest = covered.clone().map(face).fold(face_mm, f64::max);
        let arc = covered.map(|i| strips.length_mm - profile.s[i]).fold(0.0, f64::max);
        Self {
            radius_mm,
            reach_mm: radius_mm - design.input().hub_radius(),
            height_mm: highest + GAP * strips.thickness_mm,
            contact_mm: ((1.0 + BEYOND) * arc).min(strips.length_mm),
        }
    }
}
