//! How much memory a problem needs, before any is taken.

use super::ConductionError;
use super::mesh::BrickMesh;
use crate::memory::available_bytes;

/// Bytes a node on the finest level: vectors of conjugate gradients and of the smoother, diagonal, boundary.
const PER_NODE: u64 = 150;
/// Bytes a cell: its conductivity, and its share of the coarse levels (stencils and, while they are built, matrices).
const PER_CELL: u64 = 8 + 150;
/// What the program needs besides.
const BASE: u64 = 64 << 20;
/// Limit where the system does not say how much is free.
const UNKNOWN: u64 = 8 << 30;

/// Bytes that solving on a mesh of this many cells takes, about. Transients take a third more.
#[must_use]
pub fn estimated_bytes(cells: [usize; 3]) -> u64 {
    let product = |extra: u64| cells.iter().fold(1_u64, |p, n| p.saturating_mul(*n as u64 + extra));
    BASE.saturating_add(product(1).saturating_mul(PER_NODE)).saturating_add(product(0).saturating_mul(PER_CELL))
}

/// Refuses a mesh that needs more than `limit`, or than what is free.
///
/// # Errors
/// [`ConductionError::Memory`].
pub fn require(mesh: &BrickMesh, limit: Option<u64>) -> Result<(), ConductionError> {
    require_cells(mesh.cells(), limit)
}

/// The same before a mesh exists.
///
/// # Errors
/// [`ConductionError::Memory`].
pub fn require_cells(cells: [usize; 3], limit: Option<u64>) -> Result<(), ConductionError> {
    let limit = limit.unwrap_or_else(|| available_bytes().unwrap_or(UNKNOWN));
    let needed = estimated_bytes(cells);
    if needed <= limit {
        return Ok(());
    }
    let nodes = cells.iter().fold(1_u64, |p, n| p.saturating_mul(*n as u64 + 1));
    Err(ConductionError::Memory { nodes, needed_mb: needed >> 20, limit_mb: limit >> 20 })
}
