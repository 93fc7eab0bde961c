//! One spoke as a graded solid that is morphed and then pressed, for CalculiX.

use super::graded_solid::GradedSolid;
use super::keywords::materials::{Law, plain};
use super::keywords::step::Increments;
use super::keywords::{boundary, contact, output, sets, step};
use super::number::real;
use super::pressing::{Plate, Pressing};
use super::sink::Sink;
use super::solid::SolidModel;
use super::{Deck, DeckError};
use crate::design::Design;
use crate::input::IndentationInput;
use crate::input::model::DeckSolver;
use crate::materials::Material;
use crate::output::Provenance;

/// The deck.
pub(super) struct GradedSolidIndentation<'a> {
    solid: GradedSolid<'a>,
    pressing: Pressing,
}

/// Node set and element set of the plate.
const PLATE: &str = "PLATE";
/// Elements whose upper face may touch the plate.
const UPPER: &str = "UPPER";
/// The faces that touch.
const FACES: [&str; 2] = ["UPPER-FACE", "PLATE-FACE"];

impl<'a> GradedSolidIndentation<'a> {
    pub(super) fn new(design: &'a Design, input: IndentationInput) -> Result<Self, &'static str> {
        let pressing = Pressing::new(design, input, 0.5 * design.input().strips.thickness_mm)?;
        Ok(Self { solid: GradedSolid::new(design, DeckSolver::Calculix), pressing })
    }

    /// Corners of the brick that stands for the plate, in the order of an eight-node element, mm.
    fn corners(&self, plate: Plate) -> [[f64; 3]; 8] {
        let strips = &self.model().design.input().strips;
        let (hub, block) = (strips.length_mm, &self.model().block);
        // Wider than the spoke and a little beyond its end.
        let widest = (0..block.planes()).map(|p| block.y(p, 0).abs()).fold(0.0, f64::max);
        let (x, y) = ([hub - plate.reach_mm, hub + strips.thickness_mm], 1.1 * widest);
        let z = [plate.height_mm, plate.height_mm + strips.thickness_mm];
        let corner = |k: usize| [x[usize::from(k % 4 == 1 || k % 4 == 2)], if k % 4 < 2 { -y } else { y }, z[k / 4]];
        std::array::from_fn(corner)
    }

    fn model(&self) -> &SolidModel<'a> {
        &self.solid.model
    }

    fn first_plate_node(&self) -> u64 {
        self.model().nodes() + 1
    }

    fn plate_nodes(&self) -> impl Iterator<Item = u64> {
        self.first_plate_node()..self.first_plate_node() + 8
    }

    /// The plate as one element, all of whose nodes are prescribed, and the faces that may touch.
    fn plate(&self, sink: &mut Sink<'_>, plate: Plate) -> Result<(), DeckError> {
        let block = &self.model().block;
        sets::node_list(sink, PLATE, "", self.plate_nodes())?;
        sink.line(&format!("*ELEMENT, TYPE=C3D8, ELSET={PLATE}"))?;
        let corners: Vec<String> = self.plate_nodes().map(|node| node.to_string()).collect();
        sink.line(&format!("{},{}", block.elements() + 1, corners.join(",")))?;
        let covered = (0..block.slices()).filter(|i| block.x(block.slices()) - block.x(i + 1) < plate.contact_mm);
        let upper = covered.map(|i| {
            let next = block.first_element(i + 1);
            (next - block.slice_across(i) as u64, next - 1)
        });
        sets::element_ranges(sink, UPPER, upper)?;
        contact::surface(sink, FACES[0], std::iter::once(UPPER), "S2")?;
        contact::surface(sink, FACES[1], std::iter::once(PLATE), "S1")?;
        self.model().section(sink, PLATE, PLATE)
    }

    /// The plate rises and sinks with the hub.
    fn plate_follows(&self, sink: &mut Sink<'_>) -> Result<(), DeckError> {
        for node in self.plate_nodes() {
            sink.line("*EQUATION")?;
            sink.line("2")?;
            sink.line(&format!("{node},3,1.,{},3,-1.", self.model().hub.node))?;
        }
        Ok(())
    }

