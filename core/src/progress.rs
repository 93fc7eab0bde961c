//! How long work reports and is cancelled.

/// Told how many bytes were written so far; returning `false` cancels the work.
pub type Progress<'a> = &'a (dyn Fn(u64) -> bool + Sync);

/// A [`Progress`] that never cancels and shows nothing.
#[must_use]
pub fn ignore(_bytes: u64) -> bool {
    true
}

/// Told the share done, in `[0, 1]`; returning `false` cancels the work.
pub type Share<'a> = &'a (dyn Fn(f64) -> bool + Sync);

/// A [`Share`] that never cancels and shows nothing.
#[must_use]
pub fn unseen(_share: f64) -> bool {
    true
}

/// Asked whether work is to stop; from any thread, and often.
pub type Cancelled<'a> = &'a (dyn Fn() -> bool + Sync);

/// A [`Cancelled`] that never is.
#[must_use]
pub fn never() -> bool {
    false
}
