//! The elastica as a chain of straight links with springs between them, pressed from above.
//!
//! Links of length `h` have inclinations `theta_j`; node `i` lies between links `i` and `i + 1`. With bending energy
//!
//! ```text
//! U = sum_i B_i (theta_(i+1) - theta_i)^2 / (2 h) + [B_0 (theta_1 - theta(0))^2 + B_n (theta(L) - theta_n)^2] / h
//! ```
//!
//! an equilibrium is a stationary point of `U + H (x(L) - span) - V (z(L) - height) + sum_i P_i g_i`, where
//! `g_i = z_i + t/2 cos(theta at i) - z_plate` is how far the upper face at node `i` stands above the plate and `P_i >= 0`
//! the force there: `P_i g_i = 0`, `g_i <= 0`. `H` and `V` are those of [`crate::elastica`]. The error falls with `h^2`.
//!
//! Newton's method is applied to all of it at once, the set of touching nodes being those with `P_i > 0` or `g_i > 0`
//! (a primal-dual active set, which is a semi-smooth Newton method and converges as fast). Stiffness in the inclinations is
//! tridiagonal; the forces follow from a small dense complement.

use nalgebra::{DMatrix, DVector};

use crate::numerics::tridiagonal::{Tridiagonal, negative_eigenvalues};

/// Most iterations from one start.
const MAX_ITERATIONS: usize = 80;
/// Largest change of an inclination in one iteration, rad.
const LARGEST_TURN: f64 = 0.15;
/// Rounds in which all nodes may come and go at once.
const ALL_AT_ONCE: usize = 12;
/// Change of inclinations at which an equilibrium counts as found, rad.
const TOLERANCE: f64 = 1e-10;
/// Penetration that is no contact, as a share of the thickness.
const SMALLEST_GAP: f64 = 1e-7;
/// Tension that is rounding, as a share of the largest force.
const SMALLEST_FORCE: f64 = 1e-9;

/// The strip and what holds it.
#[derive(Debug, Clone)]
pub(super) struct Chain {
    /// Length of a link, mm.
    pub link: f64,
    /// Bending stiffness at the nodes, rim and hub included, N mm^2.
    pub stiffness: Vec<f64>,
    /// Half the thickness, mm.
    pub half_thickness: f64,
    /// Inclinations at rim and hub, rad.
    pub angles: [f64; 2],
    /// Distance of the hub from the rim, mm.
    pub span: f64,
}

/// What is prescribed at the hub.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Hub {
    /// The vertical force, N.
    Force(f64),
    /// The height, mm.
    Height(f64),
}

/// A plate above the strip.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Plate {
    /// Its height, mm.
    pub height: f64,
    /// It covers what is at most so far from the hub end of the strip, mm.
    pub reach: f64,
}

/// A shape and the forces that hold it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Shape {
    /// Inclinations of the links, rad.
    pub inclination: Vec<f64>,
    /// `H`, N.
    pub horizontal: f64,
    /// `V` at the hub, N.
    pub vertical: f64,
    /// Touching nodes and the plate's forces on them, N, rim first.
    pub contact: Vec<(usize, f64)>,
    /// Iterations spent.
    pub iterations: usize,
}

/// Why Newton's method stopped.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Stop {
    /// No equilibrium.
    Diverged { iterations: usize, residual: f64 },
    /// The set of touching nodes does not settle.
    Unsettled { rounds: usize, changes: usize },
}

/// Derivatives at a shape.
struct Tangent {
    factors: Tridiagonal,
    /// Rows of the constraints: span, hub, touching nodes.
    rows: Vec<Vec<f64>>,
    negative: usize,
}

impl Shape {
    /// Force of the plate on the strip, N.
    pub fn contact_force(&self) -> f64 {
        self.contact.iter().fold(0.0, |sum, (_, p)| sum + p)
    }

    /// Vertical force that the rim carries, N: `V` there.
    pub fn rim_vertical(&self) -> f64 {
        self.vertical - self.contact_force()
    }
}

impl Chain {
    fn links(&self) -> usize {
        self.stiffness.len() - 1
    }

