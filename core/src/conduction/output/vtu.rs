//! Fields on bricks as a VTK file that ParaView opens.

use std::io::{self, Write};

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

use crate::conduction::mesh::{BrickMesh, VOID};

/// VTK's number of an eight-node brick.
const HEXAHEDRON: u8 = 12;

/// A named array, one value a node of the mesh.
#[derive(Debug, Clone, Copy)]
pub struct NodeField<'a> {
    /// Name.
    pub name: &'a str,
    /// Values at all nodes of the box.
    pub values: &'a [f64],
}

/// Writes the bricks that are not void, fields at their nodes and one number a material.
///
/// `comment` goes into an XML comment, line by line.
///
/// # Errors
/// What the writer returns.
pub fn write(
    out: &mut dyn Write,
    mesh: &BrickMesh,
    comment: &[String],
    fields: &[NodeField<'_>],
    materials: (&str, &[f64]),
) -> io::Result<()> {
    let solid = || mesh.materials().iter().enumerate().filter(|(_, m)| **m != VOID);
    let mut numbers = vec![0_i32; mesh.nodes()];
    let used: Vec<usize> = mesh.used_nodes().iter().enumerate().filter(|(_, used)| **used).map(|(n, _)| n).collect();
    for (number, node) in used.iter().enumerate() {
        numbers[*node] = i32::try_from(number).map_err(|_| io::Error::other("too many nodes for a VTK file"))?;
    }
    let [_, levels, across] = mesh.node_counts();
    let cells = solid().count();

    writeln!(out, "<?xml version=\"1.0\"?>\n<!--")?;
    for line in comment {
        writeln!(out, "{}", line.replace("--", "- -"))?;
    }
    writeln!(
        out,
        "-->\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n\
         <UnstructuredGrid>\n<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{cells}\">\n<Points>",
        used.len()
    )?;
    let position = |n: &usize| mesh.position([n / (levels * across), n / across % levels, n % across]);
    array(out, "Float64", "Points", 3, used.iter().flat_map(position).flat_map(f64::to_le_bytes))?;
    writeln!(out, "</Points>\n<Cells>")?;
    let connectivity = solid().flat_map(|(cell, _)| mesh.deck_nodes(mesh.cell(cell)).map(|n| numbers[n]));
    array(out, "Int32", "connectivity", 1, connectivity.flat_map(i32::to_le_bytes))?;
    array(out, "Int64", "offsets", 1, (1..=cells as i64).flat_map(|n| (8 * n).to_le_bytes()))?;
    array(out, "UInt8", "types", 1, std::iter::repeat_n(HEXAHEDRON, cells))?;
    writeln!(out, "</Cells>\n<PointData>")?;
    for field in fields {
        array(out, "Float64", field.name, 1, used.iter().flat_map(|n| field.values[*n].to_le_bytes()))?;
    }
    writeln!(out, "</PointData>\n<CellData>")?;
    let (name, values) = materials;
    let of = |m: &u16| values.get(usize::from(*m)).copied().unwrap_or(0.0);
    array(out, "Float64", name, 1, solid().flat_map(|(_, m)| of(m).to_le_bytes()))?;
    writeln!(out, "</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>")
}

/// One array: the number of bytes and the bytes themselves, in base 64.
fn array(
    out: &mut dyn Write,
    kind: &str,
    name: &str,
    components: usize,
    bytes: impl Iterator<Item = u8>,
) -> io::Result<()> {
    let mut data = vec![0; 8];
    data.extend(bytes);
    let size = (data.len() - 8) as u64;
    data[..8].copy_from_slice(&size.to_le_bytes());
    // Readers make scalars of arrays that do not say how many components they have.
    let many = if components > 1 { format!(" NumberOfComponents=\"{components}\"") } else { String::new() };
    writeln!(
        out,
        "<DataArray type=\"{kind}\" Name=\"{name}\"{many} format=\"binary\">\n{}\n</DataArray>",
        STANDARD.encode(&data)
    )
}
