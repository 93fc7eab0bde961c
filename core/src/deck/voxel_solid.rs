//! One spoke as a solid in which every voxel has its phase.

use super::keywords::heading::heading;
use super::keywords::{elements, materials, sets};
use super::sink::Sink;
use super::solid::SolidModel;
use super::{Deck, DeckError};
use crate::design::Design;
use crate::input::model::DeckSolver;
use crate::mesh::{Block, Spacing};
use crate::output::Provenance;

/// The deck.
pub(super) struct VoxelSolid<'a> {
    model: SolidModel<'a>,
    per_edge: usize,
    doubled: bool,
}

impl<'a> VoxelSolid<'a> {
    pub(super) fn new(design: &'a Design, solver: DeckSolver) -> Self {
        let (block, per_edge, doubled) = block(design, solver);
        Self { model: SolidModel::new(design, solver, block), per_edge, doubled }
    }
}

/// The mesh, the elements along a voxel's edge, and whether these were doubled.
pub(super) fn block(design: &Design, solver: DeckSolver) -> (Block, usize, bool) {
    let (decks, strips, grid) = (&design.input().decks, &design.input().strips, design.grid());
    let wanted = match solver {
        DeckSolver::Abaqus => decks.elements_per_voxel_edge,
        DeckSolver::Calculix | DeckSolver::Nastran => decks.calculix_elements_per_voxel_edge,
    };
    // An odd number of element layers would have no nodes on the mid-plane.
    let doubled = grid.layers() * wanted % 2 == 1;
    let per_edge = if doubled { 2 * wanted } else { wanted };
    let across = grid.half_widths().iter().flat_map(|n| std::iter::repeat_n(2 * n * per_edge, per_edge)).collect();
    let edge = Spacing::Even(grid.size_mm() / per_edge as f64);
    let block = Block::new(strips.length_mm, strips.thickness_mm, grid.layers() * per_edge, across, edge);
    (block, per_edge, doubled)
}

impl Deck for VoxelSolid<'_> {
    fn nodes(&self) -> u64 {
        self.model.nodes()
    }

    fn elements(&self) -> u64 {
        self.model.block.elements()
    }

    fn midline(&self) -> Option<Vec<[f64; 3]>> {
        Some(self.model.block.midline())
    }

    fn write(&self, provenance: &Provenance, sink: &mut Sink<'_>) -> Result<(), DeckError> {
        let (model, per_edge) = (&self.model, self.per_edge);
        let (grid, phases) = (model.design.grid(), model.design.phases().phases());
        let counts = grid.counts(phases.len());
        let densities = phases.iter().all(|p| p.density_kg_m3.is_some());
        let mut paragraphs = vec![format!(
            "Model: one spoke of voxels of {} mm, each of one phase and {per_edge} x {per_edge} x {per_edge} {} elements.",
            grid.size_mm(),
            model.element
        )];
        if self.doubled {
            paragraphs.push(
                "The number of elements along a voxel's edge was doubled: with an odd number of layers no node would lie \
                 on the mid-plane."
                    .to_owned(),
            );
        }
        paragraphs.extend(model.paragraphs());
        paragraphs
            .push("PHASE-<NAME>: elements of a phase. SLICE-<i>: elements of a slice, from 1 at the rim.".to_owned());
        heading(sink, &model.design.input().name, "voxel solid", provenance, &paragraphs)?;
        let present = || phases.iter().enumerate().filter(|(i, _)| counts[*i] > 0);
        model.model(sink, |sink| {
            for (i, phase) in present() {
                let set = format!("PHASE-{}", phase.label());
                elements::phase_elements(sink, &model.block, &model.element, &set, (grid, per_edge, i as u8))?;
            }
            for i in 0..grid.slices() {
                let elements = |slice: usize| model.block.first_element(slice * per_edge);
                let range = (elements(i), elements(i + 1) - 1);
                sets::element_ranges(sink, &format!("SLICE-{}", i + 1), std::iter::once(range))?;
            }
            for (_, phase) in present() {
                model.section(sink, &format!("PHASE-{}", phase.label()), &materials::material_name(phase))?;
            }
            Ok(())
        })?;
        model.section_controls(sink)?;
        for (_, phase) in present() {
            materials::plain(sink, phase, model.law, densities)?;
        }
        model.amplitudes(sink)?;
        model.step(sink)
    }
}
