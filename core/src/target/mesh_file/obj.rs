//! Wavefront .obj.

use std::io::{BufReader, Cursor};

use super::shortened;
use crate::progress::{Cancelled, Watched, stops_at};
use crate::target::error::TargetError;
use crate::target::triangle_mesh::{TriangleMesh, check_counts};

/// Faces in one object of the essence. `tobj` hands over whole objects, so that work can be cancelled between them.
const OBJECT_FACES: usize = 1 << 17;

pub(super) fn read(bytes: &[u8], cancelled: Cancelled<'_>) -> Result<TriangleMesh, TargetError> {
    let essence = essence(bytes, cancelled)?;
    let options =
        tobj::LoadOptions { triangulate: true, ignore_points: true, ignore_lines: true, ..Default::default() };
    let no_materials = |_: &std::path::Path| Ok(Default::default());
    let mut watched = BufReader::new(Watched::new(Cursor::new(essence), cancelled));
    let (models, _) =
        tobj::load_obj_buf(&mut watched, &options, no_materials).map_err(|error| refused(error.to_string()))?;
    let mut mesh = TriangleMesh::default();
    for model in &models {
        if cancelled() {
            return Err(TargetError::Cancelled);
        }
        let first = mesh.vertices.len() as u32;
        let position = |p: &[f32]| <[f32; 3]>::try_from(p).map(|p| p.map(f64::from)).ok();
        mesh.vertices.extend(model.mesh.positions.chunks_exact(3).filter_map(position));
        let corners = |c: &[u32]| <[u32; 3]>::try_from(c).map(|c| c.map(|i| i + first)).ok();
        mesh.triangles.extend(model.mesh.indices.chunks_exact(3).filter_map(corners));
    }
    Ok(mesh)
}

fn refused(reason: String) -> TargetError {
    TargetError::MeshFile { format: "OBJ", reason }
}

/// The `v` lines, then the `f` lines, with positions and position indices alone, all of them checked.
///
/// `tobj` multiplies and indexes with texture and normal indices as they stand in the file, and slices the names of
/// objects; left to itself it panics on some files. What it never sees cannot hurt.
fn essence(bytes: &[u8], cancelled: Cancelled<'_>) -> Result<String, TargetError> {
    // Vertices first: an object that is handed over must find all its own.
    let (mut positions, mut text) = (String::new(), String::new());
    let (mut vertices, mut triangles, mut faces) = (0_u64, 0_u64, 0_usize);
    // The largest index so far and its line: faces may come before their vertices.
    let mut largest = (0, 0);
    let mut lines = bytes.split(|&b| b == b'\n').enumerate();
    while let Some((number, line)) = lines.next() {
        let line_number = number + 1;
        if stops_at(number, cancelled) {
            return Err(TargetError::Cancelled);
        }
        let mut line = line.trim_ascii().to_vec();
        if !matches!(line.get(..2), Some([b'v' | b'f', b' ' | b'\t'])) {
            continue;
        }
        while line.last() == Some(&b'\\') {
            line.pop();
            let Some((_, more)) = lines.next() else { break };
            line.extend_from_slice(more.trim_ascii());
        }
        let line = String::from_utf8_lossy(&line);
        let mut words = line.split_ascii_whitespace();
        let wrong = |what: &str, word: &str| refused(format!("line {line_number}: `{}` {what}", shortened(word)));
        if words.next() == Some("v") {
            vertices += 1;
            check_counts(vertices, 0)?;
            positions.push('v');
            // Three numbers are a position, a fourth alone its weight, six a position and a colour.
            let values: Vec<&str> = words.take(6).collect();
            if values.len() < 3 {
                return Err(wrong("has fewer than three coordinates", &line));
            }
            let used = if values.len() == 4 { 4 } else { 3 };
            for word in values.into_iter().take(used) {
                if !word.parse::<f32>().is_ok_and(f32::is_finite) {
                    return Err(wrong("is not a finite number", word));
                }
                positions.push(' ');
                positions.push_str(word);
            }
            positions.push('\n');
        } else {
            if faces > 0 && faces.is_multiple_of(OBJECT_FACES) {
                text.push_str("o next\n");
            }
            faces += 1;
            text.push('f');
            let mut corners = 0_u64;
            for word in words {
                let index: i64 = word
                    .split('/')
                    .next()
                    .and_then(|index| index.parse().ok())
                    .ok_or_else(|| wrong("is not a vertex index", word))?;
                let absolute = if index < 0 { vertices as i64 + index + 1 } else { index };
                if absolute < 1 || absolute > u32::MAX.into() {
                    return Err(wrong("refers to no vertex", word));
                }
                largest = largest.max((absolute as u64, line_number));
                text.push_str(&format!(" {absolute}"));
                corners += 1;
            }
            triangles += corners.saturating_sub(2);
            check_counts(0, triangles)?;
            text.push('\n');
        }
    }
    if largest.0 > vertices {
        return Err(refused(format!(
            "line {}: the face refers to vertex {}, the file has {vertices}",
            largest.1, largest.0
        )));
    }
    positions.push_str(&text);
    Ok(positions)
}
