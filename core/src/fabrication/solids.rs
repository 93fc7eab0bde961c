//! Makers of the files that hold solids: STL and 3MF.

use std::io::{self, Seek, SeekFrom, Write};
use std::sync::atomic::{AtomicU64, Ordering};

use serde_json::{Map, Value, json};

use super::layout::{FlatFlower, Placement};
use super::print_stack::scope_name;
use super::solid::{Mesh, PhaseSolid, SolidError};
use super::three_mf::volumetric::PhaseImages;
use super::three_mf::{BaseMaterial, Document, Object, Shape};
use super::voxel_surface::{Scale, SurfaceError, Tally, VoxelSurface};
use super::{Estimate, FOLDER, FabricationError, Job, Made, Maker, stl};
use crate::design::Design;
use crate::error::Error;
use crate::input::{FabricationKind, InputError, Scope, ThreeMfGeometry};
use crate::output::folder::{Destination, Staging, WriteFailure};
use crate::progress::{Cancelled, Progress};
use crate::report::phase_colour;
use crate::voxel::VoxelGrid;

/// Bytes that a triangle and its share of the vertices take in a 3MF package, about.
const PACKED_TRIANGLE: u64 = 14;

/// Distance between the two spokes of an alternating pattern that lie side by side, mm.
const ASIDE_MM: f64 = 5.0;

/// Writes `fabrication/spoke_PHASE.stl` or `fabrication/flower_PHASE.stl`, one file a phase.
pub struct Stl;

/// Writes `fabrication/spoke.3mf` or `fabrication/flower.3mf`.
pub struct ThreeMf;

/// In which frame a file holds the vertices of spokes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Vertices {
    /// Where the spokes lie.
    Placed,
    /// The spoke's own.
    OfSpoke,
}

/// What is laid out: the different spokes, mirrored or not, and where they stand.
struct Scene<'a> {
    surface: VoxelSurface<'a>,
    /// Spokes and whether each is the mirror image of the first.
    spokes: Vec<(Placement, bool)>,
    flower: Option<FlatFlower>,
    /// Phases that have voxels, and their numbers of them.
    phases: Vec<(u8, u64)>,
}

impl<'a> Scene<'a> {
    fn new(job: &Job<'a>, vertices: Vertices) -> Result<Self, SurfaceError> {
        let design = job.design;
        let grid = design.grid();
        let flower = if job.input.scope == Scope::Flower { FlatFlower::of(design) } else { None };
        let widest = grid.half_widths().iter().copied().max().unwrap_or(0) as f64 * grid.size_mm();
        let reach = match &flower {
            Some(flower) if vertices == Vertices::Placed => flower.reach_mm(design),
            _ => design.input().strips.length_mm.max(widest),
        };
        let spokes = flower.as_ref().map_or_else(
            || vec![(Placement::IDENTITY, false)],
            |flower| flower.spokes.iter().map(|s| (s.placement, s.mirrored)).collect(),
        );
        let counts = grid.counts(design.phases().phases().len());
        let phases = (0..).zip(counts).filter(|(_, count)| *count > 0).collect();
        Ok(Self { surface: VoxelSurface::new(grid, reach)?, spokes, flower, phases })
    }

    fn solid(&self, phase: u8, mirrored: bool) -> PhaseSolid<'a> {
        PhaseSolid { surface: self.surface, phase, mirrored }
    }

    /// Whether every second spoke is a mirror image.
    fn alternates(&self, design: &Design) -> bool {
        design.input().voxels.pattern.alternates() && !design.input().is_strip()
    }

    /// The hub plate, where the flower lies flat in one piece.
    fn hub(&self, design: &Design) -> Option<Mesh> {
        let corners = self.flower.as_ref()?.hub.as_ref()?;
        let half = 0.5 * design.input().strips.thickness_mm;
        Some(Mesh::prism(corners, [-half, half]))
    }

    fn triangles(&self) -> u64 {
        self.phases.iter().map(|(phase, _)| self.surface.estimated_triangles(*phase)).sum()
    }
}

impl Maker for Stl {
    fn kind(&self) -> FabricationKind {
        FabricationKind::Stl
    }

    fn plan(&self, job: &Job<'_>) -> Result<Estimate, FabricationError> {
        let scene = Scene::new(job, Vertices::Placed)
            .map_err(|error| FabricationError::Surface { kind: self.kind(), error })?;
        let spokes = scene.spokes.len() as u64 + u64::from(scene.flower.is_none() && scene.alternates(job.design));
        Ok(Estimate { voxels: 0, bytes: spokes.saturating_mul(stl::size(scene.triangles())) })
    }

