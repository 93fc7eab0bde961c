//! Charts with axes: plotters draws them, this sets their looks.

use plotters::chart::ChartBuilder;
use plotters::element::{Circle, PathElement, Polygon};
use plotters::prelude::{DashedLineSeries, IntoDrawingArea, SVGBackend};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color, FontFamily, FontStyle, IntoFont, RGBAColor, RGBColor, ShapeStyle, TextStyle};

use super::ReportError;
use super::palette::{AXIS, Colour, GRID, INK, MUTED};
use super::svg::{Stroke, Svg};
use super::text::{number, power_of_ten};

/// Plotters rounds to whole pixels: charts are drawn so many times larger and scaled back.
const FINE: f64 = 20.0;
/// Space left of the plotting area for labels.
pub const LEFT: f64 = 72.0;
/// Part of it that stays empty: letters reach a little beyond where they are placed.
const EDGE: f64 = 3.0;
/// Space right of it.
pub const RIGHT: f64 = 28.0;
/// Space above it.
pub const TOP: f64 = 10.0;
/// Space below it for labels.
pub const BOTTOM: f64 = 44.0;
/// The same for an axis without description.
const BARE_BOTTOM: f64 = 26.0;
/// Font size of labels.
const LABEL: f64 = 12.0;

/// One axis of a chart.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// Quantity and unit.
    pub description: String,
    /// From left to right, or from bottom to top.
    pub range: [f64; 2],
    /// About how many values are labelled, at most.
    pub labels: usize,
    /// Whether both directions count from the middle: labels have no sign.
    pub both_ways: bool,
    /// Whether values are decimal logarithms: whole ones are labelled with their power of ten.
    pub decades: bool,
}

impl Axis {
    /// An axis that counts in one direction.
    #[must_use]
    pub fn new(description: &str, range: [f64; 2], labels: usize) -> Self {
        Self { description: description.to_owned(), range, labels, both_ways: false, decades: false }
    }

    /// Space for its labels below the plotting area.
    fn below(&self) -> f64 {
        if self.description.is_empty() { BARE_BOTTOM } else { BOTTOM }
    }
}

/// What is drawn into a chart, in this order.
#[derive(Debug, Clone, PartialEq)]
pub enum Layer {
    /// A line through points.
    Line(Vec<[f64; 2]>, Stroke),
    /// A filled polygon.
    Area(Vec<[f64; 2]>, Colour, f64),
    /// Filled circles of a radius in user units.
    Dots(Vec<[f64; 2]>, f64, Colour),
}

/// A chart of given outer size.
#[derive(Debug, Clone, PartialEq)]
pub struct Chart {
    /// Name of the figure, for errors.
    pub figure: &'static str,
    /// Outer width and height, user units.
    pub size: [f64; 2],
    /// Horizontal axis.
    pub x: Axis,
    /// Vertical axis.
    pub y: Axis,
    /// What is drawn, from back to front.
    pub layers: Vec<Layer>,
}

impl Chart {
    /// Draws the chart.
    ///
    /// # Errors
    /// [`ReportError::NotFinite`] for ranges and points that are not numbers, [`ReportError::Chart`] where plotters fails.
    pub fn draw(&self) -> Result<Svg, ReportError> {
        self.check()?;
        let mut buffer = String::new();
        self.plot(&mut buffer)
            .map_err(|error| ReportError::Chart { figure: self.figure, problem: error.to_string() })?;
        let mut svg = Svg::new(self.size[0], self.size[1]);
        svg.raw(&format!("<g transform=\"scale({})\" stroke-linejoin=\"round\">", 1.0 / FINE));
        svg.raw(inside_root(&buffer));
        svg.raw("</g>");
        Ok(svg)
    }

    fn check(&self) -> Result<(), ReportError> {
        let bad = |v: &f64| !v.is_finite();
        let wrong = |quantity: &str, value: f64| {
            Err(ReportError::NotFinite { figure: self.figure, quantity: quantity.to_owned(), value })
        };
        for axis in [&self.x, &self.y] {
            if let Some(value) = axis.range.iter().copied().find(bad) {
                return wrong(&axis.description, value);
            }
        }
        for layer in &self.layers {
            let (Layer::Line(points, _) | Layer::Area(points, ..) | Layer::Dots(points, ..)) = layer;
            for point in points {
                for (value, axis) in point.iter().zip([&self.x, &self.y]) {
                    if bad(value) {
                        return wrong(&axis.description, *value);
                    }
                }
            }
        }
        Ok(())
    }

