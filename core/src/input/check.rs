//! Holds a document against the table of parameters.

use serde_json::{Map, Value};

use super::InputError;
use super::document::Document;
use super::parameters::{Kind, OPTIONAL_TABLES, PARAMETERS, Parameter, TARGET_KINDS, parameter};

/// Longest text that is echoed in an error.
const LONGEST_ECHO: usize = 60;

/// Tables of which there may be any number.
const LISTS_OF_TABLES: [&str; 1] = ["materials.custom"];

/// Checks every key and value, and fills in the defaults of the keys that are absent.
///
/// # Errors
/// [`InputError`] for the first unknown key (naming the closest known one), key that does not apply to the target's
/// kind, missing key, or value of the wrong type or out of range.
pub fn check(document: &mut Document, file: &str) -> Result<(), InputError> {
    let located = |mut error: InputError, document: &Document| {
        error.line = error.line.or_else(|| document.lines.get(&error.key).copied());
        error.in_file(file)
    };
    let kind = target_kind(&document.root).map_err(|e| located(e, document))?;
    walk(&document.root, "", "", &kind).map_err(|e| located(e, document))?;
    missing(&document.root, &kind).map_err(|e| located(e, document))?;
    fill_defaults(&mut document.root, &kind);
    Ok(())
}

fn target_kind(root: &Map<String, Value>) -> Result<String, InputError> {
    let Some(target) = root.get("target") else {
        if let Some((key, _)) = root.iter().find(|(key, _)| top_level(key).is_none()) {
            return Err(unknown(key, "", ""));
        }
        return Err(InputError::new("target", "", "this table is missing")
            .help(format!("add [target] with kind = one of {}", list(TARGET_KINDS))));
    };
    let Value::Object(target) = target else {
        return Err(InputError::new("target", show(target), "this must be a table"));
    };
    match target.get("kind") {
        Some(Value::String(kind)) if TARGET_KINDS.contains(&kind.as_str()) => Ok(kind.clone()),
        Some(other) => Err(not_a_choice("target.kind", other, TARGET_KINDS)),
        None => Err(InputError::new("target.kind", "", "this key is missing")
            .help(format!("it is one of {}", list(TARGET_KINDS)))),
    }
}

fn top_level(key: &str) -> Option<&'static Parameter> {
    PARAMETERS.iter().find(|p| p.key == key || p.key.strip_prefix(key).is_some_and(|rest| rest.starts_with('.')))
}

/// `path` has list indices in it, `generic` has not.
fn walk(map: &Map<String, Value>, path: &str, generic: &str, kind: &str) -> Result<(), InputError> {
    let join = |prefix: &str, key: &str| if prefix.is_empty() { key.to_owned() } else { format!("{prefix}.{key}") };
    for (key, value) in map {
        let (path, generic_key) = (join(path, key), join(generic, key));
        if let Some(parameter) = parameter(&generic_key) {
            if !parameter.applies_to(kind) {
                let problem = format!("this key does not apply to a target of kind \"{kind}\"");
                return Err(InputError::new(path, show(value), problem).help("remove it"));
            }
            check_value(parameter, &path, value)?;
        } else if top_level(&generic_key).is_none() {
            return Err(unknown(&path, generic, kind));
        } else if LISTS_OF_TABLES.contains(&generic_key.as_str()) {
            let Value::Array(entries) = value else {
                return Err(InputError::new(&path, show(value), format!("write [[{path}]] tables")));
            };
            for (i, entry) in entries.iter().enumerate() {
                let path = format!("{path}.{i}");
                let Value::Object(entry) = entry else {
                    return Err(InputError::new(path, show(entry), "this must be a table"));
                };
                walk(entry, &path, &generic_key, kind)?;
            }
        } else {
            let Value::Object(table) = value else {
                return Err(InputError::new(path, show(value), "this must be a table"));
            };
            walk(table, &path, &generic_key, kind)?;
        }
    }
    Ok(())
}

