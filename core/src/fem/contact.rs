//! Rigid planes that nodes of a strip may touch, without friction.
//!
//! A plane with unit normal `n` keeps a node at `x` where `g = n . x - offset <= 0`. The force on the node is `-p n` with
//! `p = max(0, multiplier + stiffness g)` (augmented Lagrangian): Newton's method solves for given multipliers, with `stiffness n n^T` in
//! the tangent of the nodes that touch, which is a semi-smooth Newton method and loses no convergence; then the
//! multipliers become `p`, until nothing penetrates by more than is allowed. The stiffness then only decides how many turns that takes.

use super::assembly::State;
use super::mesh::Mesh;
use super::pattern::{NodeUnknowns, Pattern};

/// A node and the plane that may keep it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Obstacle {
    /// The node.
    pub node: usize,
    /// Unit normal, pointing into the obstacle.
    pub normal: [f64; 3],
    /// Distance of the plane from the origin along it, mm.
    pub offset: f64,
    /// Force so far, N.
    pub multiplier: f64,
}

/// All obstacles of a strip.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Contact {
    /// One a node and plane.
    pub obstacles: Vec<Obstacle>,
    /// Force a millimetre of penetration in Newton's method, N/mm.
    pub stiffness: f64,
}

impl Obstacle {
    /// How deep the node is inside the obstacle, mm; negative outside.
    #[must_use]
    pub fn penetration(&self, mesh: &Mesh, state: &State) -> f64 {
        let (at, moved) = (mesh.nodes[self.node], state.displacements[self.node]);
        (0..3).map(|k| self.normal[k] * (at[k] + moved[k])).sum::<f64>() - self.offset
    }
}

impl Contact {
    fn force(&self, obstacle: &Obstacle, mesh: &Mesh, state: &State) -> f64 {
        (obstacle.multiplier + self.stiffness * obstacle.penetration(mesh, state)).max(0.0)
    }

    /// Forces on the touching nodes, N: number of the obstacle and `p`.
    pub fn forces<'a>(&'a self, mesh: &'a Mesh, state: &'a State) -> impl Iterator<Item = (usize, f64)> + 'a {
        let of = move |(i, o): (usize, &Obstacle)| (i, self.force(o, mesh, state));
        self.obstacles.iter().enumerate().map(of).filter(|(_, p)| *p > 0.0)
    }

    /// Adds what the obstacles take to the forces that hold the nodes.
    pub(super) fn add_forces(&self, mesh: &Mesh, state: &State, of_nodes: &mut [[f64; 3]]) {
        for (i, force) in self.forces(mesh, state) {
            let obstacle = &self.obstacles[i];
            for (total, n) in of_nodes[obstacle.node].iter_mut().zip(obstacle.normal) {
                *total += force * n;
            }
        }
    }

    /// Adds the stiffness of the touching nodes to the tangent.
    pub(super) fn add_tangent(&self, mesh: &Mesh, state: &State, pattern: &Pattern, values: &mut [f64]) {
        for (i, _) in self.forces(mesh, state) {
            let obstacle = &self.obstacles[i];
            if let NodeUnknowns::Free(first) = pattern.nodes[obstacle.node] {
                for k in 0..3 {
                    let start = pattern.columns[first as usize + k];
                    for l in k..3 {
                        values[start + l - k] += self.stiffness * obstacle.normal[k] * obstacle.normal[l];
                    }
                }
            }
        }
    }

    /// Takes the forces over as multipliers; returns the deepest penetration, mm.
    pub fn settle(&mut self, mesh: &Mesh, state: &State) -> f64 {
        let forces: Vec<f64> = self.obstacles.iter().map(|o| self.force(o, mesh, state)).collect();
        let mut deepest = 0.0_f64;
        for (obstacle, force) in self.obstacles.iter_mut().zip(forces) {
            deepest = deepest.max(obstacle.penetration(mesh, state));
            obstacle.multiplier = force;
        }
        deepest
    }
}
