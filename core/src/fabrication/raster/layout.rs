//! Where spokes lie on the print bed, and which pixels of a row belong to which of them.
//!
//! ```text
//!   one spoke:  x = s (rim to hub), y to the left of it      flower:  hub at the origin, spoke 1 along +x,
//!               z up from the lower face                              the others counter-clockwise, z up
//!
//!         y ^  row 0                              seen from above, as a picture viewer shows it:
//!           |                                     column 0 has the smallest x, row 0 the largest y,
//!           +-----> x  last row                   slice 0 is the lowest
//! ```
//!
//! A point of the flower's plane belongs to the spoke whose azimuth is nearest, so the plane falls into sectors; along a row
//! of pixels the spoke's own coordinates `s` and `y` are linear in the column.

use std::f64::consts::TAU;
use std::ops::Range;

use super::Pitch;
use crate::design::Design;
use crate::input::Scope;
use crate::mesh;

/// One spoke or the whole flower.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Layout {
    /// One spoke along x; its length, mm.
    Spoke {
        /// Length, mm.
        length: f64,
    },
    /// All spokes around the hub.
    Flower(mesh::Flower),
}

/// A value that is linear in the column.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Linear {
    /// At the centre of column 0.
    pub start: f64,
    /// From one column to the next.
    pub step: f64,
}

impl Linear {
    /// The value at the centre of a column.
    #[must_use]
    pub fn at(&self, column: usize) -> f64 {
        self.start + self.step * column as f64
    }
}

/// Columns of a row that belong to one spoke.
#[derive(Debug, Clone, PartialEq)]
pub struct Span {
    /// The spoke, from zero.
    pub spoke: usize,
    /// The columns.
    pub columns: Range<usize>,
    /// Distance from the rim, mm; beyond the spoke's length lies the hub.
    pub s: Linear,
    /// Distance to the left of the spoke's axis, seen from its rim, mm.
    pub y: Linear,
}

impl Layout {
    /// The layout of a design.
    #[must_use]
    pub fn of(design: &Design, scope: Scope) -> Self {
        let input = design.input();
        let length = input.strips.length_mm;
        match scope {
            Scope::Flower if !input.is_strip() => {
                Self::Flower(mesh::Flower { count: input.count(), hub_radius: input.hub_radius(), length })
            }
            _ => Self::Spoke { length },
        }
    }

    /// Number of spokes.
    #[must_use]
    pub fn spokes(&self) -> usize {
        match self {
            Self::Spoke { .. } => 1,
            Self::Flower(flower) => flower.count,
        }
    }
}

/// Pixels and slices of a print stack and where they are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Raster {
    /// Size of a voxel.
    pub pitch: Pitch,
    /// Pixels along x.
    pub columns: usize,
    /// Pixels along y.
    pub rows: usize,
    /// Slices.
    pub slices: usize,
    /// Lower left corner of the image and lower face of slice 0, mm, in the frame of the layout.
    pub origin_mm: [f64; 3],
    layout: Layout,
    /// Nothing lies further from the flower's centre, mm.
    reach: f64,
}

