//! The conduction operator on the finest mesh, without a matrix.
//!
//! ```text
//! (A u)_n = sum over the cells c at n:  kappa_c sum_b K_ab u_b  +  d_n u_n
//! ```
//!
//! Every node gathers from the up to eight cells around it, row by row across the strip, so threads never write to the same
//! place and the result does not depend on how work is shared among them. `d` is the lumped capacity of a time step.

use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;

use super::ConductionError;
use super::brick::Matrix;
use super::mesh::{BrickMesh, VOID};
use super::pcg::Watch;

/// Below so many nodes threads cost more than they save.
const SMALL: usize = 12_000;

/// Lines of nodes after which it is asked whether to go on.
const ASK_EVERY: usize = 64;

/// The same while the operator is applied.
const OFTEN: usize = 1024;

/// Nodes that a thread takes at a time.
const TASK: usize = 4_000;

/// Calls `f(line, row)` for every row of `length` entries, in parallel where there are many.
pub(super) fn for_rows(out: &mut [f64], length: usize, f: impl Fn(usize, &mut [f64]) + Sync) {
    if out.len() < SMALL {
        out.chunks_mut(length).enumerate().for_each(|(line, row)| f(line, row));
    } else {
        let lines = TASK.div_ceil(length);
        out.par_chunks_mut(length * lines).enumerate().for_each(|(task, rows)| {
            rows.chunks_mut(length).enumerate().for_each(|(n, row)| f(task * lines + n, row));
        });
    }
}

/// The operator of a mesh.
#[derive(Debug)]
pub struct Operator<'a> {
    mesh: &'a BrickMesh,
    /// Conductivity of every cell, zero where void.
    conductivity: Vec<f64>,
    /// Capacity of every material per volume, over the time step; empty without a time step.
    capacity: Vec<f64>,
    /// The lumped capacities, empty without a time step.
    shift: Vec<f64>,
    /// Cells across every slice that are not void: first and one past the last.
    extent: Vec<[usize; 2]>,
    /// Nodes whose value is given.
    given: &'a [bool],
    /// Reciprocals of the diagonal; zero at nodes that are given or belong to no cell.
    inverse_diagonal: Vec<f64>,
}

impl<'a> Operator<'a> {
    /// The operator for the conductivities and, with a time step, the capacities per volume over it, a material each.
    /// `given` marks the nodes whose value is prescribed.
    ///
    /// # Errors
    /// [`ConductionError::Cancelled`] where `watch` says so.
    pub fn new(
        mesh: &'a BrickMesh,
        conductivities: &[f64],
        capacities: &[f64],
        given: &'a [bool],
        watch: Watch<'_>,
    ) -> Result<Self, ConductionError> {
        let value =
            |m: u16, values: &[f64]| if m == VOID { 0.0 } else { values.get(usize::from(m)).copied().unwrap_or(0.0) };
        let conductivity: Vec<f64> = mesh.materials().par_iter().map(|m| value(*m, conductivities)).collect();
        watch.at(0.0)?;
        let per_slice = mesh.cells()[1] * mesh.cells()[2];
        let across = mesh.cells()[2];
        let extent = mesh
            .materials()
            .par_chunks(per_slice)
            .map(|slice| {
                let rows = || slice.chunks(across);
                let first = rows().filter_map(|row| row.iter().position(|m| *m != VOID)).min();
                let last = rows().filter_map(|row| row.iter().rposition(|m| *m != VOID)).max();
                [first.unwrap_or(0), last.map_or(0, |last| last + 1)]
            })
            .collect();
        watch.at(0.0)?;
        let mut operator = Self {
            mesh,
            conductivity,
            capacity: capacities.to_vec(),
            shift: Vec::new(),
            extent,
            given,
            inverse_diagonal: Vec::new(),
        };
        if !capacities.is_empty() {
            operator.shift = operator.gather(watch, |i, k, j, a| {
                value(mesh.materials()[operator.cell(i, k, j)], capacities) * mesh.bricks().at(i, k, j).volumes[a]
            })?;
        }
        let mut diagonal = operator.gather(watch, |i, k, j, a| {
            operator.conductivity[operator.cell(i, k, j)] * mesh.bricks().at(i, k, j).conductance[9 * a]
        })?;
        watch.at(0.0)?;
        for (n, d) in diagonal.iter_mut().enumerate() {
            let full = *d + operator.shift.get(n).copied().unwrap_or(0.0);
            *d = if given[n] || full <= 0.0 { 0.0 } else { 1.0 / full };
        }
        operator.inverse_diagonal = diagonal;
        Ok(operator)
    }

