//! Sparse factors of the tangent.
//!
//! `K = L D L^T` without pivoting, by faer's supernodal algorithm; the structure of `L` is found once a mesh. Unpivoted
//! factors are as good as pivoted ones for definite matrices and usually for the mildly indefinite ones near an unstable
//! branch; where a pivot vanishes or the solution's residual shows that they are not, the factors are computed again with
//! Bunch and Kaufman's pivoting inside the supernodes. By Sylvester's law of inertia the negative entries of `D` count the
//! negative eigenvalues of `K`: directions in which the strip would move away from the equilibrium by itself.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::ldlt::factor::LdltRegularization;
use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::{solve_unit_lower_triangular_in_place, solve_unit_upper_triangular_in_place};
use faer::perm::PermRef;
use faer::reborrow::ReborrowMut;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::supernodal::SupernodalLdltRef;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, IntranodeLbltRef, LdltRef, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Accum, ColMut, ColRef, Conj, MatMut, Par, Side, Spec};

use super::FemError;
use super::error::{go_on, go_on_at};
use super::pattern::Pattern;
use crate::numerics::large_array::LargeArray;
use crate::progress::Cancelled;

/// Residual of a linear solution, relative to the right-hand side, above which factors count as useless.
const USELESS: f64 = 1e-3;
/// Residual at which a solution is not refined any further.
const REFINED: f64 = 1e-10;
/// Supernodes between two questions whether to go on.
const ASK_EVERY: usize = 64;
/// Steps of iterative refinement.
const REFINEMENTS: usize = 3;

/// Structure and values of the factors.
pub struct Factorisation {
    symbolic: SymbolicCholesky<usize>,
    values: LargeArray,
    memory: MemBuffer,
    pivoting: Option<Pivoting>,
    negative: usize,
    /// There are factors, and they are those of a definite tangent.
    definite: bool,
}

/// What pivoted factors have besides.
struct Pivoting {
    subdiagonal: Vec<f64>,
    forward: Vec<usize>,
    inverse: Vec<usize>,
}

impl std::fmt::Debug for Factorisation {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Factorisation").field("entries", &self.values.len()).finish_non_exhaustive()
    }
}

fn parallel() -> Par {
    Par::rayon(0)
}

