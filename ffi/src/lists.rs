//! Lists from which hosts build their forms: materials and the keys of the design file.

use std::ffi::{CString, c_char};
use std::ptr;
use std::sync::LazyLock;

use voxelastica_core::input::parameters::{PARAMETERS, Parameter};
use voxelastica_core::input::schema::json_schema;
use voxelastica_core::materials::{Material, library};

use crate::arguments::Out;
use crate::boundary::{enter, value_or};
use crate::error::{ErrorObject, c_text};
use crate::failure::Failure;
use crate::input::to_json;
use crate::registry::keep;
use crate::status::Status;
use crate::text::Text;

/// A material of the library. What is not known is NaN. Its name lives as long as the library is loaded.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct MaterialRecord {
    /// Name, as used in `materials.phases`.
    pub name: *const c_char,
    /// Young's modulus, MPa.
    pub modulus_mpa: f64,
    /// Poisson's ratio.
    pub poisson: f64,
    /// Density, kg/m^3.
    pub density_kg_m3: f64,
    /// Thermal conductivity, W/(m K).
    pub conductivity_w_mk: f64,
    /// Specific heat, J/(kg K).
    pub specific_heat_j_kgk: f64,
    /// Electrical conductivity, S/m.
    pub electrical_conductivity_s_m: f64,
    /// Permittivity over that of the vacuum.
    pub relative_permittivity: f64,
    /// Largest principal strain the material stands.
    pub max_strain: f64,
}

/// A key of the design file. Its texts live as long as the library is loaded; those it does not have are empty.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ParameterRecord {
    /// Dotted key, such as `voxels.size_mm`.
    pub key: *const c_char,
    /// Type and range as JSON: `{"type": "number", "least": 0, "exclusive": true, "most": 10000}`, `{"type": "choice",
    /// "choices": [...]}` and so on.
    pub range: *const c_char,
    /// Unit.
    pub unit: *const c_char,
    /// Default as JSON.
    pub default_value: *const c_char,
    /// Kinds of targets it applies to, as a JSON list; an empty list means all.
    pub targets: *const c_char,
    /// What it means.
    pub description: *const c_char,
    /// Whether it must be given.
    pub required: bool,
}

static MATERIALS: LazyLock<Vec<(CString, Material)>> =
    LazyLock::new(|| library().into_iter().map(|m| (c_text(&m.name), m)).collect());

struct ParameterTexts([CString; 6], bool);

static PARAMETER_TEXTS: LazyLock<Vec<ParameterTexts>> = LazyLock::new(|| PARAMETERS.iter().map(texts).collect());

fn texts(parameter: &Parameter) -> ParameterTexts {
    let json = |value: Result<String, serde_json::Error>| c_text(&value.unwrap_or_default());
    let texts = [
        c_text(parameter.key),
        json(serde_json::to_string(&parameter.kind)),
        c_text(parameter.unit.unwrap_or("")),
        c_text(parameter.default.unwrap_or("")),
        json(serde_json::to_string(parameter.targets)),
        c_text(parameter.description),
    ];
    ParameterTexts(texts, parameter.required)
}

/// The library's materials as JSON.
///
/// # Errors
/// [`Failure`] where they cannot be represented.
pub fn materials_json() -> Result<String, Failure> {
    to_json(&library())
}

/// The table of parameters as JSON.
///
/// # Errors
/// [`Failure`] where it cannot be represented.
pub fn parameters_json() -> Result<String, Failure> {
    to_json(&PARAMETERS)
}

/// Number of materials in the library.
#[unsafe(no_mangle)]
pub extern "C" fn voxelastica_materials_count() -> usize {
    value_or(0, || Ok(MATERIALS.len()))
}

