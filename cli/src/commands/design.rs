//! `voxelastica design`.

use std::path::PathBuf;

use voxelastica_core::input::TargetInput;
use voxelastica_core::output::write::{OutputKind, WriteOptions, Written, write_outputs};
use voxelastica_core::refine::refine;
use voxelastica_core::results::EmbeddedOptions;
use voxelastica_core::{Design, DesignInput, Error, Limits};

use super::figures;
use crate::args::DesignOptions;
use crate::console::{Console, WRITING};

/// Reads, computes and writes a design.
pub fn run(options: &DesignOptions, console: &Console) -> Result<u8, Error> {
    let input = DesignInput::read_unless(&options.file, &|| console.is_cancelled())?;
    let design =
        compute(&input, options, console).map_err(|error| error.in_file(&options.file.display().to_string()))?;
    let folder = options.output.clone().unwrap_or_else(|| PathBuf::from("out").join(&input.name));
    let bar = console.bar(1, WRITING, "writing");
    let progress = |work: u64| {
        bar.set_position(work);
        !console.is_cancelled()
    };
    let allowed = WriteOptions { allow_large: options.yes };
    let total = |work: u64| bar.set_length(work);
    let written = write_outputs(&design, &folder, &OutputKind::ALL, allowed, &total, &progress);
    bar.finish_and_clear();
    let written = written?;
    report(&design, &written, console);
    for warning in design.warnings_for_files() {
        console.warn(warning);
    }
    console.say(format!("written   {}", folder.display()));
    for file in &written.files {
        console.detail(format!("          {file}"));
    }
    Ok(0)
}

/// Computes a design, refined where that was asked for and has not been done yet.
fn compute(input: &DesignInput, options: &DesignOptions, console: &Console) -> Result<Design, Error> {
    let limits = Limits { allow_large: options.yes };
    let recorded = input.refine.as_ref();
    let wanted = recorded.filter(|refine| refine.correction.is_empty()).map_or(0, |refine| refine.iterations);
    let iterations = options.refine.map_or(wanted, usize::from);
    if iterations == 0 {
        return Design::compute_unless(input, limits, &|| console.is_cancelled());
    }
    let mut how = EmbeddedOptions::default();
    if options.yes {
        how.morph.memory_limit = Some(u64::MAX);
    }
    let bar = console.bar(1000, "{msg} [{wide_bar}] {percent} % {elapsed}", "refining");
    let progress = |share: f64| {
        bar.set_position((1000.0 * share) as u64);
        !console.is_cancelled()
    };
    let refined = refine(input, limits, iterations, &how, &progress);
    bar.finish_and_clear();
    refined.map(|refined| refined.design)
}

fn report(design: &Design, written: &Written, console: &Console) {
    let summary = &written.summary;
    let forces = &summary.thrust;
    console.say(format!("design    {} ({})", design.input().name, &written.provenance.design_sha256[..12]));
    console.say(format!("contrast  {:.3} of {:.3} that the phases reach", summary.contrast, summary.contrast_reach));
    if let Some(target) = design.target() {
        if let TargetInput::Mesh { revolution: Some(found), .. } = &design.input().target {
            console.say(format!(
                "mesh      {} % of the rim radius (rms) off a surface of revolution",
                figures(found.rms_percent)
            ));
        }
        if let Some(fit) = &target.fit {
            console.say(format!(
                "meridian  smooth within {} mm of its points (rms {} mm), 1 unit = {} mm",
                figures(fit.residual_max_mm),
                figures(fit.residual_rms_mm),
                figures(fit.scale)
            ));
        }
        console.say(format!(
            "forces    H = {} to {} N a spoke, V = {} to {} N on the hub (beam to plane strain)",
            figures(forces.per_spoke.beam.horizontal_n),
            figures(forces.per_spoke.plane_strain.horizontal_n),
            figures(forces.total.beam.vertical_n),
            figures(forces.total.plane_strain.vertical_n)
        ));
        console.detail(format!(
            "moments   {} N mm at the rim, {} N mm at the hub, a spoke in beam bending",
            figures(forces.per_spoke.beam.rim_moment_nmm),
            figures(forces.per_spoke.beam.hub_moment_nmm)
        ));
    } else if design.guide().is_some() {
        console.say(format!(
            "forces    H = {} to {} N, {} N mm at the ends (beam to plane strain, beam)",
            figures(forces.per_spoke.beam.horizontal_n),
            figures(forces.per_spoke.plane_strain.horizontal_n),
            figures(forces.per_spoke.beam.rim_moment_nmm)
        ));
    }
    let voxels: Vec<String> = summary.voxels.iter().map(|(name, count)| format!("{count} {name}")).collect();
    console.say(format!("voxels    {} a strip: {}", summary.voxels_per_spoke, voxels.join(", ")));
    if let Some(refined) = &summary.refinement {
        console.say(format!(
            "refined   {} % of the length off the target instead of {} %, by {} finite-element solutions",
            figures(refined.error_after_percent),
            figures(refined.error_before_percent),
            refined.solutions
        ));
    }
    if let Some(error) = summary.predicted_error_percent {
        console.say(format!("predicted {} % of the length off the target", figures(error)));
    }
}
