//! Texts and numbers of a page: escaping and number formats.

use std::borrow::Cow;

/// Text that may stand between tags and in quoted attributes of HTML and XML.
///
/// Control characters, which XML cannot hold, become the replacement character.
#[must_use]
pub fn escape(text: &str) -> Cow<'_, str> {
    let special = |c: char| matches!(c, '<' | '>' | '&' | '"' | '\'') || is_forbidden(c);
    if !text.contains(special) {
        return Cow::Borrowed(text);
    }
    let mut escaped = String::with_capacity(text.len() + 16);
    for c in text.chars() {
        match c {
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '&' => escaped.push_str("&amp;"),
            '"' => escaped.push_str("&quot;"),
            '\'' => escaped.push_str("&#39;"),
            c if is_forbidden(c) => escaped.push(char::REPLACEMENT_CHARACTER),
            c => escaped.push(c),
        }
    }
    Cow::Owned(escaped)
}

fn is_forbidden(c: char) -> bool {
    (c.is_control() && !matches!(c, '\t' | '\n')) || matches!(c, '\u{fffe}' | '\u{ffff}')
}

/// A number for a reader, with so many significant digits, trailing zeros dropped.
///
/// Thousands are grouped by narrow spaces from five digits on; very large and very small numbers are written with a
/// power of ten; what is not a number is a dash.
#[must_use]
pub fn number(value: f64, digits: usize) -> String {
    format_number(value, digits, without_trailing_zeros)
}

/// The same with its trailing zeros, for columns of numbers that are equally accurate.
#[must_use]
pub fn significant(value: f64, digits: usize) -> String {
    if value == 0.0 { "0".to_owned() } else { format_number(value, digits, |text| text) }
}

fn format_number(value: f64, digits: usize, ending: fn(&str) -> &str) -> String {
    if !value.is_finite() {
        return "–".to_owned();
    }
    let digits = digits.max(1);
    // Rounded first, so that 9.9999 counts as 10.
    let scientific = format!("{value:.*e}", digits - 1);
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    let text = if value != 0.0 && !(-4..7).contains(&exponent) {
        format!("{} × {}", ending(mantissa), power_of_ten(exponent))
    } else {
        let decimals = usize::try_from(digits as i32 - 1 - exponent).unwrap_or(0);
        grouped(ending(&format!("{value:.decimals$}")))
    };
    if text == "-0" { "0".to_owned() } else { text.replace('-', "−") }
}

/// `10` with an exponent.
#[must_use]
pub fn power_of_ten(exponent: i32) -> String {
    let exponent: String = exponent.to_string().chars().map(superscript).collect();
    format!("10{exponent}")
}

/// A whole number for a reader.
#[must_use]
pub fn whole(value: u64) -> String {
    grouped(&value.to_string())
}

/// A coordinate of a drawing: two decimals, no trailing zeros; zero for what is not a number.
#[must_use]
pub fn coordinate(value: f64) -> String {
    if !value.is_finite() {
        return "0".to_owned();
    }
    let text = format!("{value:.2}");
    let short = without_trailing_zeros(&text);
    if short == "-0" { "0".to_owned() } else { short.to_owned() }
}

fn without_trailing_zeros(text: &str) -> &str {
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { text }
}

fn grouped(text: &str) -> String {
    let (sign, rest) = text.strip_prefix('-').map_or(("", text), |rest| ("-", rest));
    let (integer, fraction) = rest.split_once('.').map_or((rest, None), |(i, f)| (i, Some(f)));
    let mut result = sign.to_owned();
    for (i, digit) in integer.chars().enumerate() {
        if integer.len() > 4 && i > 0 && (integer.len() - i) % 3 == 0 {
            result.push('\u{202f}');
        }
        result.push(digit);
    }
    if let Some(fraction) = fraction {
        result.push('.');
        result.push_str(fraction);
    }
    result
}

fn superscript(c: char) -> char {
    match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        '0' | '4'..='9' => char::from_u32(0x2070 + c as u32 - '0' as u32).unwrap_or(c),
        other => other,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_grouped_and_never_not_a_number() {
        for (value, digits, text) in [
            (2.315_8, 4, "2.316"),
            (100.0, 4, "100"),
            (66_928.0, 6, "66\u{202f}928"),
            (-0.000_01, 2, "−1 × 10⁻⁵"),
            (2.86e-23, 3, "2.86 × 10⁻²³"),
            (9.999_96, 4, "10"),
            (-0.0, 3, "0"),
            (12.5e9, 3, "1.25 × 10¹⁰"),
            (f64::NAN, 3, "–"),
            (1234.6, 3, "1235"),
        ] {
            assert_eq!(number(value, digits), text);
        }
        assert_eq!(significant(0.116, 4), "0.1160");
        assert_eq!(coordinate(-0.001), "0");
        assert_eq!(coordinate(12.340_1), "12.34");
        assert_eq!(coordinate(f64::INFINITY), "0");
    }

    #[test]
    fn texts_cannot_leave_their_place() {
        assert_eq!(escape("plain ä"), "plain ä");
        assert_eq!(escape("<&\"'>\u{1}"), "&lt;&amp;&quot;&#39;&gt;\u{fffd}");
    }
}
