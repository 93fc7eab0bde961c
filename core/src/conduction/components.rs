//! Connected parts of a mesh: cells that share a node conduct to each other.

use super::ConductionError;
use super::pcg::Watch;

/// Cells after which it is asked whether to go on.
pub(super) const ASK_EVERY: usize = 1 << 16;

/// Disjoint sets of nodes.
#[derive(Debug)]
pub(super) struct Components {
    parent: Vec<u32>,
}

/// A node that belongs to no part.
pub(super) const NONE: u32 = u32::MAX;

impl Components {
    /// Parts of a mesh of `nodes` nodes; `cells` gives the nodes of every cell that conducts.
    pub(super) fn new(
        nodes: usize,
        cells: impl Iterator<Item = [usize; 8]>,
        watch: Watch<'_>,
    ) -> Result<Self, ConductionError> {
        let mut parts = Self { parent: vec![NONE; nodes] };
        for (n, cell) in cells.enumerate() {
            if n.is_multiple_of(ASK_EVERY) {
                watch.at(0.0)?;
            }
            let mut root = parts.touch(cell[0]);
            for node in &cell[1..] {
                let other = parts.touch(*node);
                // The smaller number is the root, so the parts' names do not depend on the order.
                let (low, high) = (root.min(other), root.max(other));
                parts.parent[high as usize] = low;
                root = low;
            }
        }
        for node in 0..nodes {
            if node.is_multiple_of(ASK_EVERY) {
                watch.at(0.0)?;
            }
            if parts.parent[node] != NONE {
                parts.parent[node] = parts.root(node as u32);
            }
        }
        Ok(parts)
    }

    fn touch(&mut self, node: usize) -> u32 {
        if self.parent[node] == NONE {
            self.parent[node] = node as u32;
        }
        self.root(node as u32)
    }

    fn root(&mut self, mut node: u32) -> u32 {
        while self.parent[node as usize] != node {
            let above = self.parent[self.parent[node as usize] as usize];
            self.parent[node as usize] = above;
            node = above;
        }
        node
    }

    /// The part of every node, named by its smallest node; [`NONE`] for nodes of no cell.
    pub(super) fn roots(&self) -> &[u32] {
        &self.parent
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_that_share_a_node_are_one_part() {
        let cells = [[8, 9, 10, 11, 12, 13, 14, 15], [0, 1, 2, 3, 4, 5, 6, 7], [15, 16, 17, 18, 19, 20, 21, 22]];
        let parts = Components::new(24, cells.into_iter(), Watch::silent()).unwrap();
        assert_eq!(parts.roots()[22], 8);
        assert_eq!(parts.roots()[7], 0);
        assert_eq!(parts.roots()[23], NONE);
    }
}
