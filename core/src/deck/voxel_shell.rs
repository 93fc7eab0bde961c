//! The whole flower as shells on the outline of its voxels, the modulus a nodal field.

use super::keywords::heading::heading;
use super::pressing::{Pressing, parameters};
use super::shell::ShellModel;
use super::shell_press::Procedure;
use super::sink::Sink;
use super::{Deck, DeckError};
use crate::design::Design;
use crate::mesh::{Sheet, Spacing};
use crate::output::Provenance;

/// The deck.
pub(super) struct VoxelShell<'a> {
    model: ShellModel<'a>,
}

impl<'a> VoxelShell<'a> {
    pub(super) fn new(design: &'a Design) -> Self {
        let grid = design.grid();
        let length = design.input().strips.length_mm;
        let stations = (0..=grid.slices()).map(|row| length * row as f64 / grid.slices() as f64).collect();
        let across = grid.half_widths().iter().map(|n| 2 * n).collect();
        let sheet = Sheet::new(stations, across, Spacing::Even(grid.size_mm()));
        Self { model: ShellModel::new(design, sheet, row_moduli(design), None) }
    }

    /// The same, morphed and pressed in explicit dynamics.
    pub(super) fn pressed(design: &'a Design) -> Result<Self, &'static str> {
        let pressing = Pressing::new(design, parameters(design), 0.5 * contact_thickness(design))?;
        let Self { model } = Self::new(design);
        Ok(Self { model: model.pressed(Procedure::Explicit { thickness_mm: contact_thickness(design) }, pressing) })
    }
}

/// Thickness of the spokes for contact, mm. ABAQUS makes facets thinner that are thicker than they are long, so what is
/// wanted is said: half an edge, or the spokes' own where that is less.
fn contact_thickness(design: &Design) -> f64 {
    design.input().strips.thickness_mm.min(0.5 * design.grid().size_mm())
}

/// Modulus at every row of nodes, MPa: the mean of the slices beside it. A slice's is the designed one times the smooth
/// width over that of its voxels, so that the stiffness of the section is the designed one.
fn row_moduli(design: &Design) -> Vec<f64> {
    let slice = |i: usize| design.slices()[i].modulus_target_mpa;
    let last = design.slices().len() - 1;
    (0..=last + 1).map(|row| 0.5 * (slice(row.saturating_sub(1)) + slice(row.min(last)))).collect()
}

impl Deck for VoxelShell<'_> {
    fn nodes(&self) -> u64 {
        self.model.nodes()
    }

    fn elements(&self) -> u64 {
        self.model.elements()
    }

    fn write(&self, provenance: &Provenance, sink: &mut Sink<'_>) -> Result<(), DeckError> {
        let model = &self.model;
        let mut paragraphs = vec![format!(
            "Model: all spokes with the outline of their voxels, {} elements of {} mm. Field variable 1 of a node is its \
             modulus in MPa: the designed one times smooth over voxel width, the mean of the slices beside the node; \
             outside the table, ABAQUS takes its first or last row, as the voxels take the softest or stiffest phase. \
             Poisson's ratio and density are mixed by volume.",
            model.element(),
            model.design.grid().size_mm()
        )];
        paragraphs.extend(model.paragraphs());
        paragraphs.push("SLICE-<i>: elements of a slice, from 1 at the rim.".to_owned());
        heading(sink, &model.design.input().name, &model.title("voxel shell"), provenance, &paragraphs)?;
        model.write(sink, |sink| {
            model.phase_sets(sink)?;
            (0..model.sheet.slices()).try_for_each(|slice| model.slice_set(sink, slice))
        })
    }
}
