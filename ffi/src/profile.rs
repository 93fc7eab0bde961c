//! What a design lends: the profile, the flat outline and the table of slices.

use voxelastica_core::Design;
use voxelastica_core::voxel::Slice;

use crate::arguments::Out;
use crate::array::ArrayF64;
use crate::boundary::enter;
use crate::design::DesignObject;
use crate::error::ErrorObject;
use crate::failure::Failure;
use crate::registry::find;
use crate::status::Status;

/// A column of the profile: one value a station, evenly spaced, rim first.
#[repr(i32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ProfileColumn {
    /// Arc length from the rim, mm.
    S = 0,
    /// Inclination, rad.
    Inclination = 1,
    /// Horizontal distance from the rim, mm.
    X = 2,
    /// Height above the rim, mm.
    Z = 3,
    /// Distance from the dome's axis in the morphed state, mm.
    Rho = 4,
    /// Full width, mm.
    Width = 5,
    /// Modulus over its largest value.
    ModulusRatio = 6,
    /// Modulus, MPa.
    Modulus = 7,
    /// Fraction of the stiffest phase.
    RigidFraction = 8,
}

/// A column of the table of voxel slices: one value a slice, rim first.
#[repr(i32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SliceColumn {
    /// Arc length of the slice's centre, mm.
    S = 0,
    /// Modulus the slice should have, MPa.
    ModulusTarget = 1,
    /// Modulus of its voxels, MPa.
    Modulus = 2,
    /// Bending stiffness it should have, N mm^2.
    StiffnessTarget = 3,
    /// Bending stiffness of its voxels about their own neutral axis, N mm^2.
    Stiffness = 4,
    /// Height of that axis above the mid-plane, mm.
    NeutralOffset = 5,
}

/// A column of the profile by its number.
///
/// # Errors
/// [`Failure`] for a number that is no column.
pub fn profile_column(design: &Design, column: i32) -> Result<&[f64], Failure> {
    let p = design.profile();
    let columns: [&[f64]; 9] =
        [&p.s, &p.inclination, &p.x, &p.z, &p.rho, &p.width, &p.modulus_ratio, &p.modulus_mpa, &p.rigid_fraction];
    let found = usize::try_from(column).ok().and_then(|i| columns.get(i).copied());
    found.ok_or_else(|| Failure::range("column", column, "a voxelastica_profile_column"))
}

/// Lends a column of the profile (a `voxelastica_profile_column`), until the design is freed.
///
/// # Safety
/// `array` and `error` are null or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn voxelastica_design_profile(
    design: *const DesignObject,
    column: i32,
    array: *mut ArrayF64,
    error: *mut *mut ErrorObject,
) -> Status {
    // SAFETY: by this function's contract.
    unsafe {
        enter(error, || {
            let (design, out) = (find(design)?, Out::new("array", array)?);
            out.set(ArrayF64::column(profile_column(&design.design, column)?));
            Ok(())
        })
    }
}

/// Lends the outline of the flat spoke, `x, y` a row in mm, x from the rim: up one edge and back along the other. It
/// lives until the design is freed.
///
/// # Safety
/// `array` and `error` are null or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn voxelastica_design_outline(
    design: *const DesignObject,
    array: *mut ArrayF64,
    error: *mut *mut ErrorObject,
) -> Status {
    // SAFETY: by this function's contract.
    unsafe {
        enter(error, || {
            let (design, out) = (find(design)?, Out::new("array", array)?);
            out.set(ArrayF64::table(design.outline.get_or_init(|| design.design.profile().flat_outline())));
            Ok(())
        })
    }
}

/// Lends a column of the table of slices (a `voxelastica_slice_column`), until the design is freed. Its stride is that of
/// the table.
///
/// # Safety
/// `array` and `error` are null or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn voxelastica_design_slices(
    design: *const DesignObject,
    column: i32,
    array: *mut ArrayF64,
    error: *mut *mut ErrorObject,
) -> Status {
    // SAFETY: by this function's contract.
    unsafe {
        enter(error, || {
            let (design, out) = (find(design)?, Out::new("array", array)?);
            let field: fn(&Slice) -> &f64 = match column {
                0 => |s| &s.s_mm,
                1 => |s| &s.modulus_target_mpa,
                2 => |s| &s.modulus_mpa,
                3 => |s| &s.stiffness_target_nmm2,
                4 => |s| &s.section.stiffness,
                5 => |s| &s.section.neutral_offset,
                _ => return Err(Failure::range("column", column, "a voxelastica_slice_column")),
            };
            let slices = design.design.slices();
            let data = slices.first().map_or(std::ptr::null(), |first| std::ptr::from_ref(field(first)));
            out.set(ArrayF64 { data, rows: slices.len(), columns: 1, stride: size_of::<Slice>() });
            Ok(())
        })
    }
}
