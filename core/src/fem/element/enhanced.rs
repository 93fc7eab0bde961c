//! The brick with its enhanced modes eliminated, for a linear law between strain and stress.

use nalgebra::SMatrix;

use super::elasticity::{Isotropic, dot};
use super::{COMPONENTS, Geometry, MODES, NODES, Voigt};

/// A brick of a linear law; the matrix `A` of the module's documentation, kept as its two parts: with `D = R^T R` and
/// `Q_g = w_g C M_g R^-1`, `A = blockdiag(w_g C) - Q Q^T`.
#[derive(Debug, Clone, PartialEq)]
pub struct EnhancedBrick {
    geometry: Geometry,
    /// Elasticity of every Gauss point.
    materials: [Isotropic; NODES],
    /// `Q_g`: `[point][component][mode]`.
    relief: [[[f64; MODES]; COMPONENTS]; NODES],
}

impl EnhancedBrick {
    /// A brick of one material.
    #[must_use]
    pub fn new(geometry: Geometry, material: Isotropic) -> Self {
        Self::graded(geometry, [material; NODES])
    }

    /// A brick whose material differs from Gauss point to Gauss point.
    ///
    /// Moduli must be positive and Poisson's ratios between -1 and 0.5, or the modes are left without relief (a plain
    /// trilinear brick).
    #[must_use]
    pub fn graded(geometry: Geometry, materials: [Isotropic; NODES]) -> Self {
        let weighted: [[[f64; MODES]; COMPONENTS]; NODES] = std::array::from_fn(|g| {
            let mut rows = [[0.0; MODES]; COMPONENTS];
            for mode in 0..MODES {
                let strain = geometry.modes[g].map(|row| row[mode]);
                let stress = materials[g].stress(&strain);
                for (row, s) in rows.iter_mut().zip(stress) {
                    row[mode] = geometry.volumes[g] * s;
                }
            }
            rows
        });
        let stiffness = SMatrix::<f64, MODES, MODES>::from_fn(|a, b| {
            let at = |g: usize| (0..COMPONENTS).map(|i| geometry.modes[g][i][a] * weighted[g][i][b]).sum::<f64>();
            (0..NODES).map(at).sum()
        });
        let relief = stiffness.cholesky().map_or([[[0.0; MODES]; COMPONENTS]; NODES], |factor| {
            let lower = factor.l();
            weighted.map(|point| {
                point.map(|row| {
                    // Solve x R = row, that is L x^T = row^T.
                    let mut x = [0.0; MODES];
                    for a in 0..MODES {
                        let known: f64 = (0..a).map(|b| lower[(a, b)] * x[b]).sum();
                        x[a] = (row[a] - known) / lower[(a, a)];
                    }
                    x
                })
            })
        });
        Self { geometry, materials, relief }
    }

    /// Gradients, volumes and modes.
    #[must_use]
    pub fn geometry(&self) -> &Geometry {
        &self.geometry
    }

    /// Elasticity of every Gauss point.
    #[must_use]
    pub fn materials(&self) -> &[Isotropic; NODES] {
        &self.materials
    }

    /// `Q_g`, for the tangent.
    pub(crate) fn relief(&self) -> &[[[f64; MODES]; COMPONENTS]; NODES] {
        &self.relief
    }

    /// `A e`: stress times volume at every Gauss point, enhanced strains included, for compatible strains `e`.
    #[must_use]
    pub fn forces(&self, strains: &[Voigt; NODES]) -> [Voigt; NODES] {
        let mut modes = [0.0; MODES];
        for (strain, relief) in strains.iter().zip(&self.relief) {
            for (e, row) in strain.iter().zip(relief) {
                for (mode, q) in modes.iter_mut().zip(row) {
                    *mode += e * q;
                }
            }
        }
        std::array::from_fn(|g| {
            let stress = self.materials[g].stress(&strains[g]);
            std::array::from_fn(|i| {
                let relieved: f64 = self.relief[g][i].iter().zip(&modes).map(|(q, m)| q * m).sum();
                self.geometry.volumes[g] * stress[i] - relieved
            })
        })
    }

    /// Energy `e^T A e / 2`, N mm.
    #[must_use]
    pub fn energy(&self, strains: &[Voigt; NODES]) -> f64 {
        0.5 * self.forces(strains).iter().zip(strains).map(|(f, e)| dot(f, e)).sum::<f64>()
    }

    /// The matrix `A` itself, 48 x 48, Gauss point after Gauss point.
    #[must_use]
    pub fn matrix(&self) -> Vec<[f64; NODES * COMPONENTS]> {
        (0..NODES * COMPONENTS)
            .map(|column| {
                let mut strains = [[0.0; COMPONENTS]; NODES];
                strains[column / COMPONENTS][column % COMPONENTS] = 1.0;
                let forces = self.forces(&strains);
                std::array::from_fn(|row| forces[row / COMPONENTS][row % COMPONENTS])
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_condensed_matrix_is_symmetric_and_exact_for_constant_strain() {
        let material = Isotropic { modulus: 3.1, poisson: 0.4 };
        let brick = EnhancedBrick::new(Geometry::of_box([1.0, 2.0, 0.5]).unwrap(), material);
        let matrix = brick.matrix();
        for i in 0..48 {
            for j in 0..48 {
                assert!((matrix[i][j] - matrix[j][i]).abs() < 1e-14);
            }
        }
        let strain = [0.1, 0.02, -0.03, 0.05, 0.01, -0.07];
        let exact = 0.5 * dot(&material.stress(&strain), &strain);
        assert!((brick.energy(&[strain; NODES]) - exact).abs() < 1e-15);
    }

    #[test]
    fn eliminating_the_modes_is_minimising_the_energy_over_them() {
        let material = Isotropic { modulus: 2.0, poisson: 0.3 };
        let geometry = Geometry::of_box([1.0, 1.0, 1.0]).unwrap();
        let brick = EnhancedBrick::new(geometry.clone(), material);
        let strains: [Voigt; NODES] =
            std::array::from_fn(|g| std::array::from_fn(|i| 0.01 * ((11 * g + 5 * i) as f64).sin()));
        let least = brick.energy(&strains);
        let energy = |modes: &[f64; MODES]| -> f64 {
            (0..NODES)
                .map(|g| {
                    let add = |i: usize| geometry.modes[g][i].iter().zip(modes).map(|(m, a)| m * a).sum::<f64>();
                    let total: Voigt = std::array::from_fn(|i| strains[g][i] + add(i));
                    0.5 * geometry.volumes[g] * dot(&material.stress(&total), &total)
                })
                .sum()
        };
        for k in 0..40 {
            let modes: [f64; MODES] = std::array::from_fn(|a| 0.01 * ((a * 7 + 3 * k) as f64).cos());
            assert!(energy(&modes) > least);
        }
        // The condensed forces are stresses of the minimiser: they do no work on the modes.
        let forces = brick.forces(&strains);
        for mode in 0..MODES {
            let work = |g: usize| (0..COMPONENTS).map(|i| forces[g][i] * geometry.modes[g][i][mode]).sum::<f64>();
            assert!((0..NODES).map(work).sum::<f64>().abs() < 1e-15);
        }
    }
}
