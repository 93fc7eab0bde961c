//! The package around a 3MF model: a zip with content types and relationships, the same bytes every time.

use std::io::Write;

use quick_xml::Writer;
use quick_xml::events::{BytesDecl, Event};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

use crate::fabrication::solid::SolidError;
use crate::output::folder::Destination;

/// Part name of the model.
const MODEL: &str = "3D/3dmodel.model";
const RELATIONSHIPS: &str = "http://schemas.openxmlformats.org/package/2006/relationships";
const CONTENT_TYPES: &str = "http://schemas.openxmlformats.org/package/2006/content-types";
const MODEL_RELATION: &str = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel";
const TEXTURE_RELATION: &str = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dtexture";

/// Types of the parts by extension.
const TYPES: [(&str, &str); 3] = [
    ("rels", "application/vnd.openxmlformats-package.relationships+xml"),
    ("model", "application/vnd.ms-package.3dmanufacturing-3dmodel+xml"),
    ("png", "image/png"),
];

/// How hard the model's text is compressed: mesh text compresses well at once, and hardly better slowly.
const LEVEL: i64 = 2;

/// A package that is being written.
pub struct Package<'a> {
    zip: ZipWriter<&'a mut dyn Destination>,
}

impl<'a> Package<'a> {
    /// Starts a package: content types and the relationship to the model.
    pub fn new(out: &'a mut dyn Destination) -> Result<Self, SolidError> {
        let mut package = Self { zip: ZipWriter::new(out) };
        let types = document(|xml| {
            xml.create_element("Types").with_attribute(("xmlns", CONTENT_TYPES)).write_inner_content(|xml| {
                for (extension, kind) in TYPES {
                    let element = xml.create_element("Default");
                    element.with_attributes([("Extension", extension), ("ContentType", kind)]).write_empty()?;
                }
                Ok(())
            })
        })?;
        package.part("[Content_Types].xml", &types)?;
        let model = format!("/{MODEL}");
        package.part("_rels/.rels", &relationships(&[(MODEL_RELATION, &model)])?)?;
        Ok(package)
    }

    /// Adds the images of a stack and the model's relationships to them.
    pub fn images(&mut self, images: &[(String, Vec<u8>)]) -> Result<(), SolidError> {
        let names: Vec<(&str, &str)> = images.iter().map(|(path, _)| (TEXTURE_RELATION, path.as_str())).collect();
        self.part("3D/_rels/3dmodel.model.rels", &relationships(&names)?)?;
        // Images are compressed already.
        let options = options().compression_method(CompressionMethod::Stored);
        for (path, bytes) in images {
            self.zip.start_file(path.trim_start_matches('/'), options)?;
            self.zip.write_all(bytes)?;
        }
        Ok(())
    }

    /// Starts the model; it may grow beyond 4 GiB.
    pub fn model(&mut self) -> Result<&mut dyn Write, SolidError> {
        let deflated = options().compression_method(CompressionMethod::Deflated);
        self.zip.start_file(MODEL, deflated.compression_level(Some(LEVEL)).large_file(true))?;
        Ok(&mut self.zip)
    }

    /// Ends the package.
    pub fn finish(self) -> Result<(), SolidError> {
        self.zip.finish()?;
        Ok(())
    }

    fn part(&mut self, name: &str, bytes: &[u8]) -> Result<(), SolidError> {
        self.zip.start_file(name, options().compression_method(CompressionMethod::Deflated))?;
        Ok(self.zip.write_all(bytes)?)
    }
}

/// Without the time and the machine.
fn options() -> SimpleFileOptions {
    SimpleFileOptions::default().last_modified_time(DateTime::DEFAULT).unix_permissions(0o644)
}

/// An XML document.
pub(super) fn document(
    body: impl FnOnce(&mut Writer<Vec<u8>>) -> std::io::Result<&mut Writer<Vec<u8>>>,
) -> std::io::Result<Vec<u8>> {
    let mut xml = Writer::new_with_indent(Vec::new(), b' ', 1);
    xml.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
    body(&mut xml)?;
    Ok(xml.into_inner())
}

fn relationships(targets: &[(&str, &str)]) -> std::io::Result<Vec<u8>> {
    document(|xml| {
        xml.create_element("Relationships").with_attribute(("xmlns", RELATIONSHIPS)).write_inner_content(|xml| {
            for (number, (kind, target)) in targets.iter().enumerate() {
                let id = format!("rel{}", number + 1);
                let element = xml.create_element("Relationship");
                element.with_attributes([("Type", *kind), ("Target", *target), ("Id", &id)]).write_empty()?;
            }
            Ok(())
        })
    })
}
