//! The flat flower with all spokes, or the flat strip.

use std::f64::consts::PI;

use super::{Figure, Mark, WIDTH};
use crate::design::Design;
use crate::profile::Profile;
use crate::report::chart::thinned;
use crate::report::palette::{AXIS, Colour, HUB, INK, MUTED, THRUST, ramp};
use crate::report::svg::{Anchor, Stroke, Svg, polyline};
use crate::report::text::{coordinate, number};

/// Largest drawing of the flower.
const LARGEST: [f64; 2] = [620.0, 620.0];
const MARGIN: f64 = 14.0;
/// Stops of the gradient along a spoke.
const STOPS: usize = 33;
/// Corners of the hub's polygon above which a circle looks the same.
const MOST_CORNERS: usize = 120;

const GROUND: Colour = Colour([0xff; 3]);
const RIM: Stroke = Stroke::dashed(THRUST, 1.2, [6.0, 4.0]);
const FLAT_RIM: Stroke = Stroke::dashed(AXIS, 1.0, [2.0, 3.0]);

/// The figure.
#[must_use]
pub fn figure(design: &Design) -> Figure {
    if design.input().is_strip() { strip(design) } else { flower(design) }
}

fn flower(design: &Design) -> Figure {
    let (profile, count, hub) = (design.profile(), design.input().count(), design.input().hub_radius());
    let length = design.input().strips.length_mm;
    let (flat, morphed) = (hub + length, profile.rho[0]);
    let edge: Vec<[f64; 2]> = profile.s.iter().zip(&profile.width).map(|(s, w)| [flat - s, 0.5 * w]).collect();
    let edge = thinned(edge, 101);
    let other = edge.iter().rev().map(|[x, y]| [*x, -y]);
    let outline: Vec<[f64; 2]> = edge.iter().copied().chain(other).collect();
    let corner = outline.iter().map(|[x, y]| x.hypot(*y)).fold(flat, f64::max);
    let scale = 0.5 * (LARGEST[0] - 2.0 * MARGIN) / corner;
    let centre = 0.5 * LARGEST[0];

    let mut svg = Svg::new(WIDTH, LARGEST[1]);
    svg.raw(&gradient(profile, |s| flat - s, scale));
    let outline = outline.into_iter().map(|[x, y]| [x * scale, -y * scale]);
    svg.raw(&format!(
        "<defs><path id=\"spoke\" d=\"{}\" fill=\"url(#modulus)\" stroke=\"#ffffff\" stroke-width=\"{}\"/></defs>",
        polyline(outline, true),
        coordinate((scale * 0.02 * profile.width[0]).clamp(0.05, 0.6))
    ));
    svg.raw(&format!("<g transform=\"translate({0} {0})\">", coordinate(centre)));
    for k in 0..count {
        let turn = 360.0 * k as f64 / count as f64;
        svg.raw(&format!("<use href=\"#spoke\" transform=\"rotate({:.4})\"/>", -turn));
    }
    let hub_style = format!("fill=\"{}\"", HUB.hex());
    if count <= MOST_CORNERS {
        let radius = scale * hub / (PI / count as f64).cos();
        let corner = |k: usize| {
            let (sin, cos) = (PI * (2 * k + 1) as f64 / count as f64).sin_cos();
            [radius * cos, -radius * sin]
        };
        svg.path(&polyline((0..count).map(corner), true), &hub_style);
    } else {
        svg.circle([0.0; 2], scale * hub, &hub_style);
    }
    svg.circle([0.0; 2], scale * flat, &FLAT_RIM.attributes());
    // A pale ground keeps the dashes readable on dark colours.
    svg.circle([0.0; 2], scale * morphed, &Stroke { colour: GROUND, width: 3.4, ..RIM }.faint(0.85).attributes());
    svg.circle([0.0; 2], scale * morphed, &RIM.attributes());
    svg.raw("</g>");
    colour_bar(&mut svg, profile, [LARGEST[0] + 50.0, 120.0]);
    scale_bar(&mut svg, [LARGEST[0] + 50.0, LARGEST[1] - 40.0], scale, 120.0);

    Figure {
        title: "Flat flower",
        legend: vec![
            (Mark::Line(FLAT_RIM), format!("flat rim, radius {} mm", number(flat, 4))),
            (Mark::Line(RIM), format!("morphed rim, radius {} mm", number(morphed, 4))),
            (Mark::Patch(HUB), format!("hub, inscribed radius {} mm", number(hub, 4))),
        ],
        drawings: vec![svg],
        caption: format!(
            "All {count} spokes to scale, seen from above; spoke 1 points to the right, counting counter-clockwise. The \
             colour is the designed modulus."
        ),
    }
}

fn strip(design: &Design) -> Figure {
    let (profile, length) = (design.profile(), design.input().strips.length_mm);
    let width = profile.width[0];
    let scale = ((WIDTH - 40.0) / length).min(260.0 / width);
    let drawn = [scale * length, scale * width].map(|side| side.max(2.0));
    let left = 0.5 * (WIDTH - drawn[0]);
    let mut svg = Svg::new(WIDTH, drawn[1] + 130.0);
    svg.raw(&gradient(profile, |s| s, drawn[0] / length));
    svg.raw(&format!("<g transform=\"translate({} 10)\">", coordinate(left)));
    svg.rectangle([0.0; 2], drawn, "fill=\"url(#modulus)\"");
    svg.raw("</g>");
    let below = drawn[1] + 34.0;
    let end = format!("s = {} mm", number(length, 4));
    if drawn[0] > 160.0 {
        svg.text([left, below], Anchor::Start, 12.0, MUTED, "s = 0");
        svg.text([left + drawn[0], below], Anchor::End, 12.0, MUTED, &end);
    } else {
        svg.text([0.5 * WIDTH, below], Anchor::Middle, 12.0, MUTED, &format!("s = 0 to the left, {end} to the right"));
    }
    let bar = [0.5 * WIDTH - 150.0, below + 40.0];
    flat_colour_bar(&mut svg, profile, bar);
    let scaled = drawn == [scale * length, scale * width];
    let note = if scaled { " to scale" } else { ", its shorter side exaggerated" };
    Figure {
        title: "Flat strip",
        legend: Vec::new(),
        drawings: vec![svg],
        caption: format!(
            "The strip of {} by {} mm{note}, seen from above. The colour is the designed modulus.",
            number(length, 4),
            number(width, 4)
        ),
    }
}

