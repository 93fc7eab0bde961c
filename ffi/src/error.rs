//! `voxelastica_error`: what went wrong in a call.

use std::ffi::{CString, c_char};
use std::ptr;

use crate::boundary::value_or;
use crate::failure::Failure;
use crate::registry::{Handle, find, release};
use crate::status::Status;

/// An error that a call has returned. The caller owns it and frees it with `voxelastica_error_free`. Its texts are UTF-8,
/// end with a zero byte and live as long as the error.
pub struct ErrorObject {
    code: Status,
    line: usize,
    message: CString,
    key: CString,
    value: CString,
    file: CString,
}

impl Handle for ErrorObject {
    const NAME: &'static str = "error";
}

impl ErrorObject {
    pub(crate) fn new(failure: Failure) -> Self {
        Self {
            code: failure.code,
            line: failure.line,
            message: c_text(&failure.message),
            key: c_text(&failure.key),
            value: c_text(&failure.value),
            file: c_text(&failure.file),
        }
    }
}

/// A text with its zero byte; zero bytes within it are shown as what they are.
pub(crate) fn c_text(text: &str) -> CString {
    CString::new(text.replace('\0', "\u{fffd}")).unwrap_or_default()
}

fn field(error: *const ErrorObject, field: fn(&ErrorObject) -> &CString) -> *const c_char {
    value_or(ptr::null(), || Ok(field(&*find(error)?).as_ptr()))
}

/// Code of the error; `VOXELASTICA_STATUS_BAD_HANDLE` if this is not an error.
#[unsafe(no_mangle)]
pub extern "C" fn voxelastica_error_code(error: *const ErrorObject) -> Status {
    value_or(Status::BadHandle, || Ok(find(error)?.code))
}

/// The whole message, as the command line prints it. Null if this is not an error.
#[unsafe(no_mangle)]
pub extern "C" fn voxelastica_error_message(error: *const ErrorObject) -> *const c_char {
    field(error, |e| &e.message)
}

/// Dotted key of the design, such as `voxels.size_mm`, or the name of the argument; empty where there is none. Null if
/// this is not an error.
#[unsafe(no_mangle)]
pub extern "C" fn voxelastica_error_key(error: *const ErrorObject) -> *const c_char {
    field(error, |e| &e.key)
}

/// The offending value as written; empty where there is none. Null if this is not an error.
#[unsafe(no_mangle)]
pub extern "C" fn voxelastica_error_value(error: *const ErrorObject) -> *const c_char {
    field(error, |e| &e.value)
}

/// The file that is wrong or could not be written; empty where there is none. Null if this is not an error.
#[unsafe(no_mangle)]
pub extern "C" fn voxelastica_error_file(error: *const ErrorObject) -> *const c_char {
    field(error, |e| &e.file)
}

/// The line in that file; 0 where there is none.
#[unsafe(no_mangle)]
pub extern "C" fn voxelastica_error_line(error: *const ErrorObject) -> usize {
    value_or(0, || Ok(find(error)?.line))
}

/// Frees an error. Null is allowed.
#[unsafe(no_mangle)]
pub extern "C" fn voxelastica_error_free(error: *mut ErrorObject) -> Status {
    value_or(Status::BadHandle, || release(error).map(|()| Status::Ok))
}