    /// Flat strip to dome, then dome to pressed dome.
    fn steps(&self, sink: &mut Sink<'_>) -> Result<(), DeckError> {
        let (model, layout) = (self.model(), self.model().layout);
        let ends = [&model.rim, &model.hub];
        step::open(sink, layout, "MORPH", Increments::of(model.design))?;
        boundary::ends(sink, layout, &model.schedule, ends)?;
        if self.pressing.plate.is_some() {
            boundary::hold(sink, PLATE, 1, 2)?;
        }
        self.requests(sink, output::frequency(self.nodes()))?;
        step::close(sink)?;
        let first = self.pressing.increment();
        step::open(sink, layout, "PRESS", Increments { first, most: first, ..Increments::MORPH })?;
        boundary::keep_ends(sink, layout, &model.schedule, ends)?;
        boundary::place(sink, model.hub.name, 3, self.pressing.hub_height_mm - self.pressing.depth_mm)?;
        self.requests(sink, 1)?;
        step::close(sink)
    }

    /// What the figures of an indentation are made from, and the usual.
    fn requests(&self, sink: &mut Sink<'_>, frequency: u32) -> Result<(), DeckError> {
        if self.pressing.plate.is_some() {
            sink.line(&format!("*NODE PRINT, NSET={PLATE}, TOTALS=ONLY"))?;
            sink.line("RF")?;
            sink.line(&format!("*CONTACT PRINT, SLAVE={}, MASTER={}", FACES[0], FACES[1]))?;
            sink.line("CDIS")?;
        }
        sink.line("*EL PRINT, ELSET=SPOKE, TOTALS=ONLY")?;
        sink.line("ELSE")?;
        sink.line("*EL PRINT, ELSET=SPOKE")?;
        sink.line("E")?;
        output::calculix_requests(sink, frequency, &["MIDLINE"], &[&self.model().rim, &self.model().hub])
    }
}

impl Deck for GradedSolidIndentation<'_> {
    fn nodes(&self) -> u64 {
        self.model().nodes() + if self.pressing.plate.is_some() { 8 } else { 0 }
    }

    fn elements(&self) -> u64 {
        self.solid.elements() + u64::from(self.pressing.plate.is_some())
    }

    fn midline(&self) -> Option<Vec<[f64; 3]>> {
        self.solid.midline()
    }

    fn write(&self, provenance: &Provenance, sink: &mut Sink<'_>) -> Result<(), DeckError> {
        let phases = self.model().design.phases();
        let stiffest = &phases.phases()[phases.phases().len() - 1];
        let mut paragraphs = vec![self.pressing.paragraph(true)];
        paragraphs.push(
            "Results: at RP-HUB, U3 falls by the depth; at RP-RIM, RF3 grows by the force of one spoke. PLATE: the plate, whose \
             total RF3 is what it puts on the spoke beside the hub, downwards. UPPER: elements that may touch it."
                .to_owned(),
        );
        let corners = self.pressing.plate.map(|plate| self.corners(plate)).into_iter().flatten();
        let nodes: Vec<_> = self.plate_nodes().zip(corners).map(|(node, position)| (PLATE, node, position)).collect();
        self.solid.model(sink, provenance, "graded solid under load", &paragraphs, &nodes, |sink| {
            self.pressing.plate.map_or(Ok(()), |plate| self.plate(sink, plate))
        })?;
        if self.pressing.plate.is_some() {
            // Its nodes are all prescribed: what it is made of does not matter.
            let plate = Material { name: PLATE.to_owned(), ..stiffest.clone() };
            plain(sink, &plate, Law::Linear, stiffest.density_kg_m3.is_some())?;
            self.plate_follows(sink)?;
            contact::pair(sink, FACES, self.pressing.input.contact_stiffness_n_mm3)?;
        }
        self.solid.field(sink)?;
        if self.pressing.plate.is_some() {
            sink.line(&format!("{PLATE},{}", real(stiffest.modulus_mpa)))?;
        }
        self.steps(sink)
    }
}
