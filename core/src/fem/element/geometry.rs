//! Gradients, weights and enhanced modes of a brick at its Gauss points.

use nalgebra::Matrix3;

use super::shape::{CORNERS, derivatives, gauss_point};
use super::{COMPONENTS, MODES, NODES, PAIRS};

/// A hexahedron whose corners are in the wrong order or that is folded.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("the determinant of an element's Jacobian is {determinant:e} at a Gauss point; it must be positive")]
pub struct InvertedElement {
    /// The determinant that was found, mm^3.
    pub determinant: f64,
}

/// What the element's integrals need, all of it of the flat state.
#[derive(Debug, Clone, PartialEq)]
pub struct Geometry {
    /// Derivatives of the shape functions by x, y and z, 1/mm: `[point][node][direction]`.
    pub gradients: [[[f64; 3]; NODES]; NODES],
    /// Volume of every Gauss point, mm^3.
    pub volumes: [f64; NODES],
    /// Strain of every enhanced mode: `[point][component][mode]`.
    pub modes: [[[f64; MODES]; COMPONENTS]; NODES],
}

impl Geometry {
    /// An upright box of the given edges, mm.
    ///
    /// # Errors
    /// [`InvertedElement`] unless every edge is positive.
    pub fn of_box(edges: [f64; 3]) -> Result<Self, InvertedElement> {
        Self::of_hexahedron(&CORNERS.map(|c| [0, 1, 2].map(|k| 0.5 * edges[k] * c[k])))
    }

    /// Any hexahedron, by its corners in the order of the nodes, mm.
    ///
    /// With `J = dx/dxi` at a point and `J_0` in the centre, a mode `m` of natural coordinates is the strain
    /// `(det J_0 / det J) J_0^-T m J_0^-1`: its integral over the element vanishes, so constant stresses do no work on it and
    /// the patch test is passed for any shape (Simo and Rifai 1990, eq. 3.10).
    ///
    /// # Errors
    /// [`InvertedElement`] where the Jacobian is not positive at every Gauss point and in the centre.
    pub fn of_hexahedron(corners: &[[f64; 3]; NODES]) -> Result<Self, InvertedElement> {
        let (centre_inverse, centre_determinant) = inverse(&jacobian(corners, [0.0; 3]))?;
        let mut geometry = Self {
            gradients: [[[0.0; 3]; NODES]; NODES],
            volumes: [0.0; NODES],
            modes: [[[0.0; MODES]; COMPONENTS]; NODES],
        };
        for point in 0..NODES {
            let at = gauss_point(point);
            let (to_natural, determinant) = inverse(&jacobian(corners, at))?;
            geometry.volumes[point] = determinant;
            for (gradient, natural) in geometry.gradients[point].iter_mut().zip(derivatives(at)) {
                // dN/dx_k = dN/dxi_i dxi_i/dx_k
                *gradient = [0, 1, 2].map(|k| (0..3).map(|i| natural[i] * to_natural[(i, k)]).sum());
            }
            let scale = centre_determinant / determinant;
            for (mode, (component, coordinate)) in NATURAL_MODES.iter().enumerate() {
                let [i, j] = PAIRS[*component];
                let value = scale * at[*coordinate];
                for (row, [k, l]) in PAIRS.iter().enumerate() {
                    // A doubled shear stands for two equal components; the rows of shears are doubled themselves.
                    let product = |k: usize, l: usize| centre_inverse[(i, k)] * centre_inverse[(j, l)];
                    let tensor = if i == j { product(*k, *l) } else { 0.5 * (product(*k, *l) + product(*l, *k)) };
                    geometry.modes[point][row][mode] = value * tensor * if k == l { 1.0 } else { 2.0 };
                }
            }
        }
        Ok(geometry)
    }

    /// Volume of the element, mm^3.
    #[must_use]
    pub fn volume(&self) -> f64 {
        self.volumes.iter().sum()
    }
}

/// Component and natural coordinate of every enhanced mode.
const NATURAL_MODES: [(usize, usize); MODES] = [(0, 0), (1, 1), (2, 2), (3, 0), (3, 1), (4, 1), (4, 2), (5, 0), (5, 2)];

fn jacobian(corners: &[[f64; 3]; NODES], at: [f64; 3]) -> Matrix3<f64> {
    let natural = derivatives(at);
    Matrix3::from_fn(|k, i| corners.iter().zip(&natural).map(|(x, d)| x[k] * d[i]).sum())
}

/// `dxi/dx` and the determinant of `dx/dxi`.
fn inverse(jacobian: &Matrix3<f64>) -> Result<(Matrix3<f64>, f64), InvertedElement> {
    let determinant = jacobian.determinant();
    match jacobian.try_inverse() {
        Some(inverse) if determinant > 0.0 && determinant.is_finite() => Ok((inverse, determinant)),
        _ => Err(InvertedElement { determinant }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A box with its corners moved.
    pub fn skewed() -> [[f64; 3]; NODES] {
        let mut corners = CORNERS.map(|c| [1.1 * c[0], 0.9 * c[1], 0.7 * c[2]]);
        for (a, corner) in corners.iter_mut().enumerate() {
            for (k, x) in corner.iter_mut().enumerate() {
                *x += 0.08 * ((7 * a + 3 * k) as f64).sin();
            }
        }
        corners
    }

    #[test]
    fn gradients_reproduce_a_linear_field_and_modes_do_no_work_on_constant_stress() {
        for corners in [CORNERS, skewed()] {
            let geometry = Geometry::of_hexahedron(&corners).unwrap();
            let slope = [0.3, -0.8, 1.7];
            for point in 0..NODES {
                for k in 0..3 {
                    let field = |a: usize| (0..3).map(|i| slope[i] * corners[a][i]).sum::<f64>();
                    let found: f64 = (0..NODES).map(|a| field(a) * geometry.gradients[point][a][k]).sum();
                    assert!((found - slope[k]).abs() < 1e-13);
                }
            }
            for component in 0..COMPONENTS {
                for mode in 0..MODES {
                    let value = |g: usize| geometry.volumes[g] * geometry.modes[g][component][mode];
                    assert!((0..NODES).map(value).sum::<f64>().abs() < 1e-14);
                }
            }
        }
    }

    #[test]
    fn a_folded_or_flat_element_is_refused() {
        let mut corners = CORNERS;
        corners.swap(0, 6);
        assert!(Geometry::of_hexahedron(&corners).is_err());
        assert!(Geometry::of_box([1.0, 0.0, 1.0]).is_err());
        assert!(Geometry::of_box([1.0, f64::NAN, 1.0]).is_err());
        assert!((Geometry::of_box([1.0, 2.0, 0.5]).unwrap().volume() - 1.0).abs() < 1e-14);
    }
}
