//! Checks of a custom material that comes from elsewhere than a design file.

use serde_json::Value;

use super::InputError;
use super::check::check_value;
use super::parameters::parameter;
use crate::materials::Material;

/// Longest name of a material in element sets; solvers take labels of 80 characters.
const LONGEST_LABEL: usize = 60;

impl Material {
    /// Types and ranges of all values, and whether element sets can be named by it.
    ///
    /// # Errors
    /// [`InputError`] naming the key within the material.
    pub fn validate(&self) -> Result<(), InputError> {
        // Numbers that are not finite have no place in JSON and become null.
        if let Ok(Value::Object(table)) = serde_json::to_value(self) {
            for (name, value) in &table {
                if let Some(parameter) = parameter(&format!("materials.custom.{name}")) {
                    check_value(parameter, name, value)?;
                }
            }
        }
        self.check_label("name")
    }

    /// Whether element sets can be named by the material's label; `key` is where its name stands.
    pub(super) fn check_label(&self, key: &str) -> Result<(), InputError> {
        let (value, length) = (format!("\"{}\"", self.name), self.label().len());
        if length == 0 {
            let problem = "the name has no letter or digit of the English alphabet to name element sets by";
            return Err(InputError::new(key, value, problem).help("rename the material"));
        }
        if length > LONGEST_LABEL {
            let problem = format!("names have at most {LONGEST_LABEL} letters and digits, for solvers' labels");
            return Err(InputError::new(key, value, problem).help("shorten the material's name"));
        }
        Ok(())
    }
}
