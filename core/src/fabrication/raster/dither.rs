//! Pixels from the continuous modulus: a mixture chosen anew at the printer's resolution, with exact counts.
//!
//! A cross-section is one pitch long. One of `n` voxels whose modulus should be `E` gets
//!
//! ```text
//! n_k = round(n f_k(E w / w_n)),   w_n = n p_y / slices
//! ```
//!
//! voxels of phase `k`: as everywhere in this library the fraction is chosen for the product of modulus and width, and what the
//! phases cannot reach is clamped. So every count is within half a voxel of its target. Within a cross-section the counts are
//! spread evenly over the slices, the residue being carried from each slice to the next, and within a slice every choice of
//! pixels that has the slice's count is equally likely (selection sampling; Knuth, The Art of Computer Programming, vol. 2,
//! algorithm 3.4.2 S). The choice of a pixel depends on the seed and its place alone, never on threads.
//!
//! Around a flower cross-sections run obliquely to the pixels, and how many centres a narrow one catches is a matter of chance;
//! there `w_n` is averaged over several cross-sections.

use rayon::prelude::*;

use super::{Layout, PIXEL_VALUES, Painter, Pixel, Raster, VOID};
use crate::design::Design;
use crate::micromechanics::PhaseSet;
use crate::progress::Cancelled;

/// Cross-sections to both sides over which the width in pixels is averaged around a flower.
const NEIGHBOURS: usize = 16;

/// One cross-section of a spoke, one pitch long.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CrossSection {
    /// Distance of its centre from the rim, mm.
    pub s_mm: f64,
    /// Its pixels in every slice.
    pub pixels: u32,
    /// Its voxels.
    pub voxels: u64,
    /// Voxels that every phase should have, softest first.
    pub targets: [f64; 3],
    /// Voxels that every phase has.
    pub counts: [u64; 3],
    /// The modulus lies outside what the phases reach.
    pub clamped: bool,
}

/// A modulus, dithered.
#[derive(Debug)]
pub struct Dithered {
    raster: Raster,
    length: f64,
    hub: Pixel,
    seed: u64,
    /// Start of the first cross-section, mm from the rim, and cross-sections per mm.
    first: f64,
    per_mm: f64,
    /// Half-width of every cross-section, mm.
    half_widths: Vec<f64>,
    /// Cross-sections of all spokes, spoke after spoke.
    sections: Vec<CrossSection>,
}

impl Dithered {
    /// Counts pixels and chooses how many of them every phase gets; `None` once it is cancelled.
    #[must_use]
    pub fn new(design: &Design, raster: Raster, hub: Pixel, cancelled: Cancelled<'_>) -> Option<Self> {
        let length = design.input().strips.length_mm;
        let step = raster.pitch.mm[0];
        let (first, bins) = match raster.layout() {
            Layout::Spoke { .. } => (raster.origin_mm[0], raster.columns),
            Layout::Flower(_) => (0.0, (length / step).ceil().max(1.0) as usize),
        };
        let profile: Vec<(f64, f64, f64)> = (0..bins)
            .into_par_iter()
            .map(|bin| {
                let s = (first + (bin as f64 + 0.5) * step).clamp(0.0, length);
                let (width, modulus) = design.width_and_modulus(s);
                (s, width, modulus)
            })
            .collect();
        let mut dithered = Self {
            raster,
            length,
            hub,
            seed: design.input().voxels.seed,
            first,
            per_mm: 1.0 / step,
            half_widths: profile.iter().map(|(_, width, _)| 0.5 * width).collect(),
            sections: Vec::new(),
        };
        let pixels = dithered.count_pixels(cancelled)?;
        let reach = if matches!(raster.layout(), Layout::Flower(_)) { NEIGHBOURS } else { 0 };
        let area = raster.pitch.mm[0] * raster.pitch.mm[1];
        for counted in pixels.chunks_exact(bins) {
            for (bin, &(s_mm, _, modulus)) in profile.iter().enumerate() {
                let near = bin.saturating_sub(reach)..(bin + reach + 1).min(bins);
                let smooth: f64 = profile[near.clone()].iter().map(|(_, width, _)| width * step).sum();
                let drawn: f64 = counted[near].iter().map(|n| f64::from(*n) * area).sum();
                let wanted = if drawn > 0.0 { modulus * smooth / drawn } else { modulus };
                dithered.sections.push(section(design.phases(), s_mm, counted[bin], raster.slices, wanted));
            }
        }
        Some(dithered)
    }

    /// Cross-sections of a spoke.
    #[must_use]
    pub fn sections(&self, spoke: usize) -> &[CrossSection] {
        let bins = self.half_widths.len();
        self.sections.get(spoke * bins..(spoke + 1) * bins).unwrap_or_default()
    }

