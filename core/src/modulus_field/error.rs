//! What can be wrong with the data a modulus field is fitted to.

use super::samples::{LENGTH_RANGE_MM, MINIMUM_STATIONS, MODULUS_RANGE_MPA};

/// Stations or moduli that no field can be fitted to, with the offending value and what is allowed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ModulusFieldError {
    /// The strip's length is not a number, not positive, or out of range.
    #[error("the strip is {value_mm} mm long; its length must be between {:e} and {:e} mm", LENGTH_RANGE_MM[0], LENGTH_RANGE_MM[1])]
    Length {
        /// The length given, mm.
        value_mm: f64,
    },
    /// Positions and moduli do not belong together.
    #[error("there are {stations} stations but {moduli} moduli; each station needs one modulus")]
    CountMismatch {
        /// Positions given.
        stations: usize,
        /// Moduli given.
        moduli: usize,
    },
    /// Too few stations to describe the modulus.
    #[error("{count} stations are too few to fit the modulus along the strip; give at least {MINIMUM_STATIONS}")]
    TooFewStations {
        /// Stations given.
        count: usize,
    },
    /// A station is not where an even grid from rim to hub has it.
    #[error(
        "station {index} is at {value_mm} mm; evenly spaced stations from 0 at the rim to the strip's length have it at \
         {expected_mm} mm"
    )]
    Station {
        /// Index of the station, from 0 at the rim.
        index: usize,
        /// Its position, mm.
        value_mm: f64,
        /// Where it should be, mm.
        expected_mm: f64,
    },
    /// A modulus is not a number, not positive, or out of range.
    #[error(
        "the modulus at s = {s_mm} mm is {value_mpa} MPa; it must be between {:e} and {:e} MPa",
        MODULUS_RANGE_MPA[0], MODULUS_RANGE_MPA[1]
    )]
    Modulus {
        /// Position of the station, mm.
        s_mm: f64,
        /// The modulus there, MPa.
        value_mpa: f64,
    },
}
