//! The two plots of unit cells: modulus over fraction between its bounds, and the departure from Voigt's rule.

use std::collections::BTreeSet;

use super::ReportError;
use super::chart::{Axis, Chart, LEFT, Layer, bounds};
use super::figures::WIDTH;
use super::palette::{INK, MEASURED, MUTED, PREDICTED, SHADE};
use super::svg::{Anchor, Stroke, Svg};
use super::text::number;
use crate::micromechanics::unit_cell::{BrickKind, Catalogue, Departure, LoadedFaces};
use crate::micromechanics::{hashin_shtrikman, reuss, voigt};

/// Space for title and legend.
const HEAD: f64 = 92.0;
/// Points of a smooth curve.
const CURVE: usize = 101;
/// Dots closer than this share of the axis are drawn once.
const APART: f64 = 1.0 / 600.0;

const VOIGT: Stroke = Stroke::solid(INK, 1.4);
const REUSS: Stroke = Stroke::dashed(INK, 1.4, [6.0, 4.0]);
const SHTRIKMAN: Stroke = Stroke::dashed(MUTED, 1.2, [2.0, 3.0]);
const MEAN: Stroke = Stroke::solid(PREDICTED, 1.6);
const THROUGH: Stroke = Stroke::solid(MEASURED, 1.6);

/// What an entry of the legend shows.
enum Mark {
    Line(Stroke),
    Dot(super::palette::Colour),
    Patch,
}

/// Modulus of every layout over the fraction of the rigid phase, normalised by the rigid phase's, as an SVG file.
///
/// # Errors
/// [`ReportError`] where a modulus is not a number.
pub fn moduli_svg(cells: &Catalogue) -> Result<String, ReportError> {
    let [soft, rigid] = cells.phases();
    let moduli = [soft.modulus_mpa, rigid.modulus_mpa];
    let scale = 1.0 / moduli[0].max(moduli[1]);
    let curve = |value: &dyn Fn(f64) -> f64| -> Vec<[f64; 2]> {
        (0..CURVE).map(|i| i as f64 / (CURVE - 1) as f64).map(|f| [f, scale * value(f)]).collect()
    };
    let upper = curve(&|f| voigt(&[1.0 - f, f], &moduli));
    let lower = curve(&|f| reuss(&[1.0 - f, f], &moduli));
    let range: Vec<[f64; 2]> = upper.iter().chain(lower.iter().rev()).copied().collect();
    let dots = |axes: &[usize], shift: f64| -> Vec<[f64; 2]> {
        let at = |f: f64, e: f64| ((f / APART).round() as i64, (scale * e / APART).round() as i64);
        let places: BTreeSet<(i64, i64)> = cells
            .classes()
            .flat_map(|row| axes.iter().map(move |axis| at(row.rigid_fraction, row.moduli_mpa[*axis])))
            .collect();
        places.into_iter().map(|(f, e)| [f as f64 * APART + shift, e as f64 * APART]).collect()
    };
    let chart = Chart {
        figure: "unit cells",
        size: [WIDTH, 430.0],
        x: Axis::new("volume fraction of the rigid phase", [-0.02, 1.02], 11),
        y: Axis::new("modulus over that of the rigid phase, E / Er", [0.0, 1.04], 10),
        layers: vec![
            Layer::Area(range, SHADE, 1.0),
            Layer::Line(upper, VOIGT),
            Layer::Line(lower, REUSS),
            Layer::Line(curve(&|f| hashin_shtrikman(soft, rigid, f).0), SHTRIKMAN),
            Layer::Line(curve(&|f| hashin_shtrikman(soft, rigid, f).1), SHTRIKMAN),
            Layer::Dots(dots(&[0, 1], 0.0), 1.8, PREDICTED),
            Layer::Dots(dots(&[2], 0.0), 2.6, MEASURED),
        ],
    };
    let legend = [
        (Mark::Dot(PREDICTED), "along x and y"),
        (Mark::Dot(MEASURED), "along z"),
        (Mark::Line(VOIGT), "Voigt"),
        (Mark::Line(REUSS), "Reuss"),
        (Mark::Line(SHTRIKMAN), "Hashin-Shtrikman"),
    ];
    framed(cells, "Young's modulus of every layout", &legend, &chart)
}

