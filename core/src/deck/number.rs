//! Numbers as text: short, exact enough, never `-0`, at most 20 characters (CalculiX reads no more).

/// Fixed-point text with trailing zeros removed. Decimals are chosen for a model of a given size, so that rounding moves
/// no node by more than 1e-9 of it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Coordinates {
    decimals: usize,
    scale: f64,
}

impl Coordinates {
    /// Coordinates of a model `size` mm long.
    pub(crate) fn new(size: f64) -> Self {
        let decimals = (9.0 - size.log10()).ceil().clamp(1.0, 15.0) as usize;
        Self { decimals, scale: 10_f64.powi(decimals as i32) }
    }

    /// Appends a coordinate.
    pub(crate) fn put(self, out: &mut Vec<u8>, value: f64) {
        let scaled = (value * self.scale).round() as i64;
        if scaled < 0 {
            out.push(b'-');
        }
        let mut digits = itoa::Buffer::new();
        let digits = digits.format(scaled.unsigned_abs()).as_bytes();
        let whole = digits.len().saturating_sub(self.decimals);
        if whole == 0 {
            out.push(b'0');
        } else {
            out.extend_from_slice(&digits[..whole]);
        }
        let fraction = &digits[whole..];
        let Some(last) = fraction.iter().rposition(|d| *d != b'0') else { return };
        out.push(b'.');
        out.extend(std::iter::repeat_n(b'0', self.decimals - fraction.len()));
        out.extend_from_slice(&fraction[..=last]);
    }
}

/// Ten significant digits, with an exponent where that is shorter.
pub(crate) fn real(value: f64) -> String {
    let rounded: f64 = format!("{value:.9e}").parse().unwrap_or(value);
    if rounded == 0.0 {
        "0".to_owned()
    } else if (1e-4..1e9).contains(&rounded.abs()) {
        format!("{rounded}")
    } else {
        format!("{rounded:e}")
    }
}

/// A decimal number that counts upward in place, which is several times faster than formatting every number.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Counter {
    text: [u8; 20],
    start: usize,
}

impl Counter {
    pub(crate) fn new(value: u64) -> Self {
        let mut digits = itoa::Buffer::new();
        let digits = digits.format(value).as_bytes();
        let start = 20 - digits.len();
        let mut text = [b'0'; 20];
        text[start..].copy_from_slice(digits);
        Self { text, start }
    }

    /// The number as text.
    #[inline]
    pub(crate) fn text(&self) -> &[u8] {
        &self.text[self.start..]
    }

    /// Adds one.
    #[inline]
    pub(crate) fn increment(&mut self) {
        let mut i = 19;
        while self.text[i] == b'9' && i > 0 {
            self.text[i] = b'0';
            i -= 1;
        }
        self.text[i] += 1;
        self.start = self.start.min(i);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn coordinate(size: f64, value: f64) -> String {
        let mut out = Vec::new();
        Coordinates::new(size).put(&mut out, value);
        String::from_utf8(out).unwrap()
    }

    #[test]
    fn coordinates_are_short_and_exact_to_a_billionth() {
        assert_eq!(coordinate(100.0, 0.0), "0");
        assert_eq!(coordinate(100.0, -1e-12), "0");
        assert_eq!(coordinate(100.0, 12.5), "12.5");
        assert_eq!(coordinate(100.0, -0.05), "-0.05");
        assert_eq!(coordinate(100.0, 100.0), "100");
        assert_eq!(coordinate(100.0, 1.0 / 3.0), "0.3333333");
        for size in [1e-3, 0.7, 10.0, 100.0, 1e5] {
            for value in [size, -size / 7.0, size / 3e7, 0.999_999_999_9 * size] {
                let text = coordinate(size, value);
                assert!((text.parse::<f64>().unwrap() - value).abs() <= 1e-9 * size, "{text} {value}");
                assert!(text.len() <= 20);
            }
        }
    }

    #[test]
    fn reals_are_short() {
        assert_eq!(real(0.1 + 0.2), "0.3");
        assert_eq!(real(-0.0), "0");
        assert_eq!(real(1145.0 * 1e-12), "1.145e-9");
        assert_eq!(real(12.6), "12.6");
        for value in [-std::f64::consts::PI * 1e-7, -1.0 / 3.0 * 1e-3, 2e12 / 3.0, -1e-300] {
            assert!(real(value).len() <= 20);
        }
    }

    #[test]
    fn counters_count() {
        for start in [1, 8, 95, 998, 1_999_999] {
            let mut counter = Counter::new(start);
            for value in start..start + 30 {
                assert_eq!(counter.text(), value.to_string().as_bytes());
                counter.increment();
            }
        }
    }
}
