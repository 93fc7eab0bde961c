//! The design file that varied designs start from.

use std::path::{Path, PathBuf};

use serde_json::{Map, Value};

use super::axis;
use super::input::read_document;
use crate::error::Error;
use crate::input::files::Format;
use crate::input::{DesignInput, InputError};

/// Values, name and folder of a design file. Whether they are right is checked design by design.
#[derive(Debug, Clone)]
pub struct Base {
    root: Map<String, Value>,
    name: String,
    folder: PathBuf,
}

impl Base {
    /// Reads a design file.
    ///
    /// # Errors
    /// [`Error::Input`] for a file that cannot be read or is neither TOML nor JSON.
    pub fn read(path: &Path) -> Result<Self, Error> {
        let document = read_document(path)?;
        let stem = path.file_stem().map_or_else(|| "design".to_owned(), |s| s.to_string_lossy().into_owned());
        let name = document.root.get("name").and_then(Value::as_str).map_or(stem, str::to_owned);
        let folder = path.parent().unwrap_or_else(|| Path::new("")).to_owned();
        Ok(Self { root: document.root, name, folder })
    }

    /// All values.
    #[must_use]
    pub fn root(&self) -> &Map<String, Value> {
        &self.root
    }

    /// The design's name, or the file's.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Kind of the target; empty where there is none.
    #[must_use]
    pub fn target_kind(&self) -> &str {
        self.root.get("target").and_then(|t| t["kind"].as_str()).unwrap_or_default()
    }

    /// A number of the file by its dotted key.
    #[must_use]
    pub fn number(&self, key: &str) -> Option<f64> {
        let (table, name) = key.split_once('.')?;
        self.root.get(table)?.get(name)?.as_f64()
    }

    /// The design with some values instead; errors name it `shown`.
    ///
    /// # Errors
    /// [`InputError`] where the values do not go together.
    pub fn design<'a>(
        &self,
        values: impl Iterator<Item = (&'a str, Value)>,
        name: String,
        shown: &str,
    ) -> Result<DesignInput, InputError> {
        let mut root = self.root.clone();
        values.for_each(|(key, value)| axis::set(&mut root, key, value));
        root.insert("name".to_owned(), name.into());
        DesignInput::from_text(&Value::Object(root).to_string(), Format::Json, shown, &self.name, &self.folder)
    }

    /// Reads a target from a file once, where none of the keys that vary changes what becomes of it; `first` makes any design.
    ///
    /// # Errors
    /// [`InputError`] of that design.
    pub fn settle_target<'a>(
        &mut self,
        mut keys: impl Iterator<Item = &'a str>,
        first: impl FnOnce(&Self) -> Result<DesignInput, InputError>,
    ) -> Result<(), InputError> {
        let changes = |key: &str| {
            key.starts_with("target.") || matches!(key, "strips.length_mm" | "strips.hub_radius_mm" | "strips.count")
        };
        let from_file = self.root.get("target").is_some_and(|t| t.get("file").is_some());
        if !from_file || keys.any(changes) {
            return Ok(());
        }
        if let Ok(target) = serde_json::to_value(&first(self)?.target) {
            self.root.insert("target".to_owned(), target);
        }
        Ok(())
    }
}
