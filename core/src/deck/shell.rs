//! What both shell decks of the whole flower share: spokes between rigid edges, the hub that joins them, the step.
//!
//! The hub's edges stay at the hub radius and rise together, but they turn by the target's inclination at the hub, which
//! need not be zero. So the spokes are not clamped to one rigid hub: every hub end is a rigid body of its own, whose
//! height follows the hub's by an equation. Corners where spokes and hub meet are separate nodes, since a node belongs to
//! one rigid body at most.

use super::DeckError;
use super::keywords::materials::Law;
use super::keywords::step::Increments;
use super::keywords::{
    amplitudes, boundary, materials, nodes, output, sets, shell_elements, shell_field, shell_nodes, step, systems, ties,
};
use super::layout::Layout;
use super::number::{Coordinates, real};
use super::pressing::Pressing;
use super::schedule::{Pace, Schedule};
use super::shell_press::{Procedure, ShellPress};
use super::sink::Sink;
use crate::design::Design;
use crate::input::model::DeckSolver;
use crate::materials::Material;
use crate::mesh::{Flower, HubPlate, Sheet};

/// Simpson points through the thickness; with an elastic material three would do as well.
const POINTS: u32 = 5;

/// All spokes of a dome.
pub(super) struct ShellModel<'a> {
    pub design: &'a Design,
    pub sheet: Sheet,
    layout: Layout,
    flower: Flower,
    hub: Option<HubPlate>,
    /// Modulus at every row of nodes of a spoke, MPa.
    moduli: Vec<f64>,
    schedule: Schedule,
    coordinates: Coordinates,
    press: Option<ShellPress>,
}

impl<'a> ShellModel<'a> {
    /// A flower of equal spokes; `hub_divisions` are the elements along half an edge of a hub of shells.
    pub(super) fn new(design: &'a Design, sheet: Sheet, moduli: Vec<f64>, hub_divisions: Option<usize>) -> Self {
        let input = design.input();
        let flower = Flower { count: input.count(), hub_radius: input.hub_radius(), length: input.strips.length_mm };
        debug_assert_eq!(moduli.len(), sheet.rows());
        Self {
            layout: Layout::new(DeckSolver::Abaqus, &input.decks),
            hub: hub_divisions.map(|divisions| HubPlate::new(flower, divisions)),
            schedule: Schedule::of(design),
            coordinates: Coordinates::new(flower.reach(sheet.half_width())),
            design,
            sheet,
            flower,
            moduli,
            press: None,
        }
    }

    /// The same flower, to be pressed after the morph.
    pub(super) fn pressed(mut self, procedure: Procedure, pressing: Pressing) -> Self {
        if procedure.is_explicit() {
            self.schedule = Schedule::paced(self.design, Pace::Smooth(pressing.morph_time_s()));
        }
        self.press = Some(ShellPress::new(self.flower, procedure, pressing));
        self
    }

    /// Nodes, reference nodes included.
    pub(super) fn nodes(&self) -> u64 {
        self.mesh_nodes() + 2 * self.count() as u64 + 1
    }

    /// Elements.
    pub(super) fn elements(&self) -> u64 {
        let plate = self.plate().map_or(0, |plate| plate.elements());
        self.flower_elements() + plate
    }

    fn flower_elements(&self) -> u64 {
        self.count() as u64 * self.sheet.elements() + self.hub.map_or(0, |hub| hub.elements())
    }

    fn plate(&self) -> Option<&HubPlate> {
        self.press.as_ref()?.plate.as_ref()
    }

    fn mesh_nodes(&self) -> u64 {
        self.flower_nodes() + self.plate().map_or(0, |plate| plate.nodes())
    }

    fn flower_nodes(&self) -> u64 {
        self.spoke_nodes() + self.hub.map_or(0, |hub| hub.nodes())
    }

    fn spoke_nodes(&self) -> u64 {
        self.count() as u64 * self.sheet.nodes()
    }

    fn count(&self) -> usize {
        self.flower.count
    }

    /// The element type.
    pub(super) fn element(&self) -> &str {
        match &self.press {
            // The only one of the two that explicit dynamics is made for.
            Some(press) if press.procedure.is_explicit() => "S4R",
            _ => &self.design.input().decks.shell_element,
        }
    }

    /// What the deck models, for its title.
    pub(super) fn title(&self, what: &str) -> String {
        if self.press.is_some() { format!("{what} under load") } else { what.to_owned() }
    }

