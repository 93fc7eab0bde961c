//! Flat patterns: what a cutter cuts out of the sheet, in true scale.
//!
//! ```text
//!   OUTLINE  cut: the flower in one piece where its hub is level, its spokes otherwise; or the strip
//!   HUB      cut: the hub, where it is a piece of its own
//!   MARKS    to be engraved: axes at the rims, edges of the hub, its centre
//!   LABELS   to be engraved: numbers of the spokes; the title beside the parts
//! ```
//!
//! A cutter burns a kerf of some width and is led along its middle, so outlines are moved outward by half of it. Towards a level
//! hub the gap between two spokes closes; where it is narrower than the kerf no cutter can leave both edges, and the two lines
//! become one slit along the bisector that ends half a kerf before the hub's corner.

pub mod dxf;
pub mod polygon;
pub mod svg;

use std::f64::consts::PI;

use serde_json::json;

use self::polygon::{Point, area, crossing, offset, simplified};
use super::{Estimate, FOLDER, FabricationError, Job, Made, Maker, hub_is_level};
use crate::design::Design;
use crate::error::Error;
use crate::input::FabricationKind;
use crate::mesh::Flower;
use crate::output::folder::{Staging, WriteFailure};
use crate::output::tables::number;
use crate::progress::Progress;

/// Distance by which outlines may be off the design's, mm.
const TOLERANCE: f64 = 1e-3;
/// Least distance between two pieces, mm.
const GAP: f64 = 2.0;
/// Longest mark, mm.
const MARK: f64 = 3.0;

/// What a line is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Layer {
    /// Cut: spokes, or the flower.
    Outline,
    /// Cut: a hub of its own.
    Hub,
    /// Engraved: where parts meet.
    Marks,
    /// Engraved: texts.
    Labels,
}

impl Layer {
    /// All layers.
    pub const ALL: [Self; 4] = [Self::Outline, Self::Hub, Self::Marks, Self::Labels];

    /// Its name in files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Outline => "OUTLINE",
            Self::Hub => "HUB",
            Self::Marks => "MARKS",
            Self::Labels => "LABELS",
        }
    }
}

/// A text.
#[derive(Debug, Clone, PartialEq)]
pub struct Label {
    /// Where it is centred, mm.
    pub at: Point,
    /// Height of its capitals, mm.
    pub height: f64,
    /// Counter-clockwise, degrees.
    pub turn_deg: f64,
    /// What it says.
    pub text: String,
}

/// What is cut and engraved, mm, y up.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Pattern {
    /// Closed outlines of parts, counter-clockwise.
    pub parts: Vec<(Layer, Vec<Point>)>,
    /// Cuts that are no outline: slits between spokes, where a kerf closes the gap.
    pub slits: Vec<[Point; 2]>,
    /// Lines to be engraved.
    pub marks: Vec<[Point; 2]>,
    /// Texts.
    pub labels: Vec<Label>,
}

impl Pattern {
    /// The pattern of a design, compensated for a kerf.
    ///
    /// # Errors
    /// [`FabricationError::OutlineCrosses`] where the kerf is so wide that outlines cross themselves.
    pub fn of(design: &Design, kerf_mm: f64) -> Result<Self, FabricationError> {
        let pattern = if design.input().is_strip() {
            Self::strip(design, kerf_mm)
        } else if hub_is_level(design) {
            Self::one_piece(design, kerf_mm)
        } else {
            Self::separate(design, kerf_mm)
        };
        let crosses = |(_, part): &(Layer, Vec<Point>)| crossing(part).map(|(i, _)| part[i]);
        match pattern.parts.iter().find_map(crosses) {
            Some([x, y]) => Err(FabricationError::OutlineCrosses { kerf_mm, x, y }),
            None => Ok(pattern),
        }
    }

    /// Corners of the smallest upright rectangle around the parts.
    #[must_use]
    pub fn bounds(&self) -> [Point; 2] {
        let points = || self.parts.iter().flat_map(|(_, part)| part);
        let fold = |k: usize, f: fn(f64, f64) -> f64, start: f64| points().map(|p| p[k]).fold(start, f);
        let (low, high) = (|k| fold(k, f64::min, f64::INFINITY), |k| fold(k, f64::max, f64::NEG_INFINITY));
        [[low(0), low(1)], [high(0), high(1)]]
    }

    fn strip(design: &Design, kerf: f64) -> Self {
        let length = design.input().strips.length_mm;
        let half = 0.5 * design.profile().width.first().copied().unwrap_or(0.0);
        let rectangle = [[0.0, -half], [length, -half], [length, half], [0.0, half]];
        let mark = MARK.min(0.05 * length);
        let mut pattern = Self {
            parts: vec![(Layer::Outline, offset(&rectangle, 0.5 * kerf, true))],
            marks: vec![[[0.0, 0.0], [mark, 0.0]], [[length - mark, 0.0], [length, 0.0]]],
            ..Self::default()
        };
        pattern.title(design, kerf);
        pattern
    }

