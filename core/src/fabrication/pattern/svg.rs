//! A pattern as SVG: one unit is one millimetre.

use std::fmt::Write;

use super::polygon::Point;
use super::{Layer, Pattern};
use crate::output::Provenance;
use crate::output::tables::number;
use crate::report::escape;

/// Room around the drawing, mm.
const MARGIN: f64 = 5.0;
/// Width of lines: what cutters take for a cut, mm.
const HAIRLINE: f64 = 0.1;

/// The drawing. Layers are groups with their name as `id`.
#[must_use]
pub fn text(pattern: &Pattern, name: &str, provenance: &Provenance) -> String {
    let [low, high] = pattern.bounds();
    let below = pattern.labels.iter().map(|l| l.at[1] - l.height).fold(low[1], f64::min);
    let (left, top) = (low[0] - MARGIN, high[1] + MARGIN);
    let size = [high[0] + MARGIN - left, top - (below - MARGIN)].map(coordinate);
    let place = |[x, y]: Point| format!("{} {}", coordinate(x - left), coordinate(top - y));
    let mut svg = String::new();
    let _ = writeln!(svg, "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<!-- {} -->", provenance.line());
    let _ = writeln!(
        svg,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}mm\" height=\"{1}mm\" viewBox=\"0 0 {0} {1}\">\n<title>{2}</title>",
        size[0],
        size[1],
        escape(name)
    );
    for layer in Layer::ALL {
        let style = match layer {
            Layer::Labels => "fill=\"#008000\" font-family=\"sans-serif\" text-anchor=\"middle\"".to_owned(),
            Layer::Outline => stroke("#ff0000"),
            Layer::Hub => stroke("#ff00ff"),
            Layer::Marks => stroke("#0000ff"),
        };
        let _ = writeln!(svg, "<g id=\"{}\" {style}>", layer.name());
        for (_, part) in pattern.parts.iter().filter(|(of, _)| *of == layer) {
            let points: Vec<String> = part.iter().map(|p| place(*p)).collect();
            let _ = writeln!(svg, "<path d=\"M{}Z\"/>", points.join("L"));
        }
        let lines: &[[Point; 2]] = match layer {
            Layer::Outline => &pattern.slits,
            Layer::Marks => &pattern.marks,
            Layer::Hub | Layer::Labels => &[],
        };
        for [from, to] in lines {
            let _ = writeln!(svg, "<path d=\"M{}L{}\"/>", place(*from), place(*to));
        }
        for label in pattern.labels.iter().filter(|_| layer == Layer::Labels) {
            // Capitals are about 0.7 of a font's size high.
            let _ = writeln!(
                svg,
                "<text transform=\"translate({}) rotate({})\" font-size=\"{}\" y=\"{}\">{}</text>",
                place(label.at),
                coordinate(-label.turn_deg),
                coordinate(label.height / 0.7),
                coordinate(0.5 * label.height),
                escape(&label.text)
            );
        }
        svg.push_str("</g>\n");
    }
    svg.push_str("</svg>\n");
    svg
}

fn stroke(colour: &str) -> String {
    format!("fill=\"none\" stroke=\"{colour}\" stroke-width=\"{HAIRLINE}\"")
}

/// To a tenth of a micrometre.
fn coordinate(value: f64) -> String {
    number((1e4 * value).round() / 1e4)
}
