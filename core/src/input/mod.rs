//! The design file: what a user states, read from TOML or JSON.
//!
//! - [`parameters`] is the one described table of keys, from which the checks, the JSON Schema and the hosts' forms are
//!   made;
//! - [`document`] reads a text into a tree of values that remembers its lines;
//! - [`check`] holds that tree against the table, so that every error names file, line, key and value;
//! - [`model`] is the typed result.

pub mod check;
pub mod conduction;
mod custom_material;
pub mod document;
mod error;
pub mod fabrication;
pub mod files;
pub mod indentation;
pub mod model;
pub mod parameters;
pub mod reference;
pub mod schema;
pub mod target_file;

pub use conduction::{ConductionInput, Electrode, ThresholdOf};
pub use error::{InputError, InputProblem};
pub use fabrication::{FabricationInput, FabricationKind, PrintSource, Printer, Scope, ThreeMfGeometry};
pub use indentation::{Bending, IndentationInput, Indenter};
pub use model::{
    DeckKind, DeckSolver, DeckStyle, DecksInput, DesignInput, MaterialsInput, StripsInput, TargetInput, ThrustInput,
    VoxelsInput,
};
