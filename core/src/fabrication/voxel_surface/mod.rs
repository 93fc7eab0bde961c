//! Exact surfaces of the phases of a voxel grid: closed, oriented, manifold, and complementary.
//!
//! Every voxel is a cube and belongs to its phase's solid; faces between voxels of one phase are left out, coplanar faces
//! merge greedily into rectangles ([`rectangles`]), and every point of the surface that lies on a rectangle's side is one of
//! its vertices, so no T-junction is left. Where voxels of a phase touch along an edge or at a corner only, the rule of
//! [`contact`] applies: **the softest phase joins, the others part**, by at most [`Scale::PARTED_MM`], and what they lose
//! is what the softest gains: the phases fill the strip without overlap or gap. [`template`] works out what that means
//! around a lattice point; [`slab`] puts it together a few slices at a time, so memory does not grow with the strip.
//!
//! ```
//! use voxelastica_core::fabrication::voxel_surface::VoxelSurface;
//! use voxelastica_core::voxel::VoxelGrid;
//!
//! // Two slices of two by one voxels, a checkerboard: the two soft voxels touch along an edge, so do the stiff ones.
//! let mut grid = VoxelGrid::new(0.5, 1, vec![1, 1]);
//! grid.slice_mut(0).copy_from_slice(&[0, 1]);
//! grid.slice_mut(1).copy_from_slice(&[1, 0]);
//! let surface = VoxelSurface::new(&grid, 100.0).unwrap();
//! let (soft, stiff) = (surface.measure(0), surface.measure(1));
//! // One joined body and two parted ones: V - E + F = V - F / 2 is 2 a body.
//! assert_eq!(soft.vertices as i64 - soft.triangles as i64 / 2, 2);
//! assert_eq!(stiff.vertices as i64 - stiff.triangles as i64 / 2, 4);
//! assert!((soft.volume_mm3 + stiff.volume_mm3 - 4.0 * 0.125).abs() < 1e-12);
//! ```

pub mod contact;
mod indexed;
pub mod rectangles;
pub mod slab;
pub mod template;

use std::collections::HashSet;

use rayon::prelude::*;

pub use slab::{Slab, Vertex};

use crate::progress::Cancelled;
use crate::voxel::VoxelGrid;
use contact::SIZES;

/// Voxels of a slab, about.
const SLAB_VOXELS: usize = 8192;

/// Voxels that are worked on at once, about, and so between two chances to cancel.
const BATCH_VOXELS: usize = 1 << 17;

/// Slabs that an estimate looks at.
const SAMPLES: usize = 6;

/// What keeps a grid's surfaces from being made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SurfaceError {
    /// The files' single precision cannot hold the distance by which phases are parted.
    #[error(
        "coordinates up to {reach_mm:.0} mm are {spacing_mm:.1e} mm apart in the single precision of STL and 3MF, too coarse to \
         part voxels of one phase by {parted_mm:.1e} mm; write single spokes instead of the flower, or make the design smaller"
    )]
    TooLarge {
        /// Largest coordinate, mm.
        reach_mm: f64,
        /// Distance between neighbouring numbers there, mm.
        spacing_mm: f64,
        /// Smallest distance between two vertices, mm.
        parted_mm: f64,
    },
    /// The work was cancelled.
    #[error("cancelled")]
    Cancelled,
}

/// Sizes of what the rule for contacts changes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scale {
    /// Voxel edge, mm.
    pub edge_mm: f64,
    /// Length of one unit of a vertex's offset, mm.
    pub unit_mm: f64,
}

impl Scale {
    /// Largest distance by which a voxel gives way, measured from the edge where it touched another of its phase, mm.
    pub const PARTED_MM: f64 = 1e-3;

