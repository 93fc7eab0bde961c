//! Pixels from the voxels of a design: the phase of the voxel that a pixel's centre lies in.

use super::{Layout, Painter, Pixel, Raster};
use crate::design::Design;
use crate::voxel::VoxelGrid;

/// The voxels of a design, seen through a raster.
#[derive(Debug)]
pub struct Resampled<'a> {
    raster: Raster,
    grid: &'a VoxelGrid,
    length: f64,
    /// Whether every second spoke is the mirror image of the first.
    alternates: bool,
    /// What the hub is made of, where it belongs to the piece.
    hub: Pixel,
}

impl<'a> Resampled<'a> {
    /// The voxels of a design.
    #[must_use]
    pub fn new(design: &'a Design, raster: Raster, hub: Pixel) -> Self {
        Self {
            raster,
            grid: design.grid(),
            length: design.input().strips.length_mm,
            alternates: design.input().voxels.pattern.alternates(),
            hub,
        }
    }

    /// Outline of the voxels: `(s, half-width)`, mm, at both ends of every slice.
    #[must_use]
    pub fn outline(grid: &VoxelGrid) -> Vec<[f64; 2]> {
        let size = grid.size_mm();
        let ends = |(i, half): (usize, &usize)| [i, i + 1].map(|k| [k as f64 * size, *half as f64 * size]);
        grid.half_widths().iter().enumerate().flat_map(ends).collect()
    }

    /// The layer of the design that a slice shows.
    #[must_use]
    pub fn layer(&self, slice: usize) -> usize {
        ((self.raster.height(slice) / self.grid.size_mm()).max(0.0) as usize).min(self.grid.layers() - 1)
    }

    /// Draws a slice.
    #[must_use]
    pub fn painter(&'a self, slice: usize) -> LayerPainter<'a> {
        let layer = self.layer(slice);
        let rows = (0..self.grid.slices())
            .map(|i| {
                let half = self.grid.half_widths()[i];
                (half as f64, &self.grid.slice(i)[layer * 2 * half..(layer + 1) * 2 * half])
            })
            .collect();
        LayerPainter { of: self, rows }
    }
}

/// Draws one layer of a design's voxels.
pub struct LayerPainter<'a> {
    of: &'a Resampled<'a>,
    /// Half-width in voxels and the phases across, for every slice of the design.
    rows: Vec<(f64, &'a [u8])>,
}

impl Painter for LayerPainter<'_> {
    fn paint(&mut self, row: usize, pixels: &mut [Pixel]) {
        let of = self.of;
        let per_mm = 1.0 / of.grid.size_mm();
        let is_flower = matches!(of.raster.layout(), Layout::Flower(_));
        for span in of.raster.spans(row) {
            let side = if of.alternates && span.spoke % 2 == 1 { -per_mm } else { per_mm };
            for column in span.columns.clone() {
                let s = span.s.at(column);
                if s < 0.0 {
                    continue;
                }
                if is_flower && s >= of.length {
                    pixels[column] = of.hub;
                    continue;
                }
                // The last slice also takes what rounding puts a hair beyond it.
                let Some((half, phases)) = self.rows.get(((s * per_mm) as usize).min(self.rows.len() - 1)) else {
                    continue;
                };
                let across = side.mul_add(span.y.at(column), *half);
                if across >= 0.0
                    && let Some(phase) = phases.get(across as usize)
                {
                    pixels[column] = phase + 1;
                }
            }
        }
    }
}
