//! Heat and current in strips of bricks.

pub mod brick;
mod components;
mod contrast;
mod error;
mod galerkin;
pub mod memory;
pub mod mesh;
mod multigrid;
mod operator;
pub mod pcg;
pub mod steady;
mod stencil;
mod transfer;
pub mod transient;

pub use error::ConductionError;
