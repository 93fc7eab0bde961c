//! Binary STL.
//!
//! A header of 80 bytes, the number of triangles, and for each its unit normal and three corners in single precision, all
//! little-endian. The format has no unit; ours is the mm. It has no vertices either, so readers weld corners that are equal,
//! or that fall into the same cell of a grid; [`Frame`] sees to it that a grid of a micrometre does no harm.

use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2, FRAC_PI_4};
use std::io::SeekFrom;

use super::layout::Placement;
use super::solid::{Point, Solid, SolidError};
use crate::output::Provenance;
use crate::output::folder::Destination;
use crate::progress::Cancelled;

/// Bytes before the first triangle, and bytes a triangle takes.
const HEADER: u64 = 84;
const FACET: u64 = 50;

/// Size of a file with this many triangles, bytes.
#[must_use]
pub fn size(triangles: u64) -> u64 {
    HEADER + FACET * triangles
}

/// A solid and where it stands in the file; several make one file.
#[derive(Clone, Copy)]
pub struct Body<'a> {
    /// The solid.
    pub solid: &'a dyn Solid,
    /// Where it stands.
    pub placement: Placement,
}

/// Edge of the cells in which a common reader (lib3mf) takes all corners for one, mm.
const CELL_MM: f64 = 1e-3;

/// Least distance of a moved corner from the boundaries of cells that matter, mm: more than single precision loses.
const MARGIN_MM: f64 = 1e-4;

/// A placement, and how lattice points are moved within their cell of the reader's grid, by less than a micrometre.
///
/// Around a lattice point where voxels of a phase touch, surfaces lie less than a cell apart. Their vertices are found along
/// the lattice's axes, turned by the placement, `d` away from the point. With the point in the middle of a cell they leave
/// the cell where `d cos` or `d sin` exceeds half a cell. Where the turn is neither, the point is moved to the corner of a
/// cell instead, and the four directions lead into four cells. So do the four diagonals, on which the corners of crossing
/// prisms lie; where the turn (45 degrees, say) would put those on the boundaries of cells, offsets are turned a little more.
#[derive(Debug, Clone, Copy)]
pub struct Frame {
    /// The placement.
    pub placement: Placement,
    /// Place of lattice points in the cell, in x, y and z, as a share of its edge.
    within: Point,
    /// Turn of the offsets: the placement's, or a little more.
    turn: Placement,
    /// Whether the lattice's planes are planes of the grid, so that everything moves together.
    together: bool,
}

impl Frame {
    /// The frame of lattices with voxels of a given edge.
    #[must_use]
    pub fn new(placement: Placement, edge_mm: f64) -> Self {
        let (along, across) = (placement.cosine.abs(), placement.sine.abs());
        // The slenderest contact reaches half a cell and a little.
        let cornered = along.min(across) * 0.5 * CELL_MM >= MARGIN_MM;
        let in_plane = if cornered { 0.0 } else { 0.5 };
        let cells = edge_mm / CELL_MM;
        let whole = |x: f64| (x - x.round()).abs() < 1e-6;
        let together = along.min(across) < 1e-12
            && whole(cells)
            && placement.shift.iter().all(|s| whole(s / CELL_MM) || whole(s / CELL_MM + 0.5));
        Self { placement, within: [in_plane, in_plane, 0.5], turn: Self::turn(placement, cornered), together }
    }

    /// The turn of offsets by which their diagonals keep off the boundaries of cells, where these meet in lattice points.
    fn turn(placement: Placement, cornered: bool) -> Placement {
        let plain = Placement { shift: [0.0; 3], ..placement };
        if !cornered {
            return plain;
        }
        let angle = placement.sine.atan2(placement.cosine);
        // From the boundary that is nearest to a diagonal.
        let diagonal = (angle + FRAC_PI_4 + FRAC_PI_4).rem_euclid(FRAC_PI_2) - FRAC_PI_4;
        let least = (MARGIN_MM / (FRAC_1_SQRT_2 * CELL_MM)).asin();
        if diagonal.abs() >= least {
            return plain;
        }
        let turned = angle + (least - diagonal.abs()).copysign(diagonal);
        Placement { cosine: turned.cos(), sine: turned.sin(), ..plain }
    }

    /// The place of a vertex: its lattice point, its offset from it, and where there is a contact, on which side is void.
    #[must_use]
    pub fn place(&self, point: Point, offset: Point, contact: Option<[i8; 2]>) -> Point {
        let mut point = self.placement.place(point);
        if contact.is_some() || self.together {
            for (coordinate, within) in point.iter_mut().zip(self.within) {
                // The cell of a point between two cells must not depend on its last digit.
                *coordinate = CELL_MM * ((*coordinate / CELL_MM - within + 0.5 + 1e-3).floor() + within);
            }
        }
        let mut offset = offset;
        if let Some([along, across]) = contact.filter(|_| offset == [0.0; 3] && self.within[0] == 0.0) {
            // In the corner of four cells a point joins what is on the side of void, not what is across the solid.
            offset = [f64::from(along) * MARGIN_MM, f64::from(across) * MARGIN_MM, 0.0];
        }
        let offset = self.turn.place(offset);
        std::array::from_fn(|k| point[k] + offset[k])
    }
}

