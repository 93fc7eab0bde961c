//! The subcommands.

pub mod design;
pub mod lists;
pub mod micromechanics;
pub mod verify;
