//! A spoke as a stack of hexahedra.
//!
//! The strip lies along x with its rim at `x = 0`, its mid-plane at `z = 0` and its mid-line at `y = 0`. Planes of nodes
//! `x = const` bound slices of elements; slices may have different numbers of elements across, and a plane between two of
//! them carries the nodes of the wider one, so every node belongs to an element.
//!
//! ```text
//!        plane p    plane p+1
//!   z  8---------7              nodes of a plane: layer by layer from the lower face, y ascending in a layer
//!   | /|  y     /|              elements of a slice: in the same order
//!   |/ | /     / |              both are numbered from one, rim to hub
//!   5---------6  |
//!   |  4------|--3
//!   | /       | /
//!   1---------2  -> x
//! ```

/// Where the nodes of a plane sit across the width.
#[derive(Debug, Clone, PartialEq)]
pub enum Spacing {
    /// Elements of one width, mm: voxels.
    Even(f64),
    /// The plane's width, mm, divided evenly: a smooth outline.
    Width(Vec<f64>),
}

/// A stack of hexahedra.
#[derive(Debug, Clone, PartialEq)]
pub struct Block {
    length: f64,
    thickness: f64,
    layers: usize,
    /// Elements across each slice, even.
    across: Vec<usize>,
    spacing: Spacing,
    /// Rise of the mid-line in the middle, mm.
    bow: f64,
    /// First node of every plane, and one past the last.
    plane_nodes: Vec<u64>,
    /// First element of every slice, and one past the last.
    slice_elements: Vec<u64>,
}

impl Block {
    /// A block of equally long slices. `across` must be even and [`Spacing::Width`] must have one width a plane; with an
    /// odd number of layers the mid-line lies between two levels of nodes and has none itself.
    #[must_use]
    pub fn new(length: f64, thickness: f64, layers: usize, across: Vec<usize>, spacing: Spacing) -> Self {
        debug_assert!(!across.is_empty() && layers > 0 && across.iter().all(|n| n.is_multiple_of(2)));
        let mut block = Self {
            length,
            thickness,
            layers,
            across,
            spacing,
            bow: 0.0,
            plane_nodes: Vec::new(),
            slice_elements: Vec::new(),
        };
        let (mut node, mut element) = (1, 1);
        for plane in 0..=block.slices() {
            block.plane_nodes.push(node);
            node += (block.plane_across(plane) as u64 + 1) * (layers as u64 + 1);
        }
        block.plane_nodes.push(node);
        for across in &block.across {
            block.slice_elements.push(element);
            element += *across as u64 * layers as u64;
        }
        block.slice_elements.push(element);
        block
    }

    /// The block with its nodes raised by `bow (1 - cos(2 pi x / L)) / 2`: the shape in which a clamped strip buckles.
    #[must_use]
    pub fn bowed(mut self, bow: f64) -> Self {
        self.bow = bow;
        self
    }

    /// Slices of elements along the strip.
    #[must_use]
    pub fn slices(&self) -> usize {
        self.across.len()
    }

    /// Planes of nodes along the strip.
    #[must_use]
    pub fn planes(&self) -> usize {
        self.across.len() + 1
    }

    /// Elements through the thickness.
    #[must_use]
    pub fn layers(&self) -> usize {
        self.layers
    }

    /// Elements across slice `slice`.
    #[must_use]
    pub fn slice_across(&self, slice: usize) -> usize {
        self.across[slice]
    }

    /// Elements across the wider slice beside plane `plane`.
    #[must_use]
    pub fn plane_across(&self, plane: usize) -> usize {
        let before = plane.checked_sub(1).and_then(|i| self.across.get(i)).copied().unwrap_or(0);
        self.across.get(plane).copied().unwrap_or(0).max(before)
    }

    /// Number of nodes.
    #[must_use]
    pub fn nodes(&self) -> u64 {
        self.plane_nodes[self.planes()] - 1
    }

    /// Number of elements.
    #[must_use]
    pub fn elements(&self) -> u64 {
        self.slice_elements[self.slices()] - 1
    }

    /// First node of a plane; of the plane past the last one, one past the last node.
    #[must_use]
    pub fn first_node(&self, plane: usize) -> u64 {
        self.plane_nodes[plane]
    }

