//! Long work that reports and is cancelled.

use std::ffi::c_void;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

use crate::boundary::run;
use crate::failure::Failure;

/// How often the caller is told, and so how soon a wish to cancel is known.
const INTERVAL: Duration = Duration::from_millis(20);

/// Told how far work is: `done` of `total`, in a unit of the work's own; `total` is 0 where it is not known. Called on the
/// thread that made the call, about fifty times a second. Returning `false` cancels the work. It must not unwind.
pub type ProgressCallback = Option<unsafe extern "C" fn(user: *mut c_void, done: u64, total: u64) -> bool>;

/// What work sees of its caller.
#[derive(Debug, Default)]
pub struct Watch {
    cancelled: AtomicBool,
    done: AtomicU64,
    total: AtomicU64,
}

impl Watch {
    /// Whether to stop.
    #[must_use]
    pub fn is_cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }

    /// Asks the work to stop.
    pub fn cancel(&self) {
        self.cancelled.store(true, Ordering::Relaxed);
    }

    /// States how much there is to do.
    pub fn set_total(&self, total: u64) {
        self.total.store(total, Ordering::Relaxed);
    }

    /// States how much is done; whether to go on.
    #[must_use]
    pub fn report(&self, done: u64) -> bool {
        self.done.store(done, Ordering::Relaxed);
        !self.is_cancelled()
    }

    /// What work that counts in shares of the whole tells, in thousandths.
    pub fn shares(&self) -> impl Fn(f64) -> bool + Sync + '_ {
        self.set_total(1000);
        |share| self.report((1000.0 * share.clamp(0.0, 1.0)) as u64)
    }

    /// How much is done, and how much there is to do.
    #[must_use]
    pub fn state(&self) -> (u64, u64) {
        (self.done.load(Ordering::Relaxed), self.total.load(Ordering::Relaxed))
    }
}

/// Does work on a thread of its own while `tell` hears of it on this one, until it is done or `tell` returns `false`.
///
/// # Errors
/// What the work returns.
pub fn watched<T: Send>(
    tell: impl FnMut(u64, u64) -> bool,
    work: impl FnOnce(&Watch) -> Result<T, Failure> + Send,
) -> Result<T, Failure> {
    let mut tell = tell;
    let watch = Watch::default();
    std::thread::scope(|scope| {
        let (sender, receiver) = channel();
        let watch = &watch;
        let worker = std::thread::Builder::new().name("voxelastica".to_owned()).spawn_scoped(scope, move || {
            let _ = sender.send(run(|| work(watch)));
        });
        worker.map_err(|e| Failure::internal(&format!("no thread could be started: {e}")))?;
        loop {
            match receiver.recv_timeout(INTERVAL) {
                Ok(result) => {
                    if result.is_ok() {
                        let (done, total) = watch.state();
                        let _ = tell(done.max(total), total);
                    }
                    return result;
                }
                Err(RecvTimeoutError::Timeout) => {
                    let (done, total) = watch.state();
                    if !watch.is_cancelled() && !tell(done, total) {
                        watch.cancel();
                    }
                }
                Err(RecvTimeoutError::Disconnected) => {
                    return Err(Failure::internal("the work ended without a result"));
                }
            }
        }
    })
}

/// [`watched`] for a callback of C; without one the work is done at once on this thread.
///
/// # Safety
/// `callback` may be called with `user` on this thread while the call lasts, and does not unwind.
pub(crate) unsafe fn with_callback<T: Send>(
    callback: ProgressCallback,
    user: *mut c_void,
    work: impl FnOnce(&Watch) -> Result<T, Failure> + Send,
) -> Result<T, Failure> {
    match callback {
        None => work(&Watch::default()),
        // SAFETY: by this function's contract.
        Some(callback) => watched(|done, total| unsafe { callback(user, done, total) }, work),
    }
}
