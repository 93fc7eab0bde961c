//! A structured box of bricks, some of them void.
//!
//! Cells and nodes are counted along the strip (slices), through the thickness (layers) and across, the last fastest, as
//! voxels are. A strip whose width varies is a box with void cells beside its narrow slices. Bricks that are equal share one
//! matrix: all cubes of a flat strip have one, those of a bent strip one a slice and layer.

use rayon::prelude::*;

use super::ConductionError;
use super::brick::{Brick, Point, corner};
use super::pcg::Watch;

/// The material number of a cell that is not there.
pub const VOID: u16 = u16::MAX;

/// Largest number of nodes; indices stay well within 32 bits.
pub const MOST_NODES: usize = 2_000_000_000;

/// Bricks after which it is asked whether to go on.
const ASK_EVERY: usize = 1024;

/// Which brick every cell is.
#[derive(Debug, Clone, PartialEq)]
pub struct Bricks {
    bricks: Vec<Brick>,
    /// Cell `(i, k, j)` is brick `i * strides[0] + k * strides[1] + j * strides[2]`.
    strides: [usize; 3],
}

impl Bricks {
    /// The same brick everywhere.
    #[must_use]
    pub fn uniform(brick: Brick) -> Self {
        Self { bricks: vec![brick], strides: [0; 3] }
    }

    /// A brick of cell `(i, k, j)`.
    #[inline]
    #[must_use]
    pub fn at(&self, i: usize, k: usize, j: usize) -> &Brick {
        &self.bricks[self.index(i, k, j)]
    }

    #[inline]
    pub(super) fn index(&self, i: usize, k: usize, j: usize) -> usize {
        i * self.strides[0] + k * self.strides[1] + j * self.strides[2]
    }

    /// Whether a row of cells across shares one brick.
    #[must_use]
    pub fn same_across(&self) -> bool {
        self.strides[2] == 0
    }

    /// The different bricks.
    #[must_use]
    pub fn all(&self) -> &[Brick] {
        &self.bricks
    }
}

/// A box of bricks.
#[derive(Debug, Clone, PartialEq)]
pub struct BrickMesh {
    cells: [usize; 3],
    materials: Vec<u16>,
    bricks: Bricks,
    /// Where the nodes are.
    geometry: Geometry,
}

/// Positions of the nodes.
#[derive(Debug, Clone, PartialEq)]
pub enum Geometry {
    /// Cubes of an edge, mm: x from zero, y and z about zero.
    Cubes(f64),
    /// Rigid cross-sections: `[x, z]` and inclination (rad) of the mid-line at every plane of nodes, and the edge across and
    /// through, mm.
    Sections {
        /// `[x, z, inclination]` a plane.
        midline: Vec<[f64; 3]>,
        /// Edge across and through the thickness, mm.
        size_mm: f64,
    },
    /// A position a node.
    Free(Vec<Point>),
}

impl BrickMesh {
    /// A mesh of `cells` (along, layers, across), with a material number a cell ([`VOID`] for none).
    ///
    /// # Errors
    /// [`ConductionError::Size`] for arrays that do not fit, [`ConductionError::Inverted`] for bricks turned inside out.
    pub fn new(cells: [usize; 3], materials: Vec<u16>, geometry: Geometry) -> Result<Self, ConductionError> {
        Self::new_unless(cells, materials, geometry, Watch::silent())
    }

    /// As [`Self::new`], unless it is cancelled.
    ///
    /// # Errors
    /// Those of [`Self::new`], and [`ConductionError::Cancelled`].
    pub fn new_unless(
        cells: [usize; 3],
        materials: Vec<u16>,
        geometry: Geometry,
        watch: Watch<'_>,
    ) -> Result<Self, ConductionError> {
        let expected = count(cells);
        let size = |what, found, expected| Err(ConductionError::Size { what, found, expected });
        if materials.len() != expected || expected == 0 {
            return size("materials of cells", materials.len(), expected.max(1));
        }
        let nodes = count(cells.map(|n| n + 1));
        if nodes > MOST_NODES {
            return size("nodes", nodes, MOST_NODES);
        }
        match &geometry {
            Geometry::Sections { midline, .. } if midline.len() != cells[0] + 1 => {
                return size("planes of the mid-line", midline.len(), cells[0] + 1);
            }
            Geometry::Free(positions) if positions.len() != nodes => {
                return size("positions of nodes", positions.len(), nodes);
            }
            _ => {}
        }
        let mut mesh = Self { cells, materials, bricks: Bricks { bricks: Vec::new(), strides: [0; 3] }, geometry };
        mesh.bricks = mesh.shapes(watch)?;
        Ok(mesh)
    }

