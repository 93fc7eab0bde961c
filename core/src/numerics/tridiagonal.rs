//! Symmetric tridiagonal systems, indefinite ones included.

/// Factors of a tridiagonal matrix, rows exchanged where that is safer.
#[derive(Debug, Clone, Default)]
pub struct Tridiagonal {
    diagonal: Vec<f64>,
    above: Vec<f64>,
    second: Vec<f64>,
    multiplier: Vec<f64>,
    exchanged: Vec<bool>,
}

impl Tridiagonal {
    /// Factors the symmetric matrix with a diagonal and what stands beside it; `None` where it is singular.
    #[must_use]
    pub fn factor(diagonal: &[f64], beside: &[f64]) -> Option<Self> {
        let n = diagonal.len();
        let mut f = Self {
            diagonal: diagonal.to_vec(),
            above: beside.to_vec(),
            second: vec![0.0; n.saturating_sub(2)],
            multiplier: beside.to_vec(),
            exchanged: vec![false; n.saturating_sub(1)],
        };
        for i in 0..n.saturating_sub(1) {
            let below = f.multiplier[i];
            if f.diagonal[i].abs() >= below.abs() {
                if f.diagonal[i] == 0.0 {
                    return None;
                }
                let m = below / f.diagonal[i];
                f.multiplier[i] = m;
                f.diagonal[i + 1] -= m * f.above[i];
            } else {
                // The next row becomes the pivot's.
                let m = f.diagonal[i] / below;
                f.exchanged[i] = true;
                f.multiplier[i] = m;
                (f.diagonal[i], f.above[i], f.diagonal[i + 1]) =
                    (below, f.diagonal[i + 1], f.above[i] - m * f.diagonal[i + 1]);
                if i + 2 < n {
                    f.second[i] = f.above[i + 1];
                    f.above[i + 1] *= -m;
                }
            }
        }
        f.diagonal.last().is_some_and(|d| *d != 0.0 && d.is_finite()).then_some(f)
    }

    /// Replaces a right-hand side by the solution.
    pub fn solve(&self, b: &mut [f64]) {
        let n = self.diagonal.len();
        for i in 0..n - 1 {
            if self.exchanged[i] {
                b.swap(i, i + 1);
            }
            b[i + 1] -= self.multiplier[i] * b[i];
        }
        for i in (0..n).rev() {
            if i + 1 < n {
                b[i] -= self.above[i] * b[i + 1];
            }
            if i + 2 < n {
                b[i] -= self.second[i] * b[i + 2];
            }
            b[i] /= self.diagonal[i];
        }
    }
}

/// Negative eigenvalues of the symmetric tridiagonal matrix (Sturm's count at zero).
#[must_use]
pub fn negative_eigenvalues(diagonal: &[f64], beside: &[f64]) -> usize {
    let mut pivot: f64 = 1.0;
    let mut count = 0;
    for (i, d) in diagonal.iter().enumerate() {
        let coupling = if i == 0 { 0.0 } else { beside[i - 1] };
        // A vanishing pivot is moved off zero by what rounding leaves of its row.
        let last = if pivot.abs() < f64::MIN_POSITIVE { f64::MIN_POSITIVE } else { pivot };
        pivot = d - coupling * coupling / last;
        count += usize::from(pivot < 0.0);
    }
    count
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector};

    use super::*;

    #[test]
    fn indefinite_systems_are_solved_and_their_negative_eigenvalues_counted() {
        for n in [1, 2, 3, 9, 40] {
            let diagonal: Vec<f64> = (0..n).map(|i| (1.7 * i as f64).sin()).collect();
            let beside: Vec<f64> = (1..n).map(|i| 0.4 + (0.9 * i as f64).cos()).collect();
            let dense = DMatrix::from_fn(n, n, |i, j| match i.abs_diff(j) {
                0 => diagonal[i] + 1e-3,
                1 => beside[i.min(j)],
                _ => 0.0,
            });
            let diagonal: Vec<f64> = diagonal.iter().map(|d| d + 1e-3).collect();
            let expected = DVector::from_fn(n, |i, _| 1.0 + i as f64);
            let mut b: Vec<f64> = (&dense * &expected).iter().copied().collect();
            Tridiagonal::factor(&diagonal, &beside).unwrap().solve(&mut b);
            for (found, expected) in b.iter().zip(expected.iter()) {
                assert!((found - expected).abs() < 1e-8 * n as f64, "{n}: {found} {expected}");
            }
            let negative = dense.symmetric_eigenvalues().iter().filter(|e| **e < 0.0).count();
            assert_eq!(negative_eigenvalues(&diagonal, &beside), negative, "{n}");
        }
        assert!(Tridiagonal::factor(&[1.0, 1.0], &[1.0]).is_none());
    }
}
