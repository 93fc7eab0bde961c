//! What both solid decks of one spoke share: end faces, reference nodes, the step.

use super::DeckError;
use super::keywords::constraints::{Reference, rigid_face};
use super::keywords::materials::Law;
use super::keywords::step::Increments;
use super::keywords::{amplitudes, boundary, nodes, output, sets, step};
use super::layout::Layout;
use super::number::Coordinates;
use super::schedule::Schedule;
use super::sink::Sink;
use crate::design::Design;
use crate::elastica::morph::Guide;
use crate::fem::model::LARGE_STRAIN;
use crate::input::model::{DeckSolver, DecksInput};
use crate::mesh::Block;

/// Rise of a strip that is to buckle, as a share of its thickness: with a twentieth some runs buckled downward; the
/// final shape hardly depends on it.
const BOW: f64 = 0.1;

/// Name of the part and of its only instance.
const PART: &str = "SPOKE";
const INSTANCE: &str = "SPOKE-1";

/// One spoke as a block of bricks between two rigid faces.
pub(super) struct SolidModel<'a> {
    pub design: &'a Design,
    pub layout: Layout,
    pub block: Block,
    pub element: String,
    pub law: Law,
    pub schedule: Schedule,
    coordinates: Coordinates,
    pub rim: Reference,
    pub hub: Reference,
}

impl<'a> SolidModel<'a> {
    pub(super) fn new(design: &'a Design, solver: DeckSolver, block: Block) -> Self {
        let input = design.input();
        let layout = Layout::new(solver, &input.decks);
        let length = input.strips.length_mm;
        let block = match initial_bow(design) {
            0.0 => block,
            bow => block.bowed(bow),
        };
        // In an assembly, reference nodes are numbered on their own.
        let first = if layout.has_parts() { 1 } else { block.nodes() + 1 };
        let step = if layout.is_abaqus() { 1_u64 } else { 2 };
        let reference = |name, rotation_name, i, x| Reference {
            name,
            rotation_name,
            node: first + step * i,
            rotation_node: first + step * i + 1,
            position: [x, 0.0, 0.0],
        };
        Self {
            design,
            layout,
            element: element(&input.decks, layout, block.layers()),
            law: law(design, layout),
            schedule: Schedule::of(design),
            coordinates: Coordinates::new(length.max(block.y(0, 0).abs())),
            rim: reference("RP-RIM", "RP-RIM-ROT", 0, 0.0),
            hub: reference("RP-HUB", "RP-HUB-ROT", 1, length),
            block,
        }
    }

    /// Nodes, reference nodes included.
    pub(super) fn nodes(&self) -> u64 {
        self.block.nodes() + if self.layout.is_abaqus() { 2 } else { 4 }
    }

    /// Paragraphs of the heading that both decks have.
    pub(super) fn paragraphs(&self) -> Vec<String> {
        let mut text = vec![
            format!(
                "Frame: the strip lies along x, rim at x = 0, hub at x = {}, mid-plane z = 0, y across.",
                self.design.input().strips.length_mm
            ),
            format!("Step: {}.", self.schedule.description),
            "Sets: MIDLINE (mid-line nodes, rim to hub), RIM and HUB (end faces, rigid), RP-RIM and RP-HUB (their \
             reference nodes)."
                .to_owned(),
        ];
        if !self.layout.is_abaqus() {
            text.push(
                "RP-RIM-ROT and RP-HUB-ROT carry the rotations and moments as degrees of freedom 1 to 3.".to_owned(),
            );
        }
        if matches!(self.design.guide(), Some(Guide::Clamped { .. })) {
            text.push(format!(
                "Imperfection: a flat strip would only be compressed, so the nodes are raised by a (1 - cos(2 pi x/L))/2 \
                 with a = {} mm.",
                super::number::real(BOW * self.design.input().strips.thickness_mm)
            ));
        }
        if self.law == Law::NeoHooke {
            text.push(
                "Material: compressible neo-Hookean with the moduli and Poisson's ratios of small strains. In large \
                 displacements CalculiX's *ELASTIC softens in compression and collapses at 42 %; this strip is bent by \
                 more than a tenth."
                    .to_owned(),
            );
        }
        text
    }