    fn write(&self, job: &Job<'_>, staging: &mut Staging, progress: Progress<'_>) -> Result<Made, Error> {
        let counter = Counter::new(progress);
        let scene = Scene::new(job, Vertices::Placed).map_err(SolidError::from).map_err(failed)?;
        let tallies = tallies(&scene, &|| counter.is_cancelled())?;
        let mut made = Made { details: details(job, &scene, &tallies), ..Made::default() };
        let mut file = |name: String, bodies: &[stl::Body<'_>], what: String| -> Result<(), Error> {
            let path = format!("{FOLDER}/{name}.stl");
            staging.write(&path, |out| {
                let mut counted = counter.counting(out);
                stl::write(&mut counted, job.provenance, bodies, &|| counter.is_cancelled())
                    .map(|_| ())
                    .map_err(WriteFailure::from)
            })?;
            made.files.push(path.clone());
            made.listed.push((path, what));
            Ok(())
        };
        let name = scope_name(job);
        for ((phase, voxels), tally) in scene.phases.iter().zip(&tallies) {
            let material = &job.design.phases().phases()[usize::from(*phase)];
            let label = material.label();
            let solids = [scene.solid(*phase, false), scene.solid(*phase, true)];
            let bodies: Vec<stl::Body<'_>> = scene
                .spokes
                .iter()
                .map(|(placement, mirrored)| stl::Body {
                    solid: &solids[usize::from(*mirrored)],
                    placement: *placement,
                })
                .collect();
            let what =
                format!("{} as one solid a spoke, {voxels} voxels, {} triangles", material.name, tally.triangles);
            file(format!("{name}_{label}"), &bodies, what)?;
            if scene.flower.is_none() && scene.alternates(job.design) {
                let body = stl::Body { solid: &solids[1], placement: Placement::IDENTITY };
                file(format!("{name}_mirrored_{label}"), &[body], format!("{} of every second spoke", material.name))?;
            }
        }
        if let Some(hub) = scene.hub(job.design) {
            let body = stl::Body { solid: &hub, placement: Placement::IDENTITY };
            file(format!("{name}_hub"), &[body], "the hub between the spokes, of the stiffest phase".to_owned())?;
        }
        Ok(made)
    }
}

impl Maker for ThreeMf {
    fn kind(&self) -> FabricationKind {
        FabricationKind::ThreeMf
    }

    fn plan(&self, job: &Job<'_>) -> Result<Estimate, FabricationError> {
        let scene = Scene::new(job, Vertices::OfSpoke)
            .map_err(|error| FabricationError::Surface { kind: self.kind(), error })?;
        let different = 1 + u64::from(scene.alternates(job.design));
        let each = match job.input.three_mf_geometry {
            ThreeMfGeometry::Mesh => PACKED_TRIANGLE * scene.triangles(),
            // A bit of colour a voxel, hardly compressed, and an outline.
            ThreeMfGeometry::ImageStack => (1 << 16) + job.design.grid().phases().len() as u64,
        };
        Ok(Estimate { voxels: 0, bytes: (1 << 13) + different.saturating_mul(each) })
    }

