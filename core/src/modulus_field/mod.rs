//! The modulus along a spoke as one closed-form expression.
//!
//! ABAQUS/CAE takes a graded modulus as an `ExpressionField`: a Python expression of the position, evaluated with the
//! `math` module at nodes or element centroids. [`ModulusField::fit`] turns the tabulated modulus `E(s)` of a design into
//! such an expression of `X`, the distance in mm from the rim along the spoke's own axis:
//!
//! - *sum of Gaussians*, `E = sum_k A_k exp(-((X - b_k) / c_k)^2)`, the form Kansara et al. (2023) use;
//! - *exponential of a polynomial*, `E = E_0 exp(c_1 u + ... + c_n u^n)` with `u = 2 X / L - 1`, positive by construction
//!   and well conditioned, where Gaussians would need more terms;
//! - a *constant*, where nothing else is needed.
//!
//! # Which one is taken
//!
//! The one with the fewest terms whose largest relative error over `[0, L]`, with the printed coefficients, is at most
//! [`TARGET_ERROR_PERCENT`]; of equally many terms the more accurate. A Gaussian counts as one term; so does each power of
//! `u`, the constant included (degree `n` has `n + 1` terms). If nothing with up to [`MAX_GAUSSIANS`] Gaussians or of degree
//! [`MAX_DEGREE`] reaches the target, the more accurate of the two is returned with its honest error.
//!
//! # What is guaranteed, and what is not
//!
//! The field is positive and finite on all of `[0, L]`. The error is measured at 2000 intervals or more, on the cubic
//! interpolant of `ln E` between stations: noise between the stations is not seen. Outside `[0, L]` the expression means
//! nothing: Gaussians whose centres lie beyond the strip grow quickly there.
//!
//! ```
//! use voxelastica_core::modulus_field::ModulusField;
//!
//! let length_mm = 100.0;
//! let s_mm: Vec<f64> = (0..=200).map(|i| 0.5 * f64::from(i)).collect();
//! let modulus_mpa: Vec<f64> = s_mm.iter().map(|s| 12.6 * (-((s - 60.0) / 80.0).powi(2)).exp()).collect();
//! let field = ModulusField::fit(&s_mm, &modulus_mpa, length_mm)?;
//! assert_eq!(field.expression, "12.6*exp(-pow((X-60.0)/80.0,2.0))");
//! assert!((field.evaluate(60.0) - 12.6).abs() < 1e-12);
//! # Ok::<(), voxelastica_core::modulus_field::ModulusFieldError>(())
//! ```

mod error;
mod exponential_polynomial;
mod expression;
mod gaussians;
mod least_squares;
mod samples;
#[cfg(test)]
mod tests;

use serde::Serialize;

pub use error::ModulusFieldError;
pub use exponential_polynomial::ExponentialPolynomial;
pub use gaussians::Gaussian;
use samples::Samples;

/// Largest relative error over the strip that a fit aims for, percent.
pub const TARGET_ERROR_PERCENT: f64 = 0.5;
/// Most Gaussians tried.
pub const MAX_GAUSSIANS: usize = 8;
/// Highest degree of the exponent's polynomial tried.
pub const MAX_DEGREE: usize = 24;

/// The expression's variable: mm from the rim along the spoke's own axis.
const VARIABLE: &str = "X";

/// The modulus `E(X)` along a spoke in closed form, valid for `0 <= X <= L`.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct ModulusField {
    /// `E(X)` on one line, ASCII, valid in Python 2.7 and 3 after `from math import *`; every number is a float literal.
    pub expression: String,
    /// `"X"`: mm from the rim along the spoke's own axis.
    pub variable: &'static str,
    /// `"MPa"`, the unit of the value.
    pub unit: &'static str,
    /// Largest relative deviation of the expression from the stations' interpolant over `[0, L]`, percent.
    pub max_error_percent: f64,
    /// Terms of the formula, as the choice between families counts them.
    pub terms: usize,
    /// The family and the coefficients, exactly as printed in the expression.
    #[serde(flatten)]
    pub family: ModulusFamily,
}

/// The formula behind the expression, with its coefficients; in JSON the keys `family` and `parameters`.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "family", content = "parameters", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum ModulusFamily {
    /// One modulus everywhere.
    Constant {
        /// `E`, MPa.
        modulus_mpa: f64,
    },
    /// `E = E_m + b |X - m|`: two straight lines that meet at a kink, as in strips graded from both ends to the middle.
    Kink {
        /// Position `m` of the kink, mm.
        middle_mm: f64,
        /// Modulus `E_m` there, MPa.
        middle_mpa: f64,
        /// Slope `b` away from it, MPa/mm.
        slope_mpa_mm: f64,
    },
    /// `E = sum_k A_k exp(-((X - b_k) / c_k)^2)`.
    Gaussians(Vec<Gaussian>),
    /// `E = E_0 exp(sum_k c_k u^k)`, `u = X / h - 1`.
    ExponentialPolynomial(ExponentialPolynomial),
}

impl ModulusFamily {
    fn terms(&self) -> usize {
        match self {
            Self::Constant { .. } => 1,
            Self::Kink { .. } => 2,
            Self::Gaussians(terms) => terms.len(),
            Self::ExponentialPolynomial(polynomial) => polynomial.coefficients.len() + 1,
        }
    }

    fn expression(&self) -> String {
        match self {
            Self::Constant { modulus_mpa } => expression::literal(*modulus_mpa),
            // The root of a square: absolute values under a name are not to be had in every expression engine.
            Self::Kink { middle_mm, middle_mpa, slope_mpa_mm } => {
                let [m, e, b] = [*middle_mm, *middle_mpa, slope_mpa_mm.abs()].map(expression::literal);
                let sign = if *slope_mpa_mm < 0.0 { '-' } else { '+' };
                format!("{e}{sign}{b}*pow(pow({VARIABLE}-{m},2.0),0.5)")
            }
            Self::Gaussians(terms) => gaussians::expression(terms, VARIABLE),
            Self::ExponentialPolynomial(polynomial) => polynomial.expression(VARIABLE),
        }
    }

