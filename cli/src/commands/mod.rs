//! The subcommands.

pub mod compare;
pub mod conduct;
pub mod design;
pub mod fabricate;
pub mod indent;
pub mod lists;
pub mod materials;
pub mod micromechanics;
pub mod optimise;
pub mod sweep;
pub mod verify;
mod work_folder;

use std::path::Path;

use voxelastica_core::output::Provenance;
use voxelastica_core::{Design, DesignInput, Error, InputError, Limits};

use crate::console::Console;

/// Exit code where `--target-error` is missed.
const MISSED: u8 = 6;

/// Exit code where no design is feasible.
const INFEASIBLE: u8 = 3;

/// The design that `voxelastica design` wrote into a folder, computed again.
fn designed(folder: &Path, console: &Console) -> Result<Design, Error> {
    let path = folder.join("design.json");
    if !path.is_file() {
        let error = InputError::new("", "", "there is no design.json").help("run voxelastica design first");
        return Err(Error::Input(error.in_file(&folder.display().to_string())));
    }
    let cancelled = || console.is_cancelled();
    let input = DesignInput::read_unless(&path, &cancelled)?;
    Design::compute_unless(&input, Limits { allow_large: true }, &cancelled)
        .map_err(|error| error.in_file(&path.display().to_string()))
}

/// Refuses a `design.json` whose design is not the one that the folder's files were written from.
fn require_unchanged(design: &Design, path: &Path) -> Result<(), Error> {
    let text = std::fs::read_to_string(path).unwrap_or_default();
    let recorded: serde_json::Value = serde_json::from_str(&text).unwrap_or_default();
    match recorded["provenance"]["design_sha256"].as_str() {
        Some(hash) if hash != Provenance::of(design.input()).design_sha256 => {
            let problem = "the design was changed after the files beside it were written";
            let error = InputError::new("design", "", problem).help("run design again");
            Err(Error::Input(error.in_file(&path.display().to_string())))
        }
        _ => Ok(()),
    }
}

/// A number with four significant digits.
pub fn figures(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return "0".to_owned();
    }
    // Rounded first, so that 0.99999 counts as 1.
    let rounded: f64 = format!("{value:.3e}").parse().unwrap_or(value);
    let magnitude = rounded.abs().log10().floor() as i32;
    if (-4..6).contains(&magnitude) {
        format!("{value:.*}", usize::try_from(3 - magnitude).unwrap_or(0))
    } else {
        format!("{value:.3e}")
    }
}
