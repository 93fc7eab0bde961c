//! Forces and tangent of a whole strip.
//!
//! Element answers are computed in parallel, a batch at a time, and added in the order of the elements, so the sums do not
//! depend on the number of threads.

use rayon::prelude::*;

use super::FemError;
use super::element::{DOFS, ElementVector, MODES};
use super::error::go_on;
use super::model::Model;
use super::pattern::Pattern;
use crate::progress::Cancelled;

/// Elements between two questions whether to go on; their answers are held at once.
const BATCH: usize = 512;

/// A deformed strip.
#[derive(Debug, Clone, PartialEq)]
pub struct State {
    /// Displacement of every node, mm.
    pub displacements: Vec<[f64; 3]>,
    /// Enhanced modes of every element, for laws that need them; else empty.
    pub modes: Vec<[f64; MODES]>,
}

impl State {
    /// A strip with given displacements.
    #[must_use]
    pub fn new(model: &Model, displacements: Vec<[f64; 3]>) -> Self {
        let modes = if model.law.needs_modes() { vec![[0.0; MODES]; model.mesh.elements.len()] } else { Vec::new() };
        Self { displacements, modes }
    }

    /// Displacements of an element's nodes.
    #[must_use]
    pub fn of_element(&self, nodes: &[u32; 8]) -> ElementVector {
        let mut u = [0.0; DOFS];
        for (place, node) in u.chunks_exact_mut(3).zip(nodes) {
            place.copy_from_slice(&self.displacements[*node as usize]);
        }
        u
    }
}

/// The forces that hold a strip.
#[derive(Debug, Clone, PartialEq)]
pub struct Forces {
    /// Strain energy, N mm.
    pub energy: f64,
    /// Force on every node that holds it where it is, N: zero in equilibrium, a reaction where it is prescribed.
    pub of_nodes: Vec<[f64; 3]>,
    /// Root of the sum of squares of all element forces, N: what rounding errors and residuals compare with.
    pub scale: f64,
}

impl Forces {
    fn zero(nodes: usize) -> Self {
        Self { energy: 0.0, of_nodes: vec![[0.0; 3]; nodes], scale: 0.0 }
    }

    fn add(&mut self, element: &[u32; 8], energy: f64, residual: &ElementVector) {
        self.energy += energy;
        for (force, node) in residual.chunks_exact(3).zip(element) {
            let total = &mut self.of_nodes[*node as usize];
            for (t, f) in total.iter_mut().zip(force) {
                *t += f;
                self.scale += f * f;
            }
        }
    }
}

/// Forces of a strip; `None` where an element is turned inside out.
///
/// # Errors
/// [`FemError::Cancelled`].
pub fn forces(model: &Model, state: &mut State, cancelled: Cancelled<'_>) -> Result<Option<Forces>, FemError> {
    let mut total = Forces::zero(model.mesh.nodes.len());
    for start in (0..model.mesh.elements.len()).step_by(BATCH) {
        go_on(cancelled)?;
        let elements = &model.mesh.elements[start..(start + BATCH).min(model.mesh.elements.len())];
        let answer = |i: usize, modes: &mut [f64; MODES]| {
            model.brick(start + i).residual(model.law, &state.of_element(&elements[i]), modes)
        };
        let batch: Vec<_> = if state.modes.is_empty() {
            (0..elements.len()).into_par_iter().map(|i| (answer(i, &mut [0.0; MODES]), [0.0; MODES])).collect()
        } else {
            let modes = &state.modes[start..start + elements.len()];
            (0..elements.len())
                .into_par_iter()
                .map(|i| {
                    let mut modes = modes[i];
                    (answer(i, &mut modes), modes)
                })
                .collect()
        };
        for (i, (answer, modes)) in batch.into_iter().enumerate() {
            let Some(answer) = answer else { return Ok(None) };
            total.add(&elements[i], answer.energy, &answer.residual);
            if let Some(place) = state.modes.get_mut(start + i) {
                *place = modes;
            }
        }
    }
    total.scale = total.scale.sqrt();
    Ok(total.energy.is_finite().then_some(total))
}

/// Writes the tangent of a strip into `values`, in the order of the pattern. `false` where an element is turned inside out.
///
/// # Errors
/// [`FemError::Cancelled`].
pub fn tangent(
    model: &Model,
    pattern: &Pattern,
    state: &State,
    values: &mut [f64],
    cancelled: Cancelled<'_>,
) -> Result<bool, FemError> {
    values.fill(0.0);
    for start in (0..model.mesh.elements.len()).step_by(BATCH) {
        go_on(cancelled)?;
        let elements = &model.mesh.elements[start..(start + BATCH).min(model.mesh.elements.len())];
        let batch: Vec<_> = elements
            .par_iter()
            .enumerate()
            .with_min_len(16)
            .map(|(i, element)| {
                let mut modes = state.modes.get(start + i).copied().unwrap_or([0.0; MODES]);
                let mut matrix = [[0.0; DOFS]; DOFS];
                let u = state.of_element(element);
                model.brick(start + i).tangent(model.law, &u, &mut modes, &mut matrix).map(|_| matrix)
            })
            .collect();
        for (i, matrix) in batch.iter().enumerate() {
            let Some(matrix) = matrix else { return Ok(false) };
            pattern.scatter(start + i, &elements[i], matrix, values);
        }
    }
    Ok(true)
}
