//! A design's files, in the order in which they are written.

use std::fs;
use std::path::Path;

use super::folder::{Staging, WriteFailure, free_bytes};
use super::{Provenance, Summary, design_json, json, tables};
use crate::deck::{self, DeckError, DeckPlan};
use crate::design::Design;
use crate::error::Error;
use crate::fabrication::record::Earlier;
use crate::fabrication::{self, Plan};
use crate::input::{DeckKind, DeckSolver};
use crate::progress::Progress;
use crate::{SCHEMA, report};

/// Room that the files other than decks take at most, bytes.
const OTHER_FILES: u64 = 8 << 20;

/// Every file this version may write besides the ones of a verification; an earlier design's are removed if the new one
/// does not have them.
const KNOWN_FILES: [&str; 19] = [
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
    "abaqus/voxel_heat.inp",
    "abaqus/graded_heat.inp",
    "abaqus/voxel_current.inp",
    "abaqus/graded_current.inp",
    "calculix/voxel_heat.inp",
    "calculix/graded_heat.inp",
    "nastran/voxel_solid.bdf",
    "nastran/graded_solid.bdf",
    FRACTIONS,
];

/// Fractions along the spoke, for programs that read a mesh and interpolate.
const FRACTIONS: &str = "nastran/fractions.csv";

/// What may be written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct WriteOptions {
    /// Write even where the estimate exceeds the free disk.
    pub allow_large: bool,
}

/// A kind of output.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OutputKind {
    /// One of the mechanical decks and those of heat and current on its mesh, for every solver the design names.
    Deck(DeckKind),
    /// `profile.csv` and `slices.csv`.
    Tables,
    /// `report.html`.
    Report,
    /// `design.json`.
    Design,
    /// The files to make the thing that the design asks for (`fabrication.write`).
    Fabrication,
}

