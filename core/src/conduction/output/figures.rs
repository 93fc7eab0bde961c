//! Pictures of an answer.

use crate::conduction::ashby::{Ashby, PATTERNS};
use crate::conduction::case::{Answer, Problem};
use crate::conduction::mesh::VOID;
use crate::conduction::strip::{Model, Strip};
use crate::input::{ConductionInput, ThresholdOf};
use crate::materials::Assumption;
use crate::report::ReportError;
use crate::report::conduction::{
    AshbyPicture, Cloud, Curve, FieldPanel, FieldPicture, HistoryPicture, ashby_svg, field_svg, history_svg,
};
use crate::report::number;

/// Sentences every caption ends with.
fn closing(answer: &Answer) -> Vec<String> {
    let notes = answer.notes.iter().cloned();
    notes.chain(answer.assumptions.iter().map(|a| capital(&Assumption::line(a)))).collect()
}

fn capital(line: &str) -> String {
    let mut letters = line.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).chain(['.']).collect())
}

/// Fields at the times that were asked for, and in the long run.
pub(super) fn fields(strip: &Strip, answer: &Answer, title: &str) -> Result<Option<String>, ReportError> {
    let mut panels = Vec::new();
    if let Some(transient) = &answer.transient {
        let maps: Vec<Vec<f64>> = transient.fields.iter().map(|f| mid_plane(strip, f)).collect();
        let range = range(maps.iter().flatten());
        for (time, values) in transient.field_times_s.iter().zip(maps) {
            panels.push(FieldPanel { heading: format!("after {} s", number(*time, 4)), values, range });
        }
    }
    if let Some(steady) = &answer.steady {
        let values = mid_plane(strip, &steady.field);
        let heading = match answer.problem {
            Problem::Heat => "steady, the far end kept at the start temperature",
            Problem::Current => "steady",
        };
        panels.push(FieldPanel { heading: heading.to_owned(), range: range(values.iter()), values });
    }
    if panels.is_empty() {
        return Ok(None);
    }
    let [along, _, across] = strip.mesh.cells();
    let width = strip.mesh.widest();
    let mut caption = vec![
        "The mid-plane from above, unrolled: arc length to the right, width upwards; every brick has the mean of its corners."
            .to_owned(),
    ];
    if answer.model == Model::Graded {
        caption.push("The width is drawn as if it were constant.".to_owned());
    }
    caption.extend(closing(answer));
    let picture = FieldPicture {
        title: title.to_owned(),
        unit: answer.problem.field()[1].to_owned(),
        cells: [along, across],
        size_mm: [strip.length_mm, width],
        panels,
        caption,
    };
    field_svg(&picture).map(Some)
}

fn range<'a>(values: impl Iterator<Item = &'a f64>) -> [f64; 2] {
    let [low, high] = values
        .filter(|v| v.is_finite())
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| [low.min(*v), high.max(*v)]);
    if low <= high { [low, high] } else { [0.0, 1.0] }
}

/// Means of bricks' corners on the mid-plane; NaN where it is void.
fn mid_plane(strip: &Strip, field: &[f64]) -> Vec<f64> {
    let mesh = &strip.mesh;
    let [along, layers, across] = mesh.cells();
    let levels = [layers / 2, layers.div_ceil(2)];
    let mut values = Vec::with_capacity(along * across);
    for i in 0..along {
        for j in 0..across {
            let cell = (i * layers + layers / 2) * across + j;
            values.push(if mesh.materials()[cell] == VOID {
                f64::NAN
            } else {
                let corner = |n: usize| field[mesh.node([i + (n >> 2), levels[n >> 1 & 1], j + (n & 1)])];
                (0..8).map(corner).sum::<f64>() / 8.0
            });
        }
    }
    values
}

