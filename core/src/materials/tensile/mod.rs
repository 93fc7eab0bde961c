//! Tensile tests: modulus, yield and break of a material from measured curves.
//!
//! - [`table`] reads a curve from a table of strain and stress, or of extension and force;
//! - [`curve`] finds where the specimen failed;
//! - [`straight`] finds straight parts and fits lines to them;
//! - [`figures`] takes modulus, yield and break from one curve;
//! - [`sample`] takes their means and scatter from several, and a material from these.
//!
//! `docs/materials.md` has the equations.

pub mod curve;
pub mod figures;
pub mod sample;
pub mod straight;
pub mod table;

pub use curve::TensileCurve;
pub use figures::{TensileFigures, Window, WindowChoice, YieldPoint, evaluate};
pub use sample::{Statistic, TensileSample, to_toml};
pub use table::{Specimen, parse_curve, read_curve};
