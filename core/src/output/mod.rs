//! What `design` writes into a folder.

pub mod design_json;
pub mod folder;
pub mod json;
mod model_json;
pub mod provenance;
pub mod summary;
pub mod tables;
pub mod unit_cells;
pub mod vtu;
pub mod write;

pub use provenance::Provenance;
pub use summary::Summary;