    fn write(&self, job: &Job<'_>, staging: &mut Staging, progress: Progress<'_>) -> Result<Made, Error> {
        let counter = Counter::new(progress);
        let scene = Scene::new(job, Vertices::OfSpoke).map_err(SolidError::from).map_err(failed)?;
        let tallies = tallies(&scene, &|| counter.is_cancelled())?;
        let imaged = job.input.three_mf_geometry == ThreeMfGeometry::ImageStack;
        let (outlines, images) = if imaged { imaged_spokes(job, &scene).map_err(failed)? } else { (None, Vec::new()) };
        let outline = match &outlines {
            Some(grid) => Some(VoxelSurface::new(grid, 1.0).map_err(SolidError::from).map_err(failed)?),
            None => None,
        };
        let hub = scene.hub(job.design);
        let stiffest = job.design.phases().phases().len() - 1;
        let mirrors: &[bool] = if scene.alternates(job.design) { &[false, true] } else { &[false] };
        let meshes: Vec<(usize, bool, PhaseSolid<'_>)> = match outline {
            Some(surface) => mirrors
                .iter()
                .map(|mirrored| (0, *mirrored, PhaseSolid { surface, phase: 0, mirrored: *mirrored }))
                .collect(),
            None => mirrors
                .iter()
                .flat_map(|m| scene.phases.iter().map(|(phase, _)| (usize::from(*phase), *m, scene.solid(*phase, *m))))
                .collect(),
        };
        let mut objects: Vec<Object<'_>> = Vec::new();
        let mut spokes: Vec<usize> = Vec::new();
        for mirrored in mirrors {
            let which = if *mirrored { " mirrored" } else { "" };
            let first = objects.len();
            for (material, _, solid) in meshes.iter().filter(|(_, m, _)| m == mirrored) {
                let shape = match images.get(usize::from(*mirrored)) {
                    Some(images) => Shape::Imaged { solid, images },
                    None => Shape::Solid { solid, material: *material },
                };
                let name = if imaged { "" } else { &job.design.phases().phases()[*material].name };
                objects.push(Object { name: format!("spoke{which} {name}").trim_end().to_owned(), shape });
            }
            let parts = (first..objects.len()).map(|part| (part, Placement::IDENTITY)).collect();
            spokes.push(objects.len());
            objects.push(Object { name: format!("spoke{which}"), shape: Shape::Components(parts) });
        }
        let items = self.arrange(job, &scene, &spokes, hub.as_ref(), stiffest, &mut objects);
        let document = Document {
            title: job.design.input().name.clone(),
            description: describe(job, &scene),
            provenance: job.provenance,
            materials: materials(job.design),
            objects,
            items,
        };
        let path = format!("{FOLDER}/{}.3mf", scope_name(job));
        staging.write(&path, |out| {
            let mut counted = counter.counting(out);
            document.write(&mut counted, &|| counter.is_cancelled()).map_err(WriteFailure::from)
        })?;
        let mut details = details(job, &scene, &tallies);
        details.insert("geometry".to_owned(), json!(job.input.three_mf_geometry));
        Ok(Made { files: vec![path.clone()], listed: vec![(path, describe(job, &scene))], details })
    }
}

impl ThreeMf {
    /// What is built and where, resting on the plate in its positive quadrant.
    fn arrange<'a>(
        &self,
        job: &Job<'_>,
        scene: &Scene<'_>,
        spokes: &[usize],
        hub: Option<&'a Mesh>,
        stiffest: usize,
        objects: &mut Vec<Object<'a>>,
    ) -> Vec<(usize, Placement)> {
        let grid = job.design.grid();
        let lift = 0.5 * job.design.input().strips.thickness_mm;
        let half = grid.half_widths().iter().copied().max().unwrap_or(0) as f64 * grid.size_mm();
        let Some(flower) = &scene.flower else {
            let aside = |i: usize| (2.0 * half + ASIDE_MM) * i as f64 + half;
            let placed = |(i, spoke): (usize, &usize)| {
                (*spoke, Placement { shift: [0.0, aside(i), lift], ..Placement::IDENTITY })
            };
            return spokes.iter().enumerate().map(placed).collect();
        };
        let mut parts: Vec<(usize, Placement)> =
            flower.spokes.iter().map(|s| (spokes[usize::from(s.mirrored)], s.placement)).collect();
        if let Some(solid) = hub {
            parts.push((objects.len(), Placement::IDENTITY));
            objects.push(Object { name: "hub".to_owned(), shape: Shape::Solid { solid, material: stiffest } });
        }
        let whole = objects.len();
        objects.push(Object { name: "flower".to_owned(), shape: Shape::Components(parts) });
        let reach = flower.reach_mm(job.design).ceil();
        vec![(whole, Placement { shift: [reach, reach, lift], ..Placement::IDENTITY })]
    }
}

/// A spoke's whole outline as a grid of one phase, and the images of the different spokes.
fn imaged_spokes(job: &Job<'_>, scene: &Scene<'_>) -> Result<(Option<VoxelGrid>, Vec<PhaseImages>), SolidError> {
    let grid = job.design.grid();
    let outline = VoxelGrid::new(grid.size_mm(), grid.layers(), grid.half_widths().to_vec());
    let mut images = vec![PhaseImages::of(grid, "spoke")?];
    if scene.alternates(job.design) {
        images.push(PhaseImages::of_mirror_image(grid, "mirrored")?);
    }
    Ok((Some(outline), images))
}

fn materials(design: &Design) -> Vec<BaseMaterial> {
    let phases = design.phases().phases();
    let colour = |k: usize| {
        let [r, g, b] = phase_colour(k, phases.len());
        format!("#{r:02X}{g:02X}{b:02X}FF")
    };
    phases.iter().enumerate().map(|(k, phase)| BaseMaterial { name: phase.name.clone(), colour: colour(k) }).collect()
}