impl Factorisation {
    /// Finds the structure of the factors and takes the memory for them, unless that is more than `limit` bytes.
    ///
    /// # Errors
    /// [`FemError::Memory`], [`FemError::Sparse`], [`FemError::Cancelled`].
    pub fn new(pattern: &Pattern, limit: Option<u64>, cancelled: Cancelled<'_>) -> Result<Self, FemError> {
        let unknowns = pattern.unknowns();
        let sparse = |what: &dyn std::fmt::Debug| FemError::Sparse(format!("{what:?}"));
        // With the order as it is, faer analyses an upper triangle and factors a lower one.
        let (columns, rows) = upper(pattern, cancelled)?;
        let structure = SymbolicSparseColMatRef::new_checked(unknowns, unknowns, &columns, None, &rows);
        let parameters = CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
            ..CholeskySymbolicParams::default()
        };
        let symbolic = factorize_symbolic_cholesky(structure, Side::Upper, SymmetricOrdering::Identity, parameters)
            .map_err(|e| sparse(&e))?;
        go_on(cancelled)?;
        let scratch = symbolic
            .factorize_numeric_ldlt_scratch::<f64>(parallel(), Spec::default())
            .or(symbolic.factorize_numeric_intranode_lblt_scratch::<f64>(parallel(), Spec::default()))
            .or(symbolic.solve_in_place_scratch::<f64>(1, Par::Seq));
        let needed = 8 * symbolic.len_val() as u64 + scratch.unaligned_bytes_required() as u64;
        let refused = || FemError::Memory { unknowns, needed, limit: limit.unwrap_or(needed) };
        if limit.is_some_and(|limit| needed > limit) {
            return Err(refused());
        }
        let memory = MemBuffer::try_new(scratch).map_err(|_| refused())?;
        let values = LargeArray::zeros(symbolic.len_val()).map_err(|_| refused())?;
        Ok(Self { symbolic, values, memory, pivoting: None, negative: 0, definite: false })
    }

    /// Entries of the factors.
    #[must_use]
    pub fn entries(&self) -> usize {
        self.values.len()
    }

    /// Negative eigenvalues of the tangent that was factored last.
    #[must_use]
    pub fn negative(&self) -> usize {
        self.negative
    }

    /// Factors a tangent and solves `K x = right`; `None` where it is singular.
    ///
    /// # Errors
    /// [`FemError::Cancelled`].
    pub fn solve(
        &mut self,
        pattern: &Pattern,
        tangent: &[f64],
        right: &[f64],
        cancelled: Cancelled<'_>,
    ) -> Result<Option<Vec<f64>>, FemError> {
        if self.factor(pattern, tangent)
            && let Some(x) = self.refined(pattern, tangent, right, cancelled)?
        {
            return Ok(Some(x));
        }
        go_on(cancelled)?;
        self.factor_with_pivots(pattern, tangent);
        self.refined(pattern, tangent, right, cancelled)
    }

    /// Solves `K x = right` for a tangent near the one that was factored, by conjugate gradients with the old factors as
    /// preconditioner, to a residual of `tolerance` times the right-hand side. `None` where there are no definite factors,
    /// the tangent is not definite, or `most` steps do not suffice.
    ///
    /// # Errors
    /// [`FemError::Cancelled`].
    pub fn solve_nearby(
        &mut self,
        pattern: &Pattern,
        tangent: &[f64],
        right: &[f64],
        tolerance: f64,
        most: usize,
        cancelled: Cancelled<'_>,
    ) -> Result<Option<Vec<f64>>, FemError> {
        if !self.definite {
            return Ok(None);
        }
        let wanted = tolerance * norm(right);
        let mut x = vec![0.0; right.len()];
        let mut residual = right.to_vec();
        let mut direction: Vec<f64> = Vec::new();
        let mut before = 1.0;
        for step in 0..most {
            go_on(cancelled)?;
            let mut preconditioned = residual.clone();
            self.apply(&mut preconditioned, cancelled)?;
            let now = dot(&residual, &preconditioned);
            if step == 0 {
                direction = preconditioned;
            } else {
                let kept = now / before;
                direction.iter_mut().zip(&preconditioned).for_each(|(d, p)| *d = p + kept * *d);
            }
            before = now;
            go_on(cancelled)?;
            let product = pattern.multiply(tangent, &direction);
            let curvature = dot(&direction, &product);
            // Not a number fails as well.
            if !(curvature > 0.0 && now > 0.0) {
                return Ok(None);
            }
            let length = now / curvature;
            x.iter_mut().zip(&direction).for_each(|(x, d)| *x += length * d);
            residual.iter_mut().zip(&product).for_each(|(r, p)| *r -= length * p);
            if norm(&residual) <= wanted {
                return Ok(Some(x));
            }
        }
        Ok(None)
    }

    /// Solves with the factors there are, and refines; `None` where the residual stays large.
    fn refined(
        &mut self,
        pattern: &Pattern,
        tangent: &[f64],
        right: &[f64],
        cancelled: Cancelled<'_>,
    ) -> Result<Option<Vec<f64>>, FemError> {
        let size = norm(right);
        let mut x = vec![0.0; right.len()];
        let mut residual = right.to_vec();
        let mut error = 1.0;
        for _ in 0..REFINEMENTS {
            go_on(cancelled)?;
            self.apply(&mut residual, cancelled)?;
            x.iter_mut().zip(&residual).for_each(|(x, d)| *x += d);
            let product = pattern.multiply(tangent, &x);
            residual = right.iter().zip(&product).map(|(b, p)| b - p).collect();
            error = norm(&residual) / size.max(f64::MIN_POSITIVE);
            if !error.is_finite() || error <= REFINED {
                break;
            }
        }
        Ok((error <= USELESS).then_some(x))
    }

    /// Unpivoted factors; `false` where a pivot vanished.
    fn factor(&mut self, pattern: &Pattern, tangent: &[f64]) -> bool {
        self.pivoting = None;
        self.definite = false;
        let matrix = SparseColMatRef::new(structure(pattern), tangent);
        let done = self.symbolic.factorize_numeric_ldlt(
            &mut self.values,
            matrix,
            Side::Lower,
            LdltRegularization::default(),
            parallel(),
            MemStack::new(&mut self.memory),
            Spec::default(),
        );
        if done.is_err() {
            return false;
        }
        let diagonal = self.diagonal();
        self.negative = diagonal.iter().filter(|d| **d < 0.0).count();
        let usable = diagonal.iter().all(|d| d.is_finite() && *d != 0.0);
        self.definite = usable && self.negative == 0;
        usable
    }

    fn factor_with_pivots(&mut self, pattern: &Pattern, tangent: &[f64]) {
        let n = pattern.unknowns();
        let mut pivoting = Pivoting { subdiagonal: vec![0.0; n], forward: vec![0; n], inverse: vec![0; n] };
        let matrix = SparseColMatRef::new(structure(pattern), tangent);
        self.symbolic.factorize_numeric_intranode_lblt(
            &mut self.values,
            &mut pivoting.subdiagonal,
            &mut pivoting.forward,
            &mut pivoting.inverse,
            matrix,
            Side::Lower,
            parallel(),
            MemStack::new(&mut self.memory),
            Spec::default(),
        );
        let diagonal = self.diagonal();
        // A block of two is indefinite: one eigenvalue of each sign.
        let mut negative = 0;
        let mut i = 0;
        while i < n {
            if pivoting.subdiagonal[i] == 0.0 {
                negative += usize::from(diagonal[i] < 0.0);
                i += 1;
            } else {
                negative += 1;
                i += 2;
            }
        }
        self.negative = negative;
        self.pivoting = Some(pivoting);
    }

    /// Solves with the factors there are. Large ones take a third of a second: it is asked on the way whether to go on.
    fn apply(&mut self, x: &mut [f64], cancelled: Cancelled<'_>) -> Result<(), FemError> {
        let n = x.len();
        match (&self.pivoting, self.symbolic.raw()) {
            (None, SymbolicCholeskyRaw::Supernodal(symbolic)) if self.symbolic.perm().is_none() => {
                return substitute(SupernodalLdltRef::new(symbolic, &self.values), x, cancelled);
            }
            (None, _) => {
                let (stack, right) = (MemStack::new(&mut self.memory), MatMut::from_column_major_slice_mut(x, n, 1));
                LdltRef::new(&self.symbolic, &self.values).solve_in_place_with_conj(Conj::No, right, parallel(), stack);
            }
            (Some(pivoting), _) => {
                let (stack, right) = (MemStack::new(&mut self.memory), MatMut::from_column_major_slice_mut(x, n, 1));
                let order = PermRef::new_checked(&pivoting.forward, &pivoting.inverse, n);
                IntranodeLbltRef::new(&self.symbolic, &self.values, &pivoting.subdiagonal, order)
                    .solve_in_place_with_conj(Conj::No, right, Par::Seq, stack);
            }
        }
        Ok(())
    }

    /// The diagonal of `D`.
    fn diagonal(&self) -> Vec<f64> {
        let SymbolicCholeskyRaw::Supernodal(symbolic) = self.symbolic.raw() else { return Vec::new() };
        let factors = SupernodalLdltRef::new(symbolic, &self.values);
        (0..symbolic.n_supernodes())
            .flat_map(|s| {
                let matrix = factors.supernode(s).val();
                (0..matrix.ncols()).map(move |j| matrix[(j, j)])
            })
            .collect()
    }
}