impl OutputKind {
    /// All kinds. The order is that of the bits in the C ABI: new ones come last, whenever they are written.
    pub const ALL: [Self; 8] = [
        Self::Deck(DeckKind::GradedShell),
        Self::Deck(DeckKind::GradedSolid),
        Self::Deck(DeckKind::VoxelSolid),
        Self::Deck(DeckKind::VoxelShell),
        Self::Tables,
        Self::Report,
        Self::Design,
        Self::Fabrication,
    ];
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

/// Writes a design into a folder: decks, files to make it, tables, report, and `design.json` last. Either all files get their
/// final names or none.
///
/// `progress` is told the work done so far, in bytes written and print voxels drawn, and may cancel.
///
/// # Errors
/// [`Error::Output`] naming the file or folder, or the estimate where the disk has no room; [`Error::Cancelled`].
pub fn write_design(
    design: &Design,
    folder: &Path,
    options: WriteOptions,
    progress: Progress<'_>,
) -> Result<Written, Error> {
    write_outputs(design, folder, &OutputKind::ALL, options, &|_| {}, progress)
}

/// Writes some kinds of a design's outputs into a folder, as [`write_design`] does. Decks are those of the kinds asked for
/// that the design has (`decks.write`, `decks.solvers`), and so are the files to make it (`fabrication.write`). Files of an
/// earlier design are removed only where all kinds are written. `total` is told once how much work that will be, about.
///
/// # Errors
/// Those of [`write_design`].
pub fn write_outputs(
    design: &Design,
    folder: &Path,
    kinds: &[OutputKind],
    options: WriteOptions,
    total: &dyn Fn(u64),
    progress: Progress<'_>,
) -> Result<Written, Error> {
    let provenance = Provenance::of(design.input());
    let summary = Summary::of(design);
    let profile = design.profile();
    let wants = |kind: OutputKind| kinds.contains(&kind);
    let field = if wants(OutputKind::Report) || wants(OutputKind::Design) {
        Some(design.modulus_field().map_err(|e| Error::Internal(format!("the modulus field: {e}")))?)
    } else {
        None
    };
    // The bytes done are none: asking is all that this is about.
    let mut decks = deck::plan_unless(design, &|| !progress(0)).map_err(|_| Error::Cancelled)?;
    decks.retain(|d| wants(OutputKind::Deck(d.kind.mesh())));
    let fractions = decks.iter().any(|d| d.solver == DeckSolver::Nastran);
    let fabrication = match wants(OutputKind::Fabrication) {
        true => Some(Plan::of_design(design, &provenance, options.allow_large)?),
        false => None,
    };
    let estimate = fabrication.as_ref().map(Plan::estimate).unwrap_or_default();
    let bytes = OTHER_FILES + decks.iter().map(|d| d.bytes).sum::<u64>();
    total(bytes + estimate.work());
    if !progress(0) {
        return Err(Error::Cancelled);
    }
    require_room(folder, bytes + estimate.bytes, options)?;

    let mut staging = Staging::new(folder)?;
    let mut before = 0;
    for plan in &decks {
        let counted = |bytes: u64| progress(before + bytes);
        staging.write(&plan.relative_path(), |out| deck::write(design, plan, &provenance, out, &counted))?;
        before += plan.bytes;
    }
    let earlier = Earlier::read(folder);
    let made = match &fabrication {
        Some(plan) => {
            let counted = |work: u64| progress(before + work);
            fabrication::stage(plan, design, &provenance, &earlier, &mut staging, &counted)?
        }
        None => fabrication::Fabricated::default(),
    };
    before += estimate.work();

    let mut files: Vec<(String, String)> = decks.iter().map(|d| (d.relative_path(), describe(d))).collect();
    files.extend(made.made.iter().flat_map(|(_, made)| made.listed.iter().cloned()));
    if fractions {
        files.push((FRACTIONS.to_owned(), "fractions of the phases along the spoke".to_owned()));
    }
    let mut others = |kind: OutputKind, name: &str, what: String| {
        if wants(kind) {
            files.push((name.to_owned(), what));
        }
    };
    let slices = design.slices().len();
    others(OutputKind::Tables, "profile.csv", format!("the profile at {} stations", profile.s.len()));
    others(OutputKind::Tables, "slices.csv", format!("counts, modulus and stiffness of {slices} slices"));
    others(OutputKind::Report, "report.html", "this page".to_owned());
    others(OutputKind::Design, "design.json", "the whole result, for programs".to_owned());
    // The page lists groups of files, the record every one.
    let is_group = |name: &&str| made.made.iter().any(|(_, made)| made.listed.iter().any(|(group, _)| group == name));
    let paths: Vec<String> = decks.iter().map(DeckPlan::relative_path).collect();
    let mut names: Vec<&str> = paths.iter().map(String::as_str).collect();
    names.extend(made.files.iter().map(String::as_str));
    names.extend(files.iter().skip(decks.len()).map(|(name, _)| name.as_str()).filter(|name| !is_group(name)));
    if fractions {
        staging.write(FRACTIONS, |out| tables::write_fractions(design, out))?;
    }
    if wants(OutputKind::Tables) {
        staging.write("profile.csv", |out| tables::write_profile(design, out))?;
        staging.write("slices.csv", |out| tables::write_slices(design, out))?;
    }
    if wants(OutputKind::Report) {
        let page = report::html(design, &summary, field, &provenance, &files)
            .map_err(|e| Error::Internal(format!("the report: {e}")))?;
        staging.write_text("report.html", &page)?;
    }
    if wants(OutputKind::Design) {
        let document = design_json::document(design, &summary, field, &provenance, &names)?;
        let text = json::to_text(&document).map_err(|e| Error::Internal(format!("design.json: {e}")))?;
        staging.write("design.json", |out| out.write_all(text.as_bytes()))?;
    }
    if !progress(before + OTHER_FILES) {
        return Err(Error::Cancelled);
    }
    if OutputKind::ALL.iter().all(|kind| wants(*kind)) {
        remove_stale(folder, &names);
        earlier.remove(folder, &made.files, &earlier.staying(&provenance, &made.made));
    }
    staging.commit()?;
    Ok(Written { summary, provenance, files: names.iter().map(|n| (*n).to_owned()).collect() })
}

/// Refuses what the disk has no room for, unless that was insisted on.
pub(crate) fn require_room(folder: &Path, needed: u64, options: WriteOptions) -> Result<(), Error> {
    match free_bytes(folder) {
        Some(free) if needed > free && !options.allow_large => Err(Error::Output {
            path: folder.to_owned(),
            problem: format!(
                "about {} MB are to be written, but only {} MB are free",
                needed / 1_000_000,
                free / 1_000_000
            ),
            help:
                "use larger voxels, write fewer decks (decks.write) or files to make it (fabrication.write), choose another \
                 disk with -o, or insist with --yes"
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
