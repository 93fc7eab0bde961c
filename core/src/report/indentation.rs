//! Force-displacement curves of pressed domes.

use super::ReportError;
use super::chart::{Axis, Chart, Layer, bounds};
use super::conduction::{SERIES, framed};
use super::figures::WIDTH;
use super::svg::Stroke;

/// Curves of one dome.
#[derive(Debug, Clone, PartialEq)]
pub struct IndentationPicture {
    /// Title.
    pub title: String,
    /// One a model and indenter.
    pub curves: Vec<IndentationCurve>,
    /// Sentences below.
    pub caption: Vec<String>,
}

/// One curve and its band.
#[derive(Debug, Clone, PartialEq)]
pub struct IndentationCurve {
    /// Name in the legend.
    pub name: String,
    /// Depth in mm and force in N.
    pub points: Vec<[f64; 2]>,
    /// Share by which the force may be off.
    pub band: f64,
}

/// The curves as an SVG file of its own.
///
/// # Errors
/// [`ReportError`].
pub fn indentation_svg(picture: &IndentationPicture) -> Result<String, ReportError> {
    let all = || picture.curves.iter().flat_map(|c| c.points.iter().map(move |p| (p, c.band)));
    let end = all().map(|(p, _)| p[0]).fold(0.0, f64::max);
    let y = bounds(all().map(|(p, band)| p[1] * (1.0 + band)).chain([0.0]), 0.05);
    let mut layers = Vec::new();
    for (k, curve) in picture.curves.iter().enumerate() {
        let edge = |factor: f64| curve.points.iter().map(move |[d, f]| [*d, f * factor]);
        let area: Vec<[f64; 2]> = edge(1.0 + curve.band).chain(edge(1.0 - curve.band).rev()).collect();
        if curve.band > 0.0 {
            layers.push(Layer::Area(area, SERIES[k % SERIES.len()], 0.12));
        }
    }
    for (k, curve) in picture.curves.iter().enumerate() {
        layers.push(Layer::Line(curve.points.clone(), Stroke::solid(SERIES[k % SERIES.len()], 1.8)));
    }
    let chart = Chart {
        figure: "indentation",
        size: [WIDTH, 380.0],
        x: Axis::new("depth D, mm", [0.0, end], 9),
        y: Axis::new("force F, N", [0.0, y[1]], 7),
        layers,
    };
    let entries = picture.curves.iter().enumerate().map(|(k, c)| (SERIES[k % SERIES.len()], c.name.as_str()));
    framed(&picture.title, entries.collect(), &chart, &picture.caption)
}
