//! Writing a design's files.

use std::ffi::{c_char, c_void};
use std::path::Path;

use voxelastica_core::Design;
use voxelastica_core::output::write::{OutputKind, WriteOptions, Written, write_outputs};

use crate::arguments::{Out, path};
use crate::boundary::enter;
use crate::design::DesignObject;
use crate::error::ErrorObject;
use crate::failure::Failure;
use crate::input::to_json;
use crate::progress::{ProgressCallback, Watch, with_callback};
use crate::registry::{find, keep};
use crate::status::Status;
use crate::text::Text;

/// Kinds of outputs, to be combined with `|`.
#[repr(u32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Output {
    /// `graded_shell.inp` for ABAQUS.
    GradedShell = 1,
    /// `graded_solid.inp` for every solver of the design.
    GradedSolid = 2,
    /// `voxel_solid.inp` for every solver of the design.
    VoxelSolid = 4,
    /// `voxel_shell.inp` for ABAQUS.
    VoxelShell = 8,
    /// `profile.csv` and `slices.csv`.
    Tables = 16,
    /// `report.html`.
    Report = 32,
    /// `design.json`.
    Design = 64,
    /// The files to make the thing that the design asks for (`fabrication.write`).
    Fabrication = 128,
    /// All of them.
    All = 255,
}

/// The kinds behind the bits.
///
/// # Errors
/// [`Failure`] for no bit or an unknown one, and for decks that the design excludes, unless all kinds are asked for.
pub fn kinds(design: &Design, bits: u32) -> Result<Vec<OutputKind>, Failure> {
    if bits == 0 || bits > Output::All as u32 {
        return Err(Failure::range("kinds", bits, "one or several voxelastica_output"));
    }
    let chosen = OutputKind::ALL.iter().enumerate().filter(|(i, _)| bits & (1 << i) != 0).map(|(_, kind)| *kind);
    let kinds: Vec<OutputKind> = chosen.collect();
    let decks = &design.input().decks;
    let missing = |kind: &OutputKind| matches!(kind, OutputKind::Deck(deck) if !decks.write.contains(deck));
    match kinds.iter().find(|kind| missing(kind)) {
        Some(OutputKind::Deck(deck)) if bits != Output::All as u32 => {
            let asked = format!("\"{}\"", deck.name());
            let problem = "the design does not have this deck; name it in decks.write";
            Err(Failure { code: Status::Input, ..Failure::argument(Status::Input, "decks.write", asked, problem) })
        }
        _ => Ok(kinds),
    }
}

/// Writes outputs while being watched.
///
/// # Errors
/// What could not be written, cancellation.
pub fn write(design: &Design, folder: &Path, bits: u32, allow_large: bool, watch: &Watch) -> Result<Written, Failure> {
    let kinds = kinds(design, bits)?;
    let (total, progress) = (|bytes| watch.set_total(bytes), |bytes| watch.report(bytes));
    Ok(write_outputs(design, folder, &kinds, WriteOptions { allow_large }, &total, &progress)?)
}

/// Writes outputs of the kinds `kinds` (`voxelastica_output`, combined) into a folder, which is made where it does not
/// exist. Either all files get their names or none. Of the decks those are written that the design has (`decks.write`,
/// `decks.solvers`). `progress` may be null and is told bytes (of print files, voxels). `files` (null: not
/// wanted) becomes a JSON list of the files' paths relative to the folder. More than the free disk is refused unless `allow_large`.
///
/// # Safety
/// `folder` is null or points to `folder_length` bytes; `progress` may be called with `user` on this thread during the
/// call; `files` and `error` are null or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn voxelastica_design_write(
    design: *const DesignObject,
    folder: *const c_char,
    folder_length: usize,
    kinds: u32,
    allow_large: bool,
    progress: ProgressCallback,
    user: *mut c_void,
    files: *mut *mut Text,
    error: *mut *mut ErrorObject,
) -> Status {
    // SAFETY: by this function's contract.
    unsafe {
        enter(error, || {
            let design = find(design)?;
            let folder = path("folder", folder, folder_length)?;
            if folder.as_os_str().is_empty() {
                return Err(Failure::range("folder", "\"\"", "the path of a folder"));
            }
            let out = if files.is_null() { None } else { Some(Out::new("files", files)?) };
            let work = |watch: &Watch| write(&design.design, &folder, kinds, allow_large, watch);
            let written = with_callback(progress, user, work)?;
            if let Some(out) = out {
                out.set(keep(Text::new(&to_json(&written.files)?)));
            }
            Ok(())
        })
    }
}
