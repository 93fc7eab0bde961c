//! What can go wrong with a sweep beside its input.

use std::path::PathBuf;

use crate::error::Error;
use crate::input::InputError;

/// Why a sweep was not computed or gathered.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SweepError {
    /// So many points that it must be meant.
    #[error(
        "{points} points take about {} at {seconds_per_point:.2e} s each on {threads} cores, and about {:.1} GB of tables; \
         use coarser axes, or insist with --yes",
        duration(*.points as f64 * .seconds_per_point / *.threads as f64),
        *.bytes as f64 / 1e9
    )]
    Many {
        /// Points.
        points: u64,
        /// Measured on one of them.
        seconds_per_point: f64,
        /// Cores.
        threads: usize,
        /// Size of the tables, estimated.
        bytes: u64,
    },
    /// The folder holds another sweep's journals.
    #[error(
        "{}: this journal belongs to another sweep (the sweep file, its design file or the program has changed); choose \
         another folder with -o, or remove it",
        .path.display()
    )]
    Foreign {
        /// The journal.
        path: PathBuf,
    },
    /// A journal that cannot be read.
    #[error("{}: line {line}: {problem}", .path.display())]
    Journal {
        /// The journal.
        path: PathBuf,
        /// Its line.
        line: usize,
        /// What is wrong.
        problem: String,
    },
    /// Another process computes the same points.
    #[error("{}: another process is writing this journal", .path.display())]
    Locked {
        /// The journal.
        path: PathBuf,
    },
    /// Points that no journal has.
    #[error(
        "{missing} of {points} points are missing, the first ones {first:?}; compute them, or gather what there is with --partial"
    )]
    Missing {
        /// How many.
        missing: u64,
        /// Of how many.
        points: u64,
        /// The first of them.
        first: Vec<u64>,
    },
}

impl From<SweepError> for Error {
    fn from(error: SweepError) -> Self {
        Self::Input(InputError::new("", "", error.to_string()).in_file("sweep"))
    }
}

/// A duration as people say it.
pub(crate) fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 90.0 => format!("{s:.0} s"),
        s if s < 5400.0 => format!("{:.0} min", s / 60.0),
        s if s < 172_800.0 => format!("{:.1} h", s / 3600.0),
        s => format!("{:.1} days", s / 86_400.0),
    }
}
