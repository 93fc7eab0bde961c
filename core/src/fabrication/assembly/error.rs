//! What keeps the parts of an assembly from being made.

/// Why hub, base or post cannot be made for a design.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AssemblyError {
    /// The strip is curved so much that it leaves a straight slot almost at once.
    #[error(
        "at the {end} the strip leaves a straight slot after {depth_mm:.2} mm, and {least_mm:.2} mm are needed to hold it; use \
         fabrication.clearance_mm = {clearance_mm:.2} or more"
    )]
    TooCurved {
        /// Rim or hub.
        end: &'static str,
        /// How far it stays within the slot, mm.
        depth_mm: f64,
        /// Least depth of a slot, mm.
        least_mm: f64,
        /// Clearance that would do, mm.
        clearance_mm: f64,
    },
    /// Neighbouring slots would break into each other through their end walls.
    #[error(
        "with {count} spokes a clearance of {clearance_mm} mm makes neighbouring slots run into each other; use less than \
         {most_mm:.2} mm, or more spokes"
    )]
    SlotsCollide {
        /// Number of spokes.
        count: usize,
        /// Clearance, mm.
        clearance_mm: f64,
        /// Largest clearance, mm.
        most_mm: f64,
    },
    /// A slot and its wall reach across the axis.
    #[error(
        "the {part} has no room inside its slots: their inner wall would be {radius_mm:.2} mm from the axis, and at least \
         {least_mm:.2} mm are needed; use thinner walls (fabrication.wall_mm), a thinner sheet or a larger hub"
    )]
    NoRoomInside {
        /// Base or hub.
        part: &'static str,
        /// Radius of the inside, mm.
        radius_mm: f64,
        /// Least radius, mm.
        least_mm: f64,
    },
    /// The base is to be lower than its slots.
    #[error(
        "a base of {height_mm} mm is lower than its slots and floor need; use at least {least_mm:.2} mm, or leave it out"
    )]
    BaseTooLow {
        /// Height asked for, mm.
        height_mm: f64,
        /// Height needed, mm.
        least_mm: f64,
    },
    /// The dome runs through one of the parts.
    #[error(
        "the spokes run through the {part} at s = {s_mm:.2} mm, outside their slots; use thinner walls (fabrication.wall_mm), \
         a lower base or a thinner post"
    )]
    RunsThrough {
        /// The part.
        part: &'static str,
        /// Where, mm from the rim.
        s_mm: f64,
    },
    /// The post would be too thin.
    #[error(
        "the hub leaves room for a post of {diameter_mm:.2} mm only, and at least {least_mm:.2} mm are needed; use thinner \
         walls (fabrication.wall_mm) or a larger hub"
    )]
    PostTooThin {
        /// Diameter there is room for, mm.
        diameter_mm: f64,
        /// Least diameter, mm.
        least_mm: f64,
    },
    /// Dimensions so close to each other that a part's surface cannot be told apart in single precision.
    #[error(
        "the {part} has features too small for single precision; change fabrication.wall_mm or fabrication.clearance_mm a \
         little"
    )]
    TooFine {
        /// The part.
        part: &'static str,
    },
}

impl AssemblyError {
    /// The key of the design file that decides.
    #[must_use]
    pub fn key(&self) -> &'static str {
        match self {
            Self::TooCurved { .. } | Self::SlotsCollide { .. } | Self::TooFine { .. } => "fabrication.clearance_mm",
            Self::NoRoomInside { .. } | Self::RunsThrough { .. } => "fabrication.wall_mm",
            Self::BaseTooLow { .. } => "fabrication.base_height_mm",
            Self::PostTooThin { .. } => "fabrication.post_diameter_mm",
        }
    }
}
