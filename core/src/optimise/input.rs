//! The file of an optimisation.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::limits::LimitsInput;
use super::objective::Objective;
use crate::error::Error;
use crate::input::InputError;
use crate::sweep::axis::Spacing;
use crate::sweep::input::{Lines, read_checked};

/// Most variables.
const MOST_VARIABLES: usize = 12;
/// Fewest and most designs.
const EVALUATIONS: [u64; 2] = [16, 1_000_000];

/// An optimisation: `OPTIMISE.toml`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OptimiseInput {
    /// Name; the file's stem where absent.
    #[serde(default)]
    pub name: String,
    /// The design file that every design starts from, relative to this file.
    pub base: String,
    /// What is made as large as possible.
    pub maximise: Objective,
    /// Designs that may be computed.
    #[serde(default = "four_hundred")]
    pub evaluations: u64,
    /// Seed of the search.
    #[serde(default = "one")]
    pub seed: u64,
    /// What must be kept.
    #[serde(default)]
    pub limits: LimitsInput,
    /// The keys that vary.
    pub variables: Vec<VariableInput>,
}

/// A key of the design file that varies: a list of values, or a range.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct VariableInput {
    /// Dotted key of the design file.
    pub key: String,
    /// Values without an order, of any type that the key takes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub values: Option<Vec<Value>>,
    /// First value of a range.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from: Option<f64>,
    /// Last value of a range.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub to: Option<f64>,
    /// Distance of the values in a range; one for whole numbers, the voxels' size for length and thickness where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub step: Option<f64>,
    /// How a range is searched.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub spacing: Option<Spacing>,
}

fn four_hundred() -> u64 {
    400
}

fn one() -> u64 {
    1
}

impl OptimiseInput {
    /// Reads the file; returns it with its folder and the lines of its keys.
    ///
    /// # Errors
    /// [`Error::Input`] naming file, line, key and value.
    pub fn read(path: &Path) -> Result<(Self, PathBuf, Lines), Error> {
        read_checked(path, "an optimisation", |input: &mut Self, stem| {
            if input.name.is_empty() {
                stem.clone_into(&mut input.name);
            }
            input.check()
        })
    }

    fn check(&self) -> Result<(), InputError> {
        if self.variables.is_empty() || self.variables.len() > MOST_VARIABLES {
            let problem = format!("an optimisation has 1 to {MOST_VARIABLES} variables");
            return Err(InputError::new("variables", self.variables.len(), problem).help("write [[variables]] tables"));
        }
        for (i, variable) in self.variables.iter().enumerate() {
            if self.variables[..i].iter().any(|other| other.key == variable.key) {
                let key = format!("\"{}\"", variable.key);
                return Err(InputError::new(format!("variables.{i}.key"), key, "this key varies twice"));
            }
        }
        let [least, most] = EVALUATIONS;
        if !(least..=most).contains(&self.evaluations) {
            let problem = format!("an optimisation computes {least} to {most} designs");
            return Err(InputError::new("evaluations", self.evaluations, problem));
        }
        self.limits.check()
    }
}
