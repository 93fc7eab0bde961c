//! A design file as a tree of values that remembers where its keys stand.

use std::collections::HashMap;
use std::ops::Range;

use serde_json::{Map, Number, Value};
use toml::de::{DeTable, DeValue};

use super::InputError;

/// Largest design file that is read, bytes. A `design.json` with an embedded meridian stays far below it.
pub const LARGEST_FILE: u64 = 64 << 20;

/// Deepest nesting that is followed.
const DEEPEST: usize = 16;

/// The values of a design file and the lines of their keys.
#[derive(Debug, Clone, Default)]
pub struct Document {
    /// The values.
    pub root: Map<String, Value>,
    /// Line of every dotted key; list entries are counted from zero, as in `materials.custom.0.name`.
    pub lines: HashMap<String, usize>,
}

impl Document {
    /// Reads TOML.
    ///
    /// # Errors
    /// [`InputError`] with its line for text that is not TOML, and for dates, which no key accepts.
    pub fn from_toml(text: &str) -> Result<Self, InputError> {
        let newlines = text.bytes().enumerate().filter(|(_, b)| *b == b'\n').map(|(i, _)| i).collect();
        let mut reader = TomlReader { text, newlines, lines: HashMap::new() };
        let table = DeTable::parse(text).map_err(|error| {
            let mut wrong = InputError::new("", "", format!("this is not TOML: {}", error.message().trim()));
            wrong.line = error.span().map(|span| reader.line(&span));
            wrong
        })?;
        let root = reader.table("", table.get_ref(), &table.span(), 0)?;
        Ok(Self { root, lines: reader.lines })
    }

    /// Reads JSON: a design with the TOML's keys, or a whole `design.json`, whose `design` table is taken.
    ///
    /// # Errors
    /// [`InputError`] with its line for text that is not JSON or not an object.
    pub fn from_json(text: &str) -> Result<Self, InputError> {
        let value: Value = serde_json::from_str(text).map_err(|error| {
            let mut wrong = InputError::new("", "", format!("this is not JSON: {error}"));
            wrong.line = Some(error.line());
            wrong
        })?;
        let Value::Object(mut root) = value else {
            return Err(InputError::new("", "", "a design must be a JSON object"));
        };
        if let Some(schema) = root.get("schema") {
            if schema != crate::SCHEMA {
                return Err(InputError::new("schema", schema, format!("this build reads \"{}\"", crate::SCHEMA))
                    .help("write the design again with this version"));
            }
            match root.remove("design") {
                Some(Value::Object(design)) => root = design,
                _ => return Err(InputError::new("design", "", "the design.json holds no design table")),
            }
        }
        Ok(Self { root, lines: HashMap::new() })
    }
}

/// Turns parsed TOML into JSON values, noting the line of every key.
struct TomlReader<'a> {
    text: &'a str,
    newlines: Vec<usize>,
    lines: HashMap<String, usize>,
}

impl TomlReader<'_> {
    fn line(&self, span: &Range<usize>) -> usize {
        1 + self.newlines.partition_point(|newline| *newline < span.start)
    }

    fn wrong(&self, path: &str, span: &Range<usize>, problem: &str) -> InputError {
        let written: String = self.text.get(span.clone()).unwrap_or_default().chars().take(60).collect();
        let mut error = InputError::new(path, written, problem);
        error.line = Some(self.line(span));
        error
    }

    fn table(
        &mut self,
        prefix: &str,
        table: &DeTable<'_>,
        span: &Range<usize>,
        depth: usize,
    ) -> Result<Map<String, Value>, InputError> {
        if depth > DEEPEST {
            return Err(self.wrong(prefix, span, "tables are nested too deeply"));
        }
        let mut map = Map::new();
        for (key, value) in table {
            let name = key.get_ref().to_string();
            let path = if prefix.is_empty() { name.clone() } else { format!("{prefix}.{name}") };
            self.lines.insert(path.clone(), self.line(&key.span()));
            let value = self.value(&path, value.get_ref(), &value.span(), depth)?;
            map.insert(name, value);
        }
        Ok(map)
    }

    fn value(
        &mut self,
        path: &str,
        value: &DeValue<'_>,
        span: &Range<usize>,
        depth: usize,
    ) -> Result<Value, InputError> {
        Ok(match value {
            DeValue::String(s) => Value::String(s.to_string()),
            DeValue::Boolean(b) => Value::Bool(*b),
            DeValue::Integer(integer) => {
                let parsed = i64::from_str_radix(integer.as_str(), integer.radix());
                Value::Number(parsed.map_err(|_| self.wrong(path, span, "this whole number is too large"))?.into())
            }
            DeValue::Float(float) => {
                let number = float.as_str().parse().ok().and_then(Number::from_f64);
                Value::Number(number.ok_or_else(|| self.wrong(path, span, "numbers must be finite"))?)
            }
            DeValue::Datetime(_) => return Err(self.wrong(path, span, "no key accepts a date")),
            DeValue::Array(entries) => {
                if depth > DEEPEST {
                    return Err(self.wrong(path, span, "lists are nested too deeply"));
                }
                let mut list = Vec::with_capacity(entries.len());
                for (i, entry) in entries.iter().enumerate() {
                    list.push(self.value(&format!("{path}.{i}"), entry.get_ref(), &entry.span(), depth + 1)?);
                }
                Value::Array(list)
            }
            DeValue::Table(table) => Value::Object(self.table(path, table, span, depth + 1)?),
        })
    }
}
