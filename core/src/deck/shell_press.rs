//! What pressing adds to a flower of shells: the indenter, contact, and the second step.
//!
//! The indenter and the hub are one rigid body, that of RP-HUB, so the indenter moves with the hub from the start and nothing
//! has to be found after the morph. It is a polygon of rigid quadrilaterals with one edge a spoke.

use super::DeckError;
use super::keywords::step::Increments;
use super::keywords::{boundary, contact, step};
use super::layout::Layout;
use super::number::real;
use super::pressing::Pressing;
use super::schedule::Motion;
use super::sink::Sink;
use crate::materials::Material;
use crate::mesh::{Flower, HubPlate};

/// Surfaces of the spokes' upper and the indenter's lower faces.
const SURFACES: [&str; 2] = ["SPOKES-UPPER", "INDENTER-LOWER"];

/// Elements of the indenter along each half of an edge: a rigid plane needs no more.
const DIVISIONS: usize = 4;

/// Pictures of the whole model in a step of explicit dynamics.
const PICTURES: u32 = 20;

/// How the equations of motion are solved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Procedure {
    /// A chain of equilibria, the indenter in contact with the spokes' upper faces.
    Standard,
    /// Explicit dynamics, everything in contact with everything.
    Explicit {
        /// Thickness of the spokes for contact, mm.
        thickness_mm: f64,
    },
}

impl Procedure {
    pub(super) fn is_explicit(self) -> bool {
        self != Self::Standard
    }
}

/// A flower about to be pressed.
pub(super) struct ShellPress {
    pub procedure: Procedure,
    pub pressing: Pressing,
    /// The indenter's mesh.
    pub plate: Option<HubPlate>,
}

impl ShellPress {
    pub(super) fn new(flower: Flower, procedure: Procedure, pressing: Pressing) -> Self {
        // In explicit dynamics the hub needs a mass, so there is a plate as large as the hub at least.
        let least = procedure.is_explicit().then_some(flower.hub_radius);
        let radius = pressing.plate.map(|plate| plate.radius_mm).or(least);
        let plate = radius.map(|hub_radius| HubPlate::new(Flower { hub_radius, ..flower }, DIVISIONS));
        Self { procedure, pressing, plate }
    }

    /// Height of the indenter above the flat flower's mid-surface, mm.
    pub(super) fn height_mm(&self) -> f64 {
        self.pressing.plate.map_or(0.0, |plate| plate.height_mm)
    }

    /// What the heading says.
    pub(super) fn paragraphs(&self) -> Vec<String> {
        let mut paragraphs = vec![self.pressing.paragraph(false)];
        paragraphs.push(
            "Results: while U3 of RP-HUB falls by the depth, RF3 there falls by the force of all spokes, the indenter's \
             included (INDENTER: its elements, which are one rigid body with the hub)."
                .to_owned(),
        );
        if let Procedure::Explicit { thickness_mm } = self.procedure {
            let (morph, press) = (self.pressing.morph_time_s(), self.pressing.press_time_s());
            paragraphs.push(format!(
                "Explicit dynamics: the morph takes {} s and pressing {} s, at {} of length and height a second; masses are \
                 multiplied by {}. Kinetic energy (ALLKE) must stay small beside strain energy (ALLSE). For contact, spokes \
                 are {} mm thick: ABAQUS would thin facets that are thicker than they are long.",
                real(morph),
                real(press),
                real(self.pressing.input.loading_rate_per_s),
                real(self.pressing.input.mass_scaling),
                real(thickness_mm)
            ));
        }
        paragraphs
    }

    /// The rigid body of the hub, with the indenter and, where the hub is modelled, its nodes.
    pub(super) fn hub(&self, sink: &mut Sink<'_>, nodes: Option<&str>, stiffest: &Material) -> Result<(), DeckError> {
        let nodes = nodes.map_or_else(String::new, |set| format!(", TIE NSET={set}"));
        if self.plate.is_none() {
            return if nodes.is_empty() { Ok(()) } else { sink.line(&format!("*RIGID BODY, REF NODE=RP-HUB{nodes}")) };
        }
        let mass = stiffest.density_tonne_mm3().filter(|_| self.procedure.is_explicit());
        let density = mass.map_or_else(String::new, |density| format!(", DENSITY={}", real(density)));
        sink.line(&format!("*RIGID BODY, REF NODE=RP-HUB, ELSET=INDENTER{nodes}{density}"))?;
        // The thickness that the density goes with.
        if mass.is_some() { sink.line("1.") } else { Ok(()) }
    }

