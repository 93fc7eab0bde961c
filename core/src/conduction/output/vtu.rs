//! Fields on bricks as a VTK file that ParaView opens.

use std::io::{self, Write};

use crate::conduction::mesh::{BrickMesh, VOID};
use crate::output::vtu::{self, Field, Hexahedra};

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
/// # Errors
/// Those of [`vtu::write`].
pub fn write(
    out: &mut dyn Write,
    mesh: &BrickMesh,
    comment: &str,
    fields: &[NodeField<'_>],
    materials: (&str, &[f64]),
) -> io::Result<()> {
    let solid = || mesh.materials().iter().enumerate().filter(|(_, m)| **m != VOID);
    let used: Vec<usize> = mesh.used_nodes().iter().enumerate().filter(|(_, used)| **used).map(|(n, _)| n).collect();
    let mut numbers = vec![0_u32; mesh.nodes()];
    for (number, node) in used.iter().enumerate() {
        numbers[*node] = u32::try_from(number).map_err(|_| io::Error::other("too many nodes for a VTU file"))?;
    }
    let [_, levels, across] = mesh.node_counts();
    let position = |n: &usize| mesh.position([n / (levels * across), n / across % levels, n % across]);
    let points: Vec<[f64; 3]> = used.iter().map(position).collect();
    let cells: Vec<[u32; 8]> = solid().map(|(cell, _)| mesh.deck_nodes(mesh.cell(cell)).map(|n| numbers[n])).collect();
    let (name, values) = materials;
    let of = |m: &u16| values.get(usize::from(*m)).copied().unwrap_or(0.0);
    let field = |f: &NodeField<'_>| Field::precise(f.name, used.iter().map(|n| f.values[*n]));
    let grid = Hexahedra {
        points: &points,
        cells: &cells,
        point_fields: fields.iter().map(field).collect(),
        cell_fields: vec![Field::precise(name, solid().map(|(_, m)| of(m)))],
    };
    vtu::write(&grid, comment, out)
}
