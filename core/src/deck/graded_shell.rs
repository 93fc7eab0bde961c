//! The whole flower as shells with a smooth outline, the modulus a nodal field.

use super::keywords::heading::heading;
use super::pressing::{Pressing, parameters};
use super::shell::ShellModel;
use super::shell_press::Procedure;
use super::sink::Sink;
use super::{Deck, DeckError};
use crate::design::Design;
use crate::mesh::sheet::graded_stations;
use crate::mesh::{Sheet, Spacing};
use crate::output::Provenance;

/// The deck.
pub(super) struct GradedShell<'a> {
    model: ShellModel<'a>,
}

impl<'a> GradedShell<'a> {
    pub(super) fn new(design: &'a Design) -> Self {
        let [along, across] = design.input().decks.shell_elements;
        let profile = design.profile();
        let stations = graded_stations(&profile.s, &profile.width, along);
        let (widths, moduli) = stations.iter().map(|s| design.width_and_modulus(*s)).unzip();
        let sheet = Sheet::new(stations, vec![across; along], Spacing::Width(widths));
        Self { model: ShellModel::new(design, sheet, moduli, Some(across / 2)) }
    }

    /// The same, pressed after the morph.
    pub(super) fn pressed(design: &'a Design) -> Result<Self, &'static str> {
        let pressing = Pressing::new(design, parameters(design), 0.5 * design.input().strips.thickness_mm)?;
        let Self { model } = Self::new(design);
        Ok(Self { model: model.pressed(Procedure::Standard, pressing) })
    }
}

impl Deck for GradedShell<'_> {
    fn nodes(&self) -> u64 {
        self.model.nodes()
    }

    fn elements(&self) -> u64 {
        self.model.elements()
    }

    fn write(&self, provenance: &Provenance, sink: &mut Sink<'_>) -> Result<(), DeckError> {
        let model = &self.model;
        let mut paragraphs = vec![format!(
            "Model: all spokes with their smooth outline and the rigid hub, {} elements, the designed modulus as a nodal \
             field. Field variable 1 of a node is its modulus in MPa; the material's table over it is exact, with \
             Poisson's ratio and density mixed by volume.",
            model.element()
        )];
        paragraphs.extend(model.paragraphs());
        heading(sink, &model.design.input().name, &model.title("graded shell"), provenance, &paragraphs)?;
        model.write(sink, |sink| model.phase_sets(sink))
    }
}
