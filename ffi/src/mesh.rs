//! `voxelastica_mesh`: the surface of one spoke.

use voxelastica_core::Design;
use voxelastica_core::surface::{SpokeSurface, Strip};

use crate::arguments;
use crate::arguments::{Out, buffer, within};
use crate::array::{ArrayF64, ArrayU32};
use crate::boundary::{enter, value_or};
use crate::design::DesignObject;
use crate::error::ErrorObject;
use crate::failure::Failure;
use crate::registry::{Handle, find, keep, release};
use crate::status::Status;

/// Which strip's shape is taken.
#[repr(i32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StripKind {
    /// The smooth, graded one: the design itself.
    Graded = 0,
    /// The voxelised one, as the forward model predicts it.
    Voxel = 1,
}

/// Most quads along or across a spoke.
pub(crate) const MOST_QUADS: usize = 20_000;
/// Most vertices of a mesh: what 32-bit indices and a host's memory bear.
const MOST_VERTICES: usize = 50_000_000;

/// A strip by its number.
///
/// # Errors
/// [`Failure`] for another number than those of [`StripKind`].
pub fn strip(number: i32) -> Result<Strip, Failure> {
    match number {
        0 => Ok(Strip::Graded),
        1 => Ok(Strip::Voxel),
        _ => Err(Failure::range("strip", number, "a voxelastica_strip_kind")),
    }
}

pub(crate) fn check_grid(spokes: usize, along: usize, across: usize) -> Result<(), Failure> {
    within("along", along, 1, MOST_QUADS)?;
    within("across", across, 1, MOST_QUADS)?;
    within("vertices", spokes * (along + 1) * (across + 1), 4, MOST_VERTICES).map(|_| ())
}

/// The surface of spoke `spoke` (from 0) at a fraction of the morph.
///
/// # Errors
/// [`Failure`] for arguments out of range, and where the path could not be followed.
pub fn spoke_surface(
    design: &Design,
    strip: Strip,
    at: f64,
    spoke: usize,
    along: usize,
    across: usize,
) -> Result<SpokeSurface, Failure> {
    let spokes = design.input().count();
    within("spoke", spoke, 0, spokes - 1)?;
    check_grid(1, along, across)?;
    let surface = design.spoke_surface(strip, arguments::fraction(at)?, along, across)?;
    Ok(if spoke == 0 { surface } else { surface.turned(spoke, spokes) })
}

/// Corners of the hub at a fraction of the morph.
///
/// # Errors
/// [`Failure`] for a fraction out of range, and where the path could not be followed.
pub fn hub(design: &Design, strip: Strip, at: f64) -> Result<Vec<[f64; 3]>, Failure> {
    Ok(design.hub_polygon(strip, arguments::fraction(at)?)?)
}

/// The mid-surface of one spoke as a grid of quads, `along + 1` by `across + 1` vertices, rim first, from one edge to the
/// other. Immutable.
///
/// A dome's spoke lies in the flower's frame: hub on the z axis, spoke 0 along +x, z up from the plane of the rim. A
/// rectangular strip lies along x with its rim at the origin. All lengths in mm.
pub struct Mesh {
    surface: SpokeSurface,
    quads: Vec<[u32; 4]>,
}

impl Handle for Mesh {
    const NAME: &'static str = "mesh";
}

/// Makes the surface of spoke `spoke` (from 0) of the strip `strip` (a `voxelastica_strip_kind`) at a fraction of the
/// morph: 0 is flat, 1 closed. `along` by `across` quads. Free it with `voxelastica_mesh_free`; the design may go before.
///
/// # Safety
/// `mesh` and `error` are null or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn voxelastica_mesh_new(
    design: *const DesignObject,
    strip: i32,
    fraction: f64,
    spoke: usize,
    along: usize,
    across: usize,
    mesh: *mut *mut Mesh,
    error: *mut *mut ErrorObject,
) -> Status {
    // SAFETY: by this function's contract.
    unsafe {
        enter(error, || {
            let (design, out) = (find(design)?, Out::new("mesh", mesh)?);
            let surface = spoke_surface(&design.design, self::strip(strip)?, fraction, spoke, along, across)?;
            let quads = surface.quads();
            out.set(keep(Mesh { surface, quads }));
            Ok(())
        })
    }
}

