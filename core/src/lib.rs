//! Voxelastica's mechanics and formats: from a target meridian to widths, graded modulus, voxels and finite-element decks.

pub mod modulus_field;
pub mod target;