    /// One edge of a spoke in its own frame, `(s, half-width)` from the rim to the hub.
    fn edge(design: &Design) -> Vec<Point> {
        let profile = design.profile();
        let edge: Vec<Point> = profile.s.iter().zip(&profile.width).map(|(s, w)| [*s, 0.5 * w]).collect();
        simplified(&edge, 0.5 * TOLERANCE)
    }

    fn one_piece(design: &Design, kerf: f64) -> Self {
        let flower = flower(design);
        let (rim, half_sector) = (flower.hub_radius + flower.length, PI / flower.count as f64);
        // Along the x axis: up to the rim at y < 0, back at y > 0; the outside is to the right.
        let edge = Self::edge(design);
        let right = edge.iter().rev().map(|[s, half]| [rim - s, -half]);
        let left = edge.iter().map(|[s, half]| [rim - s, *half]);
        let moved = offset(&right.chain(left).collect::<Vec<Point>>(), 0.5 * kerf, false);
        // From the rim inward, as far as the edge stays on its side of the bisector.
        let (sin, cos) = half_sector.sin_cos();
        let beyond = |[x, y]: Point| y.abs() * cos - x * sin;
        let middle = moved.len() / 2;
        let mut inner: Vec<Point> = Vec::new();
        for point in &moved[middle..] {
            let over = beyond(*point);
            match inner.last() {
                Some(last) if over >= -1e-9 => {
                    let before = beyond(*last);
                    let share = if over > before { (-before / (over - before)).clamp(0.0, 1.0) } else { 1.0 };
                    let at: Point = std::array::from_fn(|k| last[k] + share * (point[k] - last[k]));
                    inner.push(at);
                    break;
                }
                _ => inner.push(*point),
            }
        }
        // The meeting point lies on the bisector exactly, so that neighbours share it.
        let meeting = inner.pop().map_or(0.0, |[x, y]| x.hypot(y));
        let corner = flower.hub_radius / cos;
        let mut outline = Vec::new();
        let mut pattern = Self::default();
        for spoke in 0..flower.count {
            let [c, s] = flower.outward(spoke);
            let turned = |[x, y]: Point| [x * c - y * s, x * s + y * c];
            outline.extend(inner.iter().rev().map(|[x, y]| turned([*x, -y])));
            outline.extend(inner.iter().map(|p| turned(*p)));
            let bisector = |radius: f64| turned([radius * cos, radius * sin]);
            outline.push(bisector(meeting));
            let end = corner + 0.5 * kerf;
            if meeting > end + TOLERANCE {
                pattern.slits.push([bisector(meeting), bisector(end)]);
            }
            pattern.mark_spoke(&flower, spoke, 0.0, design);
        }
        pattern.parts.push((Layer::Outline, outline));
        pattern.mark_hub(&flower);
        pattern.title(design, kerf);
        pattern
    }

    fn separate(design: &Design, kerf: f64) -> Self {
        let flower = flower(design);
        // Spokes are drawn away from the hub until nothing touches.
        let spread = (GAP + kerf) / (2.0 * (PI / flower.count as f64).sin()) + GAP + kerf;
        let edge = Self::edge(design);
        let rim = flower.hub_radius + flower.length + spread;
        let right = edge.iter().rev().map(|[s, half]| [rim - s, -half]);
        let left = edge.iter().map(|[s, half]| [rim - s, *half]);
        let spoke = offset(&right.chain(left).collect::<Vec<Point>>(), 0.5 * kerf, true);
        let mut pattern = Self::default();
        for index in 0..flower.count {
            let [c, s] = flower.outward(index);
            let turned = spoke.iter().map(|[x, y]| [x * c - y * s, x * s + y * c]).collect();
            pattern.parts.push((Layer::Outline, turned));
            pattern.mark_spoke(&flower, index, spread, design);
            let at = |radius: f64| [radius * c, radius * s];
            let foot = flower.hub_radius + spread;
            let mark = MARK.min(0.05 * flower.length);
            pattern.marks.push([at(foot), at(foot + mark)]);
        }
        let hub: Vec<Point> = (0..flower.count).map(|k| corner(&flower, k)).collect();
        pattern.parts.push((Layer::Hub, offset(&hub, 0.5 * kerf, true)));
        pattern.mark_hub(&flower);
        pattern.title(design, kerf);
        pattern
    }

    /// The axis at the rim, and the spoke's number.
    fn mark_spoke(&mut self, flower: &Flower, spoke: usize, spread: f64, design: &Design) {
        let [c, s] = flower.outward(spoke);
        let at = |radius: f64| [radius * c, radius * s];
        let rim = flower.hub_radius + flower.length + spread;
        self.marks.push([at(rim), at(rim - MARK.min(0.05 * flower.length))]);
        let profile = design.profile();
        let middle = profile.s.len() / 3;
        let (place, width) = (profile.s[middle], profile.width[middle]);
        self.labels.push(Label {
            at: at(rim - place),
            height: (0.25 * width).min(5.0),
            turn_deg: flower.azimuth_deg(spoke),
            text: number_of(spoke + 1),
        });
    }

