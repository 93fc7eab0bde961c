//! The reference of all keys as Markdown, for `docs/design-file.md`.

use std::fmt::Write;

use super::parameters::{Kind, PARAMETERS, Parameter};

/// A table a section of the design file: key, type and range, default, meaning.
#[must_use]
pub fn markdown() -> String {
    let mut text = String::new();
    let mut section = None;
    for parameter in PARAMETERS.iter().filter(|p| p.kind != Kind::Recorded) {
        let (table, key) = parameter.key.rsplit_once('.').unwrap_or(("", parameter.key));
        if section != Some(table) {
            let title = match table {
                "" => "### Top level".to_owned(),
                "materials.custom" => "### `[[materials.custom]]`".to_owned(),
                other => format!("### `[{other}]`"),
            };
            let _ = write!(text, "\n{title}\n\n| key | value | default | meaning |\n|---|---|---|---|\n");
            section = Some(table);
        }
        let default = match (parameter.default, parameter.required) {
            (Some(default), _) => format!("`{default}`"),
            (None, true) => "required".to_owned(),
            (None, false) => "-".to_owned(),
        };
        let _ = writeln!(text, "| `{key}` | {} | {default} | {} |", value(parameter), meaning(parameter));
    }
    text
}

fn value(parameter: &Parameter) -> String {
    let unit = parameter.unit.map(|u| format!(" {u}")).unwrap_or_default();
    let words = |choices: &[&str]| choices.iter().map(|c| format!("`\"{c}\"`")).collect::<Vec<_>>().join(", ");
    match parameter.kind {
        Kind::Text => "text".to_owned(),
        Kind::Path => "path".to_owned(),
        Kind::Choice { choices } => words(choices),
        Kind::Number { least, exclusive, most } => {
            let relation = if exclusive { "<" } else { "≤" };
            format!("number, {least} {relation} value ≤ {most}{unit}")
        }
        Kind::Integer { least, most: i64::MAX } => format!("whole number, at least {least}"),
        Kind::Integer { least, most } => format!("whole number, {least} to {most}"),
        Kind::Numbers { least, most } => format!("list of {least} to {most} numbers{unit}"),
        Kind::Integers { count, least, most } => format!("list of {count} whole numbers, {least} to {most}"),
        Kind::Texts { least, most } => format!("list of {least} to {most} texts"),
        Kind::Choices { choices } => format!("list of {}", words(choices)),
        Kind::ChoiceOrVector { choices } => format!("{}, or a vector of three numbers", words(choices)),
        Kind::Pairs => "list of `[rho, z]` pairs".to_owned(),
        Kind::Recorded => String::new(),
    }
}

fn meaning(parameter: &Parameter) -> String {
    if parameter.targets.is_empty() || parameter.targets.len() == 4 {
        return parameter.description.to_owned();
    }
    let kinds: Vec<String> = parameter.targets.iter().map(|k| format!("`{k}`")).collect();
    format!("{} ({})", parameter.description, kinds.join(", "))
}