    /// The scale for `phases` phases of voxels of edge `edge_mm` whose coordinates reach `reach_mm` in the file.
    ///
    /// A voxel gives way by `d / sqrt(2)`. With two phases `d` is 0.6 micrometres. With three, what the intermediate phase gets
    /// is the slenderer and has 0.54 micrometres: as little as readers of STL that weld vertices on a grid of one
    /// micrometre still tell apart. Voxels smaller than 25 micrometres give way by less.
    ///
    /// # Errors
    /// [`SurfaceError::TooLarge`] where single precision would merge vertices.
    pub fn new(edge_mm: f64, phases: usize, reach_mm: f64) -> Result<Self, SurfaceError> {
        let [first, second, _] = SIZES.map(f64::from);
        let unit_mm = if phases > 2 { 0.54 * Self::PARTED_MM / second } else { 0.6 * Self::PARTED_MM / first };
        let unit_mm = unit_mm.min(edge_mm / (20.0 * first));
        let spacing_mm = f64::from(f32::EPSILON) * 2.0_f64.powf(reach_mm.max(f64::MIN_POSITIVE).log2().floor());
        let closest = if phases > 2 { first - 2.0 * second } else { 0.5 * first };
        let parted_mm = closest * unit_mm;
        if spacing_mm * 2.0 > parted_mm {
            return Err(SurfaceError::TooLarge { reach_mm, spacing_mm, parted_mm });
        }
        Ok(Self { edge_mm, unit_mm })
    }

    /// Largest distance by which a voxel gives way, mm: that of the softest phase's prism.
    #[must_use]
    pub fn parted_mm(&self) -> f64 {
        f64::from(SIZES[0]) * self.unit_mm / 2.0_f64.sqrt()
    }
}

/// Triangles and volume of a phase's surface.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Tally {
    /// Triangles.
    pub triangles: u64,
    /// Enclosed volume, mm^3.
    pub volume_mm3: f64,
}

/// What a phase's surface amounts to.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Measure {
    /// Distinct vertices.
    pub vertices: u64,
    /// Triangles.
    pub triangles: u64,
    /// Enclosed volume, mm^3.
    pub volume_mm3: f64,
}

/// The surfaces of a grid's phases.
///
/// Coordinates are the strip's own: rim at `x = 0`, hub at `x = L`, mid-plane at `z = 0`, mid-line at `y = 0`.
#[derive(Debug, Clone, Copy)]
pub struct VoxelSurface<'a> {
    grid: &'a VoxelGrid,
    scale: Scale,
    slices_per_slab: usize,
}

impl<'a> VoxelSurface<'a> {
    /// The surfaces of a grid, for files whose coordinates reach `reach_mm` from their origin.
    ///
    /// # Errors
    /// [`SurfaceError::TooLarge`].
    pub fn new(grid: &'a VoxelGrid, reach_mm: f64) -> Result<Self, SurfaceError> {
        let phases = usize::from(grid.phases().iter().copied().max().unwrap_or(0)) + 1;
        let scale = Scale::new(grid.size_mm(), phases, reach_mm)?;
        let slice = grid.phases().len() / grid.slices().max(1);
        Ok(Self { grid, scale, slices_per_slab: (SLAB_VOXELS / slice.max(1)).clamp(1, 512) })
    }

    /// The sizes.
    #[must_use]
    pub fn scale(&self) -> Scale {
        self.scale
    }

    /// Number of slabs; rim first.
    #[must_use]
    pub fn slabs(&self) -> usize {
        self.grid.slices().div_ceil(self.slices_per_slab)
    }

    /// One slab.
    #[must_use]
    pub fn slab(&self, index: usize) -> Slab {
        let first = index * self.slices_per_slab;
        Slab::new(self.grid, [first, (first + self.slices_per_slab).min(self.grid.slices())])
    }

    /// First slice of a slab.
    #[must_use]
    pub fn first_slice(&self, index: usize) -> usize {
        index * self.slices_per_slab
    }

    /// Position of a vertex, mm.
    #[must_use]
    pub fn position(&self, vertex: &Vertex) -> [f64; 3] {
        let (point, offset) = (self.lattice_point(vertex), self.offset(vertex));
        std::array::from_fn(|k| point[k] + offset[k])
    }

    /// Position of a vertex's lattice point, mm.
    #[must_use]
    pub fn lattice_point(&self, vertex: &Vertex) -> [f64; 3] {
        let middle = [0.0, 0.0, 0.5 * self.grid.layers() as f64];
        std::array::from_fn(|k| (f64::from(vertex.at[k]) - middle[k]) * self.scale.edge_mm)
    }

