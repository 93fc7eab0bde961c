//! Symmetric positive definite systems with a narrow band.

/// A symmetric matrix of `order` rows with `width` diagonals below the main one, stored by rows: entry `(i, i - d)` at
/// `i * (width + 1) + d`.
#[derive(Debug, Clone)]
pub(super) struct BandedSymmetric {
    order: usize,
    width: usize,
    entries: Vec<f64>,
}

impl BandedSymmetric {
    pub fn zeros(order: usize, width: usize) -> Self {
        Self { order, width, entries: vec![0.0; order * (width + 1)] }
    }

    /// Entry `(i, j)`; zero outside the band.
    pub fn get(&self, i: usize, j: usize) -> f64 {
        let (low, high) = (i.min(j), i.max(j));
        if high - low > self.width { 0.0 } else { self.entries[high * (self.width + 1) + high - low] }
    }

    /// Adds to entry `(i, j)` with `j <= i`, which must lie in the band.
    pub fn add(&mut self, i: usize, j: usize, value: f64) {
        debug_assert!(j <= i && i - j <= self.width);
        self.entries[i * (self.width + 1) + i - j] += value;
    }

    pub fn trace(&self) -> f64 {
        self.entries.iter().step_by(self.width + 1).sum()
    }

    /// `self + weight * other`; both must have the same shape.
    pub fn plus(&self, weight: f64, other: &Self) -> Self {
        debug_assert!(self.order == other.order && self.width == other.width);
        let entries = self.entries.iter().zip(&other.entries).map(|(a, b)| a + weight * b).collect();
        Self { entries, ..*self }
    }

    /// The factors `L D L^T`, or `None` where a pivot is not positive.
    pub fn factorised(&self) -> Option<BandedFactor> {
        let mut lower = self.clone();
        for i in 0..self.order {
            let first = i.saturating_sub(self.width);
            for j in first..i {
                // Here row i still holds L_ij D_j for the columns done so far.
                let mut value = lower.get(i, j);
                for k in first.max(j.saturating_sub(self.width))..j {
                    value -= lower.get(i, k) * lower.get(j, k);
                }
                lower.entries[i * (self.width + 1) + i - j] = value;
            }
            let mut pivot = lower.get(i, i);
            let scale = pivot;
            for j in first..i {
                let scaled = lower.get(i, j);
                let ratio = scaled / lower.get(j, j);
                pivot -= scaled * ratio;
                lower.entries[i * (self.width + 1) + i - j] = ratio;
            }
            if pivot.is_nan() || pivot <= 1e-15 * scale {
                return None;
            }
            lower.entries[i * (self.width + 1)] = pivot;
        }
        Some(BandedFactor { lower })
    }
}

/// The factors `L D L^T` of a [`BandedSymmetric`]: `D` on the main diagonal, `L` below it.
#[derive(Debug, Clone)]
pub(super) struct BandedFactor {
    lower: BandedSymmetric,
}

impl BandedFactor {
    /// Solves for two right sides at once.
    pub fn solve(&self, right: &[[f64; 2]]) -> Vec<[f64; 2]> {
        let (order, width) = (self.lower.order, self.lower.width);
        let mut x = right.to_vec();
        for i in 0..order {
            for j in i.saturating_sub(width)..i {
                let (factor, done) = (self.lower.get(i, j), x[j]);
                x[i] = [x[i][0] - factor * done[0], x[i][1] - factor * done[1]];
            }
        }
        for (i, row) in x.iter_mut().enumerate() {
            for value in row {
                *value /= self.lower.get(i, i);
            }
        }
        for i in (0..order).rev() {
            for j in i + 1..order.min(i + width + 1) {
                let (factor, done) = (self.lower.get(j, i), x[j]);
                x[i] = [x[i][0] - factor * done[0], x[i][1] - factor * done[1]];
            }
        }
        x
    }

    /// The trace of `A^-1 other`, for which only the band of the inverse is needed (Hutchinson and de Hoog, Numer. Math.
    /// 47, 1985): row by row from the last, `(A^-1)_ij = delta_ij / D_i - sum_k L_ki (A^-1)_kj`.
    pub fn inverse_trace(&self, other: &BandedSymmetric) -> f64 {
        let (order, width) = (self.lower.order, self.lower.width);
        let mut inverse = BandedSymmetric::zeros(order, width);
        let mut trace = 0.0;
        for i in (0..order).rev() {
            let end = order.min(i + width + 1);
            for j in (i..end).rev() {
                let mut value = if i == j { 1.0 / self.lower.get(i, i) } else { 0.0 };
                for k in i + 1..end {
                    value -= self.lower.get(k, i) * inverse.get(k, j);
                }
                inverse.add(j, i, value);
                trace += value * other.get(j, i) * if i == j { 1.0 } else { 2.0 };
            }
        }
        trace
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A band of width 2 and its dense twin.
    fn example() -> (BandedSymmetric, nalgebra::DMatrix<f64>) {
        let mut banded = BandedSymmetric::zeros(9, 2);
        for i in 0..9 {
            banded.add(i, i, 4.0 + 0.3 * i as f64);
            for d in 1..=2.min(i) {
                banded.add(i, i - d, 1.0 / (i as f64 + d as f64));
            }
        }
        let dense = nalgebra::DMatrix::from_fn(9, 9, |i, j| banded.get(i, j));
        (banded, dense)
    }

    #[test]
    fn solves_like_the_dense_matrix() {
        let (banded, dense) = example();
        let right: Vec<[f64; 2]> = (0..9).map(|i| [i as f64, 1.0 - i as f64]).collect();
        let x = banded.factorised().expect("positive definite").solve(&right);
        for k in 0..2 {
            let product = &dense * nalgebra::DVector::from_fn(9, |i, _| x[i][k]);
            assert!((0..9).all(|i| (product[i] - right[i][k]).abs() < 1e-12));
        }
    }

    #[test]
    fn trace_of_the_inverse_is_that_of_the_dense_matrix() {
        let (banded, dense) = example();
        let mut other = BandedSymmetric::zeros(9, 2);
        for i in 0..9 {
            other.add(i, i, 1.0 + i as f64);
            if i > 0 {
                other.add(i, i - 1, 0.5);
            }
        }
        let twin = nalgebra::DMatrix::from_fn(9, 9, |i, j| other.get(i, j));
        let expected = (dense.try_inverse().expect("regular") * twin).trace();
        let trace = banded.factorised().expect("positive definite").inverse_trace(&other);
        assert!((trace - expected).abs() < 1e-12);
    }

    #[test]
    fn an_indefinite_matrix_has_no_factors() {
        let mut matrix = BandedSymmetric::zeros(2, 1);
        matrix.add(0, 0, 1.0);
        matrix.add(1, 0, 2.0);
        matrix.add(1, 1, 1.0);
        assert!(matrix.factorised().is_none());
    }
}
