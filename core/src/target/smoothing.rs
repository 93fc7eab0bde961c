//! Penalised B-splines: a smooth curve through measured points.
//!
//! The curve `r(t) = (rho(t), z(t)) = sum_j c_j B_j(t)`, with B-splines `B_j` of degree 5 on even knots, minimises
//!
//! `sum_i w_i |r(t_i) - p_i|^2 + lambda sum_j |Delta^3 c_j|^2`
//!
//! (P. H. C. Eilers, B. D. Marx, "Flexible smoothing with B-splines and penalties", Stat. Sci. 11, 1996, eq. 5). Third
//! differences of the coefficients stand for the third derivative: a meridian's curvature gradient is built from it, and
//! parabolas pass unpenalised. The knots run on evenly past both ends, so no condition is forced on the end tangents.
//!
//! The weight `lambda` minimises the generalised cross-validation score (P. Craven, G. Wahba, Numer. Math. 31, 1979),
//! in the form of Y.-J. Kim, C. Gu, J. R. Stat. Soc. B 66, 2004, which counts degrees of freedom 1.4 times against
//! undersmoothing: `V = m RSS / (m - 1.4 tr A)^2`.
//!
//! A meridian that reaches the axis continues on its other side: `rho` is odd and `z` even about the apex. Mirrored
//! points impose just that.

use super::banded::BandedSymmetric;
use super::error::TargetError;

/// Polynomial degree.
pub(super) const DEGREE: usize = 5;
/// Order of the penalised difference.
const DIFFERENCE: usize = 3;
/// Most knot intervals on one side of the axis; enough for features of a fortieth of the length.
const MAX_INTERVALS: usize = 80;
/// Scatter below this share of the extent is rounding of the numbers given, not worth following.
const ROUNDING: f64 = 1e-9;
/// More points than this are averaged into as many groups of neighbours first.
const MAX_SAMPLES: usize = 6000;

/// A point to follow: its parameter, position `[rho, z]` and weight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Sample {
    pub t: f64,
    pub position: [f64; 2],
    pub weight: f64,
}

/// A curve of degree 5 on even knot intervals, as one polynomial in `u = (t - start) / step - i` an interval `i`.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct PiecewiseCurve {
    start: f64,
    step: f64,
    /// Coefficients of `u^0 ... u^5` for `rho` and `z`.
    pieces: Vec<[[f64; DEGREE + 1]; 2]>,
}

/// Position and derivatives by the parameter: `derivatives[n] = d^n (rho, z) / dt^n`, `n` from 0 to 3.
pub(super) type Derivatives = [[f64; 2]; 4];

impl PiecewiseCurve {
    /// Width of one knot interval.
    pub fn step(&self) -> f64 {
        self.step
    }

    /// `t` no further than a knot interval outside the curve, where its polynomials still mean something.
    pub fn clamped(&self, t: f64) -> f64 {
        let finish = self.start + self.step * self.pieces.len() as f64;
        t.clamp(self.start - self.step, finish + self.step)
    }

    /// The same curve, larger by `factor`, with the same parameter.
    pub fn scaled(&self, factor: f64) -> Self {
        let pieces = self.pieces.iter().map(|piece| piece.map(|c| c.map(|a| a * factor))).collect();
        Self { pieces, ..*self }
    }

    /// The piece at `t` and the place in it; beyond the ends the outermost polynomial goes on.
    fn piece(&self, t: f64) -> Option<(&[[f64; DEGREE + 1]; 2], f64)> {
        let place = (t - self.start) / self.step;
        let index = (place.max(0.0) as usize).min(self.pieces.len().saturating_sub(1));
        self.pieces.get(index).map(|piece| (piece, place - index as f64))
    }

    /// Position and derivatives at `t`.
    pub fn at(&self, t: f64) -> Derivatives {
        let Some((piece, u)) = self.piece(t) else { return [[0.0; 2]; 4] };
        let per = 1.0 / self.step;
        let mut out = [[0.0; 2]; 4];
        for k in 0..2 {
            // Horner's rule for the Taylor coefficients.
            let (mut a, mut b, mut c, mut d) = (0.0, 0.0, 0.0, 0.0);
            for coefficient in piece[k].iter().rev() {
                d = d * u + c;
                c = c * u + b;
                b = b * u + a;
                a = a * u + coefficient;
            }
            out[0][k] = a;
            out[1][k] = b * per;
            out[2][k] = 2.0 * c * per * per;
            out[3][k] = 6.0 * d * per * per * per;
        }
        out
    }

