//! `voxelastica micromechanics`.

use std::path::PathBuf;
use std::time::Instant;

use voxelastica_core::materials::{Material, library};
use voxelastica_core::micromechanics::unit_cell::{
    BrickKind, Catalogue, CellMesh, CellSize, Layout, LoadedFaces, Row, classes,
};
use voxelastica_core::output::unit_cells::write_unit_cells;
use voxelastica_core::{DesignInput, Error, InputError};

use crate::args::{CellChoice, ElementChoice, MicromechanicsOptions};
use crate::console::Console;

/// Poisson's ratio of a phase that is given by its modulus only.
const DEFAULT_POISSON: f64 = 0.3;

/// Tests all layouts of a cell and writes the table and the plots.
pub fn run(options: &MicromechanicsOptions, console: &Console) -> Result<u8, Error> {
    let [soft, rigid] = phases(options)?;
    let size = CellSize::new(match options.cell {
        CellChoice::Two => 2,
        CellChoice::Three => 3,
        CellChoice::Four => 4,
    })?;
    let mesh = CellMesh {
        elements_per_voxel: options.elements_per_voxel.into(),
        element: match options.element {
            ElementChoice::Enhanced => BrickKind::Enhanced,
            ElementChoice::Trilinear => BrickKind::Trilinear,
        },
        faces: if options.clamped { LoadedFaces::Clamped } else { LoadedFaces::Sliding },
    };
    let deck = options.deck.as_deref().map(|text| Layout::read(text, size)).transpose()?;
    let start = Instant::now();
    let bar = console.bar(classes(size).len() as u64, "{msg} [{wide_bar}] {pos}/{len} classes {eta}", "testing");
    let progress = |done: u64| {
        bar.set_position(done);
        !console.is_cancelled()
    };
    let cells = Catalogue::compute(size, [&soft, &rigid], mesh, &progress);
    bar.finish_and_clear();
    let cells = cells?;
    let seconds = start.elapsed().as_secs_f64();
    let folder = options.output.clone().unwrap_or_else(|| PathBuf::from("out").join("micromechanics"));
    let files = write_unit_cells(&cells, deck, &folder)?;
    report(&cells, seconds, console);
    console.say(format!("written   {}", folder.display()));
    for file in files {
        console.detail(format!("          {file}"));
    }
    Ok(0)
}

fn report(cells: &Catalogue, seconds: f64, console: &Console) {
    let [soft, rigid] = cells.phases();
    let size = cells.size();
    let layouts = f64::from(size.layouts());
    console.say(format!(
        "cells     {} layouts of {} in {} classes, {} ({} MPa) and {} ({} MPa)",
        size.layouts(),
        size.name(),
        cells.classes().count(),
        soft.name,
        soft.modulus_mpa,
        rigid.name,
        rigid.modulus_mpa
    ));
    console.detail(format!("          three directions each, {seconds:.2} s"));
    let weight = |wanted: &dyn Fn(&Row) -> bool| {
        cells.classes().filter(|row| wanted(row)).map(|row| row.multiplicity).sum::<u32>()
    };
    let outside = weight(&|row| !row.is_within_bounds());
    let beyond = weight(&|row| !row.is_within_hashin_shtrikman());
    console.say(match outside {
        0 => "bounds    every modulus lies between Reuss and Voigt".to_owned(),
        n => format!("bounds    {n} layouts have a modulus outside Reuss and Voigt"),
    });
    console.say(format!(
        "          {beyond} layouts have one outside Hashin and Shtrikman's, which are for isotropic mixtures"
    ));
    if outside > 0 {
        console.warn("Reuss and Voigt bound cells with equal Poisson's ratios and faces that slide; these are not");
    }
    let departures = cells.departures();
    let farthest = |worst: f64, d: f64| if d.abs() > worst.abs() { d } else { worst };
    let in_plane = departures.iter().flat_map(|d| d.in_plane).fold(0.0, farthest);
    let mean = cells
        .classes()
        .map(|row| f64::from(row.multiplicity) * 0.5 * (row.departure()[0] + row.departure()[1]))
        .sum::<f64>()
        / layouts;
    let through = departures.iter().flat_map(|d| d.across).fold(0.0, farthest);
    let through =
        if through.abs() < 1e-8 { "exactly".to_owned() } else { format!("{:+.2} % at worst", 100.0 * through) };
    console.say(format!(
        "Voigt     along x and y {:+.2} % on average and {:+.2} % at worst; along z {through}",
        100.0 * mean,
        100.0 * in_plane
    ));
}

/// The two phases: from a design, by name, or as numbers.
fn phases(options: &MicromechanicsOptions) -> Result<[Material; 2], Error> {
    if let Some(file) = &options.design {
        let input = DesignInput::read(file)?;
        let phases = input.phase_set()?.phases().to_vec();
        let count = phases.len();
        return phases.try_into().map_err(|_| {
            let error = InputError::new("materials.phases", "", format!("cells have two phases, this design {count}"))
                .help("name two of them with --phases");
            Error::Input(error.in_file(&file.display().to_string()))
        });
    }
    let wrong = |error: InputError| Error::Input(error.in_file("--phases"));
    let [soft, rigid] = match options.phases.as_slice() {
        [soft, rigid] => [soft.as_str(), rigid.as_str()],
        _ => ["FLX9070", "FLX9095"],
    };
    let phases = [phase(soft, "soft").map_err(wrong)?, phase(rigid, "rigid").map_err(wrong)?];
    let [soft, rigid] = &phases;
    if soft.modulus_mpa > rigid.modulus_mpa {
        let problem = format!("{} MPa is stiffer than {} MPa", soft.modulus_mpa, rigid.modulus_mpa);
        return Err(wrong(InputError::new("", "", problem).help("name the soft phase first")));
    }
    if soft.label() == rigid.label() {
        let problem = format!("both phases are called \"{}\"", soft.name);
        return Err(wrong(InputError::new("", "", problem).help("name two materials")));
    }
    Ok(phases)
}

/// `NAME`, `MODULUS` or `MODULUS:POISSON`; numbers make a material of the name `role`.
fn phase(text: &str, role: &str) -> Result<Material, InputError> {
    let known = library();
    if let Some(material) = known.iter().find(|m| m.name.eq_ignore_ascii_case(text)) {
        return Ok(material.clone());
    }
    let (modulus, poisson) = text.split_once(':').map_or((text, None), |(e, nu)| (e, Some(nu)));
    let number = |text: &str| text.trim().parse::<f64>().ok();
    let Some((modulus_mpa, poisson)) = number(modulus).zip(poisson.map_or(Some(DEFAULT_POISSON), number)) else {
        let names: Vec<&str> = known.iter().map(|m| m.name.as_str()).collect();
        return Err(InputError::new("", "", format!("the material \"{text}\" is not known"))
            .help(format!("known are: {}; or write MPa:POISSON, such as 3.1:0.3", names.join(", "))));
    };
    Ok(Material::new(role, modulus_mpa, poisson))
}
