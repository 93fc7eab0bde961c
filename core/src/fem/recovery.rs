//! What is read off a solution: mid-line, reactions, strains and stresses.

use nalgebra::Matrix3;
use rayon::prelude::*;

use super::FemError;
use super::assembly::{Forces, State};
use super::element::{COMPONENTS, MODES, NODES, PAIRS, Voigt};
use super::mesh::Mesh;
use super::model::Model;
use crate::progress::Cancelled;

/// Elements after which it is asked whether to go on.
const ASK_EVERY: usize = 512;

/// What an end of the strip is held by, in the signs of the elastica.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EndReaction {
    /// `H`, N: positive when the seat pushes the rim inward; the same along the whole strip.
    pub horizontal: f64,
    /// `V`, N: positive when the hub is pushed up; the same along the whole strip.
    pub vertical: f64,
    /// Bending moment at the end, N mm.
    pub moment: f64,
}

/// What both ends are held by.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reactions {
    /// At the rim.
    pub rim: EndReaction,
    /// At the hub.
    pub hub: EndReaction,
}

/// Mid-line `[s, x, z]`, mm, rim first and seen from it; where no node lies on it, the mean of the two beside it.
#[must_use]
pub fn midline(mesh: &Mesh, displacements: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let point = |plane: usize| {
        let of = |k: usize| {
            let mean: f64 = mesh.midline_nodes(plane).iter().map(|n| mesh.nodes[*n][k] + displacements[*n][k]).sum();
            0.5 * mean
        };
        [mesh.nodes[mesh.planes[plane]][0], of(0), of(2)]
    };
    let [_, rim_x, rim_z] = point(0);
    (0..mesh.plane_count())
        .map(|plane| {
            let [s, x, z] = point(plane);
            [s, x - rim_x, z - rim_z]
        })
        .collect()
}

/// Reactions of the two end sections; `rim_x` is where the rim's mid-line point was moved to.
#[must_use]
pub fn reactions(mesh: &Mesh, displacements: &[[f64; 3]], forces: &Forces, rim_x: f64) -> Reactions {
    let hub = mesh.plane_count() - 1;
    let [a, b] = mesh.midline_nodes(hub);
    let at = |n: usize, k: usize| mesh.nodes[n][k] + displacements[n][k];
    let hub_point = [0.5 * (at(a, 0) + at(b, 0)), 0.5 * (at(a, 2) + at(b, 2))];
    // Resultant and moment about y of the forces that hold a plane.
    let resultant = |plane: usize, [x0, z0]: [f64; 2]| {
        mesh.plane(plane).fold([0.0; 3], |[x, z, moment], n| {
            let [fx, _, fz] = forces.of_nodes[n];
            [x + fx, z + fz, moment + (at(n, 2) - z0) * fx - (at(n, 0) - x0) * fz]
        })
    };
    let [rim_force, rim_lift, rim_moment] = resultant(0, [rim_x, 0.0]);
    let [hub_force, hub_lift, hub_moment] = resultant(hub, hub_point);
    Reactions {
        rim: EndReaction { horizontal: rim_force, vertical: -rim_lift, moment: rim_moment },
        hub: EndReaction { horizontal: -hub_force, vertical: hub_lift, moment: -hub_moment },
    }
}

/// Strains and stresses, one entry an element, means over its Gauss points.
#[derive(Debug, Clone, PartialEq)]
pub struct ElementResults {
    /// Green-Lagrange strain, enhanced modes included, shears doubled.
    pub strains: Vec<Voigt>,
    /// Second Piola-Kirchhoff stress, MPa.
    pub stresses: Vec<Voigt>,
    /// Largest principal stretch less one, over the Gauss points.
    pub principal_strains: Vec<f64>,
}