    fn shapes(&self, watch: Watch<'_>) -> Result<Bricks, ConductionError> {
        let [_, layers, across] = self.cells;
        let (strides, many) = match &self.geometry {
            Geometry::Cubes(size) => return Ok(Bricks::uniform(Brick::cube(*size))),
            Geometry::Sections { .. } => ([layers, 1, 0], self.cells[0] * layers),
            Geometry::Free(_) => ([layers * across, across, 1], self.materials.len()),
        };
        let brick = |n: usize| {
            if n.is_multiple_of(ASK_EVERY) {
                watch.at(0.0)?;
            }
            let cell = match strides[2] {
                0 => [n / layers, n % layers, 0],
                _ => self.cell(n),
            };
            Brick::new(&self.corners(cell))
        };
        let bricks = (0..many).into_par_iter().map(brick).collect::<Result<_, _>>()?;
        Ok(Bricks { bricks, strides })
    }

    /// Number of cells along, through and across.
    #[must_use]
    pub fn cells(&self) -> [usize; 3] {
        self.cells
    }

    /// Number of nodes along, through and across.
    #[must_use]
    pub fn node_counts(&self) -> [usize; 3] {
        self.cells.map(|n| n + 1)
    }

    /// Number of nodes.
    #[must_use]
    pub fn nodes(&self) -> usize {
        count(self.node_counts())
    }

    /// Material number of every cell.
    #[must_use]
    pub fn materials(&self) -> &[u16] {
        &self.materials
    }

    /// The bricks.
    #[must_use]
    pub fn bricks(&self) -> &Bricks {
        &self.bricks
    }

    /// Number of the node of a plane, level and place across.
    #[inline]
    #[must_use]
    pub fn node(&self, [plane, level, across]: [usize; 3]) -> usize {
        (plane * (self.cells[1] + 1) + level) * (self.cells[2] + 1) + across
    }

    /// Slice, layer and place across of a cell.
    #[must_use]
    pub fn cell(&self, cell: usize) -> [usize; 3] {
        let [_, layers, across] = self.cells;
        [cell / (layers * across), cell / across % layers, cell % across]
    }

    /// Nodes of a cell, in the order of [`corner`].
    #[must_use]
    pub fn cell_nodes(&self, [i, k, j]: [usize; 3]) -> [usize; 8] {
        std::array::from_fn(|a| self.node([i + (a >> 2 & 1), k + (a >> 1 & 1), j + (a & 1)]))
    }

    /// Nodes of a cell in the order in which decks and VTK list those of a brick.
    #[must_use]
    pub fn deck_nodes(&self, cell: [usize; 3]) -> [usize; 8] {
        let nodes = self.cell_nodes(cell);
        [(0, 0, 0), (1, 0, 0), (1, 0, 1), (0, 0, 1), (0, 1, 0), (1, 1, 0), (1, 1, 1), (0, 1, 1)]
            .map(|(i, k, j)| nodes[corner(i, k, j)])
    }

    fn corners(&self, [i, k, j]: [usize; 3]) -> [Point; 8] {
        std::array::from_fn(|a| self.position([i + (a >> 2 & 1), k + (a >> 1 & 1), j + (a & 1)]))
    }

    /// Position of the node of a plane, level and place across, mm.
    #[must_use]
    pub fn position(&self, node: [usize; 3]) -> Point {
        let [plane, level, across] = node;
        let centred = |index: usize, cells: usize, size: f64| (index as f64 - 0.5 * cells as f64) * size;
        match &self.geometry {
            Geometry::Cubes(size) => {
                [plane as f64 * size, centred(across, self.cells[2], *size), centred(level, self.cells[1], *size)]
            }
            Geometry::Sections { midline, size_mm } => {
                let [x, z, inclination] = midline[plane];
                let height = centred(level, self.cells[1], *size_mm);
                let (sin, cos) = inclination.sin_cos();
                [x - height * sin, centred(across, self.cells[2], *size_mm), z + height * cos]
            }
            Geometry::Free(positions) => positions[self.node(node)],
        }
    }

