//! Colours: one ramp for everything that is soft or stiff, and a few for lines.

/// An opaque colour, red, green, blue.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Colour(pub [u8; 3]);

impl Colour {
    /// `#rrggbb`.
    #[must_use]
    pub fn hex(self) -> String {
        let [r, g, b] = self.0;
        format!("#{r:02x}{g:02x}{b:02x}")
    }
}

/// Text.
pub const INK: Colour = Colour([0x1c, 0x25, 0x33]);
/// Less important text.
pub const MUTED: Colour = Colour([0x5b, 0x67, 0x78]);
/// Axes and outlines.
pub const AXIS: Colour = Colour([0x93, 0x9d, 0xab]);
/// Grid lines.
pub const GRID: Colour = Colour([0xe6, 0xea, 0xef]);
/// The target: a broad, pale line under all others.
pub const TARGET: Colour = Colour([0xb3, 0xcb, 0xe8]);
/// What is predicted.
pub const PREDICTED: Colour = Colour([0x12, 0x4d, 0x8c]);
/// What a solver or a measurement found.
pub const MEASURED: Colour = Colour([0xc2, 0x41, 0x0c]);
/// The single points of a measurement.
pub const CLOUD: Colour = Colour([0xe9, 0x9b, 0x78]);
/// The line of thrust.
pub const THRUST: Colour = Colour([0xb4, 0x2a, 0x7d]);
/// The hub.
pub const HUB: Colour = Colour([0x3a, 0x45, 0x55]);
/// Shaded ranges.
pub const SHADE: Colour = Colour([0xec, 0xf1, 0xf7]);

/// From soft (light) to stiff (dark): viridis backwards, readable with every kind of colour vision and in grey.
const RAMP: [[u8; 3]; 9] = [
    [0xf6, 0xe0, 0x55],
    [0xb5, 0xd9, 0x45],
    [0x5e, 0xc3, 0x66],
    [0x28, 0xa8, 0x80],
    [0x21, 0x8f, 0x8c],
    [0x2c, 0x72, 0x8e],
    [0x3b, 0x52, 0x8b],
    [0x46, 0x2f, 0x7c],
    [0x3d, 0x04, 0x4e],
];

/// The colour of a share from soft (0) to stiff (1).
#[must_use]
pub fn ramp(share: f64) -> Colour {
    let share = if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.0 };
    let at = share * (RAMP.len() - 1) as f64;
    let i = (at as usize).min(RAMP.len() - 2);
    let rest = at - i as f64;
    let mut mixed = [0; 3];
    for (k, channel) in mixed.iter_mut().enumerate() {
        let (from, to) = (f64::from(RAMP[i][k]), f64::from(RAMP[i + 1][k]));
        *channel = (from + rest * (to - from)).round() as u8;
    }
    Colour(mixed)
}

/// The colour of one of `count` phases, softest first.
#[must_use]
pub fn phase(index: usize, count: usize) -> Colour {
    ramp(index as f64 / count.saturating_sub(1).max(1) as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ramp_darkens_all_the_way() {
        let luminance = |Colour([r, g, b]): Colour| 0.299 * f64::from(r) + 0.587 * f64::from(g) + 0.114 * f64::from(b);
        let shades: Vec<f64> = (0..=64).map(|i| luminance(ramp(f64::from(i) / 64.0))).collect();
        assert!(shades.windows(2).all(|w| w[1] < w[0]), "{shades:?}");
        assert_eq!(ramp(f64::NAN), ramp(0.0));
        assert_eq!(phase(2, 3), ramp(1.0));
        assert_eq!(Colour([1, 2, 255]).hex(), "#0102ff");
    }
}
