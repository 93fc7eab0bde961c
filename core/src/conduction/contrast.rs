//! Phases whose conductivities differ by so much that one system would lose the smaller ones to rounding.
//!
//! With the conducting phase `C` and the insulating one `I`, `A = A_C + e A_I` and `e` may be 1e-16. The solution is split:
//!
//! ```text
//! u = a + w      w: differences within the connected parts of C;   a: one value a part, and the values inside I
//! ```
//!
//! `A_C a = 0` exactly, so `A u = A_C w + e A_I (a + w)` loses nothing however small `e` is. The two unknowns are solved in turn,
//! each in a well-scaled system: `w` from `A_C w = f - e A_I (a + w)`, `a` from the balance of every part of `C` and every node
//! inside `I`, divided by `e`. They influence each other by `e` only, so two or three turns are enough.
//!
//! A part of `C` that touches nodes of one given value has that value in `a`; one that touches several carries current
//! and has them in `w`.

use super::ConductionError;
use super::components::{Components, NONE};
use super::mesh::{BrickMesh, VOID};
use super::operator::Operator;
use super::pcg::{self, Iterations, System, Watch, combine, dot};
use super::steady::{Apart, Boundary, LARGEST_CONTRAST, Plain, Steady, SteadyOptions, mask};

/// Conductivity of the conducting phase, relative to the insulating one, in the preconditioner of the latter.
const RIGID: f64 = 1e3;

/// Most turns.
const MOST_SWEEPS: usize = 12;

