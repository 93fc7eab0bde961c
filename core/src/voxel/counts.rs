//! How many voxels of each phase a slice gets.
//!
//! Rounding the width to whole voxels changes the stiffness, so the fraction is chosen for the product:
//! `E_slice w_voxel = E w`. What rounding the counts leaves over, at most half a step of the pattern, is carried into the
//! next slice, so errors do not add up along the strip; what the phases cannot reach at all is never carried.

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::grid::VoxelGrid;
use super::lattice::Lattice;
use super::pattern::Pattern;
use super::section::{layer_stiffness, section};
use crate::elastica::forward::Section;
use crate::micromechanics::PhaseSet;
use crate::micromechanics::calibration::MixtureRule;
use crate::progress::{Cancelled, never};

/// Which property of the slice meets its target.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Match {
    /// The Voigt modulus (Kansara et al. 2023).
    Modulus,
    /// The bending stiffness of the voxels where they are, about the section's own neutral axis.
    Stiffness,
    /// The modulus in bending by the rule that cells of the same phases, pattern and layers were found to follow.
    Calibrated,
}

/// What a slice should be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SliceTarget {
    /// Smooth width at the slice's centre, mm.
    pub width_mm: f64,
    /// Designed modulus there, MPa.
    pub modulus_mpa: f64,
    /// Width in voxels, halved.
    pub half_width: usize,
}

/// One slice of the voxelised strip.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slice {
    /// Arc length of its centre, mm.
    pub s_mm: f64,
    /// Half-width in voxels.
    pub half_width: usize,
    /// Voxels of each phase, softest first.
    pub counts: [u32; 3],
    /// Modulus the slice should have, `E w / w_voxel`, MPa.
    pub modulus_target_mpa: f64,
    /// Modulus of its voxels, MPa: Voigt's, or the one of a calibrated rule.
    pub modulus_mpa: f64,
    /// Bending stiffness it should have, `E w t^3 / 12`, N mm^2.
    pub stiffness_target_nmm2: f64,
    /// Bending properties of its voxels: plane sections of the voxels where they are, or a calibrated rule's stiffness.
    pub section: Section,
    /// The target lies outside what the phases reach.
    pub clamped: bool,
    /// Three phases: the intermediate fraction had to be reduced.
    pub intermediate_reduced: bool,
}

/// How to fill a strip.
#[derive(Debug, Clone, Copy)]
pub struct Filling<'a> {
    /// The phases.
    pub phases: &'a PhaseSet,
    /// Their arrangement.
    pub pattern: Pattern,
    /// Seed of the random patterns.
    pub seed: u64,
    /// Which property meets its target.
    pub matching: Match,
    /// The rule of [`Match::Calibrated`]; without one Voigt's rule takes its place.
    pub rule: Option<&'a MixtureRule>,
}

impl Filling<'_> {
    /// The Voigt modulus of the mixture whose modulus by the design's rule is `modulus_mpa`.
    fn voigt_of(&self, modulus_mpa: f64) -> f64 {
        let between = |rule: &MixtureRule| {
            let fraction = rule.fraction(modulus_mpa);
            (1.0 - fraction) * self.phases.softest() + fraction * self.phases.stiffest()
        };
        self.calibrated().map_or(modulus_mpa, between)
    }

    fn calibrated(&self) -> Option<&MixtureRule> {
        self.rule.filter(|_| self.matching == Match::Calibrated)
    }
}

/// Fills a strip with voxels, slice by slice from rim to hub.
#[must_use]
pub fn fill(lattice: &Lattice, targets: &[SliceTarget], filling: &Filling<'_>) -> (VoxelGrid, Vec<Slice>) {
    fill_unless(lattice, targets, filling, &never).unwrap_or_else(|| unreachable!("nothing cancels it"))
}

