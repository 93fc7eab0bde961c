//! The tables at the end of a report: inputs, modulus expression, materials and files.

use serde_json::Value;

use super::palette;
use super::text::{escape, number, whole};
use crate::design::Design;
use crate::input::DesignInput;
use crate::input::parameters::PARAMETERS;
use crate::materials::{Material, assumptions};
use crate::modulus_field::ModulusField;

/// Entries of a list that are written out.
const MOST_ENTRIES: usize = 24;

/// Every key of the design, defaults filled in.
#[must_use]
pub fn inputs(input: &DesignInput) -> String {
    let document = serde_json::to_value(input).unwrap_or_default();
    let mut rows = String::new();
    for parameter in PARAMETERS.iter().filter(|p| !p.key.starts_with("materials.custom")) {
        let mut value = &document;
        for part in parameter.key.split('.') {
            value = &value[part];
        }
        if value.is_null() || value.as_array().is_some_and(|list| list.is_empty() && parameter.key == "target.meridian")
        {
            continue;
        }
        rows.push_str(&format!(
            "<tr><td><code>{}</code></td><td class=\"value\">{}</td><td>{}</td><td>{}</td></tr>\n",
            parameter.key,
            escape(&shown(value)),
            escape(parameter.unit.unwrap_or("")),
            escape(parameter.description)
        ));
    }
    section(
        "Design inputs",
        "<tr><th>parameter</th><th>value</th><th>unit</th><th>meaning</th></tr>",
        &rows,
        "Defaults filled in.",
    )
}

/// A value as a reader wants it: texts without quotes, whole numbers without decimals, long lists counted.
fn shown(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        Value::Number(number) => match number.as_f64() {
            Some(v) if number.is_f64() => format!("{v}"),
            _ => number.to_string(),
        },
        Value::Array(list) if list.len() > MOST_ENTRIES => format!("{} entries", whole(list.len() as u64)),
        Value::Array(list) if list.is_empty() => "none".to_owned(),
        Value::Array(list) => list.iter().map(shown).collect::<Vec<_>>().join(", "),
        Value::Object(map) => {
            map.iter().map(|(key, value)| format!("{key}: {}", shown(value))).collect::<Vec<_>>().join("; ")
        }
        other => other.to_string(),
    }
}

/// The modulus in closed form.
#[must_use]
pub fn modulus(field: Option<&ModulusField>) -> String {
    let Some(field) = field else { return String::new() };
    let meets = if field.meets_target() { "" } else { ", more than is aimed for" };
    format!(
        "<section>\n<h2>Modulus as one expression</h2>\n<pre>{}</pre>\n<p class=\"hint\">E in {}, {} in mm from the rim along \
         the spoke’s own axis; at most {} % from the designed modulus{meets}.</p>\n</section>\n",
        escape(&field.expression),
        field.unit,
        field.variable,
        number(field.max_error_percent, 2)
    )
}

/// The phases' properties.
#[must_use]
pub fn materials(design: &Design) -> String {
    type Pick = fn(&Material) -> Option<f64>;
    let columns: [(&str, Pick); 11] = [
        ("E, MPa", |m| Some(m.modulus_mpa)),
        ("ν", |m| Some(m.poisson)),
        ("density, kg/m³", |m| m.density_kg_m3),
        ("conductivity, W/(m K)", |m| m.conductivity_w_mk),
        ("specific heat, J/(kg K)", |m| m.specific_heat_j_kgk),
        ("electrical conductivity, S/m", |m| m.electrical_conductivity_s_m),
        ("relative permittivity", |m| m.relative_permittivity),
        ("largest strain", |m| m.max_strain),
        ("scatter of E, %", |m| m.modulus_scatter_percent),
        ("yield strength, MPa", |m| m.yield_strength_mpa),
        ("yield strain", |m| m.yield_strain),
    ];
    let phases = design.phases().phases();
    // Properties that no phase has are left out.
    let columns: Vec<_> = columns.into_iter().filter(|(_, pick)| phases.iter().any(|m| pick(m).is_some())).collect();
    let head: String = columns.iter().map(|(name, _)| format!("<th class=\"n\">{name}</th>")).collect();
    let mut rows = String::new();
    for (i, phase) in phases.iter().enumerate() {
        let assumed = assumptions(phase);
        let cell = |name: &str, value: Option<f64>| {
            let mark =
                if assumed.iter().any(|a| name.starts_with(a.property.describe()[0])) { " (assumed)" } else { "" };
            format!("<td class=\"n\">{}{mark}</td>", value.map_or("–".to_owned(), |v| number(v, 6)))
        };
        let cells: String = columns.iter().map(|(name, pick)| cell(name, pick(phase))).collect();
        rows.push_str(&format!(
            "<tr><th><span class=\"swatch\" style=\"background:{}\"></span>{}</th>{cells}</tr>\n",
            palette::phase(i, phases.len()).hex(),
            escape(&phase.name)
        ));
    }
    section("Materials", &format!("<tr><th>phase, softest first</th>{head}</tr>"), &rows, "")
}

/// The files that belong to the design.
#[must_use]
pub fn files(files: &[(String, String)]) -> String {
    if files.is_empty() {
        return String::new();
    }
    let row = |(name, description): &(String, String)| {
        format!("<tr><td class=\"value\"><code>{}</code></td><td>{}</td></tr>\n", escape(name), escape(description))
    };
    let rows: String = files.iter().map(row).collect();
    section("Files", "<tr><th>file</th><th>content</th></tr>", &rows, "")
}

fn section(title: &str, head: &str, rows: &str, hint: &str) -> String {
    let hint = if hint.is_empty() { String::new() } else { format!("<p class=\"hint\">{hint}</p>\n") };
    format!(
        "<section>\n<h2>{title}</h2>\n<table><thead>{head}</thead>\n<tbody>\n{rows}</tbody></table>\n{hint}</section>\n"
    )
}
