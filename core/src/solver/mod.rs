//! External solvers.

pub mod ccx;
