//! Measured tables: mid-lines and scans as columns of numbers.
//!
//! One row a point, numbers separated by commas, semicolons, tabs or spaces, in mm. A header names the columns; others than those
//! needed are passed over. Lines that start with `#` and blank lines are skipped.
//!
//! | columns | what it is |
//! |---|---|
//! | `s_mm,x_mm,z_mm` | a mid-line: flat arc length from the rim, distance from the rim, height |
//! | `rho_mm,z_mm` or `rho,z` | a meridian: distance from the dome's axis, height |
//! | `x_mm,y_mm,z_mm` or `x,y,z` | points of a dome, anywhere in space |

use std::fs::File;
use std::io::Read;
use std::path::Path;

use crate::error::Error;
use crate::input::InputError;
use crate::input::files::hex_sha256;
use crate::progress::{Cancelled, Watched, stops_at};

/// Most rows a table may have.
pub const MAX_ROWS: usize = 5_000_000;
/// Most bytes a table may have: 64 a row.
pub const MAX_BYTES: u64 = 64 * MAX_ROWS as u64;
/// Largest coordinate, mm: a kilometre, far beyond any dome and any scanner's origin.
const LARGEST_MM: f64 = 1e6;
/// Fewest rows of a mid-line or a meridian.
const LEAST_ROWS: usize = 3;
/// Fewest points of a dome.
const LEAST_POINTS: usize = 50;

/// What the rows of a table are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// `[s, x, z]` of the mid-line of a strip.
    Midline,
    /// `[rho, z]` of a dome's meridian.
    Meridian,
    /// `[x, y, z]` of a dome's surface.
    Points,
}

impl Kind {
    /// Names of the columns.
    #[must_use]
    pub fn columns(self) -> &'static [&'static str] {
        match self {
            Self::Midline => &["s_mm", "x_mm", "z_mm"],
            Self::Meridian => &["rho_mm", "z_mm"],
            Self::Points => &["x_mm", "y_mm", "z_mm"],
        }
    }
}

/// A measured table.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredTable {
    /// The file as the user named it.
    pub file: String,
    /// SHA-256 of its bytes.
    pub sha256: String,
    /// What the rows are.
    pub kind: Kind,
    /// The rows in mm; of a meridian `[rho, 0, z]`.
    pub rows: Vec<[f64; 3]>,
    /// The line of every row, counted from 1.
    pub lines: Vec<usize>,
}

/// Reads a measured table.
///
/// # Errors
/// [`Error::Input`] naming file, line, column and value; [`Error::Cancelled`].
pub fn read_table(path: &Path, cancelled: Cancelled<'_>) -> Result<MeasuredTable, Error> {
    let shown = path.display().to_string();
    let wrong = |problem: String, help: &str| Error::Input(InputError::new("", "", problem).help(help).in_file(&shown));
    let unreadable = |error: std::io::Error| match cancelled() {
        true => Error::Cancelled,
        false => wrong(format!("this file cannot be read: {error}"), ""),
    };
    let file = File::open(path).map_err(unreadable)?;
    let size = file.metadata().map_err(unreadable)?;
    if !size.is_file() {
        return Err(wrong("this is not a regular file".to_owned(), "name a CSV file with --result"));
    }
    let mut bytes = Vec::new();
    Watched::new(file.take(MAX_BYTES + 1), cancelled).read_to_end(&mut bytes).map_err(unreadable)?;
    if size.len().max(bytes.len() as u64) > MAX_BYTES {
        let problem = format!("this file holds {} bytes; the limit is {MAX_BYTES}", size.len());
        return Err(wrong(problem, "thin the scan out: some ten thousand points place and measure any dome"));
    }
    parse_table(&bytes, &shown, cancelled)
}

