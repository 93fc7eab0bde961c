//! Triangle meshes as vertices and triples of vertex indices.

use std::collections::HashMap;

use super::error::TargetError;
use crate::progress::{Cancelled, never, stops_at};

/// Most vertices a mesh may have.
pub const MAX_VERTICES: usize = 20_000_000;
/// Most triangles a mesh may have; a closed surface has about twice as many as vertices.
pub const MAX_TRIANGLES: usize = 2 * MAX_VERTICES;

/// A triangle mesh in any one unit.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct TriangleMesh {
    /// Positions `[x, y, z]`.
    pub vertices: Vec<[f64; 3]>,
    /// Indices of every triangle's vertices, counted from 0.
    pub triangles: Vec<[u32; 3]>,
}

impl TriangleMesh {
    /// Checks what every reader of a mesh relies on.
    ///
    /// # Errors
    ///
    /// No triangle; more than [`MAX_VERTICES`] or [`MAX_TRIANGLES`]; a coordinate that is not finite; an index that
    /// names no vertex.
    pub fn check(&self) -> Result<(), TargetError> {
        check_mesh(&self.vertices, &self.triangles, &never)
    }
}

pub(super) fn check_mesh(
    vertices: &[[f64; 3]],
    triangles: &[[u32; 3]],
    cancelled: Cancelled<'_>,
) -> Result<(), TargetError> {
    check_counts(vertices.len() as u64, triangles.len() as u64)?;
    if triangles.is_empty() || vertices.is_empty() {
        return Err(TargetError::EmptyMesh { vertices: vertices.len(), triangles: triangles.len() });
    }
    for (vertex, position) in vertices.iter().enumerate() {
        if stops_at(vertex, cancelled) {
            return Err(TargetError::Cancelled);
        }
        // Fourth powers of coordinates must stay finite too.
        if let Some(&value) = position.iter().find(|c| !c.is_finite() || c.abs() > 1e70) {
            return Err(TargetError::VertexNotFinite { vertex, value });
        }
    }
    for (triangle, corners) in triangles.iter().enumerate() {
        if stops_at(triangle, cancelled) {
            return Err(TargetError::Cancelled);
        }
        if let Some(&index) = corners.iter().find(|&&i| i as usize >= vertices.len()) {
            return Err(TargetError::IndexOutOfRange { triangle, index: u64::from(index), vertices: vertices.len() });
        }
    }
    Ok(())
}

/// Checks counts before memory is taken for them.
pub(super) fn check_counts(vertices: u64, triangles: u64) -> Result<(), TargetError> {
    for (what, found, limit) in
        [("vertices", vertices, MAX_VERTICES as u64), ("triangles", triangles, MAX_TRIANGLES as u64)]
    {
        if found > limit {
            return Err(TargetError::MeshTooLarge { what, found, limit });
        }
    }
    Ok(())
}

/// Gives equal positions one index.
#[derive(Debug, Default)]
pub(super) struct Welder {
    known: HashMap<[u64; 3], u32>,
    pub vertices: Vec<[f64; 3]>,
}

impl Welder {
    /// The index of a position; at most [`MAX_VERTICES`] different ones are taken.
    pub fn index(&mut self, position: [f64; 3]) -> Result<u32, TargetError> {
        // Adding zero makes -0 and 0 one.
        let next = self.vertices.len();
        let index = *self.known.entry(position.map(|c| (c + 0.0).to_bits())).or_insert(next as u32);
        if index as usize == next {
            check_counts(next as u64 + 1, 0)?;
            self.vertices.push(position);
        }
        Ok(index)
    }
}
