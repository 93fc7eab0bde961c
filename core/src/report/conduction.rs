//! Pictures of conduction: fields seen from above, their history, and the chart of modulus against conductivity.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

use super::ReportError;
use super::chart::{Axis, Chart, LEFT, Layer, RIGHT, bounds, thinned};
use super::figures::WIDTH;
use super::palette::{Colour, GRID, INK, MEASURED, MUTED, PREDICTED, THRUST, ramp};
use super::svg::{Anchor, Stroke, Svg};
use super::text::number;

/// Room for title and panel headings.
const HEAD: f64 = 48.0;
const HEADING: f64 = 24.0;
const FOOT: f64 = 40.0;
/// Width of a colour bar and room for its labels.
const BAR: [f64; 2] = [14.0, 96.0];
const LINE: f64 = 16.0;
/// Most characters of a line of a caption.
const LETTERS: usize = 118;
/// Points of a curve.
const MOST_POINTS: usize = 1201;
/// Largest side of a picture in pixels; cells beyond are left out evenly.
const MOST_PIXELS: usize = 2400;

/// Lines that can be told apart with every kind of colour vision.
pub(super) const SERIES: [Colour; 8] = [
    PREDICTED,
    MEASURED,
    Colour([0x00, 0x8a, 0x6e]),
    THRUST,
    Colour([0xd9, 0x9a, 0x00]),
    Colour([0x56, 0xa5, 0xd8]),
    Colour([0x5b, 0x67, 0x78]),
    Colour([0x7a, 0x4b, 0x1e]),
];

/// One field from above.
#[derive(Debug, Clone, PartialEq)]
pub struct FieldPanel {
    /// What it shows.
    pub heading: String,
    /// Values of cells, along the strip and across (the last fastest, from the most negative y); NaN where there is none.
    pub values: Vec<f64>,
    /// Ends of the colour scale.
    pub range: [f64; 2],
}

/// Fields of one strip.
#[derive(Debug, Clone, PartialEq)]
pub struct FieldPicture {
    /// Title.
    pub title: String,
    /// Unit of the values.
    pub unit: String,
    /// Cells along and across.
    pub cells: [usize; 2],
    /// Length and width, mm.
    pub size_mm: [f64; 2],
    /// Panels, one below the other.
    pub panels: Vec<FieldPanel>,
    /// Sentences below.
    pub caption: Vec<String>,
}

/// The fields as an SVG file of its own.
///
/// # Errors
/// [`ReportError::Chart`] where the cells' picture cannot be encoded.
pub fn field_svg(picture: &FieldPicture) -> Result<String, ReportError> {
    let [length, width] = picture.size_mm;
    let room = WIDTH - 12.0 - BAR[1] - 24.0;
    // One scale for both directions, unless the strip is too slender to be seen.
    let scale = (room / length).min(320.0 / width);
    let (wide, high) = (scale * length, (scale * width).max(12.0));
    let step = HEADING + high + 22.0;
    let caption = wrapped(&picture.caption);
    let height = HEAD + step * picture.panels.len() as f64 + FOOT + LINE * caption.len() as f64;
    let mut svg = Svg::new(WIDTH, height);
    svg.text([12.0, 26.0], Anchor::Start, 16.0, INK, &picture.title);
    for (k, panel) in picture.panels.iter().enumerate() {
        let top = HEAD + k as f64 * step;
        svg.text([12.0, top + 14.0], Anchor::Start, 12.5, INK, &panel.heading);
        let image = image(picture.cells, panel).map_err(|problem| ReportError::Chart { figure: "field", problem })?;
        svg.raw(&format!(
            "<image x=\"12\" y=\"{:.2}\" width=\"{wide:.2}\" height=\"{high:.2}\" preserveAspectRatio=\"none\" \
             style=\"image-rendering:pixelated\" href=\"data:image/png;base64,{}\"/>",
            top + HEADING,
            STANDARD.encode(image)
        ));
        colour_bar(&mut svg, [wide + 30.0, top + HEADING], high, panel.range, &picture.unit);
    }
    let below = HEAD + step * picture.panels.len() as f64;
    svg.text([12.0, below + 4.0], Anchor::Start, 12.0, MUTED, "rim");
    let far = format!("far end, {} mm", number(length, 4));
    svg.text([12.0 + wide, below + 4.0], Anchor::End, 12.0, MUTED, &far);
    write_lines(&mut svg, [12.0, below + 30.0], &caption);
    Ok(svg.standalone(&picture.title))
}

