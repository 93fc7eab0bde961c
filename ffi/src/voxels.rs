//! The voxels of one spoke.

use voxelastica_core::Design;

use crate::arguments::{Out, buffer};
use crate::array::{ArraySize, ArrayU8};
use crate::boundary::{enter, value_or};
use crate::design::DesignObject;
use crate::error::ErrorObject;
use crate::failure::Failure;
use crate::registry::{find, keep};
use crate::status::Status;
use crate::text::Text;

/// The voxels of one flat spoke: slices from rim to hub, layers from the lower face up, voxels across the width.
///
/// Slice `i` is `2 half_widths[i]` voxels wide and centred on the spoke's axis; its voxel `(layer, across)` stands at
/// `phases[offsets[i] + layer * 2 half_widths[i] + across]`, `across = 0` at the most negative y. All arrays live until the
/// design is freed.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct Voxels {
    /// Voxel edge, mm.
    pub size_mm: f64,
    /// Number of slices.
    pub slices: usize,
    /// Number of layers.
    pub layers: usize,
    /// Number of phases.
    pub phase_count: usize,
    /// Phase of every voxel, from 0, softest first.
    pub phases: ArrayU8,
    /// Where every slice begins, and the total.
    pub offsets: ArraySize,
    /// Half-width of every slice in voxels.
    pub half_widths: ArraySize,
}

/// Centres of the voxels of one phase in the flat spoke, mm: x from the rim, y across, z from the mid-plane.
pub fn centres(design: &Design, phase: u8) -> impl Iterator<Item = [f64; 3]> + '_ {
    let grid = design.grid();
    let (size, layers) = (grid.size_mm(), grid.layers());
    grid.half_widths().iter().enumerate().flat_map(move |(i, &half)| {
        let x = (i as f64 + 0.5) * size;
        grid.slice(i).iter().enumerate().filter(move |(_, p)| **p == phase).map(move |(at, _)| {
            let (layer, across) = (at / (2 * half), at % (2 * half));
            let y = (across as f64 + 0.5 - half as f64) * size;
            [x, y, (layer as f64 + 0.5 - 0.5 * layers as f64) * size]
        })
    })
}

fn phase_index(design: &Design, phase: usize) -> Result<u8, Failure> {
    let count = design.phases().phases().len();
    u8::try_from(phase)
        .ok()
        .filter(|_| phase < count)
        .ok_or_else(|| Failure::range("phase", phase, &format!("below {count}, the number of phases")))
}

/// Number of voxels of a phase in one spoke.
///
/// # Errors
/// [`Failure`] for a phase that the design does not have.
pub fn phase_voxels(design: &Design, phase: usize) -> Result<usize, Failure> {
    phase_index(design, phase)?;
    let counts = design.grid().counts(design.phases().phases().len());
    Ok(counts[phase] as usize)
}

/// Lends the voxels of one spoke, until the design is freed.
///
/// # Safety
/// `voxels` and `error` are null or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn voxelastica_design_voxels(
    design: *const DesignObject,
    voxels: *mut Voxels,
    error: *mut *mut ErrorObject,
) -> Status {
    // SAFETY: by this function's contract.
    unsafe {
        enter(error, || {
            let (design, out) = (find(design)?, Out::new("voxels", voxels)?);
            let grid = design.design.grid();
            out.set(Voxels {
                size_mm: grid.size_mm(),
                slices: grid.slices(),
                layers: grid.layers(),
                phase_count: design.design.phases().phases().len(),
                phases: ArrayU8::column(grid.phases()),
                offsets: ArraySize::column(grid.offsets()),
                half_widths: ArraySize::column(grid.half_widths()),
            });
            Ok(())
        })
    }
}

/// Number of phases; 0 if this is not a design.
#[unsafe(no_mangle)]
pub extern "C" fn voxelastica_design_phases(design: *const DesignObject) -> usize {
    value_or(0, || Ok(find(design)?.design.phases().phases().len()))
}

/// Name of a phase, softest first, from 0 on.
///
/// # Safety
/// `name` and `error` are null or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn voxelastica_design_phase_name(
    design: *const DesignObject,
    phase: usize,
    name: *mut *mut Text,
    error: *mut *mut ErrorObject,
) -> Status {
    // SAFETY: by this function's contract.
    unsafe {
        enter(error, || {
            let (design, out) = (find(design)?, Out::new("name", name)?);
            let phase = usize::from(phase_index(&design.design, phase)?);
            out.set(keep(Text::new(&design.design.phases().phases()[phase].name)));
            Ok(())
        })
    }
}

/// Number of voxels of a phase in one spoke.
///
/// # Safety
/// `count` and `error` are null or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn voxelastica_design_phase_voxels(
    design: *const DesignObject,
    phase: usize,
    count: *mut usize,
    error: *mut *mut ErrorObject,
) -> Status {
    // SAFETY: by this function's contract.
    unsafe {
        enter(error, || {
            let (design, out) = (find(design)?, Out::new("count", count)?);
            out.set(phase_voxels(&design.design, phase)?);
            Ok(())
        })
    }
}

/// Writes the centres of a phase's voxels in the flat spoke, `x, y, z` each in mm, into a buffer of exactly three times
/// `voxelastica_design_phase_voxels` values: x from the rim, y across, z from the mid-plane.
///
/// # Safety
/// `centres` is null or writable for `length` values; `error` is null or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn voxelastica_design_phase_centres(
    design: *const DesignObject,
    phase: usize,
    centres: *mut f64,
    length: usize,
    error: *mut *mut ErrorObject,
) -> Status {
    // SAFETY: by this function's contract.
    unsafe {
        enter(error, || {
            let design = find(design)?;
            let index = phase_index(&design.design, phase)?;
            let places = buffer("centres", centres, length, 3 * phase_voxels(&design.design, phase)?)?;
            let (places, _) = places.as_chunks_mut::<3>();
            places.iter_mut().zip(self::centres(&design.design, index)).for_each(|(place, c)| *place = c);
            Ok(())
        })
    }
}
