//! `*STEP` and `*STATIC`.

use crate::deck::DeckError;
use crate::deck::layout::Layout;
use crate::deck::number::real;
use crate::deck::sink::Sink;

/// Increments of the step's time, which runs from 0 to 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Increments {
    /// First increment.
    pub first: f64,
    /// Smallest increment.
    pub least: f64,
    /// Largest increment.
    pub most: f64,
}

impl Increments {
    /// Those with which the paper's four shapes converge without stabilisation.
    pub(crate) const MORPH: Self = Self { first: 0.05, least: 1e-5, most: 0.05 };
}

/// Opens a static step with large displacements.
pub(crate) fn open(sink: &mut Sink<'_>, layout: Layout, name: &str, by: Increments) -> Result<(), DeckError> {
    if layout.is_abaqus() {
        sink.line(&format!("*STEP, NAME={name}, NLGEOM=YES, INC=2000"))?;
    } else {
        sink.line("*STEP, NLGEOM, INC=2000")?;
    }
    sink.line("*STATIC")?;
    sink.line(&format!("{},1.,{},{}", real(by.first), real(by.least), real(by.most)))
}

/// Closes the step.
pub(crate) fn close(sink: &mut Sink<'_>) -> Result<(), DeckError> {
    sink.line("*END STEP")
}
