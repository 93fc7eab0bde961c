//! One spoke as a solid that conducts heat or current, voxel by voxel or graded.
//!
//! Rim and hub are the end faces, everything else is insulated. Heat: the rim is suddenly at 393.15 K, the spoke at 316.15 K;
//! afterwards the hub is held at 316.15 K and the steady flux through the rim shows the conductivity. Current: 1 A enters at
//! the rim, all of whose nodes share one potential, and leaves at the hub, which is ground.

use super::keywords::conduction::{self, Conductor, Transient};
use super::keywords::heading::heading;
use super::keywords::{elements, materials, nodes, sets, step, ties};
use super::layout::Layout;
use super::number::{Coordinates, real};
use super::sink::Sink;
use super::{Deck, DeckError, graded_solid, voxel_solid};
use crate::design::Design;
use crate::input::model::DeckSolver;
use crate::materials::Material;
use crate::mesh::Block;
use crate::output::Provenance;

/// Temperature of the rim, K.
const HOT: f64 = 393.15;
/// Temperature at the start, and of the hub in the steady step, K.
const COLD: f64 = 316.15;
/// Current, A.
const CURRENT: f64 = 1.0;
/// Times of the paper's pictures, s.
const TIMES: [f64; 3] = [100.0, 1000.0, 2000.0];
/// Largest change of temperature in one increment, K.
const CHANGE: f64 = 2.0;
/// Share of the transient step in which the rim gets hot, at least; solvers take no increments below a millionth.
const RISE: f64 = 2e-4;

const PART: &str = "SPOKE";
const INSTANCE: &str = "SPOKE-1";
const POINTS: &str = "PICTURES";
const JUMP: &str = "JUMP";

/// What is conducted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Carrier {
    Heat,
    Current,
}

/// How phases are distributed over elements.
enum Filling {
    /// Every element lies in a voxel of one phase; so many lie along its edge.
    Voxels(usize),
    /// Every slice is a mixture of its own.
    Graded,
}

/// The deck.
pub(super) struct Conduction<'a> {
    design: &'a Design,
    layout: Layout,
    block: Block,
    carrier: Carrier,
    filling: Filling,
    /// Element set, material and conduction of every region.
    regions: Vec<(String, String, Conductor)>,
}

