//! Green-Lagrange strain of a displaced brick and its derivative.

use super::{COMPONENTS, DOFS, ElementVector, Geometry, NODES, PAIRS, Voigt};

/// Deformation of a brick at its Gauss points.
#[derive(Debug, Clone)]
pub struct Kinematics {
    /// Deformation gradient `F = 1 + du/dX`: `[point][row][column]`.
    pub deformation: [[[f64; 3]; 3]; NODES],
    /// Compatible Green-Lagrange strain `e = (F^T F - 1)/2`.
    pub strains: [Voigt; NODES],
}

impl Kinematics {
    /// The deformation under displacements, mm.
    #[must_use]
    pub fn new(geometry: &Geometry, displacements: &ElementVector) -> Self {
        let mut deformation = [[[0.0; 3]; 3]; NODES];
        let mut strains = [[0.0; COMPONENTS]; NODES];
        for ((f, strain), gradients) in deformation.iter_mut().zip(&mut strains).zip(&geometry.gradients) {
            let mut h = [[0.0; 3]; 3];
            for (u, gradient) in displacements.chunks_exact(3).zip(gradients) {
                for (row, u) in h.iter_mut().zip(u) {
                    for (value, g) in row.iter_mut().zip(gradient) {
                        *value += u * g;
                    }
                }
            }
            for (component, [i, j]) in PAIRS.iter().enumerate() {
                // From the gradient of the displacement, so that small strains lose no digits.
                let square: f64 = (0..3).map(|k| h[k][*i] * h[k][*j]).sum();
                let doubled = h[*i][*j] + h[*j][*i] + square;
                strain[component] = if i == j { 0.5 * doubled } else { doubled };
            }
            *f = h;
            for k in 0..3 {
                f[k][k] += 1.0;
            }
        }
        Self { deformation, strains }
    }

    /// `G` at a Gauss point: `de_ij/du_ka = F_ki dN_a/dX_j`, symmetrised, shears doubled.
    #[must_use]
    pub fn derivative(&self, geometry: &Geometry, point: usize) -> [ElementVector; COMPONENTS] {
        let f = &self.deformation[point];
        let mut rows = [[0.0; DOFS]; COMPONENTS];
        for (a, g) in geometry.gradients[point].iter().enumerate() {
            for k in 0..3 {
                let [x, y, z] = f[k];
                let column = 3 * a + k;
                rows[0][column] = x * g[0];
                rows[1][column] = y * g[1];
                rows[2][column] = z * g[2];
                rows[3][column] = x * g[1] + y * g[0];
                rows[4][column] = y * g[2] + z * g[1];
                rows[5][column] = x * g[2] + z * g[0];
            }
        }
        rows
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rotation_strains_nothing_and_a_stretch_does_as_it_should() {
        let geometry = Geometry::of_box([1.0, 0.5, 2.0]).unwrap();
        let (sin, cos) = 1.3_f64.sin_cos();
        let mut turned = [0.0; DOFS];
        let mut stretched = [0.0; DOFS];
        for (a, c) in super::super::shape::CORNERS.iter().enumerate() {
            let [x, z] = [0.5 * c[0], c[2]];
            turned[3 * a] = cos * x - sin * z - x;
            turned[3 * a + 2] = sin * x + cos * z - z;
            stretched[3 * a] = 0.2 * x;
        }
        let at_rest = Kinematics::new(&geometry, &turned);
        assert!(at_rest.strains.iter().flatten().all(|e| e.abs() < 1e-15));
        let strain = Kinematics::new(&geometry, &stretched).strains[3];
        assert!((strain[0] - 0.5 * (1.2 * 1.2 - 1.0)).abs() < 1e-15 && strain[1..].iter().all(|e| e.abs() < 1e-15));
    }
}
