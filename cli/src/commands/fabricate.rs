//! `voxelastica fabricate`.

use voxelastica_core::Error;
use voxelastica_core::fabrication::{FOLDER, fabricate};
use voxelastica_core::output::write::WriteOptions;

use super::designed;
use crate::args::FabricateOptions;
use crate::console::{Console, WRITING};

/// Makes files of a design that was written before.
pub fn run(options: &FabricateOptions, console: &Console) -> Result<u8, Error> {
    let design = designed(&options.folder, console)?;
    let bar = console.bar(1, WRITING, "making");
    let progress = |work: u64| {
        bar.set_position(work);
        !console.is_cancelled()
    };
    let allowed = WriteOptions { allow_large: options.yes };
    let total = |work: u64| bar.set_length(work);
    let file = options.folder.join("design.json").display().to_string();
    let made = fabricate(&design, &options.folder, &options.only, allowed, &total, &progress);
    bar.finish_and_clear();
    let made = made.map_err(|error| error.in_file(&file))?;
    for (kind, made) in &made.made {
        for (name, what) in &made.listed {
            console.say(format!("{:<12}{name}: {what}", kind.name()));
        }
    }
    if !made.kept.is_empty() {
        console.detail(format!("kept        {}", made.kept.join(", ")));
    }
    console.say(format!("written     {}", options.folder.join(FOLDER).display()));
    for file in &made.files {
        console.detail(format!("            {file}"));
    }
    Ok(0)
}