/// Solves a problem whose conductivities (`present`, ascending) fall into two groups.
pub(super) fn solve(
    mesh: &BrickMesh,
    conductivities: &[f64],
    present: &[f64],
    boundary: &Boundary,
    options: &SteadyOptions,
    watch: Watch<'_>,
) -> Result<Steady, ConductionError> {
    let (least, most) = (present[0], present[present.len() - 1]);
    // The widest gap divides the phases.
    let gap = present.windows(2).map(|w| w[1] / w[0]).fold(1.0, f64::max);
    let weak = present.windows(2).find(|w| w[1] / w[0] >= gap).map_or(least, |w| w[0]);
    let strong_least = present.iter().copied().find(|k| *k > weak).unwrap_or(most);
    if weak / least > LARGEST_CONTRAST || most / strong_least > LARGEST_CONTRAST {
        return Err(ConductionError::Contrast { least, most, limit: LARGEST_CONTRAST });
    }
    let group = |strong: bool, unit: f64| -> Vec<f64> {
        conductivities.iter().map(|k| if (*k > weak) == strong { k / unit } else { 0.0 }).collect()
    };
    let (strong, weaker) = (group(true, most), group(false, weak));
    let stiffened: Vec<f64> = weaker.iter().zip(&strong).map(|(w, s)| if *s > 0.0 { RIGID * s } else { *w }).collect();
    let parts = Parts::new(mesh, &strong, boundary, watch)?;
    watch.at(0.0)?;
    let ratio = weak / most;

    let operator = Operator::new(mesh, &strong, &[], &boundary.given, watch)?;
    let mut conductor = Conductor { plain: Plain::new(operator, watch)?, parts: &parts };
    watch.at(0.05)?;
    let weak_operator = Operator::new(mesh, &weaker, &[], &parts.fixed, watch)?;
    watch.at(0.05)?;
    let weights = parts.weights(&weak_operator, watch)?;
    watch.at(0.05)?;
    let mut insulator = Insulator {
        preconditioner: Plain::new(Operator::new(mesh, &stiffened, &[], &parts.fixed, watch)?, watch)?,
        operator: weak_operator,
        parts: &parts,
        weights,
        full: vec![0.0; mesh.nodes()],
        product: vec![0.0; mesh.nodes()],
    };
    watch.at(0.1)?;

    let n = mesh.nodes();
    let mut differences = parts.lift(boundary);
    let mut levels = parts.start(boundary);
    let (mut load, mut flux, mut sum) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
    let mut scales = [0.0_f64; 2];
    let mut total = Iterations::default();
    for sweep in 1..=MOST_SWEEPS {
        let before = total.count;
        let share = |part: f64| 0.1 + 0.9 * (sweep as f64 - 1.0 + part) / (sweep as f64 + 1.0);
        let mut stage =
            |system: &mut dyn System, load: &[f64], which: usize, name: &'static str, total: &mut Iterations| {
                let mut correction = vec![0.0; n];
                // Measured against the largest load so far: later turns only correct.
                let mut trial = vec![0.0; n];
                system.precondition(load, &mut trial, &|| watch.goes_on());
                watch.at(share(0.5 * which as f64))?;
                scales[which] = scales[which].max(dot(load, &trial));
                let part = watch.part(share(0.5 * which as f64), share(0.5 + 0.5 * which as f64));
                let scale = Some(scales[which]);
                let (found, reached) = pcg::solve(system, load, &mut correction, options.tolerance, scale, part)?;
                total.count += found.count;
                total.residual = total.residual.max(if sweep > 1 { found.residual } else { 0.0 });
                if reached {
                    Ok(correction)
                } else {
                    Err(ConductionError::NotConverged {
                        stage: name,
                        iterations: found.count,
                        residual: found.residual,
                        tolerance: options.tolerance.relative,
                        least,
                        most,
                    })
                }
            };

        // A_C w = f - e A_I (a + w).
        add(&levels, &differences, &mut sum);
        insulator.operator.flux(&sum, &mut flux, &|| watch.goes_on());
        watch.at(share(0.0))?;
        conductor.plain.operator.flux(&differences, &mut load, &|| watch.goes_on());
        watch.at(share(0.0))?;
        for ((l, f), b) in load.iter_mut().zip(&flux).zip(&boundary.loads) {
            *l = b / most - *l - ratio * f;
        }
        mask(&mut load, conductor.plain.operator.inverse_diagonal());
        watch.at(share(0.0))?;
        parts.remove_means(&mut load);
        let correction = stage(&mut conductor, &load, 0, "current within the conducting phase", &mut total)?;
        watch.at(share(0.5))?;
        combine(1.0, &correction, 1.0, &mut differences);
        let means = parts.remove_means(&mut differences);
        parts.raise(&mut levels, &means);

        // Balance of every part and every node inside the insulating phase.
        add(&levels, &differences, &mut sum);
        insulator.operator.flux(&sum, &mut flux, &|| watch.goes_on());
        watch.at(share(0.5))?;
        for ((l, f), b) in load.iter_mut().zip(&flux).zip(&boundary.loads) {
            *l = b / weak - f;
        }
        watch.at(share(0.5))?;
        parts.gather(&mut load);
        let correction = stage(&mut insulator, &load, 1, "potentials inside the insulating phase", &mut total)?;
        parts.spread_into(&correction, &mut insulator.full);
        combine(1.0, &insulator.full, 1.0, &mut levels);
        if sweep > 1 && total.count == before {
            add(&levels, &differences, &mut sum);
            let through = conductor.plain.operator.slice_fluxes(&differences, watch)?;
            let around = insulator.operator.slice_fluxes(&sum, watch)?;
            let slice_flux = through.iter().zip(&around).map(|(c, i)| most * c + weak * i).collect();
            let apart = Some(Apart { floating: parts.floating, percolates: parts.percolates, sweeps: sweep });
            let levels = conductor.plain.multigrid.levels();
            return Ok(Steady {
                values: sum,
                slice_flux,
                imbalance: 0.0,
                iterations: total,
                levels,
                contrast: 1.0,
                apart,
            });
        }
    }
    Err(ConductionError::NotConverged {
        stage: "alternating between the phases",
        iterations: total.count,
        residual: total.residual,
        tolerance: options.tolerance.relative,
        least,
        most,
    })
}

fn add(a: &[f64], b: &[f64], out: &mut [f64]) {
    for ((o, a), b) in out.iter_mut().zip(a).zip(b) {
        *o = a + b;
    }
}