impl Raster {
    /// The raster that holds a layout of spokes with an outline `(s, half-width)`, mm, and a thickness.
    ///
    /// Along a single spoke the number of pixels is the nearest whole one; across it, and around a flower, it is the
    /// smallest even one that holds everything, so that the axes lie between two pixels and nothing favours a side. What
    /// rounding leaves over in length and thickness is shared by both ends.
    #[must_use]
    pub fn new(layout: Layout, pitch: Pitch, outline: &[[f64; 2]], thickness: f64) -> Self {
        let [px, py, pz] = pitch.mm;
        let near = |extent: f64, p: f64| (extent / p).round().max(1.0);
        let even = |half: f64, p: f64| 2.0 * (half / p - 1e-9).ceil().max(1.0);
        let slices = near(thickness, pz);
        let below = 0.5 * (thickness - slices * pz);
        let (columns, rows, left, reach) = match layout {
            Layout::Spoke { length } => {
                let half = outline.iter().map(|[_, half]| *half).fold(0.0, f64::max);
                let columns = near(length, px);
                (columns, even(half, py), 0.5 * (length - columns * px), f64::INFINITY)
            }
            Layout::Flower(flower) => {
                let [x, y] = extents(&flower, outline);
                let reach = outline.iter().map(|[s, half]| (flower.hub_radius + flower.length - s).hypot(*half));
                let columns = even(x, px);
                (columns, even(y, py), -0.5 * columns * px, reach.fold(0.0, f64::max))
            }
        };
        // Sizes saturate here and are refused before any memory is taken.
        let whole = |n: f64| n.min(1e15) as usize;
        Self {
            pitch,
            columns: whole(columns),
            rows: whole(rows),
            slices: whole(slices),
            origin_mm: [left, -0.5 * rows * py, below],
            layout,
            reach,
        }
    }

    /// A raster of the same pitch with fewer columns and rows, for a part of a picture.
    #[must_use]
    pub fn cut_to(self, columns: usize, rows: usize) -> Self {
        Self { columns, rows, ..self }
    }

    /// Voxels, void included.
    #[must_use]
    pub fn voxels(&self) -> f64 {
        self.columns as f64 * self.rows as f64 * self.slices as f64
    }

    /// The layout.
    #[must_use]
    pub fn layout(&self) -> &Layout {
        &self.layout
    }

    /// Size of the whole raster, mm.
    #[must_use]
    pub fn size_mm(&self) -> [f64; 3] {
        let counts = [self.columns, self.rows, self.slices];
        std::array::from_fn(|i| counts[i] as f64 * self.pitch.mm[i])
    }

    /// Height of the centre of a slice above the lower face of the sheet, mm.
    #[must_use]
    pub fn height(&self, slice: usize) -> f64 {
        self.origin_mm[2] + (slice as f64 + 0.5) * self.pitch.mm[2]
    }

    /// Position of the centres of a row, mm; row 0 has the largest.
    #[must_use]
    pub fn row_position(&self, row: usize) -> f64 {
        self.origin_mm[1] + ((self.rows - row) as f64 - 0.5) * self.pitch.mm[1]
    }

    /// The pieces of a row that belong to one spoke each, from left to right. What no span covers is void.
    #[must_use]
    pub fn spans(&self, row: usize) -> Vec<Span> {
        let y = self.row_position(row);
        let px = self.pitch.mm[0];
        let x = Linear { start: self.origin_mm[0] + 0.5 * px, step: px };
        match &self.layout {
            Layout::Spoke { .. } => {
                vec![Span { spoke: 0, columns: 0..self.columns, s: x, y: Linear { start: y, step: 0.0 } }]
            }
            Layout::Flower(flower) => self.sectors(flower, x, y),
        }
    }

    fn sectors(&self, flower: &mesh::Flower, x: Linear, y: f64) -> Vec<Span> {
        let half_chord = (self.reach * self.reach - y * y).max(0.0).sqrt();
        // First column whose centre is not left of a position.
        let column = |at: f64| ((at - x.start) / x.step).ceil().clamp(0.0, self.columns as f64) as usize;
        let step = TAU / flower.count as f64;
        let mut bounds = vec![column(-half_chord), column(half_chord)];
        for k in 0..flower.count {
            let (sin, cos) = (step * (k as f64 + 0.5)).sin_cos();
            if sin * y > 1e-12 * y.abs() {
                let crossing = y * cos / sin;
                if crossing.abs() < half_chord {
                    bounds.push(column(crossing));
                }
            }
        }
        bounds.sort_unstable();
        bounds
            .windows(2)
            .filter(|pair| pair[0] < pair[1])
            .map(|pair| {
                let middle = 0.5 * (x.at(pair[0]) + x.at(pair[1] - 1));
                let turns = y.atan2(middle) / step;
                let spoke = (turns.round() as i64).rem_euclid(flower.count as i64) as usize;
                let [cos, sin] = flower.outward(spoke);
                let rim = flower.hub_radius + flower.length;
                Span {
                    spoke,
                    columns: pair[0]..pair[1],
                    s: Linear { start: rim - (x.start * cos + y * sin), step: -x.step * cos },
                    y: Linear { start: x.start * sin - y * cos, step: x.step * sin },
                }
            })
            .collect()
    }
}

