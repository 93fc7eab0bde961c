//! `voxelastica_design`: a computed design.

use std::ffi::{CString, c_char, c_void};
use std::ptr;
use std::sync::{Arc, OnceLock};

use voxelastica_core::modulus_field::ModulusField;
use voxelastica_core::output::{Provenance, Summary, design_json};
use voxelastica_core::{Design, DesignInput, Limits};

use crate::arguments::{Out, text};
use crate::boundary::{enter, value_or};
use crate::error::{ErrorObject, c_text};
use crate::failure::Failure;
use crate::input::{Input, to_json};
use crate::progress::{ProgressCallback, Watch, with_callback};
use crate::registry::{Handle, find, keep, release};
use crate::status::Status;
use crate::text::Text;

/// A finished design. Immutable: any number of threads may read it at once.
pub struct DesignObject {
    pub(crate) design: Arc<Design>,
    pub(crate) outline: OnceLock<Vec<[f64; 2]>>,
    warnings: Vec<CString>,
}

impl Handle for DesignObject {
    const NAME: &'static str = "design";
}

impl DesignObject {
    pub(crate) fn new(design: Design) -> Self {
        let warnings = design.warnings().iter().map(|w| c_text(w)).collect();
        Self { design: Arc::new(design), outline: OnceLock::new(), warnings }
    }
}

/// Computes a design while being watched.
///
/// # Errors
/// Infeasible designs, unusable targets and voxel sizes, cancellation.
pub fn compute(input: &DesignInput, allow_large: bool, watch: &Watch) -> Result<Design, Failure> {
    Ok(Design::compute_unless(input, Limits { allow_large }, &|| watch.is_cancelled())?)
}

/// One figure of a summary by its dotted name in `design.json`, such as `contrast` or `thrust.total.beam.vertical_n`. NaN
/// where the design has none.
///
/// # Errors
/// [`Failure`] for a name that is no figure.
pub fn figure(design: &Design, name: &str) -> Result<f64, Failure> {
    let summary = serde_json::to_value(Summary::of(design)).map_err(|e| Failure::internal(&e.to_string()))?;
    let value = name.split('.').try_fold(&summary, |value, key| value.get(key));
    match value {
        Some(serde_json::Value::Null) => Ok(f64::NAN),
        Some(value) if value.is_number() => Ok(value.as_f64().unwrap_or(f64::NAN)),
        _ => Err(Failure::range("name", format!("\"{name}\""), "the dotted name of a number in the summary")),
    }
}

/// The whole of `design.json`, but for the list of files.
///
/// # Errors
/// [`Failure`] where a figure cannot be represented.
pub fn document(design: &Design) -> Result<String, Failure> {
    let profile = design.profile();
    let field = ModulusField::fit(&profile.s, &profile.modulus_mpa, design.input().strips.length_mm)
        .map_err(|e| Failure::internal(&format!("the modulus field: {e}")))?;
    let provenance = Provenance::of(design.input());
    to_json(&design_json::document(design, &Summary::of(design), Some(&field), &provenance, &[])?)
}

/// Computes a design; nothing is read or written. More than 200 million voxels are refused unless `allow_large`.
/// `progress` may be null; it is called with `user`. Free the design with `voxelastica_design_free`; the input may go
/// before.
///
/// # Safety
/// `progress` may be called with `user` on this thread during the call; `design` and `error` are null or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn voxelastica_design_compute(
    input: *const Input,
    allow_large: bool,
    progress: ProgressCallback,
    user: *mut c_void,
    design: *mut *mut DesignObject,
    error: *mut *mut ErrorObject,
) -> Status {
    // SAFETY: by this function's contract.
    unsafe {
        enter(error, || {
            let input = find(input)?;
            let out = Out::new("design", design)?;
            let computed = with_callback(progress, user, |watch| compute(&input.0, allow_large, watch))?;
            out.set(keep(DesignObject::new(computed)));
            Ok(())
        })
    }
}

/// The figures that sum the design up, as JSON: `summary` of `design.json`.
///
/// # Safety
/// `json` and `error` are null or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn voxelastica_design_summary(
    design: *const DesignObject,
    json: *mut *mut Text,
    error: *mut *mut ErrorObject,
) -> Status {
    // SAFETY: by this function's contract.
    unsafe {
        enter(error, || {
            let out = Out::new("json", json)?;
            out.set(keep(Text::new(&to_json(&Summary::of(&find(design)?.design))?)));
            Ok(())
        })
    }
}

/// One figure of the summary by its dotted name: `contrast`, `height_mm`, `thrust.per_spoke.beam.horizontal_n`,
/// `volume_mm3.flower`, `voxels.FLX9070` and so on. NaN where the design has none.
///
/// # Safety
/// `name` is null or points to `name_length` bytes; `value` and `error` are null or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn voxelastica_design_figure(
    design: *const DesignObject,
    name: *const c_char,
    name_length: usize,
    value: *mut f64,
    error: *mut *mut ErrorObject,
) -> Status {
    // SAFETY: by this function's contract.
    unsafe {
        enter(error, || {
            let (design, name) = (find(design)?, text("name", name, name_length)?);
            let out = Out::new("value", value)?;
            out.set(figure(&design.design, name)?);
            Ok(())
        })
    }
}

/// The whole result as JSON: what `design.json` holds, but for its list of files.
///
/// # Safety
/// `json` and `error` are null or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn voxelastica_design_json(
    design: *const DesignObject,
    json: *mut *mut Text,
    error: *mut *mut ErrorObject,
) -> Status {
    // SAFETY: by this function's contract.
    unsafe {
        enter(error, || {
            let out = Out::new("json", json)?;
            out.set(keep(Text::new(&document(&find(design)?.design)?)));
            Ok(())
        })
    }
}

/// Number of spokes; 1 for a rectangular strip, 0 if this is not a design.
#[unsafe(no_mangle)]
pub extern "C" fn voxelastica_design_spokes(design: *const DesignObject) -> usize {
    value_or(0, || Ok(find(design)?.design.input().count()))
}

/// Number of warnings: what its user should know about this design.
#[unsafe(no_mangle)]
pub extern "C" fn voxelastica_design_warnings(design: *const DesignObject) -> usize {
    value_or(0, || Ok(find(design)?.warnings.len()))
}

/// A warning, from 0 on; it lives as long as the design. Null where there is none of that index.
#[unsafe(no_mangle)]
pub extern "C" fn voxelastica_design_warning(design: *const DesignObject, index: usize) -> *const c_char {
    value_or(ptr::null(), || Ok(find(design)?.warnings.get(index).map_or(ptr::null(), |w| w.as_ptr())))
}

/// Frees a design; meshes, flowers and paths made of it stay, arrays it lent do not. Null is allowed.
#[unsafe(no_mangle)]
pub extern "C" fn voxelastica_design_free(design: *mut DesignObject) -> Status {
    value_or(Status::BadHandle, || release(design).map(|()| Status::Ok))
}
