//! Files to make a design.

use std::ffi::{c_char, c_void};
use std::path::Path;

use voxelastica_core::Design;
use voxelastica_core::fabrication::Fabricated;
use voxelastica_core::input::FabricationKind;
use voxelastica_core::output::write::WriteOptions;

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

/// Kinds of files to make a design, to be combined with `|`; 0 stands for those that the design asks for, or where it asks
/// for none, all that it can have.
#[repr(u32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fabrication {
    /// Closed meshes for printers, one a phase.
    Stl = 1,
    /// A 3MF package.
    ThreeMf = 2,
    /// A folder of PNG slices at a printer's pitch.
    PrintStack = 4,
    /// GrabCAD's container of PNG slices.
    Gcvf = 8,
    /// Cut lines for a laser cutter.
    Dxf = 16,
    /// The same as a drawing.
    Svg = 32,
    /// Hub, base ring and post.
    Assembly = 64,
    /// A preview of the flat and the closed flower.
    Gltf = 128,
}

/// The kinds behind the bits.
///
/// # Errors
/// [`Failure`] for an unknown bit.
pub fn kinds(bits: u32) -> Result<Vec<FabricationKind>, Failure> {
    let known = FabricationKind::ALL;
    if bits >> known.len() != 0 {
        return Err(Failure::range("kinds", bits, "0, or one or several voxelastica_fabrication"));
    }
    Ok(known.into_iter().enumerate().filter(|(i, _)| bits & (1 << i) != 0).map(|(_, kind)| kind).collect())
}

/// Writes files to make a design while being watched.
///
/// # Errors
/// Kinds that do not go with the design, what could not be written, cancellation.
pub fn fabricate(
    design: &Design,
    folder: &Path,
    bits: u32,
    allow_large: bool,
    watch: &Watch,
) -> Result<Fabricated, Failure> {
    let kinds = kinds(bits)?;
    let (total, progress) = (|work| watch.set_total(work), |done| watch.report(done));
    let options = WriteOptions { allow_large };
    Ok(voxelastica_core::fabrication::fabricate(design, folder, &kinds, options, &total, &progress)?)
}

/// Writes files to make a design into the folder `fabrication` of a design's folder: those of the kinds `kinds`
/// (`voxelastica_fabrication`, combined; 0 for the design's own). Either all files get their names or none. `progress` may be
/// null. `files` (null: not wanted) becomes a JSON list of the files' paths relative to the folder. More voxels or bytes than
/// the limits are refused unless `allow_large`.
///
/// # Safety
/// `folder` is null or points to `folder_length` bytes; `progress` may be called with `user` on this thread during the
/// call; `files` and `error` are null or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn voxelastica_design_fabricate(
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
            let work = |watch: &Watch| fabricate(&design.design, &folder, kinds, allow_large, watch);
            let made = with_callback(progress, user, work)?;
            if let Some(out) = out {
                out.set(keep(Text::new(&to_json(&made.files)?)));
            }
            Ok(())
        })
    }
}