    /// Draws a slice.
    #[must_use]
    pub fn painter(&self, slice: usize) -> DitherPainter<'_> {
        let quota = |(i, section): (usize, &CrossSection)| Quota::of(section, self.raster.slices, slice, self.seed, i);
        let quotas = self.sections.iter().enumerate().map(quota).collect();
        DitherPainter { of: self, quotas, seed: mix(self.seed ^ mix(slice as u64 + 1)) }
    }

    /// Pixels of one slice in every cross-section of every spoke.
    fn count_pixels(&self, cancelled: Cancelled<'_>) -> Option<Vec<u32>> {
        let bins = self.half_widths.len();
        let sections = bins * self.raster.layout().spokes();
        let add = |mut total: Vec<u32>, other: Vec<u32>| {
            total.iter_mut().zip(other).for_each(|(a, b)| *a += b);
            total
        };
        // Few and long pieces: each has counters of its own.
        let pieces = rayon::current_num_threads().clamp(1, 16);
        (0..pieces)
            .into_par_iter()
            .map(|piece| {
                let mut counts = vec![0; sections];
                for row in (self.raster.rows * piece / pieces)..(self.raster.rows * (piece + 1) / pieces) {
                    if cancelled() {
                        return None;
                    }
                    self.each_pixel(row, |_, place| match place {
                        Place::Section(index) => counts[index] += 1,
                        Place::Hub => {}
                    });
                }
                Some(counts)
            })
            .try_reduce(|| vec![0; sections], |a, b| Some(add(a, b)))
    }

    /// Calls `visit` with the column and the place of every pixel of a row that holds material.
    fn each_pixel(&self, row: usize, mut visit: impl FnMut(usize, Place)) {
        let bins = self.half_widths.len();
        let is_flower = matches!(self.raster.layout(), Layout::Flower(_));
        for span in self.raster.spans(row) {
            let base = span.spoke * bins;
            for column in span.columns.clone() {
                let s = span.s.at(column);
                if is_flower && s >= self.length {
                    visit(column, Place::Hub);
                    continue;
                }
                let along = (s - self.first) * self.per_mm;
                if along < 0.0 {
                    continue;
                }
                let bin = along as usize;
                if let Some(half) = self.half_widths.get(bin)
                    && span.y.at(column).abs() < *half
                {
                    visit(column, Place::Section(base + bin));
                }
            }
        }
    }
}

/// Where a pixel lies.
enum Place {
    /// In a cross-section of a spoke.
    Section(usize),
    /// On the hub.
    Hub,
}

fn section(phases: &PhaseSet, s_mm: f64, pixels: u32, slices: usize, modulus: f64) -> CrossSection {
    let voxels = u64::from(pixels) * slices as u64;
    let fractions = phases.fractions(modulus);
    let (moduli, total) = (phases.moduli(), voxels as f64);
    let round = |wanted: f64, most: u64| (wanted.round().max(0.0) as u64).min(most);
    let (targets, counts) = if moduli.len() == 3 {
        let targets = fractions.values.map(|f| f * total);
        let stiff = round(targets[2], voxels);
        // Of the two that are left the softest is what remains, so that the sum is exact.
        let middle = round(targets[1], voxels - stiff);
        (targets, [voxels - stiff - middle, middle, stiff])
    } else {
        let stiff = round(fractions.values[1] * total, voxels);
        ([fractions.values[0] * total, fractions.values[1] * total, 0.0], [voxels - stiff, stiff, 0])
    };
    CrossSection { s_mm, pixels, voxels, targets, counts, clamped: fractions.clamped }
}

/// What is left to be chosen in one cross-section of one slice.
#[derive(Debug, Clone, Copy)]
struct Quota {
    pixels: u32,
    /// Pixels of the two stiffer phases, as they are counted: middle and stiffest of three, stiffer and none of two.
    phases: [u32; 2],
}

impl Quota {
    /// The share of a slice: counts are cumulated over the slices and rounded with an offset of the cross-section's own,
    /// so that they add up and no slice is favoured.
    fn of(section: &CrossSection, slices: usize, slice: usize, seed: u64, index: usize) -> Self {
        let (hard, second) = (section.counts[1] + section.counts[2], section.counts[2]);
        let slices = slices.max(1) as u64;
        let offset = mix(seed ^ mix(index as u64)) % slices;
        // floor((k hard + offset) / slices), k up to the slice.
        let hard_until = |k: u64| ((u128::from(k) * u128::from(hard) + u128::from(offset)) / u128::from(slices)) as u64;
        let (from, to) = (hard_until(slice as u64), hard_until(slice as u64 + 1));
        // Of the first n hard ones, floor(n second / hard) are of the last phase.
        let second_until =
            |n: u64| (u128::from(n) * u128::from(second)).checked_div(u128::from(hard)).unwrap_or(0) as u64;
        let last = (second_until(to) - second_until(from)) as u32;
        Self { pixels: section.pixels, phases: [(to - from) as u32 - last, last] }
    }
}

/// Draws one slice of a dithered modulus.
pub struct DitherPainter<'a> {
    of: &'a Dithered,
    quotas: Vec<Quota>,
    seed: u64,
}

impl Painter for DitherPainter<'_> {
    fn paint(&mut self, row: usize, pixels: &mut [Pixel]) {
        let row_seed = mix(self.seed ^ (row as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15));
        let (quotas, hub) = (&mut self.quotas, self.of.hub);
        self.of.each_pixel(row, |column, place| {
            let Place::Section(index) = place else {
                pixels[column] = hub;
                return;
            };
            let quota = &mut quotas[index];
            // A number below the pixels left. What it decides is as good as a coin, so there are no branches to foretell.
            let drawn = ((u64::from(scatter(row_seed, column)) * u64::from(quota.pixels)) >> 32) as u32;
            let [middle, last] = quota.phases;
            let hard = u32::from(drawn < middle + last);
            let is_middle = u32::from(drawn < middle);
            pixels[column] = (1 + 2 * hard - is_middle) as Pixel;
            *quota = Quota { pixels: quota.pixels - 1, phases: [middle - is_middle, last + is_middle - hard] };
        });
    }
}

/// A random number for a column of a row.
fn scatter(row_seed: u64, column: usize) -> u32 {
    let z = row_seed.wrapping_add(column as u64).wrapping_mul(0xD6E8_FEB8_6659_FD93);
    ((z ^ (z >> 32)).wrapping_mul(0xD6E8_FEB8_6659_FD93) >> 32) as u32
}

/// Scrambles a number (the finaliser of Steele, Lea and Flood's SplitMix64, 2014).
fn mix(mut z: u64) -> u64 {
    z = z.wrapping_add(0x9E37_79B9_7F4A_7C15);
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

const _: () = assert!(VOID == 0 && PIXEL_VALUES == 4);
