//! The `[indentation]` table: how a closed dome is pressed.

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::InputError;
use super::check::check_value;
use super::parameters::parameter;
use crate::materials::Material;

/// Pressing the hub of a dome down.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct IndentationInput {
    /// How far, mm; a tenth of the length where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub depth_mm: Option<f64>,
    /// Points of the curve.
    pub steps: usize,
    /// What presses.
    pub indenter: Indenter,
    /// Diameter of the flat indenter, mm; 0.339 of the dome's where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub indenter_diameter_mm: Option<f64>,
    /// Whether strips bend as beams or as plates.
    pub bending: Bending,
    /// Share by which all moduli may be off, percent; absent where it is that of the materials' scatter.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub modulus_band_percent: Option<f64>,
    /// Decks: pressure over penetration between indenter and spokes, N/mm^3.
    pub contact_stiffness_n_mm3: f64,
    /// Decks of explicit dynamics: nominal strain a second, 1/s.
    pub loading_rate_per_s: f64,
    /// Decks of explicit dynamics: factor on all masses.
    pub mass_scaling: f64,
}

/// What presses a dome.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Indenter {
    /// A flat rigid plate that moves with the hub and may touch the spokes.
    Flat,
    /// Nothing but the hub is pushed.
    Hub,
}

impl Indenter {
    /// The word of the design file.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Flat => "flat",
            Self::Hub => "hub",
        }
    }
}

/// How a strip bends across its width.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Bending {
    /// Free to curl: modulus `E`.
    Beam,
    /// Kept straight: modulus `E/(1 - nu^2)`.
    PlaneStrain,
}

/// Diameter of the indenter over that of the dome: 50 mm on the hemisphere of 100 mm spokes.
pub const INDENTER_SHARE: f64 = 0.339;
/// Depth over the length of a spoke.
pub const DEPTH_SHARE: f64 = 0.1;
/// Share by which moduli may be off where materials do not say, percent.
pub const BAND_PERCENT: f64 = 10.0;

impl Default for IndentationInput {
    fn default() -> Self {
        Self {
            depth_mm: None,
            steps: 40,
            indenter: Indenter::Flat,
            indenter_diameter_mm: None,
            bending: Bending::Beam,
            modulus_band_percent: None,
            contact_stiffness_n_mm3: 50.0,
            loading_rate_per_s: 0.1,
            mass_scaling: 1.0,
        }
    }
}

impl IndentationInput {
    /// Fills in the band where the phases do not all have a scatter of their own; a band that is given stays. Designs without scatter
    /// thus record the default and keep their hash.
    pub(super) fn fill_band(&mut self, phases: &[Material]) {
        if phases.iter().any(|m| m.modulus_scatter_percent.is_none()) {
            self.modulus_band_percent.get_or_insert(BAND_PERCENT);
        }
    }

    /// Types and ranges of all keys (values may come from elsewhere than a design file).
    ///
    /// # Errors
    /// [`InputError`] naming the key.
    pub fn validate(&self) -> Result<(), InputError> {
        if let Ok(Value::Object(table)) = serde_json::to_value(self) {
            for (name, value) in &table {
                let key = format!("indentation.{name}");
                if let Some(parameter) = parameter(&key) {
                    check_value(parameter, &key, value)?;
                }
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use serde_json::Map;

    use super::*;
    use crate::input::parameters::PARAMETERS;

    #[test]
    fn defaults_are_those_of_the_table() {
        let pairs = PARAMETERS.iter().filter_map(|p| {
            let key = p.key.strip_prefix("indentation.")?;
            Some((key.to_owned(), serde_json::from_str(p.default?).unwrap()))
        });
        let table: Map<String, Value> = pairs.collect();
        let parsed: IndentationInput = serde_json::from_value(Value::Object(table)).unwrap();
        assert_eq!(parsed, IndentationInput::default());
    }

    #[test]
    fn values_from_elsewhere_are_held_against_the_table() {
        for (input, key) in [
            (IndentationInput { depth_mm: Some(-1.0), ..IndentationInput::default() }, "depth_mm"),
            (IndentationInput { steps: 0, ..IndentationInput::default() }, "steps"),
            (
                IndentationInput { modulus_band_percent: Some(f64::NAN), ..IndentationInput::default() },
                "modulus_band_percent",
            ),
        ] {
            let error = input.validate().unwrap_err().to_string();
            assert!(error.contains(key), "{error}");
        }
        IndentationInput::default().validate().unwrap();
    }
}
