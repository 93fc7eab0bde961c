//! `E(X) = E_0 exp(c_1 u + c_2 u^2 + ... + c_n u^n)` with `u = 2 X / L - 1`: the best polynomial of `ln E`.
//!
//! The exponential makes the field positive, and a polynomial of `u` in `[-1, 1]` is bounded by the sum of its
//! coefficients. The fit is the minimax polynomial of `ln E` (Remez's exchange, in Chebyshev's basis): with the largest
//! deviation `d` of the logarithm equalised, scaling by `1 / cosh(d)` makes the largest *relative* error of `E` exactly
//! `tanh(d)`, the smallest any polynomial of that degree can have.

use nalgebra::{DMatrix, DVector};
use serde::Serialize;

use super::expression::{self, round_decimals, round_significant};
use super::samples::Samples;

/// Exchanges of the reference set before the fit is taken as it is; five are usual.
const MAX_EXCHANGES: usize = 30;
/// How far above its lower bound the deviation may stay: the last percent is not worth an exchange.
const LEVEL_TOLERANCE: f64 = 0.01;
/// Deviations below this are rounding.
const ROUNDING: f64 = 1e-13;

/// Modulus `E_0 exp(sum_k c_k u^k)`, `k = 1 ... n`, with `u = X / h - 1`.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct ExponentialPolynomial {
    /// `E_0`, the modulus in the middle of the strip, MPa.
    pub reference_mpa: f64,
    /// `h`, half the strip's length, mm.
    pub half_length_mm: f64,
    /// `c_1 ... c_n`, lowest power first.
    pub coefficients: Vec<f64>,
}

impl ExponentialPolynomial {
    /// The modulus in MPa at `x_mm` from the rim.
    pub(super) fn evaluate(&self, x_mm: f64) -> f64 {
        let u = x_mm / self.half_length_mm - 1.0;
        let sum = self.coefficients.iter().rev().fold(0.0, |sum, c| c + u * sum);
        self.reference_mpa * (u * sum).exp()
    }

    pub(super) fn expression(&self, variable: &str) -> String {
        expression::exponential_polynomial(variable, self.half_length_mm, self.reference_mpa, &self.coefficients)
    }

    /// The coefficients with as few decimals as keep the largest error within `allowed`; `None` if none do.
    fn rounded(exact: &[f64], samples: &Samples, allowed: f64) -> Option<(Self, f64)> {
        let half_length_mm = round_significant(0.5 * samples.length, 12);
        let (constant, rest) = exact.split_first()?;
        // The middle modulus is a factor: its relative error is the absolute error of the exponent's constant.
        (2..=15).find_map(|decimals| {
            let candidate = Self {
                reference_mpa: round_significant(constant.exp(), decimals),
                half_length_mm,
                coefficients: rest.iter().map(|&c| round_decimals(c, decimals)).collect(),
            };
            let error = samples.largest_error(|x| candidate.evaluate(x));
            (error <= allowed).then_some((candidate, error))
        })
    }
}

/// The polynomial of the lowest degree whose error, rounded coefficients included, is below `target`.
///
/// Where no degree up to `max_degree` reaches it, the most accurate one. Returns the largest relative error with it.
pub(super) fn fit(samples: &Samples, target: f64, max_degree: usize) -> Option<(ExponentialPolynomial, f64)> {
    for degree in 1..=max_degree {
        let give_up = if degree < max_degree { target.atanh() } else { f64::INFINITY };
        let Some((mut monomials, deviation)) = minimax(&samples.u, &samples.log_modulus, degree, give_up) else {
            continue;
        };
        if let Some(constant) = monomials.first_mut() {
            *constant -= deviation.cosh().ln();
        }
        let exact = deviation.tanh();
        let allowed = super::error_allowed_after_rounding(exact, target);
        match ExponentialPolynomial::rounded(&monomials, samples, allowed) {
            Some(found) if found.1 <= target || degree == max_degree => return Some(found),
            _ => {}
        }
    }
    None
}

