//! The subcommands.

pub mod design;
pub mod fabricate;
pub mod lists;
pub mod verify;

use std::path::Path;

use voxelastica_core::{Design, DesignInput, Error, InputError, Limits};

/// The design that `voxelastica design` wrote into a folder, computed again.
fn designed(folder: &Path) -> Result<Design, Error> {
    let path = folder.join("design.json");
    if !path.is_file() {
        let error = InputError::new("", "", "there is no design.json").help("run voxelastica design first");
        return Err(Error::Input(error.in_file(&folder.display().to_string())));
    }
    Design::compute(&DesignInput::read(&path)?, Limits { allow_large: true })
        .map_err(|error| error.in_file(&path.display().to_string()))
}