    /// The centre of the hub and the middles of its edges.
    fn mark_hub(&mut self, flower: &Flower) {
        let mark = MARK.min(0.25 * flower.hub_radius);
        self.marks.extend([[[-mark, 0.0], [mark, 0.0]], [[0.0, -mark], [0.0, mark]]]);
        for spoke in 0..flower.count {
            let [c, s] = flower.outward(spoke);
            let at = |radius: f64| [radius * c, radius * s];
            self.marks.push([at(flower.hub_radius - mark), at(flower.hub_radius)]);
        }
    }

    /// What it is, below the parts.
    fn title(&mut self, design: &Design, kerf: f64) {
        let [[left, bottom], [right, _]] = self.bounds();
        let kerf = if kerf > 0.0 { format!(", kerf {} mm", number(kerf)) } else { String::new() };
        let text =
            format!("{}, {} mm thick, 1:1{kerf}", design.input().name, number(design.input().strips.thickness_mm));
        let height = (0.6 * (right - left) / text.chars().count().max(1) as f64).min(5.0);
        self.labels.push(Label { at: [0.5 * (left + right), bottom - 3.0 * height], height, turn_deg: 0.0, text });
    }
}

/// A number; one that reads as another upside down gets a dot.
fn number_of(spoke: usize) -> String {
    let text = spoke.to_string();
    let turns = text.chars().all(|c| "0689".contains(c)) && text.contains(['6', '9']);
    if turns { text + "." } else { text }
}

fn flower(design: &Design) -> Flower {
    let input = design.input();
    Flower { count: input.count(), hub_radius: input.hub_radius(), length: input.strips.length_mm }
}

/// Corner of the hub between a spoke and the next.
fn corner(flower: &Flower, spoke: usize) -> Point {
    let half = PI / flower.count as f64;
    let radius = flower.hub_radius / half.cos();
    let (sin, cos) = (half * (2 * spoke + 1) as f64).sin_cos();
    [radius * cos, radius * sin]
}

/// Writes `fabrication/pattern.dxf`.
pub struct DxfPattern;

/// Writes `fabrication/pattern.svg`.
pub struct SvgPattern;

impl Maker for DxfPattern {
    fn kind(&self) -> FabricationKind {
        FabricationKind::Dxf
    }

    fn plan(&self, job: &Job<'_>) -> Result<Estimate, FabricationError> {
        plan(job)
    }

    fn write(&self, job: &Job<'_>, staging: &mut Staging, _: Progress<'_>) -> Result<Made, Error> {
        let pattern = Pattern::of(job.design, job.input.kerf_mm)?;
        let path = format!("{FOLDER}/pattern.dxf");
        staging.write(&path, |out| dxf::write(&pattern, job.provenance, out).map_err(WriteFailure::from))?;
        Ok(made(job, &pattern, path))
    }
}

impl Maker for SvgPattern {
    fn kind(&self) -> FabricationKind {
        FabricationKind::Svg
    }

    fn plan(&self, job: &Job<'_>) -> Result<Estimate, FabricationError> {
        plan(job)
    }

    fn write(&self, job: &Job<'_>, staging: &mut Staging, _: Progress<'_>) -> Result<Made, Error> {
        let pattern = Pattern::of(job.design, job.input.kerf_mm)?;
        let path = format!("{FOLDER}/pattern.svg");
        staging.write_text(&path, &svg::text(&pattern, &job.design.input().name, job.provenance))?;
        Ok(made(job, &pattern, path))
    }
}

fn plan(job: &Job<'_>) -> Result<Estimate, FabricationError> {
    let pattern = Pattern::of(job.design, job.input.kerf_mm)?;
    let points: usize = pattern.parts.iter().map(|(_, part)| part.len()).sum();
    Ok(Estimate { voxels: 0, bytes: 60 * points as u64 + 300 * pattern.labels.len() as u64 + 40_000 })
}

fn made(job: &Job<'_>, pattern: &Pattern, path: String) -> Made {
    let [low, high] = pattern.bounds();
    let size = [high[0] - low[0], high[1] - low[1]];
    let parts = |layer: Layer| pattern.parts.iter().filter(|(of, _)| *of == layer).count();
    let areas: f64 = pattern.parts.iter().map(|(_, part)| area(part)).sum();
    let details = json!({
        "pieces": { "outline": parts(Layer::Outline), "hub": parts(Layer::Hub) },
        "one_piece": hub_is_level(job.design),
        "size_mm": size,
        "cut_area_mm2": areas,
        "kerf_mm": job.input.kerf_mm,
        "layers": Layer::ALL.map(Layer::name),
    });
    let [x, y] = size.map(|n| number((1e3 * n).round() / 1e3));
    let listed = vec![(path.clone(), format!("cut pattern of {} parts, {x} x {y} mm", pattern.parts.len()))];
    Made { files: vec![path], listed, details: details.as_object().cloned().unwrap_or_default() }
}
