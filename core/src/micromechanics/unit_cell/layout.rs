//! Which voxels of a cell are rigid, and which layouts are the same cell seen from another side.

use std::collections::BTreeMap;

use super::UnitCellError;

/// Largest number of voxels along the edge of a cell.
pub const LARGEST_EDGE: usize = 4;

/// A square cell of `edge x edge x 1` voxels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CellSize {
    edge: usize,
}

impl CellSize {
    /// A cell of two, three or four voxels along x and along y, one along z.
    ///
    /// # Errors
    /// [`UnitCellError::Size`] for other numbers.
    pub fn new(edge: usize) -> Result<Self, UnitCellError> {
        if (2..=LARGEST_EDGE).contains(&edge) { Ok(Self { edge }) } else { Err(UnitCellError::Size { edge }) }
    }

    /// Voxels along x, and along y.
    #[must_use]
    pub fn edge(self) -> usize {
        self.edge
    }

    /// Voxels.
    #[must_use]
    pub fn voxels(self) -> usize {
        self.edge * self.edge
    }

    /// Number of layouts, `2^voxels`.
    #[must_use]
    pub fn layouts(self) -> u32 {
        1 << self.voxels()
    }

    /// `3x3x1` and the like.
    #[must_use]
    pub fn name(self) -> String {
        format!("{0}x{0}x1", self.edge)
    }
}

/// A layout: bit `y edge + x` is set where the voxel at `(x, y)` is rigid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Layout(pub u32);

impl Layout {
    /// Reads rows of zeros (soft) and ones (rigid), x rising in a row, y rising from row to row; slashes are optional.
    ///
    /// ```
    /// use voxelastica_core::micromechanics::unit_cell::{CellSize, Layout};
    /// let size = CellSize::new(2)?;
    /// let layout = Layout::read("10/00", size)?;
    /// assert_eq!((layout, layout.text(size).as_str()), (Layout(1), "10/00"));
    /// # Ok::<(), voxelastica_core::micromechanics::unit_cell::UnitCellError>(())
    /// ```
    ///
    /// # Errors
    /// [`UnitCellError::Layout`] for another number of digits, or other characters.
    pub fn read(text: &str, size: CellSize) -> Result<Self, UnitCellError> {
        let wrong = || UnitCellError::Layout {
            text: text.chars().take(40).collect(),
            voxels: size.voxels(),
            cell: size.name(),
        };
        let digits: Vec<char> = text.chars().filter(|c| *c != '/').collect();
        if digits.len() != size.voxels() || digits.iter().any(|c| !matches!(c, '0' | '1')) {
            return Err(wrong());
        }
        Ok(Self(digits.iter().enumerate().map(|(bit, c)| u32::from(*c == '1') << bit).sum()))
    }

    /// The layout as [`Self::read`] reads it.
    #[must_use]
    pub fn text(self, size: CellSize) -> String {
        let row = |y: usize| (0..size.edge).map(|x| if self.is_rigid(x, y, size) { '1' } else { '0' }).collect();
        (0..size.edge).map(row).collect::<Vec<String>>().join("/")
    }

    /// Whether the voxel at `(x, y)` is rigid.
    #[must_use]
    pub fn is_rigid(self, x: usize, y: usize, size: CellSize) -> bool {
        self.0 >> (y * size.edge + x) & 1 == 1
    }

    /// Number of rigid voxels.
    #[must_use]
    pub fn rigid_voxels(self) -> u32 {
        self.0.count_ones()
    }

    /// Volume fraction of the rigid phase.
    #[must_use]
    pub fn rigid_fraction(self, size: CellSize) -> f64 {
        f64::from(self.rigid_voxels()) / size.voxels() as f64
    }

    /// The cell turned or mirrored by one of the eight symmetries of the square.
    #[must_use]
    pub fn moved(self, symmetry: Symmetry, size: CellSize) -> Self {
        let mut moved = 0;
        for y in 0..size.edge {
            for x in 0..size.edge {
                if self.is_rigid(x, y, size) {
                    let [x, y] = symmetry.place([x, y], size);
                    moved |= 1 << (y * size.edge + x);
                }
            }
        }
        Self(moved)
    }
}

/// A symmetry of the square that maps the axes x and y onto themselves or onto each other, so that moduli along them can be
/// compared: mirror images in x and in y and, before them, the exchange of x and y. The eight of them include all turns.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Symmetry {
    /// Whether x and y change places: then so do the moduli along them.
    pub exchanges: bool,
    /// Whether x is mirrored, afterwards.
    pub mirrors_x: bool,
    /// Whether y is mirrored, afterwards.
    pub mirrors_y: bool,
}

impl Symmetry {
    /// All eight.
    #[must_use]
    pub fn all() -> [Self; 8] {
        std::array::from_fn(|i| Self { exchanges: i & 4 != 0, mirrors_x: i & 1 != 0, mirrors_y: i & 2 != 0 })
    }

    fn place(self, [x, y]: [usize; 2], size: CellSize) -> [usize; 2] {
        let [x, y] = if self.exchanges { [y, x] } else { [x, y] };
        let mirrored = |at: usize, mirrored: bool| if mirrored { size.edge - 1 - at } else { at };
        [mirrored(x, self.mirrors_x), mirrored(y, self.mirrors_y)]
    }
}

/// A layout's class: the representative and how the moduli follow from it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Member {
    /// The representative: the lowest of the layouts that symmetries make of this one.
    pub class: Layout,
    /// Whether the representative's x is this layout's y.
    pub exchanged: bool,
}

/// The class of a layout.
#[must_use]
pub fn member(layout: Layout, size: CellSize) -> Member {
    let mut best = Member { class: layout, exchanged: false };
    // Operations without exchange come first, so a layout that is its own image stays as it is.
    for symmetry in Symmetry::all() {
        let moved = layout.moved(symmetry, size);
        if moved < best.class {
            best = Member { class: moved, exchanged: symmetry.exchanges };
        }
    }
    best
}

/// All classes, in ascending order of their representatives, with the number of layouts in each.
#[must_use]
pub fn classes(size: CellSize) -> Vec<(Layout, u32)> {
    let mut counts = BTreeMap::new();
    for layout in 0..size.layouts() {
        *counts.entry(member(Layout(layout), size).class).or_insert(0) += 1;
    }
    counts.into_iter().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn burnside_counts_the_classes() {
        // (2^(n^2) + reflections + turns) / 8: 6, 102 and 8548.
        for (edge, expected) in [(2, 6), (3, 102), (4, 8548)] {
            let size = CellSize::new(edge).unwrap();
            let found = classes(size);
            assert_eq!(found.len(), expected);
            assert_eq!(found.iter().map(|(_, n)| n).sum::<u32>(), size.layouts());
        }
    }

    #[test]
    fn symmetries_permute_and_keep_the_fraction() {
        let size = CellSize::new(3).unwrap();
        let layout = Layout::read("110/000/001", size).unwrap();
        let images: std::collections::BTreeSet<_> = Symmetry::all().iter().map(|s| layout.moved(*s, size)).collect();
        assert_eq!(images.len(), 8);
        assert!(images.iter().all(|l| l.rigid_voxels() == 3 && member(*l, size).class == member(layout, size).class));
    }

    #[test]
    fn wrong_layouts_and_sizes_are_refused() {
        let size = CellSize::new(3).unwrap();
        for text in ["", "1010", "110/000/002", "110/000/0010"] {
            assert!(Layout::read(text, size).is_err(), "{text}");
        }
        assert!(CellSize::new(1).is_err() && CellSize::new(5).is_err());
    }
}
