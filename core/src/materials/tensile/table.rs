//! Tensile curves as tables.
//!
//! One row a reading, numbers separated by commas, semicolons or tabs. The first row names the columns with their units, or the
//! second row has the units, as testing machines write them; columns other than those needed are passed over. Lines that start with `#` and blank lines are skipped. Where the separator is not the
//! comma, a comma may be the decimal point.

use std::path::Path;

use super::TensileCurve;
use crate::input::InputError;
use crate::input::files::read_bytes;
use crate::progress::Cancelled;

/// Most bytes of a table.
pub const MAX_BYTES: u64 = 64 << 20;
/// Most rows of a table.
pub const MAX_ROWS: usize = 1_000_000;
/// Words before a column's name that say nothing here.
const SHARED_WORDS: [&str; 4] = ["tensile", "engineering", "nominal", "standard"];
/// Largest number that is read; far beyond any test in any of the units.
const LARGEST: f64 = 1e12;
/// Longest text that is echoed.
const LONGEST_ECHO: usize = 60;

/// What a column is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Quantity {
    Strain,
    Stress,
    Extension,
    Force,
}

/// Names of columns, what they are, and their unit in mm, N and MPa.
const COLUMNS: [(&str, Quantity, f64); 15] = [
    ("strain", Quantity::Strain, 1.0),
    ("strain_mm_mm", Quantity::Strain, 1.0),
    ("strain_percent", Quantity::Strain, 0.01),
    ("stress_mpa", Quantity::Stress, 1.0),
    ("stress_n_mm2", Quantity::Stress, 1.0),
    ("stress_kpa", Quantity::Stress, 1e-3),
    ("stress_pa", Quantity::Stress, 1e-6),
    ("extension_mm", Quantity::Extension, 1.0),
    ("elongation_mm", Quantity::Extension, 1.0),
    ("displacement_mm", Quantity::Extension, 1.0),
    ("force_n", Quantity::Force, 1.0),
    ("force_kn", Quantity::Force, 1e3),
    ("load_n", Quantity::Force, 1.0),
    ("load_kn", Quantity::Force, 1e3),
    ("strain_1", Quantity::Strain, 1.0),
];

const HELP: &str = "the first row names the columns with units: strain or strain_percent, or extension_mm with a gauge length; \
                    and stress_mpa, or force_n with an area";

/// The specimen: what makes strains of extensions and stresses of forces.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Specimen {
    /// Length over which the extension is measured, mm.
    pub gauge_length_mm: Option<f64>,
    /// Area of the cross-section before the test, mm^2.
    pub area_mm2: Option<f64>,
}

impl Specimen {
    /// Checks that both are positive numbers.
    ///
    /// # Errors
    /// [`InputError`] naming the key and its value.
    pub fn validate(&self) -> Result<(), InputError> {
        for (key, value) in [("gauge_length_mm", self.gauge_length_mm), ("area_mm2", self.area_mm2)] {
            if let Some(value) = value.filter(|v| !(*v > 0.0 && *v <= LARGEST)) {
                return Err(InputError::new(key, value, "this must be a positive number"));
            }
        }
        Ok(())
    }
}

/// Reads a tensile curve from a file.
///
/// # Errors
/// [`InputError`] naming file, line, column and value.
pub fn read_curve(path: &Path, specimen: &Specimen, cancelled: Cancelled<'_>) -> Result<TensileCurve, InputError> {
    let shown = path.display().to_string();
    let bytes =
        read_bytes(path, MAX_BYTES, cancelled).map_err(|problem| InputError::new("", "", problem).in_file(&shown))?;
    parse_curve(&bytes, &shown, specimen)
}

