//! The graded elastica: strips whose bending stiffness varies along their length.
//!
//! A strip of width `w(s)`, thickness `t` and modulus `E(s)` has the bending stiffness `B = E w t^3 / 12` and carries
//! the moment `M = B theta'`. With a horizontal force `H` (positive when the seat pushes the rim inward) and a vertical
//! force `V` (positive when the hub is pushed up), equilibrium `M' = -(H sin(theta) + V cos(theta))` integrates to
//!
//! ```text
//! M(s) = M_0 - H z(s) - V x(s)
//! ```
//!
//! so the moment is linear in the position and vanishes on a straight line, the *line of thrust*.
//!
//! - [`inflection`] finds where the curvature of a meridian vanishes;
//! - [`thrust_line`] holds the line of thrust and the modulus that it implies;
//! - [`inverse`] chooses the line of thrust, by the published rule or by [`least_contrast`];
//! - [`forward`] solves the shape that a given stiffness takes;
//! - [`morph`] follows the strip from flat to its final shape.

mod error;
pub mod forward;
pub mod inflection;
pub mod inverse;
pub mod least_contrast;
pub mod morph;
pub mod tessellation;
pub mod thrust_line;

pub use error::ElasticaError;
pub use inverse::{HubSupport, InverseSolution, ThrustChoice};
pub use thrust_line::ThrustLine;
