//! Small cells of two phases: the modulus of every layout along x, y and z.
//!
//! - `layout` enumerates layouts and the classes that symmetries make of them;
//! - `stretch` tests one layout along three axes with finite elements;
//! - `catalogue` tests all of a cell's layouts and holds them against the bounds.

mod catalogue;
mod error;
mod layout;
mod stretch;

pub use catalogue::{Catalogue, Departure, Row};
pub use error::UnitCellError;
pub use layout::{CellSize, LARGEST_EDGE, Layout, Member, Symmetry, classes, member};
pub use stretch::{CellMesh, LoadedFaces, MOST_ELEMENTS, StretchTest};

pub use super::elastic_block::BrickKind;
