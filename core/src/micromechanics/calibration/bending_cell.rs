//! A piece of a strip in pure bending.
//!
//! Both end sections stay plane and are free to contract in their plane. The far one moves by
//! `u_x = L (a - kappa z + beta y)`: an axial strain `a`, the wanted curvature `kappa`, and a curvature `beta` across the
//! strip. Only the bending moment acts, so `a` and `beta` adjust until the axial force and the other moment vanish. With
//! `S_cd = u_c^T K u_d` of the three unit cases,
//!
//! ```text
//! M / kappa = (S_11 - s^T A^-1 s) / L,   s = (S_01, S_21),   A = [S_00 S_02; S_20 S_22]
//! E_b       = 12 (M / kappa) / (w t^3)
//! ```
//!
//! A strip of one phase has `E_b = E` exactly, because the enhanced brick contains pure bending.

use crate::materials::Material;
use crate::micromechanics::PhaseSet;
use crate::micromechanics::elastic_block::{BlockSystem, Brick, BrickKind, Grid, Support};
use crate::micromechanics::voigt;
use crate::progress::Cancelled;
use crate::voxel::counts::{Filling, fill_unless};
use crate::voxel::{Lattice, Match, Pattern, SliceTarget};

/// Size of a cell, voxels, and its mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BendingCellSize {
    /// Slices along the strip.
    pub slices: usize,
    /// Half the width.
    pub half_width: usize,
    /// Layers through the thickness.
    pub layers: usize,
    /// Elements along a voxel's edge.
    pub elements_per_voxel: usize,
}

/// What one cell shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BendingCellResult {
    /// Volume fraction of the second phase.
    pub rigid_fraction: f64,
    /// Modulus in bending, MPa.
    pub bending_mpa: f64,
    /// Modulus in tension with plane sections that may tilt, MPa.
    pub tension_mpa: f64,
}

/// Cells of one size, ready for any filling.
#[derive(Debug)]
pub(crate) struct BendingCell {
    size: BendingCellSize,
    grid: Grid,
    system: BlockSystem,
}

impl BendingCell {
    /// Prepares cells of a size; `None` where there is not enough memory.
    pub(crate) fn new(size: BendingCellSize) -> Option<Self> {
        let fine = size.elements_per_voxel;
        let counts = [size.slices, 2 * size.half_width, size.layers].map(|n| n * fine);
        let grid = Grid { counts, edge: 1.0 / fine as f64 };
        let [length, width, thickness] = grid.lengths();
        let mut support = Support::none(&grid, 3);
        support.hold_rigid_body(&grid, 0);
        for node in 0..grid.nodes() {
            let [i, j, k] = grid.node_at(node);
            let (y, z) = (grid.edge * j as f64 - 0.5 * width, grid.edge * k as f64 - 0.5 * thickness);
            if i == 0 {
                support.prescribe(node, 0, [0.0; 3]);
            } else if i == grid.counts[0] {
                support.prescribe(node, 0, [length, -length * z, length * y]);
            }
        }
        Some(Self { size, grid, system: BlockSystem::new(grid, support)? })
    }

    /// Bends a cell filled by a pattern; `None` where cancelled or where the stiffness is not positive definite.
    pub(crate) fn bend(
        &self,
        phases: &PhaseSet,
        pattern: Pattern,
        (wanted_fraction, seed): (f64, u64),
        cancelled: Cancelled<'_>,
    ) -> Option<BendingCellResult> {
        let lattice = Lattice { size_mm: 1.0, slices: self.size.slices, layers: self.size.layers };
        let modulus_mpa = voigt(&[1.0 - wanted_fraction, wanted_fraction], &phases.moduli());
        let (half_width, width_mm) = (self.size.half_width, 2.0 * self.size.half_width as f64);
        let targets = vec![SliceTarget { width_mm, modulus_mpa, half_width }; self.size.slices];
        let filling = Filling { phases, pattern, seed, matching: Match::Modulus, rule: None };
        let (voxels, _) = fill_unless(&lattice, &targets, &filling, cancelled)?;
        let fine = self.size.elements_per_voxel;
        let phase: Vec<u8> = (0..self.grid.elements())
            .map(|element| {
                let [i, j, k] = self.grid.element_at(element).map(|n| n / fine);
                voxels.slice(i)[k * 2 * half_width + j]
            })
            .collect();
        let brick = |m: &Material| BrickKind::Enhanced.stiffness(m.modulus_mpa, m.poisson);
        let bricks = phases.phases().iter().map(brick).collect::<Option<Vec<Brick>>>()?;
        let s = self.system.energies(&bricks, &phase)?;
        let [length, width, thickness] = self.grid.lengths();
        let counts = voxels.counts(2);
        Some(BendingCellResult {
            rigid_fraction: counts[1] as f64 / (counts[0] + counts[1]) as f64,
            bending_mpa: 12.0 * condensed(&s, 1) / (length * width * thickness.powi(3)),
            tension_mpa: condensed(&s, 0) / (length * width * thickness),
        })
    }
}

/// `S_cc` once the other two cases adjust until their forces vanish.
fn condensed(s: &[[f64; 3]; 3], case: usize) -> f64 {
    let (a, b) = ((case + 1) % 3, (case + 2) % 3);
    let determinant = s[a][a] * s[b][b] - s[a][b] * s[b][a];
    let (p, q) = (s[a][case], s[b][case]);
    s[case][case] - (p * p * s[b][b] - 2.0 * p * q * s[a][b] + q * q * s[a][a]) / determinant
}
