//! Pictures of sweeps: a figure over a key or over another figure.

use super::ReportError;
use super::chart::{Axis, Chart, Layer, bounds};
use super::conduction::{SERIES, framed};
use super::figures::WIDTH;
use super::palette::Colour;
use super::svg::Stroke;

/// Ratio of largest to smallest value from which a logarithmic axis is one.
const DECADES: f64 = 100.0;

/// A figure of many designs.
#[derive(Debug, Clone, PartialEq)]
pub struct SweepPicture {
    /// Title.
    pub title: String,
    /// Names of the axes, with units.
    pub axes: [String; 2],
    /// Curves or clouds of points; those of one name have one colour.
    pub curves: Vec<SweepCurve>,
    /// Whether the points of a curve are joined.
    pub lines: bool,
    /// Decimal logarithms where values span two decades or more.
    pub logarithmic: bool,
    /// Sentences below.
    pub caption: Vec<String>,
}

/// Points that belong together.
#[derive(Debug, Clone, PartialEq)]
pub struct SweepCurve {
    /// Name in the legend; may be empty.
    pub name: String,
    /// Points.
    pub points: Vec<[f64; 2]>,
}

/// The picture as an SVG file of its own.
///
/// # Errors
/// [`ReportError`].
pub fn sweep_svg(picture: &SweepPicture) -> Result<String, ReportError> {
    // Less than two decades are easier to read without logarithms.
    let logarithmic = [0, 1].map(|k| {
        let values = || picture.curves.iter().flat_map(|c| c.points.iter().map(move |p| p[k]));
        let (low, high) = (values().fold(f64::INFINITY, f64::min), values().fold(0.0, f64::max));
        picture.logarithmic && high / low >= DECADES
    });
    let drawn =
        |p: &[f64; 2]| -> [f64; 2] { std::array::from_fn(|k| if logarithmic[k] { p[k].log10() } else { p[k] }) };
    let all = || picture.curves.iter().flat_map(|c| c.points.iter().map(drawn));
    let mut names: Vec<&str> = Vec::new();
    for curve in &picture.curves {
        if !names.contains(&curve.name.as_str()) {
            names.push(&curve.name);
        }
    }
    let colour = |name: &str| -> Colour {
        let place = names.iter().position(|n| *n == name).unwrap_or(0);
        SERIES[place % SERIES.len()]
    };
    let mut layers = Vec::new();
    let many = picture.curves.iter().map(|c| c.points.len()).sum::<usize>() > 400;
    for curve in &picture.curves {
        let points: Vec<[f64; 2]> = curve.points.iter().map(drawn).collect();
        if picture.lines && points.len() > 1 {
            layers.push(Layer::Line(points.clone(), Stroke::solid(colour(&curve.name), 1.6)));
        }
        if !picture.lines || points.len() <= 60 {
            layers.push(Layer::Dots(points, if many { 1.6 } else { 2.6 }, colour(&curve.name)));
        }
    }
    let axis = |k: usize, margin: f64| {
        let range = bounds(all().map(|p| p[k]), margin);
        Axis { decades: logarithmic[k], ..Axis::new(&picture.axes[k], range, 8) }
    };
    let chart = Chart { figure: "sweep", size: [WIDTH, 380.0], x: axis(0, 0.02), y: axis(1, 0.05), layers };
    let legend = names.iter().filter(|n| !n.is_empty()).map(|n| (colour(n), *n)).collect();
    framed(&picture.title, legend, &chart, &picture.caption)
}
