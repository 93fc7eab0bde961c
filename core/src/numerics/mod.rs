//! The few numerical tools that several concepts share.

pub(crate) mod arc_table;
pub(crate) mod quadrature;
pub(crate) mod root;
