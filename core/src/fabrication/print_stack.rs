//! Voxel print stacks: a folder of PNG slices, or GrabCAD's container of them.
//!
//! Every slice has the same size and none is left out. Seen as a picture, a slice is the part from above: column 0 has the
//! smallest x, row 0 the largest y, slice 0 is the lowest.

use serde_json::{Map, Value, json};

use super::raster::image::Format;
use super::raster::{PIXEL_VALUES, Pitch, Raster, Stack, stack};
use super::{Estimate, FOLDER, FabricationError, Job, Made, Maker, gcvf};
use crate::error::Error;
use crate::input::{FabricationKind, PrintSource, Scope};
use crate::output::folder::{Staging, WriteFailure};
use crate::output::tables::number;
use crate::progress::Progress;

/// Voxels, void included, above which a stack is refused unless it was asked for explicitly: about a minute's work.
pub const LARGEST_STACK: f64 = 4e9;

/// Most pixels along a side of an image that its readers can be expected to take.
pub const LARGEST_SIDE: u32 = 65_500;

/// Writes `fabrication/print_stack/slice_0000.png` and so on.
pub struct PrintStack;

/// Writes `fabrication/spoke.gcvf` or `fabrication/flower.gcvf`.
pub struct Gcvf;

impl Maker for PrintStack {
    fn kind(&self) -> FabricationKind {
        FabricationKind::PrintStack
    }

    fn plan(&self, job: &Job<'_>) -> Result<Estimate, FabricationError> {
        plan(self.kind(), job, Pitch::of(job.input), Format::Indexed)
    }

    fn write(&self, job: &Job<'_>, staging: &mut Staging, progress: Progress<'_>) -> Result<Made, Error> {
        let (stack, bytes) = prepared(job, Pitch::of(job.input), Format::Indexed, progress)?;
        let slices = stack.raster().slices;
        let digits = slices.saturating_sub(1).to_string().len().max(4);
        let name = |slice: usize| format!("slice_{slice:0digits$}.png");
        let path = format!("{FOLDER}/print_stack");
        let mut files: Vec<String> = (0..slices).map(|slice| format!("{path}/{}", name(slice))).collect();
        let counts = staging.write_folder(&path, is_slice, |folder| {
            let counts = stack.draw(Format::Indexed, bytes, progress, |range, image| {
                let size = image.png.len() as u64 * range.len() as u64;
                range.into_iter().try_for_each(|slice| folder.write(&name(slice), &image.png))?;
                Ok::<u64, Error>(size)
            })?;
            if let Some(table) = cross_sections(job, &stack) {
                folder.write(TABLE, table.as_bytes())?;
            }
            Ok(counts)
        })?;
        if job.input.source == PrintSource::Field {
            files.push(format!("{path}/{TABLE}"));
        }
        let listed = vec![(format!("{path}/"), describe(stack.raster()))];
        Ok(Made { files, listed, details: details(job, &stack, counts) })
    }
}

impl Maker for Gcvf {
    fn kind(&self) -> FabricationKind {
        FabricationKind::Gcvf
    }

    fn plan(&self, job: &Job<'_>) -> Result<Estimate, FabricationError> {
        plan(self.kind(), job, Pitch::of(job.input).rounded_to_dots(), Format::Rgba)
    }

    fn write(&self, job: &Job<'_>, staging: &mut Staging, progress: Progress<'_>) -> Result<Made, Error> {
        let (stack, bytes) = prepared(job, Pitch::of(job.input).rounded_to_dots(), Format::Rgba, progress)?;
        let path = format!("{FOLDER}/{}.gcvf", scope_name(job));
        let mut counts = [0; PIXEL_VALUES];
        staging.write(&path, |out| {
            counts = gcvf::write(job, &stack, bytes, out, progress)?;
            Ok::<(), WriteFailure>(())
        })?;
        let mut details = details(job, &stack, counts);
        details.insert("dpi".to_owned(), json!(stack.raster().pitch.dpi()));
        let listed = vec![(path.clone(), describe(stack.raster()))];
        Ok(Made { files: vec![path], listed, details })
    }
}

/// Counts and targets of dithered cross-sections, beside the slices.
const TABLE: &str = "cross_sections.csv";

fn is_slice(name: &str) -> bool {
    let number = name.strip_prefix("slice_").and_then(|rest| rest.strip_suffix(".png"));
    name == TABLE || number.is_some_and(|n| !n.is_empty() && n.bytes().all(|b| b.is_ascii_digit()))
}

