//! Stiffness of the brick in small displacements.

use super::kinematics::Kinematics;
use super::morphing::material_tangent;
use super::{DOFS, ElementMatrix, EnhancedBrick};

impl EnhancedBrick {
    /// `G^T A G` at rest, N/mm: symmetric, with the six rigid motions as its null space.
    ///
    /// It scales with the modulus, so for equal boxes of one Poisson's ratio one matrix serves every phase.
    #[must_use]
    pub fn linear_stiffness(&self) -> ElementMatrix {
        let rest = Kinematics::new(self.geometry(), &[0.0; DOFS]);
        let mut stiffness = [[0.0; DOFS]; DOFS];
        material_tangent(self, &rest, &mut stiffness);
        for i in 0..DOFS {
            for j in 0..i {
                stiffness[i][j] = stiffness[j][i];
            }
        }
        stiffness
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::SMatrix;

    use super::super::shape::CORNERS;
    use super::super::{Geometry, Isotropic, NODES};
    use super::*;

    fn skewed() -> [[f64; 3]; NODES] {
        let mut corners = CORNERS.map(|c| [0.8 * c[0], 0.5 * c[1], 0.6 * c[2]]);
        for (a, corner) in corners.iter_mut().enumerate() {
            for (k, x) in corner.iter_mut().enumerate() {
                *x += 0.07 * ((5 * a + 2 * k) as f64).sin();
            }
        }
        corners
    }

    #[test]
    fn there_are_six_zero_modes_and_no_more() {
        let material = Isotropic { modulus: 1.0, poisson: 0.3 };
        for corners in [CORNERS, skewed()] {
            let brick = EnhancedBrick::new(Geometry::of_hexahedron(&corners).unwrap(), material);
            let stiffness = brick.linear_stiffness();
            let eigenvalues = SMatrix::<f64, DOFS, DOFS>::from_fn(|i, j| stiffness[i][j]).symmetric_eigenvalues();
            let mut values: Vec<f64> = eigenvalues.iter().copied().collect();
            values.sort_by(f64::total_cmp);
            assert!(values[..6].iter().all(|v| v.abs() < 1e-13), "{values:?}");
            assert!(values[6] > 1e-3, "{values:?}");
        }
    }

    #[test]
    fn a_cube_bends_as_softly_as_a_beam() {
        // Pure bending about y of a box: u = c x z, w = -c x^2/2 - nu c ... at the corners only the first part differs;
        // the exact energy is that of the beam with free sides, M^2 L / (2 E I), for the rotation the corners prescribe.
        let (modulus, poisson) = (1.0, 0.3);
        let brick = EnhancedBrick::new(Geometry::of_box([2.0; 3]).unwrap(), Isotropic { modulus, poisson });
        let stiffness = brick.linear_stiffness();
        let mut u = [0.0; DOFS];
        for (a, c) in CORNERS.iter().enumerate() {
            u[3 * a] = c[0] * c[2];
        }
        let energy: f64 = (0..DOFS).map(|i| (0..DOFS).map(|j| 0.5 * u[i] * stiffness[i][j] * u[j]).sum::<f64>()).sum();
        // Curvature 1, length 2, EI = E 2 2^3 / 12; the side strains e_yy of the corners are held at zero, so the box is
        // between the beam and the plate E/(1 - nu^2); the trilinear brick has E (1 - nu)/((1 + nu)(1 - 2 nu)) and its
        // parasitic shear G on top.
        let beam = 0.5 * modulus * 16.0 / 12.0 * 2.0;
        let plate = beam / (1.0 - poisson * poisson);
        assert!(energy > beam && energy < 1.001 * plate, "{energy} between {beam} and {plate}");
    }
}
