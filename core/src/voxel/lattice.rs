//! Slices, layers and the width in whole voxels.

use serde::{Deserialize, Serialize};

/// A ratio this close to a whole number counts as whole.
const WHOLE: f64 = 1e-6;

/// How the half-width is rounded to voxels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Rounding {
    /// To the nearest whole number of voxels.
    Nearest,
    /// Down, so that neighbouring spokes never overlap in the morphed state.
    Inward,
}

/// What keeps a strip from being cut into voxels.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LatticeError {
    /// The voxel does not divide the length and the thickness.
    #[error(
        "voxels of {size_mm} mm do not divide the length of {length_mm} mm and the thickness of {thickness_mm} mm into whole \
         slices and layers; {help}"
    )]
    DoesNotDivide {
        /// Voxel edge, mm.
        size_mm: f64,
        /// Strip length, mm.
        length_mm: f64,
        /// Strip thickness, mm.
        thickness_mm: f64,
        /// The nearest size that does.
        help: String,
    },
    /// The strip is thinner than one voxel.
    #[error(
        "the thickness of {thickness_mm} mm is less than one voxel of {size_mm} mm; use voxels of at most {thickness_mm} mm"
    )]
    ThinnerThanVoxel {
        /// Strip thickness, mm.
        thickness_mm: f64,
        /// Voxel edge, mm.
        size_mm: f64,
    },
    /// More voxels than can be handled.
    #[error(
        "the strip would have about {voxels:.3e} voxels, more than the limit of {limit:.1e}; use larger voxels{help}"
    )]
    TooMany {
        /// Estimated number of voxels.
        voxels: f64,
        /// Limit.
        limit: f64,
        /// How the limit is lifted, where it can be.
        help: &'static str,
    },
}

/// The lattice of one strip: `slices` along the length, `layers` through the thickness, cubes of edge `size_mm`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lattice {
    /// Voxel edge `eta`, mm.
    pub size_mm: f64,
    /// Number of slices `L / eta`.
    pub slices: usize,
    /// Number of layers `t / eta`.
    pub layers: usize,
}

impl Lattice {
    /// Cuts a strip of the given length and thickness into voxels.
    ///
    /// # Errors
    /// [`LatticeError::ThinnerThanVoxel`] and [`LatticeError::DoesNotDivide`], which proposes the nearest size that
    /// divides.
    pub fn new(length_mm: f64, thickness_mm: f64, size_mm: f64) -> Result<Self, LatticeError> {
        if thickness_mm < size_mm * (1.0 - WHOLE) {
            return Err(LatticeError::ThinnerThanVoxel { thickness_mm, size_mm });
        }
        let (slices, layers) = (length_mm / size_mm, thickness_mm / size_mm);
        if slices > 1e9 {
            return Err(LatticeError::TooMany { voxels: slices * layers, limit: 1e9, help: "" });
        }
        if is_whole(slices) && is_whole(layers) {
            return Ok(Self { size_mm, slices: slices.round() as usize, layers: layers.round() as usize });
        }
        let help = match nearest_size(length_mm, thickness_mm, size_mm) {
            Some(size) => format!("the nearest size that does is {size} mm"),
            None => "no size does for these two; change the length or the thickness".to_owned(),
        };
        Err(LatticeError::DoesNotDivide { size_mm, length_mm, thickness_mm, help })
    }

    /// Arc length of the centre of slice `i`, mm.
    #[must_use]
    pub fn centre(&self, i: usize) -> f64 {
        (i as f64 + 0.5) * self.size_mm
    }

    /// Half-width in voxels: `max(1, round(w / (2 eta)))`, or rounded down.
    #[must_use]
    pub fn half_width(&self, width_mm: f64, rounding: Rounding) -> usize {
        let half = width_mm / (2.0 * self.size_mm);
        let rounded = match rounding {
            Rounding::Nearest => half.round(),
            Rounding::Inward => (half + WHOLE).floor(),
        };
        (rounded as usize).max(1)
    }

    /// Number of voxels in a strip with these half-widths.
    #[must_use]
    pub fn voxels(&self, half_widths: &[usize]) -> u64 {
        half_widths.iter().map(|n| 2 * *n as u64 * self.layers as u64).sum()
    }
}

fn is_whole(ratio: f64) -> bool {
    (ratio - ratio.round()).abs() <= WHOLE * ratio.max(1.0) && ratio.round() >= 1.0
}

/// The size closest to the wanted one that divides both lengths: `t/m` for some whole `m`, rounded to a short decimal.
fn nearest_size(length_mm: f64, thickness_mm: f64, size_mm: f64) -> Option<f64> {
    let middle = (thickness_mm / size_mm).round().clamp(1.0, 1e6) as usize;
    let candidates = (1..=middle.saturating_mul(2).saturating_add(50)).map(|m| thickness_mm / m as f64);
    candidates
        .filter(|size| is_whole(length_mm / size))
        .min_by(|a, b| (a - size_mm).abs().total_cmp(&(b - size_mm).abs()))
        .map(|size| (size * 1e9).round() / 1e9)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_numbers_of_slices_and_layers_are_required_and_the_nearest_size_proposed() {
        assert_eq!(Lattice::new(100.0, 2.0, 0.1).unwrap(), Lattice { size_mm: 0.1, slices: 1000, layers: 20 });
        let error = Lattice::new(100.0, 2.0, 0.3).unwrap_err().to_string();
        assert!(error.contains("nearest size that does is 0.285714286 mm") || error.contains("0.25 mm"), "{error}");
        assert!(matches!(Lattice::new(100.0, 0.5, 1.0), Err(LatticeError::ThinnerThanVoxel { .. })));
        assert!(Lattice::new(1.0, std::f64::consts::SQRT_2, 0.5).unwrap_err().to_string().contains("no size"));
    }

    #[test]
    fn widths_are_rounded_to_the_nearest_or_inward_and_never_vanish() {
        let lattice = Lattice::new(10.0, 1.0, 0.5).unwrap();
        assert_eq!(lattice.half_width(2.6, Rounding::Nearest), 3);
        assert_eq!(lattice.half_width(2.6, Rounding::Inward), 2);
        assert_eq!(lattice.half_width(0.1, Rounding::Inward), 1);
        assert_eq!(lattice.half_width(3.0, Rounding::Inward), 3);
    }
}
