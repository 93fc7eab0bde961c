//! Running CalculiX (`ccx`) on a deck.

use std::fs::{self, File};
use std::io::{ErrorKind, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use crate::error::Error;

/// Lines of the solver's log that are shown when it fails.
const LAST_LINES: usize = 12;

/// Largest result file that is read, bytes.
const LARGEST_RESULT: u64 = 1 << 30;

/// How often the solver's progress is looked at.
const POLL: Duration = Duration::from_millis(50);

/// Where the solver is and how it may work.
#[derive(Debug, Clone)]
pub struct Ccx {
    /// The program: a name that is looked up on `PATH`, or a path.
    pub executable: PathBuf,
    /// Processor cores.
    pub threads: usize,
}

impl Default for Ccx {
    fn default() -> Self {
        let threads = std::thread::available_parallelism().map_or(1, usize::from);
        Self { executable: PathBuf::from("ccx"), threads }
    }
}

/// What a finished run left behind.
#[derive(Debug, Clone)]
pub struct Run {
    /// Contents of the `.dat` file.
    pub dat: String,
    /// Version that the solver reports, such as `2.20`.
    pub version: String,
    /// Wall time, s.
    pub seconds: f64,
    /// Increments that converged.
    pub increments: usize,
    /// Iterations over all increments.
    pub iterations: usize,
}

/// State of a run: the step, the share of it that is done, and the increment.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Status {
    /// Number of the step, from one; zero before the first increment.
    pub step: usize,
    /// Share of the step, 0 to 1.
    pub share: f64,
    /// Number of the increment.
    pub increment: usize,
}

impl Ccx {
    /// Runs a deck in `folder`, into which it is copied as `job.inp`. `progress` is called often; `false` cancels.
    ///
    /// # Errors
    /// [`Error::Solver`] where the program is missing, fails or does not finish the step, with the last lines of its
    /// log; [`Error::Cancelled`].
    pub fn run(&self, deck: &Path, folder: &Path, progress: &dyn Fn(Status) -> bool) -> Result<Run, Error> {
        let version = self.version()?;
        // What an earlier run left behind must not pass for this one's result.
        for ending in ["inp", "log", "sta", "dat", "frd", "cvg", "12d"] {
            let stale = folder.join(format!("job.{ending}"));
            match fs::remove_file(&stale) {
                Err(error) if error.kind() != ErrorKind::NotFound => return Err(Error::output(stale, &error)),
                _ => {}
            }
        }
        let job = folder.join("job.inp");
        fs::copy(deck, &job).map_err(|e| Error::Solver(format!("{} cannot be copied: {e}", deck.display())))?;
        let log_path = folder.join("job.log");
        let log = File::create(&log_path).map_err(|e| Error::output(&log_path, &e))?;
        let errors = log.try_clone().map_err(|e| Error::output(&log_path, &e))?;
        let start = Instant::now();
        let child = Command::new(self.program())
            .arg("job")
            .current_dir(folder)
            .env("OMP_NUM_THREADS", self.threads.to_string())
            .stdin(Stdio::null())
            .stdout(log)
            .stderr(errors)
            .spawn()
            .map_err(|e| self.not_started(&e))?;
        let mut guarded = Running(child);
        let sta = folder.join("job.sta");
        let status = loop {
            match guarded.0.try_wait() {
                Ok(Some(status)) => break status,
                Ok(None) => {}
                Err(error) => return Err(Error::Solver(format!("ccx cannot be watched: {error}"))),
            }
            if !progress(last_status(&sta)) {
                return Err(Error::Cancelled);
            }
            std::thread::sleep(POLL);
        };
        let seconds = start.elapsed().as_secs_f64();
        let log = read_limited(&log_path);
        let rows = status_rows(&read_limited(&sta));
        let reached = rows.last().map_or(0.0, |r| r.step_time);
        let failure = |what: String| {
            let tail = useful_tail(&log);
            Error::Solver(format!("{}: ccx {version} {what}; its last lines:\n{tail}", deck.display()))
        };
        if !status.success() {
            let how = status.code().map_or("was killed".to_owned(), |c| format!("ended with code {c}"));
            return Err(failure(format!("{how} after {:.1} % of the step", 100.0 * reached)));
        }
        if log.contains("*ERROR") {
            return Err(failure("reported an error".to_owned()));
        }
        if reached < 1.0 - 1e-6 {
            return Err(failure(format!("stopped after {:.1} % of the step", 100.0 * reached)));
        }
        Ok(Run {
            dat: read_limited(&folder.join("job.dat")),
            version,
            seconds,
            increments: rows.len(),
            iterations: rows.iter().map(|r| r.iterations).sum(),
        })
    }

