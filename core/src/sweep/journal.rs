//! Journals: one line a point, appended as soon as it is known.
//!
//! The first line names the sweep; every other one is a point and its outcome. A line is written whole or, where the process is
//! killed while writing, torn: a torn last line is left out when the journal is read, and the next writer starts a new line
//! after it.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{BufRead, BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};

use super::SweepError;
use super::point::Outcome;
use crate::error::Error;

/// Folder of the journals.
pub const FOLDER: &str = "journal";
/// Version of the format.
const SCHEMA: &str = "voxelastica/sweep-journal/1";
/// How often what was written is forced to the disk, at most: a kill loses nothing anyway, a power cut this much.
const SYNC: Duration = Duration::from_secs(1);
/// Longest line that is read, bytes.
const LONGEST: u64 = 1 << 20;

#[derive(Debug, Serialize, Deserialize)]
struct Header {
    schema: String,
    sweep: String,
}

/// A point and its outcome.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Entry {
    /// Number of the point.
    pub point: u64,
    /// What became of it.
    #[serde(flatten)]
    pub outcome: Outcome,
}

/// A journal that is being written; no other process writes it meanwhile.
#[derive(Debug)]
pub struct Journal {
    path: PathBuf,
    file: File,
    synced: Instant,
}

impl Journal {
    /// Opens a journal of a sweep to append to it, or starts it.
    ///
    /// # Errors
    /// [`Error::Output`]; [`SweepError::Locked`], [`SweepError::Foreign`] as [`Error::Input`].
    pub fn open(folder: &Path, name: &str, sweep: &str) -> Result<Self, Error> {
        let folder = folder.join(FOLDER);
        fs::create_dir_all(&folder).map_err(|e| Error::output(&folder, &e))?;
        let path = folder.join(format!("{name}.jsonl"));
        let failed = |e: &std::io::Error| Error::output(&path, e);
        let mut file = OpenOptions::new().create(true).read(true).append(true).open(&path).map_err(|e| failed(&e))?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => return Err(SweepError::Locked { path }.into()),
            // Some network file systems know no locks; batches have journals of their own there.
            Err(TryLockError::Error(error)) if error.kind() == std::io::ErrorKind::Unsupported => {}
            Err(TryLockError::Error(error)) => return Err(failed(&error)),
        }
        let length = file.metadata().map_err(|e| failed(&e))?.len();
        let mut first = String::new();
        BufReader::new(&file).take(LONGEST).read_line(&mut first).map_err(|e| failed(&e))?;
        if first.ends_with('\n') {
            if !is_of(&first, sweep) {
                return Err(SweepError::Foreign { path }.into());
            }
            // A torn line ends where the next one begins.
            let mut last = [b'\n'];
            file.seek(SeekFrom::Start(length - 1)).and_then(|_| file.read_exact(&mut last)).map_err(|e| failed(&e))?;
            if last != [b'\n'] {
                file.write_all(b"\n").map_err(|e| failed(&e))?;
            }
        } else {
            // Killed before the header was whole.
            file.set_len(0).map_err(|e| failed(&e))?;
            let header = Header { schema: SCHEMA.to_owned(), sweep: sweep.to_owned() };
            let mut line = serde_json::to_string(&header).map_err(|e| Error::Internal(e.to_string()))?;
            line.push('\n');
            file.write_all(line.as_bytes()).map_err(|e| failed(&e))?;
        }
        Ok(Self { path, file, synced: Instant::now() })
    }

    /// Appends a point.
    ///
    /// # Errors
    /// [`Error::Output`].
    pub fn append(&mut self, entry: &Entry) -> Result<(), Error> {
        let mut line = serde_json::to_string(entry).map_err(|e| Error::Internal(e.to_string()))?;
        line.push('\n');
        self.file.write_all(line.as_bytes()).map_err(|e| Error::output(&self.path, &e))?;
        if self.synced.elapsed() >= SYNC {
            self.sync()?;
        }
        Ok(())
    }

    /// Forces what was written to the disk.
    ///
    /// # Errors
    /// [`Error::Output`].
    pub fn sync(&mut self) -> Result<(), Error> {
        self.synced = Instant::now();
        self.file.sync_data().map_err(|e| Error::output(&self.path, &e))
    }
}

fn is_of(header: &str, sweep: &str) -> bool {
    serde_json::from_str::<Header>(header).is_ok_and(|h| h.schema == SCHEMA && h.sweep == sweep)
}

