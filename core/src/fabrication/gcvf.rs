//! GCVF, version 2: GrabCAD's container for voxel printing, a zip of `ConfigFile.xml` and one PNG a slice.
//!
//! There is no public description of it; the layout follows what other programs write. Resolutions are whole dots per inch
//! and nanometres, images have four bytes a pixel, and voxels are counted by material, so the configuration comes after the
//! slices.

use std::io::{self, Write};

use quick_xml::Writer;
use quick_xml::events::{BytesDecl, BytesText, Event};
use zip::result::ZipError;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

use super::Job;
use super::raster::image::Format;
use super::raster::{PIXEL_VALUES, Pixel, Stack, VOID};
use crate::error::Error;
use crate::output::folder::{Destination, WriteFailure};
use crate::progress::Progress;

/// What the names of slices begin with.
const PREFIX: &str = "slice_";
/// Bytes a pixel.
const DEPTH: u32 = 4;
/// Most materials that a printer of this format holds.
const MOST_COLOURS: u32 = 6;

/// Writes the container and returns the number of voxels of every value.
pub(super) fn write(
    job: &Job<'_>,
    stack: &Stack<'_>,
    bytes: f64,
    out: &mut dyn Destination,
    progress: Progress<'_>,
) -> Result<[u64; PIXEL_VALUES], WriteFailure> {
    let mut zip = ZipWriter::new(out);
    // PNGs are compressed already. Times are those of the format's epoch.
    let stored = SimpleFileOptions::default().compression_method(CompressionMethod::Stored).unix_permissions(0o644);
    let counts = stack.draw(Format::Rgba, bytes, progress, |range, image| {
        let size = image.png.len() as u64 * range.len() as u64;
        for slice in range {
            zip.start_file(format!("{PREFIX}{slice}.png"), stored).map_err(failure)?;
            zip.write_all(&image.png)?;
        }
        Ok::<u64, WriteFailure>(size)
    })?;
    let text = configuration(job, stack, counts)?;
    zip.start_file("ConfigFile.xml", stored).map_err(failure)?;
    zip.write_all(&text)?;
    zip.finish().map_err(failure)?;
    Ok(counts)
}

fn configuration(job: &Job<'_>, stack: &Stack<'_>, counts: [u64; PIXEL_VALUES]) -> io::Result<Vec<u8>> {
    let raster = stack.raster();
    let [x_dpi, y_dpi] = raster.pitch.dpi();
    let rgba = |pixel: Pixel| stack.colours().of(pixel).map(|c| c.to_string()).join(" ");
    let mut xml = Writer::new_with_indent(Vec::new(), b' ', 2);
    xml.write_event(Event::Decl(BytesDecl::new("1.0", Some("utf-8"), None)))?;
    xml.write_event(Event::Comment(BytesText::new(&format!(" {} ", job.provenance.line()))))?;
    let text = |xml: &mut Writer<Vec<u8>>, name: &str, value: String| -> io::Result<()> {
        xml.create_element(name).write_text_content(BytesText::new(&value)).map(|_| ())
    };
    xml.create_element("GCVF").write_inner_content(|xml| {
        text(xml, "Version", "2".to_owned())?;
        xml.create_element("Resolution").write_inner_content(|xml| {
            text(xml, "XDpi", x_dpi.to_string())?;
            text(xml, "YDpi", y_dpi.to_string())?;
            text(xml, "SliceThicknessNanoMeter", raster.pitch.slice_nm().to_string())
        })?;
        xml.create_element("SliceDimensions").write_inner_content(|xml| {
            text(xml, "SliceWidth", raster.columns.to_string())?;
            text(xml, "SliceHeight", raster.rows.to_string())
        })?;
        xml.create_element("SliceRange").write_inner_content(|xml| {
            text(xml, "StartIndex", "0".to_owned())?;
            text(xml, "NumberOfSlices", raster.slices.to_string())
        })?;
        text(xml, "BitDepth", DEPTH.to_string())?;
        text(xml, "MaxNumberOfColors", MOST_COLOURS.to_string())?;
        text(xml, "DataSemantics", "Materials".to_owned())?;
        text(xml, "CreationMode", "MODEL_ONLY".to_owned())?;
        text(xml, "ImageFilePrefix", PREFIX.to_owned())?;
        xml.create_element("MaterialList").write_inner_content(|xml| {
            text(xml, "BackGroundMaterialRGBA", rgba(VOID))?;
            for (pixel, phase) in (1..).zip(job.design.phases().phases()) {
                xml.create_element("Material").write_inner_content(|xml| {
                    text(xml, "Name", phase.name.clone())?;
                    text(xml, "RGBA", rgba(pixel))?;
                    text(xml, "VoxelCount", counts[usize::from(pixel)].to_string())
                })?;
            }
            Ok(())
        })?;
        Ok(())
    })?;
    let mut text = xml.into_inner();
    text.push(b'\n');
    Ok(text)
}

fn failure(error: ZipError) -> WriteFailure {
    match error {
        ZipError::Io(error) => error.into(),
        other => Error::Internal(format!("the container of slices: {other}")).into(),
    }
}
