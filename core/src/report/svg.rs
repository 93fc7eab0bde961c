//! A small writer of SVG shapes.

use std::fmt::Write;

use super::palette::Colour;
use super::text::{coordinate, escape};

/// How a line is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stroke {
    /// Colour.
    pub colour: Colour,
    /// Width, user units.
    pub width: f64,
    /// Opacity from 0 to 1.
    pub opacity: f64,
    /// Lengths of dash and gap.
    pub dash: Option<[f64; 2]>,
}

impl Stroke {
    /// A solid line.
    #[must_use]
    pub const fn solid(colour: Colour, width: f64) -> Self {
        Self { colour, width, opacity: 1.0, dash: None }
    }

    /// A dashed line.
    #[must_use]
    pub const fn dashed(colour: Colour, width: f64, dash: [f64; 2]) -> Self {
        Self { colour, width, opacity: 1.0, dash: Some(dash) }
    }

    /// The same line, fainter.
    #[must_use]
    pub const fn faint(self, opacity: f64) -> Self {
        Self { opacity, ..self }
    }

    /// The attributes of a shape that is drawn with it and not filled.
    #[must_use]
    pub fn attributes(&self) -> String {
        let mut text =
            format!("fill=\"none\" stroke=\"{}\" stroke-width=\"{}\"", self.colour.hex(), coordinate(self.width));
        if let Some([dash, gap]) = self.dash {
            let _ = write!(text, " stroke-dasharray=\"{} {}\"", coordinate(dash), coordinate(gap));
        }
        if self.opacity < 1.0 {
            let _ = write!(text, " opacity=\"{}\"", coordinate(self.opacity));
        }
        text
    }
}

/// Where a text stands with respect to its position.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Anchor {
    /// It starts there.
    Start,
    /// It is centred there.
    Middle,
    /// It ends there.
    End,
}

/// A drawing in the making, origin at the upper left, y downwards.
#[derive(Debug, Clone, PartialEq)]
pub struct Svg {
    /// Width, user units.
    pub width: f64,
    /// Height, user units.
    pub height: f64,
    body: String,
}

impl Svg {
    /// An empty drawing.
    #[must_use]
    pub fn new(width: f64, height: f64) -> Self {
        Self { width, height, body: String::new() }
    }

    /// Appends markup as it is.
    pub fn raw(&mut self, markup: &str) {
        self.body.push_str(markup);
        self.body.push('\n');
    }

    /// A straight line.
    pub fn line(&mut self, from: [f64; 2], to: [f64; 2], stroke: &Stroke) {
        self.raw(&format!(
            "<line x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\" {}/>",
            coordinate(from[0]),
            coordinate(from[1]),
            coordinate(to[0]),
            coordinate(to[1]),
            stroke.attributes()
        ));
    }

    /// A rectangle by its upper left corner and its size.
    pub fn rectangle(&mut self, corner: [f64; 2], size: [f64; 2], attributes: &str) {
        self.raw(&format!(
            "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" {attributes}/>",
            coordinate(corner[0]),
            coordinate(corner[1]),
            coordinate(size[0]),
            coordinate(size[1]),
        ));
    }

    /// A circle.
    pub fn circle(&mut self, centre: [f64; 2], radius: f64, attributes: &str) {
        let [x, y] = centre.map(coordinate);
        self.raw(&format!("<circle cx=\"{x}\" cy=\"{y}\" r=\"{}\" {attributes}/>", coordinate(radius)));
    }

    /// A path by its commands.
    pub fn path(&mut self, commands: &str, attributes: &str) {
        self.raw(&format!("<path d=\"{commands}\" {attributes}/>"));
    }

    /// A text; its baseline is at `at`.
    pub fn text(&mut self, at: [f64; 2], anchor: Anchor, size: f64, colour: Colour, text: &str) {
        let anchor = match anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let [x, y] = at.map(coordinate);
        self.raw(&format!(
            "<text x=\"{x}\" y=\"{y}\" text-anchor=\"{anchor}\" font-family=\"sans-serif\" font-size=\"{}\" fill=\"{}\">{}</text>",
            coordinate(size),
            colour.hex(),
            escape(text)
        ));
    }

    /// Another drawing with its upper left corner at `at`.
    pub fn place(&mut self, at: [f64; 2], drawing: &Self) {
        let [x, y] = at.map(coordinate);
        self.raw(&format!("<g transform=\"translate({x} {y})\">"));
        self.body.push_str(&drawing.body);
        self.raw("</g>");
    }

    /// Markup for a page of HTML; the description is for readers who cannot see it.
    #[must_use]
    pub fn inline(&self, description: &str) -> String {
        let (w, h) = (coordinate(self.width), coordinate(self.height));
        let label = escape(description);
        format!("<svg viewBox=\"0 0 {w} {h}\" role=\"img\" aria-label=\"{label}\">\n{}</svg>", self.body)
    }

    /// A file of its own, on a white ground.
    #[must_use]
    pub fn standalone(&self, title: &str) -> String {
        let (w, h) = (coordinate(self.width), coordinate(self.height));
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}\" height=\"{h}\" viewBox=\"0 0 {w} {h}\">\n\
             <title>{}</title>\n<rect width=\"{w}\" height=\"{h}\" fill=\"#ffffff\"/>\n{}</svg>\n",
            escape(title),
            self.body
        )
    }
}

/// Commands of a path through points.
#[must_use]
pub fn polyline(points: impl IntoIterator<Item = [f64; 2]>, closed: bool) -> String {
    let mut commands = String::new();
    for (i, point) in points.into_iter().enumerate() {
        let [x, y] = point.map(coordinate);
        let _ = write!(commands, "{}{x} {y}", if i == 0 { 'M' } else { 'L' });
    }
    if closed {
        commands.push('Z');
    }
    commands
}