impl<'a> Conduction<'a> {
    /// Every voxel its phase, on the mesh of `voxel_solid`.
    pub(super) fn voxels(design: &'a Design, solver: DeckSolver, carrier: Carrier) -> Result<Self, &'static str> {
        let (block, per_edge, _) = voxel_solid::block(design, solver);
        let phases = design.phases().phases();
        let counts = design.grid().counts(phases.len());
        let present = phases.iter().zip(counts).filter(|(_, n)| *n > 0);
        let region = |m: &Material| (format!("PHASE-{}", m.label()), materials::material_name(m), Conductor::of(m));
        let regions = present.map(|(m, _)| region(m)).collect();
        Self::new(design, solver, block, carrier, Filling::Voxels(per_edge), regions)
    }

    /// The smooth spoke on the mesh of `graded_solid`, one mixture a slice.
    pub(super) fn graded(design: &'a Design, solver: DeckSolver, carrier: Carrier) -> Result<Self, &'static str> {
        let (block, moduli) = graded_solid::block(design, solver);
        let phases = design.phases().phases();
        let region = |(i, ends): (usize, &[f64])| {
            let fractions = design.fractions(0.5 * (ends[0] + ends[1])).values;
            let name = format!("SLICE-{}", i + 1);
            (name.clone(), name, Conductor::mixed(phases, &fractions[..phases.len()]))
        };
        let regions = moduli.windows(2).enumerate().map(region).collect();
        Self::new(design, solver, block, carrier, Filling::Graded, regions)
    }

    fn new(
        design: &'a Design,
        solver: DeckSolver,
        block: Block,
        carrier: Carrier,
        filling: Filling,
        regions: Vec<(String, String, Conductor)>,
    ) -> Result<Self, &'static str> {
        if carrier == Carrier::Current && solver == DeckSolver::Calculix {
            return Err("CalculiX has no elements for current");
        }
        if regions.iter().any(|(.., c)| c.thermal.is_none()) {
            return Err("a phase has no thermal conductivity (conductivity_w_mk)");
        }
        if carrier == Carrier::Current && regions.iter().any(|(.., c)| c.electrical.is_none()) {
            return Err("a phase has no electrical conductivity (electrical_conductivity_s_m)");
        }
        Ok(Self { layout: Layout::new(solver, &design.input().decks), design, block, carrier, filling, regions })
    }

    /// The transient step, where all regions have a density and a specific heat.
    ///
    /// `3.2 L^2/alpha` of the slowest region brings the far end beyond 99.9 % of its rise. The rim gets hot in the time
    /// `h^2/alpha` that heat needs to pass one element: where a face jumps, the nodes beside it first cool down by a quarter of
    /// the jump however short the increment, because linear elements share their heat capacity, and no limit on the change
    /// of temperatures is met.
    fn transient(&self) -> Option<Transient> {
        let slowest = self.regions.iter().map(|(.., c)| c.diffusivity()).collect::<Option<Vec<_>>>()?;
        let slowest = slowest.into_iter().fold(f64::INFINITY, f64::min);
        let length = self.design.input().strips.length_mm;
        let period = rounded_up(3.2 * length * length / slowest);
        let element = length / self.block.slices() as f64;
        let rise = (element * element / slowest).max(RISE * period).min(0.1 * period);
        let mut times: Vec<f64> = TIMES.into_iter().filter(|t| *t < period).collect();
        times.push(period);
        Some(Transient { rise, period, change: CHANGE, times })
    }

    fn paragraphs(&self) -> Vec<String> {
        let length = self.design.input().strips.length_mm;
        let mut text = vec![match self.filling {
            Filling::Voxels(n) => format!(
                "Model: one spoke of voxels of {} mm, each of one phase and {n} x {n} x {n} {} elements.",
                self.design.grid().size_mm(),
                self.element()
            ),
            Filling::Graded => format!(
                "Model: one spoke with its smooth outline, {} elements. Every slice is a material of its own, in which \
                 conductivities and heat capacities of the phases mix by volume, as they do for phases that lie along the \
                 spoke.",
                self.element()
            ),
        }];
        text.push(format!(
            "Frame: the strip lies along x, rim at x = 0, hub at x = {length}, mid-plane z = 0, y across. All faces but \
             rim and hub are insulated."
        ));
        match self.carrier {
            Carrier::Heat => {
                text.push(
                    "Heat: conductivity in N/(s K) = W/(m K), specific heat in mm^2/(s^2 K) = 1e-6 J/(kg K), flux in \
                     mW."
                    .to_owned(),
                );
                let steady = format!("the rim at {HOT} K, the hub at {COLD} K, steady");
                text.push(match self.transient() {
                    Some(transient) => format!(
                        "Steps: (1) all at {COLD} K, the rim at {HOT} K within {} s, the hub insulated, {} s; (2) {steady}. The \
                         specific heats are those of the material library or of the design, not of the paper.",
                        real(transient.rise),
                        real(transient.period)
                    ),
                    None => format!(
                        "Step: {steady}. There is no transient step because a phase has no specific heat or density."
                    ),
                });
            }
            Carrier::Current => {
                text.push(
                    "Current: A, potential in mV (A mV = mW), electrical conductivity in A/(mV mm) = 1e6 S/m. The rim's \
                     nodes share one potential, as under a metal contact, and the current enters through its face; the hub \
                     is ground."
                        .to_owned(),
                );
                text.push(format!(
                    "Step: {CURRENT} A, steady. Joule's heat is switched off (fraction 0), so the temperature stays at \
                     {COLD} K. ABAQUS has no displacement current: charge relaxation is not in this deck."
                ));
            }
        }
        text.push(
            "Sets: MIDLINE (mid-line nodes, rim to hub), RIM and HUB (nodes of the end faces), ALL-NODES.".to_owned(),
        );
        text
    }

    fn element(&self) -> &'static str {
        match self.carrier {
            Carrier::Heat => "DC3D8",
            Carrier::Current => "DC3D8E",
        }
    }

