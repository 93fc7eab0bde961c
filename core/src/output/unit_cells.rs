//! What `micromechanics` writes: a table of layouts and two plots.

use std::io::Write;
use std::path::Path;

use super::Provenance;
use super::folder::Staging;
use super::tables::number;
use crate::deck::unit_cell::UnitCellDeck;
use crate::error::Error;
use crate::input::DeckSolver;
use crate::input::files::hex_sha256;
use crate::micromechanics::unit_cell::{Catalogue, Layout, Row};
use crate::report::unit_cells::{departure_svg, moduli_svg};

/// Voxels along the edge of a cell up to which every layout has a row of its own; larger cells have one a class.
const EVERY_LAYOUT: usize = 3;

/// Writes `unit_cells.csv`, `unit_cells_modulus.svg` and `unit_cells_departure.svg`, and decks of one layout where one is
/// named: all files or none.
///
/// # Errors
/// [`Error::Output`] naming the file or folder, [`Error::Internal`] where a figure cannot be drawn.
pub fn write_unit_cells(cells: &Catalogue, deck: Option<Layout>, folder: &Path) -> Result<Vec<String>, Error> {
    let drawn = |e: crate::report::ReportError| Error::Internal(format!("the plots of unit cells: {e}"));
    let mut staging = Staging::new(folder)?;
    staging.write("unit_cells.csv", |out| write_csv(cells, out))?;
    staging.write_text("unit_cells_modulus.svg", &moduli_svg(cells).map_err(drawn)?)?;
    staging.write_text("unit_cells_departure.svg", &departure_svg(cells).map_err(drawn)?)?;
    let mut files =
        ["unit_cells.csv", "unit_cells_modulus.svg", "unit_cells_departure.svg"].map(str::to_owned).to_vec();
    let provenance = provenance(cells);
    let [soft, rigid] = cells.phases();
    if let Some(layout) = deck {
        for solver in [DeckSolver::Abaqus, DeckSolver::Calculix] {
            for axis in 0..3 {
                let (size, mesh, phases) = (cells.size(), cells.mesh(), [soft, rigid]);
                let deck = UnitCellDeck { size, layout, phases, mesh, axis, solver };
                staging.write(&deck.relative_path(), |out| deck.write(&provenance, out))?;
                files.push(deck.relative_path());
            }
        }
    }
    staging.commit()?;
    Ok(files)
}

/// Where the decks come from: the hash is that of phases, cell and mesh.
fn provenance(cells: &Catalogue) -> Provenance {
    let [soft, rigid] = cells.phases();
    let text = serde_json::json!({ "cell": cells.size().name(), "mesh": cells.mesh(), "phases": [soft, rigid] });
    let design_sha256 = hex_sha256(text.to_string().as_bytes());
    Provenance { version: env!("CARGO_PKG_VERSION").to_owned(), seed: 0, design_sha256 }
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
