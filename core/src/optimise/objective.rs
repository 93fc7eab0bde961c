//! What is made as large as possible.

use serde::{Deserialize, Serialize};

use super::figures::Figures;

/// Voxels across the narrowest place from which on more make no difference to printability.
const ENOUGH_VOXELS: f64 = 8.0;
/// Predicted error at which accuracy counts half, percent of the length; a design warns from it on.
const HALF_ERROR_PERCENT: f64 = 1.0;

/// A figure that can be maximised.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Objective {
    /// Rigidity `K` of a spoke, N/mm.
    #[serde(rename = "rigidity_n_mm")]
    Rigidity,
    /// Specific energy `psi`, N mm/mm^3.
    #[serde(rename = "specific_energy_nmm_mm3")]
    SpecificEnergy,
    /// [`printability`], 0 to 1.
    #[serde(rename = "printability")]
    Printability,
}

impl Objective {
    /// The word of the file.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Rigidity => "rigidity_n_mm",
            Self::SpecificEnergy => "specific_energy_nmm_mm3",
            Self::Printability => "printability",
        }
    }

    /// Its value; NaN where the design was not pressed.
    #[must_use]
    pub fn of(self, figures: &Figures) -> f64 {
        match self {
            Self::Rigidity => figures.rigidity_n_mm,
            Self::SpecificEnergy => figures.specific_energy_nmm_mm3,
            Self::Printability => printability(figures),
        }
    }
}

/// How surely a printer makes of a design what was designed, 0 to 1: the geometric mean of
///
/// - the share of the phases' contrast that stays in reserve, `1 - ln C / ln C_reach`;
/// - the voxels across the narrowest place, of 8 that are enough to mix two phases finely;
/// - accuracy, `1 / (1 + e)` with the error `e` that the voxels are predicted to make, percent of the length.
#[must_use]
pub fn printability(figures: &Figures) -> f64 {
    let reserve = (1.0 - figures.contrast.ln() / figures.contrast_reach.ln()).clamp(0.0, 1.0);
    let fineness = (figures.narrowest_voxels / ENOUGH_VOXELS).min(1.0);
    let accuracy = 1.0 / (1.0 + figures.predicted_error_percent / HALF_ERROR_PERCENT);
    (reserve * fineness * accuracy).cbrt()
}
