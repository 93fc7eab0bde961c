//! Reading design files and the files they name.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use sha2::{Digest, Sha256};

use super::document::{Document, LARGEST_FILE};
use super::model::DesignInput;
use super::{InputError, check::check};
use crate::error::Error;
use crate::progress::{Cancelled, Watched, never};

/// Bytes hashed between two questions whether to stop.
const HASHED: usize = 1 << 20;

/// How a design is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// TOML.
    Toml,
    /// JSON with the TOML's keys, or a whole `design.json`.
    Json,
}

impl DesignInput {
    /// Reads a design file (`.json` as JSON, anything else as TOML) and the files it names.
    ///
    /// # Errors
    /// [`InputError`] naming file, line, key and value.
    pub fn read(path: &Path) -> Result<Self, InputError> {
        uncancelled(Self::read_unless(path, &never))
    }

    /// As [`Self::read`], but gives up once `cancelled` says so: a large mesh takes seconds.
    ///
    /// # Errors
    /// [`Error::Input`] naming file, line, key and value; [`Error::Cancelled`].
    pub fn read_unless(path: &Path, cancelled: Cancelled<'_>) -> Result<Self, Error> {
        let shown = path.display().to_string();
        let text = read_text(path, LARGEST_FILE).map_err(|problem| InputError::new("", "", problem).in_file(&shown))?;
        let format = match path.extension() {
            Some(extension) if extension.eq_ignore_ascii_case("json") => Format::Json,
            _ => Format::Toml,
        };
        let stem = path.file_stem().map_or_else(|| "design".to_owned(), |s| s.to_string_lossy().into_owned());
        let folder = path.parent().unwrap_or_else(|| Path::new(""));
        Self::from_text_unless(&text, format, &shown, &stem, folder, cancelled)
    }

    /// Reads a design from a text. `shown` names it in errors, `default_name` is the design's name where it has none,
    /// relative paths are relative to `folder`.
    ///
    /// # Errors
    /// [`InputError`] naming file, line, key and value.
    pub fn from_text(
        text: &str,
        format: Format,
        shown: &str,
        default_name: &str,
        folder: &Path,
    ) -> Result<Self, InputError> {
        uncancelled(Self::from_text_unless(text, format, shown, default_name, folder, &never))
    }

    /// As [`Self::from_text`], but gives up once `cancelled` says so.
    ///
    /// # Errors
    /// [`Error::Input`] naming file, line, key and value; [`Error::Cancelled`].
    pub fn from_text_unless(
        text: &str,
        format: Format,
        shown: &str,
        default_name: &str,
        folder: &Path,
        cancelled: Cancelled<'_>,
    ) -> Result<Self, Error> {
        let parsed = match format {
            Format::Toml => Document::from_toml(text),
            Format::Json => Document::from_json(text),
        };
        let mut document = parsed.map_err(|e| e.in_file(shown))?;
        check(&mut document, shown)?;
        document.root.entry("name").or_insert_with(|| default_name.into());
        let Document { root, lines } = document;
        let mut input: Self = serde_json::from_value(serde_json::Value::Object(root))
            .map_err(|error| InputError::new("", "", format!("this is not a design: {error}")).in_file(shown))?;
        let located = |mut error: InputError| {
            error.line = error.line.or_else(|| lines.get(&error.key).copied());
            // Entries of lists have no line of their own: take that of the list.
            error.line =
                error.line.or_else(|| error.key.rsplit_once('.').and_then(|(list, _)| lines.get(list)).copied());
            error.in_file(shown)
        };
        input.validate().map_err(located)?;
        if input.indentation.is_some() {
            let phases = input.phase_set().map_err(located)?;
            input.indentation.iter_mut().for_each(|indentation| indentation.fill_band(phases.phases()));
        }
        if let Some(thrust) = &mut input.thrust {
            thrust.choice = Some(thrust.resolved_choice());
        }
        input.load_target(folder, cancelled).map_err(|error| match error {
            Error::Input(error) => Error::Input(located(error)),
            other => other,
        })?;
        Ok(input)
    }
}

/// The input error of work that nothing cancels.
fn uncancelled(read: Result<DesignInput, Error>) -> Result<DesignInput, InputError> {
    read.map_err(|error| match error {
        Error::Input(error) => error,
        other => InputError::new("", "", other.to_string()),
    })
}

/// Hexadecimal SHA-256.
#[must_use]
pub fn hex_sha256(bytes: &[u8]) -> String {
    hex(&Sha256::digest(bytes))
}

/// As [`hex_sha256`], but `None` once `cancelled` says so.
pub(crate) fn hex_sha256_unless(bytes: &[u8], cancelled: Cancelled<'_>) -> Option<String> {
    let mut hasher = Sha256::new();
    for piece in bytes.chunks(HASHED) {
        if cancelled() {
            return None;
        }
        hasher.update(piece);
    }
    Some(hex(&hasher.finalize()))
}

fn hex(digest: &[u8]) -> String {
    digest.iter().map(|b| format!("{b:02x}")).collect()
}

pub(crate) fn read_text(path: &Path, largest: u64) -> Result<String, String> {
    String::from_utf8(read_bytes(path, largest, &never)?).map_err(|error| {
        let line = 1 + error.as_bytes()[..error.utf8_error().valid_up_to()].iter().filter(|b| **b == b'\n').count();
        format!("line {line} is not UTF-8 text")
    })
}

/// Reads a file of limited size; the limit is checked before memory is taken and while reading.
pub(crate) fn read_bytes(path: &Path, largest: u64, cancelled: Cancelled<'_>) -> Result<Vec<u8>, String> {
    let describe = |error: std::io::Error| match error.kind() {
        std::io::ErrorKind::NotFound => "there is no such file".to_owned(),
        std::io::ErrorKind::PermissionDenied => "this file may not be read".to_owned(),
        _ => format!("this file cannot be read: {error}"),
    };
    let metadata = std::fs::metadata(path).map_err(describe)?;
    if metadata.is_dir() {
        return Err("this is a folder, not a file".to_owned());
    }
    if !metadata.is_file() {
        return Err("this is not a regular file".to_owned());
    }
    let file = File::open(path).map_err(describe)?;
    let too_large = |size: u64| {
        Err(format!("this file has {} MB, more than the limit of {} MB", size / 1_000_000, largest / 1_000_000))
    };
    if metadata.len() > largest {
        return too_large(metadata.len());
    }
    let mut bytes = Vec::new();
    Watched::new(file.take(largest + 1), cancelled).read_to_end(&mut bytes).map_err(describe)?;
    if bytes.len() as u64 > largest { too_large(bytes.len() as u64) } else { Ok(bytes) }
}