/// Calls `visit` for every point in all journals of a folder.
///
/// # Errors
/// [`SweepError::Foreign`] for a journal of another sweep, [`SweepError::Journal`] for a line that is no entry, as [`Error::Input`];
/// [`Error::Output`] where a journal cannot be read.
pub fn read_all(folder: &Path, sweep: &str, points: u64, mut visit: impl FnMut(Entry)) -> Result<(), Error> {
    let folder = folder.join(FOLDER);
    let entries = match fs::read_dir(&folder) {
        Ok(entries) => entries,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(()),
        Err(error) => return Err(Error::output(&folder, &error)),
    };
    let mut paths: Vec<PathBuf> = entries.flatten().map(|e| e.path()).collect();
    paths.retain(|p| p.extension().is_some_and(|e| e == "jsonl"));
    paths.sort();
    for path in paths {
        read(&path, sweep, points, &mut visit)?;
    }
    Ok(())
}

fn read(path: &Path, sweep: &str, points: u64, visit: &mut impl FnMut(Entry)) -> Result<(), Error> {
    let failed = |e: &std::io::Error| Error::output(path, e);
    let mut reader = BufReader::with_capacity(1 << 18, File::open(path).map_err(|e| failed(&e))?);
    let mut line = Vec::new();
    for number in 1.. {
        line.clear();
        let read = (&mut reader).take(LONGEST).read_until(b'\n', &mut line).map_err(|e| failed(&e))?;
        let whole = line.ends_with(b"\n");
        if read == 0 || (number == 1 && !whole) {
            break;
        }
        let text = String::from_utf8_lossy(&line);
        if number == 1 {
            if !is_of(&text, sweep) {
                return Err(SweepError::Foreign { path: path.to_owned() }.into());
            }
            continue;
        }
        match serde_json::from_str::<Entry>(text.trim_end()) {
            Ok(entry) if entry.point < points => visit(entry),
            Ok(entry) => {
                let problem = format!("point {} of {points}", entry.point);
                return Err(SweepError::Journal { path: path.to_owned(), line: number, problem }.into());
            }
            // Torn by a kill; what stood there is computed again.
            Err(error) if error.is_eof() => {}
            Err(error) => {
                let problem = error.to_string();
                return Err(SweepError::Journal { path: path.to_owned(), line: number, problem }.into());
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;

    fn entry(point: u64) -> Entry {
        let outputs = BTreeMap::from([("contrast".to_owned(), 0.1 + point as f64 / 3.0)]);
        Entry { point, outcome: Outcome::Ok { outputs } }
    }

    #[test]
    fn a_journal_torn_anywhere_keeps_its_whole_lines() {
        let folder = tempfile::tempdir().unwrap();
        let mut journal = Journal::open(folder.path(), "a", "sweep").unwrap();
        (0..4).for_each(|p| journal.append(&entry(p)).unwrap());
        drop(journal);
        let path = folder.path().join("journal/a.jsonl");
        let whole = fs::read(&path).unwrap();
        for length in 0..whole.len() {
            fs::write(&path, &whole[..length]).unwrap();
            let mut journal = Journal::open(folder.path(), "a", "sweep").unwrap();
            journal.append(&entry(9)).unwrap();
            drop(journal);
            let mut found = Vec::new();
            read_all(folder.path(), "sweep", 10, |e| found.push(e)).unwrap();
            let lines = whole[..length].iter().filter(|b| **b == b'\n').count().saturating_sub(1);
            // A line that lacks nothing but its end is whole as well.
            assert!(found.len() == lines + 1 || found.len() == lines + 2, "{length}: {found:?}");
            assert_eq!(found.last(), Some(&entry(9)));
            assert!(found.iter().take(lines).zip(0..).all(|(e, p)| *e == entry(p)));
        }
    }

    #[test]
    fn journals_of_others_and_open_ones_are_left_alone() {
        let folder = tempfile::tempdir().unwrap();
        let open = Journal::open(folder.path(), "a", "sweep").unwrap();
        let error = Journal::open(folder.path(), "a", "sweep").unwrap_err().to_string();
        assert!(error.contains("another process"), "{error}");
        drop(open);
        let error = Journal::open(folder.path(), "a", "other").unwrap_err().to_string();
        assert!(error.contains("another sweep"), "{error}");
        assert!(read_all(folder.path(), "other", 1, |_| {}).is_err());
    }
}
