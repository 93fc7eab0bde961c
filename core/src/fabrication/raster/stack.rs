//! All slices of a print stack, one after the other, drawn on all cores and held only until they are written.

use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering};

use super::dither::{CrossSection, Dithered};
use super::image::{Colours, Content, Encoding, Format, Image, encode};
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
    // Bytes a pixel of one colour, and bytes a change of colour or a voxel of a mixture, as measured; a margin included.
    let blank = columns * rows * slices * if rgba { 4.0 } else { 0.25 } / 200.0;
    let rest = match input.source {
        PrintSource::Voxels => {
            let changes = filled * (raster.pitch.mm[0] / design.grid().size_mm()).min(1.0);
            changes * if rgba { 4.0 } else { 1.0 }
        }
        PrintSource::Field => filled * if rgba { 0.5 } else { 0.25 },
    };
    blank + rest + slices * 100.0
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

    /// How its slices are encoded.
    #[must_use]
    pub fn encoding(&self, format: Format) -> Encoding {
        let content = match self.source {
            Source::Voxels(_) => Content::Areas,
            Source::Field(_) => Content::Mixture,
        };
        Encoding { format, content, colours: self.colours }
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
        let (done, encoding) = (AtomicU64::new(0), self.encoding(format));
        let mut totals = [0; PIXEL_VALUES];
        let mut rest = ranges.chunks(batch);
        let mut ready: Vec<(Range<usize>, Drawn)> = Vec::new();
        loop {
            let ranges = rest.next().unwrap_or_default();
            let mut next: Vec<Drawn> = ranges.iter().map(|_| Ok(None)).collect();
            rayon::in_place_scope(|scope| {
                for (slot, range) in next.iter_mut().zip(ranges) {
                    let (done, encoding, copies) = (&done, &encoding, range.len() as u64);
                    scope.spawn(move |_| {
                        let row = self.raster.columns as u64 * copies;
                        let go_on = || progress(done.fetch_add(row, Ordering::Relaxed) + row);
                        let mut painter = self.painter(range.start);
                        *slot = encode(&self.raster, painter.as_mut(), encoding, &go_on);
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

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::input::files::Format as TextFormat;
    use crate::input::{Printer, Scope};
    use crate::progress::{ignore, never};
    use crate::{DesignInput, Limits};

    const SMALL: &str = r#"
        [target]
        kind = "hemi-ellipsoid"
        [strips]
        count = 5
        length_mm = 20.0
        hub_radius_mm = 3.0
        thickness_mm = 1.0
        [materials]
        phases = ["FLX9070", "FLX9095"]
        [voxels]
        size_mm = 0.5
    "#;

    fn design(pattern: &str, phases: &str) -> Design {
        let text = SMALL
            .replace("size_mm = 0.5", &format!("size_mm = 0.5\npattern = \"{pattern}\""))
            .replace("\"FLX9070\", \"FLX9095\"", phases);
        let input = DesignInput::from_text(&text, TextFormat::Toml, "test", "test", Path::new("")).unwrap();
        Design::compute(&input, Limits::default()).unwrap()
    }

    const TWO: &str = "\"FLX9070\", \"FLX9095\"";
    const THREE: &str = "\"TangoBlack\", \"FLX9070\", \"FLX9095\"";

    fn settings(scope: Scope, source: PrintSource, pitch_um: [f64; 3]) -> FabricationInput {
        let defaults = FabricationInput::defaults().unwrap();
        FabricationInput { scope, source, printer: Printer::Custom, pitch_um: Some(pitch_um), ..defaults }
    }

    fn slices(stack: &Stack<'_>) -> Vec<Vec<Vec<Pixel>>> {
        let raster = stack.raster();
        (0..raster.slices)
            .map(|slice| {
                let mut painter = stack.painter(slice);
                (0..raster.rows)
                    .map(|row| {
                        let mut pixels = vec![VOID; raster.columns];
                        painter.paint(row, &mut pixels);
                        pixels
                    })
                    .collect()
            })
            .collect()
    }

    #[test]
    fn every_pixel_of_a_spoke_is_the_voxel_at_its_centre() {
        let design = design("one-edge", TWO);
        let input = settings(Scope::Spoke, PrintSource::Voxels, [130.0, 90.0, 70.0]);
        let raster = raster(&design, &input, Pitch::of(&input));
        let stack = Stack::new(&design, &input, raster, &never).unwrap();
        let (grid, slices) = (design.grid(), slices(&stack));
        for (k, rows) in slices.iter().enumerate() {
            let layer = (raster.height(k) / 0.5) as usize;
            for (j, pixels) in rows.iter().enumerate() {
                let y = raster.row_position(j);
                for (i, pixel) in pixels.iter().enumerate() {
                    let x = raster.origin_mm[0] + (i as f64 + 0.5) * 0.13;
                    let slice = ((x / 0.5) as usize).min(grid.slices() - 1);
                    let half = grid.half_widths()[slice] as i64;
                    let across = (y / 0.5).floor() as i64 + half;
                    let expected = if (0..2 * half).contains(&across) {
                        grid.slice(slice)[layer * 2 * half as usize + across as usize] + 1
                    } else {
                        VOID
                    };
                    assert_eq!(*pixel, expected, "{k} {j} {i}");
                }
            }
        }
        // Soft stands at the most negative y: in the last rows of the picture. The rim, where the spoke is broadest, is left.
        let picture = &slices[0];
        let column = |i: usize| picture.iter().map(|row| row[i]).filter(|p| *p != VOID).collect::<Vec<_>>();
        assert_eq!((column(0).first(), column(0).last()), (Some(&2), Some(&1)));
        assert!(column(0).len() > 2 * column(raster.columns - 1).len());
        assert_eq!(stack.distinct().len(), grid.layers());
    }

    #[test]
    fn a_flower_turns_spokes_counter_clockwise_and_mirrors_every_second_one() {
        let design = design("one-edge", TWO);
        let input = settings(Scope::Flower, PrintSource::Voxels, [100.0, 100.0, 250.0]);
        let raster = raster(&design, &input, Pitch::of(&input));
        let stack = Stack::new(&design, &input, raster, &never).unwrap();
        let picture = &slices(&stack)[0];
        let at = |radius: f64, azimuth_deg: f64| {
            let (sin, cos) = azimuth_deg.to_radians().sin_cos();
            let column = ((radius * cos - raster.origin_mm[0]) / 0.1) as usize;
            let row = raster.rows - 1 - ((radius * sin - raster.origin_mm[1]) / 0.1) as usize;
            picture[row][column]
        };
        // Near the rims, on both sides of the axes: y of a spoke points clockwise.
        for spoke in 0..5 {
            let azimuth = 72.0 * f64::from(spoke);
            let (soft, stiff) = if spoke % 2 == 0 { (25.0, -25.0) } else { (-25.0, 25.0) };
            assert_eq!(at(21.0, azimuth + soft), 1, "spoke {spoke}");
            assert_eq!(at(21.0, azimuth + stiff), 2, "spoke {spoke}");
            assert_eq!(at(21.0, azimuth + 36.0), VOID);
        }
        assert_eq!(at(1.0, 17.0), 2);
    }

    #[test]
    fn dithered_cross_sections_have_exact_counts_within_half_a_voxel_of_their_targets() {
        for (phases, scope) in
            [(TWO, Scope::Spoke), (THREE, Scope::Spoke), (TWO, Scope::Flower), (THREE, Scope::Flower)]
        {
            let design = design("random", phases);
            let input = settings(scope, PrintSource::Field, [150.0, 110.0, 90.0]);
            let raster = raster(&design, &input, Pitch::of(&input));
            let stack = Stack::new(&design, &input, raster, &never).unwrap();
            let spokes = raster.layout().spokes();
            let bins = stack.sections(0).len();
            let mut counted = vec![[0_u64; 3]; spokes * bins];
            let mut hub = 0_u64;
            let slices = slices(&stack);
            for picture in &slices {
                for (row, pixels) in picture.iter().enumerate() {
                    for span in raster.spans(row) {
                        for column in span.columns.clone().filter(|c| pixels[*c] != VOID) {
                            let s = span.s.at(column);
                            if s >= 20.0 && scope == Scope::Flower {
                                hub += 1;
                                continue;
                            }
                            let first = if scope == Scope::Flower { 0.0 } else { raster.origin_mm[0] };
                            let bin = ((s - first) / 0.15) as usize;
                            counted[span.spoke * bins + bin][usize::from(pixels[column]) - 1] += 1;
                        }
                    }
                }
            }
            let mut total = [0.0; 2];
            for spoke in 0..spokes {
                for (section, counts) in stack.sections(spoke).iter().zip(&counted[spoke * bins..]) {
                    assert_eq!(section.counts, *counts);
                    let off = |k: usize| (section.counts[k] as f64 - section.targets[k]).abs();
                    // The softest of three takes what rounding the other two leaves over.
                    assert!((1..3).all(|k| off(k) <= 0.5 + 1e-9) && off(0) <= 1.0 + 1e-9, "{section:?}");
                    total[0] += section.voxels as f64;
                    total[1] +=
                        section.counts.iter().zip(design.phases().moduli()).map(|(n, e)| *n as f64 * e).sum::<f64>();
                }
            }
            let voxel = 0.15 * 0.11 * 0.09;
            let profile = design.profile();
            let mean = |f: &dyn Fn(usize) -> f64| {
                let last = profile.s.len() - 1;
                (0..=last).map(|i| f(i) * if i == 0 || i == last { 0.5 } else { 1.0 }).sum::<f64>() / last as f64
            };
            let volume = spokes as f64 * 20.0 * mean(&|i| profile.width[i]);
            let stiffness = spokes as f64 * 20.0 * mean(&|i| profile.width[i] * profile.modulus_mpa[i]);
            // Eleven slices of 90 um are 1 % short of one millimetre, 133 columns 0.25 % short of the length.
            let whole = 0.99 * if scope == Scope::Spoke { raster.columns as f64 * 0.15 / 20.0 } else { 1.0 };
            let (drawn, wanted) = (total.map(|t| t * voxel / whole), [volume, stiffness]);
            assert!((drawn[0] / wanted[0] - 1.0).abs() < 0.01, "{drawn:?} {wanted:?}");
            assert!((drawn[1] / wanted[1] - 1.0).abs() < 0.002, "{drawn:?} {wanted:?}");
            if scope == Scope::Flower {
                let polygon = 5.0 * 9.0 * (std::f64::consts::PI / 5.0).tan();
                assert!((hub as f64 * voxel / 0.99 / polygon - 1.0).abs() < 0.02);
            }
            // Every slice has its share.
            let of = |picture: &Vec<Vec<Pixel>>| picture.iter().flatten().filter(|p| **p > 1).count() as f64;
            let shares: Vec<f64> = slices.iter().map(of).collect();
            assert!(shares.iter().all(|n| (n / shares[0] - 1.0).abs() < 0.01), "{shares:?}");
        }
    }

    #[test]
    fn images_decode_to_the_same_pixels_whatever_their_format_and_the_number_of_threads() {
        let design = design("random", THREE);
        let input = settings(Scope::Flower, PrintSource::Field, [150.0, 110.0, 240.0]);
        let raster = raster(&design, &input, Pitch::of(&input));
        let stack = Stack::new(&design, &input, raster, &never).unwrap();
        let expected = slices(&stack);
        for format in [Format::Indexed, Format::Rgba] {
            let drawn = |threads: usize| {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
                let mut files = Vec::new();
                let mut draw = || {
                    stack.draw::<Error>(format, 1e4, &ignore, |range, image| {
                        files.push((range, image.png.clone()));
                        Ok(image.png.len() as u64)
                    })
                };
                let counts = pool.install(&mut draw).unwrap();
                (counts, files)
            };
            let (counts, files) = drawn(1);
            assert_eq!((counts, &files), (drawn(3).0, &drawn(3).1));
            assert_eq!(counts.iter().sum::<u64>(), raster.voxels() as u64);
            assert_eq!(files.iter().map(|(range, _)| range.start).collect::<Vec<_>>(), [0, 1, 2, 3]);
            for ((_, file), picture) in files.iter().zip(&expected) {
                let mut decoder = png::Decoder::new(std::io::Cursor::new(file));
                decoder.set_transformations(png::Transformations::normalize_to_color8() | png::Transformations::ALPHA);
                let mut reader = decoder.read_info().unwrap();
                let dimensions = reader.info().pixel_dims.unwrap();
                assert_eq!([dimensions.xppu, dimensions.yppu], [6667, 9091]);
                let mut decoded = vec![0; reader.output_buffer_size().unwrap()];
                reader.next_frame(&mut decoded).unwrap();
                let wanted: Vec<u8> = picture.iter().flatten().flat_map(|p| stack.colours().of(*p)).collect();
                assert!(decoded == wanted);
            }
        }
        let cancelled = stack.draw::<Error>(Format::Indexed, 1e4, &|_| false, |_, _| Ok(0));
        assert!(matches!(cancelled, Err(Error::Cancelled)));
    }
}
