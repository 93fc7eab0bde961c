//! `voxelastica indent`.

use voxelastica_core::fem::{MorphOptions, Resolution};
use voxelastica_core::indentation::output::write;
use voxelastica_core::indentation::solid::{self, SolidOptions};
use voxelastica_core::indentation::{Indentation, elastica};
use voxelastica_core::input::{Bending, IndentationInput, Indenter};
use voxelastica_core::results::pressed;
use voxelastica_core::solver::ccx::{Ccx, Status};
use voxelastica_core::{Design, Error};

use super::work_folder::WorkFolder;
use super::{designed, figures};
use crate::args::{BendingChoice, IndentModel, IndentOptions, IndenterChoice};
use crate::console::Console;

/// Presses a design's dome.
pub fn run(options: &IndentOptions, console: &Console) -> Result<u8, Error> {
    let design = designed(&options.folder, console)?;
    let shown = options.folder.join("design.json").display().to_string();
    let located = |error: Error| error.in_file(&shown);
    let input = parameters(&design, options);
    input.validate().map_err(|e| located(Error::Input(e)))?;
    let bar = console.bar(1000, "{msg} {bar:30} {percent} %", "pressing");
    let progress = |share: f64| {
        bar.set_position((1000.0 * share) as u64);
        !console.is_cancelled()
    };
    let found = match options.model {
        IndentModel::Elastica => elastica::indent(&design, &input, &progress).map_err(Error::from),
        IndentModel::Graded | IndentModel::Voxel => {
            solid::indent(&design, &input, &solids(options, &design), &progress).map_err(Error::from)
        }
        IndentModel::Calculix => by_calculix(&design, &input, options, &progress),
    };
    bar.finish_and_clear();
    let found = found.map_err(located)?;
    report(&found, &design, console);
    let folder = options.output.as_ref().unwrap_or(&options.folder);
    for file in write(&design, &input, std::slice::from_ref(&found), folder)? {
        console.say(format!("written   {}", folder.join(file).display()));
    }
    for warning in &found.warnings {
        console.warn(warning);
    }
    Ok(0)
}

/// Presses one spoke in CalculiX; half of the way is the morph.
fn by_calculix(
    design: &Design,
    input: &IndentationInput,
    options: &IndentOptions,
    progress: &dyn Fn(f64) -> bool,
) -> Result<Indentation, Error> {
    let ccx = Ccx { executable: options.ccx.clone(), ..Ccx::default() };
    let work = WorkFolder::new(options.keep.as_deref())?;
    let steps = |status: Status| progress(0.5 * (status.step.saturating_sub(1) as f64 + status.share));
    pressed::press(design, input, &ccx, work.path(), &steps)
}

fn solids(options: &IndentOptions, design: &Design) -> SolidOptions {
    let resolution = match options.model {
        IndentModel::Voxel => Resolution::Voxels(1),
        _ => Resolution::Graded(design.input().decks.calculix_graded_elements),
    };
    SolidOptions { resolution, neighbours: !options.ignore_neighbours, morph: MorphOptions::default() }
}

/// The design's parameters with what the command line says instead.
fn parameters(design: &Design, options: &IndentOptions) -> IndentationInput {
    let mut input = design.input().indentation.clone().unwrap_or_default();
    input.depth_mm = options.depth.or(input.depth_mm);
    input.indenter_diameter_mm = options.indenter_diameter.or(input.indenter_diameter_mm);
    input.steps = options.steps.unwrap_or(input.steps);
    input.contact_stiffness_n_mm3 = options.contact_stiffness.unwrap_or(input.contact_stiffness_n_mm3);
    input.modulus_band_percent = options.modulus_band.or(input.modulus_band_percent);
    if let Some(indenter) = options.indenter {
        input.indenter = match indenter {
            IndenterChoice::Flat => Indenter::Flat,
            IndenterChoice::Hub => Indenter::Hub,
        };
    }
    if let Some(bending) = options.bending {
        input.bending = match bending {
            BendingChoice::Beam => Bending::Beam,
            BendingChoice::PlaneStrain => Bending::PlaneStrain,
        };
    }
    input
}

fn report(found: &Indentation, design: &Design, console: &Console) {
    let Some(last) = found.curve.last() else { return };
    let thickness = design.input().strips.thickness_mm;
    console.say(format!(
        "force     {} N a spoke at {} mm, {} N on the dome; {} to {} N by {} % ({})",
        figures(last.force_n),
        figures(last.depth_mm),
        figures(last.force_n * found.spokes as f64),
        figures(last.force_n * (1.0 - found.modulus_band_percent / 100.0)),
        figures(last.force_n * (1.0 + found.modulus_band_percent / 100.0)),
        figures(found.modulus_band_percent),
        found.modulus_band_from.describe(),
    ));
    console.say(format!(
        "stiffness K = {} N/mm a spoke (slope up to {thickness} mm), {} N/mm at no depth",
        figures(found.rigidity_n_mm),
        figures(found.tangent_n_mm),
    ));
    console.say(format!(
        "energy    W = {} N mm a spoke, psi = {} N mm/mm^3; strain energy gained {} N mm",
        figures(found.work_nmm),
        figures(found.specific_energy_nmm_mm3),
        figures(found.strain_energy_nmm),
    ));
    let first = found.curve.iter().find(|p| p.contact_force_n > 0.0);
    if let Some(first) = first {
        console.say(format!(
            "contact   from {} mm on; at the end {} N over {} mm of the spoke",
            figures(first.depth_mm),
            figures(last.contact_force_n),
            figures(last.contact_length_mm),
        ));
    }
    for phase in &found.largest_strain {
        let limit = phase.limit.map_or_else(String::new, |l| format!(" of {:.2} %", 100.0 * l));
        let yields = phase.yield_strain.map_or_else(String::new, |y| format!(", yields at {:.2} %", 100.0 * y));
        console.say(format!("strain    at most {:.2} %{limit} in {}{yields}", 100.0 * phase.strain, phase.label));
    }
}