    /// Position and first derivative at `t`.
    pub fn position_and_velocity(&self, t: f64) -> [[f64; 2]; 2] {
        let Some((piece, u)) = self.piece(t) else { return [[0.0; 2]; 2] };
        let mut out = [[0.0; 2]; 2];
        for k in 0..2 {
            let (mut a, mut b) = (0.0, 0.0);
            for coefficient in piece[k].iter().rev() {
                b = b * u + a;
                a = a * u + coefficient;
            }
            out[0][k] = a;
            out[1][k] = b / self.step;
        }
        out
    }
}

/// A fitted curve and how it fits.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Fit {
    pub curve: PiecewiseCurve,
    /// Degrees of freedom used for each coordinate.
    #[cfg_attr(not(test), allow(dead_code))]
    pub freedom: f64,
}

/// Fits samples with parameters from about 0 to `end`; with `mirror`, `end` is the apex, where the curve meets the axis.
///
/// Noise may put samples a little outside that range; the curve reaches as far as they do.
pub(super) fn fit(samples: &[Sample], end: f64, mirror: bool) -> Result<Fit, TargetError> {
    let no_fit = |reason| TargetError::NoFit { points: samples.len(), reason };
    let start = samples.iter().map(|s| s.t).fold(0.0, f64::min);
    let finish = samples.iter().map(|s| s.t).fold(end, f64::max);
    if !(end > 0.0 && start.is_finite() && finish.is_finite()) {
        return Err(no_fit("the curve has no length"));
    }
    let mut groups = grouped(samples, start, finish);
    // Fewer intervals than samples leave the data a say in every coefficient.
    let mut intervals = (groups.len() * 2 / 3).clamp(6, MAX_INTERVALS);
    let mut domain = finish - start;
    if mirror {
        let reflected = |s: &Sample| Sample { t: 2.0 * end - s.t, position: [-s.position[0], s.position[1]], ..*s };
        let twins: Vec<Sample> = groups.iter().map(reflected).collect();
        groups.extend(twins);
        intervals *= 2;
        domain = 2.0 * (end - start).max(finish - end);
    }
    groups.iter_mut().for_each(|s| s.t -= start);
    let extent = super::ordering::extent(&groups.iter().map(|s| s.position).collect::<Vec<_>>());
    let step = domain / intervals as f64;
    let system = System::new(&groups, step, intervals);
    let weights: f64 = groups.iter().map(|s| s.weight).sum();
    let floor = 2.0 * weights * (ROUNDING * extent).powi(2);
    let score = |exponent: f64| system.score(exponent, &groups, floor);
    // At the upper end even the slowest wave that is penalised, of wave number pi / intervals, is gone. Numbers further
    // apart than ten digits would spoil the solution.
    let stiffest = 2.0 * DIFFERENCE as f64 * (intervals as f64 / std::f64::consts::PI).log10() + 1.0;
    let best = minimise(score, -13.0, stiffest.min(10.0)).ok_or_else(|| no_fit("the normal equations are singular"))?;
    let coefficients = system.solve(best).ok_or_else(|| no_fit("the normal equations are singular"))?;
    if coefficients.iter().flatten().any(|c| !c.is_finite()) {
        return Err(no_fit("the numbers overflow"));
    }
    let freedom = system.freedom(best).unwrap_or(0.0);
    Ok(Fit { curve: PiecewiseCurve { start, ..piecewise(&coefficients, step) }, freedom })
}

/// Neighbours averaged into groups, where there are many samples.
fn grouped(samples: &[Sample], start: f64, finish: f64) -> Vec<Sample> {
    if samples.len() <= MAX_SAMPLES {
        return samples.to_vec();
    }
    let mut sums = vec![[0.0; 4]; MAX_SAMPLES];
    for s in samples {
        let place = ((s.t - start) / (finish - start) * MAX_SAMPLES as f64).max(0.0) as usize;
        if let Some(sum) = sums.get_mut(place.min(MAX_SAMPLES - 1)) {
            for (total, value) in sum.iter_mut().zip([1.0, s.t, s.position[0], s.position[1]]) {
                *total += s.weight * value;
            }
        }
    }
    sums.iter()
        .filter(|sum| sum[0] > 0.0)
        .map(|s| Sample { t: s[1] / s[0], position: [s[2] / s[0], s[3] / s[0]], weight: s[0] })
        .collect()
}

/// The six B-splines of degree 5 that live on one interval of even knots, as coefficients of `u^0 ... u^5`; the first
/// started five intervals before. Cox and de Boor's recursion: `p N_r^p = (u - r + p) N_(r-1)^(p-1) + (r + 1 - u) N_r^(p-1)`.
fn basis_polynomials() -> [[f64; DEGREE + 1]; DEGREE + 1] {
    let mut basis = [[0.0; DEGREE + 1]; DEGREE + 1];
    basis[0][0] = 1.0;
    for degree in 1..=DEGREE {
        let p = degree as f64;
        let mut before = [0.0; DEGREE + 1];
        for (r, spline) in basis.iter_mut().enumerate().take(degree + 1) {
            let old = *spline;
            let r = r as f64;
            for k in 0..=DEGREE {
                let lower = |poly: &[f64; DEGREE + 1]| if k == 0 { 0.0 } else { poly[k - 1] };
                spline[k] = (lower(&before) + (p - r) * before[k] - lower(&old) + (r + 1.0) * old[k]) / p;
            }
            before = old;
        }
    }
    basis
}