/// Forward and backward substitution with `L D L^T`, supernode after supernode.
fn substitute(
    factors: SupernodalLdltRef<'_, usize, f64>,
    x: &mut [f64],
    cancelled: Cancelled<'_>,
) -> Result<(), FemError> {
    let count = factors.symbolic().n_supernodes();
    let mut below = Vec::new();
    for s in 0..count {
        if s.is_multiple_of(ASK_EVERY) && cancelled() {
            return Err(FemError::Cancelled);
        }
        let node = factors.supernode(s);
        let (own, rest) = node.val().split_at_row(node.val().ncols());
        let top = &mut x[node.start()..][..own.ncols()];
        solve_unit_lower_triangular_in_place(own, ColMut::from_slice_mut(top).as_mat_mut(), Par::Seq);
        below.clear();
        below.resize(rest.nrows(), 0.0);
        let sums = ColMut::from_slice_mut(&mut below);
        matmul(sums.as_mat_mut(), Accum::Replace, rest, ColRef::from_slice(top).as_mat(), 1.0, Par::Seq);
        for (row, sum) in node.pattern().iter().zip(&below) {
            x[*row] -= sum;
        }
    }
    for s in (0..count).rev() {
        if s.is_multiple_of(ASK_EVERY) && cancelled() {
            return Err(FemError::Cancelled);
        }
        let node = factors.supernode(s);
        let (own, rest) = node.val().split_at_row(node.val().ncols());
        below.clear();
        below.extend(node.pattern().iter().map(|row| x[*row]));
        let top = &mut x[node.start()..][..own.ncols()];
        for (j, value) in top.iter_mut().enumerate() {
            *value /= own[(j, j)];
        }
        let known = ColRef::from_slice(&below);
        let mut top = ColMut::from_slice_mut(top);
        matmul(top.rb_mut().as_mat_mut(), Accum::Add, rest.transpose(), known.as_mat(), -1.0, Par::Seq);
        solve_unit_upper_triangular_in_place(own.transpose(), top.as_mat_mut(), Par::Seq);
    }
    Ok(())
}

fn structure(pattern: &Pattern) -> SymbolicSparseColMatRef<'_, usize> {
    let n = pattern.unknowns();
    SymbolicSparseColMatRef::new_checked(n, n, &pattern.columns, None, &pattern.rows)
}

/// The pattern's transpose: columns and ascending rows of the upper triangle.
fn upper(pattern: &Pattern, cancelled: Cancelled<'_>) -> Result<(Vec<usize>, Vec<usize>), FemError> {
    let n = pattern.unknowns();
    let rows_of = |column: usize| &pattern.rows[pattern.columns[column]..pattern.columns[column + 1]];
    let mut columns = vec![0; n + 1];
    for column in 0..n {
        go_on_at(column, cancelled)?;
        rows_of(column).iter().for_each(|row| columns[row + 1] += 1);
    }
    for i in 0..n {
        columns[i + 1] += columns[i];
    }
    let mut next = columns.clone();
    let mut rows = vec![0; pattern.rows.len()];
    for column in 0..n {
        go_on_at(column, cancelled)?;
        for row in rows_of(column) {
            rows[next[*row]] = column;
            next[*row] += 1;
        }
    }
    Ok((columns, rows))
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn norm(x: &[f64]) -> f64 {
    dot(x, x).sqrt()
}
