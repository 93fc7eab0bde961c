//! Structured finite-element meshes of one spoke, described by their planes and never stored node by node.

pub mod block;

pub use block::{Block, Spacing};
