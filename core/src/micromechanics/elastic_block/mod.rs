//! Linear elasticity on a block of equal bricks: the finite elements behind unit cells and bending cells.
//!
//! - `grid` numbers nodes and elements;
//! - `brick` is one element's stiffness, trilinear or with enhanced strains;
//! - `support` says which displacements are prescribed, in up to three load cases at once;
//! - `system` assembles, factorises and returns the stiffness against those load cases.

mod brick;
mod grid;
mod support;
mod system;

pub(crate) use brick::Brick;
pub use brick::BrickKind;
pub(crate) use grid::Grid;
pub(crate) use support::{CASES, Support};
pub(crate) use system::BlockSystem;
