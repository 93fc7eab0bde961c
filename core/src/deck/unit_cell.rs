//! Decks of unit cells: the tests of [`crate::micromechanics::unit_cell`] for another solver.
//!
//! One cell of voxels of 1 mm, its lower face normal to the loaded axis held in that direction, its upper face moved along it
//! by a thousandth of the cell's length. Three more degrees of freedom keep the cell from moving as a rigid body. With the
//! sum `F` of the reactions of the node set `HIGH`, `E = F L / (A delta)`.

use std::io::Write;

use super::DeckError;
use super::keywords::heading::heading;
use super::keywords::{boundary, materials, sets};
use super::number::real;
use super::sink::Sink;
use crate::input::model::DeckSolver;
use crate::materials::Material;
use crate::micromechanics::elastic_block::{BrickKind, Grid};
use crate::micromechanics::unit_cell::{CellMesh, CellSize, Layout, LoadedFaces};
use crate::output::Provenance;

/// Strain of the test.
pub const STRAIN: f64 = 1e-3;

/// What is tested.
#[derive(Debug, Clone, Copy)]
pub struct UnitCellDeck<'a> {
    /// The cell.
    pub size: CellSize,
    /// Which voxels are rigid.
    pub layout: Layout,
    /// The soft and the rigid phase.
    pub phases: [&'a Material; 2],
    /// Mesh, element and loaded faces.
    pub mesh: CellMesh,
    /// Loaded axis: 0, 1 or 2 for x, y or z; others count as z.
    pub axis: usize,
    /// The solver.
    pub solver: DeckSolver,
}

