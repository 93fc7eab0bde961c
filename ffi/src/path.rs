//! `voxelastica_path`: forces and moments along the morph.

use std::ffi::c_void;

use voxelastica_core::Design;
use voxelastica_core::surface::Strip;

use crate::arguments::{Out, within};
use crate::array::ArrayF64;
use crate::boundary::{enter, value_or};
use crate::design::DesignObject;
use crate::error::ErrorObject;
use crate::failure::Failure;
use crate::mesh::strip;
use crate::progress::{ProgressCallback, Watch, with_callback};
use crate::registry::{Handle, find, keep, release};
use crate::status::Status;

/// A column of a path: one value a point, from flat to closed. Forces are those of one spoke in beam bending.
#[repr(i32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PathColumn {
    /// Fraction of the morph.
    Fraction = 0,
    /// Horizontal force, N; positive when the seat pushes the rim inward.
    Horizontal = 1,
    /// Vertical force, N; positive when the hub is pushed up.
    Vertical = 2,
    /// Moment at the rim, N mm.
    RimMoment = 3,
    /// Moment at the hub, N mm.
    HubMoment = 4,
    /// Horizontal distance of the hub from the rim, mm.
    Span = 5,
    /// Height of the hub above the rim, mm.
    Height = 6,
}

const COLUMNS: usize = 7;
/// Most points of a path.
const MOST_POINTS: usize = 100_000;

/// Forces, moments and the place of the hub at evenly spaced fractions of the morph. Immutable. A strip that is only
/// stretched has no such path and all its forces are 0.
pub struct Path {
    columns: [Vec<f64>; COLUMNS],
}

impl Handle for Path {
    const NAME: &'static str = "path";
}

impl Path {
    /// Follows the morph at `points` fractions from 0 to 1.
    ///
    /// # Errors
    /// [`Failure`] for too few or too many points, where the path could not be followed, or once cancelled.
    pub fn follow(design: &Design, strip: Strip, points: usize, watch: &Watch) -> Result<Self, Failure> {
        within("points", points, 2, MOST_POINTS)?;
        watch.set_total(points as u64);
        let mut columns: [Vec<f64>; COLUMNS] = std::array::from_fn(|_| Vec::with_capacity(points));
        let length = design.input().strips.length_mm;
        for i in 0..points {
            if !watch.report(i as u64) {
                return Err(voxelastica_core::Error::Cancelled.into());
            }
            let fraction = i as f64 / (points - 1) as f64;
            let row = match design.strip_shape(strip, fraction)? {
                Some(shape) => {
                    let end = |v: &[f64]| v.last().copied().unwrap_or(0.0);
                    let (x, z, f) = (end(&shape.x), end(&shape.z), shape.forces);
                    // A flat strip carries nothing; the limit of its thrust belongs to the first step.
                    let horizontal = if fraction == 0.0 { 0.0 } else { f.horizontal };
                    [fraction, horizontal, f.vertical, f.rim_moment, f.moment(x, z), x, z]
                }
                None => [fraction, 0.0, 0.0, 0.0, 0.0, length, 0.0],
            };
            columns.iter_mut().zip(row).for_each(|(column, value)| column.push(value));
        }
        Ok(Self { columns })
    }

    /// A column by its number.
    ///
    /// # Errors
    /// [`Failure`] for a number that is no column.
    pub fn column(&self, column: i32) -> Result<&[f64], Failure> {
        let found = usize::try_from(column).ok().and_then(|i| self.columns.get(i));
        found.map(Vec::as_slice).ok_or_else(|| Failure::range("column", column, "a voxelastica_path_column"))
    }
}

/// Follows the morph of the strip `strip` (a `voxelastica_strip_kind`) at `points` evenly spaced fractions from 0 to 1.
/// `progress` may be null. Free the path with `voxelastica_path_free`; the design may go before.
///
/// # Safety
/// `progress` may be called with `user` on this thread during the call; `path` and `error` are null or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn voxelastica_path_new(
    design: *const DesignObject,
    strip: i32,
    points: usize,
    progress: ProgressCallback,
    user: *mut c_void,
    path: *mut *mut Path,
    error: *mut *mut ErrorObject,
) -> Status {
    // SAFETY: by this function's contract.
    unsafe {
        enter(error, || {
            let (design, out) = (find(design)?, Out::new("path", path)?);
            let strip = self::strip(strip)?;
            let followed = with_callback(progress, user, |watch| Path::follow(&design.design, strip, points, watch))?;
            out.set(keep(followed));
            Ok(())
        })
    }
}

/// Lends a column of the path (a `voxelastica_path_column`), until the path is freed.
///
/// # Safety
/// `array` and `error` are null or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn voxelastica_path_column(
    path: *const Path,
    column: i32,
    array: *mut ArrayF64,
    error: *mut *mut ErrorObject,
) -> Status {
    // SAFETY: by this function's contract.
    unsafe {
        enter(error, || {
            let (path, out) = (find(path)?, Out::new("array", array)?);
            out.set(ArrayF64::column(path.column(column)?));
            Ok(())
        })
    }
}

/// Frees a path. Null is allowed.
#[unsafe(no_mangle)]
pub extern "C" fn voxelastica_path_free(path: *mut Path) -> Status {
    value_or(Status::BadHandle, || release(path).map(|()| Status::Ok))
}
