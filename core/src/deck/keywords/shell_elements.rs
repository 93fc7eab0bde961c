//! `*ELEMENT` of spokes and hub as shells.

use std::ops::Range;

use crate::deck::DeckError;
use crate::deck::number::Counter;
use crate::deck::sink::{Rows, Sink};
use crate::mesh::{HubPlate, Sheet};

/// Writes the elements of some spokes, one spoke after the other.
pub(crate) fn spokes(sink: &mut Sink<'_>, sheet: &Sheet, spokes: usize) -> Result<(), DeckError> {
    sink.rows(&SpokeRows { sheet, spokes })
}

/// Writes the elements of the hub; nodes and elements are numbered on from the offsets.
pub(crate) fn hub(sink: &mut Sink<'_>, plate: &HubPlate, nodes: u64, elements: u64) -> Result<(), DeckError> {
    sink.rows(&HubRows { plate, nodes, elements })
}

/// One row is one slice of one spoke.
struct SpokeRows<'a> {
    sheet: &'a Sheet,
    spokes: usize,
}

impl Rows for SpokeRows<'_> {
    fn rows(&self) -> usize {
        self.spokes * self.sheet.slices()
    }

    fn group(&self) -> usize {
        1
    }

    fn weight(&self, row: usize) -> usize {
        self.sheet.slice_across(row % self.sheet.slices())
    }

    fn render(&self, rows: Range<usize>, out: &mut Vec<u8>) {
        for row in rows {
            let (spoke, slice) = ((row / self.sheet.slices()) as u64, row % self.sheet.slices());
            let [a, b, c, d] = self.sheet.connectivity(slice).map(|n| Counter::new(spoke * self.sheet.nodes() + n));
            let first = Counter::new(spoke * self.sheet.elements() + self.sheet.first_element(slice));
            let mut numbers = [first, a, b, c, d];
            for _ in 0..self.sheet.slice_across(slice) {
                put(out, &mut numbers);
            }
        }
    }
}

/// One row is one line of elements of a kite.
struct HubRows<'a> {
    plate: &'a HubPlate,
    nodes: u64,
    elements: u64,
}

impl Rows for HubRows<'_> {
    fn rows(&self) -> usize {
        self.plate.kites() * self.plate.divisions()
    }

    fn group(&self) -> usize {
        1
    }

    fn weight(&self, _row: usize) -> usize {
        self.plate.divisions()
    }

    fn render(&self, rows: Range<usize>, out: &mut Vec<u8>) {
        for row in rows {
            let (kite, a) = (row / self.plate.divisions(), row % self.plate.divisions());
            for b in 0..self.plate.divisions() {
                let [p, q, r, s] = self.plate.connectivity(kite, a, b).map(|n| Counter::new(self.nodes + n));
                put(out, &mut [Counter::new(self.elements + self.plate.element(kite, a, b)), p, q, r, s]);
            }
        }
    }
}

/// Appends a line and counts on.
#[inline]
fn put(out: &mut Vec<u8>, numbers: &mut [Counter; 5]) {
    for (i, number) in numbers.iter_mut().enumerate() {
        if i > 0 {
            out.push(b',');
        }
        out.extend_from_slice(number.text());
        number.increment();
    }
    out.push(b'\n');
}