/// Reads a measured table from the bytes of a file that errors name `shown`.
///
/// # Errors
/// As [`read_table`].
pub fn parse_table(bytes: &[u8], shown: &str, cancelled: Cancelled<'_>) -> Result<MeasuredTable, Error> {
    let at = |line: usize, mut error: InputError| {
        error.line = Some(line);
        Error::Input(error.in_file(shown))
    };
    let text = String::from_utf8_lossy(bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes));
    let mut layout: Option<Layout> = None;
    let (mut rows, mut lines) = (Vec::new(), Vec::new());
    // Files of old spreadsheets end lines with a bare carriage return.
    let ends: &[char] = if text.contains('\n') { &['\n'] } else { &['\r'] };
    for (i, line) in text.split(ends).enumerate() {
        if stops_at(i, cancelled) {
            return Err(Error::Cancelled);
        }
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let layout = match &layout {
            Some(layout) => layout,
            None => {
                let (found, is_header) = Layout::of(line).map_err(|e| at(i + 1, e))?;
                let found = layout.insert(found);
                if is_header {
                    continue;
                }
                found
            }
        };
        if rows.len() == MAX_ROWS {
            let error =
                InputError::new("", "", format!("there are more than {MAX_ROWS} rows")).help("thin the scan out");
            return Err(at(i + 1, error));
        }
        rows.push(layout.row(line).map_err(|e| at(i + 1, e))?);
        lines.push(i + 1);
    }
    let whole = |problem: String, help: &str| Error::Input(InputError::new("", "", problem).help(help).in_file(shown));
    let Some(Layout { kind, .. }) = layout else {
        return Err(whole("this file holds no rows".to_owned(), HELP));
    };
    let least = if kind == Kind::Points { LEAST_POINTS } else { LEAST_ROWS };
    if rows.len() < least {
        return Err(whole(format!("this file holds {} row(s); at least {least} are needed", rows.len()), ""));
    }
    Ok(MeasuredTable { file: shown.to_owned(), sha256: hex_sha256(bytes), kind, rows, lines })
}

const HELP: &str = "the first row must name the columns: s_mm,x_mm,z_mm (a mid-line), rho_mm,z_mm (a meridian) or \
                    x_mm,y_mm,z_mm (points of a dome)";

/// Which column is which.
struct Layout {
    kind: Kind,
    separator: Option<char>,
    /// Places of the kind's columns.
    columns: Vec<usize>,
    /// Columns that a row must have.
    width: usize,
}

impl Layout {
    /// The layout that the first row tells, and whether it is a header.
    fn of(line: &str) -> Result<(Self, bool), InputError> {
        let separator = [',', ';', '\t'].into_iter().find(|c| line.contains(*c));
        let cells: Vec<&str> = cells(line, separator).collect();
        let is_header = cells.iter().all(|cell| cell.parse::<f64>().is_err() && !cell.is_empty());
        if !is_header {
            return match cells.len() {
                2 => Ok((Self { kind: Kind::Meridian, separator, columns: vec![0, 1], width: 2 }, false)),
                _ => Err(InputError::new("", "", "the first row does not say what the columns are").help(HELP)),
            };
        }
        let names: Vec<String> = cells.iter().map(|cell| cell.trim_matches('"').to_lowercase()).collect();
        let place = |name: &str| {
            let bare = name.trim_end_matches("_mm");
            names.iter().position(|n| n == name).or_else(|| names.iter().position(|n| n == bare))
        };
        for kind in [Kind::Midline, Kind::Meridian, Kind::Points] {
            if let Some(columns) = kind.columns().iter().map(|name| place(name)).collect::<Option<Vec<usize>>>() {
                return Ok((Self { kind, separator, columns, width: names.len() }, true));
            }
        }
        let found: String = names.join(",").chars().take(60).collect();
        Err(InputError::new("", "", format!("the columns are named {found}")).help(HELP))
    }

