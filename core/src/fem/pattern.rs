//! Unknowns and the sparsity of the tangent.
//!
//! Nodes between the end planes have three unknowns each. The nodes of the end planes move with their rigid section; a
//! hub that is free to rise adds one unknown, numbered last, that all nodes of the hub's plane share.

use super::FemError;
use super::error::{go_on, go_on_at};
use super::mesh::Mesh;
use super::ordering::nested_dissection;
use crate::progress::Cancelled;

/// What a node's displacement depends on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NodeUnknowns {
    /// Nothing: it is prescribed.
    Fixed,
    /// Three unknowns from this number on.
    Free(u32),
    /// Its height is the last unknown, the rest is prescribed.
    Lift,
}

/// The lower triangle of the tangent by columns, and where element matrices go.
#[derive(Debug, Clone, PartialEq)]
pub struct Pattern {
    /// What every node depends on.
    pub nodes: Vec<NodeUnknowns>,
    /// Start of every column in [`Pattern::rows`], and their number.
    pub columns: Vec<usize>,
    /// Row of every entry, ascending in a column, the diagonal first.
    pub rows: Vec<usize>,
    /// For every element and pair of its nodes `a < b` the place of the later eliminated one among the neighbours of the
    /// other; unused where one is not free.
    neighbours: Vec<[u8; PAIRS]>,
}

/// Pairs of different nodes of an element.
const PAIRS: usize = 28;

/// The number of a pair of nodes `a < b` of an element.
fn pair(a: usize, b: usize) -> usize {
    b * (b - 1) / 2 + a
}

impl Pattern {
    /// The pattern of a mesh whose end planes are prescribed, but for the hub's height where `lift` says so.
    ///
    /// # Errors
    /// [`FemError::Cancelled`].
    pub fn new(mesh: &Mesh, lift: bool, cancelled: Cancelled<'_>) -> Result<Self, FemError> {
        let order = nested_dissection(mesh);
        go_on(cancelled)?;
        let mut nodes = vec![NodeUnknowns::Fixed; mesh.nodes.len()];
        let mut rank = vec![u32::MAX; mesh.nodes.len()];
        for (i, node) in order.iter().enumerate() {
            nodes[*node as usize] = NodeUnknowns::Free(3 * i as u32);
            rank[*node as usize] = i as u32;
        }
        if lift {
            for node in mesh.plane(mesh.plane_count() - 1) {
                nodes[node] = NodeUnknowns::Lift;
            }
        }
        let later = later_neighbours(mesh, &rank, order.len(), cancelled)?;
        let total = 3 * order.len() + usize::from(lift);
        let touches_lift = lifted(mesh, &nodes, &rank, order.len());
        let mut columns = Vec::with_capacity(total + 1);
        let mut rows = Vec::with_capacity(9 * later.places.len() + 6 * order.len());
        for i in 0..order.len() {
            go_on_at(i, cancelled)?;
            for k in 0..3 {
                columns.push(rows.len());
                rows.extend(3 * i + k..3 * i + 3);
                for neighbour in later.of(i) {
                    let first = 3 * *neighbour as usize;
                    rows.extend(first..first + 3);
                }
                if touches_lift[i] {
                    rows.push(total - 1);
                }
            }
        }
        if lift {
            columns.push(rows.len());
            rows.push(total - 1);
        }
        columns.push(rows.len());
        let mut neighbours = Vec::with_capacity(mesh.elements.len());
        for (i, element) in mesh.elements.iter().enumerate() {
            go_on_at(i, cancelled)?;
            neighbours.push(element_pairs(element, &rank, &later));
        }
        Ok(Self { nodes, columns, rows, neighbours })
    }

    /// Number of unknowns.
    #[must_use]
    pub fn unknowns(&self) -> usize {
        self.columns.len() - 1
    }

    /// Adds the upper triangle of an element's matrix to the values of the tangent.
    pub(super) fn scatter(
        &self,
        number: usize,
        element: &[u32; 8],
        matrix: &super::element::ElementMatrix,
        values: &mut [f64],
    ) {
        let neighbours = &self.neighbours[number];
        let last = values.len() - 1;
        for (b, node_b) in element.iter().enumerate() {
            for (a, node_a) in element[..=b].iter().enumerate() {
                match (self.nodes[*node_a as usize], self.nodes[*node_b as usize]) {
                    (NodeUnknowns::Free(first), NodeUnknowns::Free(_)) if a == b => {
                        for k in 0..3 {
                            let start = self.columns[first as usize + k];
                            for l in k..3 {
                                values[start + l - k] += matrix[3 * a + k][3 * a + l];
                            }
                        }
                    }
                    (NodeUnknowns::Free(first_a), NodeUnknowns::Free(first_b)) => {
                        let place = 3 * usize::from(neighbours[pair(a, b)]) + 3;
                        let first = first_a.min(first_b) as usize;
                        for k in 0..3 {
                            let start = self.columns[first + k] + place - k;
                            for l in 0..3 {
                                // k belongs to the column, the node that is eliminated first.
                                values[start + l] += if first_a < first_b {
                                    matrix[3 * a + k][3 * b + l]
                                } else {
                                    matrix[3 * a + l][3 * b + k]
                                };
                            }
                        }
                    }
                    (NodeUnknowns::Free(first), NodeUnknowns::Lift) => {
                        for k in 0..3 {
                            values[self.columns[first as usize + k + 1] - 1] += matrix[3 * a + k][3 * b + 2];
                        }
                    }
                    (NodeUnknowns::Lift, NodeUnknowns::Free(first)) => {
                        for k in 0..3 {
                            values[self.columns[first as usize + k + 1] - 1] += matrix[3 * a + 2][3 * b + k];
                        }
                    }
                    (NodeUnknowns::Lift, NodeUnknowns::Lift) => {
                        let value = matrix[3 * a + 2][3 * b + 2];
                        values[last] += if a == b { value } else { 2.0 * value };
                    }
                    (NodeUnknowns::Fixed, _) | (_, NodeUnknowns::Fixed) => {}
                }
            }
        }
    }

