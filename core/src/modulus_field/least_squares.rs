//! Levenberg and Marquardt's method on the relative residuals of a sum of Gaussians.
//!
//! Works in `u = 2 X / L - 1` and moduli relative to the largest; three parameters a term: amplitude, centre, logarithm of
//! the width, which keeps widths positive.

use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt};
use nalgebra::{DMatrix, DVector, Dyn, Owned};

use super::samples::Samples;

/// Points a term, spaced as Chebyshev's nodes: dense at the ends, where fits are worst.
const POINTS_PER_TERM: usize = 8;
/// Points at the least.
const MINIMUM_POINTS: usize = 32;
/// Narrowest and widest Gaussian, in units of half the strip: ten intervals of the grid on which the error is measured, and
/// what cannot be told from a constant.
const WIDTHS: [f64; 2] = [0.01, 1000.0];
/// Farthest centre from the middle of the strip, in the same units.
const FARTHEST: f64 = 1000.0;
/// Evaluations of the residuals a parameter in the first walk from a start: the valleys of this problem are long and flat,
/// and several short walks find a better place in the same time than one to the very bottom.
const SCREENING_PATIENCE: usize = 3;
/// The same in each reweighted fit of a promising start.
const POLISHING_PATIENCE: usize = 8;
/// Relative change of the sum of squares, or of the parameters, that ends a fit.
const TOLERANCE: f64 = 1e-4;
/// Reweighted repetitions of one fit.
const REWEIGHTINGS: i32 = 10;
/// What reweighting can gain, as a multiple of the target above it: a start is left once its largest error is beyond that.
const REWEIGHTING_GAIN: f64 = 3.0;
/// What is left of that gain after each repetition; most is gained early.
const GAIN_LEFT: f64 = 0.6;
/// Share of the target at which a fit is good enough: the rest is for the points in between and for rounding.
const GOOD_ENOUGH: f64 = 0.85;

/// The data of one least-squares problem: positions `u` in `[-1, 1]` and moduli relative to the largest.
pub(super) struct Points {
    pub u: Vec<f64>,
    pub modulus: Vec<f64>,
}

impl Points {
    pub fn new(samples: &Samples, terms: usize) -> Self {
        let count = (POINTS_PER_TERM * terms).max(MINIMUM_POINTS);
        let last = samples.u.len() - 1;
        let scale = largest(&samples.modulus);
        let index = |i: usize| {
            let angle = std::f64::consts::PI * i as f64 / (count - 1) as f64;
            ((0.5 - 0.5 * angle.cos()) * last as f64).round() as usize
        };
        Self {
            u: (0..count).map(|i| samples.u[index(i)]).collect(),
            modulus: (0..count).map(|i| samples.modulus[index(i)] / scale).collect(),
        }
    }

    /// Whether an error at the points leaves room for the points in between and for rounding.
    pub fn good_enough(error: f64, target: f64) -> bool {
        error <= GOOD_ENOUGH * target
    }

    /// Relative errors of the sum of Gaussians at the points.
    pub fn errors(&self, parameters: &[f64]) -> Vec<f64> {
        self.u.iter().zip(&self.modulus).map(|(&u, e)| (sum(parameters, u) / e - 1.0).abs()).collect()
    }

    /// The relative modulus near `u`.
    pub fn at(&self, u: f64) -> f64 {
        let i = self.u.partition_point(|&p| p < u).min(self.u.len() - 1);
        self.modulus[i]
    }
}

pub(super) fn largest(values: &[f64]) -> f64 {
    values.iter().copied().fold(0.0, f64::max)
}

/// A short least-squares walk from `start`, all points alike: the parameters and their largest relative error.
pub(super) fn screened(points: &Points, start: Vec<f64>) -> Option<(Vec<f64>, f64)> {
    let parameters = least_squares(points, &vec![1.0; points.u.len()], start, SCREENING_PATIENCE)?;
    let error = largest(&points.errors(&parameters));
    Some((parameters, error))
}

