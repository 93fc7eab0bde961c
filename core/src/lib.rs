//! Voxelastica's mechanics and formats: from a target meridian to widths, graded modulus, voxels and finite-element decks.

pub mod deck;
pub mod design;
pub mod elastica;
mod error;
pub mod flower;
pub mod input;
pub mod materials;
pub mod mesh;
pub mod micromechanics;
pub mod modulus_field;
mod numerics;
pub mod output;
pub mod profile;
pub mod progress;
pub mod report;
pub mod results;
pub mod solver;
pub mod surface;
pub mod target;
pub mod voxel;

pub use design::{Design, Limits};
pub use error::{Error, Infeasible};
pub use input::{DesignInput, InputError};

/// Name and version of the format of `design.json`.
pub const SCHEMA: &str = "voxelastica/design/1";
