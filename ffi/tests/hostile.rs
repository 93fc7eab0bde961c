//! Drives every function of the header with what it must refuse: null, freed, foreign and made-up handles, texts that are
//! not UTF-8, wrong lengths. Each must return a code, say why, and leave its outputs alone.

mod common;

use std::collections::BTreeSet;
use std::ffi::c_char;
use std::ptr;

use voxelastica::conduct::*;
use voxelastica::design::*;
use voxelastica::error::*;
use voxelastica::fabricate::*;
use voxelastica::flower::*;
use voxelastica::input::*;
use voxelastica::lists::*;
use voxelastica::mesh::*;
use voxelastica::outputs::*;
use voxelastica::path::*;
use voxelastica::profile::*;
use voxelastica::status::Status;
use voxelastica::text::*;
use voxelastica::verify::*;
use voxelastica::voxels::*;

/// How a call is spoilt.
#[derive(Clone, Copy)]
struct Spoilt {
    /// The handle, whatever its type.
    handle: usize,
    /// Where outputs go: null, or the scratch memory.
    out: *mut u8,
    /// Every text.
    text: (*const c_char, usize),
    /// Buffers.
    buffer: (*mut u8, usize),
    error: *mut *mut ErrorObject,
}

/// A call that is expected to fail; `None` from those that return no status, after their plain value was looked at.
type Call = fn(Spoilt) -> Option<Status>;

fn handle<T>(spoilt: Spoilt) -> *mut T {
    ptr::without_provenance_mut(spoilt.handle)
}

macro_rules! calls {
    ($($name:ident($s:ident) $body:expr;)*) => {
        &[$((stringify!($name), |$s: Spoilt| {
            #[allow(unused_unsafe)]
            // SAFETY: pointers are null or scratch memory that is larger than any output; handles are only looked up.
            unsafe { $body }
        })),*]
    };
}