/// Least squares reweighted by the errors (Lawson's iteration) while the largest one falls: the best parameters, their error.
pub(super) fn equalised(points: &Points, start: Vec<f64>, target: f64) -> Option<(Vec<f64>, f64)> {
    let mut weights = vec![1.0; points.u.len()];
    let mut parameters = start;
    let mut best: Option<(Vec<f64>, f64)> = None;
    for round in 0..REWEIGHTINGS {
        let errors = points.errors(&parameters);
        let error = largest(&errors);
        let previous = best.as_ref().map_or(f64::INFINITY, |(_, e)| *e);
        if error < previous {
            best = Some((parameters.clone(), error));
        }
        let reachable = target * (1.0 + REWEIGHTING_GAIN * GAIN_LEFT.powi(round));
        if Points::good_enough(error, target) || error > reachable || error > 1.2 * previous {
            break;
        }
        let mean = errors.iter().sum::<f64>() / errors.len() as f64;
        for (w, e) in weights.iter_mut().zip(&errors) {
            *w *= (0.3 + e / mean.max(f64::MIN_POSITIVE)).sqrt();
        }
        let scale = largest(&weights);
        weights.iter_mut().for_each(|w| *w /= scale);
        parameters = least_squares(points, &weights, parameters, POLISHING_PATIENCE)?;
    }
    best
}

/// The sum of Gaussians with the least weighted squares that a short walk from `start` reaches, unless a term leaves its range.
fn least_squares(points: &Points, weights: &[f64], start: Vec<f64>, patience: usize) -> Option<Vec<f64>> {
    let bells = vec![0.0; points.u.len() * start.len() / 3];
    let mut problem = Problem { points, weights, parameters: DVector::zeros(start.len()), bells };
    problem.set_params(&DVector::from_vec(start));
    let solver = LevenbergMarquardt::new().with_patience(patience).with_tol(TOLERANCE);
    let (solved, _) = solver.minimize(problem);
    let parameters: Vec<f64> = solved.parameters.iter().copied().collect();
    let usable = parameters
        .chunks_exact(3)
        .all(|p| p[0].is_finite() && p[1].abs() <= FARTHEST && p[2] >= WIDTHS[0].ln() && p[2] <= WIDTHS[1].ln());
    usable.then_some(parameters)
}

/// Relative modulus at `u`.
pub(super) fn sum(parameters: &[f64], u: f64) -> f64 {
    parameters.chunks_exact(3).map(|p| p[0] * (-((u - p[1]) / p[2].exp()).powi(2)).exp()).sum()
}

/// Weighted relative residuals `w_i (E_fit(u_i) / E_i - 1)` and their derivatives.
struct Problem<'a> {
    points: &'a Points,
    weights: &'a [f64],
    parameters: DVector<f64>,
    /// `w_i / E_i exp(-t^2)`, term after term: residuals and derivatives share them.
    bells: Vec<f64>,
}

impl LeastSquaresProblem<f64, Dyn, Dyn> for Problem<'_> {
    type ParameterStorage = Owned<f64, Dyn>;
    type ResidualStorage = Owned<f64, Dyn>;
    type JacobianStorage = Owned<f64, Dyn, Dyn>;

    fn set_params(&mut self, parameters: &DVector<f64>) {
        self.parameters.copy_from(parameters);
        let Points { u, modulus } = self.points;
        for (bells, p) in self.bells.chunks_exact_mut(u.len()).zip(parameters.as_slice().chunks_exact(3)) {
            let width = p[2].exp();
            for (i, bell) in bells.iter_mut().enumerate() {
                let t = (u[i] - p[1]) / width;
                *bell = self.weights[i] / modulus[i] * (-t * t).exp();
            }
        }
    }

    fn params(&self) -> DVector<f64> {
        self.parameters.clone()
    }

    fn residuals(&self) -> Option<DVector<f64>> {
        let mut residuals = DVector::from_column_slice(self.weights);
        residuals.neg_mut();
        for (bells, p) in self.bells.chunks_exact(self.weights.len()).zip(self.parameters.as_slice().chunks_exact(3)) {
            residuals.iter_mut().zip(bells).for_each(|(r, bell)| *r += p[0] * bell);
        }
        residuals.iter().all(|r| r.is_finite()).then_some(residuals)
    }

    fn jacobian(&self) -> Option<DMatrix<f64>> {
        let u = &self.points.u;
        let mut jacobian = DMatrix::zeros(u.len(), self.parameters.len());
        for (k, bells) in self.bells.chunks_exact(u.len()).enumerate() {
            let [amplitude, centre, width] = [0, 1, 2].map(|j| self.parameters[3 * k + j]);
            let width = width.exp();
            for (i, bell) in bells.iter().enumerate() {
                let t = (u[i] - centre) / width;
                jacobian[(i, 3 * k)] = *bell;
                jacobian[(i, 3 * k + 1)] = amplitude * bell * 2.0 * t / width;
                jacobian[(i, 3 * k + 2)] = amplitude * bell * 2.0 * t * t;
            }
        }
        jacobian.iter().all(|d| d.is_finite()).then_some(jacobian)
    }
}
