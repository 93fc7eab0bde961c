//! The subcommands.

pub mod conduct;
pub mod design;
pub mod fabricate;
pub mod lists;
pub mod micromechanics;
pub mod verify;

use std::path::Path;

use voxelastica_core::{Design, DesignInput, Error, InputError, Limits};

use crate::console::Console;

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
