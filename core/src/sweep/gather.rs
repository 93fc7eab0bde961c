//! From journals to the table and its pictures.

use std::path::Path;

use serde_json::{Map, Value, json};

use super::journal::read_all;
use super::outputs::describe;
use super::plots::pictures;
use super::table::{Status, Table};
use super::{Sweep, SweepError};
use crate::error::Error;
use crate::output::folder::Staging;
use crate::output::json;

/// Name and version of the format of `sweep.json`.
pub const SCHEMA: &str = "voxelastica/sweep/1";

/// Reads all journals of a folder.
///
/// # Errors
/// Those of [`read_all`].
pub fn read<'a>(sweep: &'a Sweep, folder: &Path) -> Result<Table<'a>, Error> {
    let mut table = Table::new(sweep);
    read_all(folder, sweep.hash(), sweep.points(), |entry| table.insert(entry))?;
    Ok(table)
}

/// Writes `results.csv`, `results.parquet`, `sweep.json` and the pictures; all of them appear together. Returns their names.
///
/// # Errors
/// [`SweepError::Missing`] where points are missing and `partial` does not allow it, as [`Error::Input`]; [`Error::Output`].
pub fn write(table: &Table<'_>, folder: &Path, partial: bool) -> Result<Vec<String>, Error> {
    let sweep = table.sweep();
    let missing = table.count(Status::Missing);
    if missing > 0 && !partial {
        let first = table.first_missing(5);
        return Err(SweepError::Missing { missing, points: sweep.points(), first }.into());
    }
    let mut staging = Staging::new(folder)?;
    staging.write("results.csv", |out| table.write_csv(out))?;
    let mut bytes = Vec::new();
    table.write_parquet(&mut bytes).map_err(|e| Error::Internal(format!("results.parquet: {e}")))?;
    staging.write("results.parquet", |out| out.write_all(&bytes))?;
    let mut files = vec!["results.csv".to_owned(), "results.parquet".to_owned()];
    for (name, svg) in pictures(table)? {
        let name = format!("plots/{name}.svg");
        staging.write_text(&name, &svg)?;
        files.push(name);
    }
    let columns: Map<String, Value> = sweep
        .input()
        .axes
        .iter()
        .map(|a| &a.key)
        .chain(&sweep.input().outputs)
        .map(|name| (name.clone(), describe(name).into()))
        .collect();
    let states = [Status::Ok, Status::Infeasible, Status::Failed, Status::Missing];
    let counts: Map<String, Value> = states.iter().map(|s| (s.name().to_owned(), table.count(*s).into())).collect();
    files.push("sweep.json".to_owned());
    let document = json!({
        "schema": SCHEMA,
        "version": env!("CARGO_PKG_VERSION"),
        "sweep_sha256": sweep.hash(),
        "name": sweep.input().name,
        "sweep": sweep.input(),
        "points": sweep.points(),
        "status": counts,
        "columns": columns,
        "files": files,
    });
    let text = json::to_text(&document).map_err(|e| Error::Internal(format!("sweep.json: {e}")))?;
    staging.write_text("sweep.json", &text)?;
    staging.commit()?;
    Ok(files)
}
