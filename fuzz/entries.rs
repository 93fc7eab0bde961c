//! What the fuzzers call: every reader, and what works on what it read, where that is small. The tests replay the corpus
//! through the same functions.

#![allow(dead_code)]

use std::path::Path;

use voxelastica_core::input::files::Format;
use voxelastica_core::results::ccx_dat;
use voxelastica_core::target::{FittedMeridian, MeshFormat, read_mesh, read_points};
use voxelastica_core::{Design, DesignInput, Limits};

/// Voxels that a fuzzed design may have to be computed as well.
const MOST_VOXELS: f64 = 2e4;
/// Points or vertices that a fuzzed target may have to be fitted as well.
const MOST_POINTS: usize = 2000;

/// A design file, as TOML and as JSON; small designs are computed.
pub fn design_file(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else { return };
    for format in [Format::Toml, Format::Json] {
        let read = DesignInput::from_text(text, format, "fuzz", "fuzz", Path::new("/nonexistent"));
        let Ok(input) = read.inspect_err(|e| assert!(!e.to_string().is_empty())) else { continue };
        let strips = &input.strips;
        let longest = strips.length_mm.max(input.hub_radius());
        let voxels = strips.length_mm * strips.thickness_mm * 7.0 * longest / input.voxels.size_mm.powi(3);
        if voxels < MOST_VOXELS {
            let _ = Design::compute(&input, Limits::default()).map_err(|e| e.to_string());
        }
    }
}

/// A meridian as CSV.
pub fn csv(data: &[u8]) {
    if let Ok(table) = read_points(data)
        && table.points().len() <= MOST_POINTS
    {
        let _ = FittedMeridian::from_points(table.points(), 100.0, 10.0);
    }
}

/// A mesh as OBJ.
pub fn obj(data: &[u8]) {
    mesh(data, MeshFormat::Obj);
}

/// A mesh as glTF or GLB.
pub fn gltf(data: &[u8]) {
    mesh(data, MeshFormat::Gltf);
}

/// A mesh as STL, text or binary.
pub fn stl(data: &[u8]) {
    mesh(data, MeshFormat::Stl);
}

fn mesh(data: &[u8], format: MeshFormat) {
    if let Ok(mesh) = read_mesh(data, format)
        && mesh.vertices.len() <= MOST_POINTS
        && mesh.triangles.len() <= 2 * MOST_POINTS
    {
        let axis = voxelastica_core::target::Axis::Auto;
        let _ = FittedMeridian::from_mesh(&mesh.vertices, &mesh.triangles, axis, 100.0, 10.0);
    }
}

/// A solver's result.
pub fn ccx_dat(data: &[u8]) {
    let _ = ccx_dat::parse(&String::from_utf8_lossy(data));
}
