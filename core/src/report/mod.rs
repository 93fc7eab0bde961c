//! The report of a design and the picture of a verification.
//!
//! [`html`] writes one self-contained page: numbers, warnings, figures, inputs. [`verification_svg`] draws what a solver
//! found over what was wanted. Both are texts without a date, so the same design gives the same bytes; the page is
//! well-formed XML as well, asks nothing of the network and runs no script.
//!
//! - [`page`] is the table of contents; `key_numbers` and `tables` are its tables, `figures` its pictures;
//! - `chart` draws axes and curves with plotters; `svg` and `cells` draw what is no chart;
//! - `palette` has one ramp from soft to stiff for moduli and phases alike, readable in grey.

mod cells;
mod chart;
pub mod conduction;
mod error;
mod figures;
pub mod indentation;
mod key_numbers;
pub mod page;
mod palette;
mod svg;
pub mod sweep;
mod tables;
mod text;
pub mod unit_cells;
pub mod verification;

pub use error::ReportError;
pub use page::html;
pub(crate) use text::{escape, number};
pub use verification::{VerificationPicture, verification_svg};

/// The colour of one of `count` phases, softest first: red, green, blue, the same in pictures and in printed files.
#[must_use]
pub fn phase_colour(index: usize, count: usize) -> [u8; 3] {
    palette::phase(index, count).0
}

/// The colour of the hub.
pub const HUB_COLOUR: [u8; 3] = palette::HUB.0;

/// The colour of a share from soft (0) to stiff (1).
#[must_use]
pub fn modulus_colour(share: f64) -> [u8; 3] {
    palette::ramp(share).0
}
