//! How far all moduli may be off.

use serde::Serialize;

use crate::design::Design;
use crate::input::IndentationInput;
use crate::input::indentation::BAND_PERCENT;
use crate::materials::Material;

/// The key that a band comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum BandSource {
    /// `indentation.modulus_band_percent`, or its default.
    ModulusBandPercent,
    /// `modulus_scatter_percent` of the phases.
    ModulusScatterPercent,
}

impl BandSource {
    /// Words for readers.
    #[must_use]
    pub fn describe(self) -> &'static str {
        match self {
            Self::ModulusBandPercent => "modulus_band_percent",
            Self::ModulusScatterPercent => "scatter of the phases",
        }
    }
}

/// Share by which all moduli, and with them the forces, may be off.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModulusBand {
    /// Percent.
    pub percent: f64,
    /// Where it comes from.
    pub source: BandSource,
}

impl ModulusBand {
    /// The band of a design: the one that is given; else, where every phase has a scatter, the largest of any slice; else 10 %.
    ///
    /// All phases are off at once and in one direction. A slice of `n_i` voxels of moduli `E_i` and scatters `p_i` is then off by
    /// `sum(n_i E_i p_i) / sum(n_i E_i)` (Voigt). To first order the force is off by a mean of that over the spoke, weighted by
    /// the strain energy, which the largest bounds.
    #[must_use]
    pub fn new(design: &Design, input: &IndentationInput) -> Self {
        let given = |percent| Self { percent, source: BandSource::ModulusBandPercent };
        if let Some(percent) = input.modulus_band_percent {
            return given(percent);
        }
        let phases = design.phases().phases();
        let scatter = |m: &Material| Some([m.modulus_mpa, m.modulus_scatter_percent?]);
        let Some(scattered) = phases.iter().map(scatter).collect::<Option<Vec<_>>>() else {
            return given(BAND_PERCENT);
        };
        let off = design.slices().iter().map(|slice| of_slice(&slice.counts, &scattered));
        Self { percent: off.fold(0.0, f64::max), source: BandSource::ModulusScatterPercent }
    }
}

/// How far a slice's modulus is off; `scattered` are modulus and scatter of each phase.
fn of_slice(counts: &[u32; 3], scattered: &[[f64; 2]]) -> f64 {
    let sums = counts.iter().zip(scattered).fold([0.0; 2], |[whole, off], (n, [modulus, percent])| {
        let share = f64::from(*n) * modulus;
        [whole + share, off + share * percent]
    });
    if sums[0] > 0.0 { sums[1] / sums[0] } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slice_is_off_by_the_mean_weighted_by_stiffness() {
        let scattered = [[2.0, 5.0], [6.0, 20.0]];
        assert_eq!(of_slice(&[4, 0, 0], &scattered), 5.0);
        assert_eq!(of_slice(&[0, 3, 0], &scattered), 20.0);
        assert_eq!(of_slice(&[3, 1, 0], &scattered), (6.0 * 5.0 + 6.0 * 20.0) / 12.0);
        assert_eq!(of_slice(&[0, 0, 0], &scattered), 0.0);
    }
}
