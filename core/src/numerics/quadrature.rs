//! Gauss-Legendre quadrature on one interval.

/// Abscissae and weights of the five-point rule on `[-1, 1]`, exact for polynomials up to degree nine.
const FIVE_POINT: [(f64, f64); 5] = [
    (-0.906_179_845_938_664, 0.236_926_885_056_189_08),
    (-0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
    (0.0, 0.568_888_888_888_888_9),
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
    (0.906_179_845_938_664, 0.236_926_885_056_189_08),
];

/// Integrates a vector-valued function over `[a, b]` with the five-point Gauss-Legendre rule.
pub(crate) fn gauss_legendre<const N: usize>(a: f64, b: f64, f: impl Fn(f64) -> [f64; N]) -> [f64; N] {
    let (half, middle) = (0.5 * (b - a), 0.5 * (a + b));
    let mut sum = [0.0; N];
    for (abscissa, weight) in FIVE_POINT {
        let value = f(middle + half * abscissa);
        for (total, component) in sum.iter_mut().zip(value) {
            *total += half * weight * component;
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::gauss_legendre;

    #[test]
    fn a_polynomial_of_degree_nine_is_integrated_exactly() {
        let [integral] = gauss_legendre(-1.0, 3.0, |x: f64| [x.powi(9)]);
        let exact = (3.0_f64.powi(10) - 1.0) / 10.0;
        assert!((integral - exact).abs() < 1e-12 * exact);
    }
}
