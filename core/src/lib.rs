//! Voxelastica's mechanics and formats: from a target meridian to widths, graded modulus, voxels and finite-element decks.

pub mod elastica;
pub mod modulus_field;
mod numerics;
pub mod target;