/// The connected parts of the conducting phase.
struct Parts {
    /// Part of every node, named by its smallest node; [`NONE`] for nodes inside the insulating phase.
    roots: Vec<u32>,
    /// What holds a part, by its root.
    hold: Vec<Hold>,
    /// Nodes that are no unknowns of `a`: those of held parts, and given ones.
    fixed: Vec<bool>,
    floating: usize,
    percolates: bool,
}

/// What holds a part of the conducting phase.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Hold {
    /// Nothing.
    Floating,
    /// One given value.
    Held(f64),
    /// Several given values: it carries current.
    Through,
}

impl Parts {
    fn new(mesh: &BrickMesh, strong: &[f64], boundary: &Boundary, watch: Watch<'_>) -> Result<Self, ConductionError> {
        let conducts = |m: u16| m != VOID && strong[usize::from(m)] > 0.0;
        let cells = mesh.materials().iter().enumerate().filter(|(_, m)| conducts(**m));
        let components = Components::new(mesh.nodes(), cells.map(|(n, _)| mesh.cell_nodes(mesh.cell(n))), watch)?;
        watch.at(0.0)?;
        let roots = components.roots().to_vec();
        let mut hold = vec![Hold::Floating; mesh.nodes()];
        for (node, root) in roots.iter().enumerate().filter(|(n, r)| **r != NONE && boundary.given[*n]) {
            let hold = &mut hold[*root as usize];
            let value = boundary.values[node];
            *hold = match *hold {
                Hold::Floating => Hold::Held(value),
                Hold::Held(other) if other == value => Hold::Held(value),
                _ => Hold::Through,
            };
        }
        let fixed =
            |node: usize| boundary.given[node] || (roots[node] != NONE && hold[roots[node] as usize] != Hold::Floating);
        watch.at(0.0)?;
        let fixed: Vec<bool> = (0..mesh.nodes()).map(fixed).collect();
        watch.at(0.0)?;
        let is_root = |n: &usize| roots[*n] as usize == *n;
        let floating = (0..mesh.nodes()).filter(is_root).filter(|n| hold[*n] == Hold::Floating).count();
        let percolates = (0..mesh.nodes()).filter(is_root).any(|n| hold[n] == Hold::Through);
        Ok(Self { roots, hold, fixed, floating, percolates })
    }

    fn of(&self, node: usize) -> Option<Hold> {
        let root = self.roots[node];
        (root != NONE).then(|| self.hold[root as usize])
    }

    /// The root of a node of a floating part.
    fn floating_root(&self, node: usize) -> Option<usize> {
        let root = self.roots[node];
        (root != NONE && self.hold[root as usize] == Hold::Floating).then_some(root as usize)
    }

    /// First `w`: given values of parts that carry current.
    fn lift(&self, boundary: &Boundary) -> Vec<f64> {
        let value =
            |n: usize| if boundary.given[n] && self.of(n) == Some(Hold::Through) { boundary.values[n] } else { 0.0 };
        (0..self.roots.len()).map(value).collect()
    }

    /// First `a`: values of held parts, and given values inside the insulating phase.
    fn start(&self, boundary: &Boundary) -> Vec<f64> {
        let value = |n: usize| match self.of(n) {
            Some(Hold::Held(value)) => value,
            None if boundary.given[n] => boundary.values[n],
            _ => 0.0,
        };
        (0..self.roots.len()).map(value).collect()
    }

    /// Sums over every floating part at its root, and how many nodes it has there.
    fn sums(&self, vector: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let (mut sums, mut counts) = (vec![0.0; vector.len()], vec![0.0; vector.len()]);
        for (node, value) in vector.iter().enumerate() {
            if let Some(root) = self.floating_root(node) {
                sums[root] += value;
                counts[root] += 1.0;
            }
        }
        (sums, counts)
    }