    /// Paragraphs of the heading that both decks have.
    pub(super) fn paragraphs(&self) -> Vec<String> {
        let (count, rim) = (self.count(), self.flower.hub_radius + self.flower.length);
        let (hub_set, hub_node) = match self.hub {
            Some(_) => (", HUB (elements of the hub)", "the rigid hub"),
            None => ("", "the hub, not modelled otherwise"),
        };
        let mut paragraphs = vec![
            format!(
                "Frame: hub at the origin, z up, spoke 1 along +x with its rim at x = {}, the others counter-clockwise.",
                real(rim)
            ),
            format!("Step: {}.", self.schedule.description),
            format!(
                "Sets, for every spoke i = 1 to {count}: MIDLINE-i (mid-line nodes, rim to hub), RIM-i and HUB-i (end \
                 edges, rigid), RP-RIM-i and RP-HUB-i (their reference nodes), SPOKE-i (elements){hub_set}; RP-HUB \
                 ({hub_node}); RP-RIMS and RP-HUBS (all RP-RIM-i, all RP-HUB-i)."
            ),
            "Degrees of freedom and reactions at RP-RIM-i and RP-HUB-i are in the spoke's axes: 1 inward, 2 across, 3 up. \
             With the horizontal force H, the vertical force V and the moment M of one spoke, RP-RIM-i has RF1 = H, \
             RF3 = -V, RM2 = M(0), RP-HUB-i has RF1 = -H, RM2 = -M(L), and RP-HUB, which the hub ends follow, has RF3 = \
             V times the number of spokes."
                .to_owned(),
            "Stresses and strains are in the spoke's axes too: 1 along, 2 across."
                .to_owned(),
            "PHASE-<NAME>: elements whose mixture contains the phase.".to_owned(),
        ];
        paragraphs.extend(self.press.iter().flat_map(ShellPress::paragraphs));
        paragraphs
    }

