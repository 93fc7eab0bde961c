//! How the stiffness has to change for the shape to change as wanted.

use nalgebra::{DMatrix, DVector};

use crate::design::Design;
use crate::elastica::morph::MorphPath;
use crate::results::MidlinePoint;

/// Knots of the factor's logarithm, evenly spaced, linear in between.
const KNOTS: usize = 21;
/// Step of the differences.
const STEP: f64 = 0.02;
/// Weight that keeps what hardly changes the shape from growing, relative to what changes it most.
const RIDGE: f64 = 0.05;
/// Largest change of the factor's logarithm in one step.
const LARGEST: f64 = 0.7;

/// Change of the logarithm of the stiffness at evenly spaced knots that moves the mid-line back to the target by the
/// elastica's account; `None` where the elastica does not answer.
pub(super) fn change(design: &Design, midline: &[MidlinePoint]) -> Option<Vec<f64>> {
    let profile = design.profile();
    let misfit: Vec<f64> = midline
        .iter()
        .flat_map(|[s, x, z]| {
            let [tx, tz] = profile.position(*s);
            [x - tx, z - tz]
        })
        .collect();
    let mut columns = Vec::with_capacity(KNOTS);
    for knot in 0..KNOTS {
        let moved = |step: f64| {
            let stiffness = design.graded_stiffness_times(|share| (step * hat(knot, share)).exp());
            let path = MorphPath::new(stiffness, design.guide()?.clone(), design.forces()).ok()?;
            Some(midline.iter().flat_map(|p| path.final_shape().position(p[0])).collect::<Vec<f64>>())
        };
        let (ahead, behind) = (moved(STEP)?, moved(-STEP)?);
        columns
            .push(DVector::from_iterator(misfit.len(), ahead.iter().zip(&behind).map(|(a, b)| (a - b) / (2.0 * STEP))));
    }
    let sensitivity = DMatrix::from_columns(&columns);
    let normal = sensitivity.transpose() * &sensitivity;
    let largest = normal.symmetric_eigenvalues().max();
    let ridge = DMatrix::identity(KNOTS, KNOTS) * (RIDGE * RIDGE * largest);
    let right = sensitivity.transpose() * DVector::from_vec(misfit);
    let solved = (normal + ridge).cholesky()?.solve(&right);
    Some(solved.iter().map(|v| (-v).clamp(-LARGEST, LARGEST)).collect())
}

/// The value at a share of the length of what is given at the knots.
pub(super) fn at(values: &[f64], share: f64) -> f64 {
    values.iter().enumerate().map(|(knot, v)| v * hat(knot, share)).sum()
}

/// One at a knot, zero at all others, linear in between.
fn hat(knot: usize, share: f64) -> f64 {
    (1.0 - (share * (KNOTS - 1) as f64 - knot as f64).abs()).max(0.0)
}
