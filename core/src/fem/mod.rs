//! Finite elements of the strip: the morph with every voxel resolved, in large displacements.
//!
//! Nothing here knows about design files or hosts. From the element up:
//!
//! - [`element`]: the brick with enhanced assumed strains;
//! - [`mesh`]: nodes and elements of a strip, those of the decks;
//! - [`model`]: which brick and which phase stands where;
//! - [`ordering`], [`pattern`]: unknowns in the order of their elimination and the sparsity of the tangent;
//! - [`assembly`]: forces and tangent of a strip;
//! - [`factorisation`]: sparse factors of the tangent and its inertia;
//! - [`contact`]: rigid planes that nodes may touch;
//! - [`newton`]: equilibrium from a starting shape;
//! - [`morph`]: the closed strip, from the design's own prediction or along the path from flat;
//! - [`recovery`]: mid-line, reactions, strains and stresses.

#![allow(clippy::needless_range_loop, reason = "indices of tensors and matrices stand as in the equations")]

pub mod assembly;
pub mod contact;
pub mod element;
mod error;
pub mod factorisation;
pub mod memory;
pub mod mesh;
pub mod model;
pub mod morph;
pub mod newton;
pub mod ordering;
pub mod pattern;
pub mod recovery;

pub use error::FemError;
pub use model::{Model, Resolution};
pub use morph::{MorphOptions, MorphSolution};
