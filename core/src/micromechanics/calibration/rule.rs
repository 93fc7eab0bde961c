//! The rule that bending cells give: fraction to modulus, and back.

use serde::Serialize;

use super::CalibrationError;
use crate::numerics::monotone_cubic::MonotoneCubic;

/// A calibrated mixture rule of two phases: a rising table of the modulus in bending over the fraction of the stiffer phase,
/// with a monotone cubic of the modulus' logarithm in between.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MixtureRule {
    /// Volume fractions of the stiffer phase, ascending from 0 to 1.
    pub rigid_fraction: Vec<f64>,
    /// Modulus in bending, MPa, ascending.
    pub bending_mpa: Vec<f64>,
    /// Voigt's modulus at the same fractions, MPa.
    pub voigt_mpa: Vec<f64>,
    /// How the table was made.
    pub cell: RuleCell,
    /// Largest standard error of the mean over the cells of one fraction, percent.
    pub scatter_percent: f64,
    /// Largest error with which every second point of the table foretells the others, percent.
    pub interpolation_error_percent: f64,
    #[serde(skip)]
    curve: MonotoneCubic,
}

/// The cells that a rule was made from.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RuleCell {
    /// Slices, voxels across and layers of a cell.
    pub voxels: [usize; 3],
    /// Elements along a voxel's edge.
    pub elements_per_voxel: usize,
    /// Seeds of the cells of one fraction.
    pub seeds: Vec<u64>,
}

impl MixtureRule {
    /// A rule through points that rise in fraction; points at which the modulus does not rise are left out.
    pub(super) fn new(points: &[[f64; 3]], cell: RuleCell, scatter_percent: f64) -> Result<Self, CalibrationError> {
        let mut rising: Vec<[f64; 3]> = Vec::with_capacity(points.len());
        for point in points {
            if rising.last().is_none_or(|last| point[0] > last[0] && point[1] > last[1]) {
                rising.push(*point);
            }
        }
        let curve = curve(rising.iter()).ok_or(CalibrationError::NotRising)?;
        let last = rising.len() - 1;
        let coarse = self::curve(rising.iter().enumerate().filter(|(i, _)| i % 2 == 0 || *i == last).map(|(_, p)| p));
        let missed = |p: &[f64; 3]| coarse.as_ref().map_or(0.0, |c| (c.at(p[0]).exp() / p[1] - 1.0).abs());
        Ok(Self {
            rigid_fraction: rising.iter().map(|p| p[0]).collect(),
            bending_mpa: rising.iter().map(|p| p[1]).collect(),
            voigt_mpa: rising.iter().map(|p| p[2]).collect(),
            cell,
            scatter_percent,
            interpolation_error_percent: 100.0 * rising.iter().map(missed).fold(0.0, f64::max),
            curve,
        })
    }

    /// Modulus in bending at a fraction, MPa.
    #[must_use]
    pub fn modulus(&self, rigid_fraction: f64) -> f64 {
        self.curve.at(rigid_fraction).exp()
    }

    /// The fraction at which the modulus in bending is `modulus_mpa`; the nearest end for a modulus out of reach.
    #[must_use]
    pub fn fraction(&self, modulus_mpa: f64) -> f64 {
        let (mut low, mut high) = (0.0, 1.0);
        if modulus_mpa <= self.modulus(low) {
            return low;
        }
        if modulus_mpa >= self.modulus(high) {
            return high;
        }
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if self.modulus(middle) < modulus_mpa {
                low = middle;
            } else {
                high = middle;
            }
        }
        0.5 * (low + high)
    }
}

fn curve<'a>(points: impl Iterator<Item = &'a [f64; 3]>) -> Option<MonotoneCubic> {
    let (x, y) = points.map(|p| (p[0], p[1].ln())).unzip();
    MonotoneCubic::new(x, y)
}
