//! VTU files (VTK's XML for unstructured grids) of hexahedra, as ParaView opens them.
//!
//! Arrays are inline, in base64, little-endian, each behind its length as a 64-bit number.

use std::io::{self, Write};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use quick_xml::Writer;
use quick_xml::events::{BytesDecl, BytesEnd, BytesStart, BytesText, Event};

/// VTK's number of a hexahedron.
const HEXAHEDRON: u8 = 12;

/// Values of one field, point after point or cell after cell.
#[derive(Debug, Clone, PartialEq)]
pub enum FieldValues {
    /// Numbers, several a point or cell.
    Numbers {
        /// Numbers a point or cell.
        components: usize,
        /// The numbers.
        values: Vec<f32>,
    },
    /// Numbers, one a point or cell, of which every digit counts.
    Precise(Vec<f64>),
    /// Small whole numbers.
    Labels(Vec<u8>),
}

/// A named field.
#[derive(Debug, Clone, PartialEq)]
pub struct Field {
    /// Name, with the unit.
    pub name: String,
    /// Values.
    pub values: FieldValues,
}

impl Field {
    /// A field of one number a point or cell.
    #[must_use]
    pub fn scalars(name: &str, values: impl IntoIterator<Item = f64>) -> Self {
        let values = values.into_iter().map(|v| v as f32).collect();
        Self { name: name.to_owned(), values: FieldValues::Numbers { components: 1, values } }
    }

    /// A field of `N` numbers a point or cell.
    #[must_use]
    pub fn vectors<const N: usize>(name: &str, values: &[[f64; N]]) -> Self {
        let values = values.iter().flatten().map(|v| *v as f32).collect();
        Self { name: name.to_owned(), values: FieldValues::Numbers { components: N, values } }
    }

    /// A field of one number a point or cell with all its digits: differences of it say something.
    #[must_use]
    pub fn precise(name: &str, values: impl IntoIterator<Item = f64>) -> Self {
        Self { name: name.to_owned(), values: FieldValues::Precise(values.into_iter().collect()) }
    }

    /// A field of whole numbers.
    #[must_use]
    pub fn labels(name: &str, values: &[u8]) -> Self {
        Self { name: name.to_owned(), values: FieldValues::Labels(values.to_vec()) }
    }
}

/// Hexahedra with fields.
#[derive(Debug, Clone, PartialEq)]
pub struct Hexahedra<'a> {
    /// Positions, mm.
    pub points: &'a [[f64; 3]],
    /// Points of every cell, in the order of an eight-node brick.
    pub cells: &'a [[u32; 8]],
    /// Fields with a value a point.
    pub point_fields: Vec<Field>,
    /// Fields with a value a cell.
    pub cell_fields: Vec<Field>,
}

/// Writes a grid; `comment` stands in the file's head.
///
/// # Errors
/// What the writer returns, and [`io::ErrorKind::InvalidInput`] for more points than 32-bit numbers count.
pub fn write(grid: &Hexahedra<'_>, comment: &str, out: &mut dyn Write) -> io::Result<()> {
    if i32::try_from(grid.points.len()).is_err() {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "too many points for a VTU file"));
    }
    let mut xml = Writer::new_with_indent(out, b' ', 1);
    xml.write_event(Event::Decl(BytesDecl::new("1.0", None, None)))?;
    // Two hyphens would end the comment.
    xml.write_event(Event::Comment(BytesText::from_escaped(comment.replace("--", "- -"))))?;
    let file =
        [("type", "UnstructuredGrid"), ("version", "1.0"), ("byte_order", "LittleEndian"), ("header_type", "UInt64")];
    open(&mut xml, "VTKFile", &file)?;
    open(&mut xml, "UnstructuredGrid", &[])?;
    let [points, cells] = [grid.points.len().to_string(), grid.cells.len().to_string()];
    open(&mut xml, "Piece", &[("NumberOfPoints", &points), ("NumberOfCells", &cells)])?;
    fields(&mut xml, "PointData", &grid.point_fields)?;
    fields(&mut xml, "CellData", &grid.cell_fields)?;
    open(&mut xml, "Points", &[])?;
    array(&mut xml, "Points", "Float64", 3, &bytes(grid.points.iter().flatten().map(|v| v.to_le_bytes())))?;
    close(&mut xml, "Points")?;
    open(&mut xml, "Cells", &[])?;
    let corners = grid.cells.iter().flatten().map(|n| (*n as i32).to_le_bytes());
    array(&mut xml, "connectivity", "Int32", 1, &bytes(corners))?;
    let ends = (1..=grid.cells.len()).map(|i| (8 * i as i64).to_le_bytes());
    array(&mut xml, "offsets", "Int64", 1, &bytes(ends))?;
    array(&mut xml, "types", "UInt8", 1, &vec![HEXAHEDRON; grid.cells.len()])?;
    for name in ["Cells", "Piece", "UnstructuredGrid", "VTKFile"] {
        close(&mut xml, name)?;
    }
    xml.into_inner().write_all(b"\n")
}

