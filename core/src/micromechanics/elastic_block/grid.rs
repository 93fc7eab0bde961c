//! Nodes and elements of a block.

/// A block of `counts` equal cubes of edge `edge` along x, y and z. Nodes and elements are numbered with x running fastest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Grid {
    /// Elements along x, y and z.
    pub counts: [usize; 3],
    /// Edge of an element, mm.
    pub edge: f64,
}

impl Grid {
    /// Number of elements.
    pub(crate) fn elements(&self) -> usize {
        self.counts.iter().product()
    }

    /// Number of nodes.
    pub(crate) fn nodes(&self) -> usize {
        self.counts.iter().map(|n| n + 1).product()
    }

    /// Lengths of the block, mm.
    pub(crate) fn lengths(&self) -> [f64; 3] {
        self.counts.map(|n| n as f64 * self.edge)
    }

    /// Element at these places along x, y and z.
    pub(crate) fn element_at(&self, element: usize) -> [usize; 3] {
        let [nx, ny, _] = self.counts;
        [element % nx, element / nx % ny, element / (nx * ny)]
    }

    /// Places of a node along x, y and z.
    pub(crate) fn node_at(&self, node: usize) -> [usize; 3] {
        let (nx, ny) = (self.counts[0] + 1, self.counts[1] + 1);
        [node % nx, node / nx % ny, node / (nx * ny)]
    }

    /// Node at these places.
    pub(crate) fn node(&self, [i, j, k]: [usize; 3]) -> usize {
        (k * (self.counts[1] + 1) + j) * (self.counts[0] + 1) + i
    }

    /// The eight nodes of an element, in the usual order of an eight-node brick.
    pub(crate) fn connectivity(&self, element: usize) -> [usize; 8] {
        let [i, j, k] = self.element_at(element);
        super::brick::CORNERS.map(|[a, b, c]| self.node([i + a, j + b, k + c]))
    }

    /// Nodes that share an element with a node, itself included, in ascending order.
    pub(crate) fn neighbours(&self, node: usize) -> impl Iterator<Item = usize> + use<'_> {
        let at = self.node_at(node);
        let range = move |axis: usize| at[axis].saturating_sub(1)..=(at[axis] + 1).min(self.counts[axis]);
        range(2).flat_map(move |k| range(1).flat_map(move |j| range(0).map(move |i| self.node([i, j, k]))))
    }
}