    /// Takes its mean off every floating part; returns the means at the roots.
    fn remove_means(&self, vector: &mut [f64]) -> Vec<f64> {
        let (mut sums, counts) = self.sums(vector);
        for (sum, count) in sums.iter_mut().zip(&counts).filter(|(_, c)| **c > 0.0) {
            *sum /= count;
        }
        for (node, value) in vector.iter_mut().enumerate() {
            if let Some(root) = self.floating_root(node) {
                *value -= sums[root];
            }
        }
        sums
    }

    /// Adds a value at every root to all nodes of its part.
    fn raise(&self, vector: &mut [f64], by: &[f64]) {
        for (node, value) in vector.iter_mut().enumerate() {
            if let Some(root) = self.floating_root(node) {
                *value += by[root];
            }
        }
    }

    /// `Z^T v`: sums of parts at their roots, zero at their other nodes and where `a` is fixed.
    fn gather(&self, vector: &mut [f64]) {
        let (sums, _) = self.sums(vector);
        for (node, value) in vector.iter_mut().enumerate() {
            match self.floating_root(node) {
                Some(root) => *value = if root == node { sums[node] } else { 0.0 },
                None if self.fixed[node] => *value = 0.0,
                None => {}
            }
        }
    }

    /// `Z v`: the value at the root for all nodes of a part.
    fn spread_into(&self, vector: &[f64], out: &mut [f64]) {
        for (node, o) in out.iter_mut().enumerate() {
            *o = vector[self.floating_root(node).unwrap_or(node)];
        }
    }

    /// Weights of a part's nodes, adding up to one: how much they have to do with the insulating phase.
    fn weights(&self, weak: &Operator<'_>, watch: Watch<'_>) -> Result<Vec<f64>, ConductionError> {
        let touch = |d: f64| if d > 0.0 { 1.0 / d } else { 0.0 };
        let diagonal: Vec<f64> = weak.inverse_diagonal().iter().map(|d| touch(*d)).collect();
        watch.at(0.0)?;
        let (sums, _) = self.sums(&diagonal);
        watch.at(0.0)?;
        let weight = |node: usize| match self.floating_root(node) {
            Some(root) if sums[root] > 0.0 => diagonal[node] / sums[root],
            Some(_) => 0.0,
            None => 1.0,
        };
        Ok((0..diagonal.len()).map(weight).collect())
    }
}

/// `A_C`, singular on floating parts, whose means are taken off.
struct Conductor<'a> {
    plain: Plain<'a>,
    parts: &'a Parts,
}

impl System for Conductor<'_> {
    fn apply(&mut self, u: &[f64], out: &mut [f64], go_on: &(dyn Fn() -> bool + Sync)) {
        self.plain.apply(u, out, go_on);
    }

    fn precondition(&mut self, r: &[f64], out: &mut [f64], go_on: &(dyn Fn() -> bool + Sync)) {
        self.plain.precondition(r, out, go_on);
        self.parts.remove_means(out);
    }
}

/// `Z^T A_I Z`; preconditioned by a mesh in which the conducting phase is merely stiff.
struct Insulator<'a> {
    operator: Operator<'a>,
    preconditioner: Plain<'a>,
    parts: &'a Parts,
    weights: Vec<f64>,
    full: Vec<f64>,
    product: Vec<f64>,
}

impl System for Insulator<'_> {
    fn apply(&mut self, u: &[f64], out: &mut [f64], go_on: &(dyn Fn() -> bool + Sync)) {
        self.parts.spread_into(u, &mut self.full);
        self.operator.apply(&self.full, out, go_on);
        self.parts.gather(out);
    }

    fn precondition(&mut self, r: &[f64], out: &mut [f64], go_on: &(dyn Fn() -> bool + Sync)) {
        self.parts.spread_into(r, &mut self.full);
        for (v, w) in self.full.iter_mut().zip(&self.weights) {
            *v *= w;
        }
        self.preconditioner.precondition(&self.full, &mut self.product, go_on);
        for ((o, v), w) in out.iter_mut().zip(&self.product).zip(&self.weights) {
            *o = v * w;
        }
        self.parts.gather(out);
    }
}
