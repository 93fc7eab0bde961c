//! JSON Schema of the design file, made from the table of parameters.

use serde_json::{Map, Value, json};

use super::parameters::{Kind, PARAMETERS, Parameter};

/// JSON Schema (2020-12) of a design file; units stand in `x-unit`, target kinds in `x-target-kinds`.
#[must_use]
pub fn json_schema() -> Value {
    let mut root = object("A Voxelastica design");
    for parameter in PARAMETERS.iter().filter(|p| p.kind != Kind::Recorded) {
        insert(&mut root, parameter.key, parameter);
    }
    root["$schema"] = json!("https://json-schema.org/draft/2020-12/schema");
    root["required"] = json!(["target", "strips", "materials", "voxels"]);
    root
}

/// Puts a property into the table its dotted key names, making tables on the way.
fn insert(table: &mut Value, key: &str, parameter: &Parameter) {
    if let Some((first, rest)) = key.split_once('.') {
        if table["properties"][first].is_null() {
            table["properties"][first] = container(first);
        }
        let entry = &mut table["properties"][first];
        insert(if first == "custom" { &mut entry["items"] } else { entry }, rest, parameter);
        return;
    }
    table["properties"][key] = property(parameter);
    let always = parameter.required && (parameter.targets.is_empty() || key == "kind");
    if let Some(required) = table["required"].as_array_mut().filter(|_| always) {
        required.push(json!(key));
    }
}

fn object(title: &str) -> Value {
    json!({ "title": title, "type": "object", "additionalProperties": false, "properties": {}, "required": [] })
}

fn container(key: &str) -> Value {
    if key == "custom" { json!({ "type": "array", "items": object("custom material") }) } else { object(key) }
}

fn property(parameter: &Parameter) -> Value {
    let mut property = match parameter.kind {
        Kind::Text | Kind::Path => json!({ "type": "string", "minLength": 1 }),
        Kind::Choice { choices } => json!({ "enum": choices }),
        Kind::Number { least, exclusive, most } => {
            let lower = if exclusive { "exclusiveMinimum" } else { "minimum" };
            json!({ "type": "number", lower: least, "maximum": most })
        }
        Kind::Integer { least, most } => json!({ "type": "integer", "minimum": least, "maximum": most }),
        Kind::Numbers { least, most } => {
            json!({ "type": "array", "items": { "type": "number" }, "minItems": least, "maxItems": most })
        }
        Kind::Integers { count, least, most } => json!({
            "type": "array", "items": { "type": "integer", "minimum": least, "maximum": most },
            "minItems": count, "maxItems": count
        }),
        Kind::Texts { least, most } => {
            json!({ "type": "array", "items": { "type": "string" }, "minItems": least, "maxItems": most })
        }
        Kind::Choices { choices } => json!({ "type": "array", "items": { "enum": choices }, "uniqueItems": true }),
        Kind::ChoiceOrVector { choices } => json!({ "oneOf": [
            { "enum": choices },
            { "type": "array", "items": { "type": "number" }, "minItems": 3, "maxItems": 3 }
        ] }),
        Kind::Pairs => json!({ "type": "array", "items": {
            "type": "array", "items": { "type": "number" }, "minItems": 2, "maxItems": 2
        } }),
        Kind::Recorded => Value::Object(Map::new()),
    };
    property["description"] = json!(parameter.description);
    if let Some(unit) = parameter.unit {
        property["x-unit"] = json!(unit);
    }
    if !parameter.targets.is_empty() {
        property["x-target-kinds"] = json!(parameter.targets);
    }
    if let Some(default) = parameter.default.and_then(|text| serde_json::from_str::<Value>(text).ok()) {
        property["default"] = default;
    }
    property
}
