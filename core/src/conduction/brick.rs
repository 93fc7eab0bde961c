//! The trilinear eight-node brick for a scalar potential.
//!
//! With shape functions `N_a` and the gradient operator `B = grad N`, a brick of unit conductivity has
//!
//! ```text
//! K_ab = int B_a . B_b dV      V_a = int N_a dV
//! ```
//!
//! by 2 x 2 x 2 Gauss points, as the bricks DC3D8 of ABAQUS and C3D8 of CalculiX do. `K` is in mm (times a conductivity
//! per mm it is a conductance), `V`, which lumps the heat capacity on the nodes by row sums, in mm^3. For a cube of edge `h`
//! `K` is exact: `h/3` on the diagonal, 0 along edges, `-h/12` across faces and through the body.

use super::ConductionError;

/// A node's position, mm.
pub type Point = [f64; 3];

/// Matrix of an eight-node brick, row by row.
pub type Matrix = [f64; 64];

/// Conductance matrix of a brick for unit conductivity, mm, and the volumes lumped on its nodes, mm^3.
#[derive(Debug, Clone, PartialEq)]
pub struct Brick {
    /// `K`, symmetric, rows and columns sum to zero.
    pub conductance: Matrix,
    /// `V`, positive.
    pub volumes: [f64; 8],
}

/// Number of a node within its brick: `4 along + 2 layer + across` with each of them 0 or 1.
#[must_use]
pub const fn corner(along: usize, layer: usize, across: usize) -> usize {
    4 * along + 2 * layer + across
}

impl Brick {
    /// A cube of edge `size_mm`.
    #[must_use]
    pub fn cube(size_mm: f64) -> Self {
        let mut conductance = [0.0; 64];
        for a in 0..8_usize {
            for b in 0..8_usize {
                // Nodes differ in as many directions as bits.
                conductance[8 * a + b] = size_mm
                    * match (a ^ b).count_ones() {
                        0 => 1.0 / 3.0,
                        1 => 0.0,
                        _ => -1.0 / 12.0,
                    };
            }
        }
        Self { conductance, volumes: [size_mm.powi(3) / 8.0; 8] }
    }

    /// A brick by its nodes, numbered as by [`corner`]; along, across and upwards are right-handed.
    ///
    /// # Errors
    /// [`ConductionError::Inverted`] where the Jacobian is not positive at a Gauss point.
    pub fn new(nodes: &[Point; 8]) -> Result<Self, ConductionError> {
        let at = 0.5 / 3.0_f64.sqrt();
        let mut brick = Self { conductance: [0.0; 64], volumes: [0.0; 8] };
        for point in 0..8_usize {
            let local =
                [point >> 2 & 1, point >> 1 & 1, point & 1].map(|bit| if bit == 1 { 0.5 + at } else { 0.5 - at });
            let (values, slopes) = shape(local);
            let mut jacobian = [[0.0; 3]; 3];
            for (node, slope) in nodes.iter().zip(&slopes) {
                for (row, s) in jacobian.iter_mut().zip(slope) {
                    for (entry, x) in row.iter_mut().zip(node) {
                        *entry += s * x;
                    }
                }
            }
            // Local axes are along, up, across: left-handed.
            let (inverse, determinant) = inverse(&jacobian);
            let volume = -determinant / 8.0;
            if volume <= 0.0 || !volume.is_finite() {
                return Err(ConductionError::Inverted { at_mm: nodes[0] });
            }
            let gradients = slopes.map(|s| [0, 1, 2].map(|i| (0..3).map(|j| inverse[i][j] * s[j]).sum::<f64>()));
            for a in 0..8 {
                brick.volumes[a] += values[a] * volume;
                for b in 0..8 {
                    let product: f64 = (0..3).map(|i| gradients[a][i] * gradients[b][i]).sum();
                    brick.conductance[8 * a + b] += product * volume;
                }
            }
        }
        Ok(brick)
    }

