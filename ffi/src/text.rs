//! `voxelastica_text`: a text that a call has made.

use std::ffi::{CString, c_char};
use std::ptr;

use crate::boundary::value_or;
use crate::error::c_text;
use crate::registry::{Handle, find, release};
use crate::status::Status;

/// A text in UTF-8. The caller owns it and frees it with `voxelastica_text_free`.
pub struct Text(CString);

impl Handle for Text {
    const NAME: &'static str = "text";
}

impl Text {
    pub(crate) fn new(text: &str) -> Self {
        Self(c_text(text))
    }
}

/// The text, ended by a zero byte; it lives as long as its handle. Null if this is not a text.
#[unsafe(no_mangle)]
pub extern "C" fn voxelastica_text_data(text: *const Text) -> *const c_char {
    value_or(ptr::null(), || Ok(find(text)?.0.as_ptr()))
}

/// Length of the text in bytes, without the zero byte at its end; 0 if this is not a text.
#[unsafe(no_mangle)]
pub extern "C" fn voxelastica_text_length(text: *const Text) -> usize {
    value_or(0, || Ok(find(text)?.0.as_bytes().len()))
}

/// Frees a text. Null is allowed.
#[unsafe(no_mangle)]
pub extern "C" fn voxelastica_text_free(text: *mut Text) -> Status {
    value_or(Status::BadHandle, || release(text).map(|()| Status::Ok))
}
