//! What can be wrong with a solver's files.

/// What is wrong with a result file.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ResultError {
    /// A line that should be a row of numbers.
    #[error("line {line}: \"{text}\" is no row of finite numbers of its block; the file may be cut short")]
    Row {
        /// Line number, from one.
        line: usize,
        /// The beginning of the line.
        text: String,
    },
    /// Nothing to read: the solver wrote no increment.
    #[error("no displacements or forces of a node set; the solver wrote no increment")]
    Empty,
}