/// A picture of one pixel a cell, cold or low values dark.
fn image([along, across]: [usize; 2], panel: &FieldPanel) -> Result<Vec<u8>, String> {
    let every = along.max(across).div_ceil(MOST_PIXELS).max(1);
    let (wide, high) = (along.div_ceil(every), across.div_ceil(every));
    let [low, top] = panel.range;
    let span = if top > low { top - low } else { 1.0 };
    let mut pixels = Vec::with_capacity(4 * wide * high);
    for row in 0..high {
        for column in 0..wide {
            let j = across - 1 - (row * every).min(across - 1);
            let value = panel.values.get(column * every * across + j).copied().unwrap_or(f64::NAN);
            if value.is_finite() {
                pixels.extend(ramp(1.0 - (value - low) / span).0);
                pixels.push(255);
            } else {
                pixels.extend([255, 255, 255, 0]);
            }
        }
    }
    let mut bytes = Vec::new();
    let size = |n: usize| u32::try_from(n).map_err(|e| e.to_string());
    let mut encoder = png::Encoder::new(&mut bytes, size(wide)?, size(high)?);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    let mut writer = encoder.write_header().map_err(|e| e.to_string())?;
    writer.write_image_data(&pixels).map_err(|e| e.to_string())?;
    writer.finish().map_err(|e| e.to_string())?;
    Ok(bytes)
}

fn colour_bar(svg: &mut Svg, [x, y]: [f64; 2], high: f64, [low, top]: [f64; 2], unit: &str) {
    const STRIPES: u32 = 48;
    for i in 0..STRIPES {
        let share = f64::from(i) / f64::from(STRIPES - 1);
        let tall = high / f64::from(STRIPES);
        let at = y + high - f64::from(i + 1) * tall;
        let fill = format!("fill=\"{}\" shape-rendering=\"crispEdges\"", ramp(1.0 - share).hex());
        svg.rectangle([x, at], [BAR[0], tall + 0.3], &fill);
    }
    let marks: &[f64] = if high > 60.0 { &[0.0, 0.5, 1.0] } else { &[0.0, 1.0] };
    for share in marks {
        let value = number(low + share * (top - low), 4);
        let at = y + high * (1.0 - share) + 4.0 + if *share == 1.0 { 4.0 } else { 0.0 }
            - if *share == 0.0 { 2.0 } else { 0.0 };
        svg.text([x + BAR[0] + 5.0, at], Anchor::Start, 11.0, MUTED, &format!("{value} {unit}"));
    }
}

/// A curve of a history.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// What it is.
    pub name: String,
    /// Time in s and value.
    pub points: Vec<[f64; 2]>,
    /// Where it gets to the threshold.
    pub mark: Option<[f64; 2]>,
}

/// A history.
#[derive(Debug, Clone, PartialEq)]
pub struct HistoryPicture {
    /// Title.
    pub title: String,
    /// Quantity and unit.
    pub quantity: String,
    /// The curves.
    pub curves: Vec<Curve>,
    /// The threshold, where it lies in the range.
    pub threshold: Option<f64>,
    /// Sentences below.
    pub caption: Vec<String>,
}

/// The history as an SVG file of its own.
///
/// # Errors
/// [`ReportError`] for values that are not numbers.
pub fn history_svg(picture: &HistoryPicture) -> Result<String, ReportError> {
    let all = || picture.curves.iter().flat_map(|c| &c.points);
    let end = all().map(|p| p[0]).fold(0.0, f64::max);
    let y = bounds(all().map(|p| p[1]).chain(picture.threshold), 0.05);
    let mut layers = Vec::new();
    if let Some(threshold) = picture.threshold {
        layers.push(Layer::Line(vec![[0.0, threshold], [end, threshold]], Stroke::dashed(MUTED, 1.2, [5.0, 4.0])));
    }
    for (k, curve) in picture.curves.iter().enumerate() {
        let colour = SERIES[k % SERIES.len()];
        layers.push(Layer::Line(thinned(curve.points.clone(), MOST_POINTS), Stroke::solid(colour, 1.8)));
        if let Some(mark) = curve.mark {
            layers.push(Layer::Dots(vec![mark], 4.0, colour));
        }
    }
    let chart = Chart {
        figure: "history",
        size: [WIDTH, 360.0],
        x: Axis::new("time, s", [0.0, end], 9),
        y: Axis::new(&picture.quantity, y, 7),
        layers,
    };
    let entries = picture.curves.iter().enumerate().map(|(k, c)| (SERIES[k % SERIES.len()], c.name.as_str()));
    framed(&picture.title, entries.collect(), &chart, &picture.caption)
}

/// A chart with a title, a legend in columns and a caption.
pub(super) fn framed(
    title: &str,
    legend: Vec<(Colour, &str)>,
    chart: &Chart,
    caption: &[String],
) -> Result<String, ReportError> {
    const COLUMNS: usize = 3;
    let caption = wrapped(caption);
    let rows = legend.len().div_ceil(COLUMNS);
    let top = HEAD + 20.0 * rows as f64;
    let mut svg = Svg::new(WIDTH, top + chart.size[1] + 18.0 + LINE * caption.len() as f64);
    svg.text([LEFT, 26.0], Anchor::Start, 16.0, INK, title);
    let column = (WIDTH - LEFT - RIGHT) / COLUMNS as f64;
    for (k, (colour, name)) in legend.into_iter().enumerate() {
        let at = [LEFT + (k % COLUMNS) as f64 * column, HEAD + 20.0 * (k / COLUMNS) as f64];
        svg.circle([at[0] + 5.0, at[1]], 4.5, &format!("fill=\"{}\"", colour.hex()));
        svg.text([at[0] + 16.0, at[1] + 4.0], Anchor::Start, 12.0, INK, name);
    }
    svg.place([0.0, top], &chart.draw()?);
    write_lines(&mut svg, [LEFT, top + chart.size[1] + 16.0], &caption);
    Ok(svg.standalone(title))
}