    /// Collects a value a node into a value an unknown.
    #[must_use]
    pub fn gather(&self, of_nodes: &[[f64; 3]]) -> Vec<f64> {
        let mut of_unknowns = vec![0.0; self.unknowns()];
        let last = of_unknowns.len().saturating_sub(1);
        for (node, value) in self.nodes.iter().zip(of_nodes) {
            match node {
                NodeUnknowns::Free(first) => of_unknowns[*first as usize..][..3].copy_from_slice(value),
                NodeUnknowns::Lift => of_unknowns[last] += value[2],
                NodeUnknowns::Fixed => {}
            }
        }
        of_unknowns
    }

    /// Adds `factor` times a change of the unknowns to the nodes' values.
    pub fn spread(&self, of_unknowns: &[f64], factor: f64, of_nodes: &mut [[f64; 3]]) {
        let last = of_unknowns.last().copied().unwrap_or(0.0);
        for (node, value) in self.nodes.iter().zip(of_nodes) {
            match node {
                NodeUnknowns::Free(first) => {
                    for (v, u) in value.iter_mut().zip(&of_unknowns[*first as usize..]) {
                        *v += factor * u;
                    }
                }
                NodeUnknowns::Lift => value[2] += factor * last,
                NodeUnknowns::Fixed => {}
            }
        }
    }

    /// `K x` for a tangent of this pattern.
    #[must_use]
    pub fn multiply(&self, values: &[f64], x: &[f64]) -> Vec<f64> {
        let mut product = vec![0.0; x.len()];
        for (j, xj) in x.iter().enumerate() {
            let entries = self.columns[j]..self.columns[j + 1];
            let mut sum = 0.0;
            for (row, value) in self.rows[entries.clone()].iter().zip(&values[entries]) {
                if *row == j {
                    sum += value * xj;
                } else {
                    product[*row] += value * xj;
                    sum += value * x[*row];
                }
            }
            product[j] += sum;
        }
        product
    }
}

/// Neighbours of every node that are eliminated after it, ascending.
struct LaterNeighbours {
    starts: Vec<usize>,
    places: Vec<u32>,
}

impl LaterNeighbours {
    fn of(&self, rank: usize) -> &[u32] {
        &self.places[self.starts[rank]..self.starts[rank + 1]]
    }
}

fn later_neighbours(
    mesh: &Mesh,
    rank: &[u32],
    free: usize,
    cancelled: Cancelled<'_>,
) -> Result<LaterNeighbours, FemError> {
    let pairs = |element: &[u32; 8]| {
        let ranks = element.map(|node| rank[node as usize]);
        (0..8)
            .flat_map(move |b| (0..b).map(move |a| [ranks[a], ranks[b]]))
            .filter(|p| p[0] != u32::MAX && p[1] != u32::MAX)
            .map(|p| [p[0].min(p[1]), p[0].max(p[1])])
    };
    let mut starts = vec![0_usize; free + 1];
    for (i, element) in mesh.elements.iter().enumerate() {
        go_on_at(i, cancelled)?;
        pairs(element).for_each(|[low, _]| starts[low as usize + 1] += 1);
    }
    for i in 0..free {
        starts[i + 1] += starts[i];
    }
    let mut next = starts.clone();
    let mut places = vec![0_u32; starts[free]];
    for (i, element) in mesh.elements.iter().enumerate() {
        go_on_at(i, cancelled)?;
        for [low, high] in pairs(element) {
            places[next[low as usize]] = high;
            next[low as usize] += 1;
        }
    }
    // Sorted and without repetitions.
    let mut unique = LaterNeighbours { starts: vec![0], places: Vec::with_capacity(13 * free) };
    for i in 0..free {
        go_on_at(i, cancelled)?;
        let list = &mut places[starts[i]..starts[i + 1]];
        list.sort_unstable();
        let before = unique.places.len();
        for place in list.iter() {
            if unique.places.len() == before || unique.places.last() != Some(place) {
                unique.places.push(*place);
            }
        }
        unique.starts.push(unique.places.len());
    }
    Ok(unique)
}

/// Whether a free node shares an element with a node whose height is the last unknown.
fn lifted(mesh: &Mesh, nodes: &[NodeUnknowns], rank: &[u32], free: usize) -> Vec<bool> {
    let mut touches = vec![false; free];
    for element in &mesh.elements {
        if element.iter().any(|n| nodes[*n as usize] == NodeUnknowns::Lift) {
            for node in element {
                if let Some(flag) = touches.get_mut(rank[*node as usize] as usize) {
                    *flag = true;
                }
            }
        }
    }
    touches
}

fn element_pairs(element: &[u32; 8], rank: &[u32], later: &LaterNeighbours) -> [u8; PAIRS] {
    let mut places = [0; PAIRS];
    for b in 1..8 {
        for a in 0..b {
            let (first, second) = (rank[element[a] as usize], rank[element[b] as usize]);
            if first == u32::MAX || second == u32::MAX {
                continue;
            }
            // A node of a structured mesh has at most 26 neighbours.
            let list = later.of(first.min(second) as usize);
            places[pair(a, b)] = list.partition_point(|n| *n < first.max(second)) as u8;
        }
    }
    places
}
