//! Writing files such that nothing half-written is ever seen.

use std::fs;
use std::io::{self, BufWriter, Seek, Write};
use std::path::{Path, PathBuf};

use tempfile::{NamedTempFile, TempDir};

use crate::error::Error;

/// Buffer in front of a file, bytes.
const BUFFER: usize = 1 << 20;

/// Files on their way into a folder. They are written under temporary names beside their final places and renamed
/// together by [`Staging::commit`]; dropping it instead removes them and leaves the folder as it was.
#[derive(Debug)]
pub struct Staging {
    root: PathBuf,
    files: Vec<(PathBuf, NamedTempFile)>,
    folders: Vec<StagedFolder>,
    /// Folders that were made for this and are removed again if nothing is committed.
    made: Vec<PathBuf>,
}

impl Staging {
    /// Prepares a folder, making it where it does not exist.
    ///
    /// # Errors
    /// [`Error::Output`] where it cannot be made.
    pub fn new(root: &Path) -> Result<Self, Error> {
        let mut staging = Self { root: root.to_owned(), files: Vec::new(), folders: Vec::new(), made: Vec::new() };
        staging.make(root)?;
        Ok(staging)
    }

    /// Makes a folder and those above it, remembering which were not there.
    fn make(&mut self, folder: &Path) -> Result<(), Error> {
        if folder.as_os_str().is_empty() || folder.is_dir() {
            return Ok(());
        }
        if let Some(parent) = folder.parent() {
            self.make(parent)?;
        }
        match fs::create_dir(folder) {
            Ok(()) => {
                self.made.push(folder.to_owned());
                Ok(())
            }
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists && folder.is_dir() => Ok(()),
            Err(error) => Err(Error::output(folder, &error)),
        }
    }

    /// Writes one file, given by its path relative to the folder.
    ///
    /// # Errors
    /// [`Error::Output`] naming the file, or what `write` returns.
    pub fn write<E>(
        &mut self,
        relative: &str,
        write: impl FnOnce(&mut dyn Destination) -> Result<(), E>,
    ) -> Result<(), Error>
    where
        E: Into<WriteFailure>,
    {
        let path = self.root.join(relative);
        let folder = path.parent().unwrap_or(&self.root).to_owned();
        self.make(&folder)?;
        if path.is_dir() {
            return Err(Error::Output {
                path,
                problem: "a folder stands where a file is to be written".to_owned(),
                help: "move it away or choose another folder with -o".to_owned(),
            });
        }
        let fail = |error: &io::Error| Error::output(&path, error);
        let file = temporary(&folder).map_err(|e| fail(&e))?;
        let mut buffered = BufWriter::with_capacity(BUFFER, file);
        write(&mut buffered).map_err(|failure| match failure.into() {
            WriteFailure::Io(error) => fail(&error),
            WriteFailure::Other(error) => error,
        })?;
        let file = buffered.into_inner().map_err(|e| fail(e.error()))?;
        self.files.push((path, file));
        Ok(())
    }

    /// Writes a text.
    ///
    /// # Errors
    /// [`Error::Output`] naming the file.
    pub fn write_text(&mut self, relative: &str, text: &str) -> Result<(), Error> {
        self.write(relative, |out| out.write_all(text.as_bytes()))
    }

    /// Fills a folder of its own, given by its path relative to the whole one. It appears as a whole: an earlier folder of that
    /// name is replaced, except for files that `is_ours` does not know, which are carried over.
    ///
    /// # Errors
    /// [`Error::Output`] naming the folder, or what `fill` returns.
    pub fn write_folder<T>(
        &mut self,
        relative: &str,
        is_ours: fn(&str) -> bool,
        fill: impl FnOnce(&StagedFolder) -> Result<T, Error>,
    ) -> Result<T, Error> {
        let path = self.root.join(relative);
        let parent = path.parent().unwrap_or(&self.root).to_owned();
        self.make(&parent)?;
        if path.exists() && !path.is_dir() {
            return Err(Error::output(&path, &io::Error::from(io::ErrorKind::AlreadyExists)));
        }
        let made = temporary_folder(&parent).map_err(|e| Error::output(&path, &e))?;
        let folder = StagedFolder { path, made, is_ours };
        let filled = fill(&folder)?;
        self.folders.push(folder);
        Ok(filled)
    }

    /// Gives all files and folders their final names.
    ///
    /// # Errors
    /// [`Error::Output`] naming the first one that could not be renamed.
    pub fn commit(mut self) -> Result<(), Error> {
        for folder in self.folders.drain(..) {
            let path = folder.path.clone();
            folder.place().map_err(|e| Error::output(&path, &e))?;
        }
        for (path, file) in self.files.drain(..) {
            file.persist(&path).map_err(|e| Error::output(&path, &e.error))?;
        }
        self.made.clear();
        Ok(())
    }
}

impl Drop for Staging {
    fn drop(&mut self) {
        self.files.clear();
        self.folders.clear();
        // Only empty folders go; whatever else is in them stays.
        for folder in self.made.iter().rev() {
            let _ = fs::remove_dir(folder);
        }
    }
}

/// What a file is written to; containers go back to fill in what they know last.
pub trait Destination: Write + Seek {}

impl<T: Write + Seek> Destination for T {}

