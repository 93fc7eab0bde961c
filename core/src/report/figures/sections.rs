//! Cross-sections of the voxelised strip.

use super::flower::scale_bar;
use super::voxels::place_cells;
use super::{Figure, WIDTH, phase_legend};
use crate::design::Design;
use crate::report::cells::Cells;
use crate::report::palette::{INK, MUTED};
use crate::report::svg::{Anchor, Svg};
use crate::report::text::{number, whole};

/// Room for the names at the left.
const LEFT: f64 = 150.0;
/// Highest section.
const MOST_HEIGHT: f64 = 70.0;
/// Lowest section that can be read.
const LEAST_HEIGHT: f64 = 6.0;
/// Least distance from one section to the next.
const LEAST_STEP: f64 = 50.0;

/// The figure.
#[must_use]
pub fn figure(design: &Design) -> Figure {
    let grid = design.grid();
    let last = grid.slices().saturating_sub(1);
    let mut chosen = vec![0, last / 4, last / 2, last * 3 / 4, last];
    chosen.dedup();
    let size = grid.size_mm();
    let widest = chosen.iter().map(|i| 2 * grid.half_widths()[*i]).max().unwrap_or(2) as f64 * size;
    let thickness = grid.layers() as f64 * size;
    let scale = ((WIDTH - LEFT) / widest).min(MOST_HEIGHT / thickness);
    let high = (scale * thickness).max(LEAST_HEIGHT);
    let step = (high + 20.0).max(LEAST_STEP);
    let centre = LEFT + 0.5 * (WIDTH - LEFT).min(scale * widest);
    let mut svg = Svg::new(WIDTH, step * chosen.len() as f64 + 30.0);
    let mut merged = false;
    for (k, i) in chosen.iter().enumerate() {
        let slice = &design.slices()[*i];
        let width = 2 * slice.half_width;
        let middle = step * (k as f64 + 0.5);
        let name = match (design.input().is_strip(), *i) {
            (true, _) => "",
            (false, 0) => "rim, ",
            (false, i) if i == last => "hub, ",
            (false, _) => "",
        };
        let label = format!("{name}s = {} mm", number(slice.s_mm, 5));
        let modulus = format!("{} MPa, {} × {}", number(slice.modulus_mpa, 3), whole(width as u64), grid.layers());
        svg.text([0.0, middle - 3.0], Anchor::Start, 12.5, INK, &label);
        svg.text([0.0, middle + 13.0], Anchor::Start, 12.0, MUTED, &modulus);
        let mut cells = Cells::new(width, grid.layers(), design.phases().phases().len());
        for (place, phase) in grid.slice(*i).iter().enumerate() {
            cells.add(place % width, grid.layers() - 1 - place / width, *phase);
        }
        merged |= cells.merged() != [1, 1];
        let across = scale * width as f64 * size;
        let corner = [centre - 0.5 * across, middle - 0.5 * high];
        let [wide, thick] = cells.merged().map(|n| n as f64 * size);
        place_cells(&mut svg, &cells, corner, [wide * scale, thick * high / thickness]);
    }
    scale_bar(&mut svg, [LEFT, step * chosen.len() as f64 + 8.0], scale, 140.0);
    let seen = if design.input().is_strip() { "along s" } else { "from the rim towards the hub" };
    let mut caption =
        format!("Cross-sections, each one voxel long, seen {seen}: modulus, number of voxels across and of layers.");
    if merged {
        caption.push_str(" For drawing, neighbouring voxels are merged into cells of their mean.");
    }
    caption.push_str(if high > 1.001 * scale * thickness {
        " The thickness is exaggerated: it would not be readable."
    } else {
        " Width and thickness are to scale."
    });
    Figure { title: "Cross-sections", legend: phase_legend(design), drawings: vec![svg], caption }
}
