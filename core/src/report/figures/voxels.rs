//! The voxels of one spoke from above.

use super::flower::scale_bar;
use super::{Figure, Frame, Mark, WIDTH, phase_legend};
use crate::design::Design;
use crate::report::cells::Cells;
use crate::report::palette::{INK, MUTED};
use crate::report::svg::{Anchor, Svg};
use crate::report::text::{coordinate, number};

/// Room above a panel for its heading, and below it for the ends' names.
const HEADING: f64 = 26.0;
const FOOT: f64 = 22.0;
const GAP: f64 = 28.0;
/// Highest panel.
const MOST: f64 = 470.0;
/// Lowest panel that can be seen.
const LEAST: f64 = 3.0;

/// The figure.
#[must_use]
pub fn figure(design: &Design) -> Figure {
    let grid = design.grid();
    let most = grid.half_widths().iter().copied().max().unwrap_or(1);
    let phases = design.phases().phases().len();
    let mut mean = Cells::new(grid.slices(), 2 * most, phases);
    let mut top = Cells::new(grid.slices(), 2 * most, phases);
    // Whether some column differs between layers, before cells are merged.
    let mut varied = false;
    for (i, half) in grid.half_widths().iter().enumerate() {
        let (width, slice) = (2 * half, grid.slice(i));
        // The most negative y is at the bottom of the picture.
        let row = |across: usize| most + half - 1 - across;
        let last = slice.len() - width;
        for (place, phase) in slice.iter().enumerate() {
            let across = place % width;
            mean.add(i, row(across), *phase);
            varied |= *phase != slice[last + across];
            if place >= last {
                top.add(i, row(across), *phase);
            }
        }
    }
    let length = grid.slices() as f64 * grid.size_mm();
    let widest = 2.0 * most as f64 * grid.size_mm();
    let panels = if varied {
        vec![("mean through the thickness", &mean), ("top layer", &top)]
    } else {
        vec![(if grid.layers() > 1 { "all layers alike" } else { "single layer" }, &mean)]
    };
    let (svg, exaggerated) = draw(&panels, [length, widest], grid.size_mm(), Frame::of(design.input()).ends());
    let mut caption = format!(
        "One spoke of {} slices, flat, seen from above, in voxels of {} mm; {} layer{} through the thickness.",
        grid.slices(),
        number(grid.size_mm(), 4),
        grid.layers(),
        if grid.layers() == 1 { "" } else { "s" },
    );
    if design.input().is_strip() {
        caption = caption.replace("One spoke of", "The strip of");
    }
    let [along, across] = mean.merged();
    if along > 1 || across > 1 {
        caption.push_str(&format!(" For drawing, {along} × {across} voxels are merged into a cell of their mean."));
    }
    if design.input().voxels.pattern.alternates() && !design.input().is_strip() {
        caption.push_str(" Every second spoke is the mirror image of this one.");
    }
    if exaggerated {
        caption.push_str(" The shorter side is exaggerated.");
    }
    let mut legend = phase_legend(design);
    if mean.is_mixed() || top.is_mixed() {
        legend.push((Mark::Ramp, "mean of several voxels".to_owned()));
    }
    Figure { title: "Voxels", legend, drawings: vec![svg], caption }
}

/// Panels side by side where spokes are broad, one below the other where they are slender.
fn draw(panels: &[(&str, &Cells)], [length, width]: [f64; 2], voxel: f64, ends: [&str; 2]) -> (Svg, bool) {
    let beside = panels.len() > 1 && width > 0.35 * length;
    let room = if beside { 0.5 * (WIDTH - GAP) } else { WIDTH };
    let scale = (room / length).min(MOST / width);
    let true_size = [scale * length, scale * width];
    let [across, high] = true_size.map(|side| side.max(LEAST));
    let step = HEADING + high + FOOT + if beside { 0.0 } else { 14.0 };
    let rows = if beside { 1 } else { panels.len() };
    let mut svg = Svg::new(WIDTH, step * rows as f64 + 34.0);
    for (k, (heading, cells)) in panels.iter().enumerate() {
        let [x, y] = if beside { [k as f64 * (room + GAP), 0.0] } else { [0.0, k as f64 * step] };
        svg.text([x, y + 14.0], Anchor::Start, 12.5, INK, heading);
        // Merged cells at the end may reach a little beyond the strip.
        let [along, thick] = cells.merged().map(|n| n as f64 * voxel);
        place_cells(&mut svg, cells, [x, y + HEADING], [along * across / length, thick * high / width]);
        let below = y + HEADING + high + 15.0;
        if across > 90.0 {
            svg.text([x, below], Anchor::Start, 12.0, MUTED, ends[0]);
            svg.text([x + across, below], Anchor::End, 12.0, MUTED, ends[1]);
        } else {
            svg.text(
                [x, below],
                Anchor::Start,
                12.0,
                MUTED,
                &format!("{} to the left, {} to the right", ends[0], ends[1]),
            );
        }
    }
    scale_bar(&mut svg, [1.0, step * rows as f64 + 10.0], scale, 160.0);
    (svg, true_size != [across, high])
}

/// Draws cells of the given size, the upper left corner of the first at `x`, `y`.
pub fn place_cells(svg: &mut Svg, cells: &Cells, [x, y]: [f64; 2], [dx, dy]: [f64; 2]) {
    svg.raw(&format!(
        "<g transform=\"translate({} {}) scale({dx:.5} {dy:.5}) translate(0 .5)\" fill=\"none\" stroke-width=\"1\" \
         shape-rendering=\"crispEdges\">",
        coordinate(x),
        coordinate(y)
    ));
    svg.raw(cells.markup().trim_end());
    svg.raw("</g>");
}