/// Minimax polynomial of the points `(u, y)`, `u` rising over `[-1, 1]`: coefficients of `1, u, u^2, ...` and the largest
/// deviation. `None` as soon as the deviation is known to exceed `give_up`.
pub(super) fn minimax(u: &[f64], y: &[f64], degree: usize, give_up: f64) -> Option<(Vec<f64>, f64)> {
    let last = u.len() - 1;
    let size = degree + 2;
    // Extrema of Chebyshev's polynomial of degree n + 1: the solution itself where y is nearly of that degree.
    let mut reference: Vec<usize> = (0..size)
        .map(|i| {
            let position = 0.5 - 0.5 * (std::f64::consts::PI * i as f64 / (size - 1) as f64).cos();
            (position * last as f64).round() as usize
        })
        .collect();
    let mut best: Option<(DVector<f64>, f64)> = None;
    let mut residuals = vec![0.0; u.len()];
    for _ in 0..MAX_EXCHANGES {
        let Some((coefficients, level)) = levelled(u, y, &reference, degree) else { break };
        // De la Vallee-Poussin: no polynomial of this degree deviates less than the level on any reference set.
        if level > give_up {
            return None;
        }
        for ((r, &u), &y) in residuals.iter_mut().zip(u).zip(y) {
            *r = y - clenshaw(coefficients.as_slice(), u);
        }
        let deviation = residuals.iter().fold(0.0_f64, |m, r| m.max(r.abs()));
        if best.as_ref().is_none_or(|(_, d)| deviation < *d) {
            best = Some((coefficients, deviation));
        }
        if deviation <= level * (1.0 + LEVEL_TOLERANCE) || deviation < ROUNDING {
            break;
        }
        match exchanged(&residuals, size) {
            Some(next) if next != reference => reference = next,
            _ => break,
        }
    }
    let (coefficients, deviation) = best?;
    (deviation <= give_up).then(|| (monomials(coefficients.as_slice()), deviation))
}

/// The polynomial that deviates from `y` by the same amount, with alternating sign, at every point of the reference set.
fn levelled(u: &[f64], y: &[f64], reference: &[usize], degree: usize) -> Option<(DVector<f64>, f64)> {
    let size = reference.len();
    let mut matrix = DMatrix::zeros(size, size);
    for (row, &i) in reference.iter().enumerate() {
        let (mut before, mut now) = (u[i], 1.0);
        for column in 0..=degree {
            matrix[(row, column)] = now;
            (before, now) = (now, 2.0 * u[i] * now - before);
        }
        matrix[(row, degree + 1)] = if row % 2 == 0 { 1.0 } else { -1.0 };
    }
    let right = DVector::from_iterator(size, reference.iter().map(|&i| y[i]));
    let solution = matrix.lu().solve(&right)?;
    let level = solution[degree + 1].abs();
    solution.iter().all(|c| c.is_finite()).then(|| (solution.rows(0, degree + 1).into_owned(), level))
}

/// One extremum from every run of residuals of one sign, thinned to `size` points that still alternate.
fn exchanged(residuals: &[f64], size: usize) -> Option<Vec<usize>> {
    let mut extrema: Vec<usize> = Vec::with_capacity(2 * size);
    for (i, r) in residuals.iter().enumerate() {
        match extrema.last_mut() {
            Some(e) if (residuals[*e] < 0.0) == (*r < 0.0) => {
                if r.abs() > residuals[*e].abs() {
                    *e = i;
                }
            }
            _ => extrema.push(i),
        }
    }
    while extrema.len() > size {
        let height = |i: usize| residuals[extrema[i]].abs();
        let last = extrema.len() - 1;
        if extrema.len() == size + 1 {
            // An end alone may go without two equal signs becoming neighbours.
            if height(0) < height(last) {
                extrema.remove(0)
            } else {
                extrema.remove(last)
            };
        } else {
            // Inside, neighbours go in pairs: the pair whose taller member is the lowest.
            let pair =
                (0..last).min_by(|&a, &b| height(a).max(height(a + 1)).total_cmp(&height(b).max(height(b + 1))))?;
            extrema.drain(pair..pair + 2);
        }
    }
    (extrema.len() == size).then_some(extrema)
}

/// Value at `u` of the polynomial with these coefficients in Chebyshev's basis.
fn clenshaw(coefficients: &[f64], u: f64) -> f64 {
    let (mut first, mut second) = (0.0, 0.0);
    for &c in coefficients.iter().skip(1).rev() {
        (first, second) = (c + 2.0 * u * first - second, first);
    }
    coefficients.first().copied().unwrap_or(0.0) + u * first - second
}

/// Coefficients of `1, u, u^2, ...` from those in Chebyshev's basis.
fn monomials(chebyshev: &[f64]) -> Vec<f64> {
    let size = chebyshev.len();
    let mut sum = vec![0.0; size];
    let mut before = vec![0.0; size];
    let mut now = vec![0.0; size];
    now[0] = 1.0;
    for (k, c) in chebyshev.iter().enumerate() {
        for (s, t) in sum.iter_mut().zip(&now) {
            *s += c * t;
        }
        let factor = if k == 0 { 1.0 } else { 2.0 };
        let next: Vec<f64> = (0..size)
            .map(|power| if power == 0 { -before[0] } else { factor * now[power - 1] - before[power] })
            .collect();
        before = std::mem::replace(&mut now, next);
    }
    sum
}
