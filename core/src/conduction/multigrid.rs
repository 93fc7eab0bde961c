//! The preconditioner: one V-cycle of geometric multigrid.
//!
//! Galerkin's coarse operators ([`super::galerkin`]), linear interpolation, and Chebyshev polynomials of Jacobi's iteration as
//! smoothers, the same before and after, so that the cycle is symmetric and positive definite. For trilinear bricks
//! `D^-1 A` has its high frequencies in [0.5, 1.5], which a polynomial of degree two damps to about 0.15.

use super::galerkin::{CoarseElements, Elements, coarsen, steps};
use super::operator::{Operator, for_rows};
use super::stencil::Stencil;
use super::transfer::Transfer;

/// Unknowns that are solved directly.
const DIRECT: usize = 500;

/// Most levels; each has at most half the cells of the one before.
const MOST_LEVELS: usize = 32;

/// Degree of the smoothing polynomials.
const DEGREE: usize = 2;

/// Smallest eigenvalue that smoothing is meant for, as a share of the largest.
const SMOOTHED: f64 = 0.3;

/// A coarse level.
struct Level {
    stencil: Stencil,
    /// From this level to the next finer one.
    transfer: Transfer,
    largest_eigenvalue: f64,
}

/// The hierarchy below an operator.
pub struct Multigrid {
    levels: Vec<Level>,
    largest_eigenvalue: f64,
    coarsest: Dense,
    work: Vec<Work>,
}

/// Vectors of one level.
struct Work {
    residual: Vec<f64>,
    correction: Vec<f64>,
    product: Vec<f64>,
    direction: Vec<f64>,
}

impl Work {
    fn new(nodes: usize) -> Self {
        let zero = || vec![0.0; nodes];
        Self { residual: zero(), correction: zero(), product: zero(), direction: zero() }
    }
}

impl Multigrid {
    /// Builds the levels below `operator`; `None` where `go_on` says no.
    #[must_use]
    pub fn new(operator: &Operator<'_>, go_on: &(dyn Fn() -> bool + Sync)) -> Option<Self> {
        let mesh = operator.mesh();
        let largest = |n: &super::brick::Brick| n.largest_scaled_eigenvalue();
        let mut edges = mesh.mean_edges();
        let mut levels: Vec<Level> = Vec::new();
        let mut elements: Option<CoarseElements> = None;
        while levels.len() < MOST_LEVELS {
            let fine: &dyn Elements = match &elements {
                Some(coarse) => coarse,
                None => operator,
            };
            if fine.nodes().iter().product::<usize>() <= DIRECT && !levels.is_empty() {
                break;
            }
            let Some(chosen) = steps(fine.cells(), fine.collapsed(), edges) else { break };
            let coarse = coarsen(fine, chosen, go_on)?;
            let stencil = coarse.stencil(go_on)?;
            let transfer = Transfer::new(fine.nodes(), coarse.nodes(), chosen);
            for (edge, step) in edges.iter_mut().zip(chosen) {
                if step == super::galerkin::Step::Halve {
                    *edge *= 2.0;
                }
            }
            let largest_eigenvalue = power_iteration(&stencil, go_on)?;
            levels.push(Level { stencil, transfer, largest_eigenvalue });
            elements = Some(coarse);
        }
        let coarsest = levels.last().map_or_else(
            || Dense::new(0, Vec::new()),
            |level| Dense::new(level.stencil.inverse_diagonal().len(), level.stencil.dense()),
        );
        let mut work = vec![Work::new(mesh.nodes())];
        work.extend(levels.iter().map(|l| Work::new(l.stencil.inverse_diagonal().len())));
        let mut largest_eigenvalue = 1.0_f64;
        for some in mesh.bricks().all().chunks(BRICKS) {
            if !go_on() {
                return None;
            }
            largest_eigenvalue = some.iter().map(largest).fold(largest_eigenvalue, f64::max);
        }
        Some(Self { levels, largest_eigenvalue, coarsest, work })
    }

    /// Number of levels, the finest included.
    #[must_use]
    pub fn levels(&self) -> usize {
        self.levels.len() + 1
    }