/// Writes solids into one file and returns the number of triangles.
///
/// # Errors
/// [`SolidError::TooMany`] for more triangles than 32 bits can count, and what reading the solids or writing the file
/// returns.
pub fn write(
    out: &mut dyn Destination,
    provenance: &Provenance,
    bodies: &[Body<'_>],
    cancelled: Cancelled<'_>,
) -> Result<u64, SolidError> {
    out.write_all(&header(provenance))?;
    out.write_all(&0_u32.to_le_bytes())?;
    let mut written = 0;
    let mut bytes = Vec::new();
    for body in bodies {
        let frame = Frame::new(body.placement, body.solid.lattice_mm());
        body.solid.facets(&frame, cancelled, &mut |facets| {
            bytes.clear();
            facets.iter().for_each(|facet| put(&mut bytes, facet));
            written += facets.len() as u64;
            Ok(out.write_all(&bytes)?)
        })?;
    }
    let limit = u64::from(u32::MAX);
    let (what, format) = ("triangles", "STL");
    let count = u32::try_from(written).map_err(|_| SolidError::TooMany { count: written, what, format, limit })?;
    out.seek(SeekFrom::Start(HEADER - 4))?;
    out.write_all(&count.to_le_bytes())?;
    out.seek(SeekFrom::End(0))?;
    Ok(written)
}

/// Version, seed and the start of the design's hash; never `solid`, which would announce a text.
fn header(provenance: &Provenance) -> [u8; 80] {
    let mut header = [b' '; 80];
    let line = provenance.line();
    let text = line.bytes().filter(u8::is_ascii);
    header.iter_mut().zip(text).for_each(|(to, from)| *to = from);
    header
}

fn put(out: &mut Vec<u8>, facet: &[Point; 3]) {
    // Rounded first, so that the normal is that of the triangle in the file. Zero has no sign.
    let corners = facet.map(|p| p.map(|c| c as f32 + 0.0));
    let [a, b, c] = corners.map(|p| p.map(f64::from));
    let edge = |k: usize| (b[k] - a[k], c[k] - a[k]);
    let cross = |i: usize, j: usize| edge(i).0 * edge(j).1 - edge(j).0 * edge(i).1;
    let normal = [cross(1, 2), cross(2, 0), cross(0, 1)];
    let length = normal.iter().map(|n| n * n).sum::<f64>().sqrt();
    let unit = normal.map(|n| if length > 0.0 { (n / length) as f32 + 0.0 } else { 0.0 });
    for value in unit.iter().chain(corners.iter().flatten()) {
        out.extend_from_slice(&value.to_le_bytes());
    }
    out.extend_from_slice(&[0, 0]);
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::*;
    use crate::fabrication::solid::{Mesh, PhaseSolid};
    use crate::fabrication::voxel_surface::VoxelSurface;
    use crate::progress;
    use crate::voxel::VoxelGrid;

    fn provenance() -> Provenance {
        Provenance { version: "1.2.3".to_owned(), seed: 7, design_sha256: "a".repeat(64) }
    }

    #[test]
    fn another_reader_finds_the_triangles_and_their_normals() {
        let mut grid = VoxelGrid::new(0.5, 2, vec![2, 1, 2]);
        grid.slice_mut(1).copy_from_slice(&[0, 1, 1, 0]);
        let surface = VoxelSurface::new(&grid, 100.0).unwrap();
        let (plain, mirrored) =
            (PhaseSolid { surface, phase: 0, mirrored: false }, PhaseSolid { surface, phase: 0, mirrored: true });
        let turned = Placement { cosine: 0.0, sine: 1.0, shift: [0.0, 20.0, 0.0] };
        let bodies =
            [Body { solid: &plain, placement: Placement::IDENTITY }, Body { solid: &mirrored, placement: turned }];
        let mut file = Cursor::new(Vec::new());
        write(&mut file, &provenance(), &bodies, &progress::never).unwrap();
        let bytes = file.into_inner();
        let count = 2 * plain.count(&progress::never).unwrap();
        assert_eq!(bytes.len() as u64, size(count));
        assert!(bytes.starts_with(b"Voxelastica 1.2.3, seed 7, design aaaa"));
        let read = stl_io::read_stl(&mut Cursor::new(&bytes)).unwrap();
        read.validate().unwrap();
        assert_eq!(read.faces.len() as u64, count);
        let corner = |k: usize| read.vertices[k].0.map(f64::from);
        let mut volume = 0.0;
        for face in &read.faces {
            let [a, b, c] = face.vertices.map(corner);
            let normal = face.normal.0.map(f64::from);
            let height: f64 = (0..3).map(|k| normal[k] * a[k]).sum();
            let cross = [0, 1, 2].map(|k| {
                let (i, j) = ((k + 1) % 3, (k + 2) % 3);
                (b[i] - a[i]) * (c[j] - a[j]) - (b[j] - a[j]) * (c[i] - a[i])
            });
            let area = 0.5 * (0..3).map(|k| cross[k] * normal[k]).sum::<f64>();
            assert!(area > 0.0);
            volume += height * area / 3.0;
        }
        assert!((volume - 2.0 * 18.0 * 0.125).abs() < 1e-5, "{volume}");
    }

    #[test]
    fn an_empty_phase_is_an_empty_file() {
        let mut file = Cursor::new(Vec::new());
        let empty = Mesh::default();
        let body = Body { solid: &empty, placement: Placement::IDENTITY };
        write(&mut file, &provenance(), &[body], &progress::never).unwrap();
        assert_eq!(file.into_inner().len() as u64, size(0));
    }

    #[test]
    fn cancelling_stops() {
        let grid = VoxelGrid::new(0.5, 2, vec![2; 40]);
        let solid = PhaseSolid { surface: VoxelSurface::new(&grid, 100.0).unwrap(), phase: 0, mirrored: false };
        let body = Body { solid: &solid, placement: Placement::IDENTITY };
        let error = write(&mut Cursor::new(Vec::new()), &provenance(), &[body], &|| true).unwrap_err();
        assert!(matches!(error, SolidError::Surface(crate::fabrication::voxel_surface::SurfaceError::Cancelled)));
    }
}
