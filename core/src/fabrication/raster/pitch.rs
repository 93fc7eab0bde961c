//! The size of a printer's voxel.

use crate::input::{FabricationInput, Printer};

/// Millimetres in an inch.
const INCH: f64 = 25.4;

/// Size of a printer's voxel along x, y and z, mm.
///
/// Printers are built to a whole number of dots per inch; what their data sheets call 42.3 or 42 um is 1/600 inch, and
/// 84.6 um is 1/300 inch. The exact figures are used, since over the width of a tray the rounded ones are off by
/// several voxels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pitch {
    /// x, y, z.
    pub mm: [f64; 3],
}

impl Pitch {
    /// The pitch that a design asks for.
    #[must_use]
    pub fn of(input: &FabricationInput) -> Self {
        match (input.printer, input.pitch_um) {
            (Printer::Custom, Some(um)) => Self { mm: um.map(|p| 1e-3 * p) },
            (Printer::Objet260, _) => Self::dots([600, 600], 16.0),
            (Printer::J750 | Printer::Custom, _) => Self::dots([600, 300], 27.0),
        }
    }

    /// A pitch from dots per inch and the height of a slice in um.
    #[must_use]
    pub fn dots(dpi: [u32; 2], slice_um: f64) -> Self {
        let [x, y] = dpi.map(|dpi| INCH / f64::from(dpi.max(1)));
        Self { mm: [x, y, 1e-3 * slice_um] }
    }

    /// The nearest pitch with whole dots per inch and whole nanometres of height, for containers that can state no other.
    #[must_use]
    pub fn rounded_to_dots(self) -> Self {
        Self::dots(self.dpi(), 1e-3 * self.slice_nm() as f64)
    }

    /// Dots per inch in x and y, rounded.
    #[must_use]
    pub fn dpi(&self) -> [u32; 2] {
        [self.mm[0], self.mm[1]].map(|p| (INCH / p).round().clamp(1.0, 1e6) as u32)
    }

    /// Height of a slice in nanometres, rounded.
    #[must_use]
    pub fn slice_nm(&self) -> u64 {
        (1e6 * self.mm[2]).round().max(1.0) as u64
    }

    /// Pixels per metre in x and y, rounded.
    #[must_use]
    pub fn pixels_per_metre(&self) -> [u32; 2] {
        [self.mm[0], self.mm[1]].map(|p| (1e3 / p).round().clamp(1.0, f64::from(u32::MAX)) as u32)
    }

    /// In um.
    #[must_use]
    pub fn um(&self) -> [f64; 3] {
        // Short decimals are what people wrote; eight digits hide what binary fractions make of them.
        self.mm.map(|p| (1e8 * p).round() / 1e5)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn printers_have_whole_dots_and_custom_pitches_are_kept() {
        let of = |printer, pitch_um| {
            Pitch::of(&FabricationInput { printer, pitch_um, ..FabricationInput::defaults().unwrap() })
        };
        let j750 = of(Printer::J750, None);
        assert_eq!((j750.dpi(), j750.slice_nm()), ([600, 300], 27_000));
        assert_eq!(j750.rounded_to_dots(), j750);
        assert!((j750.mm[0] - 0.0423).abs() < 5e-5 && (j750.mm[1] - 0.0846).abs() < 1e-4);
        assert_eq!(j750.pixels_per_metre(), [23_622, 11_811]);
        let objet = of(Printer::Objet260, None);
        assert_eq!((objet.dpi(), objet.slice_nm()), ([600, 600], 16_000));
        let custom = of(Printer::Custom, Some([42.0, 100.0, 16.5]));
        assert_eq!(custom.um(), [42.0, 100.0, 16.5]);
        assert_eq!(custom.dpi(), [605, 254]);
        assert!((custom.rounded_to_dots().mm[1] - 0.1).abs() < 1e-12);
        assert!((custom.rounded_to_dots().mm[0] / custom.mm[0] - 1.0).abs() < 5e-4);
    }
}