/// As [`fill`], but asks `cancelled` before every slice and returns `None` once it says so.
#[must_use]
pub fn fill_unless(
    lattice: &Lattice,
    targets: &[SliceTarget],
    filling: &Filling<'_>,
    cancelled: Cancelled<'_>,
) -> Option<(VoxelGrid, Vec<Slice>)> {
    let moduli = filling.phases.moduli();
    let size = lattice.size_mm;
    let mut slices = match filling.matching {
        Match::Modulus | Match::Calibrated => counts_by_modulus(lattice, targets, filling, cancelled)?,
        Match::Stiffness => counts_by_stiffness(lattice, targets, filling, cancelled)?,
    };
    let mut grid = VoxelGrid::new(size, lattice.layers, targets.iter().map(|t| t.half_width).collect());
    grid.slices_mut().into_par_iter().zip(slices.par_iter_mut()).enumerate().try_for_each(|(i, (voxels, slice))| {
        if cancelled() {
            return None;
        }
        let order = filling.pattern.order(slice.half_width, lattice.layers, filling.seed, i);
        place(voxels, &order, &slice.counts);
        slice.section = section(&layer_stiffness(voxels, lattice.layers, &moduli, size), size);
        if filling.calibrated().is_some() {
            let (width, thickness) = (2.0 * slice.half_width as f64 * size, lattice.layers as f64 * size);
            slice.section.stiffness = slice.modulus_mpa * width * thickness.powi(3) / 12.0;
        }
        Some(())
    })?;
    Some((grid, slices))
}

/// Gives the first places of the order to the softest phase, and so on.
fn place(voxels: &mut [u8], order: &[u32], counts: &[u32; 3]) {
    let (first, second) = (counts[0] as usize, (counts[0] + counts[1]) as usize);
    for (rank, place) in order.iter().enumerate() {
        voxels[*place as usize] = if rank < first {
            0
        } else if rank < second {
            1
        } else {
            2
        };
    }
}

/// Residues carried from slice to slice, in voxels.
#[derive(Default, Clone, Copy)]
struct Carry {
    intermediate: f64,
    rigid: f64,
}

fn counts_by_modulus(
    lattice: &Lattice,
    targets: &[SliceTarget],
    filling: &Filling<'_>,
    cancelled: Cancelled<'_>,
) -> Option<Vec<Slice>> {
    let mut carry = Carry::default();
    targets
        .iter()
        .enumerate()
        .map(|(i, target)| {
            if cancelled() {
                return None;
            }
            let mut slice = blank(lattice, i, target, filling);
            let voigt = filling.voigt_of(slice.modulus_target_mpa);
            (slice.counts, carry) = count(voigt, &slice, lattice, filling, carry);
            slice.modulus_mpa = mean_modulus(&slice.counts, filling);
            Some(slice)
        })
        .collect()
}

/// A slice with its targets and no voxels.
fn blank(lattice: &Lattice, i: usize, target: &SliceTarget, filling: &Filling<'_>) -> Slice {
    let voxel_width = 2.0 * target.half_width as f64 * lattice.size_mm;
    let thickness = lattice.layers as f64 * lattice.size_mm;
    let wanted = target.modulus_mpa * target.width_mm / voxel_width;
    let fractions = filling.phases.fractions(wanted);
    Slice {
        s_mm: lattice.centre(i),
        half_width: target.half_width,
        counts: [0; 3],
        modulus_target_mpa: wanted,
        modulus_mpa: 0.0,
        stiffness_target_nmm2: target.modulus_mpa * target.width_mm * thickness.powi(3) / 12.0,
        section: Section { stiffness: 0.0, neutral_offset: 0.0 },
        clamped: fractions.clamped,
        intermediate_reduced: fractions.intermediate_reduced,
    }
}