fn describe(job: &Job<'_>, scene: &Scene<'_>) -> String {
    match &scene.flower {
        None if job.design.input().is_strip() => "the strip".to_owned(),
        None if scene.alternates(job.design) => "one spoke and its mirror image, which alternate".to_owned(),
        None => "one spoke".to_owned(),
        Some(flower) if flower.hub.is_some() => {
            format!("{} spokes and the hub, laid flat in one piece", flower.spokes.len())
        }
        Some(flower) => format!(
            "{} spokes laid flat as parts of their own; they end inclined at the hub, which is another part (assembly)",
            flower.spokes.len()
        ),
    }
}

fn tallies(scene: &Scene<'_>, cancelled: Cancelled<'_>) -> Result<Vec<Tally>, Error> {
    let tally = |(phase, _): &(u8, u64)| scene.surface.tally(*phase, cancelled);
    scene.phases.iter().map(tally).collect::<Result<_, _>>().map_err(|error| failed(error.into()))
}

/// Counts, volumes and the share of the rule for contacts.
fn details(job: &Job<'_>, scene: &Scene<'_>, tallies: &[Tally]) -> Map<String, Value> {
    let grid = job.design.grid();
    let phases = job.design.phases().phases();
    let mut by_phase = Map::new();
    for ((phase, voxels), tally) in scene.phases.iter().zip(tallies) {
        let cubes = *voxels as f64 * grid.size_mm().powi(3);
        let figures = json!({
            "voxels": voxels,
            "triangles": tally.triangles,
            "volume_mm3": tally.volume_mm3,
            "voxel_volume_mm3": cubes,
            "contact_share_mm3": tally.volume_mm3 - cubes,
        });
        by_phase.insert(phases[usize::from(*phase)].label(), figures);
    }
    let scale = scene.surface.scale();
    let mut details = Map::new();
    let mut insert = |key: &str, value: Value| details.insert(key.to_owned(), value);
    insert("scope", json!(scope_name(job)));
    insert("spokes", json!(scene.spokes.len()));
    insert("per_spoke", Value::Object(by_phase));
    insert(
        "contacts",
        json!({
            "rule": "where voxels of a phase touch along an edge or at a corner only, the softest phase there joins, others part",
            "parted_by_mm": scale.parted_mm(),
            "limit_mm": Scale::PARTED_MM,
        }),
    );
    if let Some(flower) = &scene.flower {
        insert("hub_ends_radius_mm", json!(flower.inner_radius_mm));
        insert("smallest_gap_mm", json!(flower.gap_mm));
        insert("hub_in_one_piece", json!(flower.hub.is_some()));
    }
    details
}

fn failed(error: SolidError) -> Error {
    match error {
        SolidError::Surface(SurfaceError::Cancelled) => Error::Cancelled,
        SolidError::Surface(error @ SurfaceError::TooLarge { .. }) => {
            Error::Input(InputError::new("fabrication.scope", "", error.to_string()))
        }
        SolidError::TooMany { .. } => Error::Input(InputError::new("voxels.size_mm", "", error.to_string())),
        other => Error::Internal(other.to_string()),
    }
}

impl From<SolidError> for WriteFailure {
    fn from(error: SolidError) -> Self {
        match error {
            SolidError::Io(error) => Self::Io(error),
            other => Self::Other(failed(other)),
        }
    }
}

/// Tells the progress how many bytes were written, and remembers when it says no.
struct Counter<'a> {
    progress: Progress<'a>,
    written: AtomicU64,
}

impl<'a> Counter<'a> {
    fn new(progress: Progress<'a>) -> Self {
        Self { progress, written: AtomicU64::new(0) }
    }

    fn is_cancelled(&self) -> bool {
        !(self.progress)(self.written.load(Ordering::Relaxed))
    }

    fn counting<'b>(&'b self, out: &'b mut dyn Destination) -> Counting<'b> {
        Counting { out, written: &self.written }
    }
}

struct Counting<'a> {
    out: &'a mut dyn Destination,
    written: &'a AtomicU64,
}

impl Write for Counting<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let count = self.out.write(bytes)?;
        self.written.fetch_add(count as u64, Ordering::Relaxed);
        Ok(count)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}

impl Seek for Counting<'_> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.out.seek(to)
    }
}
