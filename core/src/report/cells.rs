//! Many small cells as few path commands.
//!
//! A raster of voxels becomes one path for each shade, made of horizontal strokes one cell thick: equal neighbours in a
//! row share a stroke, and the commonest shade is laid under all others. Rasters with too many cells are merged into
//! coarser ones whose shade is the mean of their voxels.

use std::collections::BTreeMap;
use std::fmt::Write;

use super::palette;

/// Shades between the softest phase (0) and the stiffest; divisible by two and by three.
const SHADES: u32 = 24;

/// Most cells that one picture has.
pub const MOST_CELLS: usize = 60_000;

/// A raster of cells, some of them empty, each with the mean phase of its voxels.
#[derive(Debug, Clone)]
pub struct Cells {
    columns: usize,
    merged: [usize; 2],
    /// Sum of phase indices and number of voxels in every cell, row by row.
    sums: Vec<(u64, u64)>,
    phases: usize,
    mixed: bool,
}

impl Cells {
    /// A raster for `columns` times `rows` places of voxels of so many phases; empty.
    #[must_use]
    pub fn new(columns: usize, rows: usize, phases: usize) -> Self {
        let merged = merging(columns.max(1), rows.max(1));
        let (columns, rows) = (columns.max(1).div_ceil(merged[0]), rows.max(1).div_ceil(merged[1]));
        Self { columns, merged, sums: vec![(0, 0); columns * rows], phases: phases.max(2), mixed: false }
    }

    /// How many places one cell spans along and across.
    #[must_use]
    pub fn merged(&self) -> [usize; 2] {
        self.merged
    }

    /// Whether some cell holds voxels of different phases.
    #[must_use]
    pub fn is_mixed(&self) -> bool {
        self.mixed
    }

    /// Adds a voxel; places outside the raster are ignored.
    pub fn add(&mut self, column: usize, row: usize, phase: u8) {
        let (column, row) = (column / self.merged[0], row / self.merged[1]);
        if column >= self.columns {
            return;
        }
        let Some((sum, count)) = self.sums.get_mut(row * self.columns + column) else { return };
        self.mixed |= *count > 0 && *sum != u64::from(phase) * *count;
        *sum += u64::from(phase);
        *count += 1;
    }

    /// Shade of a cell, if it is not empty.
    fn shade(&self, sum: u64, count: u64) -> Option<u32> {
        let most = count * (self.phases as u64 - 1);
        (count > 0).then(|| ((sum * u64::from(SHADES) + most / 2) / most.max(1)) as u32)
    }

    /// Paths in units of cells, origin at the upper left corner.
    #[must_use]
    pub fn markup(&self) -> String {
        let shades: Vec<Option<u32>> = self.sums.iter().map(|(sum, count)| self.shade(*sum, *count)).collect();
        let mut frequency = BTreeMap::new();
        for shade in shades.iter().flatten() {
            *frequency.entry(*shade).or_insert(0_usize) += 1;
        }
        let Some(base) = frequency.iter().max_by_key(|(_, n)| **n).map(|(shade, _)| *shade) else {
            return String::new();
        };
        let mut paths: BTreeMap<u32, Pen> = BTreeMap::new();
        let mut ground = Pen::default();
        for (row, cells) in shades.chunks_exact(self.columns).enumerate() {
            for (shade, from, length) in runs(cells.iter().map(|c| c.filter(|s| *s != base))) {
                paths.entry(shade).or_default().stroke(from, row, length);
            }
            for (_, from, length) in runs(cells.iter().map(|c| c.map(|_| 0))) {
                ground.stroke(from, row, length);
            }
        }
        let mut markup = String::new();
        for (shade, pen) in std::iter::once((base, ground)).chain(paths) {
            let colour = palette::ramp(f64::from(shade) / f64::from(SHADES)).hex();
            let _ = writeln!(markup, "<path stroke=\"{colour}\" d=\"{}\"/>", pen.commands);
        }
        markup
    }
}

/// How many places a cell spans along and across so that there are at most [`MOST_CELLS`]: square cells where possible.
fn merging(columns: usize, rows: usize) -> [usize; 2] {
    let cells = |k: usize| columns.div_ceil(k) * rows.div_ceil(k.min(rows));
    let mut k = 1.max((columns as f64 * rows as f64 / MOST_CELLS as f64).sqrt() as usize);
    while cells(k) > MOST_CELLS {
        k += 1 + k / 16;
    }
    [k.min(columns), k.min(rows)]
}

/// Runs of equal values: value, start, length.
fn runs(cells: impl Iterator<Item = Option<u32>>) -> Vec<(u32, usize, usize)> {
    let mut found: Vec<(u32, usize, usize)> = Vec::new();
    for (i, cell) in cells.enumerate() {
        match (cell, found.last_mut()) {
            (Some(shade), Some((last, from, length))) if *last == shade && *from + *length == i => *length += 1,
            (Some(shade), _) => found.push((shade, i, 1)),
            (None, _) => {}
        }
    }
    found
}

/// Writes strokes relative to each other, which is shorter.
#[derive(Debug, Default)]
struct Pen {
    commands: String,
    at: [usize; 2],
}

impl Pen {
    fn stroke(&mut self, column: usize, row: usize, length: usize) {
        let (dx, dy) = (column as i64 - self.at[0] as i64, row as i64 - self.at[1] as i64);
        let separator = if dy < 0 { "" } else { " " };
        let _ = write!(self.commands, "m{dx}{separator}{dy}h{length}");
        self.at = [column + length, row];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_neighbours_share_a_stroke() {
        let mut cells = Cells::new(4, 2, 2);
        for column in 0..4 {
            cells.add(column, 0, 0);
            cells.add(column, 1, u8::from(column > 1));
        }
        assert!(!cells.is_mixed());
        let markup = cells.markup();
        assert_eq!(markup.lines().count(), 2, "{markup}");
        assert!(markup.contains("d=\"m0 0h4m-4 1h4\"") && markup.contains("d=\"m2 1h2\""), "{markup}");
    }

    #[test]
    fn a_column_of_both_phases_lies_halfway() {
        let mut cells = Cells::new(1, 1, 3);
        cells.add(0, 0, 0);
        cells.add(0, 0, 2);
        assert!(cells.is_mixed());
        assert!(cells.markup().contains(&palette::ramp(0.5).hex()));
        cells.add(7, 7, 1);
        assert!(Cells::new(0, 0, 2).markup().is_empty());
    }

    #[test]
    fn large_rasters_are_merged_whatever_their_proportions() {
        for (columns, rows) in [(1000, 610), (1_000_000, 2), (2, 1_000_000), (20_000, 10_000), (200, 122)] {
            let cells = Cells::new(columns, rows, 2);
            let (across, down) = (cells.columns, cells.sums.len() / cells.columns);
            assert!(across * down <= MOST_CELLS, "{columns} {rows}: {across} {down}");
            assert!(across * cells.merged()[0] >= columns && down * cells.merged()[1] >= rows);
        }
        assert_eq!(Cells::new(200, 122, 2).merged(), [1, 1]);
    }
}
