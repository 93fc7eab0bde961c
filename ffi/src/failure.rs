//! What went wrong, as a record that crosses to other languages.

use voxelastica_core::elastica::ElasticaError;
use voxelastica_core::{Error, Infeasible, InputError};

use crate::status::Status;

/// An error with what a host may want to show or to act on.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Failure {
    /// What kind it is.
    pub code: Status,
    /// The whole message, as the command line prints it after `error: `.
    pub message: String,
    /// Dotted key of the design, such as `voxels.size_mm`, or the argument's name; may be empty.
    pub key: String,
    /// The offending value; may be empty.
    pub value: String,
    /// The file; may be empty.
    pub file: String,
    /// The line in that file; 0 where unknown.
    pub line: usize,
}

impl Failure {
    /// A failure with a code, the name of the argument and what is wrong with it.
    #[must_use]
    pub fn argument(code: Status, argument: &str, value: impl std::fmt::Display, problem: &str) -> Self {
        let value = value.to_string();
        let shown = if value.is_empty() { String::new() } else { format!(" = {value}") };
        Self {
            code,
            message: format!("{argument}{shown}: {problem}"),
            key: argument.to_owned(),
            value,
            file: String::new(),
            line: 0,
        }
    }

    /// A number or an index outside what is allowed.
    #[must_use]
    pub fn range(argument: &str, value: impl std::fmt::Display, allowed: &str) -> Self {
        Self::argument(Status::OutOfRange, argument, value, &format!("it must be {allowed}"))
    }

    /// A defect of the library.
    #[must_use]
    pub fn internal(problem: &str) -> Self {
        Error::Internal(problem.to_owned()).into()
    }

    fn bare(code: Status, message: String) -> Self {
        Self { code, message, key: String::new(), value: String::new(), file: String::new(), line: 0 }
    }
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        let message = error.to_string();
        match error {
            Error::Input(error) => error.into(),
            Error::Infeasible { name, reason } => Self {
                key: reason.key().to_owned(),
                value: match &reason {
                    Infeasible::Contrast { contrast, .. } => format!("{contrast:.3}"),
                    _ => String::new(),
                },
                file: name,
                ..Self::bare(Status::Infeasible, message)
            },
            Error::Solver(_) => Self::bare(Status::Solver, message),
            Error::Output { path, .. } => {
                Self { file: path.display().to_string(), ..Self::bare(Status::Output, message) }
            }
            Error::Cancelled => Self::bare(Status::Cancelled, message),
            _ => Self::bare(Status::Internal, message),
        }
    }
}

impl From<InputError> for Failure {
    fn from(error: InputError) -> Self {
        let message = error.to_string();
        Self {
            code: Status::Input,
            message,
            key: error.key.clone(),
            value: error.value.clone(),
            file: error.file.clone(),
            line: error.line.unwrap_or(0),
        }
    }
}

impl From<ElasticaError> for Failure {
    fn from(error: ElasticaError) -> Self {
        let reason = Infeasible::from(error);
        Self { key: reason.key().to_owned(), ..Self::bare(Status::Infeasible, reason.to_string()) }
    }
}

impl std::fmt::Display for Failure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for Failure {}