    fn evaluate(&self, x_mm: f64) -> f64 {
        match self {
            Self::Constant { modulus_mpa } => *modulus_mpa,
            Self::Kink { middle_mm, middle_mpa, slope_mpa_mm } => middle_mpa + slope_mpa_mm * (x_mm - middle_mm).abs(),
            Self::Gaussians(terms) => gaussians::evaluate(terms, x_mm),
            Self::ExponentialPolynomial(polynomial) => polynomial.evaluate(x_mm),
        }
    }
}

impl ModulusField {
    /// Fits an expression to the modulus `modulus_mpa` at stations `s_mm` of a strip of length `length_mm`.
    ///
    /// The stations start at the rim (`s = 0`), end at the hub (`s = L`) and are evenly spaced, at least 20 of them. The same
    /// data gives the same expression on the same build. Takes 1 to 20 ms for 1001 stations of a smooth modulus, up to
    /// a few times that for one that no expression here can follow: call it when the expression is asked for.
    ///
    /// # Errors
    ///
    /// [`ModulusFieldError`] if the length or a modulus is not a positive number within its range, or the stations are too
    /// few or not on the even grid. Valid data never fails for lack of accuracy: see [`ModulusField::meets_target`].
    pub fn fit(s_mm: &[f64], modulus_mpa: &[f64], length_mm: f64) -> Result<Self, ModulusFieldError> {
        let samples = Samples::new(s_mm, modulus_mpa, length_mm)?;
        let (family, error) = best_family(&samples, 0.01 * TARGET_ERROR_PERCENT);
        Ok(Self {
            expression: family.expression(),
            variable: VARIABLE,
            unit: "MPa",
            max_error_percent: 100.0 * error,
            terms: family.terms(),
            family,
        })
    }

    /// The modulus in MPa at `x_mm` from the rim, `0 <= x_mm <= L`, with the coefficients the expression prints.
    pub fn evaluate(&self, x_mm: f64) -> f64 {
        self.family.evaluate(x_mm)
    }

    /// Whether the largest relative error is at most [`TARGET_ERROR_PERCENT`]; a caller warns where it is not.
    pub fn meets_target(&self) -> bool {
        self.max_error_percent <= TARGET_ERROR_PERCENT
    }
}

/// The family by the module's rule, with its largest relative error.
fn best_family(samples: &Samples, target: f64) -> (ModulusFamily, f64) {
    let (modulus_mpa, error) = constant(samples, target);
    let mut best = (ModulusFamily::Constant { modulus_mpa }, error);
    if error <= target {
        return best;
    }
    if let Some((kink, error)) = kink(samples, target) {
        return (kink, error);
    }
    // The polynomial is quick, and tells how many Gaussians are worth trying.
    if let Some((polynomial, error)) = exponential_polynomial::fit(samples, target, MAX_DEGREE) {
        best = (ModulusFamily::ExponentialPolynomial(polynomial), error);
    }
    let most = if best.1 <= target { best.0.terms().min(MAX_GAUSSIANS) } else { MAX_GAUSSIANS };
    if let Some((terms, error)) = gaussians::fit(samples, target, most) {
        let fewer_or_closer = terms.len() < best.0.terms() || error < best.1;
        if (error <= target && fewer_or_closer) || error.max(target) < best.1 {
            best = (ModulusFamily::Gaussians(terms), error);
        }
    }
    best
}

/// The constant with the least largest relative error, in as few digits as the error allows.
fn constant(samples: &Samples, target: f64) -> (f64, f64) {
    let lowest = samples.modulus.iter().copied().fold(f64::INFINITY, f64::min);
    let highest = samples.modulus.iter().copied().fold(0.0, f64::max);
    // E / lowest - 1 = 1 - E / highest; the lowest value itself where all are equal, to the last bit.
    let exact = if lowest == highest { lowest } else { 2.0 / (1.0 / lowest + 1.0 / highest) };
    let error = |e: f64| samples.largest_error(|_| e);
    let allowed = if lowest == highest { 0.0 } else { error_allowed_after_rounding(error(exact), target) };
    (3..=17)
        .map(|digits| expression::round_significant(exact, digits))
        .map(|e| (e, error(e)))
        .find(|(_, error)| *error <= allowed)
        .unwrap_or((exact, error(exact)))
}

/// Two straight lines that meet in the middle, where they meet the target.
fn kink(samples: &Samples, target: f64) -> Option<(ModulusFamily, f64)> {
    let last = samples.modulus.len() - 1;
    let (first, middle) = (samples.modulus.first()?, samples.modulus.get(last / 2)?);
    let half = 0.5 * samples.length;
    let rounded = |value: f64| expression::round_significant(value, 10);
    let (middle_mm, middle_mpa, slope) = (rounded(half), rounded(*middle), rounded((first - middle) / half));
    let error = samples.largest_error(|x| middle_mpa + slope * (x - middle_mm).abs());
    let family = ModulusFamily::Kink { middle_mm, middle_mpa, slope_mpa_mm: slope };
    (last.is_multiple_of(2) && error <= target).then_some((family, error))
}

/// How far rounding may push a largest relative error: a tenth of it, but not past a target that it meets.
fn error_allowed_after_rounding(exact: f64, target: f64) -> f64 {
    let relaxed = 1.1 * exact + 1e-8;
    if exact <= target { relaxed.min(target) } else { relaxed }
}
