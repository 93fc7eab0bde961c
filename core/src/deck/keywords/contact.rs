//! `*SURFACE`, `*SURFACE INTERACTION`, `*CONTACT PAIR`, `*CONTACT`: a plate on spokes, without friction.

use crate::deck::DeckError;
use crate::deck::number::real;
use crate::deck::sink::Sink;

/// Name of the interaction.
const INTERACTION: &str = "PLATE-CONTACT";

/// The surface made of one face of every element of some sets.
pub(crate) fn surface<'a>(
    sink: &mut Sink<'_>,
    name: &str,
    sets: impl Iterator<Item = &'a str>,
    face: &str,
) -> Result<(), DeckError> {
    sink.line(&format!("*SURFACE, NAME={name}, TYPE=ELEMENT"))?;
    let mut sets = sets;
    sets.try_for_each(|set| sink.line(&format!("{set},{face}")))
}

/// A pair of surfaces whose pressure is proportional to their penetration, N/mm^3; the second one is the rigid one.
pub(crate) fn pair(sink: &mut Sink<'_>, [spokes, plate]: [&str; 2], stiffness: f64) -> Result<(), DeckError> {
    sink.line(&format!("*SURFACE INTERACTION, NAME={INTERACTION}"))?;
    sink.line("*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR")?;
    sink.line(&real(stiffness))?;
    sink.line(&format!("*CONTACT PAIR, INTERACTION={INTERACTION}, TYPE=SURFACE TO SURFACE"))?;
    sink.line(&format!("{spokes},{plate}"))
}

/// Contact of everything with everything in ABAQUS/Explicit by its own penalty; the spokes are `thickness` thick for it.
pub(crate) fn general(sink: &mut Sink<'_>, spokes: &str, thickness: f64) -> Result<(), DeckError> {
    sink.line(&format!("*SURFACE INTERACTION, NAME={INTERACTION}"))?;
    sink.line("*FRICTION")?;
    sink.line("0")?;
    sink.line("*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD")?;
    sink.line("*CONTACT")?;
    sink.line("*CONTACT INCLUSIONS, ALL EXTERIOR")?;
    sink.line("*CONTACT PROPERTY ASSIGNMENT")?;
    sink.line(&format!(",,{INTERACTION}"))?;
    sink.line("*SURFACE PROPERTY ASSIGNMENT, PROPERTY=THICKNESS")?;
    sink.line(&format!("{spokes},{}", real(thickness)))
}
