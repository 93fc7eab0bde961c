//! How far something that was measured, or solved elsewhere, is from the target and from the prediction.
//!
//! - a *mid-line* of any solver or of a marked strip is compared at equal arc lengths, as `verify` does;
//! - a *scan*, a meridian or points of a dome in any rigid placement, is compared with the nearest points, after the
//!   placement that fits best; stray points do not pull at it.
//!
//! [`table`] reads the file, `placement` fits, `start` finds where to begin, `dome` and `curve` measure distances, `line` and
//! `scan` compare, [`record`] is what `comparison.json` holds.

mod curve;
mod dome;
mod line;
mod placement;
pub mod record;
mod scan;
mod start;
pub mod table;

pub use dome::{Face, Surface};
pub use record::{Deviation, MeasuredComparison, PlacementRecord, PointStatistics};
pub use table::{Kind, MeasuredTable, read_table};

use curve::Curve;

use super::verification::require_shape;
use crate::design::Design;
use crate::error::Error;
use crate::input::InputError;
use crate::output::Provenance;
use crate::progress::Cancelled;

/// How a result is laid onto the target.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum PlacementChoice {
    /// A mid-line by its rim, a scan by the best fit.
    #[default]
    Auto,
    /// Not moved at all.
    AsGiven,
    /// A mid-line's first point on the target's.
    Rim,
    /// The rigid motion that fits best: of a mid-line in its plane, of a meridian along the axis (and across it where both
    /// sides are there), of points anywhere.
    Fit,
}

/// How a result is compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct MeasuredOptions {
    /// How it is laid onto the target.
    pub placement: PlacementChoice,
    /// The surface that points are compared with; `None`: the one that fits better.
    pub surface: Option<Surface>,
    /// The side of the sheet that was scanned.
    pub face: Face,
}

/// Compares a measured table with a design's target and with its prediction.
///
/// # Errors
/// [`Error::Input`] for a table that does not suit the design or the options, naming the file; [`Error::Cancelled`].
pub fn compare_table(
    design: &Design,
    table: &MeasuredTable,
    options: MeasuredOptions,
    cancelled: Cancelled<'_>,
) -> Result<MeasuredComparison, Error> {
    let wrong =
        |problem: &str, help: &str| Error::Input(InputError::new("", "", problem).help(help).in_file(&table.file));
    require_shape(design)?;
    let profile = design.profile();
    let line = |s: &[f64], x: &[f64], z: &[f64]| {
        let stations = s.iter().zip(x).zip(z).map(|((s, x), z)| [*s, *x, *z]);
        Curve::new(stations).ok_or_else(|| Error::Internal("a mid-line without length".to_owned()))
    };
    let target = line(&profile.s, &profile.x, &profile.z)?;
    let shape = design.voxel_path().map(crate::elastica::morph::MorphPath::final_shape);
    let prediction = shape.map(|p| line(&p.s, &p.x, &p.z)).transpose()?;
    let job = Job { design, table, target, prediction };
    let compared = match (table.kind, options.placement) {
        (Kind::Midline, _) if options.face != Face::Middle || options.surface.is_some() => {
            return Err(wrong("a mid-line has no faces and no surface", "leave out --face and --surface"));
        }
        (Kind::Midline, _) => line::compare(&job, options.placement)?,
        _ if design.input().is_strip() => {
            let help = "give the mid-line as columns s_mm,x_mm,z_mm";
            return Err(wrong("a rectangular strip has no axis to compare a scan about", help));
        }
        (_, PlacementChoice::Rim) => {
            return Err(wrong("only a mid-line is placed by its rim", "leave out --placement"));
        }
        (Kind::Meridian, _) if options.surface.is_some() => {
            return Err(wrong("a meridian is compared in its plane", "leave out --surface"));
        }
        _ => scan::compare(&job, options, cancelled)?,
    };
    let Compared { target, prediction, surface, midline } = compared;
    Ok(MeasuredComparison {
        provenance: Provenance::of(design.input()),
        result: record::ResultRecord {
            file: std::path::Path::new(&table.file)
                .file_name()
                .map_or_else(String::new, |name| name.to_string_lossy().into_owned()),
            sha256: table.sha256.clone(),
            kind: table.kind,
            rows: table.rows.len(),
        },
        face: options.face,
        surface,
        max_error_percent: target.max_error_percent,
        rms_error_percent: target.rms_error_percent,
        target,
        prediction,
        midline_mm: midline,
    })
}

/// What is compared.
struct Job<'a> {
    design: &'a Design,
    table: &'a MeasuredTable,
    /// The target, `(x, z)` from the rim.
    target: Curve,
    /// The forward model's shape of the voxelised strip.
    prediction: Option<Curve>,
}

impl Job<'_> {
    fn length(&self) -> f64 {
        self.design.input().strips.length_mm
    }
}

/// What comes out.
struct Compared {
    target: Deviation,
    prediction: Option<Deviation>,
    surface: Option<Surface>,
    midline: Vec<[f64; 3]>,
}