/// A set of points in the chart of modulus against conductivity.
#[derive(Debug, Clone, PartialEq)]
pub struct Cloud {
    /// What it is.
    pub name: String,
    /// Modulus in MPa and conductivity.
    pub points: Vec<[f64; 2]>,
    /// Radius of the dots.
    pub radius: f64,
}

/// The chart of modulus against conductivity.
#[derive(Debug, Clone, PartialEq)]
pub struct AshbyPicture {
    /// Title.
    pub title: String,
    /// Conductivity and unit.
    pub quantity: String,
    /// Phases and mixtures.
    pub clouds: Vec<Cloud>,
    /// Upper and lower bounds by fraction: outer and isotropic ones, as closed outlines.
    pub outlines: [Vec<[f64; 2]>; 2],
    /// Sentences below.
    pub caption: Vec<String>,
}

/// Ratio of largest to smallest conductivity from which their axis is logarithmic.
const DECADES: f64 = 100.0;

/// The chart as an SVG file of its own.
///
/// # Errors
/// [`ReportError`] for values that are not numbers.
pub fn ashby_svg(picture: &AshbyPicture) -> Result<String, ReportError> {
    let all = || picture.clouds.iter().flat_map(|c| &c.points).chain(picture.outlines.iter().flatten());
    let (low, high) = all().fold((f64::INFINITY, 0.0_f64), |(l, h), p| (l.min(p[1]), h.max(p[1])));
    let decades = high / low > DECADES;
    let place = |p: &[f64; 2]| [p[0], if decades { p[1].log10() } else { p[1] }];
    let placed = |points: &[[f64; 2]]| points.iter().map(place).collect::<Vec<_>>();
    let x = bounds(all().map(|p| p[0]), 0.05);
    let y = bounds(all().map(|p| place(p)[1]), 0.05);
    let [outer, inner] = &picture.outlines;
    let mut layers =
        vec![Layer::Area(placed(outer), GRID, 1.0), Layer::Area(placed(inner), Colour([0xc9, 0xd6, 0xe6]), 1.0)];
    for (k, cloud) in picture.clouds.iter().enumerate() {
        layers.push(Layer::Dots(placed(&cloud.points), cloud.radius, SERIES[k % SERIES.len()]));
    }
    let chart = Chart {
        figure: "modulus against conductivity",
        size: [WIDTH, 460.0],
        x: Axis::new("Young’s modulus along the strip, MPa", x, 9),
        y: Axis { decades, ..Axis::new(&picture.quantity, y, 9) },
        layers,
    };
    let entries = picture.clouds.iter().enumerate().map(|(k, c)| (SERIES[k % SERIES.len()], c.name.as_str()));
    framed(&picture.title, entries.collect(), &chart, &picture.caption)
}

fn write_lines(svg: &mut Svg, [x, y]: [f64; 2], lines: &[String]) {
    for (n, line) in lines.iter().enumerate() {
        svg.text([x, y + LINE * n as f64], Anchor::Start, 11.5, MUTED, line);
    }
}

/// Sentences in lines of limited length, each sentence on lines of its own.
fn wrapped(sentences: &[String]) -> Vec<String> {
    let mut lines = Vec::new();
    for sentence in sentences {
        let mut line = String::new();
        for word in sentence.split_whitespace() {
            if !line.is_empty() && line.chars().count() + 1 + word.chars().count() > LETTERS {
                lines.push(std::mem::take(&mut line));
            }
            if !line.is_empty() {
                line.push(' ');
            }
            line.push_str(word);
        }
        if !line.is_empty() {
            lines.push(line);
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_are_well_formed_and_void_cells_are_clear() {
        let panel =
            FieldPanel { heading: "t < 1".to_owned(), values: vec![1.0, f64::NAN, 2.0, 3.0], range: [1.0, 3.0] };
        let picture = FieldPicture {
            title: "a & b".to_owned(),
            unit: "K".to_owned(),
            cells: [2, 2],
            size_mm: [4.0, 2.0],
            panels: vec![panel],
            caption: vec!["word ".repeat(60)],
        };
        let svg = field_svg(&picture).unwrap();
        assert!(svg.contains("a &amp; b") && svg.contains("t &lt; 1") && svg.contains("data:image/png;base64,"));
        let mut reader = quick_xml::Reader::from_str(&svg);
        while !matches!(reader.read_event().unwrap(), quick_xml::events::Event::Eof) {}
    }

    #[test]
    fn long_sentences_are_broken_between_words() {
        let lines = wrapped(&["word ".repeat(60), "short".to_owned()]);
        assert!(lines.len() == 4 && lines.iter().all(|l| l.chars().count() <= LETTERS));
        assert_eq!(lines[3], "short");
    }
}
