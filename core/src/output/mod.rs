//! What `design` writes into a folder.

pub mod provenance;
pub mod summary;

pub use provenance::Provenance;
pub use summary::Summary;
