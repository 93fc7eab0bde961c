//! Voxelastica's mechanics and formats: from a target meridian to widths, graded modulus, voxels and finite-element decks.
//!
//! A design is computed in memory, in about a millisecond, and gives its arrays by reference; nothing is read or written
//! on the way:
//!
//! ```
//! use std::path::Path;
//! use voxelastica_core::input::files::Format;
//! use voxelastica_core::surface::Strip;
//! use voxelastica_core::{Design, DesignInput, Limits};
//!
//! let text = r#"
//!     [target]
//!     kind = "hemi-ellipsoid"
//!     [strips]
//!     count = 8
//!     length_mm = 100.0
//!     hub_radius_mm = 10.0
//!     thickness_mm = 2.0
//!     [materials]
//!     phases = ["FLX9070", "FLX9095"]
//!     [voxels]
//!     size_mm = 0.5
//! "#;
//! let input = DesignInput::from_text(text, Format::Toml, "dome.toml", "dome", Path::new("."))?;
//! let design = Design::compute(&input, Limits::default())?;
//!
//! // The published contrast of the hemisphere, and what its voxels are predicted to do.
//! assert!((design.contrast() - 2.316).abs() < 1e-3);
//! assert!(design.predicted_error().unwrap() < 0.001);
//! // Widths, modulus and so on at 1001 stations, without a copy.
//! assert_eq!(design.profile().width.len(), 1001);
//! // Half-way up: the equilibrium of the strip there, not a blend of the ends.
//! let half_way = design.spoke_surface(Strip::Graded, 0.5, 200, 16)?;
//! assert_eq!(half_way.positions.len(), 201 * 17);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The pipeline reads from top to bottom in [`design`]: [`target`] -> [`elastica`] -> [`materials`] and [`micromechanics`] ->
//! [`voxel`]. From there [`deck`] writes finite-element decks, [`fabrication`] files to print, cut and assemble, [`report`] the page and [`output`] a whole folder; [`solver`] runs
//! CalculiX and [`results`] compares what it returns with the target. [`input`] is the design file.
//!
//! **Guaranteed**: the same design gives the same bytes on the same machine and build; sizes from outside are limited before
//! memory is taken; errors name key, value and what would help; nothing panics on what a user can reach. **Not
//! guaranteed**: that a random mixture bends as stiffly as the rule of mixtures says, or that ABAQUS, which is not available to
//! the tests, takes the decks.
//!
//! Units are mm, N, MPa, tonne, s, K; angles are radians here and degrees in files. The method is that of Kansara, Liu, He
//! and Tan, J. Mech. Phys. Solids (2023); `docs/theory.md` derives it.

pub mod conduction;
pub mod deck;
pub mod design;
pub mod elastica;
mod error;
pub mod fabrication;
pub mod fem;
pub mod flower;
pub mod indentation;
pub mod input;
pub mod materials;
mod memory;
pub mod mesh;
pub mod micromechanics;
pub mod modulus_field;
mod numerics;
pub mod optimise;
pub mod output;
pub mod profile;
pub mod progress;
pub mod refine;
pub mod report;
pub mod results;
pub mod solver;
pub mod surface;
pub mod sweep;
pub mod target;
pub mod voxel;

pub use design::{Design, Limits};
pub use error::{Error, Infeasible};
pub use input::{DesignInput, InputError};

/// Name and version of the format of `design.json`.
pub const SCHEMA: &str = "voxelastica/design/1";
