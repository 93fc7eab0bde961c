//! What a host needs to build the finite-element model itself, as the decks have it: `voxels`, `morph_step` and
//! `graded_material` of `design.json`.

use serde_json::{Value, json};

use crate::deck::keywords::materials;
use crate::deck::keywords::step::Increments;
use crate::deck::schedule::{Motion, Schedule};
use crate::deck::solid::initial_bow;
use crate::design::Design;

/// Voxels up to which their phases are listed one by one; decks and images hold more.
const MOST_LISTED: usize = 1 << 20;

/// The lattice and, up to [`MOST_LISTED`] voxels, the phase of every voxel: one string a slice from rim to hub, one digit a
/// voxel, layer by layer from the lower face up, each from the most negative `y`; phases count from 0, softest first.
pub(super) fn voxels(design: &Design) -> Value {
    let grid = design.grid();
    let listed = grid.phases().len() <= MOST_LISTED;
    let digits = |i: usize| grid.slice(i).iter().map(|phase| char::from(b'0' + phase)).collect::<String>();
    json!({
        "size_mm": grid.size_mm(),
        "slices": grid.slices(),
        "layers": grid.layers(),
        "phases": listed.then(|| (0..grid.slices()).map(digits).collect::<Vec<_>>()),
    })
}

/// The step that morphs a spoke: what moves which end, by how much and along which course, and the increments.
pub(super) fn morph_step(design: &Design) -> Value {
    let schedule = Schedule::of(design);
    let motion = |m: &Motion, unit: &str| json!({ "amplitude": m.amplitude, "value": m.value, "unit": unit, "course": m.course });
    let by = Increments::of(design);
    json!({
        "description": schedule.description,
        "increments": { "first": by.first, "least": by.least, "most": by.most, "number": Increments::NUMBER },
        "rim_travel": motion(&schedule.rim_travel, "mm"),
        "rim_rotation": motion(&schedule.rim_rotation, "rad"),
        "hub_rotation": motion(&schedule.hub_rotation, "rad"),
        "hub_height": schedule.hub_height.as_ref().map(|m| motion(m, "mm")),
        "initial_bow_mm": initial_bow(design),
    })
}

/// Rows of the material whose modulus is a field equal to itself, softest first; between them everything is linear.
pub(super) fn graded_material(design: &Design) -> Value {
    let phases = design.phases();
    let rows = materials::mixtures(phases);
    let row = |r: &materials::Mixture| {
        json!({
            "modulus_mpa": r.modulus,
            "poisson": r.poisson,
            "density_tonne_mm3": r.density,
            "fractions": phases.fractions(r.modulus).values[..phases.phases().len()],
        })
    };
    json!({ "rows": rows.iter().map(row).collect::<Vec<_>>() })
}
