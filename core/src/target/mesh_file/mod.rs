//! Meshes from files: .obj, .gltf, .glb and .stl.
//!
//! Every reader has two entries. The one for bytes needs no file system; the one for a path reads what a .gltf refers to
//! beside it, too. Sizes and declared counts are checked before memory is taken, and no bytes make a reader panic.

mod gltf;
mod obj;
mod stl;

use std::path::Path;

use super::error::TargetError;
use super::points::read_limited;
use super::triangle_mesh::{TriangleMesh, check_mesh};
use crate::progress::{Cancelled, never};

/// Most bytes a mesh file, with what it refers to, may have.
pub const MAX_MESH_BYTES: u64 = 1 << 30;

/// The formats that are read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MeshFormat {
    /// Wavefront: `v` and `f` lines; materials, normals and texture coordinates are skipped.
    Obj,
    /// glTF 2.0, as JSON or binary (.glb).
    Gltf,
    /// STL, as text or binary.
    Stl,
}

impl MeshFormat {
    /// The format that a file's ending, in any case, stands for.
    ///
    /// # Errors
    ///
    /// An ending other than .obj, .gltf, .glb and .stl.
    pub fn of(path: &Path) -> Result<Self, TargetError> {
        let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default();
        match extension.as_str() {
            "obj" => Ok(Self::Obj),
            "gltf" | "glb" => Ok(Self::Gltf),
            "stl" => Ok(Self::Stl),
            _ => Err(TargetError::MeshFormat { extension: format!(".{extension}") }),
        }
    }
}

/// Reads a mesh from the bytes of a file. A glTF document's buffers must be embedded.
///
/// ```
/// use voxelastica_core::target::{MeshFormat, read_mesh};
///
/// let mesh = read_mesh(b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n", MeshFormat::Obj)?;
/// assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
/// # Ok::<(), voxelastica_core::target::TargetError>(())
/// ```
///
/// # Errors
///
/// More than [`MAX_MESH_BYTES`]; bytes that are not of the format or cut short; what [`TriangleMesh::check`] refuses.
pub fn read_mesh(bytes: &[u8], format: MeshFormat) -> Result<TriangleMesh, TargetError> {
    read_mesh_unless(bytes, format, &never)
}

/// As [`read_mesh`], but gives up once `cancelled` says so.
///
/// # Errors
///
/// Those of [`read_mesh`], and [`TargetError::Cancelled`].
pub fn read_mesh_unless(
    bytes: &[u8],
    format: MeshFormat,
    cancelled: Cancelled<'_>,
) -> Result<TriangleMesh, TargetError> {
    let no_files = |uri: &str| {
        Err(TargetError::BufferUri {
            uri: uri.to_owned(),
            reason: String::from("a mesh handed over as bytes must embed its buffers; save it as .glb"),
        })
    };
    read(bytes, format, &no_files, cancelled)
}

/// Reads a mesh from a file whose ending names the format.
///
/// A .gltf may refer to buffers in files beside it or in folders below; absolute paths, `..` and addresses are refused.
///
/// # Errors
///
/// An unknown ending, files that cannot be read, and what [`read_mesh`] refuses.
pub fn read_mesh_file(path: &Path) -> Result<TriangleMesh, TargetError> {
    read_mesh_file_unless(path, &never)
}

/// As [`read_mesh_file`], but gives up once `cancelled` says so.
///
/// # Errors
///
/// Those of [`read_mesh_file`], and [`TargetError::Cancelled`].
pub fn read_mesh_file_unless(path: &Path, cancelled: Cancelled<'_>) -> Result<TriangleMesh, TargetError> {
    let format = MeshFormat::of(path)?;
    let bytes = read_limited(path, check_size, cancelled)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let beside = |uri: &str| read_limited(&folder.join(gltf::relative_path(uri)?), check_size, cancelled);
    read(&bytes, format, &beside, cancelled)
}

type BufferReader<'a> = &'a dyn Fn(&str) -> Result<Vec<u8>, TargetError>;

fn read(
    bytes: &[u8],
    format: MeshFormat,
    buffers: BufferReader,
    cancelled: Cancelled<'_>,
) -> Result<TriangleMesh, TargetError> {
    check_size(bytes.len() as u64)?;
    let mesh = match format {
        MeshFormat::Obj => obj::read(bytes, cancelled),
        MeshFormat::Gltf => gltf::read(bytes, buffers, cancelled),
        MeshFormat::Stl => stl::read(bytes, cancelled),
    };
    // What a reader made of bytes that stopped coming is not its error.
    let mesh = if cancelled() { Err(TargetError::Cancelled) } else { mesh }?;
    check_mesh(&mesh.vertices, &mesh.triangles, cancelled)?;
    Ok(mesh)
}

fn check_size(bytes: u64) -> Result<(), TargetError> {
    if bytes > MAX_MESH_BYTES {
        return Err(TargetError::TooManyBytes { what: "mesh file", bytes, limit: MAX_MESH_BYTES });
    }
    Ok(())
}

/// The first characters of a text that may be as long as the file.
fn shortened(text: &str) -> String {
    text.chars().take(60).collect()
}
