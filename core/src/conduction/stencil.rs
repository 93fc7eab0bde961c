//! The operator of a coarse level: 27 numbers a node.

use super::operator::for_rows;

/// A symmetric 27-point operator on a box of nodes.
#[derive(Debug)]
pub(super) struct Stencil {
    nodes: [usize; 3],
    /// Row by row across; within a row the 27 entries, each for all nodes of the row.
    values: Vec<f64>,
    inverse_diagonal: Vec<f64>,
}

/// The entry of a node itself.
const CENTRE: usize = 13;

impl Stencil {
    /// A stencil from its values.
    pub(super) fn new(nodes: [usize; 3], values: Vec<f64>) -> Self {
        let across = nodes[2];
        let diagonal = values.chunks(27 * across).flat_map(|row| &row[CENTRE * across..(CENTRE + 1) * across]);
        let inverse_diagonal = diagonal.map(|d| if *d > 0.0 { 1.0 / d } else { 0.0 }).collect();
        Self { nodes, values, inverse_diagonal }
    }

    pub(super) fn inverse_diagonal(&self) -> &[f64] {
        &self.inverse_diagonal
    }

    /// `A u`.
    pub(super) fn apply(&self, u: &[f64], out: &mut [f64]) {
        let [planes, levels, across] = self.nodes;
        for_rows(out, across, |line, row| {
            row.fill(0.0);
            let (plane, level) = (line / levels, line % levels);
            let values = &self.values[line * 27 * across..(line + 1) * 27 * across];
            for p in plane.saturating_sub(1)..(plane + 2).min(planes) {
                for l in level.saturating_sub(1)..(level + 2).min(levels) {
                    let source = &u[(p * levels + l) * across..(p * levels + l + 1) * across];
                    let entry = ((p + 1 - plane) * 3 + (l + 1 - level)) * 3;
                    let of = |e: usize| &values[(entry + e) * across..(entry + e + 1) * across];
                    for ((o, s), u) in row.iter_mut().zip(of(1)).zip(source) {
                        *o += s * u;
                    }
                    for ((o, s), u) in row[1..].iter_mut().zip(&of(0)[1..]).zip(source) {
                        *o += s * u;
                    }
                    for ((o, s), u) in row.iter_mut().zip(of(2)).zip(&source[1..]) {
                        *o += s * u;
                    }
                }
            }
        });
    }

    /// The full matrix, row by row, for the coarsest level.
    pub(super) fn dense(&self) -> Vec<f64> {
        let n = self.inverse_diagonal.len();
        let mut unit = vec![0.0; n];
        let mut column = vec![0.0; n];
        let mut matrix = vec![0.0; n * n];
        for j in 0..n {
            unit[j] = 1.0;
            self.apply(&unit, &mut column);
            unit[j] = 0.0;
            for (i, value) in column.iter().enumerate() {
                matrix[i * n + j] = *value;
            }
        }
        matrix
    }
}
