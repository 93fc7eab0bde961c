//! `*ELEMENT`.

use std::ops::Range;

use crate::deck::DeckError;
use crate::deck::number::Counter;
use crate::deck::sink::{Rows, Sink};
use crate::mesh::Block;
use crate::voxel::VoxelGrid;

/// Writes all elements of a block, into one set.
pub(crate) fn elements(sink: &mut Sink<'_>, block: &Block, kind: &str, set: &str) -> Result<(), DeckError> {
    sink.line(&format!("*ELEMENT, TYPE={kind}, ELSET={set}"))?;
    sink.rows(&ElementRows { block, voxels: None })
}

/// Writes the elements of a block that lie in voxels of one phase, into one set; `per_edge` elements lie along a voxel's
/// edge.
pub(crate) fn phase_elements(
    sink: &mut Sink<'_>,
    block: &Block,
    kind: &str,
    set: &str,
    (grid, per_edge, phase): (&VoxelGrid, usize, u8),
) -> Result<(), DeckError> {
    sink.line(&format!("*ELEMENT, TYPE={kind}, ELSET={set}"))?;
    sink.rows(&ElementRows { block, voxels: Some((grid, per_edge, phase)) })
}

/// One row is one layer of one slice.
struct ElementRows<'a> {
    block: &'a Block,
    voxels: Option<(&'a VoxelGrid, usize, u8)>,
}

impl Rows for ElementRows<'_> {
    fn rows(&self) -> usize {
        self.block.slices() * self.group()
    }

    fn group(&self) -> usize {
        self.block.layers()
    }

    fn weight(&self, row: usize) -> usize {
        self.block.slice_across(row / self.group())
    }

    fn render(&self, rows: Range<usize>, out: &mut Vec<u8>) {
        let layers = self.group();
        for row in rows {
            let (slice, layer) = (row / layers, row % layers);
            let across = self.block.slice_across(slice);
            let mut numbers = [Counter::new(0); 9];
            numbers[0] = Counter::new(self.block.first_element(slice) + (layer * across) as u64);
            for (number, node) in numbers[1..].iter_mut().zip(self.block.row_connectivity(slice, layer)) {
                *number = Counter::new(node);
            }
            match self.voxels {
                None => (0..across).for_each(|_| put(out, &mut numbers)),
                Some((grid, per_edge, wanted)) => {
                    let width = across / per_edge;
                    let start = layer / per_edge * width;
                    for phase in &grid.slice(slice / per_edge)[start..start + width] {
                        for _ in 0..per_edge {
                            if *phase == wanted {
                                put(out, &mut numbers);
                            } else {
                                numbers.iter_mut().for_each(Counter::increment);
                            }
                        }
                    }
                }
            }
        }
    }
}

/// Appends a line and counts on.
#[inline]
fn put(out: &mut Vec<u8>, numbers: &mut [Counter; 9]) {
    for (i, number) in numbers.iter_mut().enumerate() {
        if i > 0 {
            out.push(b',');
        }
        out.extend_from_slice(number.text());
        number.increment();
    }
    out.push(b'\n');
}
