//! A design's files, in the order in which they are written.

use std::fs;
use std::path::Path;

use super::folder::{Staging, WriteFailure, free_bytes};
use super::{Provenance, Summary, design_json, json, tables};
use crate::deck::{self, DeckError, DeckPlan};
use crate::design::Design;
use crate::error::Error;
use crate::progress::Progress;
use crate::{SCHEMA, report};

/// Room that the files other than decks take at most, bytes.
const OTHER_FILES: u64 = 8 << 20;

/// Every file this version may write besides the ones of a verification; an earlier design's are removed if the new one
/// does not have them.
const KNOWN_FILES: [&str; 10] = [
    "design.json",
    "profile.csv",
    "slices.csv",
    "report.html",
    "abaqus/graded_shell.inp",
    "abaqus/graded_solid.inp",
    "abaqus/voxel_solid.inp",
    "abaqus/voxel_shell.inp",
    "calculix/graded_solid.inp",
    "calculix/voxel_solid.inp",
];

/// What may be written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct WriteOptions {
    /// Write even where the estimate exceeds the free disk.
    pub allow_large: bool,
}

/// What was written.
#[derive(Debug, Clone)]
pub struct Written {
    /// The figures that sum up the design.
    pub summary: Summary,
    /// Where the files come from.
    pub provenance: Provenance,
    /// Relative paths, in the order of writing.
    pub files: Vec<String>,
}

/// Writes a design into a folder: decks, tables, report, and `design.json` last. Either all files get their final names
/// or none.
///
/// `progress` is told the bytes written so far and may cancel.
///
/// # Errors
/// [`Error::Output`] naming the file or folder, or the estimate where the disk has no room; [`Error::Cancelled`].
pub fn write_design(
    design: &Design,
    folder: &Path,
    options: WriteOptions,
    progress: Progress<'_>,
) -> Result<Written, Error> {
    let provenance = Provenance::of(design.input());
    let summary = Summary::of(design);
    let profile = design.profile();
    let field = design.modulus_field().map_err(|e| Error::Internal(format!("the modulus field: {e}")))?;
    let decks = deck::plan(design);
    require_room(folder, &decks, options)?;

    let mut files: Vec<(String, String)> = decks.iter().map(|d| (d.relative_path().to_owned(), describe(d))).collect();
    files.push(("profile.csv".to_owned(), format!("the profile at {} stations", profile.s.len())));
    files.push(("slices.csv".to_owned(), format!("counts, modulus and stiffness of {} slices", design.slices().len())));
    files.push(("report.html".to_owned(), "this page".to_owned()));
    files.push(("design.json".to_owned(), "the whole result, for programs".to_owned()));
    let names: Vec<&str> = files.iter().map(|(name, _)| name.as_str()).collect();

    let mut staging = Staging::new(folder)?;
    let mut before = 0;
    for plan in &decks {
        let counted = |bytes: u64| progress(before + bytes);
        staging.write(plan.relative_path(), |out| deck::write(design, plan, &provenance, out, &counted))?;
        before += plan.bytes;
    }
    staging.write("profile.csv", |out| tables::write_profile(design, out))?;
    staging.write("slices.csv", |out| tables::write_slices(design, out))?;
    let page = report::html(design, &summary, Some(field), &provenance, &files)
        .map_err(|e| Error::Internal(format!("the report: {e}")))?;
    staging.write_text("report.html", &page)?;
    let document = design_json::document(design, &summary, Some(field), &provenance, &names)?;
    let text = json::to_text(&document).map_err(|e| Error::Internal(format!("design.json: {e}")))?;
    staging.write("design.json", |out| out.write_all(text.as_bytes()))?;
    if !progress(before + OTHER_FILES) {
        return Err(Error::Cancelled);
    }
    remove_stale(folder, &names);
    staging.commit()?;
    Ok(Written { summary, provenance, files: names.iter().map(|n| (*n).to_owned()).collect() })
}

/// Bytes that writing a design takes, estimated.
#[must_use]
pub fn estimated_bytes(design: &Design) -> u64 {
    OTHER_FILES + deck::plan(design).iter().map(|d| d.bytes).sum::<u64>()
}

fn require_room(folder: &Path, decks: &[DeckPlan], options: WriteOptions) -> Result<(), Error> {
    let needed = OTHER_FILES + decks.iter().map(|d| d.bytes).sum::<u64>();
    match free_bytes(folder) {
        Some(free) if needed > free && !options.allow_large => Err(Error::Output {
            path: folder.to_owned(),
            problem: format!(
                "about {} MB are to be written, but only {} MB are free",
                needed / 1_000_000,
                free / 1_000_000
            ),
            help:
                "use larger voxels, write fewer decks (decks.write), choose another disk with -o, or insist with --yes"
                    .to_owned(),
        }),
        _ => Ok(()),
    }
}

fn describe(plan: &DeckPlan) -> String {
    format!("{} nodes, {} elements", plan.nodes, plan.elements)
}

/// Removes files of an earlier design that the new one does not have. Only names this library writes, and only where its
/// own `design.json` shows that it wrote there.
fn remove_stale(folder: &Path, names: &[&str]) {
    let Ok(text) = fs::read_to_string(folder.join("design.json")) else { return };
    let Ok(old) = serde_json::from_str::<serde_json::Value>(&text) else { return };
    if old["schema"] != SCHEMA {
        return;
    }
    for file in old["files"].as_array().into_iter().flatten().filter_map(serde_json::Value::as_str) {
        if KNOWN_FILES.contains(&file) && !names.contains(&file) {
            let _ = fs::remove_file(folder.join(file));
        }
    }
}

impl From<DeckError> for WriteFailure {
    fn from(error: DeckError) -> Self {
        match error {
            DeckError::Io(error) => Self::Io(error),
            DeckError::Cancelled => Self::Other(Error::Cancelled),
            other => Self::Other(Error::Internal(other.to_string())),
        }
    }
}
