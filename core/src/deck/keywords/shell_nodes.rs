//! `*NODE` of spokes and hub as shells.

use std::ops::Range;

use crate::deck::DeckError;
use crate::deck::number::{Coordinates, Counter};
use crate::deck::sink::{Rows, Sink};
use crate::mesh::{Flower, HubPlate, Sheet};

/// Writes the nodes of the first `spokes` spokes of a flower, one spoke after the other.
pub(crate) fn spokes(
    sink: &mut Sink<'_>,
    sheet: &Sheet,
    flower: &Flower,
    spokes: usize,
    format: Coordinates,
) -> Result<(), DeckError> {
    sink.rows(&SpokeRows { sheet, flower, spokes, format })
}

/// Writes the nodes of the hub, numbered on from `offset`.
pub(crate) fn hub(sink: &mut Sink<'_>, plate: &HubPlate, offset: u64, format: Coordinates) -> Result<(), DeckError> {
    self::plate(sink, plate, offset, 0.0, format)
}

/// Writes the nodes of a plate at a height, mm, numbered on from `offset`.
pub(crate) fn plate(
    sink: &mut Sink<'_>,
    plate: &HubPlate,
    offset: u64,
    height: f64,
    format: Coordinates,
) -> Result<(), DeckError> {
    let mut tail = vec![b','];
    format.put(&mut tail, height);
    tail.push(b'\n');
    let rows = HubRows { plate, offset, format, tail };
    sink.line(&format!("{},0,0{}", offset + 1, String::from_utf8_lossy(&rows.tail).trim_end()))?;
    sink.rows(&rows)
}

/// One row is one row of one spoke's nodes.
struct SpokeRows<'a> {
    sheet: &'a Sheet,
    flower: &'a Flower,
    spokes: usize,
    format: Coordinates,
}

impl Rows for SpokeRows<'_> {
    fn rows(&self) -> usize {
        self.spokes * self.sheet.rows()
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
            let s = self.sheet.s(row);
            let mut id = Counter::new(spoke as u64 * self.sheet.nodes() + self.sheet.first_node(row));
            for index in 0..=self.sheet.row_across(row) {
                put(out, &mut id, self.flower.place(spoke, s, self.sheet.y(row, index)), self.format, b",0\n");
            }
        }
    }
}

/// One row is one line of nodes of a kite.
struct HubRows<'a> {
    plate: &'a HubPlate,
    offset: u64,
    format: Coordinates,
    /// `,z` and the end of the line.
    tail: Vec<u8>,
}

impl Rows for HubRows<'_> {
    fn rows(&self) -> usize {
        self.plate.kites() * self.plate.divisions()
    }

    fn group(&self) -> usize {
        1
    }

    fn weight(&self, _row: usize) -> usize {
        self.plate.divisions() + 1
    }

    fn render(&self, rows: Range<usize>, out: &mut Vec<u8>) {
        for row in rows {
            let (kite, a) = (row / self.plate.divisions(), row % self.plate.divisions() + 1);
            let mut id = Counter::new(self.offset + self.plate.node(kite, a, 0));
            for b in 0..=self.plate.divisions() {
                put(out, &mut id, self.plate.position(kite, a, b), self.format, &self.tail);
            }
        }
    }
}

/// Appends a node, whose `,z` and end of line are given, and counts on.
#[inline]
fn put(out: &mut Vec<u8>, id: &mut Counter, [x, y]: [f64; 2], format: Coordinates, tail: &[u8]) {
    out.extend_from_slice(id.text());
    out.push(b',');
    format.put(out, x);
    out.push(b',');
    format.put(out, y);
    out.extend_from_slice(tail);
    id.increment();
}
