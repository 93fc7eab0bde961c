//! Structured finite-element meshes of one spoke, of its mid-surface and of the hub, described by their planes and rows
//! and never stored node by node.

pub mod block;
pub mod flower;
pub mod hub_plate;
pub mod sheet;

pub use block::{Block, Spacing};
pub use flower::Flower;
pub use hub_plate::HubPlate;
pub use sheet::Sheet;
