//! One cell, stretched along one axis.
//!
//! The two faces normal to the axis move apart by a uniform displacement, along which the material may slide; the other
//! four faces are free. With the force `F` that this takes, `E = F L / (A delta)`. The force follows from the elastic
//! energy, `F delta = u^T K u`, which is an order more accurate than nodal forces.
//!
//! With equal Poisson's ratios two fields bound the result. Every phase at the same stretch and its free lateral contraction
//! is a compatible field, so no finite-element energy lies above it: Voigt's bound. Equal stress in all phases is in
//! equilibrium: `E >= 1 / sum(f/E)`, Reuss's bound, which holds for a compatible brick because its energy is never below the
//! exact one, and for the enhanced brick because its extra strains have no mean over an element.

use serde::{Deserialize, Serialize};

use super::UnitCellError;
use super::layout::{CellSize, Layout};
use crate::materials::Material;
use crate::micromechanics::elastic_block::{BlockSystem, Brick, BrickKind, CASES, Grid, Support};

/// Most elements along a voxel's edge.
pub const MOST_ELEMENTS: usize = 8;

/// How the loaded faces are held.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum LoadedFaces {
    /// Free to slide along themselves: a uniaxial test without friction. The bounds hold for equal Poisson's ratios.
    Sliding,
    /// Clamped, as in the jaws of a machine: the lateral contraction is hindered, so that even one phase alone comes out
    /// stiffer than its modulus.
    Clamped,
}

/// How finely and with what a cell is meshed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct CellMesh {
    /// Elements along a voxel's edge.
    pub elements_per_voxel: usize,
    /// The element.
    pub element: BrickKind,
    /// The loaded faces.
    pub faces: LoadedFaces,
}

impl Default for CellMesh {
    fn default() -> Self {
        Self { elements_per_voxel: 2, element: BrickKind::Enhanced, faces: LoadedFaces::Sliding }
    }
}

/// A cell's three tests, ready for any layout.
#[derive(Debug)]
pub struct StretchTest {
    size: CellSize,
    grid: Grid,
    per_voxel: usize,
    systems: [BlockSystem; 3],
    bricks: Vec<Brick>,
    contrast: f64,
}

impl StretchTest {
    /// Prepares the tests of a cell of two phases.
    ///
    /// # Errors
    /// [`UnitCellError::Elements`], [`UnitCellError::Phase`] and [`UnitCellError::Memory`].
    pub fn new(size: CellSize, phases: [&Material; 2], mesh: &CellMesh) -> Result<Self, UnitCellError> {
        let per_voxel = mesh.elements_per_voxel;
        if !(1..=MOST_ELEMENTS).contains(&per_voxel) {
            return Err(UnitCellError::Elements { elements: per_voxel, most: MOST_ELEMENTS, help: "" });
        }
        let grid = Grid {
            counts: [size.edge() * per_voxel, size.edge() * per_voxel, per_voxel],
            edge: 1.0 / per_voxel as f64,
        };
        let prepare = |axis: usize| {
            let support = faces(&grid, axis, mesh.faces);
            BlockSystem::new(grid, support).ok_or(UnitCellError::Memory { unknowns: 3 * grid.nodes() })
        };
        let [soft, rigid] = phases;
        Ok(Self {
            size,
            grid,
            per_voxel,
            systems: [prepare(0)?, prepare(1)?, prepare(2)?],
            bricks: phases.iter().map(|p| brick(p, mesh.element)).collect::<Result<_, _>>()?,
            contrast: (rigid.modulus_mpa / soft.modulus_mpa).max(soft.modulus_mpa / rigid.modulus_mpa),
        })
    }

    /// Young's modulus along x, y and z, MPa.
    ///
    /// # Errors
    /// [`UnitCellError::Singular`] where the contrast is too large for the precision.
    pub fn moduli(&self, layout: Layout) -> Result<[f64; 3], UnitCellError> {
        let voxel = |element: usize| self.grid.element_at(element).map(|n| n / self.per_voxel);
        let phase: Vec<u8> = (0..self.grid.elements())
            .map(|element| {
                let [x, y, _] = voxel(element);
                u8::from(layout.is_rigid(x, y, self.size))
            })
            .collect();
        let lengths = self.grid.lengths();
        let mut moduli = [0.0; 3];
        for (axis, system) in self.systems.iter().enumerate() {
            let energies = system
                .energies(&self.bricks, &phase)
                .ok_or_else(|| UnitCellError::Singular { layout: layout.text(self.size), contrast: self.contrast })?;
            // The faces move apart by one.
            let area = lengths[(axis + 1) % 3] * lengths[(axis + 2) % 3];
            moduli[axis] = energies[0][0] * lengths[axis] / area;
        }
        Ok(moduli)
    }
}

fn brick(phase: &Material, element: BrickKind) -> Result<Brick, UnitCellError> {
    let (modulus_mpa, poisson) = (phase.modulus_mpa, phase.poisson);
    let elastic = modulus_mpa > 0.0 && modulus_mpa.is_finite() && (0.0..=0.499).contains(&poisson);
    let stiffness = element.stiffness(modulus_mpa, poisson).filter(|_| elastic);
    stiffness.ok_or_else(|| UnitCellError::Phase { name: phase.name.clone(), modulus_mpa, poisson })
}

/// The faces normal to `axis` move apart by one.
fn faces(grid: &Grid, axis: usize, held: LoadedFaces) -> Support {
    let mut support = Support::none(grid, 1);
    if held == LoadedFaces::Sliding {
        support.hold_rigid_body(grid, axis);
    }
    for node in 0..grid.nodes() {
        let at = grid.node_at(node)[axis];
        if at == 0 || at == grid.counts[axis] {
            let mut apart = [0.0; CASES];
            apart[0] = if at == 0 { 0.0 } else { 1.0 };
            if held == LoadedFaces::Clamped {
                for other in [(axis + 1) % 3, (axis + 2) % 3] {
                    support.prescribe(node, other, [0.0; CASES]);
                }
            }
            support.prescribe(node, axis, apart);
        }
    }
    support
}
