//! The volumetric extension: phases as a stack of images.
//!
//! One image a layer of voxels, lowest first, one pixel a voxel: columns run along the strip from the rim (`u`), rows across
//! it with the largest `y` first (`v` runs upwards), and the stack upwards (`w`). Red, green and blue are 255 where the
//! voxel is of the first, second, third phase: shares of materials that a printer mixes, all or nothing here. Sampling
//! takes the nearest voxel. Pixels beside the strip, which the solid's surface cuts off, repeat the softest phase, for
//! shares must not all be zero.

use std::io;

use quick_xml::Writer;

use crate::fabrication::solid::SolidError;
use crate::voxel::VoxelGrid;

/// Declares the extension in the model element.
pub(super) const DECLARATION: &str =
    " xmlns:v=\"http://schemas.3mf.io/3dmanufacturing/volumetric/2022/01\" requiredextensions=\"v\"";

/// Names of the channels in the order of the phases.
const CHANNELS: [&str; 3] = ["red", "green", "blue"];

/// A strip's phases as images.
#[derive(Debug, Clone, PartialEq)]
pub struct PhaseImages {
    /// Path in the package and contents, lowest layer first.
    pub files: Vec<(String, Vec<u8>)>,
    /// Pixels along the strip and across it.
    pub pixels: [u32; 2],
    /// Voxel edge, mm.
    pub edge_mm: f64,
}

impl PhaseImages {
    /// The images of a grid in the strip's own frame. `stack` names them in the package.
    ///
    /// # Errors
    /// [`SolidError::TooMany`] for more slices than an image can have columns.
    pub fn of(grid: &VoxelGrid, stack: &str) -> Result<Self, SolidError> {
        // The first row is the highest voxel across.
        Self::with_rows(grid, stack, |row, rows| rows - 1 - row)
    }

    /// The images of a grid mirrored at the mid-line.
    ///
    /// # Errors
    /// Those of [`Self::of`].
    pub fn of_mirror_image(grid: &VoxelGrid, stack: &str) -> Result<Self, SolidError> {
        Self::with_rows(grid, stack, |row, _| row)
    }

    fn with_rows(grid: &VoxelGrid, stack: &str, across: fn(usize, usize) -> usize) -> Result<Self, SolidError> {
        let half = grid.half_widths().iter().copied().max().unwrap_or(0);
        let pixels = [pixels(grid.slices())?, pixels(2 * half)?];
        let layers = (0..grid.layers()).map(|layer| {
            let mut rgb = vec![0_u8; 3 * grid.slices() * 2 * half];
            for row in 0..2 * half {
                for slice in 0..grid.slices() {
                    let own = grid.half_widths()[slice];
                    let across = across(row, 2 * half).checked_sub(half - own).filter(|a| *a < 2 * own);
                    let phase = across.map_or(0, |a| grid.slice(slice)[layer * 2 * own + a]);
                    let at = 3 * (row * grid.slices() + slice);
                    if let Some(channel) = rgb.get_mut(at + usize::from(phase.min(2))) {
                        *channel = 255;
                    }
                }
            }
            let path = format!("/3D/volumetric/{stack}/layer{:04}.png", layer + 1);
            encode(&rgb, pixels).map(|bytes| (path, bytes))
        });
        Ok(Self { files: layers.collect::<io::Result<_>>()?, pixels, edge_mm: grid.size_mm() })
    }

    /// From the strip's own frame to the unit cube of the stack, by rows.
    fn transform(&self) -> String {
        let size = |n: f64| 1.0 / (n * self.edge_mm);
        let [along, across] = self.pixels.map(|n| size(f64::from(n)));
        let up = size(self.files.len() as f64);
        format!("{along} 0 0 0 {across} 0 0 0 {up} 0 0.5 0.5")
    }
}

fn pixels(count: usize) -> Result<u32, SolidError> {
    let limit = u64::from(i32::MAX.cast_unsigned());
    u32::try_from(count).ok().filter(|n| u64::from(*n) <= limit).ok_or(SolidError::TooMany {
        count: count as u64,
        what: "pixels in a row",
        format: "PNG",
        limit,
    })
}

fn encode(rgb: &[u8], [width, height]: [u32; 2]) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(rgb)?;
    writer.finish()?;
    Ok(bytes)
}

/// The stack and the function that samples it.
pub(super) fn write_images(
    images: &PhaseImages,
    [image, function]: [usize; 2],
    xml: &mut Writer<Vec<u8>>,
) -> io::Result<()> {
    let (image, function) = (image.to_string(), function.to_string());
    let [columns, rows] = images.pixels.map(|n| n.to_string());
    let sheets = images.files.len().to_string();
    xml.create_element("v:image3d").with_attributes([("id", image.as_str()), ("name", "phases")]).write_inner_content(
        |xml| {
            let counts =
                [("rowcount", rows.as_str()), ("columncount", columns.as_str()), ("sheetcount", sheets.as_str())];
            xml.create_element("v:imagestack").with_attributes(counts).write_inner_content(|xml| {
                for (path, _) in &images.files {
                    xml.create_element("v:imagesheet").with_attribute(("path", path.as_str())).write_empty()?;
                }
                Ok(())
            })?;
            Ok(())
        },
    )?;
    let clamped = ["tilestyleu", "tilestylev", "tilestylew"].map(|axis| (axis, "clamp"));
    xml.create_element("v:functionfromimage3d")
        .with_attributes([("id", function.as_str()), ("displayname", "phases"), ("image3did", image.as_str())])
        .with_attributes(clamped)
        .with_attribute(("filter", "nearest"))
        .write_empty()?;
    Ok(())
}

/// The mapping from channels to materials.
pub(super) fn write_mapping(
    images: &PhaseImages,
    phases: usize,
    materials: usize,
    [function, volume]: [usize; 2],
    xml: &mut Writer<Vec<u8>>,
) -> io::Result<()> {
    let [materials, function, volume] = [materials, function, volume].map(|n| n.to_string());
    let transform = images.transform();
    xml.create_element("v:volumedata").with_attribute(("id", volume.as_str())).write_inner_content(|xml| {
        xml.create_element("v:composite").with_attribute(("basematerialid", materials.as_str())).write_inner_content(
            |xml| {
                for channel in CHANNELS.iter().take(phases) {
                    xml.create_element("v:materialmapping")
                        .with_attributes([
                            ("functionid", function.as_str()),
                            ("transform", transform.as_str()),
                            ("channel", channel),
                        ])
                        .write_empty()?;
                }
                Ok(())
            },
        )?;
        Ok(())
    })?;
    Ok(())
}