    /// Nodes and elements, sets and sections, up to where materials begin. `elements` writes what belongs to the part.
    pub(super) fn model(
        &self,
        sink: &mut Sink<'_>,
        elements: impl FnOnce(&mut Sink<'_>) -> Result<(), DeckError>,
    ) -> Result<(), DeckError> {
        let parts = self.layout.has_parts();
        if self.layout.is_abaqus() {
            sink.line("*PREPRINT, ECHO=NO, MODEL=NO, HISTORY=NO, CONTACT=NO")?;
        }
        if parts {
            sink.line(&format!("*PART, NAME={PART}"))?;
        }
        let references = [self.rim.nodes(self.layout), self.hub.nodes(self.layout)].concat();
        nodes::nodes(sink, &self.block, self.coordinates)?;
        if !parts {
            nodes::more_nodes(sink, &references)?;
        }
        elements(sink)?;
        if parts {
            sink.line("*END PART")?;
            sink.line("*ASSEMBLY, NAME=ASSEMBLY")?;
            sink.line(&format!("*INSTANCE, NAME={INSTANCE}, PART={PART}"))?;
            sink.line("*END INSTANCE")?;
            nodes::reference_nodes(sink, &references)?;
        } else {
            for (name, node, _) in references {
                sets::node_list(sink, name, "", std::iter::once(node))?;
            }
        }
        let instance = self.layout.instance(INSTANCE);
        let block = &self.block;
        let planes = block.planes();
        sets::node_range(sink, "RIM", &instance, block.first_node(0), block.first_node(1) - 1)?;
        sets::node_range(sink, "HUB", &instance, block.first_node(planes - 1), block.nodes())?;
        let unsorted = if self.layout.is_abaqus() { ", UNSORTED" } else { "" };
        let midline = (0..planes).map(|p| block.midline_node(p));
        sets::node_list(sink, "MIDLINE", &format!("{instance}{unsorted}"), midline)?;
        rigid_face(sink, self.layout, "RIM", &self.rim)?;
        rigid_face(sink, self.layout, "HUB", &self.hub)?;
        if parts {
            sink.line("*END ASSEMBLY")?;
        }
        Ok(())
    }

    /// A section and, for elements that need it, its control against hourglassing.
    pub(super) fn section(&self, sink: &mut Sink<'_>, set: &str, material: &str) -> Result<(), DeckError> {
        let controls = if self.element == "C3D8R" { ", CONTROLS=ENHANCED" } else { "" };
        sink.line(&format!("*SOLID SECTION, ELSET={set}, MATERIAL={material}{controls}"))
    }

    /// The controls that sections refer to.
    pub(super) fn section_controls(&self, sink: &mut Sink<'_>) -> Result<(), DeckError> {
        if self.element == "C3D8R" {
            sink.line("*SECTION CONTROLS, NAME=ENHANCED, HOURGLASS=ENHANCED")?;
        }
        Ok(())
    }

    /// `INSTANCE.` before a node's label, where there are instances.
    pub(super) fn prefix(&self) -> String {
        self.layout.prefix(INSTANCE)
    }

    pub(super) fn amplitudes(&self, sink: &mut Sink<'_>) -> Result<(), DeckError> {
        amplitudes::amplitudes(sink, self.schedule.motions())
    }

    /// The step from the flat strip to its final shape.
    pub(super) fn step(&self, sink: &mut Sink<'_>) -> Result<(), DeckError> {
        step::open(sink, self.layout, "MORPH", Increments::of(self.design))?;
        boundary::ends(sink, self.layout, &self.schedule, [&self.rim, &self.hub])?;
        output::requests(sink, self.layout, self.nodes(), &["MIDLINE"], &[&self.rim, &self.hub])?;
        step::close(sink)
    }
}

/// Rise of the flat strip's middle, mm: none but where it is to buckle.
pub(crate) fn initial_bow(design: &Design) -> f64 {
    let buckles = matches!(design.guide(), Some(Guide::Clamped { .. }));
    if buckles { BOW * design.input().strips.thickness_mm } else { 0.0 }
}

/// The element type: CalculiX bends well with incompatible modes only, and so does ABAQUS where a single point through
/// the thickness of too few layers would have no bending stiffness.
fn element(decks: &DecksInput, layout: Layout, layers: usize) -> String {
    if !layout.is_abaqus() || (decks.solid_element == "C3D8R" && layers < 4) {
        "C3D8I".to_owned()
    } else {
        decks.solid_element.clone()
    }
}

/// The law of the phases: linear unless CalculiX would have to go beyond [`LARGE_STRAIN`].
fn law(design: &Design, layout: Layout) -> Law {
    let strain = 0.5 * design.input().strips.thickness_mm * design.profile().largest_curvature();
    if strain > LARGE_STRAIN && !layout.is_abaqus() { Law::NeoHooke } else { Law::Linear }
}
