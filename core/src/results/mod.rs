//! What solvers return, and how it compares with the target.

pub mod ccx_dat;
pub mod ccx_elements;
pub mod comparison;
pub mod embedded;
mod error;
pub mod measured;
pub mod pressed;
pub mod verification;

pub use comparison::{Comparison, MidlinePoint, compare};
pub use embedded::{EmbeddedOptions, EmbeddedVerification, verify_embedded};
pub use error::ResultError;
pub use measured::{MeasuredComparison, MeasuredOptions, compare_table, read_table};
pub use verification::{Verification, verify};