impl ElementResults {
    pub(crate) fn of(model: &Model, state: &State, cancelled: Cancelled<'_>) -> Result<Self, FemError> {
        let count = model.mesh.elements.len();
        let mean = |values: &[Voigt; NODES]| -> Voigt {
            std::array::from_fn(|k| values.iter().map(|v| v[k]).sum::<f64>() / NODES as f64)
        };
        let of = |i: usize| {
            if i.is_multiple_of(ASK_EVERY) && cancelled() {
                return None;
            }
            let u = state.of_element(&model.mesh.elements[i]);
            let mut modes = state.modes.get(i).copied().unwrap_or([0.0; MODES]);
            let points = model.brick(i).recover(model.law, &u, &mut modes);
            let largest = points.strains.iter().map(largest_principal).fold(f64::MIN, f64::max);
            Some((mean(&points.strains), mean(&points.stresses), largest))
        };
        let found = (0..count).into_par_iter().map(of).collect::<Option<Vec<_>>>().ok_or(FemError::Cancelled)?;
        let mut results = Self {
            strains: Vec::with_capacity(count),
            stresses: Vec::with_capacity(count),
            principal_strains: Vec::with_capacity(count),
        };
        for (strain, stress, largest) in found {
            results.strains.push(strain);
            results.stresses.push(stress);
            results.principal_strains.push(largest);
        }
        Ok(results)
    }

    /// Largest principal strain of every phase; `None` for phases without an element.
    #[must_use]
    pub fn largest_by_phase(&self, phases: &[u8], count: usize) -> Vec<Option<f64>> {
        by_phase(phases, count, self.principal_strains.iter().copied())
    }

    /// Largest von Mises stress of every phase, of the elements' mean second Piola-Kirchhoff stress, MPa; `None` for phases
    /// without an element.
    #[must_use]
    pub fn largest_von_mises_by_phase(&self, phases: &[u8], count: usize) -> Vec<Option<f64>> {
        by_phase(phases, count, self.stresses.iter().map(von_mises))
    }
}

fn by_phase(phases: &[u8], count: usize, values: impl Iterator<Item = f64>) -> Vec<Option<f64>> {
    let mut largest: Vec<Option<f64>> = vec![None; count];
    for (phase, value) in phases.iter().zip(values) {
        if let Some(place) = largest.get_mut(usize::from(*phase)) {
            *place = Some(place.map_or(value, |p: f64| p.max(value)));
        }
    }
    largest
}

/// Von Mises stress.
fn von_mises([xx, yy, zz, xy, yz, xz]: &Voigt) -> f64 {
    let normal = (xx - yy).powi(2) + (yy - zz).powi(2) + (zz - xx).powi(2);
    (0.5 * normal + 3.0 * (xy * xy + yz * yz + xz * xz)).sqrt()
}

/// `sqrt(1 + 2 E_1) - 1` for the largest eigenvalue `E_1` of a Green-Lagrange strain.
fn largest_principal(strain: &Voigt) -> f64 {
    let tensor = Matrix3::from_fn(|i, j| {
        let component = PAIRS.iter().position(|p| *p == [i.min(j), i.max(j)]).unwrap_or(COMPONENTS - 1);
        if i == j { strain[component] } else { 0.5 * strain[component] }
    });
    let largest = tensor.symmetric_eigenvalues().max();
    (1.0 + 2.0 * largest).max(0.0).sqrt() - 1.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn von_mises_is_that_of_tension_and_of_shear() {
        assert_eq!(von_mises(&[-7.0, 0.0, 0.0, 0.0, 0.0, 0.0]), 7.0);
        assert!((von_mises(&[2.0, 2.0, 2.0, 0.0, 3.0, 0.0]) - 27.0_f64.sqrt()).abs() < 1e-12);
        assert_eq!(by_phase(&[0, 2, 0], 3, [1.0, 5.0, 2.0].into_iter()), [Some(2.0), None, Some(5.0)]);
    }

    #[test]
    fn the_principal_strain_of_a_shear_is_that_of_its_diagonal() {
        assert!((largest_principal(&[0.0, 0.0, 0.0, 0.2, 0.0, 0.0]) - (1.2_f64.sqrt() - 1.0)).abs() < 1e-15);
        assert!((largest_principal(&[0.22, -0.1, 0.0, 0.0, 0.0, 0.0]) - 0.2).abs() < 1e-15);
    }
}
