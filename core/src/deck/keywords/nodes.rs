//! `*NODE`.

use std::ops::Range;

use crate::deck::DeckError;
use crate::deck::number::{Coordinates, Counter, real};
use crate::deck::sink::{Rows, Sink};
use crate::mesh::{Block, Spacing};

/// Writes the nodes of a block.
pub(crate) fn nodes(sink: &mut Sink<'_>, block: &Block, format: Coordinates) -> Result<(), DeckError> {
    sink.line("*NODE")?;
    sink.rows(&NodeRows::new(block, format))
}

/// Adds reference nodes to the nodes just written: other programs read one `*NODE` block of a flat deck only.
pub(crate) fn more_nodes(sink: &mut Sink<'_>, nodes: &[(&str, u64, [f64; 3])]) -> Result<(), DeckError> {
    nodes.iter().try_for_each(|(_, id, [x, y, z])| sink.line(&format!("{id},{},{},{}", real(*x), real(*y), real(*z))))
}

/// Writes reference nodes as blocks of their own, each in a set of its own name.
pub(crate) fn reference_nodes(sink: &mut Sink<'_>, nodes: &[(&str, u64, [f64; 3])]) -> Result<(), DeckError> {
    for (name, id, [x, y, z]) in nodes {
        sink.line(&format!("*NODE, NSET={name}"))?;
        sink.line(&format!("{id},{},{},{}", real(*x), real(*y), real(*z)))?;
    }
    Ok(())
}

/// One row is one level of one plane.
struct NodeRows<'a> {
    block: &'a Block,
    format: Coordinates,
    /// Text of `,y,` by distance from the middle in elements plus half the widest plane, where planes share their spacing.
    shared: Vec<Vec<u8>>,
    widest: usize,
}

impl<'a> NodeRows<'a> {
    fn new(block: &'a Block, format: Coordinates) -> Self {
        let (wide, widest) =
            (0..block.planes()).map(|p| (p, block.plane_across(p))).max_by_key(|(_, n)| *n).unwrap_or_default();
        let shared = match block.spacing() {
            Spacing::Even(_) => y_texts(block, wide, format),
            Spacing::Width(_) => Vec::new(),
        };
        Self { block, format, shared, widest }
    }
}

fn y_texts(block: &Block, plane: usize, format: Coordinates) -> Vec<Vec<u8>> {
    (0..=block.plane_across(plane))
        .map(|j| {
            let mut text = vec![b','];
            format.put(&mut text, block.y(plane, j));
            text.push(b',');
            text
        })
        .collect()
}

impl Rows for NodeRows<'_> {
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
        let mut own: (usize, Vec<Vec<u8>>) = (usize::MAX, Vec::new());
        let (mut before, mut after) = (Vec::new(), Vec::new());
        for row in rows {
            let (plane, level) = (row / levels, row % levels);
            let across = self.block.plane_across(plane);
            let texts = if self.shared.is_empty() {
                if own.0 != plane {
                    own = (plane, y_texts(self.block, plane, self.format));
                }
                own.1.as_slice()
            } else {
                let skip = (self.widest - across) / 2;
                &self.shared[skip..=skip + across]
            };
            before.clear();
            before.push(b',');
            self.format.put(&mut before, self.block.x(plane));
            after.clear();
            self.format.put(&mut after, self.block.z(plane, level));
            after.push(b'\n');
            let mut id = Counter::new(self.block.row_start(plane, level, across));
            for y in texts {
                out.extend_from_slice(id.text());
                out.extend_from_slice(&before);
                out.extend_from_slice(y);
                out.extend_from_slice(&after);
                id.increment();
            }
        }
    }
}
