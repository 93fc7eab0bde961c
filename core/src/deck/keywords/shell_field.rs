//! `*INITIAL CONDITIONS` of spokes as shells.

use std::ops::Range;

use crate::deck::DeckError;
use crate::deck::number::{Counter, real};
use crate::deck::sink::{Rows, Sink};
use crate::mesh::Sheet;

/// Gives every node of every spoke its modulus, one value a row of nodes, as field variable 1. `instances` are the
/// prefixes of the spokes' nodes; where they are empty the nodes are numbered on from spoke to spoke. A node without a
/// value would silently have a modulus of zero.
pub(crate) fn modulus(
    sink: &mut Sink<'_>,
    sheet: &Sheet,
    instances: &[String],
    moduli: &[f64],
) -> Result<(), DeckError> {
    let tails = moduli.iter().map(|modulus| format!(",{}\n", real(*modulus))).collect();
    sink.line("*INITIAL CONDITIONS, TYPE=FIELD, VARIABLE=1")?;
    sink.rows(&FieldRows { sheet, instances, tails })
}

/// One row is one row of one spoke's nodes.
struct FieldRows<'a> {
    sheet: &'a Sheet,
    instances: &'a [String],
    tails: Vec<String>,
}

impl Rows for FieldRows<'_> {
    fn rows(&self) -> usize {
        self.instances.len() * self.sheet.rows()
    }

    fn group(&self) -> usize {
        1
    }

    fn weight(&self, row: usize) -> usize {
        self.sheet.row_across(row % self.sheet.rows()) + 1
    }

    fn render(&self, rows: Range<usize>, out: &mut Vec<u8>) {
        for row in rows {
            let (spoke, row) = (row / self.sheet.rows(), row % self.sheet.rows());
            let (prefix, tail) = (self.instances[spoke].as_bytes(), self.tails[row].as_bytes());
            let offset = if prefix.is_empty() { spoke as u64 * self.sheet.nodes() } else { 0 };
            let mut id = Counter::new(offset + self.sheet.first_node(row));
            for _ in 0..=self.sheet.row_across(row) {
                out.extend_from_slice(prefix);
                out.extend_from_slice(id.text());
                out.extend_from_slice(tail);
                id.increment();
            }
        }
    }
}
