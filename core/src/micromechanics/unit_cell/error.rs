//! What can be wrong with a request for unit cells.

use super::layout::LARGEST_EDGE;

/// Why unit cells were not computed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum UnitCellError {
    /// A cell of another size than two to four voxels.
    #[error("a cell of {edge} x {edge} x 1 voxels; cells have 2 to {LARGEST_EDGE} voxels along x and y")]
    Size {
        /// Voxels along an edge.
        edge: usize,
    },
    /// A layout that cannot be read.
    #[error(
        "\"{text}\" is no layout of a {cell} cell; write {voxels} digits, 0 for soft and 1 for rigid, row after row"
    )]
    Layout {
        /// What was written.
        text: String,
        /// Digits it should have.
        voxels: usize,
        /// The cell.
        cell: String,
    },
    /// Too fine a mesh.
    #[error("{elements} elements along a voxel's edge; use 1 to {most}{help}")]
    Elements {
        /// Elements along a voxel's edge.
        elements: usize,
        /// Most that are allowed.
        most: usize,
        /// What would help; may be empty.
        help: &'static str,
    },
    /// A phase that is no elastic material.
    #[error("\"{name}\" with E = {modulus_mpa} MPa, nu = {poisson}; E must be positive and finite, nu from 0 to 0.499")]
    Phase {
        /// Name of the phase.
        name: String,
        /// Its modulus.
        modulus_mpa: f64,
        /// Its Poisson's ratio.
        poisson: f64,
    },
    /// The equations could not be solved.
    #[error(
        "the stiffness of layout {layout} is not positive definite in double precision; the phases' moduli differ by a \
         factor of {contrast:.1e}, use phases closer to each other"
    )]
    Singular {
        /// The layout.
        layout: String,
        /// Ratio of the phases' moduli.
        contrast: f64,
    },
    /// There is not enough memory.
    #[error("not enough memory for cells of {unknowns} unknowns; use fewer elements along a voxel's edge")]
    Memory {
        /// Unknowns of one cell.
        unknowns: usize,
    },
    /// The user cancelled.
    #[error("cancelled")]
    Cancelled,
}
