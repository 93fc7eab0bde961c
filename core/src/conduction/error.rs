//! What can keep conduction from being solved.

use crate::error::Error;
use crate::input::InputError;

/// Why heat or current could not be solved.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ConductionError {
    /// A property that the problem needs is neither given nor in the library.
    #[error("material \"{material}\" has no {property}; give {key} in a [[materials.custom]] table of that name")]
    MissingProperty {
        /// Name of the material.
        material: String,
        /// What is missing.
        property: &'static str,
        /// Key of a custom material that would supply it.
        key: &'static str,
    },
    /// A brick whose Jacobian is not positive.
    #[error(
        "the brick at {at_mm:?} mm is turned inside out; the strip is too thick for its curvature there, or the nodes are \
         in the wrong order"
    )]
    Inverted {
        /// Its first node.
        at_mm: [f64; 3],
    },
    /// Arrays of a mesh whose lengths do not fit.
    #[error("{what}: {found} given, {expected} needed")]
    Size {
        /// Which array.
        what: &'static str,
        /// Its length.
        found: usize,
        /// The length it should have.
        expected: usize,
    },
    /// A number that is out of range.
    #[error("{what} is {value}, but must be {range}")]
    Range {
        /// The quantity.
        what: &'static str,
        /// Its value.
        value: f64,
        /// What it may be.
        range: &'static str,
    },
    /// A part of the mesh that no boundary condition holds.
    #[error(
        "{voxels} voxel(s) around slice {slice}, layer {layer}, voxel {across} across (from 1) conduct but touch nothing whose \
         {quantity} is given, so theirs is undetermined; connect them, make them void, or solve the transient"
    )]
    Isolated {
        /// Number of voxels of the part.
        voxels: usize,
        /// Slice of its first voxel, from one.
        slice: usize,
        /// Its layer, from one.
        layer: usize,
        /// Its place across, from one.
        across: usize,
        /// Temperature or potential.
        quantity: &'static str,
    },
    /// Nothing conducts from one end to the other.
    #[error("no voxel conducts between the rim and the far end; the {quantity} would have no limit")]
    NoPath {
        /// Temperature or potential.
        quantity: &'static str,
    },
    /// Conductivities in more than two groups that are too far apart.
    #[error(
        "the conductivities {least:e} to {most:e} fall into more than two groups that differ by more than {limit:e}, which double \
         precision cannot solve together; leave out a phase, or let the smallest conductivity be larger"
    )]
    Contrast {
        /// Smallest conductivity.
        least: f64,
        /// Largest.
        most: f64,
        /// Largest contrast within a group.
        limit: f64,
    },
    /// More memory than there is.
    #[error(
        "{nodes} nodes need about {needed_mb} MB, but {limit_mb} MB are free; use larger voxels (voxels.size_mm), or raise the \
         limit"
    )]
    Memory {
        /// Nodes of the mesh.
        nodes: u64,
        /// Estimate.
        needed_mb: u64,
        /// What may be used.
        limit_mb: u64,
    },
    /// The iteration did not get to its tolerance.
    #[error(
        "{stage}: conjugate gradients reached a residual of {residual:.1e} in {iterations} iterations (tolerance {tolerance:.1e}), \
         conductivities {least:e} to {most:e}; phases of less contrast would help"
    )]
    NotConverged {
        /// What was solved.
        stage: &'static str,
        /// Iterations spent.
        iterations: usize,
        /// Residual relative to the loads.
        residual: f64,
        /// Wanted.
        tolerance: f64,
        /// Smallest conductivity.
        least: f64,
        /// Largest.
        most: f64,
    },
    /// What goes in does not come out.
    #[error(
        "the flux through cross-section {plane} differs by {share:.1e} of itself from that at the rim, more than {limit:.1e}; the \
         solution is not to be trusted"
    )]
    Unbalanced {
        /// Plane of nodes, from the rim.
        plane: usize,
        /// Relative difference.
        share: f64,
        /// Limit.
        limit: f64,
    },
    /// Time steps became too small.
    #[error("at t = {time_s:e} s the time step fell to {step_s:e} s without reaching the tolerance of {tolerance:e}")]
    StepTooSmall {
        /// Time reached.
        time_s: f64,
        /// Step.
        step_s: f64,
        /// Relative tolerance.
        tolerance: f64,
    },
    /// The shape that the strip takes is not known.
    #[error("there is no final shape: {reason}; use the flat strip")]
    NoShape {
        /// Why.
        reason: String,
    },
    /// The user cancelled.
    #[error("cancelled")]
    Cancelled,
}

impl From<ConductionError> for Error {
    fn from(error: ConductionError) -> Self {
        use ConductionError as E;
        let input = |key: &str, error: ConductionError| Self::Input(InputError::new(key, "", error.to_string()));
        match error {
            E::MissingProperty { .. } | E::Contrast { .. } => input("materials.phases", error),
            E::Isolated { .. } | E::NoPath { .. } | E::Memory { .. } => input("voxels", error),
            E::Size { .. } | E::Range { .. } | E::NoShape { .. } => input("conduction", error),
            E::Inverted { .. } | E::NotConverged { .. } | E::Unbalanced { .. } | E::StepTooSmall { .. } => {
                Self::Solver(error.to_string())
            }
            E::Cancelled => Self::Cancelled,
        }
    }
}