/// Largest distance of an outline, turned to the place of every spoke, from both axes, mm.
fn extents(flower: &mesh::Flower, outline: &[[f64; 2]]) -> [f64; 2] {
    let mut extents = [flower.hub_radius; 2];
    for spoke in 0..flower.count {
        let [cos, sin] = flower.outward(spoke).map(f64::abs);
        for [s, half] in outline {
            let radius = flower.hub_radius + flower.length - s;
            extents[0] = extents[0].max(radius * cos + half * sin);
            extents[1] = extents[1].max(radius * sin + half * cos);
        }
    }
    extents
}

#[cfg(test)]
mod tests {
    use super::*;

    fn flower(count: usize) -> mesh::Flower {
        mesh::Flower { count, hub_radius: 3.0, length: 20.0 }
    }

    #[test]
    fn every_pixel_within_reach_belongs_to_the_nearest_spoke_and_has_its_coordinates() {
        for count in [3, 4, 5, 8] {
            let flower = flower(count);
            let outline = [[0.0, 4.0], [20.0, 1.0]];
            let pitch = Pitch { mm: [0.31, 0.47, 0.1] };
            let raster = Raster::new(Layout::Flower(flower), pitch, &outline, 1.0);
            assert_eq!((raster.slices, raster.columns % 2, raster.rows % 2), (10, 0, 0));
            for row in 0..raster.rows {
                let mut covered = 0;
                let y = raster.row_position(row);
                for span in raster.spans(row) {
                    for column in span.columns.clone() {
                        let x = raster.origin_mm[0] + (column as f64 + 0.5) * pitch.mm[0];
                        let [px, py] = flower.place(span.spoke, span.s.at(column), span.y.at(column));
                        assert!((px - x).abs() < 1e-9 && (py - y).abs() < 1e-9);
                        let radial = |spoke: usize| {
                            let [cos, sin] = flower.outward(spoke);
                            x * cos + y * sin
                        };
                        let best = (0..count).map(radial).fold(f64::MIN, f64::max);
                        assert!(best - radial(span.spoke) < 1e-9, "{count} {row} {column}");
                        covered += 1;
                    }
                }
                let within = |column: &usize| {
                    let x = raster.origin_mm[0] + (*column as f64 + 0.5) * pitch.mm[0];
                    x.hypot(y) <= 23.0_f64.hypot(4.0)
                };
                assert!(covered >= (0..raster.columns).filter(within).count(), "{count} {row}");
            }
        }
    }

    #[test]
    fn a_spoke_is_centred_and_as_long_and_thick_as_whole_pixels_allow() {
        let outline = [[0.0, 4.0], [20.0, 1.0]];
        let raster = Raster::new(Layout::Spoke { length: 20.0 }, Pitch { mm: [0.3, 0.3, 0.3] }, &outline, 1.0);
        assert_eq!((raster.columns, raster.rows, raster.slices), (67, 28, 3));
        assert!((raster.height(0) - 0.2).abs() < 1e-12 && (raster.height(2) - 0.8).abs() < 1e-12);
        assert!((raster.row_position(0) - 4.05).abs() < 1e-12 && (raster.row_position(27) + 4.05).abs() < 1e-12);
        let span = &raster.spans(0)[0];
        assert!((span.s.at(0) - 0.1).abs() < 1e-12 && (span.s.at(66) - 19.9).abs() < 1e-12);
    }
}