/// Interval and the six B-splines that are not zero at `t`; past the ends the outermost interval's polynomials go on.
fn basis(polynomials: &[[f64; DEGREE + 1]; DEGREE + 1], place: f64, intervals: usize) -> (usize, [f64; DEGREE + 1]) {
    let index = (place.max(0.0) as usize).min(intervals.saturating_sub(1));
    let u = place - index as f64;
    (index, polynomials.map(|poly| poly.iter().rev().fold(0.0, |sum, c| sum * u + c)))
}

/// The curve of given B-spline coefficients, as polynomials.
fn piecewise(coefficients: &[[f64; 2]], step: f64) -> PiecewiseCurve {
    let polynomials = basis_polynomials();
    let piece = |window: &[[f64; 2]]| {
        let mut piece = [[0.0; DEGREE + 1]; 2];
        for (c, poly) in window.iter().zip(&polynomials) {
            for k in 0..2 {
                for (sum, a) in piece[k].iter_mut().zip(poly) {
                    *sum += c[k] * a;
                }
            }
        }
        piece
    };
    PiecewiseCurve { start: 0.0, step, pieces: coefficients.windows(DEGREE + 1).map(piece).collect() }
}

/// The normal equations `(B^T W B + lambda P) c = B^T W p`.
struct System {
    gram: BandedSymmetric,
    penalty: BandedSymmetric,
    right: Vec<[f64; 2]>,
    /// Interval and basis values of every sample.
    rows: Vec<(usize, [f64; DEGREE + 1])>,
    /// `lambda` is this times a power of ten.
    unit: f64,
}

impl System {
    fn new(samples: &[Sample], step: f64, intervals: usize) -> Self {
        let order = intervals + DEGREE;
        let polynomials = basis_polynomials();
        let mut gram = BandedSymmetric::zeros(order, DEGREE);
        let mut right = vec![[0.0; 2]; order];
        let rows: Vec<_> = samples.iter().map(|s| basis(&polynomials, s.t / step, intervals)).collect();
        for (s, (index, values)) in samples.iter().zip(&rows) {
            for (a, va) in values.iter().enumerate() {
                for (b, vb) in values.iter().enumerate().take(a + 1) {
                    gram.add(index + a, index + b, s.weight * va * vb);
                }
                for (sum, p) in right[index + a].iter_mut().zip(s.position) {
                    *sum += s.weight * va * p;
                }
            }
        }
        let mut penalty = BandedSymmetric::zeros(order, DEGREE);
        let difference = [-1.0, 3.0, -3.0, 1.0];
        for first in 0..order - DIFFERENCE {
            for (a, da) in difference.iter().enumerate() {
                for (b, db) in difference.iter().enumerate().take(a + 1) {
                    penalty.add(first + a, first + b, da * db);
                }
            }
        }
        let unit = gram.trace() / penalty.trace();
        Self { gram, penalty, right, rows, unit }
    }

    fn solve(&self, exponent: f64) -> Option<Vec<[f64; 2]>> {
        let matrix = self.gram.plus(self.unit * 10.0_f64.powf(exponent), &self.penalty);
        Some(matrix.factorised()?.solve(&self.right))
    }

    /// Trace of the matrix that takes the samples to the fitted values.
    fn freedom(&self, exponent: f64) -> Option<f64> {
        let matrix = self.gram.plus(self.unit * 10.0_f64.powf(exponent), &self.penalty);
        Some(matrix.factorised()?.inverse_trace(&self.gram))
    }

    /// The cross-validation score, without a constant factor; `None` where it has no meaning.
    fn score(&self, exponent: f64, samples: &[Sample], floor: f64) -> Option<f64> {
        let factor = self.gram.plus(self.unit * 10.0_f64.powf(exponent), &self.penalty).factorised()?;
        let coefficients = factor.solve(&self.right);
        let mut squares = floor;
        for (s, (index, values)) in samples.iter().zip(&self.rows) {
            let window = coefficients.get(*index..index + DEGREE + 1)?;
            for k in 0..2 {
                let fitted: f64 = window.iter().zip(values).map(|(c, v)| c[k] * v).sum();
                squares += s.weight * (s.position[k] - fitted).powi(2);
            }
        }
        let count = samples.len() as f64;
        let free = 1.0 - self.penalised_freedom(factor.inverse_trace(&self.gram), count) / count;
        (free > 0.0 && squares.is_finite()).then(|| squares / (free * free))
    }