    /// Nodes, elements, sets, up to where materials begin.
    fn model(&self, sink: &mut Sink<'_>) -> Result<(), DeckError> {
        let (parts, block) = (self.layout.has_parts(), &self.block);
        if self.layout.is_abaqus() {
            sink.line("*PREPRINT, ECHO=NO, MODEL=NO, HISTORY=NO, CONTACT=NO")?;
        }
        if parts {
            sink.line(&format!("*PART, NAME={PART}"))?;
        }
        let length = self.design.input().strips.length_mm;
        nodes::nodes(sink, block, Coordinates::new(length.max(block.y(0, 0).abs())))?;
        match self.filling {
            Filling::Voxels(per_edge) => {
                let (grid, phases) = (self.design.grid(), self.design.phases().phases());
                for (i, phase) in phases.iter().enumerate() {
                    let set = format!("PHASE-{}", phase.label());
                    if self.regions.iter().any(|(name, ..)| *name == set) {
                        elements::phase_elements(sink, block, self.element(), &set, (grid, per_edge, i as u8))?;
                    }
                }
            }
            Filling::Graded => {
                elements::elements(sink, block, self.element(), "SPOKE")?;
                for (i, (set, ..)) in self.regions.iter().enumerate() {
                    let range = (block.first_element(i), block.first_element(i + 1) - 1);
                    sets::element_ranges(sink, set, std::iter::once(range))?;
                }
            }
        }
        for (set, material, _) in &self.regions {
            sink.line(&format!("*SOLID SECTION, ELSET={set}, MATERIAL={material}"))?;
        }
        if parts {
            sink.line("*END PART")?;
            sink.line("*ASSEMBLY, NAME=ASSEMBLY")?;
            sink.line(&format!("*INSTANCE, NAME={INSTANCE}, PART={PART}"))?;
            sink.line("*END INSTANCE")?;
        }
        self.sets(sink)?;
        if parts {
            sink.line("*END ASSEMBLY")?;
        }
        Ok(())
    }

    fn sets(&self, sink: &mut Sink<'_>) -> Result<(), DeckError> {
        let (instance, block) = (self.layout.instance(INSTANCE), &self.block);
        let planes = block.planes();
        let rim = (block.first_node(0), block.first_node(1) - 1);
        sets::node_range(sink, "ALL-NODES", &instance, 1, block.nodes())?;
        sets::node_range(sink, "RIM", &instance, rim.0, rim.1)?;
        sets::node_range(sink, "HUB", &instance, block.first_node(planes - 1), block.nodes())?;
        let unsorted = if self.layout.is_abaqus() { ", UNSORTED" } else { "" };
        let midline = (0..planes).map(|p| block.midline_node(p));
        sets::node_list(sink, "MIDLINE", &format!("{instance}{unsorted}"), midline)?;
        if self.carrier == Carrier::Current {
            sets::node_list(sink, "RIM-FIRST", &instance, std::iter::once(rim.0))?;
            sets::node_range(sink, "RIM-OTHERS", &instance, rim.0 + 1, rim.1)?;
            let last = block.first_element(1) - 1;
            sets::element_range(sink, "RIM-ELEMENTS", &instance, block.first_element(0), last)?;
            sink.line("*SURFACE, TYPE=ELEMENT, NAME=RIM-FACE")?;
            sink.line("RIM-ELEMENTS,S6")?;
            ties::follow(sink, "RIM-OTHERS", "RIM-FIRST", 9)?;
        }
        Ok(())
    }

