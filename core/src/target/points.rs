//! Meridians from tables: the columns `rho,z` of a CSV file.
//!
//! One row a point, `rho` the radius and `z` the height, both in one length unit (any), in the order of the curve, from
//! rim to hub or from hub to rim. A header `rho,z` or `rho_mm,z_mm` may come first; `#` starts a comment line; blank
//! lines are skipped.
//!
//! ```
//! let table = voxelastica_core::target::read_points(b"rho,z\n5,0\n4,3\n3,4\n1.4,4.8\n0,5\n")?;
//! assert_eq!(table.points()[1], [4.0, 3.0]);
//! # Ok::<(), voxelastica_core::target::TargetError>(())
//! ```

use std::fs::File;
use std::io::Read;
use std::path::Path;

use super::error::{Row, TargetError};
use super::ordering;
use crate::progress::{Cancelled, Watched, never};

/// Most rows a table may have.
pub const MAX_POINTS: usize = 2_000_000;
/// Most bytes a table may have: 64 a row.
pub const MAX_POINTS_BYTES: u64 = 64 * MAX_POINTS as u64;

const COLUMNS: [&str; 2] = ["rho", "z"];

/// The points of a table, in the table's order and unit, with their lines.
///
/// They have passed the checks of [`read_points`].
#[derive(Debug, Clone, PartialEq)]
pub struct PointTable {
    points: Vec<[f64; 2]>,
    lines: Vec<u64>,
}

impl PointTable {
    /// `[rho, z]` of every row, in the table's unit.
    #[must_use]
    pub fn points(&self) -> &[[f64; 2]] {
        &self.points
    }

    /// The line, counted from 1, that each point stands on.
    #[must_use]
    pub fn lines(&self) -> &[u64] {
        &self.lines
    }
}

/// Reads a meridian from the bytes of a CSV file.
///
/// # Errors
///
/// The line, the column and the value of the first entry that is not a finite number, of a row that has not two columns
/// or of a negative radius; fewer than 5 different points or more than [`MAX_POINTS`]; more than [`MAX_POINTS_BYTES`];
/// the line where the curve doubles back or crosses itself.
pub fn read_points(bytes: &[u8]) -> Result<PointTable, TargetError> {
    check_size(bytes.len() as u64)?;
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .from_reader(bytes);
    let mut table = PointTable { points: Vec::new(), lines: Vec::new() };
    let mut record = csv::ByteRecord::new();
    let mut lines = LineCounter { bytes, offset: 0, line: 1 };
    let mut first = true;
    while reader.read_byte_record(&mut record).map_err(|error| TargetError::Table { reason: error.to_string() })? {
        let line = lines.of_record_ending_at(reader.position().byte());
        let row = Row::Line(line);
        let start = record.get(0).unwrap_or_default();
        if start.first() == Some(&b'#') || (record.len() == 1 && start.is_empty()) {
            continue;
        }
        if std::mem::take(&mut first) && is_header(&record, row)? {
            continue;
        }
        if record.len() != COLUMNS.len() {
            return Err(TargetError::ColumnCount { row, found: record.len() });
        }
        if table.points.len() == MAX_POINTS {
            return Err(TargetError::TooManyPoints { limit: MAX_POINTS });
        }
        let rho = number(&record, 0, row)?;
        if rho < 0.0 {
            return Err(TargetError::NegativeRadius { row, value: rho });
        }
        table.points.push([rho, number(&record, 1, row)?]);
        table.lines.push(line);
    }
    ordering::order(&table.points, |i| Row::Line(table.lines.get(i).copied().unwrap_or(0)))?;
    Ok(table)
}

/// Reads a meridian from a CSV file; see [`read_points`].
///
/// # Errors
///
/// A file that cannot be opened or is larger than [`MAX_POINTS_BYTES`], and what [`read_points`] refuses.
pub fn read_points_file(path: &Path) -> Result<PointTable, TargetError> {
    read_points(&read_limited(path, check_size, &never)?)
}