/// Reads a tensile curve from the bytes of a file that errors name `shown`.
///
/// # Errors
/// As [`read_curve`].
pub fn parse_curve(bytes: &[u8], shown: &str, specimen: &Specimen) -> Result<TensileCurve, InputError> {
    specimen.validate()?;
    let at = |line: usize, mut error: InputError| {
        error.line = Some(line);
        error.in_file(shown)
    };
    let text = String::from_utf8_lossy(bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes));
    // Files of old spreadsheets end lines with a bare carriage return.
    let ends: &[char] = if text.contains('\n') { &['\n'] } else { &['\r'] };
    // Not the ends of a line: a tab there may be an empty column.
    let is_row = |line: &str| !line.trim().is_empty() && !line.trim_start().starts_with('#');
    let mut rows =
        text.split(ends).enumerate().map(|(i, line)| (i + 1, line)).filter(|(_, line)| is_row(line)).peekable();
    let Some((first, line)) = rows.next() else {
        return Err(InputError::new("", "", "this file is empty").help(HELP).in_file(shown));
    };
    let mut header = Header::of(line).map_err(|e| at(first, e))?;
    if let Some(units) = rows.peek().and_then(|(_, line)| header.with_units(line)) {
        header = units;
        rows.next();
    }
    let layout = Layout::of(&header, specimen).map_err(|e| at(first, e))?;
    let (mut strains, mut stresses, mut lines) = (Vec::new(), Vec::new(), Vec::new());
    for (i, line) in rows {
        if lines.len() == MAX_ROWS {
            let problem = format!("there are more than {MAX_ROWS} rows");
            return Err(at(i, InputError::new("", "", problem).help("thin the curve out")));
        }
        let [strain, stress] = layout.row(line).map_err(|e| at(i, e))?;
        strains.push(strain);
        stresses.push(stress);
        lines.push(i);
    }
    TensileCurve::new(shown, strains, stresses, &lines)
}

/// Names of the columns, in the spelling of [`COLUMNS`].
struct Header {
    separator: char,
    names: Vec<String>,
}

impl Header {
    fn of(line: &str) -> Result<Self, InputError> {
        let separator = ['\t', ';', ','].into_iter().find(|c| line.contains(*c)).unwrap_or(',');
        if cells(line, separator).any(|cell| number_of(cell, separator).is_some()) {
            return Err(InputError::new("", "", "the first row does not name the columns").help(HELP));
        }
        Ok(Self { separator, names: cells(line, separator).map(normal).collect() })
    }

    /// The names with the units of a second row; `None` where that row makes no known name of any, and is no row of units.
    fn with_units(&self, line: &str) -> Option<Self> {
        let units: Vec<&str> = cells(line, self.separator).collect();
        if units.len() != self.names.len() || units.iter().any(|u| number_of(u, self.separator).is_some()) {
            return None;
        }
        let known = |name: &String| COLUMNS.iter().any(|(known, ..)| known == name);
        let joined: Vec<String> = self.names.iter().zip(units).map(|(n, u)| normal(&format!("{n} {u}"))).collect();
        let told = joined.iter().zip(&self.names).any(|(joined, name)| joined != name && known(joined));
        told.then_some(Self { separator: self.separator, names: joined })
    }
}

/// One of the two columns that are read.
struct Column {
    name: String,
    place: usize,
    factor: f64,
}

/// Which columns are strain and stress.
struct Layout {
    separator: char,
    columns: [Column; 2],
    width: usize,
}

