//! Where an outside solver works.

use std::path::{Path, PathBuf};

use voxelastica_core::Error;

/// A folder that is kept where the user named one, and removed otherwise.
pub enum WorkFolder {
    /// The user's.
    Kept(PathBuf),
    /// Gone with this value.
    Temporary(tempfile::TempDir),
}

impl WorkFolder {
    /// The folder that is to be kept, made where it is missing, or a temporary one.
    pub fn new(keep: Option<&Path>) -> Result<Self, Error> {
        match keep {
            Some(folder) => {
                std::fs::create_dir_all(folder).map_err(|e| Error::output(folder, &e))?;
                Ok(Self::Kept(folder.to_owned()))
            }
            None => Ok(Self::Temporary(tempfile::tempdir().map_err(|e| Error::output(std::env::temp_dir(), &e))?)),
        }
    }

    /// Its path.
    pub fn path(&self) -> &Path {
        match self {
            Self::Kept(folder) => folder,
            Self::Temporary(folder) => folder.path(),
        }
    }
}
