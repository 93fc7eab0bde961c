//! Measured meridians, points or mesh, as smooth curves of the strip's length.

use super::axis::Axis;
use super::error::{Row, TargetError};
use super::ordering;
use super::profile::Profile;
use super::revolution::{self, RevolutionFit};
use super::scale::Span;
use super::smoothing::Sample;
use super::spline_curve::SplineMeridian;
use super::triangle_mesh::check_mesh;
use crate::progress::{Cancelled, never};

/// A meridian fitted to measured points, scaled and cut so that it runs from the rim to the hub.
///
/// ```
/// use voxelastica_core::target::{FittedMeridian, MeridianCurve};
///
/// // A quarter circle of radius 7.5 in any unit, 61 points from the rim to the axis.
/// let points: Vec<[f64; 2]> = (0..=60)
///     .map(|i| f64::to_radians(1.5 * i as f64))
///     .map(|q| [7.5 * q.cos(), 7.5 * q.sin()])
///     .collect();
/// let meridian = FittedMeridian::from_points(&points, 100.0, 10.0)?;
/// assert!((meridian.curve.length() - 100.0).abs() < 1e-9);
/// // The radius r in mm satisfies r cos(100 mm / r) = 10 mm: 69.997 mm.
/// let radius = 1.0 / meridian.curve.at(50.0).curvature.abs();
/// assert!((radius * (100.0 / radius).cos() - 10.0).abs() < 1e-4);
/// # Ok::<(), voxelastica_core::target::TargetError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct FittedMeridian {
    /// The meridian, from the rim to the hub radius.
    pub curve: SplineMeridian,
    /// What the source's lengths were multiplied by, mm a unit.
    pub scale: f64,
    /// Root mean square distance of the points between rim and cut from the curve, mm.
    pub residual_rms_mm: f64,
    /// Largest distance of one of them, mm.
    pub residual_max_mm: f64,
    /// Axis and roundness, for meshes.
    pub revolution: Option<RevolutionFit>,
    /// Number of points (of a mesh: vertices of its outer surface) the curve was fitted to.
    pub source_points: usize,
}

impl FittedMeridian {
    /// Fits points `[rho, z]` in any one unit, in the order of the curve, either end first.
    ///
    /// The end with the larger radius is the rim. The curve is scaled by the one factor for which its arc length from
    /// the rim to the radius `hub_radius_mm` is `length_mm`, both above 0; what lies inside the hub is cut off.
    ///
    /// # Errors
    ///
    /// Lengths out of range; a point that is not finite or has a negative radius; fewer than 5 different points; a curve
    /// that doubles back, crosses itself, or ends outside the hub radius.
    pub fn from_points(points: &[[f64; 2]], length_mm: f64, hub_radius_mm: f64) -> Result<Self, TargetError> {
        let span = Span::new(length_mm, hub_radius_mm)?;
        if points.len() > super::points::MAX_POINTS {
            return Err(TargetError::TooManyPoints { limit: super::points::MAX_POINTS });
        }
        let ordered = ordering::order(points, |i| Row::Point(i + 1))?;
        let samples = ordered
            .points
            .iter()
            .zip(&ordered.parameters)
            .map(|(&position, &t)| Sample { t, position, weight: 1.0 })
            .collect();
        Profile::fit(samples, 1, Some(span), &mut [])?.meridian(span)
    }

    /// Fits the outer meridian of a mesh in any one unit; `triangles` index `vertices`, counted from 0.
    ///
    /// Of a closed or thick dome only the outer surface counts; flat bases and lids end it. A mesh that is smooth and
    /// closed at both ends, an egg, is cut at its widest circle. Scale and cut are those of [`Self::from_points`].
    ///
    /// # Errors
    ///
    /// Lengths out of range; an empty mesh, coordinates that are not finite, indices out of range; an axis that cannot
    /// be found or points the wrong way; vertices more than 2 % of the rim radius (rms) off a surface of revolution;
    /// fewer than 5 rings; a meridian that ends outside the hub radius. Of more than half a million vertices on the outer
    /// surface as many, evenly chosen, are fitted and measured.
    pub fn from_mesh(
        vertices: &[[f64; 3]],
        triangles: &[[u32; 3]],
        axis: Axis,
        length_mm: f64,
        hub_radius_mm: f64,
    ) -> Result<Self, TargetError> {
        Self::from_mesh_unless(vertices, triangles, axis, length_mm, hub_radius_mm, &never)
    }

    /// As [`Self::from_mesh`], but gives up once `cancelled` says so: millions of triangles take seconds.
    ///
    /// # Errors
    ///
    /// Those of [`Self::from_mesh`], and [`TargetError::Cancelled`].
    pub fn from_mesh_unless(
        vertices: &[[f64; 3]],
        triangles: &[[u32; 3]],
        axis: Axis,
        length_mm: f64,
        hub_radius_mm: f64,
        cancelled: Cancelled<'_>,
    ) -> Result<Self, TargetError> {
        let span = Span::new(length_mm, hub_radius_mm)?;
        check_mesh(vertices, triangles, cancelled)?;
        revolution::meridian(vertices, triangles, axis, span, cancelled)
    }
}
