//! All layouts of a cell, held against the bounds.

use std::sync::atomic::{AtomicU64, Ordering};

use rayon::prelude::*;

use super::UnitCellError;
use super::layout::{CellSize, Layout, classes, member};
use super::stretch::{CellMesh, StretchTest};
use crate::materials::Material;
use crate::micromechanics::{hashin_shtrikman, reuss, voigt};
use crate::progress::Progress;

/// Slack of a comparison with a bound, as a share of the bound: what rounding leaves.
const SLACK: f64 = 1e-9;

/// The moduli of every class of layouts.
#[derive(Debug, Clone)]
pub struct Catalogue {
    size: CellSize,
    phases: [Material; 2],
    mesh: CellMesh,
    /// Representative, number of layouts, moduli along x, y and z, MPa.
    classes: Vec<(Layout, u32, [f64; 3])>,
}

/// One layout and what bounds its moduli, MPa.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Row {
    /// The layout.
    pub layout: Layout,
    /// The representative of its class.
    pub class: Layout,
    /// Number of layouts in the class.
    pub multiplicity: u32,
    /// Volume fraction of the second phase.
    pub rigid_fraction: f64,
    /// Moduli along x, y and z.
    pub moduli_mpa: [f64; 3],
    /// Voigt's bound.
    pub voigt_mpa: f64,
    /// Reuss's bound.
    pub reuss_mpa: f64,
    /// Hashin and Shtrikman's bounds of an isotropic mixture of this fraction, lower first.
    pub hashin_shtrikman_mpa: [f64; 2],
}

impl Row {
    /// Departure of the moduli from Voigt's rule, as a share of it.
    #[must_use]
    pub fn departure(&self) -> [f64; 3] {
        self.moduli_mpa.map(|e| e / self.voigt_mpa - 1.0)
    }

    /// Whether every modulus lies between Reuss's and Voigt's bounds.
    #[must_use]
    pub fn is_within_bounds(&self) -> bool {
        let range = self.reuss_mpa * (1.0 - SLACK)..=self.voigt_mpa * (1.0 + SLACK);
        self.moduli_mpa.iter().all(|e| range.contains(e))
    }

    /// Whether every modulus lies between Hashin and Shtrikman's bounds, which hold for isotropic mixtures.
    #[must_use]
    pub fn is_within_hashin_shtrikman(&self) -> bool {
        let [low, high] = self.hashin_shtrikman_mpa;
        let range = low * (1.0 - SLACK)..=high * (1.0 + SLACK);
        self.moduli_mpa.iter().all(|e| range.contains(e))
    }
}

/// How the moduli of all layouts of one fraction depart from Voigt's rule, as shares of it. Along x and y the same values
/// occur, because exchanging the axes maps the set of layouts onto itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Departure {
    /// Volume fraction of the second phase.
    pub rigid_fraction: f64,
    /// Along x: least, mean over all layouts, most.
    pub in_plane: [f64; 3],
    /// Along z.
    pub across: [f64; 3],
}

impl Catalogue {
    /// Tests one layout of every class. `progress` is told how many classes are done; it is asked before each.
    ///
    /// # Errors
    /// [`UnitCellError`].
    pub fn compute(
        size: CellSize,
        phases: [&Material; 2],
        mesh: CellMesh,
        progress: Progress<'_>,
    ) -> Result<Self, UnitCellError> {
        let test = StretchTest::new(size, phases, &mesh)?;
        let done = AtomicU64::new(0);
        let classes = classes(size)
            .into_par_iter()
            .map(|(layout, multiplicity)| {
                if !progress(done.load(Ordering::Relaxed)) {
                    return Err(UnitCellError::Cancelled);
                }
                let moduli = test.moduli(layout)?;
                done.fetch_add(1, Ordering::Relaxed);
                Ok((layout, multiplicity, moduli))
            })
            .collect::<Result<Vec<_>, _>>()?;
        Ok(Self { size, phases: phases.map(Clone::clone), mesh, classes })
    }

    /// The cell.
    #[must_use]
    pub fn size(&self) -> CellSize {
        self.size
    }

    /// The phases; the second one is called rigid.
    #[must_use]
    pub fn phases(&self) -> &[Material; 2] {
        &self.phases
    }

    /// The mesh.
    #[must_use]
    pub fn mesh(&self) -> CellMesh {
        self.mesh
    }

    /// One row a class, in the order of the representatives.
    pub fn classes(&self) -> impl Iterator<Item = Row> + '_ {
        self.classes.iter().map(|(layout, multiplicity, moduli)| self.row(*layout, *layout, *multiplicity, *moduli))
    }

    /// The row of any layout; along exchanged axes its moduli are exchanged.
    #[must_use]
    pub fn layout(&self, layout: Layout) -> Option<Row> {
        let member = member(layout, self.size);
        let at = self.classes.binary_search_by_key(&member.class, |(class, ..)| *class).ok()?;
        let (class, multiplicity, [x, y, z]) = self.classes[at];
        let moduli = if member.exchanged { [y, x, z] } else { [x, y, z] };
        Some(self.row(layout, class, multiplicity, moduli))
    }

    /// One row a layout.
    pub fn layouts(&self) -> impl Iterator<Item = Row> + '_ {
        (0..self.size.layouts()).filter_map(|layout| self.layout(Layout(layout)))
    }

    fn row(&self, layout: Layout, class: Layout, multiplicity: u32, moduli_mpa: [f64; 3]) -> Row {
        let fraction = layout.rigid_fraction(self.size);
        let [soft, rigid] = &self.phases;
        let (shares, moduli) = ([1.0 - fraction, fraction], [soft.modulus_mpa, rigid.modulus_mpa]);
        let (low, high) = hashin_shtrikman(soft, rigid, fraction);
        Row {
            layout,
            class,
            multiplicity,
            rigid_fraction: fraction,
            moduli_mpa,
            voigt_mpa: voigt(&shares, &moduli),
            reuss_mpa: reuss(&shares, &moduli),
            hashin_shtrikman_mpa: [low.min(high), low.max(high)],
        }
    }

    /// Departures from Voigt's rule, one entry a fraction, ascending.
    #[must_use]
    pub fn departures(&self) -> Vec<Departure> {
        let spread = |count: u32, axes: &[usize]| {
            let (mut least, mut most, mut sum, mut layouts) = (f64::INFINITY, f64::NEG_INFINITY, 0.0, 0.0);
            for row in self.classes().filter(|row| row.layout.rigid_voxels() == count) {
                for axis in axes {
                    let departure = row.departure()[*axis];
                    least = departure.min(least);
                    most = departure.max(most);
                    sum += departure * f64::from(row.multiplicity);
                    layouts += f64::from(row.multiplicity);
                }
            }
            [least, sum / layouts, most]
        };
        (0..=self.size.voxels() as u32)
            .map(|count| Departure {
                rigid_fraction: f64::from(count) / self.size.voxels() as f64,
                in_plane: spread(count, &[0, 1]),
                across: spread(count, &[2]),
            })
            .collect()
    }
}
