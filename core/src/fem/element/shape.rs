//! Trilinear shape functions and the 2 x 2 x 2 Gauss rule.

use super::NODES;

/// Natural coordinates of the nodes.
pub const CORNERS: [[f64; 3]; NODES] = [
    [-1.0, -1.0, -1.0],
    [1.0, -1.0, -1.0],
    [1.0, 1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [1.0, -1.0, 1.0],
    [1.0, 1.0, 1.0],
    [-1.0, 1.0, 1.0],
];

/// Natural coordinates of Gauss point `point`: those of the node of that number, divided by the square root of three.
/// Every point has the weight one.
#[must_use]
pub fn gauss_point(point: usize) -> [f64; 3] {
    CORNERS[point].map(|c| c / 3.0_f64.sqrt())
}

/// Values of the shape functions `N_a = (1 + xi_a xi)(1 + eta_a eta)(1 + zeta_a zeta) / 8`.
#[must_use]
pub fn values(at: [f64; 3]) -> [f64; NODES] {
    CORNERS.map(|c| 0.125 * (0..3).map(|k| 1.0 + c[k] * at[k]).product::<f64>())
}

/// Derivatives of the shape functions by the natural coordinates.
#[must_use]
pub fn derivatives(at: [f64; 3]) -> [[f64; 3]; NODES] {
    CORNERS.map(|c| {
        let factor = |k: usize| 1.0 + c[k] * at[k];
        [
            0.125 * c[0] * factor(1) * factor(2),
            0.125 * c[1] * factor(0) * factor(2),
            0.125 * c[2] * factor(0) * factor(1),
        ]
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shape_functions_are_one_at_their_node_and_sum_to_one() {
        for (a, corner) in CORNERS.iter().enumerate() {
            let n = values(*corner);
            assert!((0..NODES).all(|b| (n[b] - f64::from(u8::from(a == b))).abs() < 1e-15));
        }
        let at = [0.3, -0.2, 0.7];
        assert!((values(at).iter().sum::<f64>() - 1.0).abs() < 1e-15);
        let d = derivatives(at);
        for k in 0..3 {
            let mut ahead = at;
            ahead[k] += 1e-6;
            for a in 0..NODES {
                assert!(((values(ahead)[a] - values(at)[a]) / 1e-6 - d[a][k]).abs() < 1e-9);
            }
        }
    }
}
