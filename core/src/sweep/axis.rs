//! The values of one key.

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use super::input::unknown;
use crate::input::InputError;
use crate::input::check::check_value;
use crate::input::parameters::{Kind, PARAMETERS, parameter};

/// Most values of an axis.
const MOST_VALUES: u64 = 10_000_000;

/// A key and the values it takes: a list, or a range.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AxisInput {
    /// Dotted key of the design file.
    pub key: String,
    /// Values, of any type that the key takes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub values: Option<Vec<Value>>,
    /// First value of a range.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from: Option<f64>,
    /// Last value of a range.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub to: Option<f64>,
    /// Values of a range in a grid, ends included.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub count: Option<u64>,
    /// How they are spaced.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub spacing: Option<Spacing>,
}

/// How a range is divided.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Spacing {
    /// Equal differences.
    Linear,
    /// Equal ratios.
    Log,
}

impl AxisInput {
    /// Holds key and values against the table of parameters. `shown` is where the axis stands, `target_kind` the design's.
    ///
    /// # Errors
    /// [`InputError`].
    pub fn check(&self, shown: &str, target_kind: &str) -> Result<(), InputError> {
        let at = |name: &str| format!("{shown}.{name}");
        let key = format!("\"{}\"", self.key);
        let Some(parameter) = parameter(&self.key).filter(|p| p.kind != Kind::Recorded) else {
            let known: Vec<&str> = PARAMETERS.iter().filter(|p| p.kind != Kind::Recorded).map(|p| p.key).collect();
            return Err(unknown(&at("key"), &self.key, &known, "the design file has no such key"));
        };
        if !parameter.applies_to(target_kind) {
            let problem = format!("this key does not apply to a target of kind \"{target_kind}\"");
            return Err(InputError::new(at("key"), key, problem));
        }
        if self.key.starts_with("materials.custom") || matches!(self.key.as_str(), "name" | "target.kind") {
            return Err(InputError::new(at("key"), key, "this key cannot vary").help("make a sweep of each"));
        }
        match (&self.values, self.from, self.to) {
            (Some(values), None, None) => {
                if values.is_empty() {
                    return Err(InputError::new(at("values"), "[]", "an axis needs a value"));
                }
                values.iter().try_for_each(|value| check_value(parameter, &self.key, value))
            }
            (None, Some(from), Some(to)) => {
                if !matches!(parameter.kind, Kind::Number { .. } | Kind::Integer { .. }) {
                    let problem = "this key takes no numbers, so it has no range";
                    return Err(InputError::new(at("key"), key, problem).help("give values = [...]"));
                }
                if from == to || !from.is_finite() || !to.is_finite() {
                    let problem = "the range is empty";
                    return Err(InputError::new(at("to"), to, problem).help("let to differ from from, or give values"));
                }
                if self.spacing == Some(Spacing::Log) && (from <= 0.0 || to <= 0.0) {
                    let problem = "equal ratios need positive ends";
                    return Err(InputError::new(at("from"), from.min(to), problem).help("use spacing = \"linear\""));
                }
                [from, to].iter().try_for_each(|v| check_value(parameter, &self.key, &self.number(*v)))
            }
            _ => Err(InputError::new(at("values"), "", "an axis has either values, or from and to")),
        }
    }

    /// Values that a grid takes.
    ///
    /// # Errors
    /// [`InputError`] for a range without a count.
    pub fn grid(&self, index: usize) -> Result<u64, InputError> {
        if let Some(values) = &self.values {
            return Ok(values.len() as u64);
        }
        match self.count {
            Some(count) if (2..=MOST_VALUES).contains(&count) => Ok(count),
            Some(count) => {
                let problem = format!("a range has 2 to {MOST_VALUES} values");
                Err(InputError::new(format!("axes.{index}.count"), count, problem))
            }
            None => Err(InputError::new(format!("axes.{index}.count"), "", "a range on a grid needs a count")),
        }
    }

    /// The value at a share of the range, or of the list.
    #[must_use]
    pub fn at(&self, share: f64) -> Value {
        if let Some(values) = &self.values {
            let last = values.len().saturating_sub(1);
            return values.get(((share * values.len() as f64) as usize).min(last)).cloned().unwrap_or_default();
        }
        let (from, to) = (self.from.unwrap_or(0.0), self.to.unwrap_or(1.0));
        self.number(match self.spacing {
            _ if share == 0.0 => from,
            _ if share == 1.0 => to,
            Some(Spacing::Log) => from * (to / from).powf(share),
            _ => from + share * (to - from),
        })
    }

    /// A number as the key takes it: whole where it must be.
    #[must_use]
    pub fn number(&self, value: f64) -> Value {
        match parameter(&self.key).map(|p| p.kind) {
            Some(Kind::Integer { .. }) => Value::from(value.round() as i64),
            // Twelve digits, so that 0.1 + 0.2 is the 0.3 that people read.
            _ => Value::from(format!("{value:.11e}").parse::<f64>().unwrap_or(value)),
        }
    }
}

/// Sets a dotted key.
pub(crate) fn set(root: &mut Map<String, Value>, key: &str, value: Value) {
    match key.split_once('.') {
        None => {
            root.insert(key.to_owned(), value);
        }
        Some((table, rest)) => {
            let entry = root.entry(table).or_insert_with(|| Value::Object(Map::new()));
            if let Value::Object(table) = entry {
                set(table, rest, value);
            }
        }
    }
}