    /// `out = M^-1 residual`; unless `go_on` says no, which leaves `out` unfinished.
    pub(super) fn apply(
        &mut self,
        operator: &Operator<'_>,
        residual: &[f64],
        out: &mut [f64],
        go_on: &(dyn Fn() -> bool + Sync),
    ) {
        let Some((own, below)) = self.work.split_first_mut() else { return };
        let apply = |u: &[f64], o: &mut [f64]| operator.apply(u, o, go_on);
        let smoother = Chebyshev {
            apply: &apply,
            inverse_diagonal: operator.inverse_diagonal(),
            largest: self.largest_eigenvalue,
        };
        smoother.start(residual, out, own, go_on);
        if !go_on() {
            return;
        }
        if let Some((level, rest)) = self.levels.split_first() {
            operator.apply(out, &mut own.product, go_on);
            if !go_on() {
                return;
            }
            difference(residual, &own.product, &mut own.residual);
            level.transfer.restrict(&own.residual, &mut below[0].residual);
            cycle(level, rest, &self.coarsest, below, go_on);
            if !go_on() {
                return;
            }
            level.transfer.prolong(&below[0].correction, operator.inverse_diagonal(), out);
        }
        if go_on() {
            smoother.improve(residual, out, own, go_on);
        }
    }
}

/// One V-cycle from `level` down; takes and leaves its vectors in `work`.
fn cycle(level: &Level, rest: &[Level], coarsest: &Dense, work: &mut [Work], go_on: &(dyn Fn() -> bool + Sync)) {
    let Some((own, below)) = work.split_first_mut() else { return };
    let residual = std::mem::take(&mut own.residual);
    let mut correction = std::mem::take(&mut own.correction);
    if let Some((next, further)) = rest.split_first() {
        let apply = |u: &[f64], o: &mut [f64]| level.stencil.apply(u, o);
        let smoother = Chebyshev {
            apply: &apply,
            inverse_diagonal: level.stencil.inverse_diagonal(),
            largest: level.largest_eigenvalue,
        };
        smoother.start(&residual, &mut correction, own, go_on);
        level.stencil.apply(&correction, &mut own.product);
        let mut rest_residual = std::mem::take(&mut own.direction);
        difference(&residual, &own.product, &mut rest_residual);
        next.transfer.restrict(&rest_residual, &mut below[0].residual);
        own.direction = rest_residual;
        cycle(next, further, coarsest, below, go_on);
        next.transfer.prolong(&below[0].correction, level.stencil.inverse_diagonal(), &mut correction);
        smoother.improve(&residual, &mut correction, own, go_on);
    } else {
        coarsest.solve(&residual, &mut correction);
    }
    own.residual = residual;
    own.correction = correction;
}

fn difference(a: &[f64], b: &[f64], out: &mut [f64]) {
    for_rows(out, ROW, |n, row| {
        let start = n * ROW;
        for (i, o) in row.iter_mut().enumerate() {
            *o = a[start + i] - b[start + i];
        }
    });
}

/// Bricks after which it is asked whether to go on.
const BRICKS: usize = 4096;

/// Entries that are handled together where rows do not matter.
const ROW: usize = 1024;

/// Chebyshev's semi-iteration on `D^-1 A` over `[SMOOTHED largest, largest]`.
struct Chebyshev<'a> {
    apply: &'a (dyn Fn(&[f64], &mut [f64]) + Sync),
    inverse_diagonal: &'a [f64],
    largest: f64,
}

impl Chebyshev<'_> {
    /// Smooths from zero: `u` is overwritten.
    fn start(&self, residual: &[f64], u: &mut [f64], work: &mut Work, go_on: &(dyn Fn() -> bool + Sync)) {
        u.fill(0.0);
        self.steps(residual, u, work, true, go_on);
    }

    /// Smooths on.
    fn improve(&self, residual: &[f64], u: &mut [f64], work: &mut Work, go_on: &(dyn Fn() -> bool + Sync)) {
        self.steps(residual, u, work, false, go_on);
    }

    fn steps(&self, rhs: &[f64], u: &mut [f64], work: &mut Work, from_zero: bool, go_on: &(dyn Fn() -> bool + Sync)) {
        let (middle, half) = (0.5 * self.largest * (1.0 + SMOOTHED), 0.5 * self.largest * (1.0 - SMOOTHED));
        let sigma = middle / half;
        let mut rho = 1.0 / sigma;
        let direction = &mut work.direction;
        for step in 0..DEGREE {
            // Where it stops, what is left is not used.
            if !go_on() {
                return;
            }
            if step > 0 || !from_zero {
                (self.apply)(u, &mut work.product);
            } else {
                work.product.fill(0.0);
            }
            // d_0 = r/middle; d_k = rho_k rho_{k-1} d_{k-1} + 2 rho_k / half r.
            let (keep, add) = if step == 0 {
                (0.0, 1.0 / middle)
            } else {
                let next = 1.0 / (2.0 * sigma - rho);
                let both = (next * rho, 2.0 * next / half);
                rho = next;
                both
            };
            let product = &work.product;
            for_rows(direction, ROW, |n, row| {
                let start = n * ROW;
                for (i, d) in row.iter_mut().enumerate() {
                    let at = start + i;
                    *d = if keep == 0.0 { 0.0 } else { keep * *d }
                        + add * self.inverse_diagonal[at] * (rhs[at] - product[at]);
                }
            });
            let direction = &*direction;
            for_rows(u, ROW, |n, row| {
                for (u, d) in row.iter_mut().zip(&direction[n * ROW..]) {
                    *u += d;
                }
            });
        }
    }
}