    /// Inclination at a node.
    fn at_node(&self, inclination: &[f64], node: usize) -> f64 {
        match node {
            0 => self.angles[0],
            n if n == self.links() => self.angles[1],
            n => 0.5 * (inclination[n - 1] + inclination[n]),
        }
    }

    /// Positions of the nodes, mm.
    pub fn positions(&self, inclination: &[f64]) -> Vec<[f64; 2]> {
        let mut at = [0.0; 2];
        let mut all = Vec::with_capacity(inclination.len() + 1);
        all.push(at);
        for theta in inclination {
            at = [at[0] + self.link * theta.cos(), at[1] + self.link * theta.sin()];
            all.push(at);
        }
        all
    }

    /// Points of the upper face above the nodes, mm.
    pub fn upper_face(&self, inclination: &[f64]) -> Vec<[f64; 2]> {
        let up = |(i, [x, z]): (usize, [f64; 2])| {
            let (sin, cos) = self.at_node(inclination, i).sin_cos();
            [x - self.half_thickness * sin, z + self.half_thickness * cos]
        };
        self.positions(inclination).into_iter().enumerate().map(up).collect()
    }

    /// Curvatures at the nodes, 1/mm.
    pub fn curvatures(&self, inclination: &[f64]) -> Vec<f64> {
        let n = self.links();
        let at = |i: usize| match i {
            0 => 2.0 * (inclination[0] - self.angles[0]) / self.link,
            i if i == n => 2.0 * (self.angles[1] - inclination[n - 1]) / self.link,
            i => (inclination[i] - inclination[i - 1]) / self.link,
        };
        (0..=n).map(at).collect()
    }

    /// Strain energy, N mm.
    pub fn energy(&self, inclination: &[f64]) -> f64 {
        let n = self.links();
        let share = |i: usize| if i == 0 || i == n { 0.25 } else { 0.5 };
        let curvatures = self.curvatures(inclination);
        self.stiffness.iter().zip(&curvatures).enumerate().map(|(i, (b, k))| share(i) * self.link * b * k * k).sum()
    }

    /// Spring constants of the nodes, N mm.
    fn spring(&self, node: usize) -> f64 {
        let ends = if node == 0 || node == self.links() { 2.0 } else { 1.0 };
        ends * self.stiffness[node] / self.link
    }

    /// Derivatives of the energy and the loads by the inclinations.
    fn residual(&self, shape: &Shape) -> Vec<f64> {
        let (n, h, theta) = (self.links(), self.link, &shape.inclination);
        let mut residual = vec![0.0; n];
        let mut above: f64 = shape.contact.iter().map(|(_, p)| p).sum();
        let mut touching = shape.contact.iter().peekable();
        for j in 0..n {
            let before = if j == 0 { self.angles[0] } else { theta[j - 1] };
            let after = if j + 1 == n { self.angles[1] } else { theta[j + 1] };
            let (sin, cos) = theta[j].sin_cos();
            residual[j] += self.spring(j) * (theta[j] - before)
                - self.spring(j + 1) * (after - theta[j])
                - h * (shape.horizontal * sin + (shape.vertical - above) * cos);
            if let Some((_, p)) = touching.next_if(|(i, _)| *i == j + 1) {
                above -= p;
                let turned = 0.5 * p * self.half_thickness * self.at_node(theta, j + 1).sin();
                residual[j] -= turned;
                residual[j + 1] -= turned;
            }
        }
        residual
    }

