//! The modulus of mixtures: bounds, the fractions that realise a wanted modulus, and what small cells of voxels show.

pub mod bounds;
pub mod calibration;
pub(crate) mod elastic_block;
pub mod phases;
pub mod unit_cell;

pub use bounds::{hashin_shtrikman, reuss, voigt};
pub use phases::{Fractions, PhaseError, PhaseSet};