    /// Largest eigenvalue of the matrix scaled by its diagonal. That of any mesh of such bricks, whatever their
    /// conductivities, is not larger.
    #[must_use]
    pub fn largest_scaled_eigenvalue(&self) -> f64 {
        let scale = |a: usize| 1.0 / self.conductance[9 * a].max(f64::MIN_POSITIVE).sqrt();
        let scaled = nalgebra::SMatrix::<f64, 8, 8>::from_fn(|a, b| self.conductance[8 * a + b] * scale(a) * scale(b));
        scaled.symmetric_eigenvalues().max()
    }
}

/// Shape functions and their slopes in the unit cube.
pub(super) fn shape(local: [f64; 3]) -> ([f64; 8], [[f64; 3]; 8]) {
    let mut values = [0.0; 8];
    let mut slopes = [[0.0; 3]; 8];
    for a in 0..8_usize {
        let bits = [a >> 2 & 1, a >> 1 & 1, a & 1];
        let factor = |d: usize| if bits[d] == 1 { local[d] } else { 1.0 - local[d] };
        let sign = |d: usize| if bits[d] == 1 { 1.0 } else { -1.0 };
        values[a] = factor(0) * factor(1) * factor(2);
        slopes[a] = [sign(0) * factor(1) * factor(2), factor(0) * sign(1) * factor(2), factor(0) * factor(1) * sign(2)];
    }
    (values, slopes)
}

/// Inverse and determinant of a 3 x 3 matrix whose rows are derivatives by a local coordinate.
fn inverse(m: &[[f64; 3]; 3]) -> ([[f64; 3]; 3], f64) {
    let cofactor = |i: usize, j: usize| {
        let (a, b, c, d) = ((i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3);
        m[a][c] * m[b][d] - m[a][d] * m[b][c]
    };
    let determinant = (0..3).map(|j| m[0][j] * cofactor(0, j)).sum::<f64>();
    ([0, 1, 2].map(|j| [0, 1, 2].map(|i| cofactor(i, j) / determinant)), determinant)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn nodes(map: impl Fn([f64; 3]) -> Point) -> [Point; 8] {
        std::array::from_fn(|a| map([(a >> 2 & 1) as f64, (a & 1) as f64, (a >> 1 & 1) as f64]))
    }

    #[test]
    fn a_cube_has_its_closed_form() {
        let general = Brick::new(&nodes(|x| x.map(|c| 0.5 * c))).unwrap();
        let cube = Brick::cube(0.5);
        for (a, b) in general.conductance.iter().zip(&cube.conductance) {
            assert!((a - b).abs() < 1e-15);
        }
        assert!((cube.largest_scaled_eigenvalue() - 1.5).abs() < 1e-12);
        assert!((general.volumes.iter().sum::<f64>() - 0.125).abs() < 1e-15);
    }

    #[test]
    fn a_linear_field_has_its_energy_on_any_hexahedron() {
        // Patch test: the energy of a linear field is its gradient squared times the volume.
        let hexahedron = nodes(|[x, y, z]| [x + 0.2 * x * y - 0.1 * z, y + 0.15 * x * z, z + 0.1 * x * y + 0.3 * x]);
        let brick = Brick::new(&hexahedron).unwrap();
        let gradient = [0.3, -1.2, 0.7];
        let field = hexahedron.map(|p| p.iter().zip(&gradient).map(|(x, g)| x * g).sum::<f64>());
        let flux: Vec<f64> = (0..8).map(|a| (0..8).map(|b| brick.conductance[8 * a + b] * field[b]).sum()).collect();
        let energy: f64 = flux.iter().zip(&field).map(|(f, u)| f * u).sum();
        let exact = gradient.iter().map(|g| g * g).sum::<f64>() * brick.volumes.iter().sum::<f64>();
        assert!((energy / exact - 1.0).abs() < 1e-12);
        assert!(flux.iter().sum::<f64>().abs() < 1e-13);
    }

    #[test]
    fn inverted_bricks_are_refused() {
        assert!(matches!(Brick::new(&nodes(|[x, y, z]| [x, y, -z])), Err(ConductionError::Inverted { .. })));
    }
}