/// A material of the library, from 0 on.
///
/// # Safety
/// `material` and `error` are null or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn voxelastica_materials_get(
    index: usize,
    material: *mut MaterialRecord,
    error: *mut *mut ErrorObject,
) -> Status {
    // SAFETY: by this function's contract.
    unsafe {
        enter(error, || {
            let out = Out::new("material", material)?;
            let known = |value: Option<f64>| value.unwrap_or(f64::NAN);
            let (name, m) = MATERIALS.get(index).ok_or_else(|| beyond(index, MATERIALS.len()))?;
            out.set(MaterialRecord {
                name: name.as_ptr(),
                modulus_mpa: m.modulus_mpa,
                poisson: m.poisson,
                density_kg_m3: known(m.density_kg_m3),
                conductivity_w_mk: known(m.conductivity_w_mk),
                specific_heat_j_kgk: known(m.specific_heat_j_kgk),
                electrical_conductivity_s_m: known(m.electrical_conductivity_s_m),
                relative_permittivity: known(m.relative_permittivity),
                max_strain: known(m.max_strain),
            });
            Ok(())
        })
    }
}

/// The library's materials as JSON.
///
/// # Safety
/// `json` and `error` are null or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn voxelastica_materials_json(json: *mut *mut Text, error: *mut *mut ErrorObject) -> Status {
    // SAFETY: by this function's contract.
    unsafe {
        enter(error, || {
            Out::new("json", json)?.set(keep(Text::new(&materials_json()?)));
            Ok(())
        })
    }
}

/// Number of keys of the design file.
#[unsafe(no_mangle)]
pub extern "C" fn voxelastica_parameters_count() -> usize {
    PARAMETERS.len()
}

/// A key of the design file, from 0 on, in the order of the file.
///
/// # Safety
/// `parameter` and `error` are null or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn voxelastica_parameters_get(
    index: usize,
    parameter: *mut ParameterRecord,
    error: *mut *mut ErrorObject,
) -> Status {
    // SAFETY: by this function's contract.
    unsafe {
        enter(error, || {
            let out = Out::new("parameter", parameter)?;
            let found = PARAMETER_TEXTS.get(index).ok_or_else(|| beyond(index, PARAMETERS.len()))?;
            let [key, range, unit, default_value, targets, description] = found.0.each_ref().map(|t| t.as_ptr());
            let required = found.1;
            out.set(ParameterRecord { key, range, unit, default_value, targets, description, required });
            Ok(())
        })
    }
}

/// All keys of the design file as JSON: key, type, range, unit, default, description.
///
/// # Safety
/// `json` and `error` are null or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn voxelastica_parameters_json(json: *mut *mut Text, error: *mut *mut ErrorObject) -> Status {
    // SAFETY: by this function's contract.
    unsafe {
        enter(error, || {
            Out::new("json", json)?.set(keep(Text::new(&parameters_json()?)));
            Ok(())
        })
    }
}

/// The JSON Schema of the design file.
///
/// # Safety
/// `json` and `error` are null or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn voxelastica_parameters_schema(json: *mut *mut Text, error: *mut *mut ErrorObject) -> Status {
    // SAFETY: by this function's contract.
    unsafe {
        enter(error, || {
            Out::new("json", json)?.set(keep(Text::new(&to_json(&json_schema())?)));
            Ok(())
        })
    }
}

fn beyond(index: usize, count: usize) -> Failure {
    Failure::range("index", index, &format!("below {count}"))
}

/// Version of the library, such as `0.1.0`; it lives as long as the library is loaded.
#[unsafe(no_mangle)]
pub extern "C" fn voxelastica_version() -> *const c_char {
    static VERSION: LazyLock<CString> = LazyLock::new(|| c_text(env!("CARGO_PKG_VERSION")));
    value_or(ptr::null(), || Ok(VERSION.as_ptr()))
}

/// Version of this interface, `VOXELASTICA_ABI_VERSION` of the header that fits. It rises with every change that breaks
/// a compiled host.
#[unsafe(no_mangle)]
pub extern "C" fn voxelastica_abi_version() -> u32 {
    ABI_VERSION
}

/// Version of the interface that this header describes.
pub const ABI_VERSION: u32 = 3;

/// Number of objects that callers hold at present: to find leaks.
#[unsafe(no_mangle)]
pub extern "C" fn voxelastica_live_objects() -> usize {
    value_or(0, || Ok(crate::registry::count()))
}
