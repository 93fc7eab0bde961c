//! Energy, residual and tangent of a brick in large displacements.
//!
//! For St. Venant and Kirchhoff's law the enhanced modes are eliminated beforehand ([`EnhancedBrick`]). For another law
//! they are found here for every displacement, by Newton's method on nine unknowns, so that for the assembly the brick is a
//! function of its displacements alone in either case:
//!
//! ```text
//! min over alpha of sum_g V_g W(e_g + M_g alpha)      K = K_uu - K_ua K_aa^-1 K_au
//! ```

use nalgebra::{SMatrix, SVector};

use super::elasticity::{Response, dot};
use super::kinematics::Kinematics;
use super::{COMPONENTS, DOFS, ElementMatrix, ElementVector, EnhancedBrick, Geometry, Law, MODES, NODES, Voigt};

/// Newton steps for the enhanced modes of one element.
const MODE_ITERATIONS: usize = 25;

/// The answer of a brick to its displacements.
#[derive(Debug, Clone)]
pub struct Answer {
    /// Energy, N mm.
    pub energy: f64,
    /// Its derivative by the displacements, N: the forces that hold the brick.
    pub residual: ElementVector,
    /// Stress times volume at the Gauss points (second Piola-Kirchhoff), N mm.
    pub forces: [Voigt; NODES],
}

/// Strains and stresses at the Gauss points of a brick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointResults {
    /// Green-Lagrange strains, enhanced modes included, shears doubled.
    pub strains: [Voigt; NODES],
    /// Second Piola-Kirchhoff stresses, MPa.
    pub stresses: [Voigt; NODES],
}

impl EnhancedBrick {
    /// Energy and residual; `None` where the law has no answer because the brick is turned inside out.
    ///
    /// `modes` are the enhanced modes: where Newton's method starts, and what it finds. St. Venant and Kirchhoff's law
    /// does not need them.
    #[must_use]
    pub fn residual(&self, law: Law, displacements: &ElementVector, modes: &mut [f64; MODES]) -> Option<Answer> {
        let kinematics = Kinematics::new(self.geometry(), displacements);
        match law {
            Law::SaintVenantKirchhoff => Some(self.answer(&kinematics, None)),
            Law::NeoHooke => {
                let state = self.minimise(law, &kinematics, modes)?;
                Some(self.answer(&kinematics, Some(&state)))
            }
        }
    }

    /// Energy, residual and, into the upper triangle of `tangent`, the derivative of the residual, N/mm.
    ///
    /// As for [`Self::residual`], `None` where the law has no answer.
    #[must_use]
    pub fn tangent(
        &self,
        law: Law,
        displacements: &ElementVector,
        modes: &mut [f64; MODES],
        tangent: &mut ElementMatrix,
    ) -> Option<Answer> {
        let kinematics = Kinematics::new(self.geometry(), displacements);
        *tangent = [[0.0; DOFS]; DOFS];
        let answer = match law {
            Law::SaintVenantKirchhoff => {
                material_tangent(self, &kinematics, tangent);
                self.answer(&kinematics, None)
            }
            Law::NeoHooke => {
                let state = self.minimise(law, &kinematics, modes)?;
                let inverse = state.stiffness.try_inverse()?;
                condensed_tangent(self.geometry(), &kinematics, &state, &inverse, tangent);
                self.answer(&kinematics, Some(&state))
            }
        };
        geometric_tangent(self.geometry(), &answer.forces, tangent);
        Some(answer)
    }

    /// Strains, enhanced modes included, and second Piola-Kirchhoff stresses at the Gauss points; not a number where the
    /// brick is turned inside out.
    #[must_use]
    pub fn recover(&self, law: Law, displacements: &ElementVector, modes: &mut [f64; MODES]) -> PointResults {
        let kinematics = Kinematics::new(self.geometry(), displacements);
        if law == Law::SaintVenantKirchhoff {
            let forces = self.forces(&kinematics.strains);
            let stresses = std::array::from_fn(|g| forces[g].map(|f| f / self.geometry().volumes[g]));
            let strains = std::array::from_fn(|g| self.materials()[g].strain(&stresses[g]));
            return PointResults { strains, stresses };
        }
        let Some(state) = self.minimise(law, &kinematics, modes) else {
            return PointResults {
                strains: [[f64::NAN; COMPONENTS]; NODES],
                stresses: [[f64::NAN; COMPONENTS]; NODES],
            };
        };
        let strain = |g: usize, i: usize| {
            kinematics.strains[g][i] + self.geometry().modes[g][i].iter().zip(&*modes).map(|(m, a)| m * a).sum::<f64>()
        };
        PointResults {
            strains: std::array::from_fn(|g| std::array::from_fn(|i| strain(g, i))),
            stresses: std::array::from_fn(|g| state.responses[g].stress),
        }
    }

