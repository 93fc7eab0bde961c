//! The model part: metadata, resources, build.

use std::io::{self, Write};

use quick_xml::Writer;
use quick_xml::escape::escape;
use quick_xml::events::BytesText;

use super::volumetric::{self, PhaseImages};
use super::{Document, Object, REACH_MM, Shape};
use crate::deck::number::Coordinates;
use crate::fabrication::layout::Placement;
use crate::fabrication::solid::{Piece, Solid, SolidError};
use crate::progress::Cancelled;

const CORE: &str = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02";

/// Resource number of the base materials; objects follow, an imaged object's other resources just before it.
const MATERIALS: usize = 1;

/// Resource numbers an object takes.
const STRIDE: usize = 4;

/// Resource number of an object.
fn id(object: usize) -> usize {
    MATERIALS + STRIDE * (object + 1)
}

pub(super) fn write(document: &Document<'_>, out: &mut dyn Write, cancelled: Cancelled<'_>) -> Result<(), SolidError> {
    let imaged = document.objects.iter().any(|o| matches!(o.shape, Shape::Imaged { .. }));
    let extension = if imaged { volumetric::DECLARATION } else { "" };
    write!(
        out,
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model unit=\"millimeter\" xml:lang=\"en-US\" \
         xmlns=\"{CORE}\"{extension}>\n"
    )?;
    out.write_all(&fragment(|xml| metadata(document, xml))?)?;
    out.write_all(b"\n<resources>\n")?;
    out.write_all(&fragment(|xml| materials(document, xml))?)?;
    for (index, object) in document.objects.iter().enumerate() {
        write_object(document, index, object, out, cancelled)?;
    }
    out.write_all(b"\n</resources>\n")?;
    out.write_all(&fragment(|xml| {
        xml.create_element("build").write_inner_content(|xml| {
            for (object, placement) in &document.items {
                placed(xml, "item", id(*object), placement)?;
            }
            Ok(())
        })?;
        Ok(())
    })?)?;
    Ok(out.write_all(b"\n</model>\n")?)
}

/// Some elements as text.
fn fragment(body: impl FnOnce(&mut Writer<Vec<u8>>) -> io::Result<()>) -> io::Result<Vec<u8>> {
    let mut xml = Writer::new_with_indent(Vec::new(), b' ', 1);
    body(&mut xml)?;
    Ok(xml.into_inner())
}

fn metadata(document: &Document<'_>, xml: &mut Writer<Vec<u8>>) -> io::Result<()> {
    let provenance = document.provenance;
    let description =
        format!("{}; seed {}, design {}", document.description, provenance.seed, provenance.design_sha256);
    let application = format!("Voxelastica {}", provenance.version);
    for (name, text) in [("Title", &document.title), ("Description", &description), ("Application", &application)] {
        xml.create_element("metadata").with_attribute(("name", name)).write_text_content(BytesText::new(text))?;
    }
    Ok(())
}

fn materials(document: &Document<'_>, xml: &mut Writer<Vec<u8>>) -> io::Result<()> {
    let id = MATERIALS.to_string();
    xml.create_element("basematerials").with_attribute(("id", id.as_str())).write_inner_content(|xml| {
        for material in &document.materials {
            let element = xml.create_element("base");
            let attributes = [("name", material.name.as_str()), ("displaycolor", material.colour.as_str())];
            element.with_attributes(attributes).write_empty()?;
        }
        Ok(())
    })?;
    Ok(())
}