    /// Everything after the heading. `sets` adds element sets after the spokes' elements.
    pub(super) fn write(
        &self,
        sink: &mut Sink<'_>,
        sets: impl FnOnce(&mut Sink<'_>) -> Result<(), DeckError>,
    ) -> Result<(), DeckError> {
        sink.line("*PREPRINT, ECHO=NO, MODEL=NO, HISTORY=NO, CONTACT=NO")?;
        if self.layout.has_parts() {
            self.parts(sink, sets)?;
            sink.line("*ASSEMBLY, NAME=ASSEMBLY")?;
            for spoke in 0..self.count() {
                systems::instance(sink, &instance(spoke), "SPOKE", self.flower.azimuth_deg(spoke))?;
            }
            if self.hub.is_some() {
                systems::instance(sink, "HUB-PLATE-1", "HUB-PLATE", 0.0)?;
            }
            if self.plate().is_some() {
                systems::instance(sink, "INDENTER-1", "INDENTER", 0.0)?;
            }
            self.assembly(sink)?;
            sink.line("*END ASSEMBLY")?;
        } else {
            self.flat(sink, sets)?;
            self.assembly(sink)?;
        }
        self.properties(sink)?;
        self.step(sink)
    }

    /// The element sets of the phases: slices whose mean modulus mixes some of a phase in.
    pub(super) fn phase_sets(&self, sink: &mut Sink<'_>) -> Result<(), DeckError> {
        let phases = self.design.phases();
        for (k, phase) in phases.phases().iter().enumerate() {
            let mean = |ends: &[f64]| 0.5 * (ends[0] + ends[1]);
            let contains = |(_, ends): &(usize, &[f64])| phases.fractions(mean(ends)).values[k] > 1e-9;
            let slices: Vec<usize> = self.moduli.windows(2).enumerate().filter(contains).map(|(i, _)| i).collect();
            if slices.is_empty() {
                continue;
            }
            sink.line(&format!("*ELSET, ELSET=PHASE-{}", phase.label()))?;
            let spokes = if self.layout.has_parts() { 1 } else { self.count() as u64 };
            let of_slice = |slice: &usize| self.sheet.first_element(*slice)..self.sheet.first_element(*slice + 1);
            let elements = self.sheet.elements();
            sink.list((0..spokes).flat_map(|spoke| {
                let slices = &slices;
                slices.iter().flat_map(of_slice).map(move |e| spoke * elements + e)
            }))?;
        }
        Ok(())
    }

    /// The element set of a slice, in the part or in all spokes.
    pub(super) fn slice_set(&self, sink: &mut Sink<'_>, slice: usize) -> Result<(), DeckError> {
        let name = format!("SLICE-{}", slice + 1);
        let (first, next) = (self.sheet.first_element(slice), self.sheet.first_element(slice + 1));
        if self.layout.has_parts() {
            return sets::element_range(sink, &name, "", first, next - 1);
        }
        // One by one: several ranges in a set are more than some readers of flat decks take.
        sink.line(&format!("*ELSET, ELSET={name}"))?;
        let elements = self.sheet.elements();
        sink.list((0..self.count() as u64).flat_map(|spoke| (first..next).map(move |e| spoke * elements + e)))
    }

    fn parts(
        &self,
        sink: &mut Sink<'_>,
        sets: impl FnOnce(&mut Sink<'_>) -> Result<(), DeckError>,
    ) -> Result<(), DeckError> {
        sink.line("*PART, NAME=SPOKE")?;
        sink.line("*NODE")?;
        shell_nodes::spokes(sink, &self.sheet, &self.flower, 1, self.coordinates)?;
        sink.line(&format!("*ELEMENT, TYPE={}, ELSET=SPOKE", self.element()))?;
        shell_elements::spokes(sink, &self.sheet, 1)?;
        sets(sink)?;
        systems::orientation(sink, "ALONG", self.flower.outward(0))?;
        self.section(sink, "SPOKE", "GRADED", ", ORIENTATION=ALONG")?;
        sink.line("*END PART")?;
        if let Some(hub) = &self.hub {
            sink.line("*PART, NAME=HUB-PLATE")?;
            sink.line("*NODE")?;
            shell_nodes::hub(sink, hub, 0, self.coordinates)?;
            sink.line(&format!("*ELEMENT, TYPE={}, ELSET=HUB", self.element()))?;
            shell_elements::hub(sink, hub, 0, 0)?;
            self.section(sink, "HUB", "HUB", "")?;
            sink.line("*END PART")?;
        }
        if let Some(press) = &self.press
            && let Some(plate) = &press.plate
        {
            sink.line("*PART, NAME=INDENTER")?;
            sink.line("*NODE")?;
            shell_nodes::plate(sink, plate, 0, press.height_mm(), self.coordinates)?;
            sink.line("*ELEMENT, TYPE=R3D4, ELSET=INDENTER")?;
            shell_elements::hub(sink, plate, 0, 0)?;
            sink.line("*END PART")?;
        }
        Ok(())
    }

    fn flat(
        &self,
        sink: &mut Sink<'_>,
        sets: impl FnOnce(&mut Sink<'_>) -> Result<(), DeckError>,
    ) -> Result<(), DeckError> {
        let count = self.count();
        let elements = count as u64 * self.sheet.elements();
        sink.line("*NODE")?;
        shell_nodes::spokes(sink, &self.sheet, &self.flower, count, self.coordinates)?;
        if let Some(hub) = &self.hub {
            shell_nodes::hub(sink, hub, self.spoke_nodes(), self.coordinates)?;
        }
        if let Some(press) = &self.press
            && let Some(plate) = &press.plate
        {
            shell_nodes::plate(sink, plate, self.flower_nodes(), press.height_mm(), self.coordinates)?;
        }
        for (name, node, position) in self.references() {
            nodes::more_nodes(sink, &[(&name, node, position)])?;
        }
        sink.line(&format!("*ELEMENT, TYPE={}, ELSET=SPOKES", self.element()))?;
        shell_elements::spokes(sink, &self.sheet, count)?;
        if let Some(hub) = &self.hub {
            sink.line(&format!("*ELEMENT, TYPE={}, ELSET=HUB", self.element()))?;
            shell_elements::hub(sink, hub, self.spoke_nodes(), elements)?;
        }
        if let Some(plate) = self.plate() {
            sink.line("*ELEMENT, TYPE=R3D4, ELSET=INDENTER")?;
            shell_elements::hub(sink, plate, self.flower_nodes(), self.flower_elements())?;
        }
        sets(sink)?;
        // One section a spoke, for its axes.
        for spoke in 0..count {
            let (axes, skip) = (format!("ALONG-{}", spoke + 1), spoke as u64 * self.sheet.elements());
            sets::element_range(sink, &instance(spoke), "", skip + 1, skip + self.sheet.elements())?;
            systems::orientation(sink, &axes, self.flower.outward(spoke))?;
            self.section(sink, &instance(spoke), "GRADED", &format!(", ORIENTATION={axes}"))?;
        }
        if self.hub.is_some() {
            self.section(sink, "HUB", "HUB", "")?;
        }
        Ok(())
    }

    fn section(&self, sink: &mut Sink<'_>, set: &str, material: &str, options: &str) -> Result<(), DeckError> {
        let controls = if self.reduced() { ", CONTROLS=ENHANCED" } else { "" };
        sink.line(&format!("*SHELL SECTION, ELSET={set}, MATERIAL={material}{controls}{options}"))?;
        sink.line(&format!("{},{POINTS}", real(self.design.input().strips.thickness_mm)))
    }

    /// Whether the element is integrated at one point and needs control of its hourglass modes.
    fn reduced(&self) -> bool {
        self.element() == "S4R"
    }

    /// Label of the first reference node: in an assembly, they are numbered on their own.
    fn first_reference(&self) -> u64 {
        1 + if self.layout.has_parts() { 0 } else { self.mesh_nodes() }
    }

    /// Node set, label and position of all reference nodes: rims, hub ends, hub.
    fn references(&self) -> Vec<(String, u64, [f64; 3])> {
        let ends = [("RP-RIM", 0.0), ("RP-HUB", self.flower.length)];
        let ends = ends.into_iter().flat_map(|(name, s)| (0..self.count()).map(move |spoke| (name, s, spoke)));
        let place = |(name, s, spoke): (&str, f64, usize)| {
            let [x, y] = self.flower.place(spoke, s, 0.0);
            (format!("{name}-{}", spoke + 1), [x, y, 0.0])
        };
        let all = ends.map(place).chain(std::iter::once(("RP-HUB".to_owned(), [0.0; 3])));
        (self.first_reference()..).zip(all).map(|(node, (name, position))| (name, node, position)).collect()
    }

    /// Reference nodes, sets of the whole model, constraints.
    fn assembly(&self, sink: &mut Sink<'_>) -> Result<(), DeckError> {
        let (parts, count) = (self.layout.has_parts(), self.count() as u64);
        let first = self.first_reference();
        if parts {
            for (name, node, position) in self.references() {
                nodes::reference_nodes(sink, &[(&name, node, position)])?;
            }
        } else {
            for (name, node, _) in self.references() {
                sets::node_list(sink, &name, "", std::iter::once(node))?;
            }
        }
        sets::node_range(sink, "RP-RIMS", "", first, first + count - 1)?;
        sets::node_range(sink, "RP-HUBS", "", first + count, first + 2 * count - 1)?;
        self.sets(sink)?;
        for (i, outward) in (0..self.count()).map(|spoke| (spoke + 1, self.flower.outward(spoke))) {
            systems::transform(sink, &format!("RP-RIM-{i}"), outward)?;
            systems::transform(sink, &format!("RP-HUB-{i}"), outward)?;
            ties::rigid_edge(sink, &format!("RIM-{i}"), &format!("RP-RIM-{i}"))?;
            ties::rigid_edge(sink, &format!("HUB-{i}"), &format!("RP-HUB-{i}"))?;
        }
        match (&self.press, self.hub.is_some()) {
            (Some(press), hub) => press.hub(sink, hub.then_some("HUB-PLATE"), self.stiffest())?,
            (None, true) => ties::rigid_edge(sink, "HUB-PLATE", "RP-HUB")?,
            (None, false) => {}
        }
        // The followers come first: RP-HUB keeps its degree of freedom, to be free or prescribed.
        (1..=count).try_for_each(|i| ties::follow(sink, &format!("RP-HUB-{i}"), "RP-HUB", 3))?;
        self.press.as_ref().map_or(Ok(()), |press| press.surfaces(sink, (0..self.count()).map(instance)))
    }

    fn stiffest(&self) -> &Material {
        let phases = self.design.phases().phases();
        &phases[phases.len() - 1]
    }

    /// Sets of the whole model; the element sets of a flat one come with its sections, which need them.
    fn sets(&self, sink: &mut Sink<'_>) -> Result<(), DeckError> {
        let (sheet, parts) = (&self.sheet, self.layout.has_parts());
        let (last, nodes) = (sheet.first_node(sheet.rows() - 1), sheet.nodes());
        for spoke in 0..self.count() {
            let (i, of) = (spoke + 1, self.layout.instance(&instance(spoke)));
            let skip = if parts { 0 } else { spoke as u64 };
            let node = |label: u64| skip * nodes + label;
            sets::node_range(sink, &format!("RIM-{i}"), &of, node(1), node(sheet.first_node(1) - 1))?;
            sets::node_range(sink, &format!("HUB-{i}"), &of, node(last), node(nodes))?;
            let midline = (0..sheet.rows()).map(|row| node(sheet.midline_node(row)));
            sets::node_list(sink, &format!("MIDLINE-{i}"), &format!("{of}, UNSORTED"), midline)?;
            if parts {
                sets::element_range(sink, &instance(spoke), &of, 1, sheet.elements())?;
            }
        }
        if let Some(hub) = &self.hub {
            let of = self.layout.instance("HUB-PLATE-1");
            let skip = if parts { 0 } else { self.spoke_nodes() };
            sets::node_range(sink, "HUB-PLATE", &of, skip + 1, skip + hub.nodes())?;
            if parts {
                sets::element_range(sink, "HUB", &of, 1, hub.elements())?;
            }
        }
        if let Some(plate) = self.plate().filter(|_| parts) {
            sets::element_range(sink, "INDENTER", &self.layout.instance("INDENTER-1"), 1, plate.elements())?;
        }
        Ok(())
    }

    /// Materials, amplitudes and the modulus field.
    fn properties(&self, sink: &mut Sink<'_>) -> Result<(), DeckError> {
        let phases = self.design.phases();
        if self.reduced() {
            sink.line("*SECTION CONTROLS, NAME=ENHANCED, HOURGLASS=ENHANCED")?;
        }
        materials::graded(sink, "GRADED", phases, Law::Linear, self.layout)?;
        let stiffest = self.stiffest();
        if self.hub.is_some() {
            let densities = phases.phases().iter().all(|p| p.density_kg_m3.is_some());
            let hub = Material { name: "HUB".to_owned(), ..stiffest.clone() };
            materials::plain(sink, &hub, Law::Linear, densities)?;
        }
        amplitudes::amplitudes(sink, self.schedule.motions())?;
        if let Some(press) = &self.press {
            amplitudes::amplitudes(sink, press.motion().iter())?;
        }
        let instances: Vec<String> = (0..self.count()).map(|spoke| self.layout.prefix(&instance(spoke))).collect();
        shell_field::modulus(sink, &self.sheet, &instances, &self.moduli)?;
        if self.hub.is_some() {
            // Its material does not depend on the field; a value makes a plot of the field complete.
            sink.line(&format!("HUB-PLATE,{}", real(stiffest.modulus_mpa)))?;
        }
        self.press.as_ref().map_or(Ok(()), |press| press.contact(sink))
    }

    /// The step from the flat flower to the dome.
    fn step(&self, sink: &mut Sink<'_>) -> Result<(), DeckError> {
        match &self.press {
            Some(press) => press.open_morph(sink, self.layout)?,
            None => step::open(sink, self.layout, "MORPH", Increments::MORPH)?,
        }
        boundary::drive(sink, "RP-RIMS", 1, &self.schedule.rim_travel)?;
        boundary::hold(sink, "RP-RIMS", 2, 3)?;
        boundary::hold(sink, "RP-HUBS", 1, 2)?;
        for (set, rotation) in [("RP-RIMS", &self.schedule.rim_rotation), ("RP-HUBS", &self.schedule.hub_rotation)] {
            boundary::hold(sink, set, 4, 4)?;
            boundary::drive(sink, set, 5, rotation)?;
            boundary::hold(sink, set, 6, 6)?;
        }
        boundary::hold(sink, "RP-HUB", 1, 2)?;
        boundary::hold(sink, "RP-HUB", 4, 6)?;
        if let Some(height) = &self.schedule.hub_height {
            boundary::drive(sink, "RP-HUB", 3, height)?;
        }
        let ends = |name: &'static str| (1..=self.count()).map(move |i| format!("{name}-{i}"));
        let references: Vec<String> =
            ends("RP-RIM").chain(ends("RP-HUB")).chain(std::iter::once("RP-HUB".to_owned())).collect();
        let references: Vec<&str> = references.iter().map(String::as_str).collect();
        // Spokes are alike: the history of one mid-line is enough, the field output has them all.
        let requests = |sink: &mut Sink<'_>, often: &[String; 2]| {
            output::abaqus_requests_at(sink, often, "S,LE,FV", &["MIDLINE-1"], &references)
        };
        let Some(press) = &self.press else {
            requests(sink, &output::every_increment(self.nodes()))?;
            return step::close(sink);
        };
        requests(sink, &press.often(self.nodes(), press.pressing.morph_time_s()))?;
        press.energies(sink)?;
        step::close(sink)?;
        press.open_press(sink, self.layout)?;
        requests(sink, &press.often(self.nodes(), press.pressing.press_time_s()))?;
        press.energies(sink)?;
        step::close(sink)
    }
}

/// Name of a spoke's instance and element set.
fn instance(spoke: usize) -> String {
    format!("SPOKE-{}", spoke + 1)
}
