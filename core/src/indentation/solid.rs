//! Indentation of one spoke in finite elements, graded or with every voxel resolved.
//!
//! The strip is closed first ([`crate::fem::morph`]), then its hub section goes down while the rim section is held. The indenter is a flat rigid
//! plane over the nodes of the upper face within its radius; it starts on the highest of them and moves with the hub. By
//! symmetry the neighbouring spokes are two vertical planes through the dome's axis, `|y| = tan(pi/N) rho`, for the nodes of the
//! sides.
//!
//! A strip whose mid-surface closes the dome without gaps overlaps its neighbours below the mid-plane: at a height `zeta` above it by
//! `-tan(pi/N) zeta sin(theta)` a side. That overlap is allowed; what rounded voxels reach beyond it is not, so their edges press.
//!
//! Contact is that of [`crate::fem::contact`]. The force is what the rim section carries more than before.

use super::curve::{LoadPoint, rigidity, tangent, work};
use super::{Indentation, IndentationError, IndentationModel, ModulusBand, PhaseStrain, Press, smooth_volume};
use crate::design::Design;
use crate::elastica::tessellation;
use crate::fem::assembly::State;
use crate::fem::contact::{Contact, Obstacle};
use crate::fem::model::MIXTURE;
use crate::fem::morph::{self, Lead};
use crate::fem::newton::{Equilibrium, Solver, Stop};
use crate::fem::recovery::{ElementResults, reactions};
use crate::fem::{self, Model, MorphOptions, Resolution};
use crate::input::IndentationInput;
use crate::materials::StrainLimits;
use crate::progress::Share;

/// Penetration that contact leaves at most, as a share of the thickness.
const PENETRATION: f64 = 1e-3;
/// Turns of the augmented Lagrangian.
const TURNS: usize = 12;
/// Parts into which a step is cut at most.
const SMALLEST_PART: f64 = 1.0 / 32.0;
/// Share of the progress that closing the dome takes.
const CLOSING: f64 = 0.2;

/// How a solid is pressed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SolidOptions {
    /// Elements.
    pub resolution: Resolution,
    /// Whether the neighbouring spokes stand in the way.
    pub neighbours: bool,
    /// How the strip is closed.
    pub morph: MorphOptions,
}

/// Presses a dome.
///
/// # Errors
/// [`IndentationError`].
pub fn indent(
    design: &Design,
    input: &IndentationInput,
    options: &SolidOptions,
    progress: Share<'_>,
) -> Result<Indentation, IndentationError> {
    let press = Press::new(design, input)?;
    let guide = design.guide().ok_or(IndentationError::NotADome)?;
    let path = match options.resolution {
        Resolution::Voxels(_) => design.voxel_path(),
        Resolution::Graded(_) => design.graded_path().ok().flatten(),
    };
    let model = Model::of_design(design, options.resolution)?;
    let closing = |share: f64| progress(CLOSING * share);
    let closed = morph::solve(&model, &Lead::new(guide, path), &options.morph, &closing)?;
    let limit = options.morph.memory_limit.or_else(fem::memory::default_limit);
    let solver = Solver::new(&model, false, limit, &|| !progress(CLOSING))?;
    let length = design.input().strips.length_mm;
    let run = Run {
        design,
        model: &model,
        press,
        length,
        rim_x: length - guide.ends(1.0).span,
        depth_of_contact: PENETRATION * design.input().strips.thickness_mm,
        start: closed.state.clone(),
        neighbours: options.neighbours,
    };
    run.curve(input, solver, progress)
}

struct Run<'a> {
    design: &'a Design,
    model: &'a Model,
    press: Press,
    length: f64,
    rim_x: f64,
    depth_of_contact: f64,
    start: State,
    neighbours: bool,
}

