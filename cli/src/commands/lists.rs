//! `voxelastica materials`, `targets` and `schema`.

use voxelastica_core::input::parameters::{PARAMETERS, TARGET_KINDS};
use voxelastica_core::input::schema::json_schema;
use voxelastica_core::materials::library;
use voxelastica_core::output::json;
use voxelastica_core::{Error, InputError};

use crate::args::TargetsOptions;
use crate::console::Console;

/// Design files that come with the program: name, what it shows, text.
const EXAMPLES: &[(&str, &str, &str)] = &[
    (
        "hemisphere",
        "the paper's hemisphere: eight spokes, two resins",
        include_str!("../../../examples/hemisphere.toml"),
    ),
    ("nose_cone", "a nose cone with a held hub", include_str!("../../../examples/nose_cone.toml")),
    ("trumpet", "a trumpet with a held hub", include_str!("../../../examples/trumpet.toml")),
    ("roof", "a roof that needs a contrast of ten", include_str!("../../../examples/roof.toml")),
    ("hemi_ellipsoid_0.5", "a tall hemi-ellipsoid", include_str!("../../../examples/hemi_ellipsoid_0.5.toml")),
    ("hemi_ellipsoid_2.0", "a flat hemi-ellipsoid", include_str!("../../../examples/hemi_ellipsoid_2.0.toml")),
    ("three_phases", "a hemisphere of three resins", include_str!("../../../examples/three_phases.toml")),
];

/// Lists the library of materials.
pub fn materials(console: &Console) -> Result<u8, Error> {
    console.answer(format!("{:<26}{:>10}{:>8}{:>12}{:>12}{:>12}", "name", "E (MPa)", "nu", "kg/m3", "W/(m K)", "S/m"));
    let shown = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), |v| v.to_string());
    let exponent = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), |v| format!("{v:e}"));
    for m in library() {
        console.answer(format!(
            "{:<26}{:>10}{:>8}{:>12}{:>12}{:>12}",
            m.name,
            m.modulus_mpa,
            m.poisson,
            shown(m.density_kg_m3),
            shown(m.conductivity_w_mk),
            exponent(m.electrical_conductivity_s_m)
        ));
    }
    Ok(0)
}

/// Lists the kinds of targets and the examples, or prints an example's design file.
pub fn targets(options: &TargetsOptions, console: &Console) -> Result<u8, Error> {
    if let Some(name) = &options.name {
        let Some((_, _, text)) = EXAMPLES.iter().find(|(known, _, _)| known == name) else {
            let known: Vec<&str> = EXAMPLES.iter().map(|(name, _, _)| *name).collect();
            let error = InputError::new("", "", format!("there is no example \"{name}\""));
            return Err(Error::Input(error.help(format!("known are: {}", known.join(", "))).in_file("targets")));
        };
        console.answer(text.trim_end());
        return Ok(0);
    }
    console.answer("Kinds of targets (target.kind) and their keys:");
    for kind in TARGET_KINDS {
        let keys: Vec<&str> = PARAMETERS
            .iter()
            .filter(|p| p.targets.contains(kind) && p.targets.len() < TARGET_KINDS.len() - 1)
            .filter_map(|p| p.key.strip_prefix("target."))
            .collect();
        console.answer(format!("  {kind:<24}{}", keys.join(", ")));
    }
    console.answer("\nExamples (voxelastica targets NAME prints the design file):");
    for (name, what, _) in EXAMPLES {
        console.answer(format!("  {name:<24}{what}"));
    }
    Ok(0)
}

/// Prints the JSON Schema of the design file.
pub fn schema(console: &Console) -> Result<u8, Error> {
    let text = json::to_text(&json_schema()).map_err(|e| Error::Internal(e.to_string()))?;
    console.answer(text.trim_end());
    Ok(0)
}
