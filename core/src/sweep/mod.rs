//! Many designs: every point of a grid or a Latin hypercube over the keys of a design file, in one table.
//!
//! - [`input`] is the sweep file; [`axis`] the values of one key; [`sampling`] which values a point takes;
//! - [`outputs`] are the figures of a point and the models that have them; [`point`] computes one;
//! - [`journal`] keeps every point as soon as it is known, so that a run can be killed at any moment and several machines can
//!   share the work; [`run`] computes what the journals lack;
//! - [`table`] gathers journals into CSV and Parquet, [`plots`] draws them.
//!
//! **Guaranteed**: the gathered table depends on the sweep alone, not on when, where, in which order or how often its points
//! were computed. It holds no times and no machine's name.

pub mod axis;
pub mod base;
mod error;
pub mod gather;
pub mod input;
pub mod journal;
pub mod outputs;
pub mod plots;
pub mod point;
pub mod run;
pub mod sampling;
pub mod table;

pub use error::SweepError;
pub use input::SweepInput;
pub use outputs::SweepModel;

use std::path::Path;

use serde_json::{Value, json};

use crate::error::Error;
use crate::input::files::hex_sha256;
use crate::input::{DesignInput, InputError};
use base::Base;
use sampling::Sampling;

/// Points above which a sweep is refused unless it was asked for explicitly.
pub const MANY_POINTS: u64 = 1_000_000;
/// Points that no sweep may have.
pub const MOST_POINTS: u64 = 100_000_000;

/// A sweep that is ready to be computed.
#[derive(Debug, Clone)]
pub struct Sweep {
    input: SweepInput,
    sampling: Sampling,
    base: Base,
    hash: String,
}

impl Sweep {
    /// Reads a sweep file, and the design file that it starts from.
    ///
    /// # Errors
    /// [`Error::Input`] naming file, line, key and value.
    pub fn read(path: &Path) -> Result<Self, Error> {
        let (input, folder, lines) = SweepInput::read(path)?;
        let shown = path.display().to_string();
        let base = Base::read(&folder.join(&input.base))?;
        let located = |mut error: InputError| {
            error.line = error.line.or_else(|| input::line_of(&lines, &error.key));
            Error::Input(error.in_file(&shown))
        };
        let sampling = Sampling::new(&input).map_err(&located)?;
        let mut sweep = Self { input, sampling, base, hash: String::new() };
        sweep.check_axes().map_err(&located)?;
        sweep.settle_target()?;
        sweep.hash = sweep.hashed();
        Ok(sweep)
    }

    /// The sweep file.
    #[must_use]
    pub fn input(&self) -> &SweepInput {
        &self.input
    }

    /// Hash of everything that decides the table: the design, the axes, the model and the version.
    #[must_use]
    pub fn hash(&self) -> &str {
        &self.hash
    }

    /// Number of points.
    #[must_use]
    pub fn points(&self) -> u64 {
        self.sampling.points()
    }

    /// Values of a point, one an axis.
    #[must_use]
    pub fn values(&self, point: u64) -> Vec<Value> {
        self.sampling.values(point)
    }

    /// The design of a point.
    ///
    /// # Errors
    /// [`InputError`] where the point's values do not go together.
    pub fn design_input(&self, point: u64) -> Result<DesignInput, InputError> {
        let name = format!("{}_{point}", self.base.name());
        let keys = self.input.axes.iter().map(|axis| axis.key.as_str());
        self.base.design(keys.zip(self.values(point)), name, &format!("point {point}"))
    }

    fn check_axes(&self) -> Result<(), InputError> {
        let kind = self.base.target_kind();
        self.input.axes.iter().enumerate().try_for_each(|(i, axis)| axis.check(&format!("axes.{i}"), kind))
    }

    /// A target from a file is read once where no axis changes what it becomes.
    fn settle_target(&mut self) -> Result<(), Error> {
        if self.points() == 0 {
            return Ok(());
        }
        let mut base = self.base.clone();
        base.settle_target(self.input.axes.iter().map(|axis| axis.key.as_str()), |_| self.design_input(0))?;
        self.base = base;
        Ok(())
    }

    fn hashed(&self) -> String {
        let content = self.design_input(0).ok().and_then(|input| serde_json::to_value(&input.target).ok());
        let mut base = self.base.root().clone();
        if let (Some(target), Some(content)) = (base.get_mut("target").and_then(Value::as_object_mut), content) {
            target.remove("file");
            target.insert("content".to_owned(), content["content_sha256"].clone());
        }
        let what = json!({
            "version": env!("CARGO_PKG_VERSION"),
            "base": base,
            "model": self.input.model,
            "outputs": self.input.outputs,
            "axes": self.input.axes,
            "sample": self.input.sample,
        });
        hex_sha256(what.to_string().as_bytes())
    }
}