/// An unknown key, with the closest known one of the same table.
fn unknown(path: &str, table: &str, kind: &str) -> InputError {
    let key = path.rsplit('.').next().unwrap_or(path);
    let prefix = if table.is_empty() { String::new() } else { format!("{table}.") };
    let mut known: Vec<&str> = PARAMETERS
        .iter()
        .filter(|p| (kind.is_empty() || p.applies_to(kind)) && p.kind != Kind::Recorded)
        .filter_map(|p| p.key.strip_prefix(prefix.as_str()))
        .map(|rest| rest.split('.').next().unwrap_or(rest))
        .collect();
    known.dedup();
    let closest = known
        .iter()
        .map(|name| (strsim::damerau_levenshtein(name, key), strsim::jaro_winkler(name, key), *name))
        .min_by(|a, b| a.0.cmp(&b.0).then(b.1.total_cmp(&a.1)));
    let help = match closest {
        Some((distance, likeness, name)) if distance <= 3 || likeness > 0.8 => format!("did you mean \"{name}\"?"),
        _ => format!("known here: {}", known.join(", ")),
    };
    InputError::new(path, "", "unknown key").help(help)
}

fn missing(root: &Map<String, Value>, kind: &str) -> Result<(), InputError> {
    for parameter in PARAMETERS.iter().filter(|p| p.required && p.applies_to(kind)) {
        let described = |path: &str| {
            let unit = parameter.unit.map(|u| format!(" (in {u})")).unwrap_or_default();
            InputError::new(path, "", "this key is missing").help(format!("{}{unit}", parameter.description))
        };
        let (table, key) = parameter.key.rsplit_once('.').unwrap_or(("", parameter.key));
        if LISTS_OF_TABLES.contains(&table) {
            for (i, entry) in entries(root, table).iter().enumerate() {
                if entry.get(key).is_none() {
                    return Err(described(&format!("{table}.{i}.{key}")));
                }
            }
        } else if root.get(table).and_then(|t| t.get(key)).is_none() {
            return Err(described(parameter.key));
        }
    }
    Ok(())
}

fn entries<'a>(root: &'a Map<String, Value>, list: &str) -> &'a [Value] {
    let mut value = root.get(list.split('.').next().unwrap_or(list));
    for key in list.split('.').skip(1) {
        value = value.and_then(|v| v.get(key));
    }
    value.and_then(Value::as_array).map_or(&[], Vec::as_slice)
}

fn fill_defaults(root: &mut Map<String, Value>, kind: &str) {
    for parameter in PARAMETERS.iter().filter(|p| p.applies_to(kind)) {
        let Some(default) = parameter.default.and_then(|text| serde_json::from_str(text).ok()) else { continue };
        let Some((table, key)) = parameter.key.rsplit_once('.') else { continue };
        let absent = OPTIONAL_TABLES.contains(&table) && !root.contains_key(table);
        if LISTS_OF_TABLES.contains(&table) || absent {
            continue;
        }
        if let Value::Object(table) = root.entry(table).or_insert_with(|| Value::Object(Map::new())) {
            table.entry(key).or_insert(default);
        }
    }
}

/// The defaults of one table that is absent.
pub(super) fn defaults(table: &str) -> Map<String, Value> {
    let keys = PARAMETERS.iter().filter_map(|p| match p.key.rsplit_once('.') {
        Some((of, key)) if of == table => Some((key, p.default?)),
        _ => None,
    });
    keys.filter_map(|(key, text)| Some((key.to_owned(), serde_json::from_str(text).ok()?))).collect()
}

