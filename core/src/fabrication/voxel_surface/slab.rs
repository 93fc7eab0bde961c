//! The surface of one phase in a slab of slices.
//!
//! A slab needs the labels of its own slices and of one more on either side, and nothing that another slab found out: along
//! the planes between slabs every lattice point of an edge is a vertex, so that both sides agree.

use super::contact::{Octants, VOID, ray};
use super::rectangles::{Rectangle, Squares};
use super::template::{Offset, Template, template};
use crate::fabrication::triangulate;
use crate::voxel::VoxelGrid;

/// Fine steps between two lattice points when only directions matter.
const FINE: i64 = 1 << 12;

/// A vertex of a surface: a lattice point (slice, across counted from the mid-line, layer) and an offset from it, in the
/// unit of [`super::Scale`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Vertex {
    /// The lattice point.
    pub at: [i32; 3],
    /// The offset.
    pub offset: Offset,
    /// Where voxels of a phase touch along an edge or at a corner at this lattice point: on which side, along the strip and
    /// across it, there is more void (0 where on neither).
    pub contact: Option<[i8; 2]>,
}

impl Vertex {
    fn fine(&self) -> [i64; 3] {
        std::array::from_fn(|k| i64::from(self.at[k]) * FINE + i64::from(self.offset[k]))
    }
}

/// A slab of a grid, labelled.
pub struct Slab {
    slices: [usize; 2],
    /// The whole grid's slices.
    total: usize,
    /// Voxels along the slab, across its widest slice, and layers.
    size: [usize; 3],
    /// Labels with one more voxel on every side.
    labels: Vec<u8>,
    /// What is done around every lattice point.
    templates: Vec<Option<&'static Template>>,
}

impl Slab {
    /// Labels the slices `slices[0]..slices[1]` of a grid.
    #[must_use]
    pub fn new(grid: &VoxelGrid, slices: [usize; 2]) -> Self {
        let (first, last) = (slices[0].saturating_sub(1), (slices[1] + 1).min(grid.slices()));
        let half = grid.half_widths()[first..last].iter().copied().max().unwrap_or(0);
        let layers = grid.layers();
        let size = [slices[1] - slices[0], 2 * half, layers];
        let mut slab = Self { slices, total: grid.slices(), size, labels: Vec::new(), templates: Vec::new() };
        slab.labels = vec![VOID; size.iter().map(|n| n + 2).product()];
        for slice in first..last {
            let own = grid.half_widths()[slice];
            for (place, phase) in grid.slice(slice).iter().enumerate() {
                let (layer, across) = (place / (2 * own), place % (2 * own));
                let at = slab.voxel(slice + 1 - slices[0], across + half - own + 1, layer + 1);
                slab.labels[at] = *phase;
            }
        }
        let points = size.map(|n| n + 1);
        slab.templates.reserve(points.iter().product());
        for i in 0..points[0] {
            for j in 0..points[1] {
                for k in 0..points[2] {
                    let octants = std::array::from_fn(|o| {
                        slab.labels[slab.voxel(i + (o & 1), j + (o >> 1 & 1), k + (o >> 2 & 1))]
                    });
                    slab.templates.push(template(Octants(octants).code()));
                }
            }
        }
        slab
    }

    /// Place of a voxel, counted from the border, in the labels.
    fn voxel(&self, i: usize, j: usize, k: usize) -> usize {
        (i * (self.size[1] + 2) + j) * (self.size[2] + 2) + k
    }

    /// Label of the voxel above a lattice point, displaced by whole voxels downwards.
    fn label(&self, at: [usize; 3], down: [usize; 3]) -> u8 {
        self.labels[self.voxel(at[0] + 1 - down[0], at[1] + 1 - down[1], at[2] + 1 - down[2])]
    }

    fn point(&self, at: [usize; 3]) -> usize {
        (at[0] * (self.size[1] + 1) + at[1]) * (self.size[2] + 1) + at[2]
    }

