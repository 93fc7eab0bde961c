//! What can go wrong with a finite-element solution.

use super::element::InvertedElement;
use crate::progress::{Cancelled, stops_at};

/// Why there is no solution.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FemError {
    /// An element of the flat mesh is folded.
    #[error("element {element}: {reason}")]
    Inverted {
        /// Number of the element, from one.
        element: usize,
        /// What is wrong with it.
        reason: InvertedElement,
    },
    /// The factors of the tangent do not fit into memory.
    #[error(
        "{unknowns} unknowns need about {:.1} GB of memory, and {:.1} GB may be used; use larger voxels or \
         fewer elements a voxel",
        *.needed as f64 / 1e9,
        *.limit as f64 / 1e9
    )]
    Memory {
        /// Unknowns of the mesh.
        unknowns: usize,
        /// Bytes needed, estimated.
        needed: u64,
        /// Bytes that may be used.
        limit: u64,
    },
    /// The tangent has no usable factors, pivoted or not.
    #[error("the tangent of {unknowns} unknowns is singular at {:.1} % of the path: part of the mesh is not held", 100.0 * .fraction)]
    Singular {
        /// Unknowns of the mesh.
        unknowns: usize,
        /// Where on the path, 0 flat and 1 closed.
        fraction: f64,
    },
    /// Newton's method found no equilibrium.
    #[error(
        "no equilibrium at {:.1} % of the path: after {iterations} iterations the residual is {residual:.1e} of the \
         forces; tried: {tried}",
        100.0 * .fraction
    )]
    Diverged {
        /// Where on the path, 0 flat and 1 closed.
        fraction: f64,
        /// Iterations of the last attempt.
        iterations: usize,
        /// Norm of the residual over that of the elements' forces.
        residual: f64,
        /// What was tried.
        tried: String,
    },
    /// The sparse matrices could not be set up.
    #[error("the sparse tangent could not be set up: {0}")]
    Sparse(String),
    /// The user cancelled.
    #[error("cancelled")]
    Cancelled,
}

/// Asks whether to go on.
pub(super) fn go_on(cancelled: Cancelled<'_>) -> Result<(), FemError> {
    if cancelled() { Err(FemError::Cancelled) } else { Ok(()) }
}

/// Asks at every so many items of a light loop whether to go on.
pub(super) fn go_on_at(item: usize, cancelled: Cancelled<'_>) -> Result<(), FemError> {
    if stops_at(item, cancelled) { Err(FemError::Cancelled) } else { Ok(()) }
}
