//! The maker of the assembly parts.

use std::f64::consts::PI;

use serde_json::{Map, Value, json};

use super::error::AssemblyError;
use super::parts::Parts;
use super::seat::Seat;
use crate::design::Design;
use crate::error::Error;
use crate::fabrication::layout::Placement;
use crate::fabrication::solid::{Mesh, SolidError};
use crate::fabrication::stl;
use crate::fabrication::three_mf::{BaseMaterial, Document, Object, Shape};
use crate::fabrication::{Estimate, FOLDER, FabricationError, Job, Made, Maker};
use crate::input::{FabricationKind, InputError};
use crate::output::Summary;
use crate::output::folder::{Staging, WriteFailure};
use crate::progress::{self, Progress};

/// Bytes a spoke's share of all parts takes at most.
const BYTES_A_SPOKE: u64 = 80_000;

/// Gap between the parts on the plate, mm.
const GAP_MM: f64 = 5.0;

/// Standard gravity, m/s^2.
const GRAVITY: f64 = 9.806_65;

/// Writes `fabrication/base.stl`, `hub.stl`, for a held hub `post.stl`, and `assembly.3mf`.
pub struct Assembly;

impl Maker for Assembly {
    fn kind(&self) -> FabricationKind {
        FabricationKind::Assembly
    }

    fn plan(&self, job: &Job<'_>) -> Result<Estimate, FabricationError> {
        let kind = self.kind();
        if job.design.input().is_strip() {
            return Err(FabricationError::NotApplicable { kind, why: "a rectangular strip has neither hub nor base" });
        }
        Parts::of(job.design, job.input)?;
        Ok(Estimate { voxels: 0, bytes: BYTES_A_SPOKE * job.design.input().count() as u64 })
    }

    fn write(&self, job: &Job<'_>, staging: &mut Staging, progress: Progress<'_>) -> Result<Made, Error> {
        let failed = |error: AssemblyError| Error::Input(InputError::new(error.key(), "", error.to_string()));
        let parts = Parts::of(job.design, job.input).map_err(failed)?;
        let mut meshes = vec![
            ("base", parts.base_mesh().map_err(failed)?, describe_seat("base ring", &parts.rim_seat)),
            ("hub", parts.hub_mesh().map_err(failed)?, describe_seat("hub", &parts.hub_seat)),
        ];
        if let Some(post) = parts.post_mesh() {
            meshes.push(("post", post.map_err(failed)?, describe_post(job.design, &parts)));
        }
        let mut made = Made { details: details(job.design, &parts), ..Made::default() };
        for (name, mesh, what) in &meshes {
            if !progress(0) {
                return Err(Error::Cancelled);
            }
            let path = format!("{FOLDER}/{name}.stl");
            let body = stl::Body { solid: mesh, placement: Placement::IDENTITY };
            staging.write(&path, |out| {
                stl::write(out, job.provenance, &[body], &progress::never).map(|_| ()).map_err(WriteFailure::from)
            })?;
            made.files.push(path.clone());
            made.listed.push((path, what.clone()));
        }
        let path = format!("{FOLDER}/assembly.3mf");
        let provenance = job.provenance;
        let rigid = BaseMaterial { name: "any stiff plastic".to_owned(), colour: "#8A94A3FF".to_owned() };
        let objects = meshes.iter().map(|(name, mesh, _)| Object {
            name: (*name).to_owned(),
            shape: Shape::Solid { solid: mesh, material: 0 },
        });
        let document = Document {
            title: format!("{}: assembly parts", job.design.input().name),
            description: "base ring, hub and post beside each other on the plate".to_owned(),
            provenance,
            materials: vec![rigid],
            objects: objects.collect(),
            items: on_plate(meshes.iter().map(|(_, mesh, _)| mesh)),
        };
        staging.write(&path, |out| {
            document.write(out, &progress::never).map_err(|error: SolidError| WriteFailure::from(error))
        })?;
        made.files.push(path.clone());
        made.listed.push((path, "all assembly parts on one plate".to_owned()));
        Ok(made)
    }
}

/// The parts one beside the other, standing on the plate.
fn on_plate<'a>(meshes: impl Iterator<Item = &'a Mesh>) -> Vec<(usize, Placement)> {
    let mut x = 0.0;
    meshes
        .enumerate()
        .map(|(index, mesh)| {
            let extent =
                |k: usize, f: fn(f64, f64) -> f64, start: f64| mesh.vertices.iter().map(|p| p[k]).fold(start, f);
            let low = [0, 1, 2].map(|k| extent(k, f64::min, f64::INFINITY));
            let right = extent(0, f64::max, f64::NEG_INFINITY);
            let placement = Placement { shift: [x - low[0], -low[1], -low[2]], ..Placement::IDENTITY };
            x += right - low[0] + GAP_MM;
            (index, placement)
        })
        .collect()
}

