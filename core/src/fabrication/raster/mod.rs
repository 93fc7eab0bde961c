//! A design as the voxels of a printer: slices of pixels, drawn row by row and never held as a whole.
//!
//! - [`pitch`] is the size of a printer's voxel;
//! - [`layout`] lays spokes on the bed and says which pixels belong to which;
//! - [`resample`] takes every pixel's phase from the voxel of the design that its centre lies in;
//! - [`dither`] chooses them anew from the continuous modulus, with exact counts;
//! - [`stack`] puts these together and draws one slice after the other;
//! - [`image`] encodes a slice as PNG.

pub mod dither;
pub mod image;
pub mod layout;
pub mod pitch;
pub mod resample;
pub mod stack;

pub use layout::{Layout, Raster};
pub use pitch::Pitch;
pub use stack::Stack;

/// What a pixel of a slice holds: void, or a phase counted from one, softest first.
pub type Pixel = u8;

/// A pixel without material.
pub const VOID: Pixel = 0;

/// Values a pixel may have: void and at most three phases.
pub const PIXEL_VALUES: usize = 4;

/// Draws the rows of one slice, from row 0 downwards, each exactly once.
pub trait Painter {
    /// Writes the pixels of a row; `pixels` holds void and is as long as the raster is wide.
    fn paint(&mut self, row: usize, pixels: &mut [Pixel]);
}
