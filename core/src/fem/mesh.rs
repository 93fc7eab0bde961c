//! A block of bricks, node by node and element by element.

use crate::mesh::Block;

/// A column of nodes through the thickness.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Column {
    /// Plane of the strip, rim first.
    pub plane: usize,
    /// Place across the strip in elements, zero on the mid-line.
    pub across: i64,
    /// Node on the lower face; the ones above follow in steps of [`Column::step`].
    pub lowest: usize,
    /// Nodes from one level to the next.
    pub step: usize,
}

/// Nodes and elements of a strip, numbered from zero in the order of [`Block`].
#[derive(Debug, Clone, PartialEq)]
pub struct Mesh {
    /// Positions in the flat state, mm.
    pub nodes: Vec<[f64; 3]>,
    /// Nodes of every element.
    pub elements: Vec<[u32; 8]>,
    /// First node of every plane, and the number of nodes.
    pub planes: Vec<usize>,
    /// First element of every slice, and the number of elements.
    pub slices: Vec<usize>,
    /// Levels of nodes through the thickness.
    pub levels: usize,
}

impl Mesh {
    /// The mesh of a block.
    #[must_use]
    pub fn new(block: &Block) -> Self {
        let levels = block.layers() + 1;
        let mut nodes = Vec::with_capacity(block.nodes() as usize);
        for plane in 0..block.planes() {
            for level in 0..levels {
                for index in 0..=block.plane_across(plane) {
                    nodes.push([block.x(plane), block.y(plane, index), block.z(plane, level)]);
                }
            }
        }
        let mut elements = Vec::with_capacity(block.elements() as usize);
        for slice in 0..block.slices() {
            for layer in 0..block.layers() {
                let first = block.row_connectivity(slice, layer);
                for across in 0..block.slice_across(slice) as u64 {
                    elements.push(first.map(|node| (node - 1 + across) as u32));
                }
            }
        }
        Self {
            nodes,
            elements,
            planes: (0..=block.planes()).map(|p| block.first_node(p) as usize - 1).collect(),
            slices: (0..=block.slices()).map(|s| block.first_element(s) as usize - 1).collect(),
            levels,
        }
    }

    /// Number of planes of nodes.
    #[must_use]
    pub fn plane_count(&self) -> usize {
        self.planes.len() - 1
    }

    /// Nodes of a plane.
    #[must_use]
    pub fn plane(&self, plane: usize) -> std::ops::Range<usize> {
        self.planes[plane]..self.planes[plane + 1]
    }

    /// The columns of a plane, from the most negative `y`.
    pub fn columns(&self, plane: usize) -> impl Iterator<Item = Column> {
        let nodes = self.plane(plane);
        let step = nodes.len() / self.levels;
        (0..step).map(move |i| Column {
            plane,
            across: i as i64 - (step as i64 - 1) / 2,
            lowest: nodes.start + i,
            step,
        })
    }

    /// Nodes whose mean is the mid-line's point in a plane: one where a level lies on the mid-plane, else two.
    #[must_use]
    pub fn midline_nodes(&self, plane: usize) -> [usize; 2] {
        let nodes = self.plane(plane);
        let step = nodes.len() / self.levels;
        let level = |k: usize| nodes.start + k * step + (step - 1) / 2;
        [level((self.levels - 1) / 2), level(self.levels / 2)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Spacing;

    #[test]
    fn the_mesh_is_the_deck_s() {
        let block = Block::new(3.0, 2.0, 2, vec![4, 2, 4], Spacing::Even(1.0));
        let mesh = Mesh::new(&block);
        assert_eq!((mesh.nodes.len() as u64, mesh.elements.len() as u64), (block.nodes(), block.elements()));
        assert_eq!(mesh.elements[8], [16, 31, 32, 17, 21, 36, 37, 22]);
        assert_eq!(mesh.nodes[block.midline_node(2) as usize - 1], [2.0, 0.0, 0.0]);
        assert_eq!(mesh.midline_nodes(2), [block.midline_node(2) as usize - 1; 2]);
        let columns: Vec<Column> = mesh.columns(1).collect();
        assert_eq!((columns.len(), columns[0].across, columns[4].lowest), (5, -2, 19));
        for column in columns {
            assert_eq!(mesh.nodes[column.lowest + column.step][1], column.across as f64);
        }
    }

    #[test]
    fn an_odd_number_of_layers_has_its_mid_line_between_two_levels() {
        let block = Block::new(2.0, 3.0, 3, vec![2, 2], Spacing::Even(1.0));
        let mesh = Mesh::new(&block);
        let [a, b] = mesh.midline_nodes(1).map(|n| mesh.nodes[n]);
        assert_eq!(([a[0], a[1]], [b[0], b[1]]), ([1.0, 0.0], [1.0, 0.0]));
        assert!((a[2] + 0.5).abs() < 1e-12 && (b[2] - 0.5).abs() < 1e-12);
    }
}
