//! Solving a design's strip with the finite elements inside the library or with CalculiX, and correcting the design by what
//! they find.

use std::ffi::{c_char, c_void};
use std::path::{Path, PathBuf};

use voxelastica_core::refine::refine;
use voxelastica_core::results::verification::Model;
use voxelastica_core::results::{EmbeddedOptions, Verification, verify_embedded};
use voxelastica_core::solver::ccx::{Ccx, Status as CcxStatus};
use voxelastica_core::{Design, Limits};

use crate::arguments::{Out, path, within};
use crate::boundary::enter;
use crate::design::DesignObject;
use crate::error::ErrorObject;
use crate::failure::Failure;
use crate::input::to_json;
use crate::outputs::{Output, write};
use crate::progress::{ProgressCallback, Watch, with_callback};
use crate::registry::{find, keep};
use crate::status::Status;
use crate::text::Text;

/// Which strip is solved.
#[repr(i32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SolvedModel {
    /// Every voxel its phase.
    Voxel = 0,
    /// Smooth width, graded modulus.
    Graded = 1,
}

/// Most corrections in one refinement.
const MOST_ITERATIONS: usize = 50;

/// The model behind a number.
///
/// # Errors
/// [`Failure`] for a number that is no model.
pub fn model(number: i32) -> Result<Model, Failure> {
    match number {
        0 => Ok(Model::Voxel),
        1 => Ok(Model::Graded),
        _ => Err(Failure::range("model", number, "a voxelastica_solved_model")),
    }
}

/// Solves a design's strip while being watched.
///
/// # Errors
/// A strip that takes no shape or does not fit into memory, an equilibrium that is not found, cancellation.
pub fn verify(design: &Design, model: Model, watch: &Watch) -> Result<Verification, Failure> {
    let options = EmbeddedOptions { model, ..EmbeddedOptions::default() };
    Ok(verify_embedded(design, &options, &watch.shares())?.verification)
}

/// Writes a design's deck into a folder and solves it there with CalculiX while being watched.
///
/// # Errors
/// A design without that deck for CalculiX, a solver that is missing or fails, what could not be written, cancellation.
pub fn verify_ccx(
    design: &Design,
    model: Model,
    folder: &Path,
    executable: PathBuf,
    watch: &Watch,
) -> Result<Verification, Failure> {
    let ccx = Ccx { executable, ..Ccx::default() };
    // A missing program is said before a large deck is written.
    ccx.version()?;
    let deck = match model {
        Model::Voxel => Output::VoxelSolid,
        Model::Graded => Output::GradedSolid,
    };
    write(design, folder, deck as u32, false, watch)?;
    let shares = watch.shares();
    let progress = |status: CcxStatus| shares(status.share);
    Ok(voxelastica_core::results::verify(design, folder, model, &ccx, folder, &progress)?)
}

/// Corrects a design while being watched.
///
/// # Errors
/// Those of [`verify`], and a number of iterations out of range.
pub fn refined(design: &Design, iterations: usize, allow_large: bool, watch: &Watch) -> Result<Design, Failure> {
    within("iterations", iterations, 1, MOST_ITERATIONS)?;
    let options = EmbeddedOptions::default();
    Ok(refine(design.input(), Limits { allow_large }, iterations, &options, &watch.shares())?.design)
}

/// Solves one spoke with the finite elements inside the library and compares its mid-line with the target; nothing is read
/// or written. `model` is a `voxelastica_solved_model`. `json` becomes what `verification.json` holds: errors, reactions,
/// strains, the mid-line. `progress` may be null and is told thousandths; cancelling waits for a factorisation under way.
///
/// # Safety
/// `progress` may be called with `user` on this thread during the call; `json` and `error` are null or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn voxelastica_design_verify(
    design: *const DesignObject,
    model: i32,
    progress: ProgressCallback,
    user: *mut c_void,
    json: *mut *mut Text,
    error: *mut *mut ErrorObject,
) -> Status {
    // SAFETY: by this function's contract.
    unsafe {
        enter(error, || {
            let (design, out) = (find(design)?, Out::new("json", json)?);
            let model = self::model(model)?;
            let found = with_callback(progress, user, |watch| verify(&design.design, model, watch))?;
            out.set(keep(Text::new(&to_json(&found)?)));
            Ok(())
        })
    }
}

/// Solves one spoke with CalculiX and compares its mid-line with the target: `voxelastica_design_verify` with another solver.
/// `ccx` is the program, a path or a name that is looked up on `PATH` (empty: `ccx`). The deck and the solver's files are
/// written into `folder`, which is the caller's to remove. The design must have the model's deck (`decks.write`) for CalculiX
/// (`decks.solvers`). Cancelling ends the solver.
///
/// # Safety
/// `ccx` and `folder` are null or point to as many bytes as their lengths say; `progress` may be called with `user` on this
/// thread during the call; `json` and `error` are null or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn voxelastica_design_verify_ccx(
    design: *const DesignObject,
    model: i32,
    ccx: *const c_char,
    ccx_length: usize,
    folder: *const c_char,
    folder_length: usize,
    progress: ProgressCallback,
    user: *mut c_void,
    json: *mut *mut Text,
    error: *mut *mut ErrorObject,
) -> Status {
    // SAFETY: by this function's contract.
    unsafe {
        enter(error, || {
            let (design, out) = (find(design)?, Out::new("json", json)?);
            let model = self::model(model)?;
            let program = match path("ccx", ccx, ccx_length)? {
                program if program.as_os_str().is_empty() => PathBuf::from("ccx"),
                program => program,
            };
            let folder = path("folder", folder, folder_length)?;
            if folder.as_os_str().is_empty() {
                return Err(Failure::range("folder", "\"\"", "the path of a folder"));
            }
            let work = |watch: &Watch| verify_ccx(&design.design, model, &folder, program, watch);
            out.set(keep(Text::new(&to_json(&with_callback(progress, user, work)?)?)));
            Ok(())
        })
    }
}

/// Corrects a design's modulus by what its voxels really do, at most `iterations` times (1 to 50), and gives the best design
/// found: a new one, to be freed by `voxelastica_design_free`. Its summary holds the error before and after. `progress` may
/// be null and is told thousandths.
///
/// # Safety
/// `progress` may be called with `user` on this thread during the call; `refined` and `error` are null or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn voxelastica_design_refine(
    design: *const DesignObject,
    iterations: usize,
    allow_large: bool,
    progress: ProgressCallback,
    user: *mut c_void,
    refined: *mut *mut DesignObject,
    error: *mut *mut ErrorObject,
) -> Status {
    // SAFETY: by this function's contract.
    unsafe {
        enter(error, || {
            let (design, out) = (find(design)?, Out::new("refined", refined)?);
            let work = |watch: &Watch| self::refined(&design.design, iterations, allow_large, watch);
            out.set(keep(DesignObject::new(with_callback(progress, user, work)?)));
            Ok(())
        })
    }
}

/// The input of a design as a handle of its own, with what a refinement recorded in it. Free it with
/// `voxelastica_input_free`.
///
/// # Safety
/// `input` and `error` are null or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn voxelastica_design_input(
    design: *const DesignObject,
    input: *mut *mut crate::input::Input,
    error: *mut *mut ErrorObject,
) -> Status {
    // SAFETY: by this function's contract.
    unsafe {
        enter(error, || {
            let (design, out) = (find(design)?, Out::new("input", input)?);
            out.set(keep(crate::input::Input(design.design.input().clone())));
            Ok(())
        })
    }
}