    fn plot(&self, buffer: &mut String) -> Result<(), Box<dyn std::error::Error + '_>> {
        let size = self.size.map(|s| fine(s).max(1));
        let root = SVGBackend::with_string(buffer, (size[0], size[1])).into_drawing_area();
        let ([x0, x1], [y0, y1]) = (separated(self.x.range), separated(self.y.range));
        let mut chart = ChartBuilder::on(&root)
            .margin_top(fine(TOP))
            .margin_right(fine(RIGHT))
            .margin_left(fine(EDGE))
            .x_label_area_size(fine(self.x.below()))
            .y_label_area_size(fine(LEFT - EDGE))
            .build_cartesian_2d(x0..x1, y0..y1)
            .map_err(|e| e.to_string())?;
        let label = text_style(LABEL, MUTED);
        chart
            .configure_mesh()
            .x_labels(self.x.labels)
            .y_labels(self.y.labels)
            .x_label_formatter(&|v| tick(if self.x.both_ways { v.abs() } else { *v }, [x0, x1]))
            .y_label_formatter(&|v| if self.y.decades { decade(*v) } else { tick(*v, [y0, y1]) })
            .x_desc(self.x.description.as_str())
            .y_desc(self.y.description.as_str())
            .axis_style(style(&Stroke::solid(AXIS, 1.0)))
            .bold_line_style(style(&Stroke::solid(GRID, 1.0)))
            .light_line_style(RGBAColor(0, 0, 0, 0.0))
            .set_all_tick_mark_size(fine(4.0))
            .label_style(label)
            .axis_desc_style(text_style(LABEL, INK))
            .draw()
            .map_err(|e| e.to_string())?;
        for layer in &self.layers {
            match layer {
                Layer::Line(points, stroke) => {
                    let points: Vec<(f64, f64)> = points.iter().map(|[x, y]| (*x, *y)).collect();
                    match stroke.dash {
                        Some([dash, gap]) => chart
                            .draw_series(DashedLineSeries::new(points, fine(dash), fine(gap), style(stroke)))
                            .map(|_| ()),
                        None => chart.draw_series([PathElement::new(points, style(stroke))]).map(|_| ()),
                    }
                }
                Layer::Area(points, colour, opacity) => {
                    let points: Vec<(f64, f64)> = points.iter().map(|[x, y]| (*x, *y)).collect();
                    chart.draw_series([Polygon::new(points, rgb(*colour).mix(*opacity).filled())]).map(|_| ())
                }
                Layer::Dots(points, radius, colour) => {
                    let dot = |p: &[f64; 2]| Circle::new((p[0], p[1]), fine(*radius), rgb(*colour).filled());
                    chart.draw_series(points.iter().map(dot)).map(|_| ())
                }
            }
            .map_err(|e| e.to_string())?;
        }
        drop(chart);
        root.present().map_err(|e| e.to_string())?;
        Ok(())
    }
}

/// Ranges and height of a chart of given width whose axes have one scale.
///
/// The plotting area is at most `most` high (then the horizontal range is widened about its middle) and at least `least`
/// (then the vertical range is extended upwards).
#[must_use]
pub fn equal_aspect(x: [f64; 2], y: [f64; 2], width: f64, [least, most]: [f64; 2]) -> ([f64; 2], [f64; 2], f64) {
    let across = width - LEFT - RIGHT;
    let ([x0, x1], [y0, y1]) = (separated(x), separated(y));
    let high = across * (y1 - y0) / (x1 - x0);
    let chart_height = |plot: f64| plot + TOP + BOTTOM;
    if high > most {
        let half = 0.5 * (y1 - y0) * across / most;
        let middle = 0.5 * (x0 + x1);
        ([middle - half, middle + half], [y0, y1], chart_height(most))
    } else if high < least {
        ([x0, x1], [y0, y0 + (x1 - x0) * least / across], chart_height(least))
    } else {
        ([x0, x1], [y0, y1], chart_height(high))
    }
}

/// Smallest and largest of some values, widened by a share of their difference at both ends.
#[must_use]
pub fn bounds(values: impl IntoIterator<Item = f64>, margin: f64) -> [f64; 2] {
    let (low, high) = values
        .into_iter()
        .filter(|v| v.is_finite())
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
    if low > high {
        return [0.0, 1.0];
    }
    let extra = margin * (high - low);
    separated([low - extra, high + extra])
}

/// At most so many of the points, first and last included.
#[must_use]
pub fn thinned(points: Vec<[f64; 2]>, most: usize) -> Vec<[f64; 2]> {
    if points.len() <= most || most < 2 {
        return points;
    }
    let last = points.len() - 1;
    (0..most).map(|i| points[i * last / (most - 1)]).collect()
}

