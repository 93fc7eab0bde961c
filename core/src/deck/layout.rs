//! How a deck is laid out.

use crate::input::model::{DeckSolver, DeckStyle, DecksInput};

/// ABAQUS with parts, ABAQUS flat, or CalculiX.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Layout {
    AbaqusParts,
    AbaqusFlat,
    Calculix,
}

impl Layout {
    pub(crate) fn new(solver: DeckSolver, decks: &DecksInput) -> Self {
        match (solver, decks.style) {
            // NASTRAN meshes are flat as well, and have a writer of their own.
            (DeckSolver::Calculix | DeckSolver::Nastran, _) => Self::Calculix,
            (DeckSolver::Abaqus, DeckStyle::Parts) => Self::AbaqusParts,
            (DeckSolver::Abaqus, DeckStyle::Flat) => Self::AbaqusFlat,
        }
    }

    pub(crate) fn is_abaqus(self) -> bool {
        self != Self::Calculix
    }

    pub(crate) fn has_parts(self) -> bool {
        self == Self::AbaqusParts
    }

    /// `INSTANCE.` before a node or set of an instance, where the layout has instances.
    pub(crate) fn prefix(self, instance: &str) -> String {
        if self.has_parts() { format!("{instance}.") } else { String::new() }
    }

    /// `, INSTANCE=name` for a set made in the assembly, where the layout has instances.
    pub(crate) fn instance(self, instance: &str) -> String {
        if self.has_parts() { format!(", INSTANCE={instance}") } else { String::new() }
    }
}
