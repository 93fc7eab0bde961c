//! The sweep file.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::axis::AxisInput;
use super::outputs::{OUTPUTS, SweepModel};
use crate::error::Error;
use crate::input::InputError;
use crate::input::document::Document;

/// Most axes.
const MOST_AXES: usize = 16;

/// A sweep: `SWEEP.toml`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SweepInput {
    /// Name; the file's stem where absent.
    #[serde(default)]
    pub name: String,
    /// The design file that every point starts from, relative to this file.
    pub base: String,
    /// What is computed of every point.
    #[serde(default)]
    pub model: SweepModel,
    /// Figures to keep; all that the model has where absent.
    #[serde(default)]
    pub outputs: Vec<String>,
    /// Which values points take.
    #[serde(default)]
    pub sample: SampleInput,
    /// The keys that vary.
    pub axes: Vec<AxisInput>,
    /// Pictures; one for every figure over the first axis where absent.
    #[serde(default)]
    pub plots: Vec<PlotInput>,
}

/// Which values points take.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(tag = "method", rename_all = "kebab-case", deny_unknown_fields)]
pub enum SampleInput {
    /// Every combination; the last axis varies fastest.
    #[default]
    Grid,
    /// As many values of every axis as there are points, each once, combined at random.
    LatinHypercube {
        /// Points.
        points: u64,
        /// Seed.
        #[serde(default = "one")]
        seed: u64,
    },
}

fn one() -> u64 {
    1
}

/// A picture of the table.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlotInput {
    /// An axis' key or a figure.
    pub x: String,
    /// A figure.
    pub y: String,
    /// An axis whose values have colours.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub series: Option<String>,
    /// Decimal logarithms where values span two decades or more, as in charts of materials.
    #[serde(default)]
    pub logarithmic: bool,
}

impl SweepInput {
    /// Reads a sweep file; returns it with its folder and the lines of its keys.
    ///
    /// # Errors
    /// [`Error::Input`] naming file, line, key and value.
    pub fn read(path: &Path) -> Result<(Self, PathBuf, Lines), Error> {
        read_checked(path, "a sweep", |input: &mut Self, stem| {
            if input.name.is_empty() {
                stem.clone_into(&mut input.name);
            }
            input.check()
        })
    }

    fn check(&mut self) -> Result<(), InputError> {
        if self.axes.is_empty() || self.axes.len() > MOST_AXES {
            let problem = format!("a sweep has 1 to {MOST_AXES} axes");
            return Err(InputError::new("axes", self.axes.len(), problem).help("write [[axes]] tables"));
        }
        for (i, axis) in self.axes.iter().enumerate() {
            if self.axes[..i].iter().any(|other| other.key == axis.key) {
                let problem = "this key is on two axes";
                return Err(InputError::new(format!("axes.{i}.key"), format!("\"{}\"", axis.key), problem));
            }
        }
        let known: Vec<&str> = OUTPUTS.iter().filter(|o| self.model.has(o)).map(|o| o.name).collect();
        if self.outputs.is_empty() {
            self.outputs = known.iter().map(|s| (*s).to_owned()).collect();
        }
        for (i, name) in self.outputs.iter().enumerate() {
            if !known.contains(&name.as_str()) {
                return Err(unknown(&format!("outputs.{i}"), name, &known, "the model has no such figure"));
            }
        }
        let columns: Vec<&str> =
            self.axes.iter().map(|a| a.key.as_str()).chain(self.outputs.iter().map(String::as_str)).collect();
        let axes: Vec<&str> = self.axes.iter().map(|a| a.key.as_str()).collect();
        for (i, plot) in self.plots.iter().enumerate() {
            for (key, name, known) in [("x", Some(&plot.x), &columns), ("y", Some(&plot.y), &columns)]
                .into_iter()
                .chain([("series", plot.series.as_ref(), &axes)])
            {
                if let Some(name) = name.filter(|name| !known.contains(&name.as_str())) {
                    return Err(unknown(&format!("plots.{i}.{key}"), name, known, "the table has no such column"));
                }
            }
        }
        Ok(())
    }
}

/// An unknown name, with the closest known one.
pub(crate) fn unknown(key: &str, name: &str, known: &[&str], problem: &str) -> InputError {
    let closest = known
        .iter()
        .map(|k| (strsim::jaro_winkler(k, name), *k))
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .filter(|(likeness, _)| *likeness > 0.75);
    let help = match closest {
        Some((_, name)) => format!("did you mean \"{name}\"?"),
        None => format!("known are: {}", known.join(", ")),
    };
    InputError::new(key, format!("\"{name}\""), problem).help(help)
}

/// Lines of dotted keys.
pub(crate) type Lines = HashMap<String, usize>;

/// Line of a key, or of the table it stands in.
pub(crate) fn line_of(lines: &Lines, key: &str) -> Option<usize> {
    let mut key = key;
    loop {
        if let Some(line) = lines.get(key) {
            return Some(*line);
        }
        key = key.rsplit_once('.')?.0;
    }
}

/// Reads a file of a type and checks it with the file's stem, which may serve as a name; returns it with its folder and the lines of
/// its keys. `what` says in errors what the file should be.
///
/// # Errors
/// [`Error::Input`] naming file, line, key and value.
pub(crate) fn read_checked<T: DeserializeOwned>(
    path: &Path,
    what: &str,
    check: impl FnOnce(&mut T, &str) -> Result<(), InputError>,
) -> Result<(T, PathBuf, Lines), Error> {
    let shown = path.display().to_string();
    let document = read_document(path)?;
    let located = |mut error: InputError| {
        error.line = error.line.or_else(|| line_of(&document.lines, &error.key));
        Error::Input(error.in_file(&shown))
    };
    let mut input: T = serde_json::from_value(Value::Object(document.root.clone())).map_err(|error| {
        let text = error.to_string();
        // What stands in backquotes first is the key that is unknown or missing.
        let key = text.split('`').nth(1).unwrap_or_default().to_owned();
        let mut wrong = InputError::new("", "", format!("this is not {what}: {text}"));
        wrong.line = document.lines.iter().filter(|(k, _)| k.rsplit('.').next() == Some(&key)).map(|(_, l)| *l).min();
        located(wrong)
    })?;
    let stem = path.file_stem().map_or_else(|| what.to_owned(), |s| s.to_string_lossy().into_owned());
    check(&mut input, &stem).map_err(&located)?;
    Ok((input, path.parent().unwrap_or_else(|| Path::new("")).to_owned(), document.lines))
}

pub(super) fn read_document(path: &Path) -> Result<Document, Error> {
    let shown = path.display().to_string();
    let text = crate::input::files::read_text(path, crate::input::document::LARGEST_FILE)
        .map_err(|problem| InputError::new("", "", problem).in_file(&shown))?;
    let parsed = match path.extension() {
        Some(extension) if extension.eq_ignore_ascii_case("json") => Document::from_json(&text),
        _ => Document::from_toml(&text),
    };
    parsed.map_err(|e| Error::Input(e.in_file(&shown)))
}