    fn answer(&self, kinematics: &Kinematics, state: Option<&ModeState>) -> Answer {
        let forces = state.map_or_else(|| self.forces(&kinematics.strains), |s| s.forces(self.geometry()));
        let mut residual = [0.0; DOFS];
        for (point, force) in forces.iter().enumerate() {
            let f = &kinematics.deformation[point];
            // First Piola-Kirchhoff stress F S, then its work on the gradients.
            let s = [[force[0], force[3], force[5]], [force[3], force[1], force[4]], [force[5], force[4], force[2]]];
            let mut p = [[0.0; 3]; 3];
            for k in 0..3 {
                for j in 0..3 {
                    p[k][j] = f[k][0] * s[0][j] + f[k][1] * s[1][j] + f[k][2] * s[2][j];
                }
            }
            for (r, g) in residual.chunks_exact_mut(3).zip(&self.geometry().gradients[point]) {
                for k in 0..3 {
                    r[k] += p[k][0] * g[0] + p[k][1] * g[1] + p[k][2] * g[2];
                }
            }
        }
        let energy = state.map_or_else(
            || 0.5 * forces.iter().zip(&kinematics.strains).map(|(f, e)| dot(f, e)).sum::<f64>(),
            |s| s.energy,
        );
        Answer { energy, residual, forces }
    }

    /// The enhanced modes of least energy.
    fn minimise(&self, law: Law, kinematics: &Kinematics, modes: &mut [f64; MODES]) -> Option<ModeState> {
        let mut state = ModeState::at(self, law, kinematics, modes).or_else(|| {
            *modes = [0.0; MODES];
            ModeState::at(self, law, kinematics, modes)
        })?;
        let scale: f64 = (0..NODES).map(|g| self.geometry().volumes[g] * self.materials()[g].modulus).sum();
        for _ in 0..MODE_ITERATIONS {
            let step = state.stiffness.lu().solve(&state.residual)?;
            let decrement = step.dot(&state.residual).abs();
            let mut share = 1.0;
            let next = loop {
                let moved = std::array::from_fn(|a| modes[a] - share * step[a]);
                match ModeState::at(self, law, kinematics, &moved) {
                    Some(next) if next.energy <= state.energy + 1e-12 * scale.abs() => break Some((moved, next)),
                    _ if share > 1e-3 => share *= 0.5,
                    _ => break None,
                }
            };
            let Some((moved, next)) = next else { break };
            (*modes, state) = (moved, next);
            // The decrement of the next step is the square of this one's.
            if decrement <= 1e-15 * scale {
                break;
            }
        }
        Some(state)
    }
}

/// A brick at some values of its enhanced modes.
struct ModeState {
    responses: [Response; NODES],
    energy: f64,
    residual: SVector<f64, MODES>,
    stiffness: SMatrix<f64, MODES, MODES>,
}

impl ModeState {
    fn at(brick: &EnhancedBrick, law: Law, kinematics: &Kinematics, modes: &[f64; MODES]) -> Option<Self> {
        let geometry = brick.geometry();
        let blank = Response { energy: 0.0, stress: [0.0; COMPONENTS], tangent: [[0.0; COMPONENTS]; COMPONENTS] };
        let mut state =
            Self { responses: [blank; NODES], energy: 0.0, residual: SVector::zeros(), stiffness: SMatrix::zeros() };
        for g in 0..NODES {
            let (volume, shape) = (geometry.volumes[g], &geometry.modes[g]);
            let strain: Voigt = std::array::from_fn(|i| {
                kinematics.strains[g][i] + shape[i].iter().zip(modes).map(|(m, a)| m * a).sum::<f64>()
            });
            let response = brick.materials()[g].respond(law, &strain)?;
            state.energy += volume * response.energy;
            for a in 0..MODES {
                let column = shape.map(|row| row[a]);
                state.residual[a] += volume * dot(&response.stress, &column);
                let pushed: Voigt = std::array::from_fn(|i| volume * dot(&response.tangent[i], &column));
                for b in 0..MODES {
                    state.stiffness[(b, a)] += (0..COMPONENTS).map(|i| shape[i][b] * pushed[i]).sum::<f64>();
                }
            }
            state.responses[g] = response;
        }
        state.energy.is_finite().then_some(state)
    }