/// Departure of the moduli from Voigt's rule over the fraction, least, mean and most, as an SVG file.
///
/// # Errors
/// [`ReportError`] where a modulus is not a number.
pub fn departure_svg(cells: &Catalogue) -> Result<String, ReportError> {
    let [soft, rigid] = cells.phases();
    let moduli = [soft.modulus_mpa, rigid.modulus_mpa];
    let departures = cells.departures();
    let line = |value: &dyn Fn(&Departure) -> f64| -> Vec<[f64; 2]> {
        departures.iter().map(|d| [d.rigid_fraction, 100.0 * value(d)]).collect()
    };
    let (least, most) = (line(&|d| d.in_plane[0]), line(&|d| d.in_plane[2]));
    let spread: Vec<[f64; 2]> = most.iter().chain(least.iter().rev()).copied().collect();
    let below = |value: &dyn Fn(f64) -> f64| -> Vec<[f64; 2]> {
        (0..CURVE)
            .map(|i| i as f64 / (CURVE - 1) as f64)
            .map(|f| [f, 100.0 * (value(f) / voigt(&[1.0 - f, f], &moduli) - 1.0)])
            .collect()
    };
    let lower = below(&|f| reuss(&[1.0 - f, f], &moduli));
    let mean = line(&|d| d.in_plane[1]);
    let through = line(&|d| d.across[1]);
    let y = bounds(lower.iter().chain(&spread).chain(&through).map(|p| p[1]), 0.05);
    let chart = Chart {
        figure: "departure from Voigt",
        size: [WIDTH, 360.0],
        x: Axis::new("volume fraction of the rigid phase", [-0.02, 1.02], 11),
        y: Axis::new("departure from Voigt's rule, %", y, 9),
        layers: vec![
            Layer::Area(spread, PREDICTED, 0.16),
            Layer::Line(below(&|_| 0.0).into_iter().map(|[f, _]| [f, 0.0]).collect(), VOIGT),
            Layer::Line(lower, REUSS),
            Layer::Line(below(&|f| hashin_shtrikman(soft, rigid, f).0), SHTRIKMAN),
            Layer::Line(below(&|f| hashin_shtrikman(soft, rigid, f).1), SHTRIKMAN),
            Layer::Line(mean.clone(), MEAN),
            Layer::Dots(mean, 2.6, PREDICTED),
            Layer::Line(through.clone(), THROUGH),
            Layer::Dots(through, 2.6, MEASURED),
        ],
    };
    let legend = [
        (Mark::Line(MEAN), "x and y, mean"),
        (Mark::Patch, "least to most"),
        (Mark::Line(THROUGH), "z, mean"),
        (Mark::Line(VOIGT), "Voigt"),
        (Mark::Line(REUSS), "Reuss"),
        (Mark::Line(SHTRIKMAN), "Hashin-Shtrikman"),
    ];
    framed(cells, "Departure of the modulus from Voigt's rule", &legend, &chart)
}

/// The chart below its title and legend.
fn framed(cells: &Catalogue, title: &str, legend: &[(Mark, &str)], chart: &Chart) -> Result<String, ReportError> {
    let [soft, rigid] = cells.phases();
    let phase = |m: &crate::materials::Material| {
        format!("{} ({} MPa, ν = {})", m.name, number(m.modulus_mpa, 4), number(m.poisson, 3))
    };
    let mesh = cells.mesh();
    let n = mesh.elements_per_voxel;
    let element = match mesh.element {
        BrickKind::Enhanced => "bricks with enhanced strains",
        BrickKind::Trilinear => "trilinear bricks",
    };
    let faces = match mesh.faces {
        LoadedFaces::Sliding => "loaded faces free to slide",
        LoadedFaces::Clamped => "loaded faces clamped",
    };
    let summary = format!(
        "{} cells, {} layouts, of {} and {}",
        cells.size().name(),
        cells.size().layouts(),
        phase(soft),
        phase(rigid)
    );
    let mut svg = Svg::new(WIDTH, HEAD + chart.size[1]);
    svg.text([LEFT, 24.0], Anchor::Start, 16.0, INK, title);
    svg.text([LEFT, 43.0], Anchor::Start, 12.0, MUTED, &summary.chars().take(115).collect::<String>());
    let second = format!("{n} × {n} × {n} {element} a voxel, {faces}");
    svg.text([LEFT, 59.0], Anchor::Start, 12.0, MUTED, &second);
    let column = (WIDTH - LEFT - 20.0) / legend.len() as f64;
    for (k, (mark, text)) in legend.iter().enumerate() {
        let x = LEFT + k as f64 * column;
        match mark {
            Mark::Line(stroke) => svg.line([x, 78.0], [x + 18.0, 78.0], stroke),
            Mark::Dot(colour) => svg.circle([x + 12.0, 78.0], 3.0, &format!("fill=\"{}\"", colour.hex())),
            Mark::Patch => {
                let fill = format!("fill=\"{}\" fill-opacity=\"0.16\"", PREDICTED.hex());
                svg.rectangle([x + 4.0, 72.0], [14.0, 12.0], &fill);
            }
        }
        svg.text([x + 23.0, 82.0], Anchor::Start, 11.5, INK, text);
    }
    svg.place([0.0, HEAD], &chart.draw()?);
    Ok(svg.standalone(&format!("{title}: {summary}")))
}
