//! `voxelastica design`.

use std::path::PathBuf;

use voxelastica_core::output::write::{WriteOptions, Written, estimated_bytes, write_design};
use voxelastica_core::{Design, DesignInput, Error, Limits};

use crate::args::DesignOptions;
use crate::console::Console;

/// Reads, computes and writes a design.
pub fn run(options: &DesignOptions, console: &Console) -> Result<u8, Error> {
    let input = DesignInput::read(&options.file)?;
    let design = Design::compute(&input, Limits { allow_large: options.yes })
        .map_err(|error| error.in_file(&options.file.display().to_string()))?;
    let folder = options.output.clone().unwrap_or_else(|| PathBuf::from("out").join(&input.name));
    let bar = console.bar(estimated_bytes(&design), "{msg} [{wide_bar}] {bytes}/{total_bytes} {eta}", "writing");
    let progress = |bytes: u64| {
        bar.set_position(bytes);
        !console.is_cancelled()
    };
    let written = write_design(&design, &folder, WriteOptions { allow_large: options.yes }, &progress);
    bar.finish_and_clear();
    let written = written?;
    report(&design, &written, console);
    for warning in design.warnings() {
        console.warn(warning);
    }
    console.say(format!("written   {}", folder.display()));
    for file in &written.files {
        console.detail(format!("          {file}"));
    }
    Ok(0)
}

fn report(design: &Design, written: &Written, console: &Console) {
    let summary = &written.summary;
    let forces = &summary.thrust;
    console.say(format!("design    {} ({})", design.input().name, &written.provenance.design_sha256[..12]));
    console.say(format!("contrast  {:.3} of {:.3} that the phases reach", summary.contrast, summary.contrast_reach));
    console.say(format!(
        "forces    H = {:.4} to {:.4} N a spoke, V = {:.4} to {:.4} N on the hub (beam to plane strain)",
        forces.per_spoke.beam.horizontal_n,
        forces.per_spoke.plane_strain.horizontal_n,
        forces.total.beam.vertical_n,
        forces.total.plane_strain.vertical_n
    ));
    console.detail(format!(
        "moments   {:.3} N mm at the rim, {:.3} N mm at the hub, a spoke in beam bending",
        forces.per_spoke.beam.rim_moment_nmm, forces.per_spoke.beam.hub_moment_nmm
    ));
    let voxels: Vec<String> = summary.voxels.iter().map(|(name, count)| format!("{count} {name}")).collect();
    console.say(format!("voxels    {} a spoke: {}", summary.voxels_per_spoke, voxels.join(", ")));
    if let Some(error) = summary.predicted_error_percent {
        console.say(format!("predicted {error:.3} % of the length off the target"));
    }
}
