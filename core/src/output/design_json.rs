//! `design.json`: the whole result, which every host reads.

use serde_json::{Value, json};

use super::{Provenance, Summary, model_json};
use crate::SCHEMA;
use crate::deck::keywords::materials::material_name;
use crate::design::Design;
use crate::error::Error;
use crate::modulus_field::ModulusField;

/// Fractions of the morph at which the guided ends are recorded.
const PATH_POINTS: usize = 41;

/// The contents of `design.json`.
///
/// # Errors
/// [`Error::Internal`] where a figure cannot be represented.
pub fn document(
    design: &Design,
    summary: &Summary,
    field: Option<&ModulusField>,
    provenance: &Provenance,
    files: &[&str],
) -> Result<Value, Error> {
    let profile = design.profile();
    let slices = design.slices();
    let degrees: Vec<f64> = profile.inclination.iter().map(|t| t.to_degrees()).collect();
    let phases: Vec<Value> = design
        .phases()
        .phases()
        .iter()
        .map(|phase| {
            let mut value = serde_json::to_value(phase).unwrap_or_default();
            value["label"] = json!(phase.label());
            value["material"] = json!(material_name(phase));
            value
        })
        .collect();
    let counts = |k: usize| slices.iter().map(|s| s.counts[k]).collect::<Vec<_>>();
    let by_phase: serde_json::Map<String, Value> =
        design.phases().phases().iter().enumerate().map(|(k, phase)| (phase.label(), json!(counts(k)))).collect();
    let column = |f: fn(&crate::voxel::Slice) -> f64| slices.iter().map(f).collect::<Vec<f64>>();
    Ok(json!({
        "schema": SCHEMA,
        "provenance": provenance,
        "units": { "length": "mm", "force": "N", "stress": "MPa", "mass": "tonne", "time": "s", "temperature": "K" },
        "design": design.input(),
        "summary": summary,
        "modulus_field": field,
        "target_fit": design.target().and_then(|t| t.fit),
        "inflections_mm": design.inverse().map(|i| i.inflections.iter().map(|p| p.s).collect::<Vec<f64>>()),
        "phases": phases,
        "mixture_rule": design.mixture_rule(),
        "profile": {
            "s_mm": profile.s,
            "theta_deg": degrees,
            "x_mm": profile.x,
            "z_mm": profile.z,
            "rho_mm": profile.rho,
            "width_mm": profile.width,
            "modulus_ratio": profile.modulus_ratio,
            "modulus_mpa": profile.modulus_mpa,
            "rigid_fraction": profile.rigid_fraction,
        },
        "slices": {
            "s_mm": column(|s| s.s_mm),
            "half_width_voxels": slices.iter().map(|s| s.half_width).collect::<Vec<_>>(),
            "counts": by_phase,
            "modulus_target_mpa": column(|s| s.modulus_target_mpa),
            "modulus_mpa": column(|s| s.modulus_mpa),
            "stiffness_target_nmm2": column(|s| s.stiffness_target_nmm2),
            "stiffness_nmm2": column(|s| s.section.stiffness),
            "neutral_offset_mm": column(|s| s.section.neutral_offset),
        },
        "voxels": model_json::voxels(design),
        "graded_material": model_json::graded_material(design),
        "morph_step": model_json::morph_step(design),
        "morph_path": morph_path(design),
        "predicted_midline_mm": predicted_midline(design),
        "warnings": design.warnings_for_files(),
        "files": files,
    }))
}

/// Where the ends are guided: fraction, horizontal distance and height of the hub seen from the rim.
fn morph_path(design: &Design) -> Option<Value> {
    let guide = design.guide()?;
    let fractions: Vec<f64> = (0..PATH_POINTS).map(|i| i as f64 / (PATH_POINTS - 1) as f64).collect();
    let hubs: Vec<[f64; 2]> = fractions.iter().map(|f| guide.hub_position(*f)).collect();
    Some(json!({
        "fraction": fractions,
        "span_mm": hubs.iter().map(|h| h[0]).collect::<Vec<_>>(),
        "height_mm": hubs.iter().map(|h| h[1]).collect::<Vec<_>>(),
    }))
}

/// `[s, x, z]` of the voxelised strip's predicted mid-line.
fn predicted_midline(design: &Design) -> Option<Vec<[f64; 3]>> {
    let shape = design.voxel_path()?.final_shape();
    let profile = design.profile();
    let every = (profile.s.len() - 1) / 200;
    Some(
        profile
            .s
            .iter()
            .step_by(every.max(1))
            .map(|s| {
                let [x, z] = shape.position(*s);
                [*s, x, z]
            })
            .collect(),
    )
}
