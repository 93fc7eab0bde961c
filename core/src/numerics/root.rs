//! Bracketed root finding.

/// The root of `f` in `[a, b]`, where `f(a)` and `f(b)` have opposite signs.
///
/// Bisection with a secant step where that stays inside the bracket (the Illinois form of false position), to the
/// precision of the argument.
pub(crate) fn bracketed_root(mut a: f64, mut b: f64, f: impl Fn(f64) -> f64) -> f64 {
    let (mut fa, mut fb) = (f(a), f(b));
    if fa == 0.0 {
        return a;
    }
    if fb == 0.0 {
        return b;
    }
    let mut last_side = 0;
    for iteration in 0..200 {
        let width = b - a;
        let secant = (a * fb - b * fa) / (fb - fa);
        let usable = secant > a && secant < b && iteration % 8 != 7;
        let c = if usable { secant } else { a + 0.5 * width };
        let fc = f(c);
        if fc == 0.0 || width <= 2.0 * f64::EPSILON * (a.abs() + b.abs()) {
            return c;
        }
        if (fc > 0.0) == (fb > 0.0) {
            (b, fb) = (c, fc);
            if last_side == 1 {
                fa *= 0.5;
            }
            last_side = 1;
        } else {
            (a, fa) = (c, fc);
            if last_side == -1 {
                fb *= 0.5;
            }
            last_side = -1;
        }
    }
    0.5 * (a + b)
}

#[cfg(test)]
mod tests {
    use super::bracketed_root;

    #[test]
    fn simple_and_flat_roots_are_found_to_machine_precision() {
        assert!((bracketed_root(0.0, 2.0, |x| x * x - 2.0) - 2.0_f64.sqrt()).abs() < 1e-15);
        assert!((bracketed_root(-1.0, 2.0, |x: f64| (x - 0.3).powi(5)) - 0.3).abs() < 1e-3);
        assert_eq!(bracketed_root(0.0, 1.0, |x| x), 0.0);
    }
}
