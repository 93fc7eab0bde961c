//! Where solids stand in a file: one spoke in its own frame, or all of them laid flat around the hub.

use std::f64::consts::PI;

use super::hub_is_level;
use super::solid::Point;
use super::voxel_surface::Scale;
use crate::design::Design;
use crate::mesh::Flower;

/// Gap between neighbouring spokes that are laid out as separate parts, mm.
const GAP_MM: f64 = 1.0;

/// A turn about the z axis and a shift.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placement {
    /// Cosine of the turn.
    pub cosine: f64,
    /// Sine of the turn.
    pub sine: f64,
    /// The shift after it, mm.
    pub shift: Point,
}

impl Placement {
    /// Where it is.
    pub const IDENTITY: Self = Self { cosine: 1.0, sine: 0.0, shift: [0.0; 3] };

    /// The place of a point.
    #[must_use]
    pub fn place(&self, [x, y, z]: Point) -> Point {
        let [dx, dy, dz] = self.shift;
        [self.cosine * x - self.sine * y + dx, self.sine * x + self.cosine * y + dy, z + dz]
    }
}

/// A spoke of the flower.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlacedSpoke {
    /// From the spoke's own frame to the flower's.
    pub placement: Placement,
    /// Whether it is the mirror image of the first.
    pub mirrored: bool,
}

/// The flower laid flat, in its own frame: hub at the origin, spoke 1 along +x, counter-clockwise, mid-plane at `z = 0`.
#[derive(Debug, Clone, PartialEq)]
pub struct FlatFlower {
    /// The spokes.
    pub spokes: Vec<PlacedSpoke>,
    /// Corners of the hub plate, counter-clockwise; none where spokes end inclined at the hub, which is then a part of its
    /// own ([`super::assembly`]).
    pub hub: Option<Vec<[f64; 2]>>,
    /// Distance of the spokes' hub ends from the axis, mm: the hub radius, and more where they are parts of their own and
    /// would touch.
    pub inner_radius_mm: f64,
    /// Smallest gap between neighbouring spokes, mm; negative where voxels overlap near the hub because widths were
    /// rounded up (`voxels.rounding = "inward"` avoids that).
    pub gap_mm: f64,
}

impl FlatFlower {
    /// Lays out a design's spokes; `None` for a rectangular strip.
    #[must_use]
    pub fn of(design: &Design) -> Option<Self> {
        let input = design.input();
        if input.is_strip() {
            return None;
        }
        let (count, length) = (input.count(), input.strips.length_mm);
        let half_angle = PI / count as f64;
        let level = hub_is_level(design);
        let gap_at = |radius: f64| smallest_gap(design, radius, half_angle);
        let nominal = input.hub_radius();
        let gap = gap_at(nominal);
        // Corners of neighbours that just touch are parted like any contact, so that no reader merges them.
        let wanted = match level {
            true if gap.abs() < Scale::PARTED_MM => Scale::PARTED_MM,
            true => gap,
            false => gap.max(GAP_MM),
        };
        let inner_radius_mm = nominal + (wanted - gap) / (2.0 * half_angle.sin());
        let flower = Flower { count, hub_radius: inner_radius_mm, length };
        let spokes = (0..count)
            .map(|index| {
                // The spoke's own frame runs from the rim inwards.
                let [cosine, sine] = flower.outward(index).map(|c| -c);
                let [x, y] = flower.place(index, 0.0, 0.0);
                let mirrored = input.voxels.pattern.alternates() && index % 2 == 1;
                PlacedSpoke { placement: Placement { cosine, sine, shift: [x, y, 0.0] }, mirrored }
            })
            .collect();
        let corner = |i: usize| {
            let radius = inner_radius_mm / half_angle.cos();
            let (sin, cos) = (half_angle * (2.0 * i as f64 - 1.0)).sin_cos();
            [radius * cos, radius * sin]
        };
        let hub = level.then(|| (0..count).map(corner).collect());
        Some(Self { spokes, hub, inner_radius_mm, gap_mm: gap_at(inner_radius_mm) })
    }

    /// Largest coordinate of the spokes, mm.
    #[must_use]
    pub fn reach_mm(&self, design: &Design) -> f64 {
        let grid = design.grid();
        let widest = grid.half_widths().iter().copied().max().unwrap_or(0) as f64 * grid.size_mm();
        (self.inner_radius_mm + design.input().strips.length_mm).hypot(widest)
    }
}

/// Smallest gap between the voxels of neighbouring spokes whose hub ends lie at a radius: twice the distance of a slice's
/// inner corner from the plane of symmetry between them.
fn smallest_gap(design: &Design, radius: f64, half_angle: f64) -> f64 {
    let grid = design.grid();
    let (sin, cos) = half_angle.sin_cos();
    let slices = grid.slices();
    let gap = |(i, half): (usize, &usize)| {
        let inner = radius + (slices - 1 - i) as f64 * grid.size_mm();
        2.0 * (inner * sin - *half as f64 * grid.size_mm() * cos)
    };
    grid.half_widths().iter().enumerate().map(gap).fold(f64::INFINITY, f64::min)
}
