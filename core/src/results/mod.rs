//! What solvers return, and how it compares with the target.

pub mod comparison;
pub mod verification;

pub use comparison::{Comparison, MidlinePoint, compare};
pub use verification::{Verification, verify};
