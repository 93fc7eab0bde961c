//! What solvers return, and how it compares with the target.

pub mod ccx_dat;
pub mod comparison;
mod error;
pub mod verification;

pub use comparison::{Comparison, MidlinePoint, compare};
pub use error::ResultError;
pub use verification::{Verification, verify};
