//! What is wrong with a design file.

use std::fmt;
use std::ops::{Deref, DerefMut};

/// A problem in a design file. Its parts are those of [`InputProblem`].
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct InputError(Box<InputProblem>);

/// Where a problem in a design file is, what stands there, what is wrong with it and what would help.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct InputProblem {
    /// Name of the design file (or of the file it names), as the user gave it.
    pub file: String,
    /// Line in that file, where known.
    pub line: Option<usize>,
    /// Dotted key, such as `voxels.size_mm`; empty where the whole file is meant.
    pub key: String,
    /// The offending value as written; empty where there is none.
    pub value: String,
    /// What is wrong.
    pub problem: String,
    /// What would help; may be empty.
    pub help: String,
}

impl InputError {
    /// A problem with one key.
    #[must_use]
    pub fn new(key: impl Into<String>, value: impl fmt::Display, problem: impl Into<String>) -> Self {
        Self(Box::new(InputProblem {
            file: String::new(),
            line: None,
            key: key.into(),
            value: value.to_string(),
            problem: problem.into(),
            help: String::new(),
        }))
    }

    /// Adds what would help.
    #[must_use]
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = help.into();
        self
    }

    /// Adds the file, unless one is already named.
    #[must_use]
    pub fn in_file(mut self, file: &str) -> Self {
        if self.file.is_empty() {
            file.clone_into(&mut self.file);
        }
        self
    }
}

impl Deref for InputError {
    type Target = InputProblem;

    fn deref(&self) -> &InputProblem {
        &self.0
    }
}

impl DerefMut for InputError {
    fn deref_mut(&mut self) -> &mut InputProblem {
        &mut self.0
    }
}

impl fmt::Display for InputError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(if self.file.is_empty() { "design" } else { &self.file })?;
        if let Some(line) = self.line {
            write!(f, ":{line}")?;
        }
        f.write_str(": ")?;
        if !self.key.is_empty() {
            write!(f, "{}", self.key)?;
            if !self.value.is_empty() {
                write!(f, " = {}", self.value)?;
            }
            f.write_str(": ")?;
        }
        f.write_str(&self.problem)?;
        if !self.help.is_empty() {
            write!(f, "; {}", self.help)?;
        }
        Ok(())
    }
}

impl std::error::Error for InputError {}
