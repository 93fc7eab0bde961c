//! All slices of a print stack, one after the other, drawn on all cores and held only until they are written.

use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering};

use super::dither::{CrossSection, Dithered};
use super::image::{Colours, Format, Image, encode};
use super::resample::Resampled;
use super::{Layout, PIXEL_VALUES, Painter, Pitch, Pixel, Raster, VOID};
use crate::design::Design;
use crate::error::Error;
use crate::fabrication::hub_is_level;
use crate::input::{FabricationInput, PrintSource};
use crate::progress::{Cancelled, Progress};
use crate::report::phase_colour;

/// Memory that encoded slices may take while they wait to be written, bytes.
const WAITING: u64 = 64 << 20;

/// A design as slices of a printer's voxels.
#[derive(Debug)]
pub struct Stack<'a> {
    raster: Raster,
    source: Source<'a>,
    colours: Colours,
}

#[derive(Debug)]
enum Source<'a> {
    Voxels(Resampled<'a>),
    Field(Dithered),
}

/// The raster of a design at a pitch.
#[must_use]
pub fn raster(design: &Design, input: &FabricationInput, pitch: Pitch) -> Raster {
    let layout = Layout::of(design, input.scope);
    let thickness = design.input().strips.thickness_mm;
    let outline = match input.source {
        PrintSource::Voxels => Resampled::outline(design.grid()),
        PrintSource::Field => {
            let profile = design.profile();
            profile.s.iter().zip(&profile.width).map(|(s, width)| [*s, 0.5 * width]).collect()
        }
    };
    Raster::new(layout, pitch, &outline, thickness)
}

/// Bytes of all slices of a stack, estimated from how often its rows change colour.
#[must_use]
pub fn estimated_bytes(design: &Design, input: &FabricationInput, raster: &Raster, format: Format) -> f64 {
    let [columns, rows, slices] = [raster.columns, raster.rows, raster.slices].map(|n| n as f64);
    let volume = design.grid().volume_mm3() * raster.layout().spokes() as f64;
    let filled = volume / raster.pitch.mm.iter().product::<f64>();
    let rgba = format == Format::Rgba;
    let blank = columns * rows * slices * if rgba { 4.0 } else { 0.25 } / 200.0;
    let changes = match input.source {
        PrintSource::Voxels => filled * (raster.pitch.mm[0] / design.grid().size_mm()).min(1.0),
        PrintSource::Field => filled,
    };
    blank + changes * if rgba { 1.5 } else { 0.4 } + slices * 100.0
}

impl<'a> Stack<'a> {
    /// The stack of a design in a raster; `None` once it is cancelled.
    #[must_use]
    pub fn new(design: &'a Design, input: &FabricationInput, raster: Raster, cancelled: Cancelled<'_>) -> Option<Self> {
        let phases = design.phases().phases().len();
        let with_hub = matches!(raster.layout(), Layout::Flower(_)) && hub_is_level(design);
        let hub = if with_hub { hub_pixel(phases) } else { VOID };
        let source = match input.source {
            PrintSource::Voxels => Source::Voxels(Resampled::new(design, raster, hub)),
            PrintSource::Field => Source::Field(Dithered::new(design, raster, hub, cancelled)?),
        };
        let colours: Vec<[u8; 3]> = (0..phases).map(|i| phase_colour(i, phases)).collect();
        Some(Self { raster, source, colours: Colours::new(&colours) })
    }

    /// The raster.
    #[must_use]
    pub fn raster(&self) -> &Raster {
        &self.raster
    }

    /// The colours.
    #[must_use]
    pub fn colours(&self) -> &Colours {
        &self.colours
    }

    /// Cross-sections of a spoke, where the stack was dithered.
    #[must_use]
    pub fn sections(&self, spoke: usize) -> &[CrossSection] {
        match &self.source {
            Source::Voxels(_) => &[],
            Source::Field(dithered) => dithered.sections(spoke),
        }
    }

    /// Draws a slice.
    #[must_use]
    pub fn painter(&self, slice: usize) -> Box<dyn Painter + '_> {
        match &self.source {
            Source::Voxels(resampled) => Box::new(resampled.painter(slice)),
            Source::Field(dithered) => Box::new(dithered.painter(slice)),
        }
    }

    /// Slices that show the same picture stand in one range.
    #[must_use]
    pub fn distinct(&self) -> Vec<Range<usize>> {
        let slices = self.raster.slices;
        let Source::Voxels(resampled) = &self.source else { return (0..slices).map(|i| i..i + 1).collect() };
        let mut ranges: Vec<Range<usize>> = Vec::new();
        for slice in 0..slices {
            match ranges.last_mut() {
                Some(range) if resampled.layer(range.start) == resampled.layer(slice) => range.end = slice + 1,
                _ => ranges.push(slice..slice + 1),
            }
        }
        ranges
    }

    /// Draws and encodes all slices and hands them on from the lowest to the highest, together with the range of slices that
    /// look like it. `progress` counts voxels and then the bytes that `emit` returns. Returns the number of voxels of
    /// every value, void first.
    ///
    /// # Errors
    /// [`Error::Cancelled`], and what `emit` returns.
    pub fn draw<E: From<Error>>(
        &self,
        format: Format,
        bytes: f64,
        progress: Progress<'_>,
        mut emit: impl FnMut(Range<usize>, &Image) -> Result<u64, E>,
    ) -> Result<[u64; PIXEL_VALUES], E> {
        let ranges = self.distinct();
        let expected = (bytes / self.raster.slices.max(1) as f64).max(1.0) as u64;
        let batch = rayon::current_num_threads().clamp(1, (WAITING / expected).clamp(1, 256) as usize);
        let done = AtomicU64::new(0);
        let mut totals = [0; PIXEL_VALUES];
        let mut rest = ranges.chunks(batch);
        let mut ready: Vec<(Range<usize>, Drawn)> = Vec::new();
        loop {
            let ranges = rest.next().unwrap_or_default();
            let mut next: Vec<Drawn> = ranges.iter().map(|_| Ok(None)).collect();
            rayon::in_place_scope(|scope| {
                for (slot, range) in next.iter_mut().zip(ranges) {
                    let (done, copies) = (&done, range.len() as u64);
                    scope.spawn(move |_| {
                        let row = self.raster.columns as u64 * copies;
                        let go_on = || progress(done.fetch_add(row, Ordering::Relaxed) + row);
                        let mut painter = self.painter(range.start);
                        *slot = encode(&self.raster, painter.as_mut(), format, &self.colours, &go_on);
                    });
                }
                for (range, drawn) in ready.drain(..) {
                    let image = drawn.map_err(|e| Error::Internal(format!("a slice: {e}")))?;
                    let Some(image) = image else { return Err(Error::Cancelled.into()) };
                    for (total, count) in totals.iter_mut().zip(image.counts) {
                        *total += count * range.len() as u64;
                    }
                    let written = emit(range, &image)?;
                    if !progress(done.fetch_add(written, Ordering::Relaxed) + written) {
                        return Err(Error::Cancelled.into());
                    }
                }
                Ok::<(), E>(())
            })?;
            if ranges.is_empty() {
                return Ok(totals);
            }
            ready = ranges.iter().cloned().zip(next).collect();
        }
    }
}

/// A slice, drawn, cancelled or refused.
type Drawn = Result<Option<Image>, png::EncodingError>;

/// What the hub of a flat flower is made of: the stiffest phase, since the design takes it to be rigid.
fn hub_pixel(phases: usize) -> Pixel {
    u8::try_from(phases).unwrap_or(VOID)
}
