//! Target and prediction from the side, with the line of thrust, and the distance between the two.

use super::{Figure, Frame, Mark, WIDTH, mirrored};
use crate::design::Design;
use crate::elastica::forward::{EndForces, Equilibrium};
use crate::report::ReportError;
use crate::report::chart::{Axis, Chart, Layer, bounds, equal_aspect, thinned};
use crate::report::palette::{HUB, PREDICTED, TARGET, THRUST};
use crate::report::svg::Stroke;
use crate::report::text::number;

const POINTS: usize = 401;
/// Lowest and highest plotting area.
const HEIGHTS: [f64; 2] = [110.0, 420.0];
/// How far the line of thrust may lie outside the curves, as a share of their height, and still widen the figure.
const NEAR: f64 = 0.35;

/// Errors in percent of the length that need not be told from zero.
const NEGLIGIBLE: f64 = 0.01;

const TARGET_LINE: Stroke = Stroke::solid(TARGET, 7.0);
const PREDICTED_LINE: Stroke = Stroke::solid(PREDICTED, 1.6);
const THRUST_LINE: Stroke = Stroke::dashed(THRUST, 1.4, [7.0, 4.0]);
const HUB_LINE: Stroke = Stroke::solid(HUB, 4.0);

/// The figure; absent for a strip that is only stretched.
pub fn figure(design: &Design) -> Result<Option<Figure>, ReportError> {
    if design.guide().is_none() {
        return Ok(None);
    }
    let frame = Frame::of(design.input());
    let profile = design.profile();
    let hub_x = profile.x.last().copied().unwrap_or(0.0);
    let hub_z = profile.z.last().copied().unwrap_or(0.0);
    let target = thinned(frame.points(&profile.x, &profile.z, hub_x), POINTS);
    let shape = design.voxel_path().map(|path| path.final_shape());
    let prediction = shape.map(|shape| thinned(frame.points(&shape.x, &shape.z, hub_x), POINTS));

    let all = || target.iter().chain(prediction.iter().flatten());
    let mut x_range = bounds(all().map(|p| p[0]), 0.03);
    if frame.dome {
        let reach = x_range[1].abs().max(1.06 * frame.hub_radius);
        x_range = [-reach, reach];
    }
    let curves = bounds(all().map(|p| p[1]).chain([0.0]), 0.06);
    let line = line_of_thrust(design, shape);
    let (x_range, y_range, height) = equal_aspect(x_range, with_level(curves, line), WIDTH, HEIGHTS);
    let thrust = line.and_then(|line| line.inside(frame, hub_x, x_range, y_range));

    let mut layers = Vec::new();
    let mut half = |points: &[[f64; 2]], stroke: Stroke| {
        if frame.dome {
            layers.push(Layer::Line(mirrored(points), stroke.faint(0.35)));
        }
        layers.push(Layer::Line(points.to_vec(), stroke));
    };
    half(&target, TARGET_LINE);
    if let Some(prediction) = &prediction {
        half(prediction, PREDICTED_LINE);
    }
    if frame.dome {
        let hub = |z: f64, stroke| Layer::Line(vec![[-frame.hub_radius, z], [frame.hub_radius, z]], stroke);
        layers.push(hub(hub_z, HUB_LINE));
        layers.extend(shape.and_then(|shape| shape.z.last()).map(|z| hub(*z, PREDICTED_LINE)));
    }
    layers.extend(thrust.map(|ends| Layer::Line(ends.to_vec(), THRUST_LINE)));
    if let Some(inverse) = design.inverse() {
        let (x, z): (Vec<f64>, Vec<f64>) = inverse.inflections.iter().map(|p| (p.x, p.z)).unzip();
        layers.push(Layer::Dots(frame.points(&x, &z, hub_x), 3.2, THRUST));
    }
    let chart = Chart {
        figure: "meridian",
        size: [WIDTH, height],
        x: Axis { both_ways: frame.dome, ..Axis::new(frame.axis(), x_range, 12) },
        y: Axis::new("height z, mm", y_range, 7),
        layers,
    };
    let mut drawings = vec![chart.draw()?];
    if let Some(shape) = shape {
        drawings.push(distance(design, shape)?.draw()?);
    }
    Ok(Some(Figure {
        title: if frame.dome { "Target and predicted meridian" } else { "Graded and voxelised strip" },
        legend: legend(design, frame, prediction.is_some(), thrust.is_some()),
        drawings,
        caption: caption(design, frame, line, thrust.is_some()),
    }))
}

fn legend(design: &Design, frame: Frame, prediction: bool, thrust: bool) -> Vec<(Mark, String)> {
    let mut legend = vec![(
        Mark::Line(TARGET_LINE),
        if frame.dome { "target" } else { "strip with the designed, smooth modulus" }.to_owned(),
    )];
    if prediction {
        legend.push((Mark::Line(PREDICTED_LINE), "predicted for the voxelised strip".to_owned()));
    }
    if frame.dome {
        legend.push((Mark::Line(HUB_LINE), "hub".to_owned()));
    }
    if thrust {
        let points = design.inverse().is_some_and(|inverse| !inverse.inflections.is_empty());
        let text = if points { "line of thrust, through the inflections" } else { "line of thrust" };
        legend.push((Mark::Line(THRUST_LINE), text.to_owned()));
    }
    legend
}

