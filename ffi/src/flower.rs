//! `voxelastica_flower`: all spokes at once, for animation.

use std::sync::Arc;

use voxelastica_core::Design;
use voxelastica_core::flower::{Coordinate, Flower};
use voxelastica_core::surface::Strip;

use crate::arguments::{Out, buffer, exactly, fraction};
use crate::array::{ArrayF64, ArrayU32};
use crate::boundary::{enter, value_or};
use crate::design::DesignObject;
use crate::error::ErrorObject;
use crate::failure::Failure;
use crate::mesh::{check_grid, strip};
use crate::registry::{Handle, find, keep, release};
use crate::status::Status;

/// All spokes of a design, with what does not change.
pub struct PreparedFlower {
    design: Arc<Design>,
    flower: Flower,
    quads: Vec<[u32; 4]>,
}

impl PreparedFlower {
    /// Prepares `along` by `across` quads a spoke.
    ///
    /// # Errors
    /// [`Failure`] for more quads than fit.
    pub fn new(design: Arc<Design>, strip: Strip, along: usize, across: usize) -> Result<Self, Failure> {
        check_grid(design.input().count(), along, across)?;
        let flower = Flower::new(&design, strip, along, across);
        let quads = flower.quads();
        Ok(Self { design, flower, quads })
    }

    /// Number of vertices.
    #[must_use]
    pub fn vertices(&self) -> usize {
        self.flower.vertices()
    }

    /// Four vertices a quad.
    #[must_use]
    pub fn quads(&self) -> &[[u32; 4]] {
        &self.quads
    }

    /// Modulus at the vertices, MPa.
    #[must_use]
    pub fn modulus_mpa(&self) -> &[f64] {
        self.flower.modulus_mpa()
    }

    /// Fills vertices and, unless they have no room, normals at a fraction of the morph.
    ///
    /// # Errors
    /// [`Failure`] for wrong lengths, a fraction out of range, and where the path could not be followed.
    pub fn fill<T: Coordinate>(&self, at: f64, positions: &mut [T], normals: &mut [T]) -> Result<(), Failure> {
        let wanted = 3 * self.vertices();
        exactly("positions", positions.len(), wanted)?;
        let normals = if normals.is_empty() {
            None
        } else {
            exactly("normals", normals.len(), wanted)?;
            Some(normals.as_chunks_mut::<3>().0)
        };
        Ok(self.flower.fill(&self.design, fraction(at)?, positions.as_chunks_mut::<3>().0, normals)?)
    }
}

/// The surfaces of all spokes, prepared so that a new fraction of the morph fills a caller's buffers in about a
/// millisecond. Immutable; several threads may fill buffers of their own at once.
pub struct FlowerObject(PreparedFlower);

impl Handle for FlowerObject {
    const NAME: &'static str = "flower";
}

/// Prepares the surfaces of all spokes of the strip `strip` (a `voxelastica_strip_kind`), `along` by `across` quads each,
/// in the order and the frame of `voxelastica_mesh`, spoke after spoke. Free it with `voxelastica_flower_free`; the design
/// may go before.
///
/// # Safety
/// `flower` and `error` are null or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn voxelastica_flower_new(
    design: *const DesignObject,
    strip: i32,
    along: usize,
    across: usize,
    flower: *mut *mut FlowerObject,
    error: *mut *mut ErrorObject,
) -> Status {
    // SAFETY: by this function's contract.
    unsafe {
        enter(error, || {
            let (design, out) = (find(design)?, Out::new("flower", flower)?);
            let flower = PreparedFlower::new(Arc::clone(&design.design), self::strip(strip)?, along, across)?;
            out.set(keep(FlowerObject(flower)));
            Ok(())
        })
    }
}

/// Number of vertices of all spokes; 0 if this is not a flower.
#[unsafe(no_mangle)]
pub extern "C" fn voxelastica_flower_vertices(flower: *const FlowerObject) -> usize {
    value_or(0, || Ok(find(flower)?.0.vertices()))
}

/// Lends the quads of all spokes, four vertices a row, until the flower is freed. They do not change with the morph.
///
/// # Safety
/// `array` and `error` are null or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn voxelastica_flower_quads(
    flower: *const FlowerObject,
    array: *mut ArrayU32,
    error: *mut *mut ErrorObject,
) -> Status {
    // SAFETY: by this function's contract.
    unsafe {
        enter(error, || {
            let (flower, out) = (find(flower)?, Out::new("array", array)?);
            out.set(ArrayU32::table(flower.0.quads()));
            Ok(())
        })
    }
}

/// Lends the designed modulus in MPa, one a vertex, until the flower is freed. It does not change with the morph.
///
/// # Safety
/// `array` and `error` are null or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn voxelastica_flower_modulus(
    flower: *const FlowerObject,
    array: *mut ArrayF64,
    error: *mut *mut ErrorObject,
) -> Status {
    // SAFETY: by this function's contract.
    unsafe {
        enter(error, || {
            let (flower, out) = (find(flower)?, Out::new("array", array)?);
            out.set(ArrayF64::column(flower.0.modulus_mpa()));
            Ok(())
        })
    }
}

/// Fills buffers with vertices and, unless `normals` is null, normals at a fraction of the morph.
///
/// # Safety
/// Both buffers are null or writable for their lengths.
unsafe fn fill<T: Coordinate>(
    flower: *const FlowerObject,
    at: f64,
    positions: (*mut T, usize),
    normals: (*mut T, usize),
) -> Result<(), Failure> {
    let flower = find(flower)?;
    let wanted = 3 * flower.0.vertices();
    // SAFETY: by this function's contract; the two do not overlap.
    let (positions, normals) = unsafe {
        let places = buffer("positions", positions.0, positions.1, wanted)?;
        if normals.0.is_null() && normals.1 == 0 {
            (places, <&mut [T]>::default())
        } else if positions.0 == normals.0 {
            return Err(Failure::range("normals", "", "another buffer than positions"));
        } else {
            (places, buffer("normals", normals.0, normals.1, wanted)?)
        }
    };
    flower.0.fill(at, positions, normals)
}

/// Writes the vertices at a fraction of the morph, `x, y, z` each in mm, into `positions`, and unit normals into `normals`
/// (null with length 0: none). Each holds exactly three times `voxelastica_flower_vertices` values; on an error both are
/// untouched.
///
/// # Safety
/// Both buffers are null or writable for their lengths and do not overlap; `error` is null or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn voxelastica_flower_fill_f32(
    flower: *const FlowerObject,
    fraction: f64,
    positions: *mut f32,
    positions_length: usize,
    normals: *mut f32,
    normals_length: usize,
    error: *mut *mut ErrorObject,
) -> Status {
    // SAFETY: by this function's contract.
    unsafe { enter(error, || fill(flower, fraction, (positions, positions_length), (normals, normals_length))) }
}

/// As `voxelastica_flower_fill_f32`, in double precision.
///
/// # Safety
/// As for `voxelastica_flower_fill_f32`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn voxelastica_flower_fill_f64(
    flower: *const FlowerObject,
    fraction: f64,
    positions: *mut f64,
    positions_length: usize,
    normals: *mut f64,
    normals_length: usize,
    error: *mut *mut ErrorObject,
) -> Status {
    // SAFETY: by this function's contract.
    unsafe { enter(error, || fill(flower, fraction, (positions, positions_length), (normals, normals_length))) }
}

/// Frees a flower. Null is allowed.
#[unsafe(no_mangle)]
pub extern "C" fn voxelastica_flower_free(flower: *mut FlowerObject) -> Status {
    value_or(Status::BadHandle, || release(flower).map(|()| Status::Ok))
}
