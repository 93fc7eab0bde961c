//! What can keep a dome from being pressed.

use crate::elastica::ElasticaError;
use crate::error::Error;
use crate::fem::FemError;
use crate::input::InputError;

/// Why there is no force-displacement curve.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum IndentationError {
    /// The design is no dome.
    #[error("a rectangular strip has no hub to press on; indentation is for domes")]
    NotADome,
    /// A depth that the dome does not have.
    #[error("a depth of {depth_mm} mm is more than the dome's height of {height_mm:.3} mm")]
    TooDeep {
        /// mm.
        depth_mm: f64,
        /// mm.
        height_mm: f64,
    },
    /// The closed dome itself is not found.
    #[error("the closed dome: {0}")]
    Start(#[from] ElasticaError),
    /// No equilibrium at a depth.
    #[error(
        "no equilibrium at a depth of {depth_mm:.4} mm: after {iterations} iterations the residual is {residual:.1e} of \
         the forces; use a smaller depth or more steps"
    )]
    NoEquilibrium {
        /// mm.
        depth_mm: f64,
        /// Iterations of the last attempt.
        iterations: usize,
        /// Residual, relative to the forces.
        residual: f64,
    },
    /// The set of touching nodes does not settle.
    #[error(
        "contact does not settle at a depth of {depth_mm:.4} mm: after {rounds} rounds {changes} nodes still change"
    )]
    Contact {
        /// mm.
        depth_mm: f64,
        /// Rounds spent.
        rounds: usize,
        /// Nodes that changed in the last one.
        changes: usize,
    },
    /// The finite elements failed.
    #[error(transparent)]
    FiniteElements(#[from] FemError),
    /// The user cancelled.
    #[error("cancelled")]
    Cancelled,
}

impl From<IndentationError> for Error {
    fn from(error: IndentationError) -> Self {
        match error {
            IndentationError::Cancelled | IndentationError::FiniteElements(FemError::Cancelled) => Self::Cancelled,
            IndentationError::NotADome => Self::Input(InputError::new("target.kind", "\"strip\"", error.to_string())),
            IndentationError::TooDeep { depth_mm, .. } => {
                Self::Input(InputError::new("indentation.depth_mm", depth_mm, error.to_string()))
            }
            IndentationError::FiniteElements(error) => error.into(),
            other => Self::Solver(other.to_string()),
        }
    }
}
