//! `*INITIAL CONDITIONS`.

use std::ops::Range;

use crate::deck::DeckError;
use crate::deck::layout::Layout;
use crate::deck::number::{Counter, real};
use crate::deck::sink::{Rows, Sink};
use crate::mesh::Block;

/// Gives every node of a block its modulus, one value a plane, as field variable 1 (ABAQUS) or temperature (CalculiX).
/// `prefix` names the instance. A node without a value would silently have a modulus of zero.
pub(crate) fn modulus_field(
    sink: &mut Sink<'_>,
    layout: Layout,
    prefix: &str,
    block: &Block,
    moduli: &[f64],
) -> Result<(), DeckError> {
    let kind = if layout.is_abaqus() { "FIELD, VARIABLE=1" } else { "TEMPERATURE" };
    sink.line(&format!("*INITIAL CONDITIONS, TYPE={kind}"))?;
    sink.rows(&FieldRows { block, prefix, moduli })
}

/// One row is one level of one plane.
struct FieldRows<'a> {
    block: &'a Block,
    prefix: &'a str,
    moduli: &'a [f64],
}

impl Rows for FieldRows<'_> {
    fn rows(&self) -> usize {
        self.block.planes() * self.group()
    }

    fn group(&self) -> usize {
        self.block.layers() + 1
    }

    fn weight(&self, row: usize) -> usize {
        self.block.plane_across(row / self.group()) + 1
    }

    fn render(&self, rows: Range<usize>, out: &mut Vec<u8>) {
        let levels = self.group();
        for row in rows {
            let (plane, level) = (row / levels, row % levels);
            let across = self.block.plane_across(plane);
            let tail = format!(",{}\n", real(self.moduli[plane]));
            let mut id = Counter::new(self.block.row_start(plane, level, across));
            for _ in 0..=across {
                out.extend_from_slice(self.prefix.as_bytes());
                out.extend_from_slice(id.text());
                out.extend_from_slice(tail.as_bytes());
                id.increment();
            }
        }
    }
}