/// Largest eigenvalue of `D^-1 A`, slightly over-estimated; `None` where `go_on` says no.
fn power_iteration(stencil: &Stencil, go_on: &(dyn Fn() -> bool + Sync)) -> Option<f64> {
    let inverse = stencil.inverse_diagonal();
    // Any start with all frequencies in it; the same on every machine.
    let mut state = 0x9E37_79B9_u32;
    let mut v: Vec<f64> = inverse
        .iter()
        .map(|d| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            if *d == 0.0 { 0.0 } else { f64::from(state >> 8) / f64::from(1 << 24) - 0.5 }
        })
        .collect();
    let mut product = vec![0.0; inverse.len()];
    let mut largest = 1.0_f64;
    for _ in 0..15 {
        if !go_on() {
            return None;
        }
        stencil.apply(&v, &mut product);
        let energy: f64 = v.iter().zip(&product).map(|(v, p)| v * p).sum();
        let mass: f64 = v.iter().zip(inverse).filter(|(_, d)| **d > 0.0).map(|(v, d)| v * v / d).sum();
        if mass <= 0.0 {
            return Some(1.0);
        }
        largest = largest.max(energy / mass);
        let scale = 1.0 / mass.sqrt();
        for ((v, d), p) in v.iter_mut().zip(inverse).zip(&product) {
            *v = d * p * scale;
        }
    }
    Some(1.15 * largest)
}

/// A small matrix, factored; directions in which it vanishes are left out.
struct Dense {
    n: usize,
    factor: Vec<f64>,
    /// Reciprocals of the pivots; zero where there is none.
    pivots: Vec<f64>,
}

impl Dense {
    /// `L D L^T` of a symmetric, positive semi-definite matrix.
    fn new(n: usize, mut matrix: Vec<f64>) -> Self {
        let mut pivots = vec![0.0; n];
        let original: Vec<f64> = (0..n).map(|i| matrix[i * n + i]).collect();
        for j in 0..n {
            let pivot = matrix[j * n + j];
            if pivot <= 1e-12 * original[j] || pivot <= 0.0 {
                for i in j..n {
                    matrix[i * n + j] = 0.0;
                }
                continue;
            }
            pivots[j] = 1.0 / pivot;
            let column: Vec<f64> = (j + 1..n).map(|i| matrix[i * n + j]).collect();
            for (a, i) in (j + 1..n).enumerate() {
                let factor = column[a] / pivot;
                if factor != 0.0 {
                    for (b, k) in (j + 1..=i).enumerate() {
                        matrix[i * n + k] -= factor * column[b];
                    }
                }
                matrix[i * n + j] = factor;
            }
        }
        Self { n, factor: matrix, pivots }
    }

    fn solve(&self, rhs: &[f64], out: &mut [f64]) {
        let n = self.n;
        out.copy_from_slice(rhs);
        for i in 0..n {
            let row = &self.factor[i * n..i * n + i];
            let sum: f64 = row.iter().zip(&out[..i]).map(|(l, x)| l * x).sum();
            out[i] -= sum;
        }
        for (x, p) in out.iter_mut().zip(&self.pivots) {
            *x *= p;
        }
        for i in (0..n).rev() {
            let x = out[i];
            for (o, l) in out[..i].iter_mut().zip(&self.factor[i * n..]) {
                *o -= l * x;
            }
        }
    }
}
