//! The figures of a report.

pub mod flower;
pub mod meridian;
pub mod morph;
pub mod print;
pub mod profile;
pub mod sections;
pub mod voxels;

use super::palette::Colour;
use super::svg::{Stroke, Svg};
use super::text::escape;
use crate::design::Design;
use crate::input::DesignInput;

/// Width of all figures, user units; about one CSS pixel each on a screen.
pub const WIDTH: f64 = 800.0;

/// What a legend shows beside its text.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Mark {
    /// A piece of a line.
    Line(Stroke),
    /// A patch of colour.
    Patch(Colour),
    /// The ramp from soft to stiff.
    Ramp,
}

/// A figure with its legend and caption.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// Title.
    pub title: &'static str,
    /// Legend.
    pub legend: Vec<(Mark, String)>,
    /// The drawings, one below the other.
    pub drawings: Vec<Svg>,
    /// What the figure shows and what to note, as plain text.
    pub caption: String,
}

impl Figure {
    /// The figure as HTML.
    #[must_use]
    pub fn html(&self, number: usize) -> String {
        let mut html = format!("<figure>\n<h2><span>Figure {number}</span> {}</h2>\n", escape(self.title));
        if !self.legend.is_empty() {
            html.push_str("<ul class=\"legend\">");
            for (mark, text) in &self.legend {
                html.push_str(&format!("<li>{}{}</li>", mark.html(), escape(text)));
            }
            html.push_str("</ul>\n");
        }
        for drawing in &self.drawings {
            html.push_str(&drawing.inline(self.title));
            html.push('\n');
        }
        html.push_str(&format!("<figcaption>{}</figcaption>\n</figure>\n", escape(&self.caption)));
        html
    }
}

impl Mark {
    fn html(&self) -> String {
        let (width, shape) = match self {
            Self::Line(stroke) => (28, format!("<path d=\"M1 6h26\" {}/>", stroke.attributes())),
            Self::Patch(colour) => {
                (12, format!("<rect width=\"12\" height=\"12\" rx=\"2\" fill=\"{}\"/>", colour.hex()))
            }
            Self::Ramp => {
                let piece = |k: u32| {
                    let colour = super::palette::ramp(f64::from(k) / 15.0).hex();
                    format!("<rect x=\"{}\" width=\"4\" height=\"12\" fill=\"{colour}\"/>", 3 * k)
                };
                (48, (0..16).map(piece).collect())
            }
        };
        format!("<svg viewBox=\"0 0 {width} 12\" width=\"{width}\" height=\"12\" aria-hidden=\"true\">{shape}</svg>")
    }
}

/// From a strip's own frame (rim at the origin) to that of the dome (axis at the origin), or for a strip unchanged.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    /// Hub radius, mm; zero for a strip.
    pub hub_radius: f64,
    /// Whether this is a dome.
    pub dome: bool,
}

impl Frame {
    /// The frame of a design.
    #[must_use]
    pub fn of(input: &DesignInput) -> Self {
        Self { hub_radius: input.hub_radius(), dome: !input.is_strip() }
    }

    /// Horizontal axis of charts.
    #[must_use]
    pub fn axis(&self) -> &'static str {
        if self.dome { "distance from the axis ρ, mm" } else { "horizontal position x, mm" }
    }

    /// Name of the arc length on charts.
    #[must_use]
    pub fn arc_length(&self) -> &'static str {
        if self.dome { "arc length from the rim s, mm" } else { "arc length s, mm" }
    }

    /// Names of the two ends.
    #[must_use]
    pub fn ends(&self) -> [&'static str; 2] {
        if self.dome { ["rim", "hub"] } else { ["s = 0", "s = L"] }
    }

    /// Where points of a strip whose hub end is at `hub_x` are drawn.
    #[must_use]
    pub fn points(&self, x: &[f64], z: &[f64], hub_x: f64) -> Vec<[f64; 2]> {
        let at = |x: f64| if self.dome { self.hub_radius + hub_x - x } else { x };
        x.iter().zip(z).map(|(x, z)| [at(*x), *z]).collect()
    }
}

/// Points mirrored at the axis.
#[must_use]
pub fn mirrored(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    points.iter().map(|[x, z]| [-x, *z]).collect()
}

/// Legend of the phases, softest first.
#[must_use]
pub fn phase_legend(design: &Design) -> Vec<(Mark, String)> {
    let phases = design.phases().phases();
    let mark = |i: usize| Mark::Patch(super::palette::phase(i, phases.len()));
    phases.iter().enumerate().map(|(i, phase)| (mark(i), phase.name.clone())).collect()
}