const CALLS: &[(&str, Call)] = calls! {
    voxelastica_error_code(s) { assert_eq!(voxelastica_error_code(handle(s)), Status::BadHandle); None };
    voxelastica_error_message(s) { assert!(voxelastica_error_message(handle(s)).is_null()); None };
    voxelastica_error_key(s) { assert!(voxelastica_error_key(handle(s)).is_null()); None };
    voxelastica_error_value(s) { assert!(voxelastica_error_value(handle(s)).is_null()); None };
    voxelastica_error_file(s) { assert!(voxelastica_error_file(handle(s)).is_null()); None };
    voxelastica_error_line(s) { assert_eq!(voxelastica_error_line(handle(s)), 0); None };
    voxelastica_error_free(s) freed(s, voxelastica_error_free(handle(s)));
    voxelastica_text_data(s) { assert!(voxelastica_text_data(handle(s)).is_null()); None };
    voxelastica_text_length(s) { assert_eq!(voxelastica_text_length(handle(s)), 0); None };
    voxelastica_text_free(s) freed(s, voxelastica_text_free(handle(s)));
    voxelastica_input_parse_toml(s) Some(voxelastica_input_parse_toml(
        s.text.0, s.text.1, s.text.0, s.text.1, s.text.0, s.text.1, None, ptr::null_mut(), s.out.cast(), s.error));
    voxelastica_input_parse_json(s) Some(voxelastica_input_parse_json(
        s.text.0, s.text.1, s.text.0, s.text.1, s.text.0, s.text.1, None, ptr::null_mut(), s.out.cast(), s.error));
    voxelastica_input_read(s) Some(voxelastica_input_read(s.text.0, s.text.1, None, ptr::null_mut(), s.out.cast(), s.error));
    voxelastica_input_validate(s) Some(voxelastica_input_validate(handle(s), s.error));
    voxelastica_input_json(s) Some(voxelastica_input_json(handle(s), s.out.cast(), s.error));
    voxelastica_input_hash(s) Some(voxelastica_input_hash(handle(s), s.out.cast(), s.error));
    voxelastica_input_free(s) freed(s, voxelastica_input_free(handle(s)));
    voxelastica_design_compute(s) Some(voxelastica_design_compute(
        handle(s), false, None, ptr::null_mut(), s.out.cast(), s.error));
    voxelastica_design_summary(s) Some(voxelastica_design_summary(handle(s), s.out.cast(), s.error));
    voxelastica_design_figure(s) Some(voxelastica_design_figure(
        handle(s), s.text.0, s.text.1, s.out.cast(), s.error));
    voxelastica_design_json(s) Some(voxelastica_design_json(handle(s), s.out.cast(), s.error));
    voxelastica_design_spokes(s) { assert_eq!(voxelastica_design_spokes(handle(s)), 0); None };
    voxelastica_design_warnings(s) { assert_eq!(voxelastica_design_warnings(handle(s)), 0); None };
    voxelastica_design_warning(s) { assert!(voxelastica_design_warning(handle(s), 0).is_null()); None };
    voxelastica_design_profile(s) Some(voxelastica_design_profile(handle(s), 0, s.out.cast(), s.error));
    voxelastica_design_outline(s) Some(voxelastica_design_outline(handle(s), s.out.cast(), s.error));
    voxelastica_design_slices(s) Some(voxelastica_design_slices(handle(s), 0, s.out.cast(), s.error));
    voxelastica_design_voxels(s) Some(voxelastica_design_voxels(handle(s), s.out.cast(), s.error));
    voxelastica_design_phases(s) { assert_eq!(voxelastica_design_phases(handle(s)), 0); None };
    voxelastica_design_phase_name(s) Some(voxelastica_design_phase_name(handle(s), 0, s.out.cast(), s.error));
    voxelastica_design_phase_voxels(s) Some(voxelastica_design_phase_voxels(handle(s), 0, s.out.cast(), s.error));
    voxelastica_design_phase_centres(s) Some(voxelastica_design_phase_centres(
        handle(s), 0, s.buffer.0.cast(), s.buffer.1, s.error));
    voxelastica_design_hub(s) Some(voxelastica_design_hub(
        handle(s), 0, 0.5, s.buffer.0.cast(), s.buffer.1, s.error));
    voxelastica_design_write(s) Some(voxelastica_design_write(
        handle(s), s.text.0, s.text.1, 255, false, None, ptr::null_mut(), s.out.cast(), s.error));
    voxelastica_design_verify(s) Some(voxelastica_design_verify(
        handle(s), 0, None, ptr::null_mut(), s.out.cast(), s.error));
    voxelastica_design_verify_ccx(s) Some(voxelastica_design_verify_ccx(
        handle(s), 0, s.text.0, s.text.1, s.text.0, s.text.1, None, ptr::null_mut(), s.out.cast(), s.error));
    voxelastica_design_refine(s) Some(voxelastica_design_refine(
        handle(s), 1, false, None, ptr::null_mut(), s.out.cast(), s.error));
    voxelastica_design_input(s) Some(voxelastica_design_input(handle(s), s.out.cast(), s.error));
    voxelastica_design_conduct(s) Some(voxelastica_design_conduct(
        handle(s), 0, 0, 0, 0, None, ptr::null_mut(), s.out.cast(), s.error));
    voxelastica_design_fabricate(s) Some(voxelastica_design_fabricate(
        handle(s), s.text.0, s.text.1, 0, false, None, ptr::null_mut(), s.out.cast(), s.error));
    voxelastica_design_free(s) freed(s, voxelastica_design_free(handle(s)));
    voxelastica_mesh_new(s) Some(voxelastica_mesh_new(handle(s), 0, 0.5, 0, 4, 4, s.out.cast(), s.error));
    voxelastica_mesh_positions(s) Some(voxelastica_mesh_positions(handle(s), s.out.cast(), s.error));
    voxelastica_mesh_normals(s) Some(voxelastica_mesh_normals(handle(s), s.out.cast(), s.error));
    voxelastica_mesh_modulus(s) Some(voxelastica_mesh_modulus(handle(s), s.out.cast(), s.error));
    voxelastica_mesh_quads(s) Some(voxelastica_mesh_quads(handle(s), s.out.cast(), s.error));
    voxelastica_mesh_free(s) freed(s, voxelastica_mesh_free(handle(s)));
    voxelastica_flower_new(s) Some(voxelastica_flower_new(handle(s), 0, 4, 4, s.out.cast(), s.error));
    voxelastica_flower_vertices(s) { assert_eq!(voxelastica_flower_vertices(handle(s)), 0); None };
    voxelastica_flower_quads(s) Some(voxelastica_flower_quads(handle(s), s.out.cast(), s.error));
    voxelastica_flower_modulus(s) Some(voxelastica_flower_modulus(handle(s), s.out.cast(), s.error));
    voxelastica_flower_fill_f32(s) Some(voxelastica_flower_fill_f32(
        handle(s), 0.5, s.buffer.0.cast(), s.buffer.1, ptr::null_mut(), 0, s.error));
    voxelastica_flower_fill_f64(s) Some(voxelastica_flower_fill_f64(
        handle(s), 0.5, s.buffer.0.cast(), s.buffer.1, ptr::null_mut(), 0, s.error));
    voxelastica_flower_free(s) freed(s, voxelastica_flower_free(handle(s)));
    voxelastica_path_new(s) Some(voxelastica_path_new(
        handle(s), 0, 3, None, ptr::null_mut(), s.out.cast(), s.error));
    voxelastica_path_column(s) Some(voxelastica_path_column(handle(s), 0, s.out.cast(), s.error));
    voxelastica_path_free(s) freed(s, voxelastica_path_free(handle(s)));
    voxelastica_materials_count(_s) { assert!(voxelastica_materials_count() > 0); None };
    voxelastica_materials_get(s) Some(voxelastica_materials_get(usize::MAX, s.out.cast(), s.error));
    voxelastica_materials_json(s) spoilt_out(s, |out, error| voxelastica_materials_json(out.cast(), error));
    voxelastica_parameters_count(_s) { assert!(voxelastica_parameters_count() > 0); None };
    voxelastica_parameters_get(s) Some(voxelastica_parameters_get(usize::MAX, s.out.cast(), s.error));
    voxelastica_parameters_json(s) spoilt_out(s, |out, error| voxelastica_parameters_json(out.cast(), error));
    voxelastica_parameters_schema(s) spoilt_out(s, |out, error| voxelastica_parameters_schema(out.cast(), error));
    voxelastica_version(_s) { assert!(!voxelastica_version().is_null()); None };
    voxelastica_abi_version(_s) { assert_eq!(voxelastica_abi_version(), ABI_VERSION); None };
    voxelastica_live_objects(_s) { let _ = voxelastica_live_objects(); None };
};