/// The bytes of a file whose size passes `check`; a file that grows meanwhile is read up to the size checked, plus one.
pub(super) fn read_limited(
    path: &Path,
    check: impl Fn(u64) -> Result<(), TargetError>,
    cancelled: Cancelled<'_>,
) -> Result<Vec<u8>, TargetError> {
    let unreadable = |error: std::io::Error| match cancelled() {
        true => TargetError::Cancelled,
        false => TargetError::Unreadable { path: path.display().to_string(), reason: error.to_string() },
    };
    let file = File::open(path).map_err(unreadable)?;
    let metadata = file.metadata().map_err(unreadable)?;
    if !metadata.is_file() {
        return Err(TargetError::Unreadable {
            path: path.display().to_string(),
            reason: String::from("it is not a regular file"),
        });
    }
    check(metadata.len())?;
    let mut bytes = Vec::new();
    let most = metadata.len().saturating_add(1);
    Watched::new(file.take(most), cancelled).read_to_end(&mut bytes).map_err(unreadable)?;
    check(bytes.len() as u64)?;
    Ok(bytes)
}

/// Counts lines up to the end of a record. The CSV reader's own count stands where the search for the record began,
/// before comments and blank lines.
struct LineCounter<'a> {
    bytes: &'a [u8],
    offset: usize,
    line: u64,
}

impl LineCounter<'_> {
    fn of_record_ending_at(&mut self, end: u64) -> u64 {
        let end = usize::try_from(end).unwrap_or(usize::MAX).min(self.bytes.len());
        let record = self.bytes.get(self.offset..end).unwrap_or_default();
        // The line break that ends the record belongs to its line; a leading half of `\r\n` to the one before.
        let text = record.strip_suffix(b"\n").unwrap_or(record);
        let text = text.strip_suffix(b"\r").unwrap_or(text);
        for (i, byte) in text.iter().enumerate() {
            let next = self.bytes.get(self.offset + i + 1);
            self.line += u64::from(*byte == b'\n' || (*byte == b'\r' && next != Some(&b'\n')));
        }
        self.offset += text.len();
        self.line
    }
}

fn check_size(bytes: u64) -> Result<(), TargetError> {
    if bytes > MAX_POINTS_BYTES {
        return Err(TargetError::TooManyBytes { what: "table of points", bytes, limit: MAX_POINTS_BYTES });
    }
    Ok(())
}

/// Whether the first row holds the column names; words that are no known names are an error.
fn is_header(record: &csv::ByteRecord, row: Row) -> Result<bool, TargetError> {
    // A row with a number in it is data, whatever else is wrong with it: its own error names the column.
    let starts_like_a_number = |field: &[u8]| field.is_empty() || String::from_utf8_lossy(field).parse::<f64>().is_ok();
    if record.iter().any(starts_like_a_number) {
        return Ok(false);
    }
    let names: Vec<String> = record.iter().map(|name| String::from_utf8_lossy(name).to_lowercase()).collect();
    if names == ["rho", "z"] || names == ["rho_mm", "z_mm"] {
        return Ok(true);
    }
    Err(TargetError::Header { row, found: shortened(&names.join(",")) })
}

fn number(record: &csv::ByteRecord, index: usize, row: Row) -> Result<f64, TargetError> {
    let column = COLUMNS.get(index).copied().unwrap_or_default();
    let text = String::from_utf8_lossy(record.get(index).unwrap_or_default());
    let value: f64 =
        text.parse().map_err(|_| TargetError::NotANumber { row, column, value: shortened(text.as_ref()) })?;
    if !value.is_finite() {
        return Err(TargetError::NotFinite { row, column, value });
    }
    Ok(value)
}

/// The first characters of a text that may be as long as the file.
fn shortened(text: &str) -> String {
    const SHOWN: usize = 40;
    match text.char_indices().nth(SHOWN) {
        Some((end, _)) => format!("{}...", text.get(..end).unwrap_or_default()),
        None => text.to_owned(),
    }
}
