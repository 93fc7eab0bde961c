//! Width and modulus along the strip.

use super::{Figure, Frame, Mark, WIDTH};
use crate::design::Design;
use crate::report::ReportError;
use crate::report::chart::{Axis, Chart, Layer, bounds, thinned};
use crate::report::palette::{AXIS, PREDICTED, SHADE, TARGET};
use crate::report::svg::Stroke;
use crate::report::text::number;

const POINTS: usize = 401;
/// Steps above which neighbouring slices are drawn as one range.
const MOST_STEPS: usize = 600;

const SMOOTH: Stroke = Stroke::solid(TARGET, 6.0);
const STEPS: Stroke = Stroke::solid(PREDICTED, 1.0);
const LIMIT: Stroke = Stroke::dashed(AXIS, 1.0, [3.0, 3.0]);

/// The figure.
pub fn figure(design: &Design) -> Result<Figure, ReportError> {
    let profile = design.profile();
    let input = design.input();
    let length = input.strips.length_mm;
    let size = design.grid().size_mm();
    let along = |description: &str| Axis::new(description, [0.0, length], 12);
    let curve = |values: &[f64]| thinned(profile.s.iter().zip(values).map(|(s, v)| [*s, *v]).collect(), POINTS);

    let widths: Vec<f64> = design.slices().iter().map(|s| 2.0 * s.half_width as f64 * size).collect();
    let [_, widest] = bounds(profile.width.iter().chain(&widths).copied(), 0.0);
    let width = Chart {
        figure: "width and modulus",
        size: [WIDTH, 170.0],
        x: along(""),
        y: Axis::new("width w, mm", [0.0, 1.08 * widest], 5),
        layers: vec![Layer::Line(curve(&profile.width), SMOOTH), Layer::Line(steps(&widths, length), STEPS)],
    };

    let moduli: Vec<f64> = design.slices().iter().map(|s| s.modulus_mpa).collect();
    let (soft, stiff) = (design.phases().softest(), design.phases().stiffest());
    let level = |e: f64| vec![[0.0, e], [length, e]];
    let reach = vec![[0.0, soft], [length, soft], [length, stiff], [0.0, stiff]];
    let modulus = Chart {
        figure: "width and modulus",
        size: [WIDTH, 270.0],
        x: along(Frame::of(input).arc_length()),
        y: Axis::new("modulus E, MPa", [0.0, 1.08 * stiff], 6),
        layers: vec![
            Layer::Area(reach, SHADE, 1.0),
            Layer::Line(level(soft), LIMIT),
            Layer::Line(level(stiff), LIMIT),
            Layer::Line(curve(&profile.modulus_mpa), SMOOTH),
            Layer::Line(steps(&moduli, length), STEPS),
        ],
    };
    let reach = format!("what the phases reach, {} to {} MPa", number(soft, 4), number(stiff, 4));
    let mut caption = "The voxelised strip meets the product of modulus and width: where rounding to whole voxels \
                       changes the width, the modulus makes up for it as far as the phases reach."
        .to_owned();
    if design.slices().len() > MOST_STEPS {
        caption.push_str(" Neighbouring slices are drawn together, from their least to their largest value.");
    }
    Ok(Figure {
        title: "Width and modulus along the strip",
        legend: vec![
            (Mark::Line(SMOOTH), "designed".to_owned()),
            (Mark::Line(STEPS), "voxel slices".to_owned()),
            (Mark::Patch(SHADE), reach),
        ],
        drawings: vec![width.draw()?, modulus.draw()?],
        caption,
    })
}

/// Values of slices as steps, or for many slices as a band from least to largest.
fn steps(values: &[f64], length: f64) -> Vec<[f64; 2]> {
    let step = length / values.len().max(1) as f64;
    if values.len() <= MOST_STEPS {
        let edges = |(i, v): (usize, &f64)| [[i as f64 * step, *v], [(i + 1) as f64 * step, *v]];
        return values.iter().enumerate().flat_map(edges).collect();
    }
    let many = values.len().div_ceil(MOST_STEPS);
    values
        .chunks(many)
        .enumerate()
        .flat_map(|(i, chunk)| {
            let [low, high] = chunk.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], v| [l.min(*v), h.max(*v)]);
            let s = (i as f64 * many as f64 + 0.5 * chunk.len() as f64) * step;
            [[s, low], [s, high]]
        })
        .collect()
}
