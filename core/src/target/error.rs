//! What can be wrong with a target.

use std::fmt;

/// Where a point stands in what the user handed over: a line of a file, or a place in a list.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Row {
    /// A line of a text file, counted from 1.
    Line(u64),
    /// A point of a list in memory, counted from 1.
    Point(usize),
}

impl fmt::Display for Row {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line(line) => write!(f, "line {line}"),
            Self::Point(point) => write!(f, "point {point}"),
        }
    }
}

/// A target that cannot be used, with the offending value and what would help.
///
/// The design file's name and key are added by the caller, who knows them.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TargetError {
    /// A length or ratio outside its range.
    #[error("{name} is {value}; it must be {allowed}")]
    OutOfRange { name: &'static str, value: f64, allowed: &'static str },

    /// Reading or fitting was cancelled.
    #[error("cancelled")]
    Cancelled,
    /// A file that cannot be read.
    #[error("{path} cannot be read: {reason}")]
    Unreadable { path: String, reason: String },
    /// More bytes than any sensible target has.
    #[error("the {what} holds {bytes} bytes; the limit is {limit}: hand over fewer points or a coarser mesh")]
    TooManyBytes { what: &'static str, bytes: u64, limit: u64 },

    /// A first row of words that are not the known column names.
    #[error("{row} names the columns `{found}`; they must be `rho,z` (or `rho_mm,z_mm`), or the header left out")]
    Header { row: Row, found: String },
    /// A row that has not exactly two columns.
    #[error("{row} has {found} column(s); it must have 2, rho and z, separated by a comma")]
    ColumnCount { row: Row, found: usize },
    /// Text where a number belongs.
    #[error("{row}, column {column}: `{value}` is not a number (decimal point, no unit)")]
    NotANumber { row: Row, column: &'static str, value: String },
    /// NaN or an infinity.
    #[error("{row}, column {column}: {value} is not finite; leave such rows out")]
    NotFinite { row: Row, column: &'static str, value: f64 },
    /// A radius below zero.
    #[error("{row}, column rho: the radius {value} is negative; give one side of the meridian only")]
    NegativeRadius { row: Row, value: f64 },
    /// A file in a form the CSV reader refuses.
    #[error("the table cannot be read: {reason}")]
    Table { reason: String },
    /// Fewer different points than a curve needs.
    #[error("the meridian has {found} different point(s); it needs at least {needed}")]
    TooFewPoints { found: usize, needed: usize },
    /// More points than the limit.
    #[error("the meridian has more than {limit} points; leave out points, a few hundred describe any dome")]
    TooManyPoints { limit: usize },
    /// Consecutive segments that reverse direction.
    #[error(
        "the meridian doubles back at {row}: it turns by {angle_deg:.0} degrees there, at most {limit_deg:.0} can be \
         a curve; sort the points along the meridian and leave out bases and inner surfaces"
    )]
    DoublesBack { row: Row, angle_deg: f64, limit_deg: f64 },
    /// A meridian that crosses itself.
    #[error(
        "the meridian crosses itself: the segment from {row} meets the one from {other}; one strip cannot follow it"
    )]
    CrossesItself { row: Row, other: Row },
    /// A meridian that cannot be cut at the hub radius at any scale.
    #[error(
        "scaled to an arc length of {length_mm} mm the meridian ends at a radius of {end_radius_mm:.4} mm, outside the \
         hub radius of {hub_radius_mm} mm: continue the meridian towards the axis, or set the hub radius to at least \
         {end_radius_mm:.4} mm"
    )]
    EndsOutsideHub { length_mm: f64, end_radius_mm: f64, hub_radius_mm: f64 },
    /// A fit that has no solution, which data that passed the checks do not cause.
    #[error("no smooth curve fits the {points} points of the meridian ({reason}); check them for stray values")]
    NoFit { points: usize, reason: &'static str },

    /// A file whose ending is none of the readable ones.
    #[error("`{extension}` files are not read; export the mesh as .obj, .gltf, .glb or .stl")]
    MeshFormat { extension: String },
    /// A mesh file that its format's reader refuses.
    #[error("the {format} file cannot be read: {reason}")]
    MeshFile { format: &'static str, reason: String },
    /// A count declared in the file that its bytes cannot hold.
    #[error("the {format} file declares {declared} {what}, its bytes hold {held}: it is cut short or damaged")]
    Truncated { format: &'static str, what: &'static str, declared: u64, held: u64 },
    /// A glTF buffer that is neither embedded nor a file beside the glTF file.
    #[error("the glTF file refers to `{uri}`: {reason}")]
    BufferUri { uri: String, reason: String },
    /// A mesh without triangles.
    #[error("the mesh has {vertices} vertices and {triangles} triangles; it needs at least one triangle")]
    EmptyMesh { vertices: usize, triangles: usize },
    /// A mesh with more vertices or triangles than the limit.
    #[error("the mesh has {found} {what}; the limit is {limit}: decimate it")]
    MeshTooLarge { what: &'static str, found: u64, limit: u64 },
    /// A vertex with NaN or an infinity.
    #[error("vertex {vertex} of the mesh has the coordinate {value}, which is not finite")]
    VertexNotFinite { vertex: usize, value: f64 },
    /// A triangle that refers to a vertex that does not exist.
    #[error("triangle {triangle} refers to vertex {index}, the mesh has {vertices} (counted from 0)")]
    IndexOutOfRange { triangle: usize, index: u64, vertices: usize },

    /// An axis without direction.
    #[error("the axis [{}, {}, {}] has no direction; give a finite vector from rim to apex", .axis[0], .axis[1], .axis[2])]
    NoDirection { axis: [f64; 3] },
    /// A surface whose normals and extent leave the axis open.
    #[error(
        "the axis of revolution cannot be told from the mesh (a sphere's part, say, or too few faces); set axis to \
         \"x\", \"y\", \"z\" or to a vector from rim to apex"
    )]
    AxisUndetermined,
    /// A vector that points from the apex to the rim.
    #[error(
        "along the given axis the lower end has the radius {lower:.4} and the upper one {upper:.4} (in the mesh's unit): \
         the axis must point from the rim to the apex; use its opposite"
    )]
    AxisReversed { lower: f64, upper: f64 },
    /// No usable outline: too coarse, or nothing that looks like a meridian.
    #[error(
        "about its axis the mesh has {found} different ring(s) of vertices on its outer surface; a meridian needs at \
         least {needed}: refine the mesh along the meridian, or check the axis"
    )]
    TooFewRings { found: usize, needed: usize },
    /// Too few vertices to tell whether the mesh is round.
    #[error(
        "the outer surface of the mesh has {found} vertices about its axis; at least {needed} are needed to tell whether \
         it is round: refine the mesh, or check the axis"
    )]
    TooFewVertices { found: usize, needed: usize },
    /// A mesh too far from a surface of revolution.
    #[error(
        "the mesh is no surface of revolution: its vertices lie {share_percent:.2} % of the rim radius (rms) off the \
         best one, the limit is {limit_percent} %; leave out what is not the dome, check the axis, and name it where the \
         dome does not go all the way round"
    )]
    NotARevolution { share_percent: f64, limit_percent: f64 },
}