impl Layout {
    /// The layout that the header tells.
    fn of(header: &Header, specimen: &Specimen) -> Result<Self, InputError> {
        let Header { separator, names } = header;
        let find = |quantity: Quantity| -> Result<Option<Column>, InputError> {
            let mut found: Option<Column> = None;
            for (place, name) in names.iter().enumerate() {
                let Some((_, _, factor)) = COLUMNS.iter().find(|(known, q, _)| known == name && *q == quantity) else {
                    continue;
                };
                if let Some(first) = &found {
                    let problem = format!("columns {} and {name} are both there", first.name);
                    return Err(InputError::new("", "", problem).help("leave one of them out"));
                }
                found = Some(Column { name: name.clone(), place, factor: *factor });
            }
            Ok(found)
        };
        let pick = |direct, measured, what: &str, size: Option<f64>, key: &str| match (find(direct)?, find(measured)?) {
            (Some(column), _) => Ok(column),
            (None, Some(column)) => match size {
                Some(size) => Ok(Column { factor: column.factor / size, ..column }),
                None => Err(InputError::new(key, "", format!("column {} needs it to give the {what}", column.name))
                    .help(format!("give --{}", key.replace('_', "-")))),
            },
            (None, None) => {
                let found: String = names.join(",").chars().take(LONGEST_ECHO).collect();
                Err(InputError::new("", "", format!("no column gives the {what}; they are named {found}")).help(HELP))
            }
        };
        let strain =
            pick(Quantity::Strain, Quantity::Extension, "strain", specimen.gauge_length_mm, "gauge_length_mm")?;
        let stress = pick(Quantity::Stress, Quantity::Force, "stress", specimen.area_mm2, "area_mm2")?;
        Ok(Self { separator: *separator, columns: [strain, stress], width: names.len() })
    }

    fn row(&self, line: &str) -> Result<[f64; 2], InputError> {
        let cells: Vec<&str> = cells(line, self.separator).collect();
        if cells.len() != self.width {
            let problem = format!("this row has {} column(s), the first one has {}", cells.len(), self.width);
            return Err(InputError::new("", "", problem).help("the file may be cut short"));
        }
        let [strain, stress] = &self.columns;
        Ok([self.value(&cells, strain)?, self.value(&cells, stress)?])
    }

    fn value(&self, cells: &[&str], column: &Column) -> Result<f64, InputError> {
        let text = cells.get(column.place).copied().unwrap_or_default();
        let shown: String = text.chars().take(LONGEST_ECHO).collect();
        let wrong = |problem: &str, help: &str| Err(InputError::new(&column.name, shown.clone(), problem).help(help));
        match number_of(text, self.separator) {
            Some(value) if value.abs() <= LARGEST => Ok(value * column.factor),
            Some(value) if value.is_finite() => wrong("this is too large", "look at the column's unit"),
            Some(_) => wrong("this is not a finite number", "leave such rows out"),
            None => wrong("this is not a number", "leave units and remarks out, or begin the line with #"),
        }
    }
}

fn cells(line: &str, separator: char) -> impl Iterator<Item = &str> {
    line.trim_end_matches(['\r', '\n']).split(separator).map(|cell| cell.trim().trim_matches('"').trim())
}

/// A number; a decimal comma where the comma does not separate.
fn number_of(text: &str, separator: char) -> Option<f64> {
    if separator == ',' { text.parse().ok() } else { text.replace(',', ".").parse().ok() }
}

/// A column's name in lower case, with `_` for what is neither letter nor digit and without words that all tensile tests share:
/// `Tensile stress (MPa)` is `stress_mpa`.
fn normal(name: &str) -> String {
    let spelled = name.to_lowercase().replace('%', " percent ").replace('²', "2");
    let words = spelled.split(|c: char| !c.is_ascii_alphanumeric()).filter(|word| !word.is_empty());
    words.skip_while(|word| SHARED_WORDS.contains(word)).collect::<Vec<_>>().join("_")
}

#[cfg(test)]
mod tests {
    use super::*;

    const LINE: [[f64; 2]; 6] = [[0.0, 0.0], [0.01, 1.0], [0.02, 2.0], [0.03, 3.0], [0.04, 4.0], [0.05, 5.0]];

    fn text(header: &str, separator: &str, factors: [f64; 2]) -> String {
        let row = |[e, s]: &[f64; 2]| format!("{}{separator}{}\n", e * factors[0], s * factors[1]);
        format!("{header}\n{}", LINE.iter().map(row).collect::<String>())
    }

    fn parsed(text: &str, specimen: &Specimen) -> Result<TensileCurve, String> {
        parse_curve(text.as_bytes(), "a.csv", specimen).map_err(|e| e.to_string())
    }