impl UnitCellDeck<'_> {
    /// Where the deck goes in a folder.
    #[must_use]
    pub fn relative_path(&self) -> String {
        let (folder, ending) = self.solver.folder_and_ending();
        let layout = self.layout.text(self.size).replace('/', "-");
        format!("{folder}/unit_cell_{layout}_{}.{ending}", self.axis_name())
    }

    fn axis_name(&self) -> &'static str {
        ["x", "y", "z"][self.axis.min(2)]
    }

    fn grid(&self) -> Grid {
        let n = self.mesh.elements_per_voxel;
        Grid { counts: [self.size.edge() * n, self.size.edge() * n, n], edge: 1.0 / n as f64 }
    }

    /// Writes the deck.
    ///
    /// # Errors
    /// [`DeckError::Io`] where `out` fails, [`DeckError::NotOffered`] for solvers that read no decks.
    pub fn write(&self, provenance: &Provenance, out: &mut dyn Write) -> Result<(), DeckError> {
        if self.solver == DeckSolver::Nastran {
            let reason = "unit cells are decks for ABAQUS and CalculiX";
            return Err(DeckError::NotOffered { path: self.relative_path(), reason });
        }
        let mut sink = Sink::new(out, &crate::progress::ignore);
        let (grid, axis) = (self.grid(), self.axis.min(2));
        heading(&mut sink, "a unit cell", "unit cell", provenance, &self.paragraphs(&grid))?;
        self.nodes(&mut sink, &grid)?;
        let present = self.elements(&mut sink, &grid)?;
        for phase in &present {
            let (set, material) = (format!("PHASE-{}", phase.label()), materials::material_name(phase));
            sink.line(&format!("*SOLID SECTION, ELSET={set}, MATERIAL={material}"))?;
        }
        for phase in &present {
            materials::plain(&mut sink, phase, materials::Law::Linear, false)?;
        }
        self.step(&mut sink, &grid, axis)?;
        sink.finish()
    }

    fn paragraphs(&self, grid: &Grid) -> Vec<String> {
        let axis = self.axis_name();
        let n = self.mesh.elements_per_voxel;
        vec![
            format!(
                "Model: layout {} (rows of y, x rising in a row, 1 is rigid) of a {} cell, voxels of 1 mm, {n} x {n} x {n} {} \
                 elements each.",
                self.layout.text(self.size),
                self.size.name(),
                self.element()
            ),
            format!(
                "Step: the face HIGH moves along {axis} by {} mm, {} along itself; the other four faces are free. E along \
                 {axis} is the sum of the reactions of HIGH times {} MPa/N.",
                real(STRAIN * grid.lengths()[self.axis.min(2)]),
                match self.mesh.faces {
                    LoadedFaces::Sliding => "free to slide",
                    LoadedFaces::Clamped => "clamped",
                },
                real(1.0 / (STRAIN * self.area(grid)))
            ),
        ]
    }

    fn area(&self, grid: &Grid) -> f64 {
        let lengths = grid.lengths();
        lengths[(self.axis.min(2) + 1) % 3] * lengths[(self.axis.min(2) + 2) % 3]
    }

    fn element(&self) -> &'static str {
        match self.mesh.element {
            BrickKind::Enhanced => "C3D8I",
            BrickKind::Trilinear => "C3D8",
        }
    }

    fn nodes(&self, sink: &mut Sink<'_>, grid: &Grid) -> Result<(), DeckError> {
        sink.line("*NODE")?;
        for node in 0..grid.nodes() {
            let [x, y, z] = grid.node_at(node).map(|n| real(n as f64 * grid.edge));
            sink.line(&format!("{},{x},{y},{z}", node + 1))?;
        }
        let axis = self.axis.min(2);
        for (name, at) in [("LOW", 0), ("HIGH", grid.counts[axis])] {
            let nodes = (0..grid.nodes()).filter(|n| grid.node_at(*n)[axis] == at).map(|n| n as u64 + 1);
            sets::node_list(sink, name, "", nodes)?;
        }
        Ok(())
    }

    /// Elements of each phase; the phases that occur.
    fn elements(&self, sink: &mut Sink<'_>, grid: &Grid) -> Result<Vec<&Material>, DeckError> {
        let per_voxel = self.mesh.elements_per_voxel;
        let rigid = |element: usize| {
            let [x, y, _] = grid.element_at(element).map(|n| n / per_voxel);
            self.layout.is_rigid(x, y, self.size)
        };
        let mut present = Vec::new();
        for (phase, wanted) in self.phases.into_iter().zip([false, true]) {
            let members: Vec<usize> = (0..grid.elements()).filter(|e| rigid(*e) == wanted).collect();
            if members.is_empty() {
                continue;
            }
            sink.line(&format!("*ELEMENT, TYPE={}, ELSET=PHASE-{}", self.element(), phase.label()))?;
            for element in members {
                let nodes = grid.connectivity(element).map(|n| (n + 1).to_string()).join(",");
                sink.line(&format!("{},{nodes}", element + 1))?;
            }
            present.push(phase);
        }
        Ok(present)
    }

    fn step(&self, sink: &mut Sink<'_>, grid: &Grid, axis: usize) -> Result<(), DeckError> {
        let abaqus = self.solver == DeckSolver::Abaqus;
        sink.line(if abaqus { "*STEP, NAME=STRETCH, NLGEOM=NO" } else { "*STEP" })?;
        sink.line("*STATIC")?;
        sink.line("1.,1.,1e-5,1.")?;
        let dof = |axis: usize| axis as u8 + 1;
        boundary::hold(sink, "LOW", dof(axis), dof(axis))?;
        sink.line("*BOUNDARY")?;
        sink.line(&format!("HIGH,{0},{0},{1}", dof(axis), real(STRAIN * grid.lengths()[axis])))?;
        let (second, third) = ((axis + 1) % 3, (axis + 2) % 3);
        if self.mesh.faces == LoadedFaces::Clamped {
            for face in ["LOW", "HIGH"] {
                boundary::hold(sink, face, dof(second), dof(second))?;
                boundary::hold(sink, face, dof(third), dof(third))?;
            }
        } else {
            let mut far = [0; 3];
            far[second] = grid.counts[second];
            let (origin, far) = (grid.node([0; 3]) + 1, grid.node(far) + 1);
            for (node, axis) in [(origin, second), (origin, third), (far, third)] {
                boundary::hold(sink, &node.to_string(), dof(axis), dof(axis))?;
            }
        }
        if abaqus {
            sink.line("*OUTPUT, FIELD")?;
            sink.line("*NODE OUTPUT")?;
            sink.line("U,RF")?;
            sink.line("*ELEMENT OUTPUT")?;
            sink.line("S,E")?;
            sink.line("*OUTPUT, HISTORY")?;
            sink.line("*NODE OUTPUT, NSET=HIGH")?;
            sink.line(&format!("RF{}", dof(axis)))?;
        } else {
            sink.line("*NODE PRINT, NSET=HIGH, TOTALS=ONLY")?;
            sink.line("RF")?;
            sink.line("*NODE FILE")?;
            sink.line("U")?;
            sink.line("*EL FILE")?;
            sink.line("S")?;
        }
        sink.line("*END STEP")
    }
}
