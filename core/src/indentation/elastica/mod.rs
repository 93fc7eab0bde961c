//! Indentation of the graded strip as an elastica.
//!
//! The rim keeps its place and inclination, the hub its distance and inclination and goes down by `D`. The force above that
//! before pressing is `F = V(0) - V`, with `V` at the rim, which also carries what the indenter puts on the spoke beside the
//! hub. The indenter is a flat rigid plate without friction: it starts on the highest point of what it covers and moves
//! with the hub.
//!
//! Forces scale with the modulus, and so do the limits of bending: with `E/(1 - nu^2)` instead of `E` they are larger by
//! `1/(1 - nu^2)`, at the same shapes.

mod chain;
#[cfg(test)]
mod tests;

use chain::{Chain, Hub, Plate, Shape, Stop};

use super::curve::{LoadPoint, rigidity, work};
use super::{
    Indentation, IndentationError, IndentationModel, ModulusBand, PhaseStrain, Press, curve_warnings, smooth_volume,
};
use crate::design::{Design, STATIONS};
use crate::input::{Bending, IndentationInput};
use crate::progress::Share;

/// Stations of the profile in a link.
const STRIDE: usize = 4;
/// Links of the chain.
const LINKS: usize = (STATIONS - 1) / STRIDE;
/// Parts into which a step is cut at most where Newton's method fails.
const SMALLEST_PART: f64 = 1.0 / 64.0;
/// Steps to the thickness where only the rigidity is asked for.
const RIGIDITY_STEPS: usize = 8;

/// Presses a dome.
///
/// # Errors
/// [`IndentationError`] for a strip that is no dome, a depth that it does not have, no equilibrium, or where it was
/// cancelled.
pub fn indent(design: &Design, input: &IndentationInput, progress: Share<'_>) -> Result<Indentation, IndentationError> {
    let press = Press::new(design, input)?;
    let depths = (0..=input.steps).map(|i| press.depth_mm * i as f64 / input.steps as f64).collect();
    Run::new(design, input, press)?.curve(depths, progress)
}

/// Presses a dome no further than its rigidity needs: to its thickness, or to the full depth where that is less.
///
/// # Errors
/// Those of [`indent`].
pub fn indent_for_rigidity(
    design: &Design,
    input: &IndentationInput,
    progress: Share<'_>,
) -> Result<Indentation, IndentationError> {
    let press = Press::new(design, input)?;
    let reach = press.depth_mm.min(design.input().strips.thickness_mm);
    let depths = (0..=RIGIDITY_STEPS).map(|i| reach * i as f64 / RIGIDITY_STEPS as f64).collect();
    Run::new(design, input, press)?.curve(depths, progress)
}

/// A dome in the press.
struct Run<'a> {
    design: &'a Design,
    input: &'a IndentationInput,
    press: Press,
    chain: Chain,
    start: Shape,
    /// Height of the hub and of the plate before pressing, mm.
    height: f64,
    plate: f64,
    /// Forces of the limit of bending over those of beams.
    factor: f64,
}

impl<'a> Run<'a> {
    fn new(design: &'a Design, input: &'a IndentationInput, press: Press) -> Result<Self, IndentationError> {
        let guide = design.guide().ok_or(IndentationError::NotADome)?;
        let ends = guide.ends(1.0);
        let profile = design.profile();
        let chain = Chain {
            link: design.input().strips.length_mm / LINKS as f64,
            stiffness: stiffness(design),
            half_thickness: 0.5 * design.input().strips.thickness_mm,
            angles: [ends.rim_angle, ends.hub_angle],
            span: ends.span,
        };
        let forces = design.forces();
        let guess = Shape {
            inclination: (0..LINKS).map(|j| profile.inclination[STRIDE * j + STRIDE / 2]).collect(),
            horizontal: forces.horizontal,
            vertical: forces.vertical,
            contact: Vec::new(),
            iterations: 0,
        };
        let hub = ends.height.map_or(Hub::Force(0.0), Hub::Height);
        let start = chain.solve(&guess, hub, None).map_err(|stop| located(stop, 0.0))?;
        let height = chain.positions(&start.inclination)[LINKS][1];
        let mut run = Self { design, input, press, chain, start, height, plate: height, factor: 1.0 };
        if input.bending == Bending::PlaneStrain {
            run.factor = 1.0 / (1.0 - design.mean_poisson().powi(2));
        }
        if let Some(reach) = run.reach() {
            let face = run.chain.upper_face(&run.start.inclination);
            let covered = face.iter().filter(|[x, _]| *x >= run.chain.span - reach);
            // The hub's own upper face is that of the spoke's end, whatever way that looks.
            let hub = face.last().map_or(height, |p| p[1]);
            run.plate = covered.fold(hub, |m, [_, z]| m.max(*z));
        }
        Ok(run)
    }

    /// How far from the hub end the indenter reaches, mm.
    fn reach(&self) -> Option<f64> {
        self.press.radius_mm.map(|r| r - self.design.input().hub_radius()).filter(|r| *r > 0.0)
    }