/// Lends the vertices, `x, y, z` a row in mm, until the mesh is freed.
///
/// # Safety
/// `array` and `error` are null or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn voxelastica_mesh_positions(
    mesh: *const Mesh,
    array: *mut ArrayF64,
    error: *mut *mut ErrorObject,
) -> Status {
    // SAFETY: by this function's contract.
    unsafe {
        enter(error, || {
            let (mesh, out) = (find(mesh)?, Out::new("array", array)?);
            out.set(ArrayF64::table(&mesh.surface.positions));
            Ok(())
        })
    }
}

/// Lends the unit normals, one a vertex, up in the flat state and outward in the morphed one, until the mesh is freed.
///
/// # Safety
/// `array` and `error` are null or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn voxelastica_mesh_normals(
    mesh: *const Mesh,
    array: *mut ArrayF64,
    error: *mut *mut ErrorObject,
) -> Status {
    // SAFETY: by this function's contract.
    unsafe {
        enter(error, || {
            let (mesh, out) = (find(mesh)?, Out::new("array", array)?);
            out.set(ArrayF64::table(&mesh.surface.normals));
            Ok(())
        })
    }
}

/// Lends the designed modulus in MPa, one a vertex, until the mesh is freed.
///
/// # Safety
/// `array` and `error` are null or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn voxelastica_mesh_modulus(
    mesh: *const Mesh,
    array: *mut ArrayF64,
    error: *mut *mut ErrorObject,
) -> Status {
    // SAFETY: by this function's contract.
    unsafe {
        enter(error, || {
            let (mesh, out) = (find(mesh)?, Out::new("array", array)?);
            out.set(ArrayF64::column(&mesh.surface.modulus_mpa));
            Ok(())
        })
    }
}

/// Lends the quads, four vertices a row, counter-clockwise seen from where the normals point, until the mesh is freed.
///
/// # Safety
/// `array` and `error` are null or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn voxelastica_mesh_quads(
    mesh: *const Mesh,
    array: *mut ArrayU32,
    error: *mut *mut ErrorObject,
) -> Status {
    // SAFETY: by this function's contract.
    unsafe {
        enter(error, || {
            let (mesh, out) = (find(mesh)?, Out::new("array", array)?);
            out.set(ArrayU32::table(&mesh.quads));
            Ok(())
        })
    }
}

/// Writes the corners of the hub at a fraction of the morph, `x, y, z` each in mm, into a buffer of exactly three times
/// `voxelastica_design_spokes` values, counter-clockwise; edge `i` is the end of spoke `i`. A rectangular strip has no hub.
///
/// # Safety
/// `corners` is null or writable for `length` values; `error` is null or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn voxelastica_design_hub(
    design: *const DesignObject,
    strip: i32,
    fraction: f64,
    corners: *mut f64,
    length: usize,
    error: *mut *mut ErrorObject,
) -> Status {
    // SAFETY: by this function's contract.
    unsafe {
        enter(error, || {
            let design = find(design)?;
            let polygon = hub(&design.design, self::strip(strip)?, fraction)?;
            buffer("corners", corners, length, 3 * polygon.len())?.copy_from_slice(polygon.as_flattened());
            Ok(())
        })
    }
}

/// Frees a mesh. Null is allowed.
#[unsafe(no_mangle)]
pub extern "C" fn voxelastica_mesh_free(mesh: *mut Mesh) -> Status {
    value_or(Status::BadHandle, || release(mesh).map(|()| Status::Ok))
}
