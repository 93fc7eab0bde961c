//! What is written as a solid: a closed, oriented triangle surface, given piece by piece.

use std::io;

use super::stl::Frame;
use super::voxel_surface::{SurfaceError, Vertex, VoxelSurface, signed_volume};
use crate::progress::Cancelled;

/// A point, mm.
pub type Point = [f64; 3];

/// What keeps a solid from being written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SolidError {
    /// The surface cannot be made.
    #[error(transparent)]
    Surface(#[from] SurfaceError),
    /// More elements than the format can number.
    #[error("the surface has {count} {what}, more than the {limit} that {format} can number; use larger voxels")]
    TooMany {
        /// How many there are.
        count: u64,
        /// Of what.
        what: &'static str,
        /// The format.
        format: &'static str,
        /// How many it can number.
        limit: u64,
    },
    /// The file system.
    #[error(transparent)]
    Io(#[from] io::Error),
}

impl From<zip::result::ZipError> for SolidError {
    fn from(error: zip::result::ZipError) -> Self {
        Self::Io(error.into())
    }
}

/// A piece of an indexed surface: new vertices, and triangles of vertices numbered over all pieces from zero.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Piece {
    /// Vertices that no earlier piece has.
    pub vertices: Vec<Point>,
    /// Triangles, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

/// Takes one piece after the other.
pub type TakePiece<'a> = &'a mut dyn FnMut(Piece) -> Result<(), SolidError>;

/// Takes triangles a few thousand at a time.
pub type TakeFacets<'a> = &'a mut dyn FnMut(&[[Point; 3]]) -> Result<(), SolidError>;

/// A solid. Both ways of walking through it give the same triangles in the same order every time.
pub trait Solid: Sync {
    /// Edge of the lattice that vertices lie on, mm; zero where there is none.
    fn lattice_mm(&self) -> f64 {
        0.0
    }

    /// Number of triangles.
    ///
    /// # Errors
    /// [`SurfaceError::Cancelled`].
    fn count(&self, cancelled: Cancelled<'_>) -> Result<u64, SolidError>;

    /// The triangles, in a frame of single precision: `frame` may move what lies closest together.
    ///
    /// # Errors
    /// [`SurfaceError::Cancelled`], and what `take` returns.
    fn facets(&self, frame: &Frame, cancelled: Cancelled<'_>, take: TakeFacets<'_>) -> Result<(), SolidError>;

    /// The triangles by their vertices' numbers.
    ///
    /// # Errors
    /// [`SurfaceError::Cancelled`], [`SolidError::TooMany`], and what `take` returns.
    fn pieces(&self, cancelled: Cancelled<'_>, take: TakePiece<'_>) -> Result<(), SolidError>;
}

/// A surface held in memory.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Mesh {
    /// Vertices, mm.
    pub vertices: Vec<Point>,
    /// Triangles, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

impl Mesh {
    /// Corners of a triangle.
    #[must_use]
    pub fn corners(&self, triangle: [u32; 3]) -> [Point; 3] {
        triangle.map(|v| self.vertices[v as usize])
    }

    /// A prism with a convex base, given counter-clockwise seen from above, between two heights.
    #[must_use]
    pub fn prism(base: &[[f64; 2]], [low, high]: [f64; 2]) -> Self {
        let n = base.len() as u32;
        let vertices = [low, high].into_iter().flat_map(|z| base.iter().map(move |[x, y]| [*x, *y, z])).collect();
        let mut triangles = Vec::new();
        for k in 1..n.saturating_sub(1) {
            triangles.extend([[0, k + 1, k], [n, n + k, n + k + 1]]);
        }
        for (k, next) in (0..n).map(|k| (k, (k + 1) % n)) {
            triangles.extend([[k, next, n + next], [k, n + next, n + k]]);
        }
        Self { vertices, triangles }
    }

    /// Enclosed volume, mm^3.
    #[must_use]
    pub fn volume(&self) -> f64 {
        self.triangles.iter().map(|t| signed_volume(&self.corners(*t))).sum()
    }
}

impl Solid for Mesh {
    fn count(&self, _cancelled: Cancelled<'_>) -> Result<u64, SolidError> {
        Ok(self.triangles.len() as u64)
    }

    fn facets(&self, frame: &Frame, _cancelled: Cancelled<'_>, take: TakeFacets<'_>) -> Result<(), SolidError> {
        let place = |t: &[u32; 3]| self.corners(*t).map(|p| frame.placement.place(p));
        let facets: Vec<[Point; 3]> = self.triangles.iter().map(place).collect();
        take(&facets)
    }

    fn pieces(&self, _cancelled: Cancelled<'_>, take: TakePiece<'_>) -> Result<(), SolidError> {
        take(Piece { vertices: self.vertices.clone(), triangles: self.triangles.clone() })
    }
}

/// One phase of a voxel grid, in the strip's own frame or its mirror image.
#[derive(Debug, Clone, Copy)]
pub struct PhaseSolid<'a> {
    /// The surfaces.
    pub surface: VoxelSurface<'a>,
    /// The phase.
    pub phase: u8,
    /// Mirrored at the mid-line, as every second spoke of an alternating pattern is.
    pub mirrored: bool,
}

impl PhaseSolid<'_> {
    fn place(&self, [x, y, z]: Point) -> Point {
        if self.mirrored { [x, -y, z] } else { [x, y, z] }
    }

    fn turn<T>(&self, [a, b, c]: [T; 3]) -> [T; 3] {
        if self.mirrored { [a, c, b] } else { [a, b, c] }
    }
}

impl Solid for PhaseSolid<'_> {
    fn lattice_mm(&self) -> f64 {
        self.surface.scale().edge_mm
    }

    fn count(&self, cancelled: Cancelled<'_>) -> Result<u64, SolidError> {
        Ok(self.surface.count(self.phase, cancelled)?)
    }

    fn facets(&self, frame: &Frame, cancelled: Cancelled<'_>, take: TakeFacets<'_>) -> Result<(), SolidError> {
        self.surface.for_each_slab(
            cancelled,
            |slab| {
                let mut facets = Vec::new();
                slab.triangles(self.phase, &mut |triangle| {
                    let place = |vertex: Vertex| {
                        let (point, offset) = (self.surface.lattice_point(&vertex), self.surface.offset(&vertex));
                        let contact =
                            vertex.contact.map(|[along, across]| [along, if self.mirrored { -across } else { across }]);
                        frame.place(self.place(point), self.place(offset), contact)
                    };
                    facets.push(self.turn(triangle.map(place)));
                });
                facets
            },
            |_, facets| take(&facets),
        )
    }

    fn pieces(&self, cancelled: Cancelled<'_>, take: TakePiece<'_>) -> Result<(), SolidError> {
        self.surface.indexed(self.phase, cancelled, &mut |vertices, mut triangles| {
            if self.mirrored {
                triangles.iter_mut().for_each(|t| *t = self.turn(*t));
            }
            let vertices = vertices.iter().map(|v| self.place(self.surface.position(v))).collect();
            take(Piece { vertices, triangles })
        })
    }
}
