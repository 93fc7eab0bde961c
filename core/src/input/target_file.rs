//! Takes in the target of a design that names a file.

use std::path::Path;

use super::InputError;
use super::files::{hex_sha256_unless, read_bytes};
use super::model::{AxisInput, DesignInput, RevolutionRecord, TargetInput};
use crate::error::Error;
use crate::progress::{Cancelled, never};
use crate::target::{
    Axis, FittedMeridian, MAX_MESH_BYTES, MAX_POINTS_BYTES, MeridianCurve, MeshFormat, TargetError, TriangleMesh,
    read_mesh_file_unless, read_mesh_unless, read_points,
};

/// Points at which a mesh's smooth meridian is recorded: far denser than any feature of it.
const MERIDIAN_POINTS: usize = 801;

impl DesignInput {
    /// Reads the file of a `points` or `mesh` target, relative to `folder`, unless its meridian is already there.
    ///
    /// # Errors
    /// [`Error::Input`] naming the file, the key and what is wrong in it; [`Error::Cancelled`].
    pub(super) fn load_target(&mut self, folder: &Path, cancelled: Cancelled<'_>) -> Result<(), Error> {
        match &mut self.target {
            TargetInput::Points { file: Some(file), meridian, content_sha256 } if meridian.is_empty() => {
                let bytes = read_named(folder, file, MAX_POINTS_BYTES, cancelled)?;
                let table = read_points(&bytes).map_err(|e| wrong(file, &e))?;
                *meridian = table.points().to_vec();
                *content_sha256 = Some(hex_sha256_unless(&bytes, cancelled).ok_or(Error::Cancelled)?);
            }
            TargetInput::Mesh { file: Some(file), axis, meridian, revolution, content_sha256 }
                if meridian.is_empty() =>
            {
                let bytes = read_named(folder, file, MAX_MESH_BYTES, cancelled)?;
                let path = folder.join(&*file);
                let read = || match MeshFormat::of(&path)? {
                    // A glTF file may keep its numbers in files of their own.
                    MeshFormat::Gltf => read_mesh_file_unless(&path, cancelled),
                    format => read_mesh_unless(&bytes, format, cancelled),
                };
                let mesh = read().map_err(|e| wrong(file, &e))?;
                let hub_radius = self.strips.hub_radius_mm.unwrap_or(0.0);
                let (points, record) = extract_unless(&mesh, axis, self.strips.length_mm, hub_radius, cancelled)
                    .map_err(|e| wrong(file, &e))?;
                *meridian = points;
                *revolution = Some(record);
                *content_sha256 = Some(hex_sha256_unless(&bytes, cancelled).ok_or(Error::Cancelled)?);
            }
            _ => {}
        }
        Ok(())
    }
}

/// The smooth outer meridian of a mesh, `[rho, z]` in mm, and what was found out about the mesh.
///
/// # Errors
/// [`TargetError`] for a mesh that is not a surface of revolution or does not reach the hub.
pub fn extract(
    mesh: &TriangleMesh,
    axis: &AxisInput,
    length_mm: f64,
    hub_radius_mm: f64,
) -> Result<(Vec<[f64; 2]>, RevolutionRecord), TargetError> {
    extract_unless(mesh, axis, length_mm, hub_radius_mm, &never)
}

/// As [`extract`], but gives up once `cancelled` says so.
///
/// # Errors
/// Those of [`extract`], and [`TargetError::Cancelled`].
pub fn extract_unless(
    mesh: &TriangleMesh,
    axis: &AxisInput,
    length_mm: f64,
    hub_radius_mm: f64,
    cancelled: Cancelled<'_>,
) -> Result<(Vec<[f64; 2]>, RevolutionRecord), TargetError> {
    let axis = match axis {
        AxisInput::Vector(direction) => Axis::Vector(*direction),
        AxisInput::Named(name) => match name.as_str() {
            "x" => Axis::X,
            "y" => Axis::Y,
            "z" => Axis::Z,
            _ => Axis::Auto,
        },
    };
    let fitted =
        FittedMeridian::from_mesh_unless(&mesh.vertices, &mesh.triangles, axis, length_mm, hub_radius_mm, cancelled)?;
    let length = fitted.curve.length();
    let points =
        (0..MERIDIAN_POINTS).map(|i| fitted.curve.position(length * i as f64 / (MERIDIAN_POINTS - 1) as f64)).collect();
    let revolution = fitted.revolution.unwrap_or_default();
    let record = RevolutionRecord {
        axis_direction: revolution.axis_direction,
        axis_point: revolution.axis_point,
        rms_percent: 100.0 * revolution.rms_share,
        scale: fitted.scale,
        residual_rms_mm: fitted.residual_rms_mm,
        residual_max_mm: fitted.residual_max_mm,
    };
    Ok((points, record))
}

fn wrong(file: &str, error: &TargetError) -> Error {
    match error {
        TargetError::Cancelled => Error::Cancelled,
        _ => Error::Input(InputError::new("target.file", format!("\"{file}\""), error.to_string())),
    }
}

fn read_named(folder: &Path, file: &str, largest: u64, cancelled: Cancelled<'_>) -> Result<Vec<u8>, Error> {
    read_bytes(&folder.join(file), largest, cancelled).map_err(|problem| match cancelled() {
        true => Error::Cancelled,
        false => Error::Input(InputError::new("target.file", format!("\"{file}\""), problem)),
    })
}
