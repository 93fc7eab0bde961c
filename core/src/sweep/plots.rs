//! Pictures of a table.

use serde_json::Value;

use super::input::PlotInput;
use super::outputs::describe;
use super::table::{Status, Table, text};
use crate::error::Error;
use crate::input::parameters::parameter;
use crate::report::sweep::{SweepCurve, SweepPicture, sweep_svg};

/// Most pictures that are drawn without being asked for.
const MOST_PICTURES: usize = 12;
/// Most values of an axis that have colours of their own.
const MOST_COLOURS: usize = 8;
/// Points that a picture shows at most.
const MOST_POINTS: u64 = 20_000;

/// The pictures of a table, by name.
///
/// # Errors
/// [`Error::Internal`] where one cannot be drawn.
pub fn pictures(table: &Table<'_>) -> Result<Vec<(String, String)>, Error> {
    let input = table.sweep().input();
    let asked = if input.plots.is_empty() { unasked(table) } else { input.plots.clone() };
    let mut all = Vec::new();
    for plot in asked {
        let Some(picture) = picture(table, &plot) else { continue };
        let svg = sweep_svg(&picture).map_err(|e| Error::Internal(format!("a picture of the sweep: {e}")))?;
        let name = format!("{}_over_{}", plot.y, plot.x).replace('.', "_");
        all.push((name, svg));
    }
    Ok(all)
}

/// Every figure over the first axis that has numbers, coloured by the next axis with few values.
fn unasked(table: &Table<'_>) -> Vec<PlotInput> {
    let input = table.sweep().input();
    let first = table.sweep().values(0);
    let Some(x) = first.iter().position(Value::is_number) else { return Vec::new() };
    let few = |k: usize| input.axes[k].values.as_ref().map_or(input.axes[k].count, |v| Some(v.len() as u64));
    let series = (0..input.axes.len()).find(|k| *k != x && few(*k).is_some_and(|n| n <= MOST_COLOURS as u64));
    let plot = |y: &String| PlotInput {
        x: input.axes[x].key.clone(),
        y: y.clone(),
        series: series.map(|k| input.axes[k].key.clone()),
        logarithmic: false,
    };
    input.outputs.iter().take(MOST_PICTURES).map(plot).collect()
}

/// A column by its name.
enum Column {
    Axis(usize),
    Figure(usize),
}

fn column(table: &Table<'_>, name: &str) -> Option<Column> {
    let input = table.sweep().input();
    let axis = input.axes.iter().position(|a| a.key == name).map(Column::Axis);
    axis.or_else(|| input.outputs.iter().position(|o| o == name).map(Column::Figure))
}

fn picture(table: &Table<'_>, plot: &PlotInput) -> Option<SweepPicture> {
    let sweep = table.sweep();
    let (x, y) = (column(table, &plot.x)?, column(table, &plot.y)?);
    let series = plot.series.as_ref().and_then(|name| sweep.input().axes.iter().position(|a| a.key == *name));
    // Points that agree in all axes but x lie on one line.
    let lines = matches!(x, Column::Axis(_)) && sweep.input().sample == super::input::SampleInput::Grid;
    let mut curves: Vec<(Vec<String>, SweepCurve)> = Vec::new();
    let step = sweep.points().div_ceil(MOST_POINTS).max(1);
    for point in (0..sweep.points()).step_by(step as usize).filter(|p| table.status(*p) == Status::Ok) {
        let values = sweep.values(point);
        let of = |column: &Column| match column {
            Column::Axis(k) => values[*k].as_f64().unwrap_or(f64::NAN),
            Column::Figure(k) => table.figure(*k, point),
        };
        let at = [of(&x), of(&y)];
        if !at.iter().all(|v| v.is_finite() && (!plot.logarithmic || *v > 0.0)) {
            continue;
        }
        let name = series.map_or_else(String::new, |k| text(&values[k]));
        let group: Vec<String> = match (&x, lines) {
            (Column::Axis(k), true) => {
                values.iter().enumerate().filter(|(i, _)| i != k).map(|(_, v)| text(v)).collect()
            }
            _ => vec![name.clone()],
        };
        match curves.iter_mut().find(|(g, _)| *g == group) {
            Some((_, curve)) => curve.points.push(at),
            None => curves.push((group, SweepCurve { name, points: vec![at] })),
        }
    }
    let heading = series.map_or_else(String::new, |k| format!("Colours: {}.", sweep.input().axes[k].key));
    let infeasible = table.count(Status::Infeasible);
    let mut caption = vec![heading];
    if infeasible > 0 {
        caption.push(format!("{infeasible} of {} points are infeasible and not shown.", sweep.points()));
    }
    Some(SweepPicture {
        title: format!("{}: {}", sweep.input().name, describe(&plot.y)),
        axes: [label(&plot.x), label(&plot.y)],
        curves: curves.into_iter().map(|(_, curve)| curve).collect(),
        lines,
        logarithmic: plot.logarithmic,
        caption: caption.into_iter().filter(|s| !s.is_empty()).collect(),
    })
}

/// A column with its unit.
fn label(name: &str) -> String {
    match parameter(name).and_then(|p| p.unit) {
        Some(unit) => format!("{name}, {unit}"),
        None => name.to_owned(),
    }
}
