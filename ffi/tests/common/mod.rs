//! What the tests share: designs by the C functions.

#![allow(dead_code)]

use std::ffi::CStr;
use std::ptr;

use voxelastica::design::{DesignObject, voxelastica_design_compute};
use voxelastica::error::{ErrorObject, voxelastica_error_free, voxelastica_error_message};
use voxelastica::input::{Input, voxelastica_input_parse_toml};
use voxelastica::status::Status;

/// A dome of 80 slices of two layers.
pub const SMALL: &str = r#"
[target]
kind = "hemi-ellipsoid"
[strips]
count = 6
length_mm = 20.0
hub_radius_mm = 3.0
thickness_mm = 2.0
[materials]
phases = ["FLX9070", "FLX9095"]
[voxels]
size_mm = 1.0
"#;

pub fn parse(toml: &str) -> *mut Input {
    let (mut input, mut error) = (ptr::null_mut(), ptr::null_mut());
    // SAFETY: the text is as long as it says, the outputs are writable.
    let status = unsafe {
        let text = toml.as_ptr().cast();
        voxelastica_input_parse_toml(
            text,
            toml.len(),
            ptr::null(),
            0,
            ptr::null(),
            0,
            None,
            ptr::null_mut(),
            &raw mut input,
            &raw mut error,
        )
    };
    assert_eq!(status, Status::Ok, "{}", message(error));
    input
}

pub fn compute(input: *const Input) -> *mut DesignObject {
    let (mut design, mut error) = (ptr::null_mut(), ptr::null_mut());
    // SAFETY: the outputs are writable.
    let status =
        unsafe { voxelastica_design_compute(input, false, None, ptr::null_mut(), &raw mut design, &raw mut error) };
    assert_eq!(status, Status::Ok, "{}", message(error));
    design
}

/// Message of an error, which is freed.
pub fn message(error: *mut ErrorObject) -> String {
    let text = voxelastica_error_message(error);
    if text.is_null() {
        return "no error".to_owned();
    }
    // SAFETY: a text of a live error ends with a zero byte.
    let message = unsafe { CStr::from_ptr(text) }.to_string_lossy().into_owned();
    voxelastica_error_free(error);
    message
}