    fn curve(&self, depths: Vec<f64>, progress: Share<'_>) -> Result<Indentation, IndentationError> {
        let input = self.input;
        let (tangent, stable) = self.chain.stiffness_at(&self.start).unwrap_or((f64::NAN, true));
        let start_energy = self.chain.energy(&self.start.inclination);
        let mut curve: Vec<LoadPoint> = Vec::with_capacity(depths.len());
        let (mut shape, mut penetration) = (self.start.clone(), 0.0_f64);
        let mut lost = (!stable).then_some(0.0);
        let last = depths.last().copied().unwrap_or(1.0);
        for (i, depth) in depths.iter().enumerate() {
            if !progress(if last > 0.0 { depth / last } else { 0.0 }) {
                return Err(IndentationError::Cancelled);
            }
            if i > 0 {
                shape = self.pressed(&shape, depths[i - 1], *depth)?;
            }
            if lost.is_none() && shape.contact.is_empty() && self.chain.stiffness_at(&shape).is_some_and(|s| !s.1) {
                lost = Some(*depth);
            }
            penetration = penetration.max(self.penetration(&shape, *depth));
            curve.push(self.point(&shape, *depth, start_energy));
        }
        let [volume, mean_modulus] = smooth_volume(self.design);
        let strain = curve.iter().fold(0.0_f64, |m, p| m.max(p.largest_strain));
        let largest = PhaseStrain::of_mixture(self.design, strain);
        let mut warnings = curve_warnings(&curve, lost);
        warnings.extend(largest.warnings());
        let work = work(&curve);
        let band = ModulusBand::new(self.design, input);
        Ok(Indentation {
            model: IndentationModel::Elastica,
            indenter: input.indenter,
            bending: Some(input.bending),
            spokes: self.design.input().count(),
            start_force_n: 0.0 - self.factor * self.start.vertical,
            tangent_n_mm: self.factor * tangent,
            rigidity_n_mm: rigidity(&curve, self.design.input().strips.thickness_mm),
            work_nmm: work,
            strain_energy_nmm: curve.last().map_or(0.0, |p| p.strain_energy_nmm),
            specific_energy_nmm_mm3: work / volume,
            volume_mm3: volume,
            mean_modulus_mpa: mean_modulus,
            largest_strain: vec![largest],
            warnings,
            modulus_band_percent: band.percent,
            modulus_band_from: band.source,
            penetration_mm: penetration,
            curve,
        })
    }

    /// The shape at a depth, from that at a smaller one.
    fn pressed(&self, from: &Shape, shallow: f64, deep: f64) -> Result<Shape, IndentationError> {
        let (mut shape, mut at, mut part) = (from.clone(), 0.0, 1.0);
        loop {
            let to = if at + part >= 1.0 - 1e-9 { 1.0 } else { at + part };
            let depth = shallow + to * (deep - shallow);
            match self.chain.solve(&shape, Hub::Height(self.height - depth), self.plate(depth)) {
                Ok(found) if to == 1.0 => return Ok(found),
                Ok(found) => (shape, at) = (found, to),
                Err(_) if part > SMALLEST_PART => part *= 0.5,
                Err(stop) => return Err(located(stop, depth)),
            }
        }
    }

    fn plate(&self, depth: f64) -> Option<Plate> {
        self.reach().map(|reach| Plate { height: self.plate - depth, reach })
    }

    /// How deep the upper face is inside the plate, mm.
    fn penetration(&self, shape: &Shape, depth: f64) -> f64 {
        let Some(plate) = self.plate(depth) else { return 0.0 };
        let face = self.chain.upper_face(&shape.inclination);
        let covered = face.iter().filter(|[x, _]| *x >= self.chain.span - plate.reach);
        covered.fold(0.0, |m, [_, z]| m.max(z - plate.height))
    }

    fn point(&self, shape: &Shape, depth: f64, start_energy: f64) -> LoadPoint {
        let bent = self.chain.curvatures(&shape.inclination).into_iter().fold(0.0_f64, |m, k| m.max(k.abs()));
        // From the first touching node to the hub, since the plate lies on the hub.
        let length = shape.contact.first().map_or(0.0, |(i, _)| (LINKS - i) as f64 * self.chain.link);
        LoadPoint {
            depth_mm: depth,
            force_n: self.factor * (self.start.vertical - shape.rim_vertical()),
            contact_force_n: self.factor * shape.contact_force() + 0.0,
            contact_length_mm: length,
            strain_energy_nmm: self.factor * (self.chain.energy(&shape.inclination) - start_energy),
            largest_strain: self.chain.half_thickness * bent,
            iterations: shape.iterations,
        }
    }
}

/// Bending stiffness of the chain's nodes: the springs are as flexible as the half links beside them together.
fn stiffness(design: &Design) -> Vec<f64> {
    let profile = design.profile();
    let third = design.input().strips.thickness_mm.powi(3) / 12.0;
    let flexibility = |i: usize| 1.0 / (third * profile.width[i] * profile.modulus_mpa[i]);
    // Trapezoidal rule over the half links beside the node.
    let mean = |from: usize, to: usize| {
        let inner: f64 = (from + 1..to).map(flexibility).sum();
        (0.5 * (flexibility(from) + flexibility(to)) + inner) / (to - from) as f64
    };
    let node = |i: usize| {
        let (at, half) = (STRIDE * i, STRIDE / 2);
        1.0 / mean(at.saturating_sub(half), (at + half).min(STRIDE * LINKS))
    };
    (0..=LINKS).map(node).collect()
}

fn located(stop: Stop, depth_mm: f64) -> IndentationError {
    match stop {
        Stop::Diverged { iterations, residual } => IndentationError::NoEquilibrium { depth_mm, iterations, residual },
        Stop::Unsettled { rounds, changes } => IndentationError::Contact { depth_mm, rounds, changes },
    }
}
