//! The few numerical tools that several concepts share.

pub(crate) mod arc_table;
pub(crate) mod large_array;
pub(crate) mod monotone_cubic;
pub(crate) mod quadrature;
pub(crate) mod root;
pub(crate) mod sparse_cholesky;
pub(crate) mod tridiagonal;