fn describe_seat(part: &str, seat: &Seat) -> String {
    format!(
        "{part} with {} slots at {:.2} mm from the axis, {:.2} x {:.2} mm wide, {:.2} mm deep, slanting by {:.2} deg",
        seat.count,
        seat.radius_mm,
        seat.width_mm,
        seat.thickness_mm,
        seat.depth_mm,
        seat.inclination.to_degrees()
    )
}

/// Vertical force of all spokes on the hub in both limits, N; positive when the hub is pushed up.
fn hub_forces(design: &Design) -> [f64; 2] {
    let total = Summary::of(design).thrust.total;
    [total.beam.vertical_n, total.plane_strain.vertical_n]
}

fn describe_post(design: &Design, parts: &Parts) -> String {
    let [beam, strained] = hub_forces(design);
    let length = parts.post.as_ref().map_or(0.0, |p| p.heights_mm[1] - p.heights_mm[0]);
    let sense = if beam >= 0.0 { "pushes the hub up" } else { "holds the hub down: fix it there, or hang a weight" };
    format!(
        "post of {length:.2} mm that {sense} with {:.3} to {:.3} N (beam to plane strain)",
        beam.abs(),
        strained.abs()
    )
}

fn seat_details(seat: &Seat, asked: f64) -> Value {
    json!({
        "radius_mm": seat.radius_mm,
        "height_mm": seat.height_mm,
        "slant_deg": seat.inclination.to_degrees(),
        "slot_width_mm": seat.width_mm,
        "slot_thickness_mm": seat.thickness_mm,
        "slot_depth_mm": seat.depth_mm,
        "slot_depth_asked_mm": asked,
        "walls_between_slots": seat.is_walled(),
    })
}

fn details(design: &Design, parts: &Parts) -> Map<String, Value> {
    let input = design.input();
    let asked = input.fabrication().map(|f| [f.seat_depth_mm, f.hub_seat_depth_mm]).unwrap_or_default();
    let mut base = seat_details(&parts.rim_seat, asked[0]);
    base["inner_radius_mm"] = json!(parts.base.radii_mm[0]);
    base["outer_radius_mm"] = json!(parts.base.radii_mm[1]);
    base["floor_mm"] = json!(parts.base.heights_mm[0]);
    base["top_mm"] = json!(parts.base.heights_mm[1]);
    let mut hub = seat_details(&parts.hub_seat, asked[1]);
    hub["outer_radius_mm"] = json!(parts.hub.radii_mm[1]);
    hub["bottom_mm"] = json!(parts.hub.heights_mm[0]);
    hub["top_mm"] = json!(parts.hub.heights_mm[1]);
    let mut details = Map::new();
    details.insert("base".to_owned(), base);
    details.insert("hub".to_owned(), hub);
    let [beam, strained] = hub_forces(design);
    let force = json!({ "beam": beam, "plane_strain": strained });
    if let Some(post) = &parts.post {
        let weight = [beam, strained].map(|f| if f < 0.0 { -f / GRAVITY * 1e3 } else { 0.0 });
        let post = json!({
            "diameter_mm": post.diameter_mm,
            "length_mm": post.heights_mm[1] - post.heights_mm[0],
            "top_mm": post.heights_mm[1],
            "socket_depth_mm": post.socket_mm,
            "foot_radius_mm": post.foot_radius_mm,
            "foot_thickness_mm": post.foot_mm,
            "force_on_hub_n": force,
            "weight_instead_g": { "beam": weight[0], "plane_strain": weight[1] },
        });
        details.insert("post".to_owned(), post);
    }
    // Mid-surfaces tessellate, so the inner faces of thick neighbours meet before them.
    let half = 0.5 * input.strips.thickness_mm * (PI / input.count() as f64).tan();
    let meeting = |inclination: f64| half * inclination.sin().abs();
    details.insert(
        "neighbours_overlap_a_side_mm".to_owned(),
        json!({ "rim": meeting(parts.rim_seat.inclination), "hub": meeting(parts.hub_seat.inclination) }),
    );
    details.insert("frame".to_owned(), json!("morphed flower: axis along z, rim's plane at z = 0, spoke 1 along +x"));
    details
}