    /// The mesh.
    #[must_use]
    pub fn mesh(&self) -> &'a BrickMesh {
        self.mesh
    }

    /// Reciprocals of the diagonal; zero at nodes that are given or belong to no cell.
    #[must_use]
    pub fn inverse_diagonal(&self) -> &[f64] {
        &self.inverse_diagonal
    }

    fn cell(&self, i: usize, k: usize, j: usize) -> usize {
        (i * self.mesh.cells()[1] + k) * self.mesh.cells()[2] + j
    }

    /// Sums a quantity of the cells at every node.
    fn gather(
        &self,
        watch: Watch<'_>,
        f: impl Fn(usize, usize, usize, usize) -> f64 + Sync,
    ) -> Result<Vec<f64>, ConductionError> {
        let [slices, layers, across] = self.mesh.cells();
        let mut out = vec![0.0; self.mesh.nodes()];
        let stopped = AtomicBool::new(false);
        for_rows(&mut out, across + 1, |line, row| {
            if line.is_multiple_of(ASK_EVERY) && !watch.goes_on() {
                stopped.store(true, Ordering::Relaxed);
            }
            if stopped.load(Ordering::Relaxed) {
                return;
            }
            let (plane, level) = (line / (layers + 1), line % (layers + 1));
            for (i, a) in neighbours(plane, slices) {
                let [first, end] = self.extent[i];
                for (k, b) in neighbours(level, layers) {
                    for j in first..end {
                        row[j] += f(i, k, j, 4 * a + 2 * b);
                        row[j + 1] += f(i, k, j, 4 * a + 2 * b + 1);
                    }
                }
            }
        });
        if stopped.into_inner() { Err(ConductionError::Cancelled) } else { Ok(out) }
    }

    /// `A u` at all nodes, given ones included: the flux that enters there. Where `go_on` says no, the rest of `out` is zero.
    pub fn flux(&self, u: &[f64], out: &mut [f64], go_on: &(dyn Fn() -> bool + Sync)) {
        let levels = self.mesh.cells()[1] + 1;
        let stopped = AtomicBool::new(false);
        for_rows(out, self.mesh.cells()[2] + 1, |line, row| {
            row.fill(0.0);
            if line.is_multiple_of(OFTEN) && !go_on() {
                stopped.store(true, Ordering::Relaxed);
            }
            if stopped.load(Ordering::Relaxed) {
                return;
            }
            let (plane, level) = (line / levels, line % levels);
            for (i, a) in neighbours(plane, self.mesh.cells()[0]) {
                for (k, b) in neighbours(level, levels - 1) {
                    self.add_row(i, k, 4 * a + 2 * b, u, row);
                }
            }
        });
        if !self.shift.is_empty() {
            for_rows(out, self.mesh.cells()[2] + 1, |line, row| {
                let start = line * row.len();
                for (n, o) in row.iter_mut().enumerate() {
                    *o += self.shift[start + n] * u[start + n];
                }
            });
        }
    }

    /// `A u` at the free nodes, zero at the others, and where `go_on` says no.
    pub fn apply(&self, u: &[f64], out: &mut [f64], go_on: &(dyn Fn() -> bool + Sync)) {
        self.flux(u, out, go_on);
        for_rows(out, self.mesh.cells()[2] + 1, |line, row| {
            let start = line * row.len();
            for (o, d) in row.iter_mut().zip(&self.inverse_diagonal[start..]) {
                if *d == 0.0 {
                    *o = 0.0;
                }
            }
        });
    }

    /// Flux that the cells of every slice take from the plane of nodes before them: what flows through the slice, positive from
    /// the rim to the far end (where `u` falls).
    ///
    /// # Errors
    /// [`ConductionError::Cancelled`] where `watch` says so.
    pub fn slice_fluxes(&self, u: &[f64], watch: Watch<'_>) -> Result<Vec<f64>, ConductionError> {
        let [slices, layers, _] = self.mesh.cells();
        let through = |i: usize| {
            watch.at(1.0)?;
            let mut total = 0.0;
            for k in 0..layers {
                for j in self.extent[i][0]..self.extent[i][1] {
                    let kappa = self.conductivity[self.cell(i, k, j)];
                    if kappa == 0.0 {
                        continue;
                    }
                    let nodes = self.mesh.cell_nodes([i, k, j]);
                    let matrix = &self.mesh.bricks().at(i, k, j).conductance;
                    // Rows sum to zero, so a common value may be taken off first: less is lost to rounding.
                    let common = u[nodes[0]];
                    let flux: f64 =
                        (0..4).map(|a| (0..8).map(|b| matrix[8 * a + b] * (u[nodes[b]] - common)).sum::<f64>()).sum();
                    total += kappa * flux;
                }
            }
            Ok(total)
        };
        (0..slices).into_par_iter().map(through).collect()
    }

    /// Adds what the cells of one row contribute to the nodes of one of the four rows of nodes around it.
    fn add_row(&self, i: usize, k: usize, first_corner: usize, u: &[f64], out: &mut [f64]) {
        let [first, end] = self.extent[i];
        if first >= end {
            return;
        }
        let n = end - first;
        let cells = self.cell(i, k, first);
        let kappa = &self.conductivity[cells..cells + n];
        let row = |a: usize| {
            let start = self.mesh.node([i + (a >> 1), k + (a & 1), first]);
            &u[start..=start + n]
        };
        let (u0, u1, u2, u3) = (row(0), row(1), row(2), row(3));
        let out = &mut out[first..=first + n];
        if self.mesh.bricks().same_across() {
            let matrix = &self.mesh.bricks().at(i, k, first).conductance;
            let pick = |row: usize| -> [f64; 8] { std::array::from_fn(|b| matrix[8 * row + b]) };
            add_near(kappa, &pick(first_corner), [u0, u1, u2, u3], &mut out[..n]);
            add_near(kappa, &pick(first_corner + 1), [u0, u1, u2, u3], &mut out[1..]);
        } else {
            for (j, kappa) in kappa.iter().enumerate() {
                let matrix = &self.mesh.bricks().at(i, k, first + j).conductance;
                let values = [u0[j], u0[j + 1], u1[j], u1[j + 1], u2[j], u2[j + 1], u3[j], u3[j + 1]];
                let dot = |row: usize| (0..8).map(|b| matrix[8 * row + b] * values[b]).sum::<f64>();
                out[j] += kappa * dot(first_corner);
                out[j + 1] += kappa * dot(first_corner + 1);
            }
        }
    }
}