    fn heat_steps(&self, sink: &mut Sink<'_>) -> Result<(), DeckError> {
        let abaqus = self.layout.is_abaqus();
        let open = |sink: &mut Sink<'_>, name: &str| {
            sink.line(&if abaqus { format!("*STEP, NAME={name}, INC=2000") } else { "*STEP, INC=2000".to_owned() })
        };
        if let Some(Transient { rise, period, change, .. }) = self.transient() {
            open(sink, "HEATING")?;
            sink.line(&format!("*HEAT TRANSFER, DELTMX={}", real(change)))?;
            let [first, period, least, most] = [rise / 50.0, period, 1e-6 * period, 0.01 * period].map(real);
            sink.line(&format!("{first},{period},{least},{most}"))?;
            sink.line(&format!("*BOUNDARY, AMPLITUDE={JUMP}"))?;
            sink.line(&format!("RIM,11,11,{}", real(HOT)))?;
            self.heat_output(sink, true)?;
            step::close(sink)?;
        }
        open(sink, "STEADY")?;
        sink.line("*HEAT TRANSFER, STEADY STATE")?;
        sink.line("1.,1.,1e-5,1.")?;
        conduction::held(sink, "RIM", 11, HOT)?;
        conduction::held(sink, "HUB", 11, COLD)?;
        self.heat_output(sink, false)?;
        step::close(sink)
    }

    fn heat_output(&self, sink: &mut Sink<'_>, transient: bool) -> Result<(), DeckError> {
        let points = if transient { format!(", TIME POINTS={POINTS}") } else { String::new() };
        if !self.layout.is_abaqus() {
            sink.line(&format!("*NODE PRINT, NSET=MIDLINE{points}"))?;
            sink.line("NT")?;
            sink.line(&format!("*NODE PRINT, NSET=RIM, TOTALS=ONLY{points}"))?;
            sink.line("RFL")?;
            sink.line(&format!("*NODE FILE{points}"))?;
            return sink.line("NT");
        }
        sink.line(&format!("*OUTPUT, FIELD{points}"))?;
        sink.line("*NODE OUTPUT")?;
        sink.line("NT,RFL")?;
        sink.line("*ELEMENT OUTPUT")?;
        sink.line("HFL")?;
        sink.line("*OUTPUT, HISTORY, FREQUENCY=1")?;
        for (set, variables) in [("MIDLINE", "NT"), ("RIM", "RFL")] {
            sink.line(&format!("*NODE OUTPUT, NSET={set}"))?;
            sink.line(variables)?;
        }
        Ok(())
    }

    fn current_step(&self, sink: &mut Sink<'_>) -> Result<(), DeckError> {
        let strips = &self.design.input().strips;
        let area = -2.0 * self.block.y(0, self.first_row()) * strips.thickness_mm;
        sink.line("*STEP, NAME=CURRENT, INC=100")?;
        sink.line("*COUPLED THERMAL-ELECTRICAL, STEADY STATE")?;
        sink.line("1.,1.,1e-5,1.")?;
        conduction::held(sink, "HUB", 9, 0.0)?;
        conduction::held(sink, "RIM", 11, COLD)?;
        conduction::held(sink, "HUB", 11, COLD)?;
        sink.line("*DSECURRENT")?;
        sink.line(&format!("RIM-FACE,CS,{}", real(CURRENT / area)))?;
        sink.line("*OUTPUT, FIELD")?;
        sink.line("*NODE OUTPUT")?;
        sink.line("EPOT,NT")?;
        sink.line("*ELEMENT OUTPUT")?;
        sink.line("EPG,ECD")?;
        sink.line("*OUTPUT, HISTORY, FREQUENCY=1")?;
        sink.line("*NODE OUTPUT, NSET=MIDLINE")?;
        sink.line("EPOT")?;
        sink.line("*NODE OUTPUT, NSET=HUB")?;
        sink.line("RECUR")?;
        step::close(sink)
    }

    /// Index, in the rim's plane of nodes, of the outermost node of the first slice, which may be narrower than the plane.
    fn first_row(&self) -> usize {
        (self.block.plane_across(0) - self.block.slice_across(0)) / 2
    }
}

/// Two significant digits, rounded up.
fn rounded_up(seconds: f64) -> f64 {
    let unit = 10_f64.powf(seconds.log10().floor() - 1.0);
    let rounded = (seconds / unit).ceil() * unit;
    format!("{rounded:.1e}").parse().unwrap_or(rounded)
}

impl Deck for Conduction<'_> {
    fn nodes(&self) -> u64 {
        self.block.nodes()
    }

    fn elements(&self) -> u64 {
        self.block.elements()
    }

    fn midline(&self) -> Option<Vec<[f64; 3]>> {
        Some(self.block.midline())
    }

    fn write(&self, provenance: &Provenance, sink: &mut Sink<'_>) -> Result<(), DeckError> {
        let model = match (&self.filling, self.carrier) {
            (Filling::Voxels(_), Carrier::Heat) => "voxel heat",
            (Filling::Voxels(_), Carrier::Current) => "voxel current",
            (Filling::Graded, Carrier::Heat) => "graded heat",
            (Filling::Graded, Carrier::Current) => "graded current",
        };
        heading(sink, &self.design.input().name, model, provenance, &self.paragraphs())?;
        self.model(sink)?;
        for (_, name, conductor) in &self.regions {
            conduction::material(sink, name, conductor, self.carrier == Carrier::Current)?;
        }
        conduction::initial_temperature(sink, "ALL-NODES", COLD)?;
        match self.carrier {
            Carrier::Heat => {
                if let Some(transient) = self.transient() {
                    sink.line(&format!("*AMPLITUDE, NAME={JUMP}"))?;
                    sink.line(&format!("0,{},{},1.", real(COLD / HOT), real(transient.rise)))?;
                    conduction::time_points(sink, POINTS, &transient.times)?;
                }
                self.heat_steps(sink)
            }
            Carrier::Current => self.current_step(sink),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::rounded_up;

    #[test]
    fn periods_are_round_and_never_shorter() {
        assert_eq!((rounded_up(23_456.0), rounded_up(0.0123), rounded_up(1000.0)), (24_000.0, 0.013, 1000.0));
    }
}