    /// Surfaces in contact.
    pub(super) fn surfaces(&self, sink: &mut Sink<'_>, spokes: impl Iterator<Item = String>) -> Result<(), DeckError> {
        if self.pressing.plate.is_none() && !self.procedure.is_explicit() {
            return Ok(());
        }
        let spokes: Vec<String> = spokes.collect();
        contact::surface(sink, SURFACES[0], spokes.iter().map(String::as_str), "SPOS")?;
        contact::surface(sink, SURFACES[1], std::iter::once("INDENTER"), "SNEG")
    }

    /// Contact.
    pub(super) fn contact(&self, sink: &mut Sink<'_>) -> Result<(), DeckError> {
        match self.procedure {
            Procedure::Explicit { thickness_mm } => contact::general(sink, SURFACES[0], thickness_mm),
            Procedure::Standard if self.pressing.plate.is_some() => {
                contact::pair(sink, SURFACES, self.pressing.input.contact_stiffness_n_mm3)
            }
            Procedure::Standard => Ok(()),
        }
    }

    /// Opens the step of the morph.
    pub(super) fn open_morph(&self, sink: &mut Sink<'_>, layout: Layout) -> Result<(), DeckError> {
        match self.procedure {
            Procedure::Standard => step::open(sink, layout, "MORPH", Increments::MORPH),
            Procedure::Explicit { .. } => self.open_explicit(sink, "MORPH", self.pressing.morph_time_s()),
        }
    }

    fn open_explicit(&self, sink: &mut Sink<'_>, name: &str, time_s: f64) -> Result<(), DeckError> {
        step::open_explicit(sink, name, time_s)?;
        let factor = self.pressing.input.mass_scaling;
        // Scaled masses stay so in later steps.
        if factor > 1.0 && name == "MORPH" {
            sink.line(&format!("*FIXED MASS SCALING, FACTOR={}", real(factor)))
        } else {
            Ok(())
        }
    }

    /// Opens the step in which the hub goes down, and moves it. What held everything else in the morph goes on holding it.
    pub(super) fn open_press(&self, sink: &mut Sink<'_>, layout: Layout) -> Result<(), DeckError> {
        let pressing = &self.pressing;
        let increment = pressing.increment();
        match self.procedure {
            Procedure::Standard => {
                step::open(
                    sink,
                    layout,
                    "PRESS",
                    Increments { first: increment, most: increment, ..Increments::MORPH },
                )?;
            }
            Procedure::Explicit { .. } => self.open_explicit(sink, "PRESS", pressing.press_time_s())?,
        }
        match (self.motion(), pressing.held) {
            // Where the morph left a free hub is known to the solver only, so its velocity is prescribed.
            (None, false) => boundary::velocity(sink, "RP-HUB", 3, -pressing.depth_mm, None),
            (None, true) => boundary::place(sink, "RP-HUB", 3, pressing.hub_height_mm - pressing.depth_mm),
            (Some(motion), false) => boundary::velocity(sink, "RP-HUB", 3, motion.value, Some(motion.amplitude)),
            (Some(motion), true) => boundary::drive(sink, "RP-HUB", 3, &motion),
        }
    }

    /// The hub's course in explicit dynamics, from rest to rest: its velocity where the morph left it free, its height where
    /// it is held.
    pub(super) fn motion(&self) -> Option<Motion> {
        let Pressing { depth_mm, hub_height_mm, held, .. } = self.pressing;
        self.procedure
            .is_explicit()
            .then(|| Motion::pressing(self.pressing.press_time_s(), depth_mm, held.then_some(hub_height_mm)))
    }

    /// How often fields and histories are kept in a step that takes `time_s`.
    pub(super) fn often(&self, nodes: u64, time_s: f64) -> [String; 2] {
        match self.procedure {
            Procedure::Standard => super::keywords::output::every_increment(nodes),
            Procedure::Explicit { .. } => [
                format!("NUMBER INTERVAL={PICTURES}"),
                format!("TIME INTERVAL={}", real(time_s * self.pressing.increment())),
            ],
        }
    }

    /// Energies and the contact's force, over the step.
    pub(super) fn energies(&self, sink: &mut Sink<'_>) -> Result<(), DeckError> {
        sink.line("*ENERGY OUTPUT")?;
        sink.line(if self.procedure.is_explicit() { "ALLSE,ALLKE,ALLWK,ETOTAL" } else { "ALLSE,ALLWK" })?;
        if self.pressing.plate.is_none() {
            return Ok(());
        }
        if self.procedure.is_explicit() {
            sink.line(&format!("*CONTACT OUTPUT, SURFACE={}", SURFACES[1]))?;
        } else {
            sink.line(&format!("*CONTACT OUTPUT, SLAVE={}, MASTER={}", SURFACES[0], SURFACES[1]))?;
        }
        sink.line("CFN")
    }
}