    fn tangent(&self, shape: &Shape, hub: Hub) -> Option<Tangent> {
        let (n, h, theta) = (self.links(), self.link, &shape.inclination);
        let mut diagonal: Vec<f64> = (0..n).map(|j| self.spring(j) + self.spring(j + 1)).collect();
        let mut beside: Vec<f64> = (1..n).map(|i| -self.spring(i)).collect();
        let mut above: f64 = shape.contact.iter().map(|(_, p)| p).sum();
        let mut touching = shape.contact.iter().peekable();
        for j in 0..n {
            let (sin, cos) = theta[j].sin_cos();
            diagonal[j] -= h * (shape.horizontal * cos - (shape.vertical - above) * sin);
            if let Some((_, p)) = touching.next_if(|(i, _)| *i == j + 1) {
                above -= p;
                let turned = 0.25 * p * self.half_thickness * self.at_node(theta, j + 1).cos();
                diagonal[j] -= turned;
                diagonal[j + 1] -= turned;
                beside[j] -= turned;
            }
        }
        let mut rows = vec![theta.iter().map(|t| -h * t.sin()).collect::<Vec<f64>>()];
        if let Hub::Height(_) = hub {
            rows.push(theta.iter().map(|t| -h * t.cos()).collect());
        }
        for (node, _) in &shape.contact {
            let turned = 0.5 * self.half_thickness * self.at_node(theta, *node).sin();
            let mut row: Vec<f64> = theta[..*node].iter().map(|t| h * t.cos()).collect();
            row.resize(n, 0.0);
            row[node - 1] -= turned;
            row[*node] -= turned;
            rows.push(row);
        }
        let negative = negative_eigenvalues(&diagonal, &beside);
        Tridiagonal::factor(&diagonal, &beside).map(|factors| Tangent { factors, rows, negative })
    }

    /// What the constraints miss: span, height, gaps of the touching nodes.
    fn misfit(&self, shape: &Shape, hub: Hub, plate: Option<Plate>) -> Vec<f64> {
        let positions = self.positions(&shape.inclination);
        let [x, z] = positions[self.links()];
        let mut misfit = vec![x - self.span];
        if let Hub::Height(height) = hub {
            misfit.push(height - z);
        }
        let level = plate.map_or(0.0, |p| p.height);
        misfit.extend(shape.contact.iter().map(|(node, _)| {
            positions[*node][1] + self.half_thickness * self.at_node(&shape.inclination, *node).cos() - level
        }));
        misfit
    }

    /// The equilibrium near a shape.
    pub fn solve(&self, start: &Shape, hub: Hub, plate: Option<Plate>) -> Result<Shape, Stop> {
        let mut shape = start.clone();
        if plate.is_none() {
            shape.contact.clear();
        }
        if let Hub::Force(force) = hub {
            shape.vertical = force;
        }
        // What the plate covers is taken from the start: a node that slides under its edge would come and go.
        let covered = plate.map(|plate| self.covered(&shape, plate));
        let (mut rounds, mut changes) = (0, 0);
        let mut largest = f64::INFINITY;
        for iterations in 1..=MAX_ITERATIONS {
            let diverged = Stop::Diverged { iterations, residual: largest };
            let step = self.step(&shape, hub, plate).ok_or(diverged)?;
            largest = step.inclination.iter().fold(0.0_f64, |m, d| m.max(d.abs()));
            if !largest.is_finite() {
                return Err(diverged);
            }
            let share = (LARGEST_TURN / largest).min(1.0);
            shape.move_by(&step, share, matches!(hub, Hub::Height(_)));
            changes = match (plate, &covered) {
                (Some(plate), Some(covered)) => self.update_contact(&mut shape, plate, covered, rounds >= ALL_AT_ONCE),
                _ => 0,
            };
            rounds += usize::from(changes > 0);
            if changes == 0 && share == 1.0 && largest <= TOLERANCE {
                shape.iterations = iterations;
                return Ok(shape);
            }
        }
        if changes > 0 {
            Err(Stop::Unsettled { rounds, changes })
        } else {
            Err(Stop::Diverged { iterations: MAX_ITERATIONS, residual: largest })
        }
    }

    /// One Newton step: changes of inclinations and of all forces.
    fn step(&self, shape: &Shape, hub: Hub, plate: Option<Plate>) -> Option<Step> {
        let tangent = self.tangent(shape, hub)?;
        let mut free: Vec<f64> = self.residual(shape).iter().map(|r| -r).collect();
        tangent.factors.solve(&mut free);
        let answers = tangent.answers();
        let misfit = self.misfit(shape, hub, plate);
        let complement = tangent.complement(&answers);
        // C (free - K^-1 C^T f) = -misfit.
        let target = DVector::from_fn(misfit.len(), |i, _| misfit[i] + dot(&tangent.rows[i], &free));
        let forces = complement.lu().solve(&target)?;
        for (answer, force) in answers.iter().zip(forces.iter()) {
            free.iter_mut().zip(answer).for_each(|(d, a)| *d -= force * a);
        }
        Some(Step { inclination: free, forces: forces.iter().copied().collect() })
    }

