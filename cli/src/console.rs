//! What the user sees: figures, progress, errors; and Ctrl-C.

use std::io::{self, IsTerminal, Write};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use indicatif::{ProgressBar, ProgressStyle};
use voxelastica_core::Error;

/// Progress of writing.
pub const WRITING: &str = "{msg} [{wide_bar}] {percent} % {eta}";

/// The user's end of the command line.
pub struct Console {
    quiet: bool,
    verbose: bool,
    cancelled: Arc<AtomicBool>,
}

impl Console {
    /// A console; from here on Ctrl-C and a termination signal cancel work instead of ending the process at once.
    pub fn new(quiet: bool, verbose: bool) -> Self {
        let cancelled = Arc::new(AtomicBool::new(false));
        let flag = Arc::clone(&cancelled);
        // Without a handler the signal simply ends the process, which leaves nothing under a final name either.
        let _ = ctrlc::set_handler(move || flag.store(true, Ordering::Relaxed));
        Self { quiet, verbose, cancelled }
    }

    /// Prints a line of result, unless quiet.
    pub fn say(&self, line: impl AsRef<str>) {
        if !self.quiet {
            print(line.as_ref());
        }
    }

    /// Prints a line of detail, if verbose.
    pub fn detail(&self, line: impl AsRef<str>) {
        if self.verbose {
            print(line.as_ref());
        }
    }

    /// Prints what was asked for, quiet or not.
    pub fn answer(&self, text: impl AsRef<str>) {
        print(text.as_ref());
    }

    /// Prints a line beside an answer that may be piped elsewhere, unless quiet: to standard error.
    pub fn note(&self, line: impl AsRef<str>) {
        if !self.quiet {
            eprintln!("{}", line.as_ref());
        }
    }

    /// Prints a warning to standard error.
    pub fn warn(&self, line: impl AsRef<str>) {
        if !self.quiet {
            eprintln!("warning: {}", line.as_ref());
        }
    }

    /// Prints an error to standard error.
    pub fn error(&self, error: &Error) {
        eprintln!("error: {error}");
    }

    /// Whether the user wants to stop.
    pub fn is_cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }

    /// A progress bar on a terminal, an invisible one elsewhere.
    pub fn bar(&self, total: u64, template: &str, message: &'static str) -> ProgressBar {
        if self.quiet || !io::stderr().is_terminal() {
            return ProgressBar::hidden();
        }
        let bar = ProgressBar::new(total).with_message(message);
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style.progress_chars("=> "));
        }
        bar
    }
}

/// Prints a line; a reader that went away (`| head`) is no error.
fn print(line: &str) {
    let _ = writeln!(io::stdout(), "{line}");
}
