//! One spoke as a solid with a smooth outline, its modulus a nodal field.

use super::keywords::heading::heading;
use super::keywords::{elements, initial, materials, nodes, sets};
use super::sink::Sink;
use super::solid::SolidModel;
use super::{Deck, DeckError};
use crate::design::Design;
use crate::input::model::DeckSolver;
use crate::mesh::{Block, Spacing};
use crate::output::Provenance;

/// The deck.
pub(super) struct GradedSolid<'a> {
    pub model: SolidModel<'a>,
    /// Designed modulus at every plane of nodes, MPa.
    moduli: Vec<f64>,
}

impl<'a> GradedSolid<'a> {
    pub(super) fn new(design: &'a Design, solver: DeckSolver) -> Self {
        let (block, moduli) = block(design, solver);
        Self { model: SolidModel::new(design, solver, block), moduli }
    }

    /// Runs of elements that contain a phase, from the mixture in the middle of each slice.
    fn runs(&self, phase: usize) -> Vec<(u64, u64)> {
        let (block, phases) = (&self.model.block, self.model.design.phases());
        let mut runs: Vec<(u64, u64)> = Vec::new();
        for (i, ends) in self.moduli.windows(2).enumerate() {
            if phases.fractions(0.5 * (ends[0] + ends[1])).values[phase] <= 1e-9 {
                continue;
            }
            let (first, last) = (block.first_element(i), block.first_element(i + 1) - 1);
            match runs.last_mut() {
                Some(run) if run.1 + 1 == first => run.1 = last,
                _ => runs.push((first, last)),
            }
        }
        runs
    }

    /// Everything up to the amplitudes; `paragraphs`, `nodes` and what `more` writes are added to heading, nodes and elements.
    pub(super) fn model(
        &self,
        sink: &mut Sink<'_>,
        provenance: &Provenance,
        title: &str,
        more_paragraphs: &[String],
        more_nodes: &[(&str, u64, [f64; 3])],
        more: impl FnOnce(&mut Sink<'_>) -> Result<(), DeckError>,
    ) -> Result<(), DeckError> {
        let model = &self.model;
        let phases = model.design.phases();
        let field = if model.layout.is_abaqus() { "Field variable 1" } else { "The temperature" };
        let mut paragraphs = vec![format!(
            "Model: one spoke with its smooth outline, {} elements, the designed modulus as a nodal field. {field} of a \
             node is its modulus in MPa; the material's table over it is exact, with Poisson's ratio and density mixed by \
             volume.",
            model.element
        )];
        paragraphs.extend(model.paragraphs());
        paragraphs.push("PHASE-<NAME>: elements whose mixture contains the phase.".to_owned());
        paragraphs.extend_from_slice(more_paragraphs);
        heading(sink, &model.design.input().name, title, provenance, &paragraphs)?;
        model.model(sink, |sink| {
            nodes::more_nodes(sink, more_nodes)?;
            elements::elements(sink, &model.block, &model.element, "SPOKE")?;
            for (i, phase) in phases.phases().iter().enumerate() {
                let runs = self.runs(i);
                if !runs.is_empty() {
                    sets::element_ranges(sink, &format!("PHASE-{}", phase.label()), runs.into_iter())?;
                }
            }
            model.section(sink, "SPOKE", "GRADED")?;
            more(sink)
        })?;
        model.section_controls(sink)?;
        materials::graded(sink, "GRADED", phases, model.law, model.layout)
    }

    /// Amplitudes and the modulus field.
    pub(super) fn field(&self, sink: &mut Sink<'_>) -> Result<(), DeckError> {
        let model = &self.model;
        model.amplitudes(sink)?;
        initial::modulus_field(sink, model.layout, &model.prefix(), &model.block, &self.moduli)
    }
}

/// The mesh, and the designed modulus at every plane of nodes, MPa.
pub(super) fn block(design: &Design, solver: DeckSolver) -> (Block, Vec<f64>) {
    let (decks, strips) = (&design.input().decks, &design.input().strips);
    let [along, across, through] = match solver {
        DeckSolver::Abaqus => decks.graded_elements,
        DeckSolver::Calculix | DeckSolver::Nastran => decks.calculix_graded_elements,
    };
    let station = |i: usize| design.width_and_modulus(strips.length_mm * i as f64 / along as f64);
    let (widths, moduli) = (0..=along).map(station).unzip();
    let block = Block::new(strips.length_mm, strips.thickness_mm, through, vec![across; along], Spacing::Width(widths));
    (block, moduli)
}

impl Deck for GradedSolid<'_> {
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
        self.model(sink, provenance, "graded solid", &[], &[], |_| Ok(()))?;
        self.field(sink)?;
        self.model.step(sink)
    }
}
