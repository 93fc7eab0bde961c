//! From a modulus along the strip to voxels of two or three phases.
//!
//! - [`lattice`] cuts the strip into slices and layers and rounds its width to whole voxels;
//! - [`counts`] decides how many voxels of each phase a slice gets, carrying the rounding residue along the strip;
//! - [`pattern`] places them in the cross-section;
//! - [`section`] is the bending stiffness of the slice that results;
//! - [`grid`] holds the voxels.

pub mod counts;
pub mod grid;
pub mod lattice;
pub mod pattern;
pub mod section;

pub use counts::{Match, Slice, SliceTarget, fill};
pub use grid::VoxelGrid;
pub use lattice::{Lattice, LatticeError, Rounding};
pub use pattern::Pattern;