/// Checks one value against its parameter's type and range.
pub(crate) fn check_value(parameter: &Parameter, path: &str, value: &Value) -> Result<(), InputError> {
    let unit = parameter.unit.map(|u| format!(" {u}")).unwrap_or_default();
    let wrong = |problem: String| Err(InputError::new(path, show(value), problem).help(parameter.description));
    match (&parameter.kind, value) {
        (Kind::Text | Kind::Path, Value::String(text)) if !text.trim().is_empty() => Ok(()),
        (Kind::Text | Kind::Path, _) => wrong("this must be a text that is not empty".into()),
        (Kind::Choice { choices }, Value::String(word)) if choices.contains(&word.as_str()) => Ok(()),
        (Kind::Choice { choices }, _) => Err(not_a_choice(path, value, choices)),
        (Kind::Number { least, exclusive, most }, Value::Number(number)) => {
            let number = number.as_f64().unwrap_or(f64::NAN);
            let low = if *exclusive { number > *least } else { number >= *least };
            if low && number <= *most {
                Ok(())
            } else {
                let from = if *exclusive { "greater than" } else { "at least" };
                wrong(format!("this must be {from} {least}{unit} and at most {most}{unit}"))
            }
        }
        (Kind::Number { .. }, _) => wrong(format!("this must be a number{}", in_unit(parameter))),
        (Kind::Integer { least, most }, Value::Number(number)) => match number.as_i64() {
            Some(n) if (*least..=*most).contains(&n) => Ok(()),
            _ if *most == i64::MAX => wrong(format!("this must be a whole number of at least {least}")),
            _ => wrong(format!("this must be a whole number between {least} and {most}")),
        },
        (Kind::Integer { .. }, _) => wrong("this must be a whole number".into()),
        (Kind::Numbers { least, most }, Value::Array(entries)) => {
            if !(*least..=*most).contains(&entries.len()) {
                return wrong(format!("this must have between {least} and {most} numbers, not {}", entries.len()));
            }
            all(path, entries, "this must be a number", Value::is_number)
        }
        (Kind::Integers { count, least, most }, Value::Array(entries)) => {
            if entries.len() != *count {
                return wrong(format!("this must have {count} whole numbers, not {}", entries.len()));
            }
            let problem = format!("this must be a whole number between {least} and {most}");
            all(path, entries, &problem, |v| v.as_i64().is_some_and(|n| (*least..=*most).contains(&n)))
        }
        (Kind::Texts { least, most }, Value::Array(entries)) => {
            if !(*least..=*most).contains(&entries.len()) {
                return wrong(format!("this must have {least} to {most} entries, not {}", entries.len()));
            }
            all(path, entries, "this must be a text", Value::is_string)
        }
        (Kind::Choices { choices }, Value::Array(entries)) => {
            for (i, entry) in entries.iter().enumerate() {
                if !entry.as_str().is_some_and(|word| choices.contains(&word)) {
                    return Err(not_a_choice(&format!("{path}.{i}"), entry, choices));
                }
                if entries[..i].contains(entry) {
                    return wrong(format!("{} is named twice", show(entry)));
                }
            }
            Ok(())
        }
        (Kind::ChoiceOrVector { choices }, Value::String(word)) if choices.contains(&word.as_str()) => Ok(()),
        (Kind::ChoiceOrVector { choices }, Value::Array(entries)) => {
            let length: f64 = entries.iter().filter_map(Value::as_f64).map(|c| c * c).sum();
            if entries.len() == 3 && entries.iter().all(Value::is_number) && length > 0.0 && length.is_finite() {
                Ok(())
            } else {
                wrong(format!("this must be three numbers, not all zero, or one of {}", list(choices)))
            }
        }
        (Kind::ChoiceOrVector { choices }, _) => Err(not_a_choice(path, value, choices)),
        (Kind::Pairs, Value::Array(entries)) => all(path, entries, "this must be a pair of numbers [rho, z]", |v| {
            v.as_array().is_some_and(|pair| pair.len() == 2 && pair.iter().all(Value::is_number))
        }),
        (Kind::Numbers { .. } | Kind::Integers { .. } | Kind::Texts { .. } | Kind::Choices { .. } | Kind::Pairs, _) => {
            wrong("this must be a list".into())
        }
        (Kind::Recorded, _) => Ok(()),
    }
}

fn in_unit(parameter: &Parameter) -> String {
    parameter.unit.map(|u| format!(" in {u}")).unwrap_or_default()
}

fn all(path: &str, entries: &[Value], problem: &str, good: impl Fn(&Value) -> bool) -> Result<(), InputError> {
    match entries.iter().enumerate().find(|(_, entry)| !good(entry)) {
        Some((i, entry)) => Err(InputError::new(format!("{path}.{i}"), show(entry), problem)),
        None => Ok(()),
    }
}

fn not_a_choice(path: &str, value: &Value, choices: &[&str]) -> InputError {
    let closest = value.as_str().and_then(|word| {
        let near = choices.iter().map(|c| (strsim::jaro_winkler(c, word), *c)).max_by(|a, b| a.0.total_cmp(&b.0));
        near.filter(|(likeness, _)| *likeness > 0.75)
    });
    let help = match closest {
        Some((_, choice)) => format!("did you mean \"{choice}\"? It is one of {}", list(choices)),
        None => format!("it is one of {}", list(choices)),
    };
    InputError::new(path, show(value), "this value is not known").help(help)
}

fn list(choices: &[&str]) -> String {
    choices.iter().map(|c| format!("\"{c}\"")).collect::<Vec<_>>().join(", ")
}

fn show(value: &Value) -> String {
    let text = value.to_string();
    if text.chars().count() > LONGEST_ECHO {
        let start: String = text.chars().take(LONGEST_ECHO).collect();
        format!("{start}...")
    } else {
        text
    }
}