    /// Degrees of freedom as the score counts them. Few points need each of their own: there the plain count stands.
    fn penalised_freedom(&self, freedom: f64, count: f64) -> f64 {
        freedom * (1.0 + 0.4 * (count / 50.0).min(1.0))
    }
}

/// The exponent with the least score: a scan in steps of a third, then golden sections about the best.
fn minimise(score: impl Fn(f64) -> Option<f64>, low: f64, high: f64) -> Option<f64> {
    const STEP: f64 = 1.0 / 3.0;
    let count = ((high - low) / STEP) as usize;
    let (mut best, _) = (0..=count)
        .map(|i| low + STEP * i as f64)
        .filter_map(|x| Some((x, score(x)?)))
        .min_by(|a, b| a.1.total_cmp(&b.1))?;
    let (mut a, mut b) = ((best - STEP).max(low), (best + STEP).min(high));
    let ratio = (5.0_f64.sqrt() - 1.0) / 2.0;
    for _ in 0..12 {
        let (c, d) = (b - ratio * (b - a), a + ratio * (b - a));
        match (score(c), score(d)) {
            (Some(vc), Some(vd)) if vc < vd => b = d,
            (Some(_), None) => b = d,
            _ => a = c,
        }
        best = 0.5 * (a + b);
    }
    Some(best)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn samples(count: usize, end: f64, curve: impl Fn(f64) -> [f64; 2]) -> Vec<Sample> {
        (0..count)
            .map(|i| end * i as f64 / (count - 1) as f64)
            .map(|t| Sample { t, position: curve(t), weight: 1.0 })
            .collect()
    }

    #[test]
    fn basis_sums_to_one_and_has_the_known_values_at_a_knot() {
        // Uniform quintic B-splines at a knot: 1, 26, 66, 26, 1 over 120.
        let (index, values) = basis(&basis_polynomials(), 3.0, 7);
        assert_eq!(index, 3);
        for (value, expected) in values.iter().zip([1.0, 26.0, 66.0, 26.0, 1.0, 0.0]) {
            assert!((value - expected / 120.0).abs() < 1e-15);
        }
        for place in [-0.5, 0.3, 6.9, 7.0, 7.4] {
            let (_, values) = basis(&basis_polynomials(), place, 7);
            assert!((values.iter().sum::<f64>() - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn a_quintic_is_followed_with_its_derivatives() {
        // Quintics lie in the spline's space: with data this exact the penalty must give way.
        let curve = |t: f64| [1.0 - t.powi(5), t - t.powi(3)];
        let fit = fit(&samples(200, 1.0, curve), 1.0, false).expect("fits");
        for t in [0.0, 0.31, 0.77, 1.0] {
            let [p, d1, d2, d3] = fit.curve.at(t);
            assert!((p[0] - curve(t)[0]).abs() < 1e-9 && (p[1] - curve(t)[1]).abs() < 1e-9);
            assert!((d1[0] + 5.0 * t.powi(4)).abs() < 1e-5 && (d1[1] - 1.0 + 3.0 * t * t).abs() < 1e-5);
            assert!((d2[0] + 20.0 * t.powi(3)).abs() < 2e-3 && (d2[1] + 6.0 * t).abs() < 2e-3);
            assert!((d3[0] + 60.0 * t * t).abs() < 0.5 && (d3[1] + 6.0).abs() < 0.5);
        }
    }

    #[test]
    fn pure_noise_about_a_parabola_leaves_few_degrees_of_freedom() {
        use rand_xoshiro::rand_core::{Rng, SeedableRng};
        let mut random = rand_xoshiro::Xoshiro256PlusPlus::seed_from_u64(3);
        let mut noise = || 0.01 * (random.next_u64() as f64 / u64::MAX as f64 - 0.5);
        let mut data = samples(400, 1.0, |t| [1.0 - t, t * (1.0 - t)]);
        for s in &mut data {
            s.position = [s.position[0] + noise(), s.position[1] + noise()];
        }
        let fit = fit(&data, 1.0, false).expect("fits");
        assert!(fit.freedom < 14.0, "{}", fit.freedom);
    }

    #[test]
    fn mirrored_data_make_radius_odd_and_height_even() {
        let data = samples(50, 1.5, |t| [(1.5 - t).sin(), (1.5 - t).cos()]);
        let fit = fit(&data, 1.5, true).expect("fits");
        let [p, d1, d2, _] = fit.curve.at(1.5);
        assert!(p[0].abs() < 1e-12 && d1[1].abs() < 1e-10 && d2[0].abs() < 1e-8);
    }

    #[test]
    fn a_curve_without_length_is_refused() {
        assert!(matches!(fit(&[], 0.0, false), Err(TargetError::NoFit { .. })));
        assert!(fit(&[], 1.0, false).is_err());
    }
}