/// Values at the measuring points over time.
pub(super) fn history(input: &ConductionInput, answer: &Answer, title: &str) -> Result<Option<String>, ReportError> {
    let Some(transient) = &answer.transient else { return Ok(None) };
    let share = |s: f64| format!("s = {} L", number(s, 4));
    let mut names: Vec<String> = answer.measured_at.iter().map(|s| share(*s)).collect();
    if answer.problem == Problem::Current {
        names.insert(0, "rim".to_owned());
    }
    let steady = answer.steady.as_ref();
    let threshold = match answer.problem {
        Problem::Heat => {
            let (start, rim) = (input.start_temperature_k, input.rim_temperature_k);
            Some(start + input.rise_at_threshold() * (rim - start))
        }
        Problem::Current => transient.critical_times_s[0].and(steady).map(|s| (1.0 - input.plateau) * s.difference),
    };
    let curve = |(n, name): (usize, &String)| {
        let values = &transient.history[n];
        let critical = transient.critical_times_s.get(n).copied().flatten();
        Curve {
            name: match critical {
                Some(time) => format!("{name}: {} s", number(time, 5)),
                None => name.clone(),
            },
            points: transient.times.iter().zip(values).map(|(t, v)| [*t, *v]).collect(),
            mark: critical.zip(threshold).map(|(time, value)| [time, value]),
        }
    };
    let curves = names.iter().enumerate().map(curve).collect();
    let (threshold_text, quantity) = match answer.problem {
        Problem::Heat => {
            let of = match input.threshold_of {
                ThresholdOf::Rise => "of the rise",
                ThresholdOf::Value => "of the absolute temperature",
            };
            (
                format!("Dashed: {} % {of}, the critical time in the legend.", number(100.0 * input.threshold, 6)),
                "temperature, K",
            )
        }
        Problem::Current => (
            format!(
                "Dashed: {} % off the steady potential, the critical time in the legend.",
                number(100.0 * input.plateau, 4)
            ),
            "potential, V",
        ),
    };
    let mut caption = vec![threshold_text];
    let unit = match answer.problem {
        Problem::Heat => "W/(m K)",
        Problem::Current => "S/m",
    };
    let by_time = transient.effective_conductivities.last().copied().flatten();
    if let (Some(steady), Some(by_time)) = (steady, by_time) {
        caption.push(format!(
            "Effective conductivity: {} {unit} by steady flow, {} {unit} by time.",
            number(steady.effective_conductivity, 4),
            number(by_time, 4)
        ));
    }
    caption.extend(closing(answer));
    let picture = HistoryPicture { title: title.to_owned(), quantity: quantity.to_owned(), curves, threshold, caption };
    history_svg(&picture).map(Some)
}

/// Modulus against conductivity.
///
/// Neither is assumed, so its caption names no assumption.
pub(super) fn ashby(chart: &Ashby) -> Result<String, ReportError> {
    let mut clouds: Vec<Cloud> = chart
        .phases
        .iter()
        .map(|(name, modulus, k)| Cloud { name: name.clone(), points: vec![[*modulus, *k]], radius: 7.0 })
        .collect();
    for pattern in PATTERNS {
        let name = serde_json::to_value(pattern).unwrap_or_default();
        let points = chart.mixtures.iter().filter(|m| m.pattern == pattern);
        clouds.push(Cloud {
            name: name.as_str().unwrap_or_default().to_owned(),
            points: points.map(|m| [m.modulus_mpa, m.conductivity]).collect(),
            radius: 3.6,
        });
    }
    let outline = |lower: &dyn Fn(usize) -> [f64; 2], upper: &dyn Fn(usize) -> [f64; 2]| {
        let n = chart.bounds.len();
        (0..n).map(lower).chain((0..n).rev().map(upper)).collect::<Vec<_>>()
    };
    let b = &chart.bounds;
    let outlines = [
        outline(&|i| [b[i].modulus_mpa[0], b[i].conductivity[0]], &|i| [b[i].modulus_mpa[1], b[i].conductivity[1]]),
        outline(&|i| [b[i].isotropic_modulus_mpa[0], b[i].isotropic_conductivity[0]], &|i| {
            [b[i].isotropic_modulus_mpa[1], b[i].isotropic_conductivity[1]]
        }),
    ];
    let picture = AshbyPicture {
        title: format!("Young’s modulus against {}", chart.quantity),
        quantity: format!("{}, {}", chart.quantity, chart.unit),
        clouds,
        outlines,
        caption: vec![
            "Coupons of 20 × 6 × 2 mm, voxels of 0.5 mm, nine fractions a pattern. Modulus by Voigt’s rule in every slice, \
             conductivity by steady flow along the coupon. Patterns that line up along it coincide."
                .to_owned(),
            "Light: between Reuss (series) and Voigt (parallel) at equal fractions; darker: between Hashin and Shtrikman’s bounds \
             for isotropic mixtures. Voigt’s rule overstates the modulus of random mixtures: they belong further left."
                .to_owned(),
        ],
    };
    ashby_svg(&picture)
}
