//! Conduction as CSV. Lines that begin with `#` name what is assumed.

use std::io::{self, Write};

use crate::conduction::ashby::Ashby;
use crate::conduction::case::{Answer, Problem};
use crate::conduction::steady::plane_nodes;
use crate::conduction::strip::Strip;
use crate::materials::Assumption;
use crate::output::tables::number;

fn head<'a>(out: &mut dyn Write, assumptions: impl Iterator<Item = &'a Assumption>) -> io::Result<()> {
    let mut lines: Vec<String> = Vec::new();
    for line in assumptions.map(Assumption::line) {
        if !lines.contains(&line) {
            writeln!(out, "# {line}")?;
            lines.push(line);
        }
    }
    Ok(())
}

/// A number in its shortest form; nothing where there is none.
fn cell(value: Option<f64>) -> String {
    match value {
        Some(value) if value != 0.0 && !(1e-6..1e9).contains(&value.abs()) => format!("{value:.9e}"),
        Some(value) => number(value),
        None => String::new(),
    }
}

/// One row a case: the figures that sum it up.
pub(super) fn cases(cases: &[(&Strip, Answer)], out: &mut dyn Write) -> io::Result<()> {
    head(out, cases.iter().flat_map(|(_, a)| &a.assumptions))?;
    let mut csv = csv::Writer::from_writer(out);
    csv.write_record([
        "case",
        "unit",
        "flow",
        "difference",
        "effective_by_flow",
        "series_bound",
        "parallel_bound",
        "critical_time_s",
        "effective_by_time",
        "imbalance",
        "contrast",
        "iterations",
    ])?;
    for (_, answer) in cases {
        let unit = match answer.problem {
            Problem::Heat => "W/(m K)",
            Problem::Current => "S/m",
        };
        let steady = answer.steady.as_ref();
        let transient = answer.transient.as_ref();
        csv.write_record([
            super::stem(answer),
            unit.to_owned(),
            cell(steady.map(|s| s.flow)),
            cell(steady.map(|s| s.difference)),
            cell(steady.map(|s| s.effective_conductivity)),
            cell(steady.map(|s| s.series_bound)),
            cell(steady.map(|s| s.parallel_bound)),
            cell(transient.and_then(|t| *t.critical_times_s.last()?)),
            cell(transient.and_then(|t| *t.effective_conductivities.last()?)),
            cell(steady.map(|s| s.imbalance)),
            cell(steady.map(|s| s.contrast)),
            steady.map_or_else(String::new, |s| s.iterations.to_string()),
        ])?;
    }
    csv.flush()
}

/// Values at the measuring points over time.
pub(super) fn history(answer: &Answer, out: &mut dyn Write) -> io::Result<()> {
    let Some(transient) = &answer.transient else { return Ok(()) };
    head(out, answer.assumptions.iter())?;
    let [field, unit] = answer.problem.field();
    let unit = unit.to_lowercase();
    let mut header = vec!["time_s".to_owned()];
    if answer.problem == Problem::Current {
        header.push(format!("{field}_rim_{unit}"));
    }
    header.extend(answer.measured_at.iter().map(|share| format!("{field}_{}_{unit}", number(*share))));
    let mut csv = csv::Writer::from_writer(out);
    csv.write_record(&header)?;
    for (n, time) in transient.times.iter().enumerate() {
        let values = transient.history.iter().map(|row| cell(row.get(n).copied()));
        csv.write_record(std::iter::once(cell(Some(*time))).chain(values))?;
    }
    csv.flush()
}

/// Means over cross-sections along the strip.
pub(super) fn profile(strip: &Strip, answer: &Answer, out: &mut dyn Write) -> io::Result<()> {
    head(out, answer.assumptions.iter())?;
    let [field, unit] = answer.problem.field();
    let unit = unit.to_lowercase();
    let mut header = vec!["s_mm".to_owned()];
    let mut fields: Vec<&[f64]> = Vec::new();
    if let Some(transient) = &answer.transient {
        for (time, values) in transient.field_times_s.iter().zip(&transient.fields) {
            header.push(format!("{field}_at_{time}_s_{unit}"));
            fields.push(values);
        }
    }
    if let Some(steady) = &answer.steady {
        header.push(format!("{field}_steady_{unit}"));
        fields.push(&steady.field);
    }
    let mut csv = csv::Writer::from_writer(out);
    csv.write_record(&header)?;
    let mesh = &strip.mesh;
    let used = mesh.used_nodes();
    for plane in 0..=mesh.cells()[0] {
        let nodes: Vec<usize> = plane_nodes(mesh, plane).filter(|n| used[*n]).collect();
        let mean = |values: &&[f64]| nodes.iter().map(|n| values[*n]).sum::<f64>() / nodes.len().max(1) as f64;
        let s = strip.length_mm * plane as f64 / mesh.cells()[0] as f64;
        csv.write_record(std::iter::once(number(s)).chain(fields.iter().map(|v| cell(Some(mean(v))))))?;
    }
    csv.flush()
}

/// The chart of modulus against conductivity: phases, mixtures, bounds.
pub(super) fn ashby(chart: &Ashby, out: &mut dyn Write) -> io::Result<()> {
    let mut csv = csv::Writer::from_writer(out);
    let unit = chart.unit.to_lowercase().replace("/(m k)", "_mk").replace("s/m", "s_m");
    csv.write_record(["kind", "name", "rigid_fraction", "modulus_mpa", &format!("conductivity_{unit}")])?;
    let mut row = |kind: &str, name: &str, fraction: f64, modulus: f64, k: f64| {
        csv.write_record([kind, name, &number(fraction), &cell(Some(modulus)), &cell(Some(k))])
    };
    for (n, (name, modulus, k)) in chart.phases.iter().enumerate() {
        row("phase", name, n as f64, *modulus, *k)?;
    }
    for mix in &chart.mixtures {
        let name = serde_json::to_value(mix.pattern).unwrap_or_default();
        row("mixture", name.as_str().unwrap_or_default(), mix.rigid_fraction, mix.modulus_mpa, mix.conductivity)?;
    }
    for b in &chart.bounds {
        for (name, side) in [("lower", 0), ("upper", 1)] {
            row("reuss-voigt", name, b.rigid_fraction, b.modulus_mpa[side], b.conductivity[side])?;
            let isotropic = (b.isotropic_modulus_mpa[side], b.isotropic_conductivity[side]);
            row("hashin-shtrikman", name, b.rigid_fraction, isotropic.0, isotropic.1)?;
        }
    }
    csv.flush()
}
