//! What `micromechanics` writes: a table of layouts and two plots.

use std::io::Write;
use std::path::Path;

use super::folder::Staging;
use super::tables::number;
use crate::error::Error;
use crate::micromechanics::unit_cell::{Catalogue, Row};
use crate::report::unit_cells::{departure_svg, moduli_svg};

/// Voxels along the edge of a cell up to which every layout has a row of its own; larger cells have one a class.
const EVERY_LAYOUT: usize = 3;

/// Writes `unit_cells.csv`, `unit_cells_modulus.svg` and `unit_cells_departure.svg`, and what `more` adds, all or none.
///
/// # Errors
/// [`Error::Output`] naming the file or folder, [`Error::Internal`] where a figure cannot be drawn, and what `more` returns.
pub fn write_unit_cells(
    cells: &Catalogue,
    folder: &Path,
    more: impl FnOnce(&mut Staging) -> Result<Vec<String>, Error>,
) -> Result<Vec<String>, Error> {
    let drawn = |e: crate::report::ReportError| Error::Internal(format!("the plots of unit cells: {e}"));
    let mut staging = Staging::new(folder)?;
    staging.write("unit_cells.csv", |out| write_csv(cells, out))?;
    staging.write_text("unit_cells_modulus.svg", &moduli_svg(cells).map_err(drawn)?)?;
    staging.write_text("unit_cells_departure.svg", &departure_svg(cells).map_err(drawn)?)?;
    let mut files = ["unit_cells.csv", "unit_cells_modulus.svg", "unit_cells_departure.svg"].map(str::to_owned).to_vec();
    files.extend(more(&mut staging)?);
    staging.commit()?;
    Ok(files)
}

/// Writes one row a layout, or a class where there are too many layouts.
///
/// # Errors
/// What the writer returns.
pub fn write_csv(cells: &Catalogue, out: &mut dyn Write) -> std::io::Result<()> {
    let mut csv = csv::Writer::from_writer(out);
    csv.write_record([
        "layout",
        "class",
        "multiplicity",
        "rigid_fraction",
        "ex_mpa",
        "ey_mpa",
        "ez_mpa",
        "voigt_mpa",
        "reuss_mpa",
        "hashin_shtrikman_lower_mpa",
        "hashin_shtrikman_upper_mpa",
    ])?;
    let size = cells.size();
    let mut write = |row: Row| {
        let [x, y, z] = row.moduli_mpa;
        let [low, high] = row.hashin_shtrikman_mpa;
        let mut record = vec![row.layout.text(size), row.class.text(size), row.multiplicity.to_string()];
        record.extend([row.rigid_fraction, x, y, z, row.voigt_mpa, row.reuss_mpa, low, high].map(number));
        csv.write_record(&record)
    };
    if size.edge() <= EVERY_LAYOUT {
        cells.layouts().try_for_each(&mut write)?;
    } else {
        cells.classes().try_for_each(&mut write)?;
    }
    csv.flush()
}