    fn template(&self, at: [usize; 3]) -> Option<&'static Template> {
        self.templates[self.point(at)]
    }

    fn vertex(&self, at: [usize; 3], offset: Offset) -> Vertex {
        let across = at[1] as i32 - (self.size[1] / 2) as i32;
        let contact = self.template(at).map(|template| template.contact.void_side());
        Vertex { at: [(self.slices[0] + at[0]) as i32, across, at[2] as i32], offset, contact }
    }

    /// Whether a lattice point lies in a plane shared with another slab.
    fn is_shared(&self, at: [usize; 3]) -> bool {
        (at[0] == 0 && self.slices[0] > 0) || (at[0] == self.size[0] && self.slices[1] < self.total)
    }

    /// Whether what lies at this distance along the slab is its own, not the next slab's.
    fn owns_plane(&self, i: usize) -> bool {
        i < self.size[0] || self.slices[1] == self.total
    }

    /// All polygons of a phase's surface, counter-clockwise seen from outside.
    pub fn polygons(&self, phase: u8, polygon: &mut dyn FnMut(&[Vertex], Offset)) {
        let rectangles = self.rectangles(phase);
        let mut corners = vec![false; self.templates.len()];
        for (axis, plane, rectangle) in &rectangles {
            for (u, w) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                corners[self.point(on_plane(*axis, *plane, rectangle.u[u], rectangle.w[w]))] = true;
            }
        }
        let mut ring = Vec::new();
        for (axis, plane, rectangle) in &rectangles {
            ring.clear();
            self.outline(phase, *axis, *plane, rectangle, &corners, &mut ring);
            let mut normal = [0; 3];
            normal[*axis] = rectangle.sign;
            polygon(&ring, normal);
        }
        self.contacts(phase, polygon);
    }

    fn rectangles(&self, phase: u8) -> Vec<(usize, usize, Rectangle)> {
        let mut found = Vec::new();
        let mut squares = Squares::default();
        for axis in 0..3 {
            let (u_axis, w_axis) = ((axis + 1) % 3, (axis + 2) % 3);
            let mut below = [0; 3];
            below[axis] = 1;
            squares.wide = self.size[u_axis];
            squares.high = self.size[w_axis];
            for plane in (0..=self.size[axis]).filter(|p| axis != 0 || self.owns_plane(*p)) {
                squares.faces.clear();
                for w in 0..squares.high {
                    for u in 0..squares.wide {
                        let at = on_plane(axis, plane, u, w);
                        let face = (self.label(at, below) == phase, self.label(at, [0; 3]) == phase);
                        squares.faces.push(i8::from(face.0) - i8::from(face.1));
                    }
                }
                if squares.faces.iter().all(|f| *f == 0) {
                    continue;
                }
                squares.free.clear();
                for w in 0..=squares.high {
                    let free = |u: usize| self.template(on_plane(axis, plane, u, w)).is_none();
                    squares.free.extend((0..=squares.wide).map(free));
                }
                squares.take(|rectangle| found.push((axis, plane, rectangle)));
            }
        }
        found
    }

    /// Vertices of a merged rectangle: what its corners have become, and what its sides need.
    fn outline(
        &self,
        phase: u8,
        axis: usize,
        plane: usize,
        rectangle: &Rectangle,
        corners: &[bool],
        ring: &mut Vec<Vertex>,
    ) {
        let ([u0, u1], [w0, w1]) = (rectangle.u, rectangle.w);
        let corner = |u: usize, w: usize, quadrant: usize, reversed: bool, ring: &mut Vec<Vertex>| {
            let at = on_plane(axis, plane, u, w);
            match self.template(at) {
                None => ring.push(self.vertex(at, [0; 3])),
                Some(template) => {
                    let chain = &template.phases[usize::from(phase)].faces[axis][quadrant];
                    let vertices = chain.iter().map(|offset| self.vertex(at, *offset));
                    if reversed { ring.extend(vertices.rev()) } else { ring.extend(vertices) }
                }
            }
        };
        let side = |at: [usize; 3], ring: &mut Vec<Vertex>| {
            if corners[self.point(at)] || self.is_shared(at) {
                ring.push(self.vertex(at, [0; 3]));
            }
        };
        corner(u0, w0, 3, true, ring);
        (u0 + 1..u1).for_each(|u| side(on_plane(axis, plane, u, w0), ring));
        corner(u1, w0, 2, false, ring);
        (w0 + 1..w1).for_each(|w| side(on_plane(axis, plane, u1, w), ring));
        corner(u1, w1, 0, true, ring);
        (u0 + 1..u1).rev().for_each(|u| side(on_plane(axis, plane, u, w1), ring));
        corner(u0, w1, 1, false, ring);
        (w0 + 1..w1).rev().for_each(|w| side(on_plane(axis, plane, u0, w), ring));
        if rectangle.sign < 0 {
            ring.reverse();
        }
    }

    /// Walls and strips of the prisms, and what octahedra leave.
    fn contacts(&self, phase: u8, polygon: &mut dyn FnMut(&[Vertex], Offset)) {
        let mut ring: Vec<Vertex> = Vec::new();
        let mut oriented = |ring: &mut Vec<Vertex>, normal: Offset| {
            let mut area = [0_i64; 3];
            let origin = ring[0].fine();
            for pair in ring.windows(2) {
                let from = |v: &Vertex| -> [i64; 3] {
                    let fine = v.fine();
                    std::array::from_fn(|k| fine[k] - origin[k])
                };
                let (a, b) = (from(&pair[0]), from(&pair[1]));
                (0..3).for_each(|k| area[k] += a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3]);
            }
            if (0..3).map(|k| area[k] * i64::from(normal[k])).sum::<i64>() < 0 {
                ring.reverse();
            }
            polygon(ring, normal);
        };
        for i in (0..=self.size[0]).filter(|i| self.owns_plane(*i)) {
            for j in 0..=self.size[1] {
                for k in 0..=self.size[2] {
                    let at = [i, j, k];
                    let Some(template) = self.template(at) else { continue };
                    for patch in &template.phases[usize::from(phase)].patches {
                        ring.clear();
                        ring.extend(patch.corners.iter().map(|offset| self.vertex(at, *offset)));
                        oriented(&mut ring, patch.normal);
                    }
                    for axis in (0..3).filter(|axis| at[*axis] < self.size[*axis]) {
                        if template.contact.rays[ray(axis, 1)].is_some() {
                            self.prism(phase, at, axis, template, &mut oriented);
                        }
                    }
                }
            }
        }
    }

    fn prism(
        &self,
        phase: u8,
        at: [usize; 3],
        axis: usize,
        near: &Template,
        oriented: &mut dyn FnMut(&mut Vec<Vertex>, Offset),
    ) {
        let mut end = at;
        end[axis] += 1;
        let Some(far) = self.template(end) else { return };
        let (up, down) = (ray(axis, 1), ray(axis, 0));
        let (near, owner) = (&near.phases[usize::from(phase)], near.contact.rays[up]);
        let far = &far.phases[usize::from(phase)];
        let mut join = |near: &[Offset], far: &[Offset], normal: Offset| {
            if !near.is_empty() && !far.is_empty() {
                let mut ring: Vec<Vertex> = near.iter().map(|offset| self.vertex(at, *offset)).collect();
                ring.extend(far.iter().rev().map(|offset| self.vertex(end, *offset)));
                oriented(&mut ring, normal);
            }
        };
        for (position, octant) in Octants::around(up).into_iter().enumerate() {
            let side = |k: usize| if octant >> k & 1 == 1 { 1 } else { -1 };
            let (b, c) = ((axis + 1) % 3, (axis + 2) % 3);
            // Outwards for the owner is away from the edge, for the voxel towards it.
            let out = if owner == Some(phase) { 1 } else { -1 };
            let mut normal = [0; 3];
            (normal[b], normal[c]) = (out * side(b), out * side(c));
            join(&near.walls[up][position], &far.walls[down][position], normal);
            for which in 0..2 {
                let towards = (axis + 1 + which) % 3;
                let mut normal = [0; 3];
                normal[towards] = -side(towards);
                join(&near.strips[up][position][which], &far.strips[down][position][which], normal);
            }
        }
    }

    /// All triangles of a phase's surface, counter-clockwise seen from outside.
    pub fn triangles(&self, phase: u8, triangle: &mut dyn FnMut([Vertex; 3])) {
        self.polygons(phase, &mut |ring, normal| {
            let at = |k: usize| ring[k].fine();
            let turns = |i: usize, j: usize, k: usize| {
                let (a, b, c) = (at(i), at(j), at(k));
                let (p, q): ([i64; 3], [i64; 3]) =
                    (std::array::from_fn(|k| b[k] - a[k]), std::array::from_fn(|k| c[k] - b[k]));
                let cross = |k: usize| p[(k + 1) % 3] * q[(k + 2) % 3] - p[(k + 2) % 3] * q[(k + 1) % 3];
                (0..3).map(|k| cross(k) * i64::from(normal[k])).sum::<i64>() > 0
            };
            triangulate::convex(ring.len(), turns, |t| triangle(t.map(|k| ring[k])));
        });
    }

    /// Number of triangles of a phase's surface.
    #[must_use]
    pub fn count(&self, phase: u8) -> u64 {
        let mut count = 0;
        self.polygons(phase, &mut |ring, _| count += ring.len() as u64 - 2);
        count
    }
}

/// The lattice point at `u`, `w` of the plane across `axis`.
fn on_plane(axis: usize, plane: usize, u: usize, w: usize) -> [usize; 3] {
    let mut at = [0; 3];
    at[axis] = plane;
    at[(axis + 1) % 3] = u;
    at[(axis + 2) % 3] = w;
    at
}
