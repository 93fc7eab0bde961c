//! Widths that close the dome without gaps.

use std::f64::consts::PI;

use super::ElasticaError;

/// Full width of one of `count` spokes at radius `rho`: `w = 2 tan(pi/N) rho`, in the unit of `rho`.
///
/// Neighbouring spokes then share their edges in the morphed state, and at the hub they form a regular polygon whose
/// inscribed circle has the hub radius.
///
/// ```
/// # use voxelastica_core::elastica::tessellation::width;
/// assert!((width(8, 10.0) - 8.284_271_247).abs() < 1e-9);
/// ```
#[must_use]
pub fn width(count: usize, rho: f64) -> f64 {
    2.0 * (PI / count as f64).tan() * rho
}

/// Widths at all stations; `radii` holds `(s, rho)` in mm.
///
/// # Errors
/// [`ElasticaError::NoWidth`] at the first radius that is not positive.
pub fn widths(count: usize, radii: impl Iterator<Item = (f64, f64)>) -> Result<Vec<f64>, ElasticaError> {
    radii
        .map(|(at_mm, radius_mm)| {
            if radius_mm > 0.0 { Ok(width(count, radius_mm)) } else { Err(ElasticaError::NoWidth { radius_mm, at_mm }) }
        })
        .collect()
}
