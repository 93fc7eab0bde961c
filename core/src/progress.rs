//! How long work reports and is cancelled.

/// Told how much work is done: bytes written, and print voxels drawn; returning `false` cancels the rest.
pub type Progress<'a> = &'a (dyn Fn(u64) -> bool + Sync);

/// A [`Progress`] that never cancels and shows nothing.
#[must_use]
pub fn ignore(_bytes: u64) -> bool {
    true
}

/// Asked whether work is to stop; from any thread, and often.
pub type Cancelled<'a> = &'a (dyn Fn() -> bool + Sync);

/// A [`Cancelled`] that never is.
#[must_use]
pub fn never() -> bool {
    false
}