/// Freeing null is no mistake; anything else that is no handle is.
fn freed(s: Spoilt, status: Status) -> Option<Status> {
    assert_eq!(status, if s.handle == 0 { Status::Ok } else { Status::BadHandle });
    None
}

/// Of a call whose only argument is its output, only that can be wrong.
fn spoilt_out(s: Spoilt, call: impl Fn(*mut u8, *mut *mut ErrorObject) -> Status) -> Option<Status> {
    s.out.is_null().then(|| call(s.out, s.error))
}

#[test]
fn every_function_of_the_header_is_driven() {
    let header = include_str!("../include/voxelastica.h");
    let mut declared = BTreeSet::new();
    for line in header.lines().filter(|l| !l.trim_start().starts_with("//") && !l.trim_start().starts_with('*')) {
        if let Some(at) = line.find("voxelastica_")
            && let Some(end) = line[at..].find('(')
            && line[at..at + end].chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
        {
            declared.insert(&line[at..at + end]);
        }
        // `voxelastica_status voxelastica_...(`
        if let Some(rest) = line.split_whitespace().nth(1)
            && let Some(end) = rest.find('(')
        {
            declared.insert(rest[..end].trim_start_matches('*'));
        }
    }
    declared.retain(|name| name.starts_with("voxelastica_"));
    let driven: BTreeSet<&str> = CALLS.iter().map(|(name, _)| *name).collect();
    assert_eq!(declared, driven);
}

#[test]
fn wrong_arguments_are_codes_and_outputs_are_left_alone() {
    let design = common::compute(common::parse(common::SMALL));
    let gone = common::parse(common::SMALL);
    assert_eq!(voxelastica_input_free(gone), Status::Ok);
    let mut name = ptr::null_mut();
    // SAFETY: the output is writable.
    assert_eq!(unsafe { voxelastica_design_phase_name(design, 0, &raw mut name, ptr::null_mut()) }, Status::Ok);

    let mut scratch = [0xAB_u8; 1024];
    let out = scratch.as_mut_ptr();
    // SAFETY: within the array.
    let aligned = unsafe { out.add(out.align_offset(64)) };
    let bad_text = b"\xff\xfe\x00a".as_ptr().cast::<c_char>();
    let texts: [(*const c_char, usize); 3] = [(ptr::null(), 4), (bad_text, 4), (bad_text, usize::MAX)];
    let handles = [0, gone.addr(), name.addr(), 1, 63, 64 * 1_000_000, usize::MAX, aligned.addr()];
    let buffers: [(*mut u8, usize); 3] = [(ptr::null_mut(), 12), (aligned, 1), (aligned, usize::MAX)];
    let mut count = 0;
    for (function, call) in CALLS {
        for handle in handles {
            // A text is what some of these calls expect.
            if handle == name.addr() && function.starts_with("voxelastica_text") {
                continue;
            }
            for (text, buffer) in texts.into_iter().zip(buffers) {
                for out in [ptr::null_mut(), aligned] {
                    let mut error = ptr::null_mut();
                    let spoilt = Spoilt { handle, out, text, buffer, error: &raw mut error };
                    if let Some(status) = call(spoilt) {
                        assert_ne!(status, Status::Ok, "{function}");
                        assert_ne!(status, Status::Internal, "{function}");
                        assert_eq!(voxelastica_error_code(error), status, "{function}");
                        assert!(!common::message(error).is_empty(), "{function}");
                        // The same without an error's place.
                        assert_eq!(call(Spoilt { error: ptr::null_mut(), ..spoilt }), Some(status));
                    }
                    count += 1;
                }
            }
        }
    }
    assert!(scratch.iter().all(|byte| *byte == 0xAB));
    // A live design, but wrong buffers, texts and outputs.
    for (function, call) in CALLS.iter().filter(|(name, _)| name.starts_with("voxelastica_design_")) {
        if function.ends_with("_free")
            || ["spokes", "warnings", "warning", "phases"].iter().any(|n| function.ends_with(n))
        {
            continue;
        }
        for (text, buffer) in texts.into_iter().zip(buffers) {
            let mut error = ptr::null_mut();
            let spoilt = Spoilt { handle: design.addr(), out: ptr::null_mut(), text, buffer, error: &raw mut error };
            assert!(call(spoilt).is_none_or(|status| status != Status::Ok && status != Status::Internal), "{function}");
            voxelastica_error_free(error);
            count += 1;
        }
    }
    println!("{count} wrong calls");
    voxelastica_text_free(name);
    assert_eq!(voxelastica_design_free(design), Status::Ok);
}