    fn row(&self, line: &str) -> Result<[f64; 3], InputError> {
        let cells: Vec<&str> = cells(line, self.separator).collect();
        let names = self.kind.columns();
        if cells.len() != self.width {
            let problem = format!("this row has {} column(s), the first one has {}", cells.len(), self.width);
            return Err(InputError::new("", "", problem).help("the file may be cut short"));
        }
        let mut values = [0.0; 3];
        for (i, (&column, name)) in self.columns.iter().zip(names).enumerate() {
            // A meridian leaves the middle place empty.
            let place = if self.kind == Kind::Meridian { 2 * i } else { i };
            values[place] = number(cells[column], name)?;
        }
        Ok(values)
    }
}

fn cells(line: &str, separator: Option<char>) -> impl Iterator<Item = &str> {
    let split: Box<dyn Iterator<Item = &str>> = match separator {
        Some(separator) => Box::new(line.split(separator)),
        None => Box::new(line.split_whitespace()),
    };
    split.map(str::trim)
}

fn number(text: &str, column: &str) -> Result<f64, InputError> {
    let shown: String = text.chars().take(40).collect();
    match text.parse::<f64>() {
        Ok(value) if value.abs() <= LARGEST_MM => Ok(value),
        Ok(value) if value.is_finite() => {
            Err(InputError::new(column, shown, format!("this is more than {LARGEST_MM} mm")).help("lengths are in mm"))
        }
        Ok(_) => Err(InputError::new(column, shown, "this is not a finite number").help("leave such rows out")),
        Err(_) => Err(InputError::new(column, shown, "this is not a number").help("decimal point, no unit")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::progress::never;

    fn parsed(text: &str) -> Result<MeasuredTable, String> {
        parse_table(text.as_bytes(), "scan.csv", &never).map_err(|e| e.to_string())
    }

    #[test]
    fn kinds_are_told_by_their_headers() {
        let midline = parsed("s_mm,x_mm,z_mm\n0,0,0\n1,1,0\n2,2,0\n").unwrap();
        assert_eq!((midline.kind, midline.rows[2]), (Kind::Midline, [2.0, 2.0, 0.0]));
        // Further columns are passed over, whatever their order.
        let more = parsed("node; z_mm ;x_mm;s_mm\r\n7;0.5;1;2\r\n8;0.5;1;3\r\n\r\n# note\r\n9;0.5;1;4\r\n").unwrap();
        assert_eq!((more.kind, more.rows[0], more.lines[2]), (Kind::Midline, [2.0, 1.0, 0.5], 6));
        assert_eq!(parsed("rho z\n5 0\n4 3\n3 4\n").unwrap().rows[1], [4.0, 0.0, 3.0]);
        assert_eq!(parsed("5\t0\r4\t3\r3\t4").unwrap().kind, Kind::Meridian);
        let points: String = (0..50).map(|i| format!("{i},1,2\n")).collect();
        assert_eq!(parsed(&format!("\u{feff}X,Y,Z\n{points}")).unwrap().kind, Kind::Points);
    }

    #[test]
    fn errors_name_line_column_and_value() {
        for (text, words) in [
            ("", "no rows"),
            ("1,2,3\n", "scan.csv:1: the first row does not say"),
            ("a,b\n1,2\n", "scan.csv:1: the columns are named a,b"),
            ("rho,z\n1,2\n\n1,x\n", "scan.csv:4: z_mm = x: this is not a number"),
            ("rho,z\n1,2\n1,nan\n", "scan.csv:3: z_mm = nan: this is not a finite"),
            ("rho,z\n1,2\n1e9,2\n", "scan.csv:3: rho_mm = 1e9"),
            ("rho,z\n1,2\n1\n", "scan.csv:3: this row has 1 column"),
            ("rho,z\n1,2\n", "1 row(s); at least 3"),
            ("x,y,z\n1,2,3\n", "1 row(s); at least 50"),
            ("rho;z\n1,5;2\n", "scan.csv:2: rho_mm = 1,5: this is not a number; decimal point"),
        ] {
            let error = parsed(text).unwrap_err();
            assert!(error.contains(words), "{text:?}: {error}");
        }
    }
}
