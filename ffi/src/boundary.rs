//! Where calls come in: panics stop here, errors become codes and objects.

use std::panic::{AssertUnwindSafe, catch_unwind};

use crate::error::ErrorObject;
use crate::failure::Failure;
use crate::registry::keep;
use crate::status::Status;

/// Runs a call's body. A failure is returned as its code and, where the caller asked for it, as an error object; a panic
/// is a failure of this library.
///
/// # Safety
/// `error` is null or points to writable memory for one pointer.
pub(crate) unsafe fn enter(error: *mut *mut ErrorObject, body: impl FnOnce() -> Result<(), Failure>) -> Status {
    let Err(failure) = run(body) else { return Status::Ok };
    let code = failure.code;
    if !error.is_null() {
        let object = keep(ErrorObject::new(failure));
        // SAFETY: not null, and writable by this function's contract.
        unsafe { error.write(object) };
    }
    code
}

/// A body's result; a panic is a failure.
pub fn run<T>(body: impl FnOnce() -> Result<T, Failure>) -> Result<T, Failure> {
    catch_unwind(AssertUnwindSafe(body)).unwrap_or_else(|payload| {
        let text = payload
            .downcast_ref::<&str>()
            .map(|s| (*s).to_owned())
            .or_else(|| payload.downcast_ref::<String>().cloned())
            .unwrap_or_else(|| "a panic without a message".to_owned());
        // Dropping a payload may panic as well.
        let _ = catch_unwind(AssertUnwindSafe(|| drop(payload)));
        Err(Failure::internal(&text))
    })
}

/// A call that cannot fail but with a panic or a bad handle; then `otherwise`.
pub(crate) fn value_or<T>(otherwise: T, body: impl FnOnce() -> Result<T, Failure>) -> T {
    run(body).unwrap_or(otherwise)
}
