//! The gathered table: one row a point.

use std::collections::BTreeMap;
use std::io::{self, Write};
use std::sync::Arc;

use parquet::basic::{Compression, LogicalType, Repetition, Type as Physical};
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;
use serde_json::Value;

use super::Sweep;
use super::journal::Entry;
use super::point::Outcome;
use crate::output::tables::number;

/// Rows that are held and written at once.
const ROWS: u64 = 1 << 16;

/// State of a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Status {
    /// No journal has it.
    Missing,
    /// It has figures.
    Ok,
    /// Its design is ruled out.
    Infeasible,
    /// A solver failed.
    Failed,
}

impl Status {
    /// The word in the table.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Missing => "missing",
            Self::Ok => "ok",
            Self::Infeasible => "infeasible",
            Self::Failed => "failed",
        }
    }
}

/// All points of a sweep.
#[derive(Debug, Clone)]
pub struct Table<'a> {
    sweep: &'a Sweep,
    status: Vec<Status>,
    reasons: BTreeMap<u64, String>,
    /// One vector a figure; NaN where there is none.
    figures: Vec<Vec<f64>>,
}

impl<'a> Table<'a> {
    /// An empty table.
    #[must_use]
    pub fn new(sweep: &'a Sweep) -> Self {
        let points = usize::try_from(sweep.points()).unwrap_or(usize::MAX);
        let figures = vec![vec![f64::NAN; points]; sweep.input().outputs.len()];
        Self { sweep, status: vec![Status::Missing; points], reasons: BTreeMap::new(), figures }
    }

    /// The sweep.
    #[must_use]
    pub fn sweep(&self) -> &Sweep {
        self.sweep
    }

    /// Puts a point in; a failure never replaces an answer.
    pub fn insert(&mut self, entry: Entry) {
        let row = entry.point as usize;
        let answered = matches!(self.status[row], Status::Ok | Status::Infeasible);
        match entry.outcome {
            Outcome::Ok { outputs } => {
                self.reasons.remove(&entry.point);
                self.status[row] = Status::Ok;
                for (name, column) in self.sweep.input().outputs.iter().zip(&mut self.figures) {
                    column[row] = outputs.get(name).copied().unwrap_or(f64::NAN);
                }
            }
            Outcome::Infeasible { reason } => {
                self.status[row] = Status::Infeasible;
                self.reasons.insert(entry.point, reason);
            }
            Outcome::Failed { reason } if !answered => {
                self.status[row] = Status::Failed;
                self.reasons.insert(entry.point, reason);
            }
            Outcome::Failed { .. } => {}
        }
    }

    /// Points of a state.
    #[must_use]
    pub fn count(&self, status: Status) -> u64 {
        self.status.iter().filter(|s| **s == status).count() as u64
    }

    /// The first points that are missing.
    #[must_use]
    pub fn first_missing(&self, most: usize) -> Vec<u64> {
        (0..).zip(&self.status).filter(|(_, s)| **s == Status::Missing).map(|(p, _)| p).take(most).collect()
    }

    /// State of a point.
    #[must_use]
    pub fn status(&self, point: u64) -> Status {
        self.status[point as usize]
    }

    /// A figure of a point, by the number of its column; NaN where there is none.
    #[must_use]
    pub fn figure(&self, column: usize, point: u64) -> f64 {
        self.figures[column][point as usize]
    }

    fn reason(&self, point: u64) -> &str {
        self.reasons.get(&point).map_or("", String::as_str)
    }

    fn names(&self) -> Vec<&str> {
        let input = self.sweep.input();
        let axes = input.axes.iter().map(|a| a.key.as_str());
        let outputs = input.outputs.iter().map(String::as_str);
        ["point"].into_iter().chain(axes).chain(["status", "reason"]).chain(outputs).collect()
    }

    /// Writes it as CSV: a header and one row a point; figures that a point does not have are empty.
    ///
    /// # Errors
    /// Of the writer.
    pub fn write_csv(&self, out: &mut dyn Write) -> io::Result<()> {
        let mut rows = csv::Writer::from_writer(out);
        rows.write_record(self.names())?;
        for point in 0..self.sweep.points() {
            let mut row = vec![point.to_string()];
            row.extend(self.sweep.values(point).iter().map(text));
            row.extend([self.status(point).name().to_owned(), self.reason(point).to_owned()]);
            let figure = |column: &Vec<f64>| {
                let value = column[point as usize];
                if value.is_finite() { number(value) } else { String::new() }
            };
            row.extend(self.figures.iter().map(figure));
            rows.write_record(&row)?;
        }
        rows.flush()
    }

