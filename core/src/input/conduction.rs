//! The `[conduction]` table: what is heated, how current enters, where and when it is measured.

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::InputError;
use super::check::check_value;
use super::parameters::parameter;

/// Heat and current through a strip.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ConductionInput {
    /// Temperature of the rim, K.
    pub rim_temperature_k: f64,
    /// Temperature of the rest at the start, K.
    pub start_temperature_k: f64,
    /// Current that enters at the rim, A.
    pub current_a: f64,
    /// How it enters.
    pub electrode: Electrode,
    /// Times of temperature fields, s.
    pub heat_times_s: Vec<f64>,
    /// Times of potential fields, s.
    pub current_times_s: Vec<f64>,
    /// Measuring points, shares of the length from the rim.
    pub measure_at: Vec<f64>,
    /// Share of the final temperature at the critical time.
    pub threshold: f64,
    /// What it is a share of.
    pub threshold_of: ThresholdOf,
    /// Share off the steady potential that counts as its plateau.
    pub plateau: f64,
    /// Largest error of a time step as a share of the rise.
    pub time_tolerance: f64,
    /// Elements of the graded model along, across and through.
    pub graded_elements: [usize; 3],
}

/// How current enters at the rim.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Electrode {
    /// Through a contact of one, unknown potential.
    Equipotential,
    /// With one density over the cross-section.
    Uniform,
}

/// What the threshold of the critical time is a share of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ThresholdOf {
    /// The rise from the start.
    Rise,
    /// The absolute temperature.
    Value,
}

impl Default for ConductionInput {
    fn default() -> Self {
        Self {
            rim_temperature_k: 393.15,
            start_temperature_k: 316.15,
            current_a: 1.0,
            electrode: Electrode::Equipotential,
            heat_times_s: vec![100.0, 1000.0, 2000.0],
            current_times_s: vec![1e-4, 1e-3, 2e-3],
            measure_at: vec![0.5, 1.0],
            threshold: 0.999,
            threshold_of: ThresholdOf::Rise,
            plateau: 1e-3,
            time_tolerance: 2e-6,
            graded_elements: [160, 24, 4],
        }
    }
}

impl ConductionInput {
    /// Share of the rise from the start at which a point has got to the threshold.
    #[must_use]
    pub fn rise_at_threshold(&self) -> f64 {
        let (start, rim) = (self.start_temperature_k, self.rim_temperature_k);
        match self.threshold_of {
            ThresholdOf::Rise => self.threshold,
            // Cooling gets to the value from above.
            ThresholdOf::Value if rim >= start => (self.threshold * rim - start) / (rim - start),
            ThresholdOf::Value => (start - (2.0 - self.threshold) * rim) / (start - rim),
        }
    }

    /// Types and ranges of all keys (values may come from elsewhere than a design file), and rules that concern more than that.
    ///
    /// # Errors
    /// [`InputError`] naming the key.
    pub fn validate(&self) -> Result<(), InputError> {
        let key = |name: &str| format!("conduction.{name}");
        if let Ok(Value::Object(table)) = serde_json::to_value(self) {
            for (name, value) in &table {
                if let Some(parameter) = parameter(&key(name)) {
                    check_value(parameter, &key(name), value)?;
                }
            }
        }
        for (name, times) in [("heat_times_s", &self.heat_times_s), ("current_times_s", &self.current_times_s)] {
            if let Some(time) = times.iter().find(|t| !(**t > 0.0 && t.is_finite())) {
                return Err(InputError::new(key(name), time, "times must be positive"));
            }
            if times.windows(2).any(|w| w[1] <= w[0]) {
                return Err(InputError::new(key(name), format!("{times:?}"), "times must rise"));
            }
        }
        if let Some(share) = self.measure_at.iter().find(|s| !(**s > 0.0 && **s <= 1.0)) {
            let problem =
                "measuring points are shares of the length, greater than 0 (the rim) and at most 1 (the far end)";
            return Err(InputError::new(key("measure_at"), share, problem));
        }
        if (self.rim_temperature_k - self.start_temperature_k).abs() < 1e-6 * self.start_temperature_k {
            let problem = "the rim is as warm as the rest, so no heat flows";
            return Err(InputError::new(key("rim_temperature_k"), self.rim_temperature_k, problem)
                .help("give rim_temperature_k and start_temperature_k different values"));
        }
        if self.rise_at_threshold() <= 0.0 {
            let problem = format!(
                "of the absolute temperature this is reached before it starts: the start is at {} K, the rim at {} K",
                self.start_temperature_k, self.rim_temperature_k
            );
            return Err(InputError::new(key("threshold"), self.threshold, problem)
                .help("use a larger threshold or threshold_of = \"rise\""));
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
            let key = p.key.strip_prefix("conduction.")?;
            Some((key.to_owned(), serde_json::from_str(p.default?).unwrap()))
        });
        let table: Map<String, Value> = pairs.collect();
        let parsed: ConductionInput = serde_json::from_value(Value::Object(table)).unwrap();
        assert_eq!(parsed, ConductionInput::default());
    }

    #[test]
    fn thresholds_of_the_value_are_thresholds_of_the_rise_in_disguise() {
        let input = ConductionInput { threshold_of: ThresholdOf::Value, ..ConductionInput::default() };
        assert!((input.rise_at_threshold() - 0.994_894_155_844).abs() < 1e-9);
        let low = ConductionInput { threshold: 0.5, ..input };
        assert!(low.validate().unwrap_err().to_string().contains("threshold_of"));
    }

    #[test]
    fn values_from_elsewhere_are_held_against_the_table() {
        for (input, key) in [
            (ConductionInput { current_a: 0.0, ..ConductionInput::default() }, "current_a"),
            (ConductionInput { rim_temperature_k: f64::NAN, ..ConductionInput::default() }, "rim_temperature_k"),
            (ConductionInput { heat_times_s: vec![1.0, f64::INFINITY], ..ConductionInput::default() }, "heat_times_s"),
            (ConductionInput { graded_elements: [0, 1, 1], ..ConductionInput::default() }, "graded_elements"),
        ] {
            let error = input.validate().unwrap_err().to_string();
            assert!(error.contains(key), "{error}");
        }
        ConductionInput::default().validate().unwrap();
    }
}