type Xml<'a, 'b> = Writer<&'a mut (dyn Write + 'b)>;

fn open(xml: &mut Xml<'_, '_>, name: &str, attributes: &[(&str, &str)]) -> io::Result<()> {
    xml.write_event(Event::Start(BytesStart::new(name).with_attributes(attributes.iter().copied())))
}

fn close(xml: &mut Xml<'_, '_>, name: &str) -> io::Result<()> {
    xml.write_event(Event::End(BytesEnd::new(name)))
}

fn fields(xml: &mut Xml<'_, '_>, section: &str, fields: &[Field]) -> io::Result<()> {
    open(xml, section, &[])?;
    for field in fields {
        match &field.values {
            FieldValues::Numbers { components, values } => {
                let bytes = bytes(values.iter().map(|v| v.to_le_bytes()));
                array(xml, &field.name, "Float32", *components, &bytes)?;
            }
            FieldValues::Precise(values) => {
                let bytes = bytes(values.iter().map(|v| v.to_le_bytes()));
                array(xml, &field.name, "Float64", 1, &bytes)?;
            }
            FieldValues::Labels(values) => array(xml, &field.name, "UInt8", 1, values)?,
        }
    }
    close(xml, section)
}

fn bytes<const N: usize>(values: impl Iterator<Item = [u8; N]>) -> Vec<u8> {
    values.flatten().collect()
}

fn array(xml: &mut Xml<'_, '_>, name: &str, kind: &str, components: usize, values: &[u8]) -> io::Result<()> {
    let mut element = BytesStart::new("DataArray").with_attributes([("type", kind), ("Name", name)]);
    // Readers make columns, not scalars, of arrays that say they have one component.
    if components > 1 {
        element.push_attribute(("NumberOfComponents", components.to_string().as_str()));
    }
    element.push_attribute(("format", "binary"));
    xml.write_event(Event::Start(element))?;
    let mut block = Vec::with_capacity(values.len() + 8);
    block.extend_from_slice(&(values.len() as u64).to_le_bytes());
    block.extend_from_slice(values);
    xml.write_event(Event::Text(BytesText::from_escaped(STANDARD.encode(&block))))?;
    close(xml, "DataArray")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arrays_stand_behind_their_length() {
        let points: Vec<[f64; 3]> = crate::fem::element::shape::CORNERS.to_vec();
        let grid = Hexahedra {
            points: &points,
            cells: &[[0, 1, 2, 3, 4, 5, 6, 7]],
            point_fields: vec![Field::vectors("displacement_mm", &points)],
            cell_fields: vec![Field::labels("phase", &[2]), Field::scalars("a < b", [1.5]), Field::precise("c", [0.1])],
        };
        let mut out = Vec::new();
        write(&grid, "Voxelastica --model", &mut out).unwrap();
        let text = String::from_utf8(out).unwrap();
        assert!(text.contains("<!--Voxelastica - -model-->") && text.contains("Name=\"a &lt; b\""), "{text}");
        let document: Vec<&str> = text.split("<DataArray").collect();
        let bytes = |i: usize| {
            STANDARD.decode(document[i].split('>').nth(1).unwrap().split('<').next().unwrap().trim()).unwrap()
        };
        assert_eq!(bytes(2), [1, 0, 0, 0, 0, 0, 0, 0, 2]);
        assert_eq!(bytes(3)[8..], 1.5_f32.to_le_bytes());
        assert_eq!(bytes(4)[8..], 0.1_f64.to_le_bytes());
    }
}
