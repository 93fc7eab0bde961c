//! What keeps a design from being made.

use super::voxel_surface::SurfaceError;
use crate::error::Error;
use crate::input::{FabricationKind, InputError};

/// Why a kind of file cannot be made of a design.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FabricationError {
    /// The design has nothing of this kind.
    #[error("{kind} does not go with this design: {why}")]
    NotApplicable {
        /// The kind.
        kind: FabricationKind,
        /// What the design lacks.
        why: &'static str,
    },
    /// This version has no writer for the kind.
    #[error("this version does not write {kind}")]
    Unknown {
        /// The kind.
        kind: FabricationKind,
    },
    /// A print stack would have more voxels than are made without being asked twice.
    #[error(
        "{kind} would have {voxels:.3e} voxels of {} x {} x {} um, more than the limit of {limit:.1e}; use a coarser pitch, \
         scope = \"spoke\", or ask for it with --yes", .pitch_um[0], .pitch_um[1], .pitch_um[2]
    )]
    TooManyVoxels {
        /// The kind.
        kind: FabricationKind,
        /// Voxels, void included.
        voxels: f64,
        /// Limit.
        limit: f64,
        /// Pitch, um.
        pitch_um: [f64; 3],
    },
    /// An image would have more pixels along a side than the format's readers take.
    #[error(
        "a slice of {kind} would have {pixels:.0} pixels along one side, more than the {limit} that images may have; use a \
         coarser pitch or scope = \"spoke\""
    )]
    ImageTooLarge {
        /// The kind.
        kind: FabricationKind,
        /// Pixels along the longer side.
        pixels: f64,
        /// Limit.
        limit: u32,
    },
    /// An outline that was moved outward by half a kerf crosses itself.
    #[error(
        "with a kerf of {kerf_mm} mm an outline crosses itself at x = {x:.2} mm, y = {y:.2} mm; use a narrower kerf"
    )]
    OutlineCrosses {
        /// Width of the cut, mm.
        kerf_mm: f64,
        /// Where, mm.
        x: f64,
        /// Where, mm.
        y: f64,
    },
    /// The phases' surfaces cannot be held in a file.
    #[error("{kind}: {error}")]
    Surface {
        /// The kind.
        kind: FabricationKind,
        /// Why.
        error: SurfaceError,
    },
}

impl FabricationError {
    /// The key of the design file that decides.
    #[must_use]
    pub fn key(&self) -> &'static str {
        match self {
            Self::NotApplicable { .. } | Self::Unknown { .. } => "fabrication.write",
            Self::Surface { .. } => "fabrication.scope",
            Self::OutlineCrosses { .. } => "fabrication.kerf_mm",
            Self::TooManyVoxels { .. } | Self::ImageTooLarge { .. } => "fabrication.printer",
        }
    }
}

impl From<FabricationError> for Error {
    fn from(error: FabricationError) -> Self {
        Self::Input(InputError::new(error.key(), "", error.to_string()))
    }
}
