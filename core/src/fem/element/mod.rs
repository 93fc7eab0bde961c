//! The eight-node brick with enhanced assumed strains, in the total Lagrangian description.
//!
//! ```text
//!          8---------7           natural coordinates (xi, eta, zeta) in [-1, 1]^3, xi along x, eta along y, zeta
//!         /|        /|           along z for an upright box; 2 x 2 x 2 Gauss points, numbered like the nodes
//!        5---------6 |
//!  zeta  | 4-------|-3           strains and stresses: xx, yy, zz, xy, yz, xz, shear strains doubled
//!  | eta |/        |/
//!  |/    1---------2  -- xi
//! ```
//!
//! The compatible Green-Lagrange strain at the Gauss points, `e` (8 times 6 numbers), is quadratic in the displacements. To it
//! nine internal modes `M alpha` are added (Simo and Rifai 1990): a linear normal strain along each axis and two modes for
//! each shear, which frees the element from the parasitic stiffness that trilinear bricks show in bending. With St.
//! Venant and Kirchhoff's law the modes can be eliminated once and for all, and the energy of an element is
//!
//! ```text
//! W = e^T A e / 2      A = blockdiag(w_g C) - L^T D^-1 L      L_g = w_g M_g^T C      D = sum_g w_g M_g^T C M_g
//! ```
//!
//! with one constant 48 x 48 matrix `A` for all equal boxes of one phase. Residual and tangent follow from the derivative
//! `G = de/du`: `G^T A e` and `G^T A G` plus the geometric term.
//!
//! - [`shape`]: shape functions and Gauss points;
//! - [`geometry`]: gradients, weights and the enhanced modes of a box or of any hexahedron;
//! - [`elasticity`]: isotropic elasticity of small and of large strains;
//! - [`enhanced`]: the condensed brick, with its matrix `A`;
//! - [`linear`]: its stiffness in small displacements, `G^T A G` at rest;
//! - [`kinematics`]: the strain `e` and its derivative `G`;
//! - [`morphing`]: energy, residual and tangent in large displacements, for both laws.

pub mod elasticity;
pub mod enhanced;
pub mod geometry;
pub mod kinematics;
pub mod linear;
pub mod morphing;
pub mod shape;

pub use elasticity::{Isotropic, Law};
pub use enhanced::EnhancedBrick;
pub use geometry::{Geometry, InvertedElement};

/// Nodes of a brick, and Gauss points.
pub const NODES: usize = 8;
/// Degrees of freedom of a brick: three a node, `3 node + direction`.
pub const DOFS: usize = 24;
/// Enhanced modes.
pub const MODES: usize = 9;
/// Components of a symmetric tensor.
pub const COMPONENTS: usize = 6;

/// A symmetric tensor: xx, yy, zz, xy, yz, xz; the shears of a strain are doubled.
pub type Voigt = [f64; COMPONENTS];
/// A value a degree of freedom.
pub type ElementVector = [f64; DOFS];
/// A matrix over the degrees of freedom, by rows.
pub type ElementMatrix = [[f64; DOFS]; DOFS];

/// Directions of the components of a symmetric tensor.
pub(crate) const PAIRS: [[usize; 2]; COMPONENTS] = [[0, 0], [1, 1], [2, 2], [0, 1], [1, 2], [0, 2]];
