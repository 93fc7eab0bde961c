//! Axis and roundness of a mesh.

/// The axis of a mesh and how far the mesh is from a surface of revolution about it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RevolutionFit {
    /// Unit vector along the axis, from rim to apex.
    pub axis_direction: [f64; 3],
    /// A point of the axis, in the mesh's unit: the centre of the rim.
    pub axis_point: [f64; 3],
    /// Root mean square distance of the vertices of the outer surface from the fitted surface of revolution, as a share
    /// of the rim radius.
    pub rms_share: f64,
}