    #[test]
    fn columns_are_told_by_their_names_and_units() {
        let specimen = Specimen { gauge_length_mm: Some(50.0), area_mm2: Some(40.0) };
        for (header, separator, factors) in [
            ("strain,stress_mpa", ",", [1.0, 1.0]),
            ("\u{feff}# by hand\n\nStrain (%)\tStress [MPa]", "\t", [100.0, 1.0]),
            ("extension_mm;force_n", ";", [50.0, 40.0]),
            ("\"Extension (mm)\",\"Load (kN)\"", ",", [50.0, 0.04]),
            ("strain;stress (N/mm²)", ";", [1.0, 1.0]),
            // Units in a second row.
            ("Strain,Stress\n%,MPa", ",", [100.0, 1.0]),
            ("\"Tensile strain\",\"Tensile stress\"\n\"(mm/mm)\",\"(MPa)\"", ",", [1.0, 1.0]),
            ("Extension\tLoad\n\n(mm)\t(kN)", "\t", [50.0, 0.04]),
            ("Strain;Standard force\n;N", ";", [1.0, 40.0]),
        ] {
            let curve = parsed(&text(header, separator, factors), &specimen).unwrap();
            for (i, [strain, stress]) in LINE.iter().enumerate() {
                assert!((curve.strains()[i] - strain).abs() < 1e-12, "{header}");
                assert!((curve.stresses_mpa()[i] - stress).abs() < 1e-12, "{header}");
            }
        }
        // Decimal commas, further columns, in any order.
        let comma = text("time_s;stress_mpa;strain", ";", [1.0, 1.0]);
        let rows: String = LINE.iter().map(|[e, s]| format!("1;{s};{e}\r\n").replace('.', ",")).collect();
        let curve = parsed(&format!("{}\r\n{rows}", comma.lines().next().unwrap()), &Specimen::default()).unwrap();
        assert_eq!(curve.strains()[2], 0.02);
    }

    #[test]
    fn errors_name_line_column_and_value() {
        let none = Specimen::default();
        for (text, words) in [
            ("", "a.csv: this file is empty"),
            ("# only this\n", "this file is empty"),
            ("1,2\n2,3\n", "a.csv:1: the first row does not name the columns"),
            ("strain,stress\n0,0\n", "a.csv:1: no column gives the stress; they are named strain,stress"),
            ("stress_mpa\n0\n", "no column gives the strain"),
            ("strain,strain_percent,stress_mpa\n0,0,0\n", "columns strain and strain_percent are both there"),
            ("extension_mm,force_n\n0,0\n", "a.csv:1: gauge_length_mm: column extension_mm needs it"),
            ("strain,force_n\n0,0\n", "area_mm2: column force_n needs it to give the stress; give --area-mm2"),
            ("strain,stress_mpa\nsoft,hard\n0,0\n", "a.csv:2: strain = soft: this is not a number"),
            (
                "strain,stress\n%,psi\n0,0\n",
                "a.csv:1: no column gives the stress; they are named strain_percent,stress_psi",
            ),
            ("strain,stress\n", "a.csv:1: no column gives the stress"),
            ("strain,stress_mpa\n0,0\n\n0.1,soft\n", "a.csv:4: stress_mpa = soft: this is not a number"),
            ("strain,stress_mpa\n0,0\n0.1,inf\n", "a.csv:3: stress_mpa = inf: this is not a finite number"),
            ("strain,stress_mpa\n0,1e300\n", "this is too large"),
            ("strain,stress_mpa\n0,0\n0.1\n", "a.csv:3: this row has 1 column(s)"),
            ("strain,stress_mpa\n0,0\n", "1 row(s)"),
        ] {
            let error = parsed(text, &none).unwrap_err();
            assert!(error.contains(words), "{text:?}: {error}");
        }
        for area in [-1.0, 0.0, f64::NAN, f64::INFINITY] {
            let error = parsed("", &Specimen { area_mm2: Some(area), ..none }).unwrap_err();
            assert!(error.contains("area_mm2 = ") && error.contains("positive"), "{error}");
        }
    }
}
