//! The meridian of a design's target, whatever kind it is.

use std::sync::Arc;

use super::{EllipseMeridian, FittedMeridian, MeridianCurve, MeridianPoint, PolynomialMeridian, TargetError};
use crate::design::STATIONS;
use crate::error::Error;
use crate::input::{DesignInput, TargetInput};

/// A target meridian, ready for the inverse problem.
#[derive(Debug, Clone)]
pub struct Target {
    /// The curve.
    pub curve: Arc<dyn MeridianCurve>,
    /// Its states at the design's stations.
    pub stations: Vec<MeridianPoint>,
    /// How well a fitted meridian agrees with its points; absent for closed forms.
    pub fit: Option<FitReport>,
}

/// How well a smooth meridian agrees with the points it was fitted to.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct FitReport {
    /// Factor from the points' unit to mm.
    pub scale: f64,
    /// Root mean square distance of the points, mm.
    pub residual_rms_mm: f64,
    /// Largest distance of a point, mm.
    pub residual_max_mm: f64,
}

/// The meridian of a design's target; `None` for a rectangular strip.
///
/// # Errors
/// [`Error::Input`] naming the key for a target that cannot be used.
pub fn resolve(input: &DesignInput) -> Result<Option<Target>, Error> {
    let length = input.strips.length_mm;
    let (curve, fit): (Arc<dyn MeridianCurve>, Option<FitReport>) = match &input.target {
        TargetInput::Strip { .. } => return Ok(None),
        TargetInput::HemiEllipsoid { aspect_ratio } => (
            Arc::new(
                EllipseMeridian::new(*aspect_ratio, length)
                    .map_err(|error| Error::target("target.aspect_ratio", aspect_ratio, &error))?,
            ),
            None,
        ),
        TargetInput::InclinationPolynomial { coefficients_deg } => (
            Arc::new(
                PolynomialMeridian::new(coefficients_deg, length)
                    .map_err(|error| Error::target("target.coefficients_deg", "", &error))?,
            ),
            None,
        ),
        TargetInput::Points { meridian, .. } => {
            let fitted = fit(input, meridian)?;
            let report = FitReport {
                scale: fitted.scale,
                residual_rms_mm: fitted.residual_rms_mm,
                residual_max_mm: fitted.residual_max_mm,
            };
            (Arc::new(fitted.curve), Some(report))
        }
        TargetInput::Mesh { meridian, revolution, .. } => {
            let report = revolution.as_ref().map(|r| FitReport {
                scale: r.scale,
                residual_rms_mm: r.residual_rms_mm,
                residual_max_mm: r.residual_max_mm,
            });
            (Arc::new(fit(input, meridian)?.curve), report)
        }
    };
    let stations = curve.stations(STATIONS);
    Ok(Some(Target { curve, stations, fit }))
}

/// The smooth curve through the points of a target.
fn fit(input: &DesignInput, meridian: &[[f64; 2]]) -> Result<FittedMeridian, Error> {
    FittedMeridian::from_points(meridian, input.strips.length_mm, input.hub_radius()).map_err(|error| {
        let key = if matches!(error, TargetError::EndsOutsideHub { .. }) { "strips.hub_radius_mm" } else { "target" };
        let value = if key == "target" { String::new() } else { input.hub_radius().to_string() };
        Error::target(key, value, &error)
    })
}
