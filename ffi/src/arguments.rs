//! Arguments as they come in: pointers that may be null, texts that may not be UTF-8.

use std::ffi::c_char;
use std::path::PathBuf;

use crate::failure::Failure;
use crate::status::Status;

/// Largest length that is believed, bytes: beyond it a slice could not exist.
const LARGEST: usize = isize::MAX as usize;

/// A text given by pointer and length; null is an empty text only with length 0.
///
/// # Safety
/// `data` is null or points to `length` readable bytes that do not change during the call.
pub(crate) unsafe fn text<'a>(name: &str, data: *const c_char, length: usize) -> Result<&'a str, Failure> {
    if data.is_null() {
        return if length == 0 { Ok("") } else { Err(null(name)) };
    }
    if length > LARGEST {
        return Err(Failure::argument(Status::WrongLength, name, length, "no text is that long"));
    }
    // SAFETY: not null, readable for `length` bytes by this function's contract.
    let bytes = unsafe { std::slice::from_raw_parts(data.cast::<u8>(), length) };
    std::str::from_utf8(bytes).map_err(|error| {
        let at = format!("this text is not UTF-8, from byte {} on", error.valid_up_to());
        Failure::argument(Status::BadText, name, "", &at)
    })
}

/// A path given as text.
///
/// # Safety
/// As for [`text`].
pub(crate) unsafe fn path(name: &str, data: *const c_char, length: usize) -> Result<PathBuf, Failure> {
    // SAFETY: passed on.
    let text = unsafe { text(name, data, length) }?;
    if text.contains('\0') {
        return Err(Failure::argument(Status::BadText, name, "", "a path holds no zero bytes"));
    }
    Ok(PathBuf::from(text))
}

/// An output; written only once everything else has succeeded.
pub(crate) struct Out<T>(*mut T);

impl<T> Out<T> {
    /// # Safety
    /// `place` is null or writable, and stays so while this lives.
    pub(crate) unsafe fn new(name: &str, place: *mut T) -> Result<Self, Failure> {
        if place.is_null() {
            return Err(null(name));
        }
        if !place.is_aligned() {
            return Err(Failure::argument(Status::NullArgument, name, "", "this pointer is not aligned"));
        }
        Ok(Self(place))
    }

    /// Writes the output.
    pub(crate) fn set(self, value: T) {
        // SAFETY: not null, aligned, writable by the contract of `new`.
        unsafe { self.0.write(value) };
    }
}

/// A caller's buffer of exactly `wanted` values; null where `optional` and of no length.
///
/// # Safety
/// `data` is null or points to `length` writable, initialised values that nothing else uses during the call.
pub(crate) unsafe fn buffer<'a, T>(
    name: &str,
    data: *mut T,
    length: usize,
    wanted: usize,
) -> Result<&'a mut [T], Failure> {
    if data.is_null() && wanted > 0 {
        return Err(null(name));
    }
    exactly(name, length, wanted)?;
    if wanted == 0 {
        return Ok(&mut []);
    }
    if !data.is_aligned() {
        return Err(Failure::argument(Status::NullArgument, name, "", "this pointer is not aligned"));
    }
    // SAFETY: not null, aligned, writable for `length` values by this function's contract.
    Ok(unsafe { std::slice::from_raw_parts_mut(data, length) })
}

/// Checks the length of a buffer.
pub(crate) fn exactly(name: &str, length: usize, wanted: usize) -> Result<(), Failure> {
    if length == wanted {
        return Ok(());
    }
    let problem = format!("this buffer must hold {wanted} values");
    Err(Failure::argument(Status::WrongLength, name, length, &problem))
}

/// A whole number within limits, such as quads along a spoke.
pub(crate) fn within(name: &str, value: usize, least: usize, most: usize) -> Result<usize, Failure> {
    if (least..=most).contains(&value) {
        Ok(value)
    } else {
        Err(Failure::range(name, value, &format!("from {least} to {most}")))
    }
}

/// A fraction of the morph.
pub(crate) fn fraction(value: f64) -> Result<f64, Failure> {
    if (0.0..=1.0).contains(&value) { Ok(value) } else { Err(Failure::range("fraction", value, "from 0 to 1")) }
}

fn null(name: &str) -> Failure {
    Failure::argument(Status::NullArgument, name, "", "this pointer is null")
}
