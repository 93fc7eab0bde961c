//! The stiffness of one cubic element.

use serde::{Deserialize, Serialize};

use crate::fem::element::{COMPONENTS, EnhancedBrick, Geometry, Isotropic, MODES, NODES};

pub(crate) use crate::fem::element::{DOFS, ElementMatrix as Brick};

/// Corners of a brick in the order of its nodes, in elements.
pub(crate) const CORNERS: [[usize; 3]; NODES] =
    [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]];

/// Which element.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum BrickKind {
    /// Trilinear displacements, fully integrated: C3D8 of the solvers. Moduli come out too high and fall with refinement.
    Trilinear,
    /// The same with nine enhanced strains: C3D8I of the solvers.
    Enhanced,
}

impl BrickKind {
    /// The stiffness of a cube of edge one, row by row; a cube of edge `h` has `h` times it. `None` for a material that is
    /// not elastic.
    pub(crate) fn stiffness(self, modulus: f64, poisson: f64) -> Option<Brick> {
        let mut geometry = Geometry::of_box([1.0; 3]).ok()?;
        if self == Self::Trilinear {
            geometry.modes = [[[0.0; MODES]; COMPONENTS]; NODES];
        }
        let stiffness = EnhancedBrick::new(geometry, Isotropic { modulus, poisson }).linear_stiffness();
        stiffness.iter().flatten().all(|k| k.is_finite()).then_some(stiffness)
    }
}
