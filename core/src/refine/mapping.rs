//! How the stiffness has to change for the shape to change as wanted.

use nalgebra::{DMatrix, DVector};

use crate::design::Design;
use crate::elastica::morph::MorphPath;
use crate::results::MidlinePoint;

/// Knots of the factor's logarithm, evenly spaced, linear in between.
pub(super) const KNOTS: usize = 21;
/// Step of the differences.
const STEP: f64 = 0.02;
/// Singular values of what was learnt, relative to the largest, below which they count as none.
const SMALLEST: f64 = 0.1;
/// Share of the change itself in a penalty on its bends.
const SLIGHT: f64 = 1e-3;
/// Largest change of the factor's logarithm in one step.
const LARGEST: f64 = 0.7;

/// What was learnt of how the finite elements answer: of every solved strip the mid-line by the finite elements (fine) and
/// by the elastica of the same voxels (coarse), less those of the best of them.
///
/// ```text
/// fine(v) = fine(best) + S (coarse(v) - coarse(best))        S = 1 + (dF - dC) pinv(dC)
/// ```
///
/// `dF` and `dC` have a column for every other solved strip (manifold mapping; Echeverria and Hemker 2005).
pub(super) struct Mapping {
    /// `dF - dC`.
    excess: DMatrix<f64>,
    /// `pinv(dC)`.
    inverse: DMatrix<f64>,
}

impl Mapping {
    /// From the mid-lines `[fine, coarse]` of the best strip and of all.
    pub(super) fn new(best: &[DVector<f64>; 2], all: &[[DVector<f64>; 2]]) -> Self {
        let others: Vec<_> = all.iter().filter(|[fine, _]| *fine != best[0]).collect();
        let columns = |k: usize| {
            let moved: Vec<DVector<f64>> = others.iter().map(|lines| &lines[k] - &best[k]).collect();
            if moved.is_empty() { DMatrix::zeros(best[k].len(), 0) } else { DMatrix::from_columns(&moved) }
        };
        let (fine, coarse) = (columns(0), columns(1));
        let none = || DMatrix::zeros(coarse.ncols(), coarse.nrows());
        let inverse = if coarse.is_empty() {
            none()
        } else {
            let svd = coarse.clone().svd(true, true);
            let least = SMALLEST * svd.singular_values.max();
            svd.pseudo_inverse(least.max(f64::MIN_POSITIVE)).unwrap_or_else(|_| none())
        };
        Self { excess: fine - coarse, inverse }
    }

    /// `S` times a change of the coarse mid-line.
    pub(super) fn fine(&self, coarse: &DVector<f64>) -> DVector<f64> {
        coarse + &self.excess * (&self.inverse * coarse)
    }
}

/// A mid-line's `x` and `z`, mm, at the stations `s` of another.
pub(super) fn line(stations: &[MidlinePoint], position: impl Fn(f64) -> [f64; 2]) -> DVector<f64> {
    DVector::from_iterator(2 * stations.len(), stations.iter().flat_map(|p| position(p[0])))
}

/// How the mid-line answers a change of the stiffness, and what it is to answer.
pub(super) struct Sensitivity {
    /// `J^T J`, and its largest eigenvalue.
    normal: DMatrix<f64>,
    largest: f64,
    /// `J^T r`.
    right: DVector<f64>,
}

impl Sensitivity {
    /// Of a design whose strip took a mid-line that misses its target; `None` where the elastica does not answer.
    pub(super) fn new(
        design: &Design,
        midline: &[MidlinePoint],
        misfit: &DVector<f64>,
        mapping: &Mapping,
    ) -> Option<Self> {
        let mut columns = Vec::with_capacity(KNOTS);
        for knot in 0..KNOTS {
            let moved = |step: f64| {
                let stiffness = design.graded_stiffness_times(|share| (step * hat(knot, share)).exp());
                let path = MorphPath::new(stiffness, design.guide()?.clone(), design.forces()).ok()?;
                Some(line(midline, |s| path.final_shape().position(s)))
            };
            columns.push(mapping.fine(&((moved(STEP)? - moved(-STEP)?) / (2.0 * STEP))));
        }
        let sensitivity = DMatrix::from_columns(&columns);
        let normal = sensitivity.transpose() * &sensitivity;
        let largest = normal.symmetric_eigenvalues().max();
        Some(Self { right: sensitivity.transpose() * misfit, normal, largest })
    }

    /// Change of the logarithm of the stiffness at evenly spaced knots that moves the mid-line back to the target. `weight`
    /// keeps what hardly changes the shape from growing, relative to what changes it most.
    pub(super) fn change(&self, penalty: Penalty, weight: f64) -> Option<Vec<f64>> {
        let kept = match penalty {
            Penalty::Size => DMatrix::identity(KNOTS, KNOTS),
            Penalty::Bends => {
                let bends = DMatrix::from_fn(KNOTS - 2, KNOTS, |i, j| match j.wrapping_sub(i) {
                    0 | 2 => 1.0,
                    1 => -2.0,
                    _ => 0.0,
                });
                bends.transpose() * bends + DMatrix::identity(KNOTS, KNOTS) * SLIGHT
            }
        };
        let kept = kept * (weight * weight * self.largest);
        let solved = (&self.normal + kept).cholesky()?.solve(&self.right);
        Some(solved.iter().map(|v| (-v).clamp(-LARGEST, LARGEST)).collect())
    }
}

/// What of a change is to be small.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Penalty {
    /// The change itself.
    Size,
    /// Its second differences: whole voxels follow a smooth change best.
    Bends,
}

/// The value at a share of the length of what is given at the knots.
pub(super) fn at(values: &[f64], share: f64) -> f64 {
    values.iter().enumerate().map(|(knot, v)| v * hat(knot, share)).sum()
}

/// One at a knot, zero at all others, linear in between.
fn hat(knot: usize, share: f64) -> f64 {
    (1.0 - (share * (KNOTS - 1) as f64 - knot as f64).abs()).max(0.0)
}
