//! A slice as PNG.

use png::{BitDepth, ColorType, DeflateCompression, Encoder, EncodingError, Filter, PixelDimensions, Unit};
use std::io::Write;

use super::{PIXEL_VALUES, Painter, Pixel, Raster, VOID};

/// Pieces in which compressed data is handed on, bytes.
const CHUNK: usize = 1 << 16;

/// How pixels are stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Two bits a pixel and a palette.
    Indexed,
    /// Four bytes a pixel.
    Rgba,
}

/// Colours of void and of the phases; void is (0, 0, 0, 0) and everything else opaque.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Colours([[u8; 4]; PIXEL_VALUES]);

impl Colours {
    /// The colours of phases, softest first; more than three are ignored.
    #[must_use]
    pub fn new(phases: &[[u8; 3]]) -> Self {
        let mut colours = [[0; 4]; PIXEL_VALUES];
        for (colour, [r, g, b]) in colours.iter_mut().skip(1).zip(phases) {
            *colour = [*r, *g, *b, 255];
        }
        Self(colours)
    }

    /// Red, green, blue and opacity of a pixel.
    #[must_use]
    pub fn of(&self, pixel: Pixel) -> [u8; 4] {
        self.0[usize::from(pixel) % PIXEL_VALUES]
    }
}

/// A slice as a file, and how many pixels have which value.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Image {
    /// The file.
    pub png: Vec<u8>,
    /// Pixels of every value, void first.
    pub counts: [u64; PIXEL_VALUES],
}

/// Draws and encodes a slice; `go_on` is asked before every row, and `None` returned once it says no.
///
/// # Errors
/// What the encoder refuses: an image of more than 2^31 pixels along a side, or none.
pub fn encode(
    raster: &Raster,
    painter: &mut dyn Painter,
    format: Format,
    colours: &Colours,
    go_on: &dyn Fn() -> bool,
) -> Result<Option<Image>, EncodingError> {
    let mut image = Image { png: Vec::new(), counts: [0; PIXEL_VALUES] };
    let side = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
    let mut encoder = Encoder::new(&mut image.png, side(raster.columns), side(raster.rows));
    let [xppu, yppu] = raster.pitch.pixels_per_metre();
    encoder.set_pixel_dims(Some(PixelDimensions { xppu, yppu, unit: Unit::Meter }));
    match format {
        Format::Indexed => {
            encoder.set_color(ColorType::Indexed);
            encoder.set_depth(BitDepth::Two);
            encoder.set_palette(colours.0.iter().flat_map(|[r, g, b, _]| [*r, *g, *b]).collect::<Vec<u8>>());
            encoder.set_trns(vec![colours.of(VOID)[3]]);
            encoder.set_deflate_compression(DeflateCompression::Level(1));
        }
        Format::Rgba => {
            encoder.set_color(ColorType::Rgba);
            encoder.set_depth(BitDepth::Eight);
            encoder.set_deflate_compression(DeflateCompression::FdeflateUltraFast);
        }
    }
    // Rows repeat where a printer's voxels are smaller than the design's.
    encoder.set_filter(Filter::Up);
    let mut writer = encoder.write_header()?;
    let mut stream = writer.stream_writer_with_size(CHUNK)?;
    let mut pixels = vec![VOID; raster.columns];
    let mut bytes = Vec::with_capacity(4 * raster.columns);
    for row in 0..raster.rows {
        if !go_on() {
            return Ok(None);
        }
        pixels.fill(VOID);
        painter.paint(row, &mut pixels);
        bytes.clear();
        match format {
            Format::Indexed => pack(&pixels, &mut bytes),
            Format::Rgba => bytes.extend(pixels.iter().flat_map(|pixel| colours.of(*pixel))),
        }
        for pixel in &pixels {
            image.counts[usize::from(*pixel) % PIXEL_VALUES] += 1;
        }
        stream.write_all(&bytes)?;
    }
    stream.finish()?;
    writer.finish()?;
    Ok(Some(image))
}

/// Four pixels a byte, the leftmost in the highest bits.
fn pack(pixels: &[Pixel], bytes: &mut Vec<u8>) {
    bytes.extend(pixels.chunks(4).map(|four| {
        let packed = four.iter().fold(0, |byte, pixel| byte << 2 | (pixel & 3));
        packed << (2 * (4 - four.len()))
    }));
}