/// A folder in the making, under a temporary name.
#[derive(Debug)]
pub struct StagedFolder {
    path: PathBuf,
    made: TempDir,
    is_ours: fn(&str) -> bool,
}

impl StagedFolder {
    /// Writes one file of the folder; from any thread.
    ///
    /// # Errors
    /// [`Error::Output`] naming the file's final place.
    pub fn write(&self, name: &str, bytes: &[u8]) -> Result<(), Error> {
        fs::write(self.made.path().join(name), bytes).map_err(|e| Error::output(self.path.join(name), &e))
    }

    /// Takes the place of an earlier folder.
    fn place(self) -> io::Result<()> {
        let Self { path, made, is_ours } = self;
        if !path.is_dir() {
            fs::rename(made.path(), &path)?;
            let _ = made.keep();
            return Ok(());
        }
        let parent = path.parent().unwrap_or(Path::new("."));
        let aside = temporary_folder(parent)?;
        let old = aside.path().join("old");
        fs::rename(&path, &old)?;
        if let Err(error) = fs::rename(made.path(), &path) {
            let _ = fs::rename(&old, &path);
            return Err(error);
        }
        let _ = made.keep();
        for entry in fs::read_dir(&old)?.filter_map(Result::ok) {
            let name = entry.file_name();
            let place = path.join(&name);
            if !name.to_str().is_some_and(is_ours) && !place.exists() {
                fs::rename(entry.path(), place)?;
            }
        }
        Ok(())
    }
}

/// What can stop the writing of a file.
pub enum WriteFailure {
    /// The file system.
    Io(io::Error),
    /// Something else.
    Other(Error),
}

impl From<io::Error> for WriteFailure {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

impl From<Error> for WriteFailure {
    fn from(error: Error) -> Self {
        Self::Other(error)
    }
}

fn temporary(folder: &Path) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".voxelastica-").suffix(".tmp");
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder)
}

fn temporary_folder(folder: &Path) -> io::Result<TempDir> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".voxelastica-").suffix(".tmp");
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o777));
    builder.tempdir_in(folder)
}

/// Bytes free where `folder` is or will be; `None` where the system does not say.
#[must_use]
pub fn free_bytes(folder: &Path) -> Option<u64> {
    let absolute = std::path::absolute(folder).ok()?;
    let existing = absolute.ancestors().find(|p| p.is_dir())?;
    fs4::available_space(existing).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_left_behind_unless_committed() {
        let root = tempfile::tempdir().unwrap();
        let target = root.path().join("a/b");
        let mut staging = Staging::new(&target).unwrap();
        staging.write_text("c/one.txt", "1").unwrap();
        let failed = staging.write("two.txt", |_| Err(io::Error::from(io::ErrorKind::StorageFull)));
        assert!(failed.unwrap_err().to_string().contains("disk is full"));
        drop(staging);
        assert!(!root.path().join("a").exists());

        let mut staging = Staging::new(&target).unwrap();
        staging.write_text("c/one.txt", "1").unwrap();
        staging.commit().unwrap();
        assert_eq!(fs::read_to_string(target.join("c/one.txt")).unwrap(), "1");
        assert_eq!(fs::read_dir(target.join("c")).unwrap().count(), 1);
    }

    #[test]
    fn a_folder_appears_as_a_whole_and_keeps_what_is_not_ours() {
        let root = tempfile::tempdir().unwrap();
        let fill = |count: usize| {
            let mut staging = Staging::new(&root.path().join("a")).unwrap();
            let is_ours = |name: &str| name.ends_with(".png");
            let filled = staging.write_folder("b/stack", is_ours, |folder| {
                (0..count).try_for_each(|i| folder.write(&format!("{i}.png"), &[i as u8]))?;
                if count == 0 { Err(Error::Cancelled) } else { Ok(count) }
            });
            filled.map(|count| (count, staging))
        };
        let list = || {
            let mut names: Vec<String> = fs::read_dir(root.path().join("a/b/stack"))
                .unwrap()
                .map(|entry| entry.unwrap().file_name().into_string().unwrap())
                .collect();
            names.sort();
            names
        };
        assert!(matches!(fill(0), Err(Error::Cancelled)));
        assert!(!root.path().join("a").exists());
        let (_, staging) = fill(3).unwrap();
        assert!(!root.path().join("a/b/stack").exists());
        staging.commit().unwrap();
        assert_eq!(list(), ["0.png", "1.png", "2.png"]);
        fs::write(root.path().join("a/b/stack/mine.txt"), "mine").unwrap();
        fill(2).unwrap().1.commit().unwrap();
        assert_eq!(list(), ["0.png", "1.png", "mine.txt"]);
        drop(fill(1).unwrap());
        assert_eq!(list(), ["0.png", "1.png", "mine.txt"]);
        assert_eq!(fs::read_dir(root.path().join("a/b")).unwrap().count(), 1);
    }

    #[test]
    fn a_file_in_the_folders_place_is_named() {
        let root = tempfile::tempdir().unwrap();
        let blocked = root.path().join("out");
        fs::write(&blocked, "mine").unwrap();
        let error = Staging::new(&blocked.join("deep")).unwrap_err();
        assert_eq!(error.exit_code(), 5);
        assert!(error.to_string().contains("out"), "{error}");
        assert_eq!(fs::read_to_string(&blocked).unwrap(), "mine");
    }
}
