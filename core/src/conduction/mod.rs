//! Heat and current in strips of bricks.

pub mod ashby;
pub mod brick;
pub mod case;
mod components;
mod contrast;
mod current;
mod error;
mod galerkin;
mod heat;
pub mod memory;
pub mod mesh;
mod multigrid;
mod operator;
pub mod output;
pub mod pcg;
pub mod steady;
mod stencil;
pub mod strip;
mod transfer;
pub mod transient;

pub use error::ConductionError;