/// `out_j += kappa_j sum_b m_b u_b` for a row of cells with one matrix; in a form that compilers turn into vector code.
fn add_near(kappa: &[f64], m: &[f64; 8], [u0, u1, u2, u3]: [&[f64]; 4], out: &mut [f64]) {
    let n = kappa.len();
    let (out, u0, u1, u2, u3) = (&mut out[..n], &u0[..=n], &u1[..=n], &u2[..=n], &u3[..=n]);
    for (j, (o, kappa)) in out.iter_mut().zip(kappa).enumerate() {
        let even = m[0] * u0[j] + m[2] * u1[j] + m[4] * u2[j] + m[6] * u3[j];
        let odd = m[1] * u0[j + 1] + m[3] * u1[j + 1] + m[5] * u2[j + 1] + m[7] * u3[j + 1];
        *o += kappa * (even + odd);
    }
}

/// The cells before and after a plane of nodes, each with the plane's place in them.
fn neighbours(plane: usize, cells: usize) -> impl Iterator<Item = (usize, usize)> + Clone {
    let before = plane.checked_sub(1).map(|i| (i, 1));
    let after = (plane < cells).then_some((plane, 0));
    before.into_iter().chain(after)
}

/// Where a multigrid hierarchy takes the matrices of its first coarse level from.
impl super::galerkin::Elements for Operator<'_> {
    fn cells(&self) -> [usize; 3] {
        self.mesh.cells()
    }

    fn collapsed(&self) -> [bool; 3] {
        [false; 3]
    }

    fn given(&self) -> &[bool] {
        self.given
    }

    fn matrix(&self, [i, k, j]: [usize; 3], out: &mut Matrix) -> bool {
        let cell = self.cell(i, k, j);
        let material = self.mesh.materials()[cell];
        if material == VOID {
            return false;
        }
        let brick = self.mesh.bricks().at(i, k, j);
        let kappa = self.conductivity[cell];
        let capacity = self.capacity.get(usize::from(material)).copied().unwrap_or(0.0);
        if kappa == 0.0 && capacity == 0.0 {
            return false;
        }
        for (o, m) in out.iter_mut().zip(&brick.conductance) {
            *o = kappa * m;
        }
        if capacity != 0.0 {
            for (a, volume) in brick.volumes.iter().enumerate() {
                out[9 * a] += capacity * volume;
            }
        }
        true
    }
}
