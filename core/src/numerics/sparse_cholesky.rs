//! Many symmetric positive definite systems of one sparsity pattern: analysed once, factorised often.
//!
//! A thin layer over faer's sparse Cholesky factorisation `P A P^T = L L^T`. Work inside one factorisation stays on the
//! calling thread: callers run many of them side by side, and the result then never depends on the number of threads.

use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMat};
use faer::{Conj, MatMut, Par, Side, Spec};

/// The pattern of the lower triangle of a symmetric matrix, analysed.
#[derive(Debug)]
pub(crate) struct Pattern {
    lower: SymbolicSparseColMat<u32>,
    symbolic: SymbolicCholesky<u32>,
}

/// A factorised matrix and the room to solve with it.
pub(crate) struct Factor<'a> {
    pattern: &'a Pattern,
    values: Vec<f64>,
    memory: MemBuffer,
}

impl Pattern {
    /// Analyses a matrix of `columns.len() - 1` columns. Column `j` has entries in `rows[columns[j]..columns[j + 1]]`, sorted,
    /// none above the diagonal. `None` where there is not enough memory for the factor.
    pub(crate) fn new(columns: Vec<u32>, rows: Vec<u32>) -> Option<Self> {
        let order = columns.len() - 1;
        let lower = SymbolicSparseColMat::new_checked(order, order, columns, None, rows);
        let ordering = SymmetricOrdering::Amd;
        let params = CholeskySymbolicParams::default();
        let symbolic = factorize_symbolic_cholesky(lower.as_ref(), Side::Lower, ordering, params).ok()?;
        Some(Self { lower, symbolic })
    }

    /// Entries that the lower triangle has.
    pub(crate) fn entries(&self) -> usize {
        self.lower.row_idx().len()
    }

    /// Where entry `(row, column)` with `row >= column` is stored; `None` outside the pattern.
    pub(crate) fn slot(&self, row: usize, column: usize) -> Option<usize> {
        let range = self.lower.col_range(column);
        let found = self.lower.row_idx()[range.clone()].binary_search(&(row as u32)).ok()?;
        Some(range.start + found)
    }

    /// Factorises the matrix with these entries of its lower triangle; `None` where it is not positive definite.
    pub(crate) fn factorise(&self, entries: &[f64]) -> Option<Factor<'_>> {
        let request = StackReq::any_of(&[
            self.symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Spec::default()),
            self.symbolic.solve_in_place_scratch::<f64>(3, Par::Seq),
        ]);
        let mut memory = MemBuffer::try_new(request).ok()?;
        let mut values = vec![0.0; self.symbolic.len_val()];
        let matrix = SparseColMatRef::new(self.lower.as_ref(), entries);
        self.symbolic
            .factorize_numeric_llt(
                &mut values,
                matrix,
                Side::Lower,
                LltRegularization::default(),
                Par::Seq,
                MemStack::new(&mut memory),
                Spec::default(),
            )
            .ok()?;
        Some(Factor { pattern: self, values, memory })
    }
}

impl Factor<'_> {
    /// Solves for up to three right-hand sides, stored one after the other; they are replaced by the solutions.
    pub(crate) fn solve(&mut self, sides: &mut [f64]) {
        let order = self.pattern.lower.nrows();
        let count = sides.len() / order.max(1);
        let sides = MatMut::from_column_major_slice_mut(sides, order, count);
        LltRef::new(&self.pattern.symbolic, &self.values).solve_in_place_with_conj(
            Conj::No,
            sides,
            Par::Seq,
            MemStack::new(&mut self.memory),
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tridiagonal_system_has_its_closed_solution() {
        // -u'' = 1 on (0, 1), u = 0 at the ends: nodal values are exact, x (1 - x) / 2.
        let n = 49_u32;
        let h = 1.0 / f64::from(n + 1);
        let (mut columns, mut rows, mut entries) = (vec![0], Vec::new(), Vec::new());
        for j in 0..n {
            rows.push(j);
            entries.push(2.0 / h);
            if j + 1 < n {
                rows.push(j + 1);
                entries.push(-1.0 / h);
            }
            columns.push(rows.len() as u32);
        }
        let pattern = Pattern::new(columns, rows).unwrap();
        assert_eq!((pattern.entries(), pattern.slot(3, 2), pattern.slot(4, 2)), (97, Some(5), None));
        let mut sides = vec![h; 2 * n as usize];
        pattern.factorise(&entries).unwrap().solve(&mut sides);
        for j in 0..n {
            let x = f64::from(j + 1) * h;
            assert!((sides[j as usize] - 0.5 * x * (1.0 - x)).abs() < 1e-13);
            assert!((sides[(j + n) as usize] - 0.5 * x * (1.0 - x)).abs() < 1e-13);
        }
        entries[0] = -1.0;
        assert!(pattern.factorise(&entries).is_none());
    }
}
