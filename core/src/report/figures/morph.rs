//! The way from flat to the final shape.

use super::{Figure, Frame, Mark, WIDTH, mirrored};
use crate::design::Design;
use crate::elastica::morph::MorphPath;
use crate::report::ReportError;
use crate::report::chart::{Axis, Chart, Layer, bounds, equal_aspect, thinned};
use crate::report::palette::{HUB, ramp};
use crate::report::svg::Stroke;

const FRACTIONS: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];
const POINTS: usize = 301;
const HEIGHTS: [f64; 2] = [110.0, 360.0];

/// The figure; absent for a strip that is only stretched, and where no path is known.
pub fn figure(design: &Design) -> Result<Option<Figure>, ReportError> {
    let (path, voxelised) = match (design.voxel_path(), design.graded_path()) {
        (Some(path), _) => (path, true),
        (None, Ok(Some(path))) => (path, false),
        (None, _) => return Ok(None),
    };
    let frame = Frame::of(design.input());
    let states: Vec<(f64, Vec<[f64; 2]>)> =
        FRACTIONS.iter().filter_map(|fraction| Some((*fraction, state(path, *fraction, frame)?))).collect();

    let all = || states.iter().flat_map(|(_, points)| points);
    let mut x_range = bounds(all().map(|p| p[0]), 0.03);
    if frame.dome {
        x_range = [-x_range[1].abs(), x_range[1].abs()];
    }
    let y_range = bounds(all().map(|p| p[1]).chain([0.0]), 0.07);
    let (x_range, y_range, height) = equal_aspect(x_range, y_range, WIDTH, HEIGHTS);
    let mut layers = Vec::new();
    for (fraction, points) in &states {
        let stroke = stroke(*fraction);
        if frame.dome {
            layers.push(Layer::Line(mirrored(points), stroke.faint(0.35)));
            let z = points.last().map_or(0.0, |p| p[1]);
            let hub = Stroke::solid(HUB, 3.0).faint(0.35 + 0.65 * fraction);
            layers.push(Layer::Line(vec![[-frame.hub_radius, z], [frame.hub_radius, z]], hub));
        }
        layers.push(Layer::Line(points.clone(), stroke));
    }
    let chart = Chart {
        figure: "morph",
        size: [WIDTH, height],
        x: Axis { both_ways: frame.dome, ..Axis::new(frame.axis(), x_range, 12) },
        y: Axis::new("height z, mm", y_range, 6),
        layers,
    };
    let legend = states.iter().map(|(f, _)| (Mark::Line(stroke(*f)), format!("λ = {f}"))).collect();
    let which = if voxelised { "voxelised" } else { "graded" };
    let mut caption = if frame.dome {
        format!(
            "The {which} spoke, from the flat flower (λ = 0) to the dome (λ = 1): its ends follow the target with \
             the inclination scaled by λ, and it takes its own equilibrium in between."
        )
    } else {
        format!("The {which} strip while its ends are pushed together, by λ² of the final shortening.")
    };
    if states.len() < FRACTIONS.len() {
        caption.push_str(" States whose equilibrium was not found are left out.");
    }
    Ok(Some(Figure { title: "Morph", legend, drawings: vec![chart.draw()?], caption }))
}

fn stroke(fraction: f64) -> Stroke {
    Stroke::solid(ramp(0.15 + 0.75 * fraction), 1.4 + 1.0 * fraction)
}

/// The mid-line at a fraction of the morph, where its equilibrium is found.
fn state(path: &MorphPath, fraction: f64, frame: Frame) -> Option<Vec<[f64; 2]>> {
    let length = path.guide().length();
    if fraction == 0.0 {
        return Some(frame.points(&[0.0, length], &[0.0, 0.0], length));
    }
    let shape = path.at(fraction).ok()?;
    let hub_x = shape.x.last().copied().unwrap_or(length);
    Some(thinned(frame.points(&shape.x, &shape.z, hub_x), POINTS))
}
