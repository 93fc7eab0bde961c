//! `*BOUNDARY`.

use crate::deck::DeckError;
use crate::deck::layout::Layout;
use crate::deck::number::real;
use crate::deck::schedule::{Motion, Schedule};
use crate::deck::sink::Sink;

use super::constraints::Reference;

/// Holds degrees of freedom `first..=last` of a node set at zero.
pub(crate) fn hold(sink: &mut Sink<'_>, set: &str, first: u8, last: u8) -> Result<(), DeckError> {
    sink.line("*BOUNDARY")?;
    sink.line(&format!("{set},{first},{last}"))
}

/// Moves a degree of freedom, or holds it where the motion does not move.
pub(crate) fn drive(sink: &mut Sink<'_>, set: &str, dof: u8, motion: &Motion) -> Result<(), DeckError> {
    if !motion.moves() {
        return hold(sink, set, dof, dof);
    }
    sink.line(&format!("*BOUNDARY, AMPLITUDE={}", motion.amplitude))?;
    sink.line(&format!("{set},{dof},{dof},{}", real(motion.value)))
}

/// Keeps a degree of freedom where a motion has brought it. CalculiX would begin the motion's amplitude anew.
pub(crate) fn keep(sink: &mut Sink<'_>, set: &str, dof: u8, motion: &Motion) -> Result<(), DeckError> {
    if motion.moves() { place(sink, set, dof, motion.last()) } else { Ok(()) }
}

/// Brings a degree of freedom to a value, linearly in time.
pub(crate) fn place(sink: &mut Sink<'_>, set: &str, dof: u8, value: f64) -> Result<(), DeckError> {
    sink.line("*BOUNDARY")?;
    sink.line(&format!("{set},{dof},{dof},{}", real(value)))
}

/// Gives a degree of freedom a velocity, constant or over an amplitude.
pub(crate) fn velocity(
    sink: &mut Sink<'_>,
    set: &str,
    dof: u8,
    value: f64,
    amplitude: Option<&str>,
) -> Result<(), DeckError> {
    let amplitude = amplitude.map_or_else(String::new, |name| format!(", AMPLITUDE={name}"));
    sink.line(&format!("*BOUNDARY, TYPE=VELOCITY{amplitude}"))?;
    sink.line(&format!("{set},{dof},{dof},{}", real(value)))
}

/// Keeps both ends of a single strip in CalculiX where the morph has brought them, except for the hub's height.
pub(crate) fn keep_ends(
    sink: &mut Sink<'_>,
    layout: Layout,
    schedule: &Schedule,
    [rim, hub]: [&Reference; 2],
) -> Result<(), DeckError> {
    keep(sink, rim.name, 1, &schedule.rim_travel)?;
    for (reference, rotation) in [(rim, &schedule.rim_rotation), (hub, &schedule.hub_rotation)] {
        let (set, dof) = reference.rotation(layout, 2);
        keep(sink, set, dof, rotation)?;
    }
    Ok(())
}

/// Moves the two ends of a single strip by their reference nodes: everything is constrained but a free hub's height.
pub(crate) fn ends(
    sink: &mut Sink<'_>,
    layout: Layout,
    schedule: &Schedule,
    [rim, hub]: [&Reference; 2],
) -> Result<(), DeckError> {
    drive(sink, rim.name, 1, &schedule.rim_travel)?;
    hold(sink, rim.name, 2, 3)?;
    turn(sink, layout, rim, &schedule.rim_rotation)?;
    hold(sink, hub.name, 1, 2)?;
    if let Some(height) = &schedule.hub_height {
        drive(sink, hub.name, 3, height)?;
    }
    turn(sink, layout, hub, &schedule.hub_rotation)
}

/// Rotates a reference node about y only.
fn turn(sink: &mut Sink<'_>, layout: Layout, reference: &Reference, motion: &Motion) -> Result<(), DeckError> {
    for axis in [1, 3] {
        let (set, dof) = reference.rotation(layout, axis);
        hold(sink, set, dof, dof)?;
    }
    let (set, dof) = reference.rotation(layout, 2);
    drive(sink, set, dof, motion)
}