impl Run<'_> {
    fn curve(
        &self,
        input: &IndentationInput,
        mut solver: Solver<'_>,
        progress: Share<'_>,
    ) -> Result<Indentation, IndentationError> {
        let going = |depth: f64| CLOSING + (1.0 - CLOSING) * depth / self.press.depth_mm;
        let mut state = self.start.clone();
        solver.contact = self.obstacles(&state);
        let plate = self.plate(&state);
        // Forces and energy are counted from the state at no depth, neighbours included.
        let [mut lift, mut energy] = [0.0; 2];
        let mut curve = Vec::with_capacity(input.steps + 1);
        let (mut penetration, mut unstable) = (0.0_f64, None);
        let mut strains = vec![0.0_f64; self.phases()];
        let mut before: Option<State> = None;
        for i in 0..=input.steps {
            let depth = self.press.depth_mm * i as f64 / input.steps as f64;
            let cancelled = || !progress(going(depth));
            if cancelled() {
                return Err(IndentationError::Cancelled);
            }
            let from = self.press.depth_mm * i.saturating_sub(1) as f64 / input.steps as f64;
            let next = self.pressed(&mut solver, &state, before.as_ref(), [from, depth], plate, &cancelled)?;
            let (reached, found, deepest) = next;
            before = Some(std::mem::replace(&mut state, reached));
            if i == 0 {
                [lift, energy] = [self.vertical(&state, &found), found.forces.energy];
            }
            penetration = penetration.max(deepest);
            if found.negative > 0 && unstable.is_none() {
                unstable = Some(depth);
            }
            let results = ElementResults::of(self.model, &state, &cancelled)?;
            let now = self.largest(&results);
            strains.iter_mut().zip(&now).for_each(|(all, now)| *all = all.max(*now));
            curve.push(self.point(&solver.contact, &state, &found, depth, [lift, energy], &now));
        }
        let tangent = tangent(&curve);
        Ok(self.summed(input, curve, strains, [tangent, lift, penetration], unstable))
    }

    fn phases(&self) -> usize {
        if self.mixture() { 1 } else { self.design.phases().phases().len() }
    }

    fn mixture(&self) -> bool {
        self.model.phases.first() == Some(&MIXTURE)
    }

    fn largest(&self, results: &ElementResults) -> Vec<f64> {
        if self.mixture() {
            return vec![results.principal_strains.iter().copied().fold(0.0, f64::max)];
        }
        let found = results.largest_by_phase(&self.model.phases, self.phases());
        found.into_iter().map(|e| e.unwrap_or(0.0)).collect()
    }

    /// `V` at the rim, N.
    fn vertical(&self, state: &State, found: &Equilibrium) -> f64 {
        reactions(&self.model.mesh, &state.displacements, &found.forces, self.rim_x).rim.vertical
    }

    /// Planes of the indenter and of the neighbours, none of them touched yet.
    fn obstacles(&self, state: &State) -> Contact {
        let mesh = &self.model.mesh;
        // About as stiff as the elements: more would hurt Newton's method, less takes more turns.
        let stiffness = self.design.phases().stiffest() * self.length / mesh.plane_count() as f64;
        let mut obstacles = Vec::new();
        let (reach, slope) = (self.reach(), 0.5 * tessellation::width(self.design.input().count(), 1.0));
        let radius = self.design.input().hub_radius();
        let inclination = &self.design.profile().inclination;
        for plane in 1..mesh.plane_count() - 1 {
            let nodes = mesh.plane(plane);
            let step = nodes.len() / mesh.levels;
            let top = nodes.end - step;
            for node in top..nodes.end {
                if reach.is_some_and(|reach| self.length - self.position(state, node)[0] <= reach) {
                    obstacles.push(Obstacle { node, normal: [0.0, 0.0, 1.0], offset: f64::INFINITY, multiplier: 0.0 });
                }
            }
            if !self.neighbours {
                continue;
            }
            let share = mesh.nodes[nodes.start][0] / self.length;
            let theta = inclination[(share * (inclination.len() - 1) as f64).round() as usize];
            for level in 0..mesh.levels {
                let first = nodes.start + level * step;
                for (node, side) in [(first, -1.0), (first + step - 1, 1.0)] {
                    // n = (tan, +-1, 0) cos: |y| + tan x <= tan (r_h + L) + allowed overlap.
                    let cos = 1.0 / slope.hypot(1.0);
                    let allowed = (-slope * mesh.nodes[node][2] * theta.sin()).max(0.0);
                    let offset = cos * (slope * (radius + self.length) + allowed);
                    obstacles.push(Obstacle { node, normal: [cos * slope, cos * side, 0.0], offset, multiplier: 0.0 });
                }
            }
        }
        Contact { obstacles, stiffness }
    }

    fn position(&self, state: &State, node: usize) -> [f64; 3] {
        std::array::from_fn(|k| self.model.mesh.nodes[node][k] + state.displacements[node][k])
    }

    /// How far from the hub end the indenter reaches, mm.
    fn reach(&self) -> Option<f64> {
        self.press.radius_mm.map(|r| r - self.design.input().hub_radius()).filter(|r| *r > 0.0)
    }

    /// Height of the plate before pressing: the highest point of what it covers.
    fn plate(&self, state: &State) -> Option<f64> {
        let (mesh, reach) = (&self.model.mesh, self.reach()?);
        let covered = |node: &usize| self.length - self.position(state, *node)[0] <= reach;
        let heights = (0..mesh.nodes.len()).filter(covered).map(|node| self.position(state, node)[2]);
        Some(heights.fold(f64::NEG_INFINITY, f64::max))
    }

    /// The state at a depth, from that at a smaller one.
    #[allow(clippy::type_complexity, reason = "the three belong together and go to one place")]
    fn pressed(
        &self,
        solver: &mut Solver<'_>,
        from: &State,
        before: Option<&State>,
        [shallow, deep]: [f64; 2],
        plate: Option<f64>,
        cancelled: &(dyn Fn() -> bool + Sync),
    ) -> Result<(State, Equilibrium, f64), IndentationError> {
        let hub = self.model.mesh.plane(self.model.mesh.plane_count() - 1);
        let (mut state, mut at, mut part) = (from.clone(), 0.0, 1.0);
        let kept = solver.contact.clone();
        loop {
            let to = if at + part >= 1.0 - 1e-9 { 1.0 } else { at + part };
            let depth = shallow + to * (deep - shallow);
            let mut trial = state.clone();
            // The first trial goes on as the last step did.
            if let Some(before) = before.filter(|_| at == 0.0 && to == 1.0 && shallow > 0.0) {
                for ((u, now), old) in
                    trial.displacements.iter_mut().zip(&from.displacements).zip(&before.displacements)
                {
                    (0..3).for_each(|k| u[k] += now[k] - old[k]);
                }
            }
            for node in hub.clone() {
                trial.displacements[node] = self.start.displacements[node];
                trial.displacements[node][2] -= depth;
            }
            if let Some(plate) = plate {
                for obstacle in solver.contact.obstacles.iter_mut().filter(|o| o.normal[2] == 1.0) {
                    obstacle.offset = plate - depth;
                }
            }
            match self.solved(solver, &mut trial, cancelled, depth) {
                Ok((found, deepest)) if to == 1.0 => return Ok((trial, found, deepest)),
                Ok(_) => (state, at) = (trial, to),
                Err(IndentationError::NoEquilibrium { .. } | IndentationError::Contact { .. })
                    if part > SMALLEST_PART =>
                {
                    solver.contact = kept.clone();
                    part *= 0.5;
                }
                Err(error) => return Err(error),
            }
        }
    }

    /// Equilibrium with contact: Newton's method between turns of the augmented Lagrangian.
    fn solved(
        &self,
        solver: &mut Solver<'_>,
        state: &mut State,
        cancelled: &(dyn Fn() -> bool + Sync),
        depth_mm: f64,
    ) -> Result<(Equilibrium, f64), IndentationError> {
        let mut iterations = 0;
        for _ in 0..TURNS {
            let mut found = solver.solve(state, cancelled, &|_, _| {}).map_err(|stop| match stop {
                Stop::Diverged { iterations, residual } => {
                    IndentationError::NoEquilibrium { depth_mm, iterations, residual }
                }
                Stop::Final(error) => error.into(),
            })?;
            iterations += found.iterations;
            let deepest = solver.contact.settle(&self.model.mesh, state);
            if deepest <= self.depth_of_contact {
                found.iterations = iterations;
                return Ok((found, deepest.max(0.0)));
            }
        }
        let changes = solver.contact.forces(&self.model.mesh, state).count();
        Err(IndentationError::Contact { depth_mm, rounds: TURNS, changes })
    }

    fn point(
        &self,
        contact: &Contact,
        state: &State,
        found: &Equilibrium,
        depth: f64,
        [lift, energy]: [f64; 2],
        strains: &[f64],
    ) -> LoadPoint {
        let mesh = &self.model.mesh;
        let pressed: Vec<(usize, f64)> =
            contact.forces(mesh, state).filter(|(i, _)| contact.obstacles[*i].normal[2] == 1.0).collect();
        let far = pressed.iter().map(|(i, _)| self.length - mesh.nodes[contact.obstacles[*i].node][0]);
        LoadPoint {
            depth_mm: depth,
            force_n: lift - self.vertical(state, found),
            contact_force_n: pressed.iter().fold(0.0, |sum, (_, p)| sum + p),
            contact_length_mm: far.fold(0.0, f64::max),
            strain_energy_nmm: found.forces.energy - energy,
            largest_strain: strains.iter().copied().fold(0.0, f64::max),
            iterations: found.iterations,
        }
    }

    fn summed(
        &self,
        input: &IndentationInput,
        curve: Vec<LoadPoint>,
        strains: Vec<f64>,
        [tangent, lift, penetration]: [f64; 3],
        unstable: Option<f64>,
    ) -> Indentation {
        let [smooth, mean_modulus] = smooth_volume(self.design);
        let phases = self.design.phases().phases();
        let (model, volume) = if self.mixture() {
            (IndentationModel::Graded, smooth)
        } else {
            (IndentationModel::Voxel, self.design.grid().volume_mm3())
        };
        let of_phase = |(i, strain): (usize, f64)| {
            if self.mixture() {
                PhaseStrain::of_mixture(self.design, strain)
            } else {
                PhaseStrain::new(phases[i].label(), strain, StrainLimits::of(&phases[i]))
            }
        };
        let largest: Vec<PhaseStrain> = strains.into_iter().enumerate().map(of_phase).collect();
        let mut warnings = super::curve_warnings(&curve, unstable);
        warnings.extend(largest.iter().flat_map(PhaseStrain::warnings));
        let work = work(&curve);
        let band = ModulusBand::new(self.design, input);
        Indentation {
            model,
            indenter: input.indenter,
            bending: None,
            spokes: self.design.input().count(),
            start_force_n: 0.0 - lift,
            tangent_n_mm: tangent,
            rigidity_n_mm: rigidity(&curve, self.design.input().strips.thickness_mm),
            work_nmm: work,
            strain_energy_nmm: curve.last().map_or(0.0, |p| p.strain_energy_nmm),
            specific_energy_nmm_mm3: work / volume,
            volume_mm3: volume,
            mean_modulus_mpa: mean_modulus,
            largest_strain: largest,
            modulus_band_percent: band.percent,
            modulus_band_from: band.source,
            penetration_mm: penetration,
            curve,
            warnings,
        }
    }
}