    /// The program to start: a bare name is looked up on `PATH`, a path holds wherever the solver works.
    fn program(&self) -> PathBuf {
        if self.executable.components().count() > 1 {
            std::path::absolute(&self.executable).unwrap_or_else(|_| self.executable.clone())
        } else {
            self.executable.clone()
        }
    }

    /// The version the solver reports.
    ///
    /// # Errors
    /// [`Error::Solver`] where the program is missing or cannot be started.
    pub fn version(&self) -> Result<String, Error> {
        let output =
            Command::new(self.program()).arg("-v").stdin(Stdio::null()).output().map_err(|e| self.not_started(&e))?;
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        let version = text.split_whitespace().find(|word| word.starts_with(|c: char| c.is_ascii_digit()));
        match version {
            Some(version) => Ok(version.trim_end_matches('.').to_owned()),
            None => Err(Error::Solver(format!(
                "{} does not answer -v with a version; is it CalculiX? Name the right program with --ccx",
                self.executable.display()
            ))),
        }
    }

    fn not_started(&self, error: &std::io::Error) -> Error {
        let program = self.executable.display();
        Error::Solver(match error.kind() {
            ErrorKind::NotFound => format!(
                "the solver \"{program}\" was not found; install CalculiX (Debian: calculix-ccx) or name it with --ccx PATH"
            ),
            ErrorKind::PermissionDenied => format!("the solver \"{program}\" may not be run; check its permissions"),
            _ => format!("the solver \"{program}\" could not be started: {error}"),
        })
    }
}

/// Ends the solver when dropped, so that neither a cancelled run nor an error leaves it running.
struct Running(Child);

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// One converged increment of the status file.
struct StatusRow {
    step: usize,
    increment: usize,
    iterations: usize,
    step_time: f64,
}

/// Rows of a `.sta` file: step, increment, attempt, iterations, total time, step time, increment of time.
fn status_rows(text: &str) -> Vec<StatusRow> {
    text.lines()
        .filter_map(|line| {
            let cells: Vec<&str> = line.split_whitespace().collect();
            let [step, increment, _, iterations, _, step_time, _] = cells[..] else { return None };
            Some(StatusRow {
                step: step.parse().ok()?,
                increment: increment.parse().ok()?,
                iterations: iterations.parse().ok()?,
                step_time: step_time.parse().ok()?,
            })
        })
        .collect()
}

fn last_status(sta: &Path) -> Status {
    let rows = status_rows(&read_limited(sta));
    rows.last().map_or(Status::default(), |r| Status {
        step: r.step,
        share: r.step_time.clamp(0.0, 1.0),
        increment: r.increment,
    })
}

/// A file's text, its end where it is too large; empty where there is none yet.
fn read_limited(path: &Path) -> String {
    let read = || -> std::io::Result<Vec<u8>> {
        let mut file = File::open(path)?;
        let size = file.metadata()?.len();
        if size > LARGEST_RESULT {
            file.seek(SeekFrom::Start(size - LARGEST_RESULT))?;
        }
        let mut bytes = Vec::new();
        file.take(LARGEST_RESULT).read_to_end(&mut bytes)?;
        Ok(bytes)
    };
    read().map_or_else(|_| String::new(), |bytes| String::from_utf8_lossy(&bytes).into_owned())
}

/// The end of a log without blank lines, preceded by the last lines that report an error.
fn useful_tail(log: &str) -> String {
    let lines: Vec<&str> = log.lines().map(str::trim_end).filter(|l| !l.trim().is_empty()).collect();
    let tail = &lines[lines.len().saturating_sub(LAST_LINES)..];
    let marked = lines[..lines.len() - tail.len()].iter().filter(|l| l.contains("*ERROR"));
    let mut errors: Vec<&str> = marked.copied().collect();
    errors.drain(..errors.len().saturating_sub(3));
    errors.extend(tail);
    errors.iter().map(|l| format!("  {l}")).collect::<Vec<_>>().join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_missing_program_says_what_would_help() {
        let ccx = Ccx { executable: PathBuf::from("/nonexistent/ccx"), threads: 1 };
        let error = ccx.version().unwrap_err();
        assert_eq!(error.exit_code(), 4);
        assert!(error.to_string().contains("--ccx"), "{error}");
    }

    #[test]
    fn status_rows_skip_headers_and_garbage() {
        let text = "SUMMARY OF JOB INFORMATION\n  STEP  INC  ATT  ITRS  TOT TIME  STEP TIME  INC TIME\n\
                    1 1 1 5 0.5E-01 0.5E-01 0.5E-01\n 1 2 1 4 0.100000E+00 0.100000E+00 0.5E-01\n1 x 1 4 0 0 0\n";
        let rows = status_rows(text);
        assert_eq!(rows.len(), 2);
        assert_eq!((rows[1].increment, rows[1].iterations, rows[1].step_time), (2, 4, 0.1));
    }
}
