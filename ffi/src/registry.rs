//! Handles: numbers that look like pointers.
//!
//! What a caller holds is never dereferenced. It is looked up, so that a null, freed, foreign or wrongly typed handle is an
//! error and not a crash, and a handle that one thread frees stays alive until another thread's call with it returns.
//! Numbers are never given out twice.

use std::any::Any;
use std::collections::HashMap;
use std::ptr;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, LazyLock, PoisonError, RwLock};

use crate::failure::Failure;
use crate::status::Status;

type Object = Arc<dyn Any + Send + Sync>;

static LIVE: LazyLock<RwLock<HashMap<usize, Object>>> = LazyLock::new(RwLock::default);
static NEXT: AtomicUsize = AtomicUsize::new(1);

/// Distance of two handles: they look aligned, and arithmetic on them does not lead from one to the next.
const STEP: usize = 64;

/// An object that callers hold by a handle.
pub(crate) trait Handle: Any + Send + Sync {
    /// Its name in the interface.
    const NAME: &'static str;
}

/// Makes a handle.
pub(crate) fn keep<T: Handle>(object: T) -> *mut T {
    let number = STEP * NEXT.fetch_add(1, Ordering::Relaxed);
    LIVE.write().unwrap_or_else(PoisonError::into_inner).insert(number, Arc::new(object));
    ptr::without_provenance_mut(number)
}

/// The object behind a handle.
pub(crate) fn find<T: Handle>(handle: *const T) -> Result<Arc<T>, Failure> {
    if handle.is_null() {
        return Err(Failure::argument(Status::NullArgument, T::NAME, "", "this handle is null"));
    }
    let live = LIVE.read().unwrap_or_else(PoisonError::into_inner);
    match live.get(&handle.addr()) {
        Some(object) => Arc::clone(object)
            .downcast()
            .map_err(|_| Failure::argument(Status::BadHandle, T::NAME, "", "this handle is of another type")),
        None => Err(Failure::argument(Status::BadHandle, T::NAME, "", unknown(handle.addr()))),
    }
}

/// Lets an object go. Null is let go without a complaint.
pub(crate) fn release<T: Handle>(handle: *mut T) -> Result<(), Failure> {
    if handle.is_null() {
        return Ok(());
    }
    // Held until the lock is gone: what is dropped may be large.
    let object = find(handle.cast_const())?;
    let removed = LIVE.write().unwrap_or_else(PoisonError::into_inner).remove(&handle.addr());
    drop(object);
    match removed {
        Some(_) => Ok(()),
        None => Err(Failure::argument(Status::BadHandle, T::NAME, "", unknown(handle.addr()))),
    }
}

/// Number of objects that callers hold.
pub(crate) fn count() -> usize {
    LIVE.read().unwrap_or_else(PoisonError::into_inner).len()
}

fn unknown(number: usize) -> &'static str {
    let given = number.is_multiple_of(STEP) && number / STEP < NEXT.load(Ordering::Relaxed);
    if given { "this handle was freed" } else { "this is not a handle" }
}
