//! The library's error, grouped by what the user can do about it.

use std::path::PathBuf;

use crate::elastica::ElasticaError;
use crate::input::InputError;
use crate::micromechanics::calibration::CalibrationError;
use crate::micromechanics::unit_cell::UnitCellError;
use crate::target::TargetError;
use crate::voxel::LatticeError;

/// Everything that can go wrong, with a stable exit code a group.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The design file or a file it names is wrong.
    #[error(transparent)]
    Input(#[from] InputError),
    /// Mechanics or the materials rule the design out.
    #[error("{name}: {}: this design is infeasible: {reason}", .reason.key())]
    Infeasible {
        /// The design file, or the design's name where there is none.
        name: String,
        /// Why, where, and what would help.
        reason: Infeasible,
    },
    /// A solver is missing, failed or did not converge.
    #[error("{0}")]
    Solver(String),
    /// A file could not be written.
    #[error("{}: {problem}{}", .path.display(), help_suffix(.help))]
    Output {
        /// The file or folder.
        path: PathBuf,
        /// What happened.
        problem: String,
        /// What would help; may be empty.
        help: String,
    },
    /// The user cancelled.
    #[error("cancelled; nothing half-written was left behind")]
    Cancelled,
    /// A defect of the library.
    #[error("internal error: {0}; please report it")]
    Internal(String),
}

fn help_suffix(help: &str) -> String {
    if help.is_empty() { String::new() } else { format!("; {help}") }
}

/// Why a design is infeasible.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Infeasible {
    /// No strip takes this shape.
    #[error(transparent)]
    Elastica(#[from] ElasticaError),
    /// The phases are not different enough.
    #[error(
        "the target needs moduli with a contrast of {contrast:.3} (softest at s = {softest_mm:.2} mm, stiffest at \
         s = {stiffest_mm:.2} mm), but {phases} reach {reach:.3}; {help}"
    )]
    Contrast {
        /// Largest over smallest modulus.
        contrast: f64,
        /// What the phases reach.
        reach: f64,
        /// Where the modulus is smallest, mm from the rim.
        softest_mm: f64,
        /// Where it is largest, mm from the rim.
        stiffest_mm: f64,
        /// The phases.
        phases: String,
        /// What would help.
        help: String,
    },
}

impl Infeasible {
    /// The key of the design file that decides.
    #[must_use]
    pub fn key(&self) -> &'static str {
        match self {
            Self::Elastica(ElasticaError::NoWidth { .. }) => "strips.hub_radius_mm",
            Self::Elastica(ElasticaError::EqualEndsUndetermined { .. } | ElasticaError::EqualEndsHeld) => {
                "thrust.choice"
            }
            Self::Elastica(_) => "target",
            Self::Contrast { .. } => "materials.phases",
        }
    }
}

impl From<UnitCellError> for Error {
    fn from(error: UnitCellError) -> Self {
        match error {
            UnitCellError::Cancelled => Self::Cancelled,
            UnitCellError::Singular { .. } => Self::Solver(error.to_string()),
            other => Self::Input(InputError::new("", "", other.to_string()).in_file("micromechanics")),
        }
    }
}

impl Error {
    /// Names the file that the design was read from, where the error does not name one yet.
    #[must_use]
    pub fn in_file(self, file: &str) -> Self {
        match self {
            Self::Input(error) => Self::Input(error.in_file(file)),
            Self::Infeasible { reason, .. } => Self::Infeasible { name: file.to_owned(), reason },
            other => other,
        }
    }

    /// Exit code of the command line: 1 internal, 2 input, 3 infeasible, 4 solver, 5 output, 130 cancelled.
    #[must_use]
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Internal(_) => 1,
            Self::Input(_) => 2,
            Self::Infeasible { .. } => 3,
            Self::Solver(_) => 4,
            Self::Output { .. } => 5,
            Self::Cancelled => 130,
        }
    }

    /// A failure to write `path`.
    #[must_use]
    pub fn output(path: impl Into<PathBuf>, error: &std::io::Error) -> Self {
        let (problem, help) = match error.kind() {
            std::io::ErrorKind::PermissionDenied | std::io::ErrorKind::ReadOnlyFilesystem => {
                ("this cannot be written: no permission".to_owned(), "choose another folder with -o")
            }
            std::io::ErrorKind::StorageFull | std::io::ErrorKind::QuotaExceeded => {
                ("the disk is full".to_owned(), "free some space, or write fewer decks (decks.write)")
            }
            std::io::ErrorKind::NotADirectory | std::io::ErrorKind::AlreadyExists => {
                ("a file stands where a folder is needed".to_owned(), "choose another folder with -o")
            }
            _ => (format!("this cannot be written: {error}"), ""),
        };
        Self::Output { path: path.into(), problem, help: help.to_owned() }
    }

    pub(crate) fn infeasible(name: &str, reason: impl Into<Infeasible>) -> Self {
        Self::Infeasible { name: name.to_owned(), reason: reason.into() }
    }

    pub(crate) fn target(key: &str, value: impl std::fmt::Display, error: &TargetError) -> Self {
        Self::Input(InputError::new(key, value, error.to_string()))
    }

    pub(crate) fn calibration(error: &CalibrationError) -> Self {
        match error {
            CalibrationError::Cancelled => Self::Cancelled,
            other => Self::Input(InputError::new("voxels.match", "\"calibrated\"", other.to_string())),
        }
    }

    pub(crate) fn lattice(size_mm: f64, error: &LatticeError) -> Self {
        Self::Input(InputError::new("voxels.size_mm", size_mm, error.to_string()))
    }
}
