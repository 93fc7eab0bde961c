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
mod error;
mod figures;
mod key_numbers;
pub mod page;
mod palette;
mod svg;
mod tables;
mod text;
pub mod unit_cells;
pub mod verification;

pub use error::ReportError;
pub use page::html;
pub use verification::{VerificationPicture, verification_svg};
