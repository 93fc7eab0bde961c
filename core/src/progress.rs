//! How long work reports and is cancelled.

use std::io::{self, Read};

/// Told how much work is done: bytes written, and print voxels drawn; returning `false` cancels the rest.
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

/// Items of a light loop between two questions whether to stop: about a millisecond's worth.
const BETWEEN: usize = 1 << 14;

/// Most bytes read between two questions.
const PIECE: usize = 1 << 20;

/// Asks at every so many items of a long loop whether to stop there.
#[must_use]
pub(crate) fn stops_at(item: usize, cancelled: Cancelled<'_>) -> bool {
    item.is_multiple_of(BETWEEN) && cancelled()
}

/// A reader that fails once work is cancelled; its caller asks again and then reports the cancellation, not the failure.
pub(crate) struct Watched<'a, R> {
    inner: R,
    cancelled: Cancelled<'a>,
}

impl<'a, R: Read> Watched<'a, R> {
    /// Watches over a reader.
    pub(crate) fn new(inner: R, cancelled: Cancelled<'a>) -> Self {
        Self { inner, cancelled }
    }
}

impl<R: Read> Read for Watched<'_, R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if (self.cancelled)() {
            return Err(io::Error::other("cancelled"));
        }
        let piece = buffer.len().min(PIECE);
        self.inner.read(&mut buffer[..piece])
    }
}
