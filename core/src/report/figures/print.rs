//! Slices of a print stack, where the design asks for one.

use std::ops::Range;

use base64::Engine;

use super::flower::scale_bar;
use super::{Figure, WIDTH, phase_legend};
use crate::design::Design;
use crate::fabrication::raster::image::{Format, encode};
use crate::fabrication::raster::{Painter, Pitch, Pixel, Raster, Stack, VOID, stack};
use crate::input::{FabricationInput, FabricationKind, PrintSource};
use crate::progress::never;
use crate::report::palette::{AXIS, INK};
use crate::report::svg::{Anchor, Stroke, Svg};
use crate::report::text::{coordinate, number};

/// Most pixels of the picture of a whole slice, along its longer side.
const MOST_PIXELS: f64 = 760.0;
/// Printer's voxels in the close-up.
const WINDOW: [usize; 2] = [180, 90];
/// Largest slice that a close-up is drawn of, pixels: the rows before it have to be drawn as well.
const LARGEST_SLICE: f64 = 1e8;
/// Highest picture.
const HIGHEST: f64 = 420.0;
const HEADING: f64 = 24.0;

/// The figure; none where no print stack is asked for.
#[must_use]
pub fn figure(design: &Design) -> Option<Figure> {
    let input = design.input().fabrication.as_ref()?;
    let stacks = [FabricationKind::PrintStack, FabricationKind::Gcvf];
    if !input.write.iter().any(|kind| stacks.contains(kind)) {
        return None;
    }
    let native = stack::raster(design, input, Pitch::of(input));
    let slice = native.slices / 2;
    let coarse = (native.columns.max(native.rows) as f64 / MOST_PIXELS).ceil().max(1.0);
    let mut drawings = vec![overview(design, input, &native, coarse, slice)?];
    if native.columns as f64 * native.rows as f64 <= LARGEST_SLICE {
        drawings.push(close_up(design, input, native, slice)?);
    }
    let source = match input.source {
        PrintSource::Voxels => "the voxels of the design, enlarged to the printer's",
        PrintSource::Field => "the continuous modulus, dithered with the printer's voxels",
    };
    let [x, y, z] = native.pitch.um().map(|p| number(p, 4));
    let mut caption = format!(
        "Slice {} of {} of the print stack, seen from above: {source}, {x} × {y} × {z} µm.",
        slice + 1,
        native.slices
    );
    if coarse > 1.0 {
        caption.push_str(&format!(" The whole slice is drawn {coarse} times coarser; the close-up shows every voxel."));
    }
    Some(Figure { title: "Print slices", legend: phase_legend(design), drawings, caption })
}

/// The whole slice, on a coarser raster.
fn overview(design: &Design, input: &FabricationInput, native: &Raster, coarse: f64, slice: usize) -> Option<Svg> {
    let [x, y, z] = native.pitch.mm;
    let raster = stack::raster(design, input, Pitch { mm: [coarse * x, coarse * y, z] });
    let stack = Stack::new(design, input, raster, &never)?;
    let png = encode(&raster, stack.painter(slice).as_mut(), &stack.encoding(Format::Indexed), &|| true).ok()??.png;
    let [wide, high, _] = raster.size_mm();
    let scale = (WIDTH / wide).min(HIGHEST / high);
    let mut svg = Svg::new(WIDTH, HEADING + scale * high + 34.0);
    svg.text([0.0, 14.0], Anchor::Start, 12.5, INK, "whole slice");
    place(&mut svg, &png, [0.5 * (WIDTH - scale * wide), HEADING], [scale * wide, scale * high]);
    scale_bar(&mut svg, [1.0, HEADING + scale * high + 10.0], scale, 160.0);
    Some(svg)
}

/// A few thousand of the printer's voxels, a third of the way along spoke 1.
fn close_up(design: &Design, input: &FabricationInput, native: Raster, slice: usize) -> Option<Svg> {
    let stack = Stack::new(design, input, native, &never)?;
    let [columns, rows] = [WINDOW[0].min(native.columns), WINDOW[1].min(native.rows)];
    let third = match native.layout().spokes() {
        1 => native.columns / 3,
        _ => native.columns - native.columns / 6,
    };
    let left = third.saturating_sub(columns / 2).min(native.columns - columns);
    let top = (native.rows - rows) / 2;
    let mut window = Window { columns: left..left + columns, pixels: Vec::new() };
    let mut painter = stack.painter(slice);
    let mut line = vec![VOID; native.columns];
    for row in 0..top + rows {
        line.fill(VOID);
        painter.paint(row, &mut line);
        if row >= top {
            window.pixels.push(line[window.columns.clone()].to_vec());
        }
    }
    let raster = native.cut_to(columns, rows);
    let png = encode(&raster, &mut window, &stack.encoding(Format::Indexed), &|| true).ok()??.png;
    let [wide, high, _] = raster.size_mm();
    let scale = (WIDTH / wide).min(HIGHEST / high);
    let mut svg = Svg::new(WIDTH, HEADING + scale * high + 34.0);
    svg.text([0.0, 14.0], Anchor::Start, 12.5, INK, "close-up, every voxel of the printer");
    place(&mut svg, &png, [0.0, HEADING], [scale * wide, scale * high]);
    let frame = Stroke::solid(AXIS, 0.8);
    svg.rectangle([0.0, HEADING], [scale * wide, scale * high], &frame.attributes());
    scale_bar(&mut svg, [1.0, HEADING + scale * high + 10.0], scale, 160.0);
    Some(svg)
}

/// Pixels that were cut out of a slice.
struct Window {
    columns: Range<usize>,
    pixels: Vec<Vec<Pixel>>,
}

impl Painter for Window {
    fn paint(&mut self, row: usize, pixels: &mut [Pixel]) {
        if let Some(line) = self.pixels.get(row) {
            pixels.copy_from_slice(line);
        }
    }
}

fn place(svg: &mut Svg, png: &[u8], [x, y]: [f64; 2], [wide, high]: [f64; 2]) {
    svg.raw(&format!(
        "<image x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" preserveAspectRatio=\"none\" style=\"image-rendering:pixelated\" \
         href=\"data:image/png;base64,{}\"/>",
        coordinate(x),
        coordinate(y),
        coordinate(wide),
        coordinate(high),
        base64::engine::general_purpose::STANDARD.encode(png)
    ));
}
