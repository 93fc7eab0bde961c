//! STL, text or binary.

use std::io::Cursor;

use super::shortened;
use crate::progress::{Cancelled, stops_at};
use crate::target::error::TargetError;
use crate::target::triangle_mesh::{TriangleMesh, Welder, check_counts};

/// Bytes before the first facet of a binary file, the last four of which hold the count, and bytes a facet.
const HEADER: usize = 84;
const FACET: usize = 50;

pub(super) fn read(bytes: &[u8], cancelled: Cancelled<'_>) -> Result<TriangleMesh, TargetError> {
    let mut mesh = Builder { welder: Welder::default(), triangles: Vec::new(), cancelled };
    let is_text = bytes.trim_ascii_start().get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid"));
    // Some binary files start with `solid` too; theirs is the size that the count asks for.
    if is_text && binary_size(bytes).is_none_or(|size| size != bytes.len() as u64) {
        for solid in solids(bytes, cancelled) {
            mesh.add(&solid)?;
        }
    } else {
        let Some(size) = binary_size(bytes) else {
            return Err(TargetError::Truncated {
                format: "STL",
                what: "bytes of header",
                declared: HEADER as u64,
                held: bytes.len() as u64,
            });
        };
        let held = bytes.len().saturating_sub(HEADER) / FACET;
        let declared = (size - HEADER as u64) / FACET as u64;
        if size > bytes.len() as u64 {
            return Err(TargetError::Truncated { format: "STL", what: "facets", declared, held: held as u64 });
        }
        check_counts(0, declared)?;
        // The reader takes a file that starts with `solid ` for text; the header's words carry nothing.
        let mut blank = vec![b' '; HEADER - 4];
        blank.extend_from_slice(bytes.get(HEADER - 4..).unwrap_or_default());
        mesh.add(&blank)?;
    }
    Ok(TriangleMesh { vertices: mesh.welder.vertices, triangles: mesh.triangles })
}

/// The size of a binary file with the count that its header declares.
fn binary_size(bytes: &[u8]) -> Option<u64> {
    let count: [u8; 4] = bytes.get(HEADER - 4..HEADER)?.try_into().ok()?;
    Some(HEADER as u64 + FACET as u64 * u64::from(u32::from_le_bytes(count)))
}

/// The solids of a text file, one after the other, in the form the reader expects: `solid ` with a space, lower case. Cut
/// short once work is cancelled.
fn solids<'a>(bytes: &'a [u8], cancelled: Cancelled<'a>) -> impl Iterator<Item = Vec<u8>> + 'a {
    let mut lines = bytes.split(|&b| b == b'\n' || b == b'\r').map(<[u8]>::trim_ascii).filter(|line| !line.is_empty());
    std::iter::from_fn(move || {
        lines.next()?;
        let mut solid = b"solid \n".to_vec();
        for (number, line) in lines.by_ref().enumerate() {
            if stops_at(number, cancelled) {
                break;
            }
            solid.extend(line.to_ascii_lowercase());
            solid.push(b'\n');
            if line.get(..8).is_some_and(|word| word.eq_ignore_ascii_case(b"endsolid")) {
                break;
            }
        }
        Some(solid)
    })
}

struct Builder<'a> {
    welder: Welder,
    triangles: Vec<[u32; 3]>,
    cancelled: Cancelled<'a>,
}

impl Builder<'_> {
    fn add(&mut self, file: &[u8]) -> Result<(), TargetError> {
        let refused =
            |error: std::io::Error| TargetError::MeshFile { format: "STL", reason: shortened(&error.to_string()) };
        let mut cursor = Cursor::new(file);
        for facet in stl_io::create_stl_reader(&mut cursor).map_err(refused)? {
            let facet = facet.map_err(refused)?;
            check_counts(0, self.triangles.len() as u64 + 1)?;
            if stops_at(self.triangles.len(), self.cancelled) {
                return Err(TargetError::Cancelled);
            }
            let mut corners = [0; 3];
            for (corner, vertex) in corners.iter_mut().zip(facet.vertices) {
                *corner = self.welder.index(vertex.0.map(f64::from))?;
            }
            self.triangles.push(corners);
        }
        Ok(())
    }
}