    fn forces(&self, geometry: &Geometry) -> [Voigt; NODES] {
        std::array::from_fn(|g| self.responses[g].stress.map(|s| geometry.volumes[g] * s))
    }
}

/// Adds `G^T A G` to the upper triangle.
pub(super) fn material_tangent(brick: &EnhancedBrick, kinematics: &Kinematics, tangent: &mut ElementMatrix) {
    let geometry = brick.geometry();
    let mut relieved = [[0.0; DOFS]; MODES];
    for point in 0..NODES {
        let rows = kinematics.derivative(geometry, point);
        let (material, volume) = (&brick.materials()[point], geometry.volumes[point]);
        let (lambda, shear) = (volume * material.lambda(), volume * material.shear());
        let mut stressed = [[0.0; DOFS]; COMPONENTS];
        for c in 0..DOFS {
            let trace = lambda * (rows[0][c] + rows[1][c] + rows[2][c]);
            for i in 0..3 {
                stressed[i][c] = trace + 2.0 * shear * rows[i][c];
                stressed[i + 3][c] = shear * rows[i + 3][c];
            }
        }
        add_products(&rows, &stressed, 1.0, tangent);
        for (row, weights) in rows.iter().zip(&brick.relief()[point]) {
            for (mode, weight) in relieved.iter_mut().zip(weights) {
                for (value, b) in mode.iter_mut().zip(row) {
                    *value += weight * b;
                }
            }
        }
    }
    add_products(&relieved, &relieved, -1.0, tangent);
}

/// Adds the tangent of a brick whose modes were found for this displacement to the upper triangle.
fn condensed_tangent(
    geometry: &Geometry,
    kinematics: &Kinematics,
    state: &ModeState,
    inverse: &SMatrix<f64, MODES, MODES>,
    tangent: &mut ElementMatrix,
) {
    let mut coupled = [[0.0; DOFS]; MODES];
    for point in 0..NODES {
        let rows = kinematics.derivative(geometry, point);
        let (material, volume) = (&state.responses[point].tangent, geometry.volumes[point]);
        let mut stressed = [[0.0; DOFS]; COMPONENTS];
        for (stress, weights) in stressed.iter_mut().zip(material) {
            for (row, weight) in rows.iter().zip(weights) {
                for (value, b) in stress.iter_mut().zip(row) {
                    *value += volume * weight * b;
                }
            }
        }
        add_products(&rows, &stressed, 1.0, tangent);
        for (row, weights) in stressed.iter().zip(&geometry.modes[point]) {
            for (mode, weight) in coupled.iter_mut().zip(weights) {
                for (value, b) in mode.iter_mut().zip(row) {
                    *value += weight * b;
                }
            }
        }
    }
    let mut released = [[0.0; DOFS]; MODES];
    for a in 0..MODES {
        for b in 0..MODES {
            for c in 0..DOFS {
                released[a][c] += inverse[(a, b)] * coupled[b][c];
            }
        }
    }
    add_products(&coupled, &released, -1.0, tangent);
}

/// Adds `factor a^T b` to the upper triangle.
fn add_products<const N: usize>(
    a: &[ElementVector; N],
    b: &[ElementVector; N],
    factor: f64,
    tangent: &mut ElementMatrix,
) {
    for (r, row) in tangent.iter_mut().enumerate() {
        // Whole groups of eight columns are faster than the exact triangle.
        let first = r / 8 * 8;
        for (left, right) in a.iter().zip(b) {
            let weight = factor * left[r];
            for (value, right) in row[first..].iter_mut().zip(&right[first..]) {
                *value += weight * right;
            }
        }
    }
}