/// `spoke` or `flower`.
pub(super) fn scope_name(job: &Job<'_>) -> &'static str {
    match job.input.scope {
        Scope::Flower if !job.design.input().is_strip() => "flower",
        _ => "spoke",
    }
}

fn plan(kind: FabricationKind, job: &Job<'_>, pitch: Pitch, format: Format) -> Result<Estimate, FabricationError> {
    let raster = stack::raster(job.design, job.input, pitch);
    let (voxels, limit) = (raster.voxels(), LARGEST_STACK);
    if voxels > limit && !job.allow_large {
        return Err(FabricationError::TooManyVoxels { kind, voxels, limit, pitch_um: pitch.um() });
    }
    let pixels = raster.columns.max(raster.rows) as f64;
    if pixels > f64::from(LARGEST_SIDE) {
        return Err(FabricationError::ImageTooLarge { kind, pixels, limit: LARGEST_SIDE });
    }
    let bytes = stack::estimated_bytes(job.design, job.input, &raster, format);
    Ok(Estimate { voxels: voxels as u64, bytes: bytes as u64 })
}

fn prepared<'a>(
    job: &Job<'a>,
    pitch: Pitch,
    format: Format,
    progress: Progress<'_>,
) -> Result<(Stack<'a>, f64), Error> {
    let raster = stack::raster(job.design, job.input, pitch);
    let bytes = stack::estimated_bytes(job.design, job.input, &raster, format);
    let stack = Stack::new(job.design, job.input, raster, &|| !progress(0)).ok_or(Error::Cancelled)?;
    Ok((stack, bytes))
}

fn describe(raster: &Raster) -> String {
    let [x, y, z] = raster.pitch.um().map(number);
    format!("{} slices of {} x {} pixels, {x} x {y} x {z} um", raster.slices, raster.columns, raster.rows)
}

fn details(job: &Job<'_>, stack: &Stack<'_>, counts: [u64; PIXEL_VALUES]) -> Map<String, Value> {
    let raster = stack.raster();
    let phases = job.design.phases().phases();
    let by_phase: Map<String, Value> =
        phases.iter().zip(&counts[1..]).map(|(phase, n)| (phase.label(), json!(n))).collect();
    let colours: Map<String, Value> =
        (1..).zip(phases).map(|(pixel, phase)| (phase.label(), json!(stack.colours().of(pixel)))).collect();
    let mut details = Map::new();
    let mut insert = |key: &str, value: Value| details.insert(key.to_owned(), value);
    insert("scope", json!(scope_name(job)));
    insert("source", json!(job.input.source));
    insert("pitch_um", json!(raster.pitch.um()));
    insert("columns", json!(raster.columns));
    insert("rows", json!(raster.rows));
    insert("slices", json!(raster.slices));
    insert("size_mm", json!(raster.size_mm()));
    insert("origin_mm", json!(raster.origin_mm));
    insert("orientation", json!("column 0: least x; row 0: largest y; slice 0: least z"));
    insert("colours_rgba", Value::Object(colours));
    insert("voxels", Value::Object(by_phase));
    insert("void", json!(counts[0]));
    if job.input.source == PrintSource::Field {
        let clamped: usize = (0..raster.layout().spokes())
            .map(|spoke| stack.sections(spoke).iter().filter(|section| section.clamped).count())
            .sum();
        insert("clamped_cross_sections", json!(clamped));
    }
    details
}

/// The table of cross-sections, one row each, spoke after spoke; nothing where voxels were resampled.
fn cross_sections(job: &Job<'_>, stack: &Stack<'_>) -> Option<String> {
    if job.input.source != PrintSource::Field {
        return None;
    }
    let phases = job.design.phases().phases();
    let mut text = "spoke,s_mm,voxels".to_owned();
    for phase in phases {
        text.push_str(&format!(",target_{0},count_{0}", phase.label()));
    }
    text.push('\n');
    for spoke in 0..stack.raster().layout().spokes() {
        for section in stack.sections(spoke) {
            text.push_str(&format!("{},{},{}", spoke + 1, number(section.s_mm), section.voxels));
            for k in 0..phases.len() {
                text.push_str(&format!(",{},{}", number(section.targets[k]), section.counts[k]));
            }
            text.push('\n');
        }
    }
    Some(text)
}
