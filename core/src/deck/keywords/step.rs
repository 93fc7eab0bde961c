//! `*STEP` and `*STATIC`.

use crate::deck::DeckError;
use crate::deck::layout::Layout;
use crate::deck::number::real;
use crate::deck::sink::Sink;
use crate::design::Design;
use crate::elastica::morph::Guide;

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
    /// Most increments of a step.
    pub(crate) const NUMBER: u32 = 2000;

    /// Increments of a design's morph; a strip that is to buckle passes its buckling load, where `(pi^2/3) (t/L)^2` of its
    /// length is gone, in small ones.
    pub(crate) fn of(design: &Design) -> Self {
        let Some(Guide::Clamped { length_mm, shortening }) = design.guide() else { return Self::MORPH };
        let slenderness = design.input().strips.thickness_mm / length_mm;
        let buckled = slenderness * std::f64::consts::PI / (3.0 * shortening).sqrt();
        let first = (0.1 * buckled).clamp(1e-3, Self::MORPH.first);
        Self { first, ..Self::MORPH }
    }
}

/// Opens a static step with large displacements.
pub(crate) fn open(sink: &mut Sink<'_>, layout: Layout, name: &str, by: Increments) -> Result<(), DeckError> {
    if layout.is_abaqus() {
        sink.line(&format!("*STEP, NAME={name}, NLGEOM=YES, INC={}", Increments::NUMBER))?;
    } else {
        sink.line(&format!("*STEP, NLGEOM, INC={}", Increments::NUMBER))?;
    }
    sink.line("*STATIC")?;
    sink.line(&format!("{},1.,{},{}", real(by.first), real(by.least), real(by.most)))
}

/// Opens a step of explicit dynamics that takes `time_s`.
pub(crate) fn open_explicit(sink: &mut Sink<'_>, name: &str, time_s: f64) -> Result<(), DeckError> {
    sink.line(&format!("*STEP, NAME={name}, NLGEOM=YES"))?;
    sink.line("*DYNAMIC, EXPLICIT")?;
    sink.line(&format!(",{}", real(time_s)))
}

/// Closes the step.
pub(crate) fn close(sink: &mut Sink<'_>) -> Result<(), DeckError> {
    sink.line("*END STEP")
}