/// Adds the work of the stresses on the curvature of the strain to the upper triangle: `(dN_a . S dN_b) 1` for nodes a, b.
fn geometric_tangent(geometry: &Geometry, forces: &[Voigt; NODES], tangent: &mut ElementMatrix) {
    let mut blocks = [[0.0; NODES]; NODES];
    for (force, gradients) in forces.iter().zip(&geometry.gradients) {
        let pulled = gradients.map(|[x, y, z]| {
            [
                force[0] * x + force[3] * y + force[5] * z,
                force[3] * x + force[1] * y + force[4] * z,
                force[5] * x + force[4] * y + force[2] * z,
            ]
        });
        for (row, p) in blocks.iter_mut().zip(&pulled) {
            for (value, g) in row.iter_mut().zip(gradients) {
                *value += p[0] * g[0] + p[1] * g[1] + p[2] * g[2];
            }
        }
    }
    for (a, row) in blocks.iter().enumerate() {
        for (b, value) in row.iter().enumerate().skip(a) {
            for k in 0..3 {
                tangent[3 * a + k][3 * b + k] += value;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::Isotropic;
    use super::super::shape::CORNERS;
    use super::*;

    fn bent(amount: f64) -> ElementVector {
        std::array::from_fn(|i| amount * ((13 * i + 4) as f64).sin())
    }

    fn bricks() -> Vec<EnhancedBrick> {
        let material = |g: usize| Isotropic { modulus: 5.0 + g as f64, poisson: 0.3 };
        let mut corners = CORNERS;
        for (a, corner) in corners.iter_mut().enumerate() {
            corner[1] *= 1.0 + 0.2 * corner[0];
            corner[2] += 0.05 * (a as f64).sin();
        }
        vec![
            EnhancedBrick::new(Geometry::of_box([1.0, 1.0, 1.0]).unwrap(), material(0)),
            EnhancedBrick::graded(Geometry::of_hexahedron(&corners).unwrap(), std::array::from_fn(material)),
        ]
    }

    #[test]
    fn residual_and_tangent_are_derivatives_of_the_energy() {
        for brick in bricks() {
            for (law, amount) in [(Law::SaintVenantKirchhoff, 0.15), (Law::NeoHooke, 0.1)] {
                let u = bent(amount);
                let mut tangent = [[0.0; DOFS]; DOFS];
                let here = brick.tangent(law, &u, &mut [0.0; MODES], &mut tangent).unwrap();
                for j in 0..DOFS {
                    let step = 1e-5;
                    let at = |d: f64| {
                        let mut moved = u;
                        moved[j] += d;
                        brick.residual(law, &moved, &mut [0.0; MODES]).unwrap()
                    };
                    let (low, high) = (at(-step), at(step));
                    let slope = (high.energy - low.energy) / (2.0 * step);
                    assert!((slope - here.residual[j]).abs() < 1e-7, "{law:?} {j}: {slope} {}", here.residual[j]);
                    for i in 0..=j {
                        let slope = (high.residual[i] - low.residual[i]) / (2.0 * step);
                        assert!((slope - tangent[i][j]).abs() < 1e-6, "{law:?} {i} {j}: {slope} {}", tangent[i][j]);
                    }
                }
            }
        }
    }

    #[test]
    fn a_turned_brick_needs_no_forces_and_laws_agree_in_small_strains() {
        for brick in bricks() {
            let small = bent(1e-6);
            let [a, b] = [Law::SaintVenantKirchhoff, Law::NeoHooke]
                .map(|law| brick.residual(law, &small, &mut [0.0; MODES]).unwrap().residual);
            assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-9), "{a:?}\n{b:?}");
        }
        let brick = &bricks()[0];
        let (sin, cos) = 2.0_f64.sin_cos();
        let mut turned = [0.0; DOFS];
        for (a, c) in CORNERS.iter().enumerate() {
            turned[3 * a] = 0.5 * (cos * c[0] - sin * c[2] - c[0]);
            turned[3 * a + 2] = 0.5 * (sin * c[0] + cos * c[2] - c[2]);
        }
        for law in [Law::SaintVenantKirchhoff, Law::NeoHooke] {
            let answer = brick.residual(law, &turned, &mut [0.0; MODES]).unwrap();
            assert!(answer.residual.iter().all(|r| r.abs() < 1e-13));
        }
    }

    #[test]
    fn a_brick_turned_inside_out_has_no_neo_hookean_answer() {
        let mut flat = [0.0; DOFS];
        for (a, c) in CORNERS.iter().enumerate() {
            flat[3 * a] = -0.5 * c[0];
        }
        assert!(bricks()[0].residual(Law::NeoHooke, &flat, &mut [0.0; MODES]).is_none());
    }
}
