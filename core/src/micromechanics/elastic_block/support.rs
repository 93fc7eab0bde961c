//! Prescribed displacements.

use super::grid::Grid;

/// Most load cases that are solved together.
pub(crate) const CASES: usize = 3;

/// Degrees of freedom whose displacement is prescribed, one value a load case (mm); all others are free of force.
///
/// Degree of freedom `3 node + axis`.
#[derive(Debug, Clone)]
pub(crate) struct Support {
    prescribed: Vec<Option<[f64; CASES]>>,
    cases: usize,
}

impl Support {
    /// No support at all, for the first `cases` load cases.
    pub(crate) fn none(grid: &Grid, cases: usize) -> Self {
        Self { prescribed: vec![None; 3 * grid.nodes()], cases: cases.min(CASES) }
    }

    /// Number of load cases.
    pub(crate) fn cases(&self) -> usize {
        self.cases
    }

    /// Prescribes a displacement.
    pub(crate) fn prescribe(&mut self, node: usize, axis: usize, values: [f64; CASES]) {
        self.prescribed[3 * node + axis] = Some(values);
    }

    /// What is prescribed of every degree of freedom.
    pub(crate) fn prescribed(&self) -> &[Option<[f64; CASES]>] {
        &self.prescribed
    }

    /// Keeps a block from moving as a rigid body without any force: three displacements normal to `axis` that the faces
    /// normal to `axis`, free to slide, leave open.
    pub(crate) fn hold_rigid_body(&mut self, grid: &Grid, axis: usize) {
        let (second, third) = ((axis + 1) % 3, (axis + 2) % 3);
        let mut far = [0; 3];
        far[second] = grid.counts[second];
        for (node, axis) in [(grid.node([0; 3]), second), (grid.node([0; 3]), third), (grid.node(far), third)] {
            self.prescribe(node, axis, [0.0; CASES]);
        }
    }
}
