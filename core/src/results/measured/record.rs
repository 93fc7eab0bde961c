//! What `comparison.json` holds.

use serde::Serialize;

use super::dome::{Face, Surface};
use super::placement::Placement;
use super::table::Kind;
use crate::output::Provenance;

/// Contents of `comparison.json`.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct MeasuredComparison {
    /// Version, seed and hash of the design.
    #[serde(flatten)]
    pub provenance: Provenance,
    /// What was compared.
    pub result: ResultRecord,
    /// The side of the sheet that was scanned.
    pub face: Face,
    /// The surface that points were compared with.
    pub surface: Option<Surface>,
    /// `target.max_error_percent`.
    pub max_error_percent: f64,
    /// `target.rms_error_percent`.
    pub rms_error_percent: f64,
    /// Against the target.
    pub target: Deviation,
    /// Against the shape that the forward model predicts for the voxelised strip.
    pub prediction: Option<Deviation>,
    /// `[s, x, z]` of the mid-line as it lies on the target, rim first, seen from the target's rim; of a scan its mean meridian.
    pub midline_mm: Vec<[f64; 3]>,
}

/// A compared file, without its path.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct ResultRecord {
    /// Name.
    pub file: String,
    /// SHA-256 of its bytes.
    pub sha256: String,
    /// What its rows are.
    pub kind: Kind,
    /// Number of rows.
    pub rows: usize,
}

/// Distances from a shape, percent of the length. A mid-line's are those at equal arc lengths; a scan's those of its mean
/// meridian from the nearest points, in which the scanner's noise has averaged out.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Deviation {
    /// Largest distance.
    pub max_error_percent: f64,
    /// Root mean square distance.
    pub rms_error_percent: f64,
    /// Largest distance from the nearest point of the shape, where that differs.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max_shape_error_percent: Option<f64>,
    /// Distances of the single points of a scan.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub points: Option<PointStatistics>,
    /// Where the result was laid.
    pub placement: PlacementRecord,
    /// Arc length, mm, and distance, percent, along the strip.
    #[serde(skip)]
    pub along: Vec<[f64; 2]>,
    /// Some points of the scan as they lie on the shape: distance from the rim and height, mm.
    #[serde(skip)]
    pub cloud: Vec<[f64; 2]>,
}

/// The single points of a scan.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct PointStatistics {
    /// Points that were compared.
    pub compared: usize,
    /// Points further from the dome than a tenth of the length: no part of it.
    pub stray: usize,
    /// Points on the hub, which has no meridian.
    pub on_hub: usize,
    /// Points beyond the rim or the hub edge.
    pub beyond_ends: usize,
    /// Root mean square distance, mm.
    pub rms_mm: f64,
    /// Distance that 95 % of the points do not exceed, mm.
    pub p95_mm: f64,
    /// Largest distance, mm.
    pub max_mm: f64,
    /// Mean distance, positive outside, mm.
    pub mean_mm: f64,
}

/// A rigid motion: a point `p` of the file lies at `R p + shift` in the dome's frame, `R` the right-handed rotation by the
/// angle about the axis. The dome's frame has its origin on the axis, in the plane of the rim, z upward; that of a single
/// mid-line has the rim as its origin and x towards the hub.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct PlacementRecord {
    /// `as-given`, `rim` or `fit`.
    pub choice: &'static str,
    /// Unit vector.
    pub rotation_axis: [f64; 3],
    /// Angle, degrees.
    pub rotation_angle_deg: f64,
    /// Shift, mm.
    pub shift_mm: [f64; 3],
    /// Direction of the dome's axis in the file's coordinates, from the rim to the hub.
    pub dome_axis: [f64; 3],
    /// The origin of the dome's frame in the file's coordinates, mm.
    pub dome_origin_mm: [f64; 3],
    /// Standard uncertainty of the rotation, degrees; absent where the points leave it open.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rotation_uncertainty_deg: Option<f64>,
    /// Standard uncertainty of the shift, mm; absent where the points leave it open.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shift_uncertainty_mm: Option<f64>,
}

impl PlacementRecord {
    pub(super) fn new(choice: &'static str, placement: &Placement) -> Self {
        let (axis, angle) = placement.axis_angle();
        let back = placement.rotation.inverse();
        Self {
            choice,
            rotation_axis: axis.into_inner().into(),
            rotation_angle_deg: angle.to_degrees(),
            shift_mm: placement.shift.into(),
            dome_axis: (back * nalgebra::Vector3::z()).into(),
            dome_origin_mm: (back * -placement.shift).into(),
            rotation_uncertainty_deg: None,
            shift_uncertainty_mm: None,
        }
    }

    pub(super) fn uncertain(mut self, [turn, shift]: [f64; 2]) -> Self {
        self.rotation_uncertainty_deg = turn.is_finite().then(|| turn.to_degrees());
        self.shift_uncertainty_mm = shift.is_finite().then_some(shift);
        self
    }
}