/// Least and largest modulus and the share of a modulus between them.
fn shares(profile: &Profile) -> ([f64; 2], impl Fn(f64) -> f64) {
    let fold = |f: fn(f64, f64) -> f64, start: f64| profile.modulus_mpa.iter().copied().fold(start, f);
    let (low, high) = (fold(f64::min, f64::INFINITY), fold(f64::max, 0.0));
    let even = high - low <= 1e-6 * high;
    ([low, high], move |e: f64| if even { 0.5 } else { (e - low) / (high - low) })
}

/// A gradient of the modulus along the spoke, in the spoke's own drawn coordinates.
fn gradient(profile: &Profile, place: impl Fn(f64) -> f64, scale: f64) -> String {
    let (_, share) = shares(profile);
    let last = profile.s.len() - 1;
    let ends = [profile.s[0], profile.s[last]].map(|s| coordinate(scale * place(s)));
    let mut text = format!(
        "<defs><linearGradient id=\"modulus\" gradientUnits=\"userSpaceOnUse\" x1=\"{}\" y1=\"0\" x2=\"{}\" y2=\"0\">",
        ends[0], ends[1]
    );
    for k in 0..STOPS {
        let colour = ramp(share(profile.modulus_mpa[k * last / (STOPS - 1)]));
        text.push_str(&stop(k as f64 / (STOPS - 1) as f64, colour));
    }
    text.push_str("</linearGradient></defs>");
    text
}

fn stop(offset: f64, colour: Colour) -> String {
    format!("<stop offset=\"{offset:.4}\" stop-color=\"{}\"/>", colour.hex())
}

/// The ramp itself as a gradient; `along` are the attributes of its direction.
fn bar_gradient(profile: &Profile, along: &str) -> String {
    let ([low, high], share) = shares(profile);
    let stops: String = (0..=16)
        .map(|k| {
            let offset = f64::from(k) / 16.0;
            stop(offset, ramp(share(low + offset * (high - low))))
        })
        .collect();
    format!("<defs><linearGradient id=\"bar\" {along}>{stops}</linearGradient></defs>")
}

const BAR_LENGTH: f64 = 300.0;

fn colour_bar(svg: &mut Svg, profile: &Profile, [x, y]: [f64; 2]) {
    let ([low, high], _) = shares(profile);
    svg.raw(&bar_gradient(profile, "x1=\"0\" y1=\"1\" x2=\"0\" y2=\"0\""));
    svg.text([x, y - 16.0], Anchor::Start, 12.0, INK, "modulus E, MPa");
    svg.rectangle([x, y], [18.0, BAR_LENGTH], "fill=\"url(#bar)\"");
    for (share, value) in bar_ticks([low, high]) {
        let at = y + BAR_LENGTH * (1.0 - share);
        svg.line([x + 18.0, at], [x + 23.0, at], &Stroke::solid(AXIS, 1.0));
        svg.text([x + 28.0, at + 4.2], Anchor::Start, 12.0, MUTED, &number(value, 3));
    }
}

fn flat_colour_bar(svg: &mut Svg, profile: &Profile, [x, y]: [f64; 2]) {
    let (range, _) = shares(profile);
    svg.raw(&bar_gradient(profile, "x1=\"0\" y1=\"0\" x2=\"1\" y2=\"0\""));
    svg.text([x + 0.5 * BAR_LENGTH, y - 10.0], Anchor::Middle, 12.0, INK, "modulus E, MPa");
    svg.rectangle([x, y], [BAR_LENGTH, 16.0], "fill=\"url(#bar)\"");
    for (share, value) in bar_ticks(range) {
        let at = x + BAR_LENGTH * share;
        svg.line([at, y + 16.0], [at, y + 21.0], &Stroke::solid(AXIS, 1.0));
        svg.text([at, y + 34.0], Anchor::Middle, 12.0, MUTED, &number(value, 3));
    }
}

/// Where ticks of a colour bar stand; only one for a single modulus.
fn bar_ticks([low, high]: [f64; 2]) -> Vec<(f64, f64)> {
    if high - low <= 1e-3 * high {
        return vec![(0.5, high)];
    }
    (0..=4).map(|k| f64::from(k) / 4.0).map(|share| (share, low + share * (high - low))).collect()
}

/// A bar of a round length, at most `most` units long.
pub fn scale_bar(svg: &mut Svg, [x, y]: [f64; 2], scale: f64, most: f64) {
    let longest = most / scale;
    let decade = 10.0_f64.powf(longest.log10().floor());
    let length = [5.0, 2.0, 1.0].map(|m| m * decade).into_iter().find(|l| *l <= longest).unwrap_or(decade);
    let end = x + scale * length;
    let stroke = Stroke::solid(INK, 1.4);
    svg.line([x, y], [end, y], &stroke);
    for at in [x, end] {
        svg.line([at, y - 4.0], [at, y + 4.0], &stroke);
    }
    svg.text([0.5 * (x + end), y + 18.0], Anchor::Middle, 12.0, INK, &format!("{} mm", number(length, 3)));
}