    /// Which nodes' faces the plate covers.
    fn covered(&self, shape: &Shape, plate: Plate) -> Vec<bool> {
        let far = self.span - plate.reach;
        self.upper_face(&shape.inclination).iter().map(|[x, _]| *x >= far).collect()
    }

    /// Nodes that come into contact or leave it; returns how many. `one` lets only the node go that is pulled most, or if
    /// there is none the one come that is deepest: slower, but it does not go round in circles.
    fn update_contact(&self, shape: &mut Shape, plate: Plate, covered: &[bool], one: bool) -> usize {
        let face = self.upper_face(&shape.inclination);
        let largest = shape.contact.iter().fold(shape.horizontal.abs(), |m, (_, p)| m.max(p.abs()));
        let (tension, depth) = (SMALLEST_FORCE * largest, SMALLEST_GAP * 2.0 * self.half_thickness);
        let mut gone: Vec<(usize, f64)> = shape.contact.iter().copied().filter(|(_, p)| *p <= -tension).collect();
        let touching = |node: usize| shape.contact.binary_search_by_key(&node, |(i, _)| *i).is_ok();
        let mut come: Vec<(usize, f64)> = (1..face.len() - 1)
            .filter(|i| covered[*i] && !touching(*i))
            .map(|i| (i, face[i][1] - plate.height))
            .filter(|(_, above)| *above > depth)
            .collect();
        if one && gone.len() + come.len() > 1 {
            gone.sort_by(|a, b| a.1.total_cmp(&b.1));
            gone.truncate(1);
            come.sort_by(|a, b| b.1.total_cmp(&a.1));
            come.truncate(usize::from(gone.is_empty()));
        }
        shape.contact.retain(|(i, _)| gone.iter().all(|(g, _)| g != i));
        shape.contact.extend(come.iter().map(|(i, _)| (*i, 0.0)));
        shape.contact.sort_by_key(|(i, _)| *i);
        gone.len() + come.len()
    }

    /// Stiffness `dF/dD` of a shape whose hub is at a given height, N/mm, and whether it is stable.
    pub fn stiffness_at(&self, shape: &Shape) -> Option<(f64, bool)> {
        let tangent = self.tangent(shape, Hub::Height(0.0))?;
        let complement = tangent.complement(&tangent.answers());
        // The whole system has as many negative eigenvalues as constraints where the energy is least under them.
        let positive = complement.clone().symmetric_eigenvalues().iter().filter(|e| **e > 0.0).count();
        let stable = tangent.negative + positive == tangent.rows.len();
        let mut lifted = DVector::zeros(tangent.rows.len());
        lifted[1] = 1.0;
        let forces = complement.lu().solve(&lifted)?;
        // The plate goes with the hub: it takes its part of the force.
        Some((forces[1], stable))
    }
}

/// Changes of inclinations, and of `H`, `V` and the contact forces.
struct Step {
    inclination: Vec<f64>,
    forces: Vec<f64>,
}

impl Shape {
    fn move_by(&mut self, step: &Step, share: f64, held: bool) {
        self.inclination.iter_mut().zip(&step.inclination).for_each(|(t, d)| *t += share * d);
        let mut forces = step.forces.iter().map(|f| share * f);
        self.horizontal += forces.next().unwrap_or(0.0);
        if held {
            self.vertical += forces.next().unwrap_or(0.0);
        }
        self.contact.iter_mut().zip(forces).for_each(|((_, p), d)| *p += d);
    }
}

impl Tangent {
    /// `K^-1 C^T`.
    fn answers(&self) -> Vec<Vec<f64>> {
        let answer = |row: &Vec<f64>| {
            let mut x = row.clone();
            self.factors.solve(&mut x);
            x
        };
        self.rows.iter().map(answer).collect()
    }

    /// `C K^-1 C^T`.
    fn complement(&self, answers: &[Vec<f64>]) -> DMatrix<f64> {
        let n = self.rows.len();
        DMatrix::from_fn(n, n, |i, j| dot(&self.rows[i], &answers[j]))
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
