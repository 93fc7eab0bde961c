//! Coarse levels by Galerkin's products, brick by brick.
//!
//! Linear interpolation within a coarse cell needs its eight nodes only, so the coarse operator `P^T A P` is again a sum of
//! 8 x 8 matrices, each the sum of `P_c^T K_c P_c` over the (up to eight) cells it holds. That is exact for any conductivities,
//! voids and shapes of cells.
//!
//! A direction is halved where its cells are about as short as the shortest; otherwise it waits. A direction of one cell that is
//! due is *collapsed*: both its layers of nodes get one value. A thin plate thus becomes a sheet before its cells would
//! become flat, which point smoothers do not like.

use rayon::prelude::*;

use super::brick::Matrix;
use super::stencil::Stencil;

/// Cells after which it is asked whether to go on.
const ASK_EVERY: usize = 1024;
/// Lines of nodes after which it is.
const LINES: usize = 16;

/// What happens to one direction from a level to the next.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Step {
    /// Nothing.
    Keep,
    /// Two cells become one.
    Halve,
    /// The two layers of nodes of the only cell become one.
    Collapse,
}

/// Cells of a level that give their matrices.
pub(super) trait Elements: Sync {
    /// Number of cells along, through and across.
    fn cells(&self) -> [usize; 3];
    /// Directions that have one layer of nodes only.
    fn collapsed(&self) -> [bool; 3];
    /// Nodes whose value is given.
    fn given(&self) -> &[bool];
    /// The matrix of a cell; `false` where the cell is void.
    fn matrix(&self, cell: [usize; 3], out: &mut Matrix) -> bool;

    /// Number of nodes along, through and across.
    fn nodes(&self) -> [usize; 3] {
        node_counts(self.cells(), self.collapsed())
    }
}

fn node_counts(cells: [usize; 3], collapsed: [bool; 3]) -> [usize; 3] {
    std::array::from_fn(|d| if collapsed[d] { 1 } else { cells[d] + 1 })
}

/// The steps from a level with these cells to the next; `None` where no direction can become coarser.
pub(super) fn steps(cells: [usize; 3], collapsed: [bool; 3], edges: [f64; 3]) -> Option<[Step; 3]> {
    let open = |d: usize| !collapsed[d];
    let shortest = (0..3).filter(|d| open(*d)).map(|d| edges[d]).fold(f64::INFINITY, f64::min);
    let step = |d: usize| {
        if !open(d) || edges[d] > 1.7 * shortest {
            Step::Keep
        } else if cells[d] == 1 {
            Step::Collapse
        } else {
            Step::Halve
        }
    };
    let steps = [step(0), step(1), step(2)];
    // The last open direction stays open: a single unknown would be of no use.
    let closing = (0..3).filter(|d| open(*d)).all(|d| steps[d] == Step::Collapse);
    (!closing && steps.iter().any(|s| *s != Step::Keep)).then_some(steps)
}

/// Cells of a coarse level with their matrices.
pub(super) struct CoarseElements {
    cells: [usize; 3],
    collapsed: [bool; 3],
    given: Vec<bool>,
    matrices: Vec<Matrix>,
}

impl Elements for CoarseElements {
    fn cells(&self) -> [usize; 3] {
        self.cells
    }

    fn collapsed(&self) -> [bool; 3] {
        self.collapsed
    }

    fn given(&self) -> &[bool] {
        &self.given
    }

    fn matrix(&self, [i, k, j]: [usize; 3], out: &mut Matrix) -> bool {
        *out = self.matrices[(i * self.cells[1] + k) * self.cells[2] + j];
        (0..8).any(|a| out[9 * a] != 0.0)
    }
}

/// Numbers of a cell's nodes; of a collapsed direction both ends are the same.
fn cell_nodes(nodes: [usize; 3], [i, k, j]: [usize; 3]) -> [usize; 8] {
    std::array::from_fn(|a| {
        let [p, l, c] = [i + (a >> 2 & 1), k + (a >> 1 & 1), j + (a & 1)];
        let within = |index: usize, d: usize| index.min(nodes[d] - 1);
        (within(p, 0) * nodes[1] + within(l, 1)) * nodes[2] + within(c, 2)
    })
}

/// Zeroes the rows and columns of nodes whose value is given.
fn mask(matrix: &mut Matrix, given: &[bool], nodes: &[usize; 8]) {
    for (a, node) in nodes.iter().enumerate() {
        if given[*node] {
            for b in 0..8 {
                matrix[8 * a + b] = 0.0;
                matrix[8 * b + a] = 0.0;
            }
        }
    }
}

