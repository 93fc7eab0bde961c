//! A spoke's mid-surface as a strip of quadrilaterals.
//!
//! In the spoke's own frame the rim is at `s = 0` and the mid-line at `y = 0`. Rows of nodes `s = const` bound slices of
//! elements; slices may have different numbers of elements across, and a row between two of them carries the nodes of the
//! wider one, so every node belongs to an element.
//!
//! ```text
//!   y  4-------3         nodes of a row: y ascending; elements of a slice: in the same order
//!   |  |       |         both are numbered from one, rim to hub; normals point up (+z)
//!   |  1-------2 -> s
//! ```

use super::Spacing;

/// A strip of quadrilaterals.
#[derive(Debug, Clone, PartialEq)]
pub struct Sheet {
    /// Distance of every row of nodes from the rim, mm.
    stations: Vec<f64>,
    /// Elements across each slice, even.
    across: Vec<usize>,
    spacing: Spacing,
    /// First node of every row, and one past the last.
    row_nodes: Vec<u64>,
    /// First element of every slice, and one past the last.
    slice_elements: Vec<u64>,
}

impl Sheet {
    /// A strip with rows of nodes at `stations`, one more than there are slices. Numbers in `across` must be even for the
    /// mid-line to have nodes, and [`Spacing::Width`] must have one width a row.
    #[must_use]
    pub fn new(stations: Vec<f64>, across: Vec<usize>, spacing: Spacing) -> Self {
        debug_assert!(stations.len() == across.len() + 1 && across.iter().all(|n| n.is_multiple_of(2)));
        let mut sheet = Self { stations, across, spacing, row_nodes: Vec::new(), slice_elements: Vec::new() };
        let (mut node, mut element) = (1, 1);
        for row in 0..sheet.rows() {
            sheet.row_nodes.push(node);
            node += sheet.row_across(row) as u64 + 1;
        }
        sheet.row_nodes.push(node);
        for across in &sheet.across {
            sheet.slice_elements.push(element);
            element += *across as u64;
        }
        sheet.slice_elements.push(element);
        sheet
    }

    /// Slices of elements along the strip.
    #[must_use]
    pub fn slices(&self) -> usize {
        self.across.len()
    }

    /// Rows of nodes along the strip.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.stations.len()
    }

    /// Elements across slice `slice`.
    #[must_use]
    pub fn slice_across(&self, slice: usize) -> usize {
        self.across[slice]
    }

    /// Elements across the wider slice beside row `row`.
    #[must_use]
    pub fn row_across(&self, row: usize) -> usize {
        let before = row.checked_sub(1).and_then(|i| self.across.get(i)).copied().unwrap_or(0);
        self.across.get(row).copied().unwrap_or(0).max(before)
    }

    /// Number of nodes.
    #[must_use]
    pub fn nodes(&self) -> u64 {
        self.row_nodes[self.rows()] - 1
    }

    /// Number of elements.
    #[must_use]
    pub fn elements(&self) -> u64 {
        self.slice_elements[self.slices()] - 1
    }

    /// First node of a row; of the row past the last one, one past the last node.
    #[must_use]
    pub fn first_node(&self, row: usize) -> u64 {
        self.row_nodes[row]
    }

    /// First element of a slice; of the slice past the last one, one past the last element.
    #[must_use]
    pub fn first_element(&self, slice: usize) -> u64 {
        self.slice_elements[slice]
    }

    /// Node of the mid-line in a row.
    #[must_use]
    pub fn midline_node(&self, row: usize) -> u64 {
        self.row_nodes[row] + self.row_across(row) as u64 / 2
    }

    /// Nodes of the first element of a slice; the next elements' are one higher each.
    #[must_use]
    pub fn connectivity(&self, slice: usize) -> [u64; 4] {
        let first = |row: usize| self.row_nodes[row] + (self.row_across(row) - self.across[slice]) as u64 / 2;
        let (near, far) = (first(slice), first(slice + 1));
        [near, far, far + 1, near + 1]
    }

    /// Distance of a row from the rim, mm.
    #[must_use]
    pub fn s(&self, row: usize) -> f64 {
        self.stations[row]
    }

    /// Position across, mm, of node `index` of a row.
    #[must_use]
    pub fn y(&self, row: usize, index: usize) -> f64 {
        let across = self.row_across(row) as f64;
        let steps = index as f64 - 0.5 * across;
        match &self.spacing {
            Spacing::Even(edge) => steps * edge,
            Spacing::Width(widths) => steps * widths[row] / across,
        }
    }

    /// Largest distance of a node from the mid-line, mm.
    #[must_use]
    pub fn half_width(&self) -> f64 {
        (0..self.rows()).map(|row| self.y(row, self.row_across(row))).fold(0.0, f64::max)
    }
}

/// Divides a strip of variable width into slices whose length is proportional to the root of the width.
///
/// Half-way, on a logarithmic scale, between even slices, whose quadrilaterals would be long and narrow at the hub and
/// short and wide at the rim, and slices of equal proportions, which would leave the rim too coarse for its curvature.
/// `s` and `widths` sample the strip.
///
/// ```
/// # use voxelastica_core::mesh::sheet::graded_stations;
/// let even = graded_stations(&[0.0, 2.0, 4.0], &[1.0, 1.0, 1.0], 4);
/// assert_eq!(even, [0.0, 1.0, 2.0, 3.0, 4.0]);
/// ```
#[must_use]
pub fn graded_stations(s: &[f64], widths: &[f64], slices: usize) -> Vec<f64> {
    let mut sums = Vec::with_capacity(s.len());
    let mut sum = 0.0;
    for i in 0..s.len() {
        if i > 0 {
            sum += (s[i] - s[i - 1]) * 0.5 * (widths[i].sqrt().recip() + widths[i - 1].sqrt().recip());
        }
        sums.push(sum);
    }
    let last = s.len() - 1;
    (0..=slices)
        .map(|k| {
            let wanted = sum * k as f64 / slices as f64;
            let i = sums.partition_point(|at| *at <= wanted).clamp(1, last);
            if k == 0 || k == slices {
                // Ends are ends, whatever rounding says.
                return if k == 0 { s[0] } else { s[last] };
            }
            s[i - 1] + (s[i] - s[i - 1]) * (wanted - sums[i - 1]) / (sums[i] - sums[i - 1])
        })
        .collect()
}
