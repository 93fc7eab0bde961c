//! Target meridians: the curve a spoke must take, as a function of arc length.

mod axis;
mod banded;
pub mod ellipse;
mod error;
mod fitted;
mod mesh_file;
mod ordering;
mod outline;
mod points;
pub mod polynomial;
mod profile;
mod resolve;
mod revolution;
mod scale;
mod smoothing;
mod spline_curve;
mod triangle_mesh;

pub use axis::Axis;
pub use ellipse::EllipseMeridian;
pub use error::{Row, TargetError};
pub use fitted::FittedMeridian;
pub use mesh_file::{MAX_MESH_BYTES, MeshFormat, read_mesh, read_mesh_file, read_mesh_file_unless, read_mesh_unless};
pub use points::{MAX_POINTS, MAX_POINTS_BYTES, PointTable, read_points, read_points_file};
pub use polynomial::PolynomialMeridian;
pub use resolve::{FitReport, Target, resolve};
pub use revolution::RevolutionFit;
pub use spline_curve::SplineMeridian;
pub use triangle_mesh::{MAX_TRIANGLES, MAX_VERTICES, TriangleMesh};

/// The state of a meridian at one arc length.
///
/// Arc length `s` runs from the rim (`s = 0`) to the hub (`s = L`). The inclination `theta` is the angle of the tangent
/// to the horizontal; `x` and `z` are the horizontal and vertical distance from the rim:
/// `x' = cos(theta)`, `z' = sin(theta)`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeridianPoint {
    /// Arc length from the rim, mm.
    pub s: f64,
    /// Inclination `theta`, rad, continuous along the strip (never wrapped).
    pub inclination: f64,
    /// Curvature `theta' = d theta / d s`, 1/mm.
    pub curvature: f64,
    /// Curvature gradient `theta'' = d^2 theta / d s^2`, 1/mm^2.
    pub curvature_gradient: f64,
    /// Horizontal distance from the rim, mm.
    pub x: f64,
    /// Height above the rim, mm.
    pub z: f64,
}

/// A target meridian that can be evaluated at any arc length.
pub trait MeridianCurve: std::fmt::Debug + Send + Sync {
    /// Arc length `L` from rim to hub, mm.
    fn length(&self) -> f64;

    /// The state at arc length `s`, which is clamped to `[0, L]`.
    fn at(&self, s: f64) -> MeridianPoint;

    /// The states at `count >= 2` evenly spaced stations, both ends included.
    ///
    /// Curves that integrate along the way override this with one sweep.
    fn stations(&self, count: usize) -> Vec<MeridianPoint> {
        let last = count.max(2) - 1;
        (0..=last).map(|i| self.at(self.length() * i as f64 / last as f64)).collect()
    }
}

/// Refuses lengths that are not positive and finite.
fn require_length(length_mm: f64) -> Result<(), TargetError> {
    if length_mm.is_finite() && length_mm > 0.0 {
        Ok(())
    } else {
        Err(TargetError::OutOfRange { name: "the length", value: length_mm, allowed: "positive and finite" })
    }
}