/// The next coarser level's cells; `None` where `go_on` says no.
pub(super) fn coarsen(
    fine: &dyn Elements,
    steps: [Step; 3],
    go_on: &(dyn Fn() -> bool + Sync),
) -> Option<CoarseElements> {
    let (fine_cells, fine_nodes) = (fine.cells(), fine.nodes());
    let cells: [usize; 3] = std::array::from_fn(|d| match steps[d] {
        Step::Halve => fine_cells[d].div_ceil(2),
        Step::Keep | Step::Collapse => fine_cells[d],
    });
    let collapsed = std::array::from_fn(|d| fine.collapsed()[d] || steps[d] == Step::Collapse);
    let nodes = node_counts(cells, collapsed);
    let given = coarse_given(fine.given(), fine_nodes, nodes, steps);
    let children = |c: usize, d: usize| match steps[d] {
        Step::Halve => 2 * c..(2 * c + 2).min(fine_cells[d]),
        Step::Keep | Step::Collapse => c..c + 1,
    };
    let one = |n: usize| {
        if n.is_multiple_of(ASK_EVERY) && !go_on() {
            return None;
        }
        let cell = [n / (cells[1] * cells[2]), n / cells[2] % cells[1], n % cells[2]];
        let mut sum = [0.0; 64];
        let mut matrix = [0.0; 64];
        for i in children(cell[0], 0) {
            for k in children(cell[1], 1) {
                for j in children(cell[2], 2) {
                    let child = [i, k, j];
                    if !fine.matrix(child, &mut matrix) {
                        continue;
                    }
                    mask(&mut matrix, fine.given(), &cell_nodes(fine_nodes, child));
                    for (d, step) in steps.into_iter().enumerate() {
                        project(&mut matrix, d, step, child[d] % 2);
                    }
                    for (s, m) in sum.iter_mut().zip(&matrix) {
                        *s += m;
                    }
                }
            }
        }
        mask(&mut sum, &given, &cell_nodes(nodes, cell));
        Some(sum)
    };
    let many = 0..cells.iter().product();
    let matrices = many.into_par_iter().with_min_len(64).map(one).collect::<Option<Vec<Matrix>>>()?;
    Some(CoarseElements { cells, collapsed, given, matrices })
}

/// A coarse node is given where the fine node it sits on is.
fn coarse_given(fine: &[bool], fine_nodes: [usize; 3], nodes: [usize; 3], steps: [Step; 3]) -> Vec<bool> {
    let mut given = Vec::with_capacity(nodes.iter().product());
    let fine_index = |c: usize, d: usize| match steps[d] {
        Step::Halve => 2 * c..2 * c + 1,
        Step::Keep => c..c + 1,
        Step::Collapse => 0..2,
    };
    for p in 0..nodes[0] {
        for l in 0..nodes[1] {
            for c in 0..nodes[2] {
                let mut all = true;
                for i in fine_index(p, 0) {
                    for k in fine_index(l, 1) {
                        for j in fine_index(c, 2) {
                            let inside = i < fine_nodes[0] && k < fine_nodes[1] && j < fine_nodes[2];
                            all &= inside && fine[(i * fine_nodes[1] + k) * fine_nodes[2] + j];
                        }
                    }
                }
                given.push(all);
            }
        }
    }
    given
}

/// `P^T M P` for one direction; `second` tells which half of the coarse cell the child is.
fn project(matrix: &mut Matrix, direction: usize, step: Step, second: usize) {
    let bit = 4 >> direction;
    // Fine values by coarse ones: u_0 = t00 U_0 + t01 U_1, u_1 = t10 U_0 + t11 U_1.
    let [t00, t01, t10, t11] = match (step, second) {
        (Step::Keep, _) => return,
        (Step::Halve, 0) => [1.0, 0.0, 0.5, 0.5],
        (Step::Halve, _) => [0.5, 0.5, 0.0, 1.0],
        (Step::Collapse, _) => [1.0, 0.0, 1.0, 0.0],
    };
    for a in (0..8_usize).filter(|a| a & bit == 0) {
        for b in 0..8 {
            let (low, high) = (matrix[8 * a + b], matrix[8 * (a | bit) + b]);
            matrix[8 * a + b] = t00 * low + t10 * high;
            matrix[8 * (a | bit) + b] = t01 * low + t11 * high;
        }
    }
    for b in (0..8_usize).filter(|b| b & bit == 0) {
        for a in 0..8 {
            let (low, high) = (matrix[8 * a + b], matrix[8 * a + (b | bit)]);
            matrix[8 * a + b] = t00 * low + t10 * high;
            matrix[8 * a + (b | bit)] = t01 * low + t11 * high;
        }
    }
}

impl CoarseElements {
    /// The 27-point stencils of the level's nodes; `None` where `go_on` says no.
    pub(super) fn stencil(&self, go_on: &(dyn Fn() -> bool + Sync)) -> Option<Stencil> {
        let nodes = self.nodes();
        let [_, levels, across] = nodes;
        let per_line = 27 * across;
        let mut values = vec![0.0; per_line * nodes[0] * levels];
        let around = |index: usize, d: usize| -> Vec<(usize, usize)> {
            if self.collapsed[d] {
                return vec![(0, 0)];
            }
            let before = index.checked_sub(1).map(|c| (c, 1));
            before.into_iter().chain((index < self.cells[d]).then_some((index, 0))).collect()
        };
        let all = values.par_chunks_mut(per_line).enumerate().try_for_each(|(line, out)| {
            if line.is_multiple_of(LINES) && !go_on() {
                return None;
            }
            let (plane, level) = (line / levels, line % levels);
            for (i, a) in around(plane, 0) {
                for (k, b) in around(level, 1) {
                    for c in 0..across {
                        for (j, e) in around(c, 2) {
                            let matrix = &self.matrices[(i * self.cells[1] + k) * self.cells[2] + j];
                            let row = 4 * a + 2 * b + e;
                            for column in 0..8_usize {
                                let value = matrix[8 * row + column];
                                // Offsets -1, 0, 1 of the neighbour, as 0, 1, 2.
                                let offset = |own: usize, d: usize| {
                                    if self.collapsed[d] { 1 } else { (column >> (2 - d) & 1) + 1 - own }
                                };
                                let entry = (3 * offset(a, 0) + offset(b, 1)) * 3 + offset(e, 2);
                                out[entry * across + c] += value;
                            }
                        }
                    }
                }
            }
            Some(())
        });
        all.map(|()| Stencil::new(nodes, values))
    }
}