    /// Offset of a vertex from its lattice point, mm.
    #[must_use]
    pub fn offset(&self, vertex: &Vertex) -> [f64; 3] {
        vertex.offset.map(|o| f64::from(o) * self.scale.unit_mm)
    }

    /// Works on all slabs, several at a time, and hands the results over in order.
    ///
    /// # Errors
    /// [`SurfaceError::Cancelled`], and what `take` returns.
    pub fn for_each_slab<T: Send, E: From<SurfaceError>>(
        &self,
        cancelled: Cancelled<'_>,
        work: impl Fn(&Slab) -> T + Sync,
        mut take: impl FnMut(usize, T) -> Result<(), E>,
    ) -> Result<(), E> {
        let all: Vec<usize> = (0..self.slabs()).collect();
        let slab = self.grid.phases().len() / self.slabs().max(1);
        for batch in all.chunks((BATCH_VOXELS / slab.max(1)).clamp(2, 16)) {
            let one = |index: &usize| (!cancelled()).then(|| work(&self.slab(*index)));
            let done = batch.par_iter().map(one).collect::<Option<Vec<T>>>().ok_or(SurfaceError::Cancelled)?;
            for (index, result) in batch.iter().zip(done) {
                if cancelled() {
                    return Err(SurfaceError::Cancelled.into());
                }
                take(*index, result)?;
            }
        }
        Ok(())
    }

    /// Number of triangles of a phase's surface.
    ///
    /// # Errors
    /// [`SurfaceError::Cancelled`].
    pub fn count(&self, phase: u8, cancelled: Cancelled<'_>) -> Result<u64, SurfaceError> {
        let mut total = 0;
        self.for_each_slab(
            cancelled,
            |slab| slab.count(phase),
            |_, count| {
                total += count;
                Ok::<(), SurfaceError>(())
            },
        )?;
        Ok(total)
    }

    /// Triangles and volume of a phase's surface.
    ///
    /// # Errors
    /// [`SurfaceError::Cancelled`].
    pub fn tally(&self, phase: u8, cancelled: Cancelled<'_>) -> Result<Tally, SurfaceError> {
        let mut total = Tally::default();
        let work = |slab: &Slab| {
            let mut tally = Tally::default();
            slab.triangles(phase, &mut |triangle| {
                tally.triangles += 1;
                tally.volume_mm3 += signed_volume(&triangle.map(|v| self.position(&v)));
            });
            tally
        };
        self.for_each_slab(cancelled, work, |_, tally| {
            total.triangles += tally.triangles;
            total.volume_mm3 += tally.volume_mm3;
            Ok::<(), SurfaceError>(())
        })?;
        Ok(total)
    }

    /// Number of triangles of a phase's surface, from a few slabs spread over the strip.
    #[must_use]
    pub fn estimated_triangles(&self, phase: u8) -> u64 {
        let slabs = self.slabs();
        let sampled: Vec<usize> = (0..SAMPLES.min(slabs)).map(|k| k * slabs / SAMPLES.min(slabs)).collect();
        let found: u64 = sampled.par_iter().map(|index| self.slab(*index).count(phase)).sum();
        found.saturating_mul(slabs as u64) / (sampled.len() as u64).max(1)
    }

    /// Vertices, triangles and volume of a phase's surface. Holds all vertices in memory: for tests and small grids.
    #[must_use]
    pub fn measure(&self, phase: u8) -> Measure {
        let mut measure = Measure::default();
        let mut vertices = HashSet::new();
        for index in 0..self.slabs() {
            self.slab(index).triangles(phase, &mut |triangle| {
                measure.triangles += 1;
                vertices.extend(triangle);
                measure.volume_mm3 += signed_volume(&triangle.map(|v| self.position(&v)));
            });
        }
        measure.vertices = vertices.len() as u64;
        measure
    }
}

/// Volume of the tetrahedron from the origin to a triangle.
#[must_use]
pub fn signed_volume([a, b, c]: &[[f64; 3]; 3]) -> f64 {
    (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])) / 6.0
}

#[cfg(test)]
mod tests;