/// A range wide enough for ticks to differ in double precision.
fn separated([from, to]: [f64; 2]) -> [f64; 2] {
    let least = (1e-6 * from.abs().max(to.abs())).max(1e-9);
    if to - from >= least { [from, to] } else { [from - least, to + least] }
}

/// A tick's label: as many digits as tell neighbours apart.
fn tick(value: f64, [from, to]: [f64; 2]) -> String {
    let span = to - from;
    if value.abs() < 1e-9 * span {
        return "0".to_owned();
    }
    let needed = (value.abs() / span).log10().ceil().max(0.0) as usize + 3;
    number(value, needed.min(9))
}

/// The label of a whole logarithm.
fn decade(value: f64) -> String {
    if (value - value.round()).abs() > 1e-6 { String::new() } else { power_of_ten(value.round() as i32) }
}

fn fine(length: f64) -> u32 {
    (length * FINE).round().clamp(0.0, 1e6) as u32
}

fn rgb(Colour([r, g, b]): Colour) -> RGBColor {
    RGBColor(r, g, b)
}

fn style(stroke: &Stroke) -> ShapeStyle {
    ShapeStyle { color: rgb(stroke.colour).mix(stroke.opacity), filled: false, stroke_width: fine(stroke.width) }
}

fn text_style(size: f64, colour: Colour) -> TextStyle<'static> {
    // Plotters writes size / 1.24 into the file.
    let font = (FontFamily::SansSerif, size * FINE * 1.24, FontStyle::Normal).into_font();
    font.color(&rgb(colour)).pos(Pos::new(HPos::Center, VPos::Center))
}

/// What stands inside the root element that plotters writes.
fn inside_root(document: &str) -> &str {
    let start = document.find('>').map_or(0, |i| i + 1);
    let end = document.rfind("</svg>").unwrap_or(document.len());
    document.get(start..end).unwrap_or_default().trim()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chart(points: Vec<[f64; 2]>) -> Chart {
        Chart {
            figure: "test",
            size: [400.0, 200.0],
            x: Axis::new("x, mm", [0.0, 1.0], 5),
            y: Axis::new("y", [0.0, 1.0], 5),
            layers: vec![Layer::Line(points, Stroke::solid(INK, 1.0))],
        }
    }

    #[test]
    fn what_is_not_a_number_is_an_error_and_no_picture() {
        let error = chart(vec![[0.0, 0.0], [0.5, f64::NAN]]).draw().unwrap_err();
        assert!(matches!(error, ReportError::NotFinite { figure: "test", .. }), "{error}");
        let mut broken = chart(Vec::new());
        broken.x.range[1] = f64::INFINITY;
        assert!(broken.draw().is_err());
    }

    #[test]
    fn degenerate_ranges_end_and_are_drawn() {
        for range in [[0.0, 0.0], [1e12, 1e12], [1e-30, 2e-30], [-1e-300, 0.0], [5.0, 1.0], [-1e15, 1e15]] {
            let mut flat = chart(vec![[range[0], range[0]], [range[1], range[1]]]);
            flat.x.range = range;
            flat.y.range = range;
            flat.draw().unwrap();
        }
    }

    #[test]
    fn equal_aspect_has_one_scale() {
        for (x, y) in [([0.0, 10.0], [0.0, 3.0]), ([0.0, 10.0], [0.0, 0.001]), ([0.0, 1.0], [-5.0, 30.0])] {
            let (wide, tall, height) = equal_aspect(x, y, 800.0, [100.0, 400.0]);
            let across = (800.0 - LEFT - RIGHT) / (wide[1] - wide[0]);
            let up = (height - TOP - BOTTOM) / (tall[1] - tall[0]);
            assert!((across / up - 1.0).abs() < 1e-9);
            assert!(wide[0] <= x[0] && wide[1] >= x[1] && tall[0] <= y[0] && tall[1] >= y[1]);
        }
    }

    #[test]
    fn whole_logarithms_are_powers_of_ten() {
        assert_eq!((decade(-23.0), decade(0.5)), ("10⁻²³".to_owned(), String::new()));
    }

    #[test]
    fn ticks_tell_neighbours_apart() {
        assert_eq!(tick(1000.25, [1000.0, 1001.0]), "1000.25");
        assert_eq!(tick(-40.0, [-50.0, 50.0]), "−40");
        assert_eq!(tick(1e-17, [0.0, 1.0]), "0");
    }
}