/// Whole voxels, in steps the pattern allows, for a modulus; with the residues before and after.
fn count(modulus: f64, slice: &Slice, lattice: &Lattice, filling: &Filling<'_>, carry: Carry) -> ([u32; 3], Carry) {
    let step = filling.pattern.granule(lattice.layers) as f64;
    let total = (2 * slice.half_width * lattice.layers) as f64;
    let round = |wanted: f64, most: f64| ((wanted / step).round() * step).clamp(0.0, most);
    let residue = |wanted: f64, got: f64| (wanted - got).clamp(-0.5 * step, 0.5 * step);
    let fractions = filling.phases.fractions(modulus).values;
    let moduli = filling.phases.moduli();
    if let [soft, middle, stiff] = moduli[..] {
        let wanted = fractions[1] * total + carry.intermediate;
        let intermediate = round(wanted, total);
        // The stiffest phase makes up for the rounding of the intermediate one.
        let reached = modulus.clamp(soft, stiff);
        let rigid_wanted = (total * (reached - soft) - intermediate * (middle - soft)) / (stiff - soft) + carry.rigid;
        let rigid = round(rigid_wanted, total - intermediate);
        let next = Carry { intermediate: residue(wanted, intermediate), rigid: residue(rigid_wanted, rigid) };
        ([(total - intermediate - rigid) as u32, intermediate as u32, rigid as u32], next)
    } else {
        let wanted = fractions[1] * total + carry.rigid;
        let rigid = round(wanted, total);
        let next = Carry { intermediate: 0.0, rigid: residue(wanted, rigid) };
        ([(total - rigid) as u32, rigid as u32, 0], next)
    }
}

fn mean_modulus(counts: &[u32; 3], filling: &Filling<'_>) -> f64 {
    let total: u32 = counts.iter().sum();
    if let Some(rule) = filling.calibrated() {
        return rule.modulus(f64::from(counts[1]) / f64::from(total.max(1)));
    }
    let sum: f64 = counts.iter().zip(filling.phases.moduli()).map(|(n, e)| f64::from(*n) * e).sum();
    sum / f64::from(total.max(1))
}

/// Chooses counts whose bending stiffness, where the pattern puts the voxels, is nearest to the target.
///
/// The stiffness rises with the modulus because every voxel that turns stiffer raises it, so bisection on the modulus
/// finds the two neighbouring counts.
fn counts_by_stiffness(
    lattice: &Lattice,
    targets: &[SliceTarget],
    filling: &Filling<'_>,
    cancelled: Cancelled<'_>,
) -> Option<Vec<Slice>> {
    let moduli = filling.phases.moduli();
    let (soft, stiff) = (filling.phases.softest(), filling.phases.stiffest());
    let size = lattice.size_mm;
    let thickness = lattice.layers as f64 * size;
    // Largest change of stiffness that one step of the pattern makes: at the outer faces.
    let step = filling.pattern.granule(lattice.layers) as f64;
    let limit = 0.5 * step * size * size * (stiff - soft) * thickness * thickness / 4.0;
    let mut carry = 0.0_f64;
    let mut voxels = Vec::new();
    targets
        .iter()
        .enumerate()
        .map(|(i, target)| {
            if cancelled() {
                return None;
            }
            let mut slice = blank(lattice, i, target, filling);
            let order = filling.pattern.order(slice.half_width, lattice.layers, filling.seed, i);
            voxels.clear();
            voxels.resize(order.len(), 0_u8);
            let mut evaluate = |modulus: f64| {
                let (counts, _) = count(modulus, &slice, lattice, filling, Carry::default());
                place(&mut voxels, &order, &counts);
                (counts, section(&layer_stiffness(&voxels, lattice.layers, &moduli, size), size).stiffness)
            };
            let wanted = slice.stiffness_target_nmm2 + carry;
            let (mut low, mut high) = (evaluate(soft), evaluate(stiff));
            let (mut from, mut to) = (soft, stiff);
            let clamped = slice.stiffness_target_nmm2 < low.1 * (1.0 - 1e-9)
                || slice.stiffness_target_nmm2 > high.1 * (1.0 + 1e-9);
            for _ in 0..40 {
                if low.0 == high.0 || (to - from) * order.len() as f64 <= 0.25 * step * (stiff - soft) {
                    break;
                }
                let middle = 0.5 * (from + to);
                let found = evaluate(middle);
                if found.1 < wanted {
                    (low, from) = (found, middle);
                } else {
                    (high, to) = (found, middle);
                }
            }
            let (counts, reached) = if wanted - low.1 <= high.1 - wanted { low } else { high };
            carry = if clamped { 0.0 } else { (wanted - reached).clamp(-limit, limit) };
            slice.counts = counts;
            slice.clamped = clamped;
            slice.modulus_mpa = mean_modulus(&slice.counts, filling);
            Some(slice)
        })
        .collect()
}
