//! `voxelastica materials` and `materials fit`.

use std::path::Path;

use voxelastica_core::materials::tensile::{
    Specimen, Statistic, TensileFigures, TensileSample, Window, evaluate, read_curve, to_toml,
};
use voxelastica_core::{Error, InputError};

use super::{figures, lists};
use crate::args::{FitOptions, MaterialsCommand, MaterialsOptions};
use crate::console::Console;

/// Lists the library, or fits a material.
pub fn run(options: &MaterialsOptions, console: &Console) -> Result<u8, Error> {
    match &options.command {
        None => lists::materials(console),
        Some(MaterialsCommand::Fit(options)) => fit(options, console),
    }
}

fn fit(options: &FitOptions, console: &Console) -> Result<u8, Error> {
    let wrong = |error: InputError| Error::Input(error.in_file("materials fit"));
    let specimen = Specimen { gauge_length_mm: options.gauge_length_mm, area_mm2: options.area_mm2 };
    specimen.validate().map_err(wrong)?;
    let window = match options.window.as_deref() {
        Some([low, high]) => Some(Window::new(*low, *high).map_err(wrong)?),
        _ => None,
    };
    let cancelled = || console.is_cancelled();
    let mut specimens = Vec::with_capacity(options.curves.len());
    for path in &options.curves {
        let curve = read_curve(path, &specimen, &cancelled);
        if console.is_cancelled() {
            return Err(Error::Cancelled);
        }
        specimens.push(evaluate(&curve?, window)?);
    }
    let sample = TensileSample::new(specimens).ok_or_else(|| wrong(InputError::new("", "", "no curve is given")))?;
    let material = sample.material(&options.name, options.poisson).map_err(wrong)?;
    let table = to_toml(&material, &sample).map_err(|e| Error::Internal(e.to_string()))?;
    report(&sample, console);
    match &options.output {
        Some(path) => write(path, &table, console)?,
        None => console.answer(table.trim_end()),
    }
    Ok(0)
}

fn write(path: &Path, table: &str, console: &Console) -> Result<(), Error> {
    std::fs::write(path, table).map_err(|error| Error::output(path, &error))?;
    console.note(format!("written   {}", path.display()));
    Ok(())
}

fn report(sample: &TensileSample, console: &Console) {
    for specimen in &sample.specimens {
        one(specimen, console);
    }
    let count = sample.specimens.len();
    if count > 1 {
        console.note(format!("of {count} tests, mean and standard deviation:"));
        console.note(format!("modulus   {} MPa", spread(&sample.modulus_mpa)));
        if let (Some(strength), Some(strain)) = (&sample.yield_strength_mpa, &sample.yield_strain) {
            let some =
                if strength.count < count { format!(", of the {} that yield", strength.count) } else { String::new() };
            console.note(format!("yield     {} MPa at {}{some}", spread(strength), spread(strain)));
        }
        console.note(format!(
            "break     at {}, the first at {}",
            spread(&sample.break_strain),
            figures(sample.least_break_strain)
        ));
    }
    if !sample.all_yield() {
        let which = if count == 1 { "the curve ends" } else { "some curves end" };
        console.note(format!("{which} before the 0.2 % offset: the material gets no yield"));
    }
    for warning in sample.specimens.iter().flat_map(|s| &s.warnings) {
        console.warn(warning);
    }
}

fn one(found: &TensileFigures, console: &Console) {
    console.note(format!(
        "{}: E = {} MPa (R2 = {:.5}, {} rows, {} window {} to {}), zero at {:.5}",
        found.file,
        figures(found.modulus_mpa),
        found.r_squared,
        found.window_rows,
        found.window_choice.name(),
        figures(found.window.low),
        figures(found.window.high),
        found.zero_strain,
    ));
    let yields = found.yield_point.map_or_else(
        || "no 0.2 % offset yield".to_owned(),
        |y| format!("yield {} MPa at {}", figures(y.strength_mpa), figures(y.strain)),
    );
    let after =
        if found.rows_after > 0 { format!("; {} rows after it left out", found.rows_after) } else { String::new() };
    console.note(format!(
        "  {yields}, strength {} MPa, break at {}{after}",
        figures(found.strength_mpa),
        figures(found.break_strain)
    ));
}

fn spread(statistic: &Statistic) -> String {
    let scatter = statistic.standard_deviation.zip(statistic.variation_percent());
    scatter.map_or_else(
        || figures(statistic.mean),
        |(s, percent)| format!("{} +- {} ({percent:.2} %)", figures(statistic.mean), figures(s)),
    )
}