    /// Typical length of a brick along, through and across, mm: a mean over the box.
    #[must_use]
    pub fn mean_edges(&self) -> [f64; 3] {
        let distance = |a: Point, b: Point| (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt();
        let middle = self.cells.map(|n| n / 2);
        let samples = 1 + self.cells[0].min(16);
        let mut sums = [0.0; 3];
        for s in 0..samples {
            let i = (self.cells[0] - 1) * s / samples.max(1);
            let at = self.position([i, middle[1], middle[2]]);
            sums[0] += distance(at, self.position([i + 1, middle[1], middle[2]]));
            let (low, high) = (self.position([i, 0, middle[2]]), self.position([i, self.cells[1], middle[2]]));
            sums[1] += distance(low, high) / self.cells[1] as f64;
            let (left, right) = (self.position([i, middle[1], 0]), self.position([i, middle[1], self.cells[2]]));
            sums[2] += distance(left, right) / self.cells[2] as f64;
        }
        sums.map(|s| s / samples as f64)
    }

    /// Which nodes belong to a cell that is not void.
    #[must_use]
    pub fn used_nodes(&self) -> Vec<bool> {
        let mut used = vec![false; self.nodes()];
        for (cell, _) in self.materials.iter().enumerate().filter(|(_, m)| **m != VOID) {
            for node in self.cell_nodes(self.cell(cell)) {
                used[node] = true;
            }
        }
        used
    }

    /// Largest distance across between the outermost nodes of a plane, mm.
    #[must_use]
    pub fn widest(&self) -> f64 {
        let wide = |i: usize| self.position([i, 0, self.cells[2]])[1] - self.position([i, 0, 0])[1];
        (0..=self.cells[0]).map(wide).fold(0.0, f64::max)
    }

    /// `int (grad u)^2 dV` over the cells of every material; at least `materials` entries.
    ///
    /// # Errors
    /// [`ConductionError::Cancelled`] where `watch` says so.
    pub fn dissipations(&self, u: &[f64], materials: usize, watch: Watch<'_>) -> Result<Vec<f64>, ConductionError> {
        let per_slice = self.cells[1] * self.cells[2];
        let of_slice = |i: usize| {
            watch.at(0.0)?;
            let mut sums = vec![0.0; materials];
            let cells = self.materials[i * per_slice..(i + 1) * per_slice].iter().enumerate();
            for (n, material) in cells.filter(|(_, m)| **m != VOID) {
                let cell = [i, n / self.cells[2], n % self.cells[2]];
                let values = self.cell_nodes(cell).map(|node| u[node]);
                let matrix = &self.bricks.at(cell[0], cell[1], cell[2]).conductance;
                let m = usize::from(*material);
                if m >= sums.len() {
                    sums.resize(m + 1, 0.0);
                }
                for (row, v) in matrix.chunks(8).zip(&values) {
                    sums[m] += v * row.iter().zip(&values).map(|(k, u)| k * u).sum::<f64>();
                }
            }
            Ok(sums)
        };
        let slices = (0..self.cells[0]).into_par_iter().map(of_slice).collect::<Result<Vec<_>, ConductionError>>()?;
        let mut total = vec![0.0; materials];
        for sums in slices {
            total.resize(total.len().max(sums.len()), 0.0);
            total.iter_mut().zip(sums).for_each(|(t, s)| *t += s);
        }
        Ok(total)
    }

    /// Volume of the cells that are not void, mm^3.
    #[must_use]
    pub fn volume(&self) -> f64 {
        self.volumes(0).iter().sum()
    }

    /// Volume of every material, mm^3; at least `materials` entries.
    #[must_use]
    pub fn volumes(&self, materials: usize) -> Vec<f64> {
        let mut volumes = vec![0.0; materials];
        for (n, material) in self.materials.iter().enumerate().filter(|(_, m)| **m != VOID) {
            let [i, k, j] = self.cell(n);
            let m = usize::from(*material);
            if m >= volumes.len() {
                volumes.resize(m + 1, 0.0);
            }
            volumes[m] += self.bricks.at(i, k, j).volumes.iter().sum::<f64>();
        }
        volumes
    }
}

fn count(counts: [usize; 3]) -> usize {
    counts.iter().fold(1, |product: usize, n| product.saturating_mul(*n))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bent_strip_has_the_volume_of_a_flat_one() {
        // A quarter circle: mid-plane at the mid-line, so what one face gains the other loses.
        let radius = 20.0;
        let midline = (0..=40)
            .map(|i| {
                let angle = std::f64::consts::FRAC_PI_2 * f64::from(i) / 40.0;
                [radius * angle.sin(), radius * (1.0 - angle.cos()), angle]
            })
            .collect();
        let mesh = BrickMesh::new([40, 4, 6], vec![0; 960], Geometry::Sections { midline, size_mm: 0.5 }).unwrap();
        let exact = std::f64::consts::FRAC_PI_2 * radius * 2.0 * 3.0;
        assert!((mesh.volume() / exact - 1.0).abs() < 1e-3, "{} {exact}", mesh.volume());
        assert!(!mesh.bricks().all().is_empty() && mesh.bricks().same_across());
    }

    #[test]
    fn arrays_that_do_not_fit_are_refused() {
        assert!(matches!(
            BrickMesh::new([2, 2, 2], vec![0; 7], Geometry::Cubes(1.0)),
            Err(ConductionError::Size { .. })
        ));
        let huge = [usize::MAX, 2, 2];
        assert!(matches!(BrickMesh::new(huge, vec![0; 7], Geometry::Cubes(1.0)), Err(ConductionError::Size { .. })));
    }
}