fn caption(design: &Design, frame: Frame, line: Option<ThrustLine>, drawn: bool) -> String {
    let mut caption = match (frame.dome, design.voxel_path().is_some()) {
        (true, true) => "The mid-line of one spoke, rim to hub, and faintly its mirror image; below, how far the \
                         voxelised strip's predicted mid-line is from the target."
            .to_owned(),
        (false, true) => "The mid-line after the ends were pushed together; below, how far apart the voxelised and \
                          the graded strip are."
            .to_owned(),
        (_, false) => "The shape of the voxelised strip could not be predicted.".to_owned(),
    };
    match line.and_then(ThrustLine::level) {
        Some(level) if !drawn => caption
            .push_str(&format!(" The line of thrust is level at z = {} mm, outside the figure.", number(level, 4))),
        None if line.is_some() && !drawn => caption.push_str(" The line of thrust lies outside the figure."),
        _ if drawn => caption.push_str(" On the line of thrust the bending moment vanishes."),
        _ => {}
    }
    caption
}

/// Distance between the predicted and the wanted mid-line along the strip.
fn distance(design: &Design, shape: &Equilibrium) -> Result<Chart, ReportError> {
    let profile = design.profile();
    let length = design.input().strips.length_mm;
    let points: Vec<[f64; 2]> = (0..profile.s.len())
        .map(|i| {
            let [x, z] = shape.position(profile.s[i]);
            [profile.s[i], 100.0 * (x - profile.x[i]).hypot(z - profile.z[i]) / length]
        })
        .collect();
    let along = Axis::new(Frame::of(design.input()).arc_length(), [0.0, length], 12);
    Ok(error_chart("meridian", along, thinned(points, POINTS), PREDICTED_LINE))
}

/// A low chart of distances in percent of the length.
pub fn error_chart(figure: &'static str, along: Axis, points: Vec<[f64; 2]>, stroke: Stroke) -> Chart {
    let [_, highest] = bounds(points.iter().map(|p| p[1]), 0.0);
    Chart {
        figure,
        size: [WIDTH, 154.0],
        x: along,
        y: Axis::new("error, % of L", [0.0, 1.15 * highest.max(NEGLIGIBLE)], 4),
        layers: vec![Layer::Line(points, stroke)],
    }
}

/// Where the moment `M_0 - H z - V x` vanishes, in the strip's own frame.
#[derive(Debug, Clone, Copy)]
struct ThrustLine {
    /// Foot of the perpendicular from the rim.
    foot: [f64; 2],
    /// Unit vector along the line.
    direction: [f64; 2],
}

fn line_of_thrust(design: &Design, shape: Option<&Equilibrium>) -> Option<ThrustLine> {
    let forces = match (design.inverse(), shape) {
        (None, Some(shape)) => shape.forces,
        _ => design.forces(),
    };
    let EndForces { rim_moment, horizontal, vertical } = forces;
    let size = horizontal.hypot(vertical);
    let length = design.input().strips.length_mm;
    // Pure bending: the line is at infinity.
    if !size.is_finite() || size * length <= 1e-6 * rim_moment.abs() || size == 0.0 {
        return None;
    }
    let away = rim_moment / (size * size);
    Some(ThrustLine { foot: [away * vertical, away * horizontal], direction: [horizontal / size, -vertical / size] })
}

impl ThrustLine {
    /// Its height, if it is level.
    fn level(self) -> Option<f64> {
        (self.direction[1].abs() < 1e-9).then_some(self.foot[1])
    }

    /// The part inside a box, in the figure's frame; on the right half only where the left is a mirror image.
    fn inside(self, frame: Frame, hub_x: f64, x: [f64; 2], y: [f64; 2]) -> Option<[[f64; 2]; 2]> {
        let sign = if frame.dome { -1.0 } else { 1.0 };
        let from_x = if frame.dome { frame.hub_radius + hub_x } else { 0.0 };
        let foot = [from_x + sign * self.foot[0], self.foot[1]];
        let direction = [sign * self.direction[0], self.direction[1]];
        let x = if frame.dome { [x[0].max(0.0), x[1]] } else { x };
        let mut part = [f64::NEG_INFINITY, f64::INFINITY];
        for (at, along, [low, high]) in [(foot[0], direction[0], x), (foot[1], direction[1], y)] {
            if along.abs() < 1e-12 {
                if at < low || at > high {
                    return None;
                }
                continue;
            }
            let (a, b) = ((low - at) / along, (high - at) / along);
            part = [part[0].max(a.min(b)), part[1].min(a.max(b))];
        }
        let end = |t: f64| [foot[0] + t * direction[0], foot[1] + t * direction[1]];
        (part[0] < part[1] && part.iter().all(|t| t.is_finite())).then(|| part.map(end))
    }
}

/// The vertical range, widened for a level line of thrust that is near.
fn with_level([low, high]: [f64; 2], line: Option<ThrustLine>) -> [f64; 2] {
    let room = NEAR * (high - low);
    let margin = 0.04 * (high - low);
    match line.and_then(ThrustLine::level) {
        Some(level) if level > high - margin && level < high + room => [low, level + margin],
        Some(level) if level < low + margin && level > low - room => [level - margin, high],
        _ => [low, high],
    }
}