fn write_object(
    document: &Document<'_>,
    index: usize,
    object: &Object<'_>,
    out: &mut dyn Write,
    cancelled: Cancelled<'_>,
) -> Result<(), SolidError> {
    let (name, id) = (escape(object.name.as_str()), id(index));
    match &object.shape {
        Shape::Components(components) => {
            let number = id.to_string();
            let attributes = [("id", number.as_str()), ("name", object.name.as_str()), ("type", "model")];
            out.write_all(b"\n")?;
            out.write_all(&fragment(|xml| {
                xml.create_element("object").with_attributes(attributes).write_inner_content(|xml| {
                    xml.create_element("components").write_inner_content(|xml| {
                        for (component, placement) in components {
                            placed(xml, "component", self::id(*component), placement)?;
                        }
                        Ok(())
                    })?;
                    Ok(())
                })?;
                Ok(())
            })?)?;
            Ok(())
        }
        Shape::Solid { solid, material } => {
            let head = format!(
                "\n<object id=\"{id}\" name=\"{name}\" type=\"model\" pid=\"{MATERIALS}\" pindex=\"{material}\">\n<mesh>\n"
            );
            out.write_all(head.as_bytes())?;
            mesh(*solid, out, cancelled)
        }
        Shape::Imaged { solid, images } => {
            let numbers = ImageIds { image: id - 3, function: id - 2, volume: id - 1 };
            out.write_all(b"\n")?;
            out.write_all(&fragment(|xml| imaged(document, images, numbers, xml))?)?;
            let volume = numbers.volume;
            let head =
                format!("\n<object id=\"{id}\" name=\"{name}\" type=\"model\">\n<mesh v:volumeid=\"{volume}\">\n");
            out.write_all(head.as_bytes())?;
            mesh(*solid, out, cancelled)
        }
    }
}

#[derive(Clone, Copy)]
struct ImageIds {
    image: usize,
    function: usize,
    volume: usize,
}

fn imaged(document: &Document<'_>, images: &PhaseImages, ids: ImageIds, xml: &mut Writer<Vec<u8>>) -> io::Result<()> {
    volumetric::write_images(images, [ids.image, ids.function], xml)?;
    volumetric::write_mapping(images, document.materials.len(), MATERIALS, [ids.function, ids.volume], xml)
}

fn placed(xml: &mut Writer<Vec<u8>>, element: &str, id: usize, placement: &Placement) -> io::Result<()> {
    let id = id.to_string();
    let element = xml.create_element(element).with_attribute(("objectid", id.as_str()));
    if *placement == Placement::IDENTITY {
        element.write_empty()?;
        return Ok(());
    }
    // Row vectors: the images of the axes, then the shift.
    let (c, s, shift) = (placement.cosine, placement.sine, placement.shift);
    let rows = [c, s, 0.0, -s, c, 0.0, 0.0, 0.0, 1.0, shift[0], shift[1], shift[2]];
    let words = rows.map(|v| format!("{}", (v * 1e12).round() / 1e12 + 0.0));
    element.with_attribute(("transform", words.join(" ").as_str())).write_empty()?;
    Ok(())
}

/// Vertices, then triangles; the solid is walked through once for each.
fn mesh(solid: &dyn Solid, out: &mut dyn Write, cancelled: Cancelled<'_>) -> Result<(), SolidError> {
    let coordinates = Coordinates::new(REACH_MM);
    let mut text = Vec::new();
    out.write_all(b"<vertices>\n")?;
    solid.pieces(cancelled, &mut |piece: Piece| {
        text.clear();
        for vertex in &piece.vertices {
            for (name, value) in [&b"<vertex x=\""[..], b"\" y=\"", b"\" z=\""].iter().zip(vertex) {
                text.extend_from_slice(name);
                coordinates.put(&mut text, *value);
            }
            text.extend_from_slice(b"\"/>\n");
        }
        Ok(out.write_all(&text)?)
    })?;
    out.write_all(b"</vertices>\n<triangles>\n")?;
    let mut digits = itoa::Buffer::new();
    solid.pieces(cancelled, &mut |piece: Piece| {
        text.clear();
        for triangle in &piece.triangles {
            for (name, value) in [&b"<triangle v1=\""[..], b"\" v2=\"", b"\" v3=\""].iter().zip(triangle) {
                text.extend_from_slice(name);
                text.extend_from_slice(digits.format(*value).as_bytes());
            }
            text.extend_from_slice(b"\"/>\n");
        }
        Ok(out.write_all(&text)?)
    })?;
    Ok(out.write_all(b"</triangles>\n</mesh>\n</object>")?)
}