    /// Writes it as Parquet: the same columns, numbers as doubles, the point as a whole number; figures that a point does not
    /// have are null.
    ///
    /// # Errors
    /// Of the writer.
    pub fn write_parquet(&self, out: &mut (dyn Write + Send)) -> Result<(), ParquetError> {
        let axes = &self.sweep.input().axes;
        let first = self.sweep.values(0);
        let numeric: Vec<bool> = first.iter().map(Value::is_number).collect();
        let column = |name: &str, physical: Physical, repetition: Repetition| {
            let builder = Type::primitive_type_builder(name, physical).with_repetition(repetition);
            let builder = if physical == Physical::BYTE_ARRAY {
                builder.with_logical_type(Some(LogicalType::String))
            } else {
                builder
            };
            builder.build().map(Arc::new)
        };
        let mut fields = vec![column("point", Physical::INT64, Repetition::REQUIRED)?];
        for (axis, numeric) in axes.iter().zip(&numeric) {
            let physical = if *numeric { Physical::DOUBLE } else { Physical::BYTE_ARRAY };
            fields.push(column(&axis.key, physical, Repetition::REQUIRED)?);
        }
        fields.push(column("status", Physical::BYTE_ARRAY, Repetition::REQUIRED)?);
        fields.push(column("reason", Physical::BYTE_ARRAY, Repetition::REQUIRED)?);
        for name in &self.sweep.input().outputs {
            fields.push(column(name, Physical::DOUBLE, Repetition::OPTIONAL)?);
        }
        let schema = Arc::new(Type::group_type_builder("sweep").with_fields(fields).build()?);
        let properties = WriterProperties::builder()
            .set_compression(Compression::UNCOMPRESSED)
            .set_created_by(format!("voxelastica {}", env!("CARGO_PKG_VERSION")))
            .build();
        let mut writer = SerializedFileWriter::new(out, schema, Arc::new(properties))?;
        let points = self.sweep.points();
        for start in (0..points).step_by(ROWS as usize) {
            let rows: Vec<u64> = (start..points.min(start + ROWS)).collect();
            let values: Vec<Vec<Value>> = rows.iter().map(|p| self.sweep.values(*p)).collect();
            let mut group = writer.next_row_group()?;
            let mut next = 0;
            while let Some(mut column) = group.next_column()? {
                let axis = (1..=axes.len()).contains(&next).then(|| next - 1);
                match (next, axis) {
                    (0, _) => {
                        let points: Vec<i64> = rows.iter().map(|p| *p as i64).collect();
                        column.typed::<Int64Type>().write_batch(&points, None, None)?;
                    }
                    (_, Some(k)) if numeric[k] => {
                        let numbers: Vec<f64> = values.iter().map(|v| v[k].as_f64().unwrap_or(f64::NAN)).collect();
                        column.typed::<DoubleType>().write_batch(&numbers, None, None)?;
                    }
                    (_, Some(k)) => {
                        let texts: Vec<ByteArray> = values.iter().map(|v| text(&v[k]).as_str().into()).collect();
                        column.typed::<ByteArrayType>().write_batch(&texts, None, None)?;
                    }
                    (n, None) if n <= axes.len() + 2 => {
                        let word = |p: &u64| {
                            if n == axes.len() + 1 { self.status(*p).name() } else { self.reason(*p) }
                        };
                        let texts: Vec<ByteArray> = rows.iter().map(|p| word(p).into()).collect();
                        column.typed::<ByteArrayType>().write_batch(&texts, None, None)?;
                    }
                    (n, None) => {
                        let figures = &self.figures[n - axes.len() - 3][start as usize..][..rows.len()];
                        let levels: Vec<i16> = figures.iter().map(|v| i16::from(v.is_finite())).collect();
                        let finite: Vec<f64> = figures.iter().copied().filter(|v| v.is_finite()).collect();
                        column.typed::<DoubleType>().write_batch(&finite, Some(&levels), None)?;
                    }
                }
                column.close()?;
                next += 1;
            }
            group.close()?;
        }
        writer.close()?;
        Ok(())
    }
}

/// A value as a cell.
pub(super) fn text(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        Value::Array(entries) => entries.iter().map(text).collect::<Vec<_>>().join(" + "),
        Value::Number(n) => n.as_f64().map_or_else(|| n.to_string(), number),
        other => other.to_string(),
    }
}
