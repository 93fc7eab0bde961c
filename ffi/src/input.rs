//! `voxelastica_input`: a design as its author states it, read and checked.

use std::ffi::{c_char, c_void};
use std::path::Path;

use voxelastica_core::DesignInput;
use voxelastica_core::input::files::Format;
use voxelastica_core::output::{Provenance, json};

use crate::arguments::{Out, path, text};
use crate::boundary::{enter, value_or};
use crate::error::ErrorObject;
use crate::failure::Failure;
use crate::progress::{ProgressCallback, Watch, with_callback};
use crate::registry::{Handle, find, keep, release};
use crate::status::Status;
use crate::text::Text;

/// A design's input: the design file with defaults filled in and the contents of the files it names. Immutable.
pub struct Input(pub(crate) DesignInput);

impl Handle for Input {
    const NAME: &'static str = "input";
}

/// Name of a design that states none and comes from no file.
const DEFAULT_NAME: &str = "design";

/// Reads a design from a text while being watched.
///
/// # Errors
/// What is wrong with the text, naming `shown`, line, key and value; cancellation.
pub fn parse(text: &str, format: Format, shown: &str, folder: &Path, watch: &Watch) -> Result<DesignInput, Failure> {
    let stem = Path::new(shown).file_stem().map(|s| s.to_string_lossy().into_owned());
    let name = stem.filter(|s| !s.is_empty()).unwrap_or_else(|| DEFAULT_NAME.to_owned());
    let shown = if shown.is_empty() { DEFAULT_NAME } else { shown };
    Ok(DesignInput::from_text_unless(text, format, shown, &name, folder, &|| watch.is_cancelled())?)
}

/// Reads a design file while being watched.
///
/// # Errors
/// What is wrong with the file; cancellation.
pub fn read(file: &Path, watch: &Watch) -> Result<DesignInput, Failure> {
    Ok(DesignInput::read_unless(file, &|| watch.is_cancelled())?)
}

/// Reads a design from TOML text. `file` names it in errors, and its stem names a design that has no name (may be empty);
/// relative paths are relative to `folder` (empty: the working folder). `progress` may be null; a large mesh takes seconds.
/// Free the input with `voxelastica_input_free`.
///
/// # Safety
/// Every pointer is null or points to as many bytes as its length says; `progress` may be called with `user` on this
/// thread during the call; `input` and `error` are null or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn voxelastica_input_parse_toml(
    toml: *const c_char,
    toml_length: usize,
    file: *const c_char,
    file_length: usize,
    folder: *const c_char,
    folder_length: usize,
    progress: ProgressCallback,
    user: *mut c_void,
    input: *mut *mut Input,
    error: *mut *mut ErrorObject,
) -> Status {
    // SAFETY: by this function's contract.
    unsafe {
        enter(error, || {
            let toml = text("toml", toml, toml_length)?;
            let (file, folder) = (text("file", file, file_length)?, path("folder", folder, folder_length)?);
            let input = Out::new("input", input)?;
            let work = |watch: &Watch| parse(toml, Format::Toml, file, &folder, watch);
            input.set(keep(Input(with_callback(progress, user, work)?)));
            Ok(())
        })
    }
}

/// As `voxelastica_input_parse_toml`, from JSON text with the TOML's keys, or from a whole `design.json`.
///
/// # Safety
/// As for `voxelastica_input_parse_toml`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn voxelastica_input_parse_json(
    json: *const c_char,
    json_length: usize,
    file: *const c_char,
    file_length: usize,
    folder: *const c_char,
    folder_length: usize,
    progress: ProgressCallback,
    user: *mut c_void,
    input: *mut *mut Input,
    error: *mut *mut ErrorObject,
) -> Status {
    // SAFETY: by this function's contract.
    unsafe {
        enter(error, || {
            let json = text("json", json, json_length)?;
            let (file, folder) = (text("file", file, file_length)?, path("folder", folder, folder_length)?);
            let input = Out::new("input", input)?;
            let work = |watch: &Watch| parse(json, Format::Json, file, &folder, watch);
            input.set(keep(Input(with_callback(progress, user, work)?)));
            Ok(())
        })
    }
}

/// Reads a design file (`.json` as JSON, anything else as TOML) and the files it names. `progress` may be null. Free the
/// input with `voxelastica_input_free`.
///
/// # Safety
/// As for `voxelastica_input_parse_toml`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn voxelastica_input_read(
    file: *const c_char,
    file_length: usize,
    progress: ProgressCallback,
    user: *mut c_void,
    input: *mut *mut Input,
    error: *mut *mut ErrorObject,
) -> Status {
    // SAFETY: by this function's contract.
    unsafe {
        enter(error, || {
            let file = path("file", file, file_length)?;
            let input = Out::new("input", input)?;
            input.set(keep(Input(with_callback(progress, user, |watch: &Watch| read(&file, watch))?)));
            Ok(())
        })
    }
}

/// Checks an input again: ranges and what its keys demand of each other. Reading has done so already; whether mechanics
/// allows the design shows when it is computed.
///
/// # Safety
/// `error` is null or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn voxelastica_input_validate(input: *const Input, error: *mut *mut ErrorObject) -> Status {
    // SAFETY: by this function's contract.
    unsafe { enter(error, || Ok(find(input)?.0.validate()?)) }
}

/// The input as JSON with all defaults filled in: enough to compute the design again, anywhere.
///
/// # Safety
/// `json` and `error` are null or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn voxelastica_input_json(
    input: *const Input,
    json: *mut *mut Text,
    error: *mut *mut ErrorObject,
) -> Status {
    // SAFETY: by this function's contract.
    unsafe {
        enter(error, || {
            let out = Out::new("json", json)?;
            out.set(keep(Text::new(&to_json(&find(input)?.0)?)));
            Ok(())
        })
    }
}

/// SHA-256 of the design in hexadecimal, as in the header of every file it writes.
///
/// # Safety
/// `hash` and `error` are null or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn voxelastica_input_hash(
    input: *const Input,
    hash: *mut *mut Text,
    error: *mut *mut ErrorObject,
) -> Status {
    // SAFETY: by this function's contract.
    unsafe {
        enter(error, || {
            let out = Out::new("hash", hash)?;
            out.set(keep(Text::new(&Provenance::of(&find(input)?.0).design_sha256)));
            Ok(())
        })
    }
}

/// Frees an input; designs computed from it stay. Null is allowed.
#[unsafe(no_mangle)]
pub extern "C" fn voxelastica_input_free(input: *mut Input) -> Status {
    value_or(Status::BadHandle, || release(input).map(|()| Status::Ok))
}

/// A value as JSON text.
///
/// # Errors
/// [`Failure`] where it cannot be represented.
pub fn to_json<T: serde::Serialize>(value: &T) -> Result<String, Failure> {
    json::to_text(value).map_err(|e| Failure::internal(&e.to_string()))
}
