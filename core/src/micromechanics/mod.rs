//! The modulus of mixtures: bounds, and the fractions that realise a wanted modulus.

pub mod bounds;
pub mod phases;

pub use bounds::{hashin_shtrikman, reuss, voigt};
pub use phases::{Fractions, PhaseError, PhaseSet};