    /// First element of a slice; of the slice past the last one, one past the last element.
    #[must_use]
    pub fn first_element(&self, slice: usize) -> u64 {
        self.slice_elements[slice]
    }

    /// Node of the mid-line in a plane; the one below it where the number of layers is odd.
    #[must_use]
    pub fn midline_node(&self, plane: usize) -> u64 {
        let across = self.plane_across(plane) as u64;
        self.plane_nodes[plane] + (self.layers as u64 / 2) * (across + 1) + across / 2
    }

    /// Node of a plane at a level (0 is the lower face) above the lowest `y` of a slice `across` elements wide.
    #[must_use]
    pub fn row_start(&self, plane: usize, level: usize, across: usize) -> u64 {
        let own = self.plane_across(plane);
        self.plane_nodes[plane] + level as u64 * (own as u64 + 1) + (own - across) as u64 / 2
    }

    /// Nodes of the first element of a row, in the order of an eight-node brick; the next elements' are one higher each.
    #[must_use]
    pub fn row_connectivity(&self, slice: usize, layer: usize) -> [u64; 8] {
        let across = self.across[slice];
        let corner = |plane, level| self.row_start(plane, level, across);
        let (a, b) = (corner(slice, layer), corner(slice + 1, layer));
        let (c, d) = (corner(slice, layer + 1), corner(slice + 1, layer + 1));
        [a, b, b + 1, a + 1, c, d, d + 1, c + 1]
    }

    /// Distance of a plane from the rim, mm.
    #[must_use]
    pub fn x(&self, plane: usize) -> f64 {
        self.length * plane as f64 / self.slices() as f64
    }

    /// Position across, mm, of node `index` of a row of a plane.
    #[must_use]
    pub fn y(&self, plane: usize, index: usize) -> f64 {
        let across = self.plane_across(plane) as f64;
        let steps = index as f64 - 0.5 * across;
        match &self.spacing {
            Spacing::Even(edge) => steps * edge,
            Spacing::Width(widths) => steps * widths[plane] / across,
        }
    }

    /// Height, mm, of level `level` of a plane.
    #[must_use]
    pub fn z(&self, plane: usize, level: usize) -> f64 {
        let turn = std::f64::consts::TAU * plane as f64 / self.slices() as f64;
        let rise = if self.bow == 0.0 { 0.0 } else { 0.5 * self.bow * (1.0 - turn.cos()) };
        self.thickness * (level as f64 / self.layers as f64 - 0.5) + rise
    }

    /// Nodes of the mid-line, mm, rim to hub; the number of layers must be even.
    #[must_use]
    pub fn midline(&self) -> Vec<[f64; 3]> {
        (0..self.planes()).map(|p| [self.x(p), 0.0, self.z(p, self.layers / 2)]).collect()
    }

    /// Where the nodes of a plane sit across the width.
    #[must_use]
    pub fn spacing(&self) -> &Spacing {
        &self.spacing
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn planes_carry_the_nodes_of_their_wider_slice() {
        let block = Block::new(3.0, 2.0, 2, vec![4, 2, 4], Spacing::Even(1.0));
        assert_eq!((block.nodes(), block.elements()), (4 * 5 * 3, (4 + 2 + 4) * 2));
        assert_eq!((0..4).map(|p| block.plane_across(p)).collect::<Vec<_>>(), [4, 4, 4, 4]);
        assert_eq!(block.midline_node(1), 15 + 5 + 2 + 1);
        // The narrow slice hangs on the middle nodes of the planes beside it.
        assert_eq!(block.row_connectivity(1, 0), [17, 32, 33, 18, 22, 37, 38, 23]);
        assert_eq!((block.y(1, 0), block.y(1, 2), block.z(1, 0)), (-2.0, 0.0, -1.0));
    }

    #[test]
    fn a_bow_keeps_the_ends_and_lifts_the_middle() {
        let block = Block::new(10.0, 2.0, 2, vec![2; 4], Spacing::Width(vec![3.0; 5])).bowed(0.2);
        let line = block.midline();
        assert_eq!((line[0], line[4][0]), ([0.0; 3], 10.0));
        assert!((line[2][2] - 0.2).abs() < 1e-15 && (line[1][2] - 0.1).abs() < 1e-15 && line[4][2].abs() < 1e-15);
    }
}
