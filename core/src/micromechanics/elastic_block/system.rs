//! Assembly and solution.

use super::brick::{Brick, DOFS};
use super::grid::Grid;
use super::support::{CASES, Support};
use crate::numerics::sparse_cholesky::Pattern;

/// Entries of the lower triangle of an element's stiffness.
const TRIANGLE: usize = DOFS * (DOFS + 1) / 2;
/// Marks a prescribed degree of freedom, and an entry that belongs to one.
const NONE: u32 = u32::MAX;

/// A supported block, ready to be solved for many arrangements of phases.
#[derive(Debug)]
pub(crate) struct BlockSystem {
    grid: Grid,
    support: Support,
    /// Number of each degree of freedom among the free ones, or [`NONE`].
    free: Vec<u32>,
    unknowns: usize,
    pattern: Pattern,
    /// For every element, where its lower triangle goes.
    slots: Vec<u32>,
}

impl BlockSystem {
    /// Analyses a block. `None` where there is not enough memory.
    pub(crate) fn new(grid: Grid, support: Support) -> Option<Self> {
        let mut unknowns = 0_u32;
        let free: Vec<u32> = support
            .prescribed()
            .iter()
            .map(|prescribed| match prescribed {
                Some(_) => NONE,
                None => {
                    unknowns += 1;
                    unknowns - 1
                }
            })
            .collect();
        let (mut columns, mut rows) = (vec![0_u32], Vec::new());
        for (dof, column) in free.iter().enumerate().filter(|(_, column)| **column != NONE) {
            let of_node = |node: usize| (3 * node..3 * node + 3).map(|dof| free[dof]);
            let below = grid.neighbours(dof / 3).flat_map(of_node).filter(|row| *row != NONE && row >= column);
            rows.extend(below);
            columns.push(rows.len() as u32);
        }
        let pattern = Pattern::new(columns, rows)?;
        let mut slots = Vec::with_capacity(TRIANGLE * grid.elements());
        for element in 0..grid.elements() {
            let dofs = element_dofs(&grid, element);
            for p in 0..DOFS {
                for q in 0..=p {
                    let (a, b) = (free[dofs[p]], free[dofs[q]]);
                    let slot =
                        if a == NONE || b == NONE { None } else { pattern.slot(a.max(b) as usize, a.min(b) as usize) };
                    slots.push(slot.map_or(NONE, |slot| slot as u32));
                }
            }
        }
        Some(Self { grid, support, free, unknowns: unknowns as usize, pattern, slots })
    }

    /// Twice the elastic energy that the load cases `c` and `d` share, N mm: `S_cd = u_c^T K u_d`.
    ///
    /// `phase` says which of `bricks` an element is. `None` where the stiffness is not positive definite.
    pub(crate) fn energies(&self, bricks: &[Brick], phase: &[u8]) -> Option<[[f64; CASES]; CASES]> {
        let mut entries = vec![0.0; self.pattern.entries()];
        let mut sides = vec![0.0; self.support.cases() * self.unknowns];
        for element in 0..self.grid.elements() {
            let brick = &bricks[usize::from(phase[element])];
            let slots = &self.slots[TRIANGLE * element..TRIANGLE * (element + 1)];
            let mut slot = slots.iter();
            for (p, row) in brick.iter().enumerate() {
                for (value, slot) in row[..=p].iter().zip(slot.by_ref()) {
                    if *slot != NONE {
                        entries[*slot as usize] += self.grid.edge * value;
                    }
                }
            }
            let dofs = element_dofs(&self.grid, element);
            for (q, dof) in dofs.iter().enumerate() {
                let Some(values) = self.support.prescribed()[*dof].filter(|v| v.iter().any(|v| *v != 0.0)) else {
                    continue;
                };
                for (p, dof) in dofs.iter().enumerate() {
                    let row = self.free[*dof];
                    if row != NONE {
                        for (case, value) in values.iter().take(self.support.cases()).enumerate() {
                            sides[case * self.unknowns + row as usize] -= self.grid.edge * brick[p][q] * value;
                        }
                    }
                }
            }
        }
        self.pattern.factorise(&entries)?.solve(&mut sides);
        let mut energies = [[0.0; CASES]; CASES];
        for element in 0..self.grid.elements() {
            let brick = &bricks[usize::from(phase[element])];
            let moved = element_dofs(&self.grid, element).map(|dof| self.displacement(&sides, dof));
            for (row, left) in brick.iter().zip(&moved) {
                let mut force = [0.0; CASES];
                for (stiffness, right) in row.iter().zip(&moved) {
                    for (force, right) in force.iter_mut().zip(right) {
                        *force += stiffness * right;
                    }
                }
                for (energies, left) in energies.iter_mut().zip(left) {
                    for (energy, force) in energies.iter_mut().zip(&force) {
                        *energy += self.grid.edge * left * force;
                    }
                }
            }
        }
        Some(energies)
    }

    fn displacement(&self, solution: &[f64], dof: usize) -> [f64; CASES] {
        match self.support.prescribed()[dof] {
            Some(values) => values,
            None => {
                let row = self.free[dof] as usize;
                std::array::from_fn(|case| solution.get(case * self.unknowns + row).copied().unwrap_or(0.0))
            }
        }
    }
}

fn element_dofs(grid: &Grid, element: usize) -> [usize; DOFS] {
    let nodes = grid.connectivity(element);
    std::array::from_fn(|p| 3 * nodes[p / 3] + p % 3)
}
