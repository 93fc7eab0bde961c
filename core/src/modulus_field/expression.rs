//! Text of the expression: numbers, signs and nesting that read the same in Python 2, Python 3 and ABAQUS/CAE.
//!
//! ABAQUS/CAE hands the expression of an `ExpressionField` to its Python interpreter with the `math` module imported, so
//! the grammar is Python's: `+ - * /`, parentheses and calls such as `exp(...)` and `pow(a,b)`. Two habits of that
//! interpreter shape the text: Python 2 divides integers (`1/2` is 0), hence a decimal point in every number, and a sign
//! is always written as the operator between two terms, never as a second operator in a row.

/// `value` rounded to `digits` significant decimal digits, halves by the exact binary value.
pub(super) fn round_significant(value: f64, digits: usize) -> f64 {
    format!("{value:.*e}", digits.saturating_sub(1)).parse().unwrap_or(value)
}

/// `value` rounded to `decimals` places after the decimal point; never a negative zero.
pub(super) fn round_decimals(value: f64, decimals: usize) -> f64 {
    format!("{value:.decimals$}").parse::<f64>().unwrap_or(value) + 0.0
}

/// The shortest float literal of a number that is not negative: it reads back as the same number and has a decimal point.
pub(super) fn literal(value: f64) -> String {
    let mut plain = format!("{value}");
    if !plain.contains('.') {
        plain.push_str(".0");
    }
    let scientific = format!("{value:e}");
    let scientific = match scientific.split_once('e') {
        Some((mantissa, exponent)) if !mantissa.contains('.') => format!("{mantissa}.0e{exponent}"),
        _ => scientific,
    };
    if scientific.len() < plain.len() { scientific } else { plain }
}

/// A literal with its sign, for the head of an expression or of a parenthesis.
fn signed_literal(value: f64) -> String {
    let sign = if value < 0.0 { "-" } else { "" };
    format!("{sign}{}", literal(value.abs()))
}

/// The sign that joins a term to the text before it: none at the head unless negative.
fn join(text: &mut String, value: f64) {
    if value < 0.0 {
        text.push('-');
    } else if !text.is_empty() {
        text.push('+');
    }
}

/// `A*exp(-pow((X-b)/c,2.0))+...`; each term is (amplitude `A`, centre `b`, width `c > 0`).
pub(super) fn gaussian_sum(variable: &str, terms: impl Iterator<Item = (f64, f64, f64)>) -> String {
    let mut text = String::new();
    for (amplitude, centre, width) in terms {
        join(&mut text, amplitude);
        let shifted = match centre {
            0.0 => variable.to_owned(),
            c if c < 0.0 => format!("({variable}+{})", literal(-c)),
            c => format!("({variable}-{})", literal(c)),
        };
        text.push_str(&format!("{}*exp(-pow({shifted}/{},2.0))", literal(amplitude.abs()), literal(width)));
    }
    text
}

/// `A*exp(u*(c1+u*(c2+...)))` in Horner form with `u = X/h-1.0` written out; `coefficients` are `c1, c2, ...`.
pub(super) fn exponential_polynomial(variable: &str, half_length: f64, reference: f64, coefficients: &[f64]) -> String {
    let u = format!("({variable}/{}-1.0)", literal(half_length));
    // Built from the innermost coefficient outwards; a lone number keeps its sign apart, so that the sign can become the
    // operator of the level above.
    enum Inner {
        Nothing,
        Number(f64),
        Sum(String),
    }
    let mut inner = Inner::Nothing;
    for &coefficient in coefficients.iter().rev() {
        inner = match (inner, coefficient == 0.0) {
            (Inner::Nothing, true) => Inner::Nothing,
            (Inner::Nothing, false) => Inner::Number(coefficient),
            (Inner::Number(c), zero) => {
                let mut text = if zero { String::new() } else { signed_literal(coefficient) };
                join(&mut text, c);
                text.push_str(&format!("{u}*{}", literal(c.abs())));
                Inner::Sum(text)
            }
            (Inner::Sum(sum), true) => Inner::Sum(format!("{u}*({sum})")),
            (Inner::Sum(sum), false) => Inner::Sum(format!("{}+{u}*({sum})", signed_literal(coefficient))),
        };
    }
    let reference = literal(reference);
    match inner {
        Inner::Nothing => reference,
        Inner::Number(c) => format!("{reference}*exp({}*{u})", signed_literal(c)),
        Inner::Sum(sum) => format!("{reference}*exp({u}*({sum}))"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_literal_is_a_float_and_reads_back() {
        for (value, text) in [
            (0.0, "0.0"),
            (2.0, "2.0"),
            (100.0, "100.0"),
            (0.125, "0.125"),
            (1e-7, "1.0e-7"),
            (2.5e-8, "2.5e-8"),
            (3e20, "3.0e20"),
            (2033.33, "2033.33"),
        ] {
            assert_eq!(literal(value), text);
            assert_eq!(text.parse::<f64>().unwrap(), value);
        }
    }

    #[test]
    fn rounds_in_decimal() {
        assert_eq!(round_significant(12.3456, 3), 12.3);
        assert_eq!(round_significant(-0.0012345, 2), -0.0012);
        assert_eq!(round_decimals(0.12345, 3), 0.123);
        assert_eq!(literal(round_decimals(-1e-9, 3)), "0.0");
    }

    #[test]
    fn signs_become_operators() {
        let gaussians = gaussian_sum("X", [(2.0, -1.5, 30.0), (-0.5, 0.0, 4.0), (1.0, 7.0, 8.0)].into_iter());
        assert_eq!(
            gaussians,
            "2.0*exp(-pow((X+1.5)/30.0,2.0))-0.5*exp(-pow(X/4.0,2.0))+1.0*exp(-pow((X-7.0)/8.0,2.0))"
        );
        let polynomial = |c: &[f64]| exponential_polynomial("X", 50.0, 3.0, c);
        assert_eq!(polynomial(&[]), "3.0");
        assert_eq!(polynomial(&[0.0, 0.0]), "3.0");
        assert_eq!(polynomial(&[-0.5]), "3.0*exp(-0.5*(X/50.0-1.0))");
        assert_eq!(polynomial(&[-0.5, -0.25]), "3.0*exp((X/50.0-1.0)*(-0.5-(X/50.0-1.0)*0.25))");
        assert_eq!(polynomial(&[0.0, 0.25]), "3.0*exp((X/50.0-1.0)*((X/50.0-1.0)*0.25))");
        assert_eq!(
            polynomial(&[1.0, -2.0, 0.0, 4.0]),
            "3.0*exp((X/50.0-1.0)*(1.0+(X/50.0-1.0)*(-2.0+(X/50.0-1.0)*((X/50.0-1.0)*4.0))))"
        );
    }
}
