//! Random sequences of calls of the native library, by its C functions: designs of random text, handles that are live,
//! freed, of another type or made up, lengths and indices at random. Nothing may crash, and nothing may stay behind.

use std::ffi::c_char;
use std::ptr;

use voxelastica::array::{ArrayF64, ArrayU32};
use voxelastica::conduct::*;
use voxelastica::design::*;
use voxelastica::error::*;
use voxelastica::fabricate::*;
use voxelastica::flower::*;
use voxelastica::input::*;
use voxelastica::lists::*;
use voxelastica::mesh::*;
use voxelastica::path::*;
use voxelastica::profile::*;
use voxelastica::status::Status;
use voxelastica::text::*;
use voxelastica::verify::*;
use voxelastica::voxels::*;

/// Calls of one sequence.
const MOST_CALLS: usize = 40;
const SMALL: &str = "[target]\nkind = \"hemi-ellipsoid\"\naspect_ratio = 1.0\n[strips]\ncount = 6\nlength_mm = 20.0\n\
    hub_radius_mm = 3.0\nthickness_mm = 2.0\n[materials]\nphases = [\"FLX9070\", \"FLX9095\"]\n[voxels]\nsize_mm = 1.0\n";

/// What decides: the input, byte by byte.
struct Dice<'a>(&'a [u8]);

impl<'a> Dice<'a> {
    fn byte(&mut self) -> Option<u8> {
        let (first, rest) = self.0.split_first()?;
        self.0 = rest;
        Some(*first)
    }

    fn number(&mut self) -> usize {
        match self.byte() {
            Some(255) => usize::MAX,
            Some(254) => usize::MAX / 2,
            byte => usize::from(byte.unwrap_or(0)) % 40,
        }
    }

    fn fraction(&mut self) -> f64 {
        match self.byte() {
            Some(255) => f64::NAN,
            Some(254) => f64::INFINITY,
            byte => f64::from(byte.unwrap_or(0)) / 240.0,
        }
    }

    fn text(&mut self) -> &'a [u8] {
        let length = self.number().min(self.0.len());
        let (text, rest) = self.0.split_at(length);
        self.0 = rest;
        text
    }
}

/// All handles that were ever given out here, and some that were not.
struct Handles(Vec<usize>);

impl Handles {
    fn any<T>(&self, dice: &mut Dice<'_>) -> *mut T {
        let index = usize::from(dice.byte().unwrap_or(0));
        ptr::without_provenance_mut(self.0[index % self.0.len()])
    }

    fn keep<T>(&mut self, handle: *mut T) {
        if !handle.is_null() {
            self.0.push(handle.addr());
        }
    }
}

/// A design text: the small one with one line spoilt, or bytes as they come.
fn design_text(dice: &mut Dice<'_>) -> Vec<u8> {
    let spoilt = dice.byte().unwrap_or(0);
    match spoilt {
        0..=127 => SMALL.as_bytes().to_vec(),
        128..=220 => {
            let mut lines: Vec<&[u8]> = SMALL.as_bytes().split(|b| *b == b'\n').collect();
            let line = dice.text();
            let place = usize::from(spoilt) % lines.len();
            lines[place] = line;
            lines.join(&b'\n')
        }
        _ => dice.text().to_vec(),
    }
}

/// One sequence.
pub fn calls(data: &[u8]) {
    let before = voxelastica_live_objects();
    let mut dice = Dice(data);
    let mut handles = Handles(vec![0, 1, 64 * 1_000_000_000, usize::MAX]);
    for _ in 0..MOST_CALLS {
        let Some(kind) = dice.byte() else { break };
        step(kind, &mut dice, &mut handles);
    }
    for handle in handles.0 {
        voxelastica_input_free(ptr::without_provenance_mut(handle));
        voxelastica_design_free(ptr::without_provenance_mut(handle));
        voxelastica_mesh_free(ptr::without_provenance_mut(handle));
        voxelastica_flower_free(ptr::without_provenance_mut(handle));
        voxelastica_path_free(ptr::without_provenance_mut(handle));
        voxelastica_text_free(ptr::without_provenance_mut(handle));
    }
    assert_eq!(voxelastica_live_objects(), before);
}

fn step(kind: u8, dice: &mut Dice<'_>, handles: &mut Handles) {
    let mut error = ptr::null_mut();
    let e = &raw mut error;
    // SAFETY: outputs are writable, texts and buffers as long as they say; handles are only looked up.
    let status = unsafe {
        match kind % 24 {
            0 | 1 => {
                let text = design_text(dice);
                let (data, length) = (text.as_ptr().cast::<c_char>(), text.len());
                let mut input = ptr::null_mut();
                let parse = if kind < 128 { voxelastica_input_parse_toml } else { voxelastica_input_parse_json };
                let folder = b"/nonexistent";
                let (folder, most) = ((folder.as_ptr().cast(), folder.len()), length.min(3));
                let (none, user) = (None, ptr::null_mut());
                let status = parse(data, length, data, most, folder.0, folder.1, none, user, &raw mut input, e);
                handles.keep(input);
                status
            }
            2 | 3 => {
                let mut design = ptr::null_mut();
                let input = handles.any(dice);
                // Only what is small is computed.
                if !small(input) {
                    return;
                }
                let status = voxelastica_design_compute(input, false, None, ptr::null_mut(), &raw mut design, e);
                handles.keep(design);
                status
            }
            4 => voxelastica_input_free(handles.any(dice)),
            5 => voxelastica_design_free(handles.any(dice)),
            6 => {
                let mut text = ptr::null_mut();
                let status = voxelastica_design_summary(handles.any(dice), &raw mut text, e);
                handles.keep(text);
                let _ = voxelastica_text_length(text);
                status
            }
            7 => {
                let (mut value, name) = (0.0, dice.text());
                voxelastica_design_figure(handles.any(dice), name.as_ptr().cast(), name.len(), &raw mut value, e)
            }
            8 => sum(|array| voxelastica_design_profile(handles.any(dice), dice.number() as i32, array, e)),
            9 => sum(|array| voxelastica_design_slices(handles.any(dice), dice.number() as i32, array, e)),
            10 => sum(|array| voxelastica_design_outline(handles.any(dice), array, e)),
            11 => {
                let mut buffer = vec![0.0; dice.number().min(100_000)];
                let phase = dice.number();
                voxelastica_design_phase_centres(handles.any(dice), phase, buffer.as_mut_ptr(), buffer.len(), e)
            }
            12 => {
                let mut mesh = ptr::null_mut();
                let (strip, fraction, spoke) = (dice.number() as i32 % 3, dice.fraction(), dice.number());
                let (along, across) = (dice.number(), dice.number());
                let status =
                    voxelastica_mesh_new(handles.any(dice), strip, fraction, spoke, along, across, &raw mut mesh, e);
                handles.keep(mesh);
                status
            }
            13 => sum(|array| voxelastica_mesh_positions(handles.any(dice), array, e)),
            14 => {
                let mut array = ArrayU32 { data: ptr::null(), rows: 0, columns: 0, stride: 0 };
                voxelastica_mesh_quads(handles.any(dice), &raw mut array, e)
            }
            15 => {
                let mut flower = ptr::null_mut();
                let (along, across) = (dice.number(), dice.number());
                let status = voxelastica_flower_new(handles.any(dice), 0, along, across, &raw mut flower, e);
                handles.keep(flower);
                status
            }
            16 => {
                let flower = handles.any(dice);
                let right = 3 * voxelastica_flower_vertices(flower);
                let mut buffer = vec![0.0_f32; if dice.number() > 3 { right } else { dice.number().min(1000) }];
                let fraction = dice.fraction();
                let (data, length) = (buffer.as_mut_ptr(), buffer.len());
                voxelastica_flower_fill_f32(flower, fraction, data, length, ptr::null_mut(), 0, e)
            }
            17 => {
                let mut path = ptr::null_mut();
                let points = dice.number();
                let status =
                    voxelastica_path_new(handles.any(dice), 0, points, None, ptr::null_mut(), &raw mut path, e);
                handles.keep(path);
                status
            }
            18 => sum(|array| voxelastica_path_column(handles.any(dice), dice.number() as i32, array, e)),
            19 => {
                let (mut text, design, model) = (ptr::null_mut(), handles.any(dice), dice.number() as i32 % 3);
                if !solvable(design) {
                    return;
                }
                let status = voxelastica_design_verify(design, model, None, ptr::null_mut(), &raw mut text, e);
                handles.keep(text);
                status
            }
            20 => {
                let (mut refined, design, most) = (ptr::null_mut(), handles.any(dice), dice.number());
                if !solvable(design) {
                    return;
                }
                let (most, user) = (if most > 2 { 0 } else { most }, ptr::null_mut());
                let status = voxelastica_design_refine(design, most, false, None, user, &raw mut refined, e);
                handles.keep(refined);
                status
            }
            21 => {
                let (mut text, design, user) = (ptr::null_mut(), handles.any(dice), ptr::null_mut());
                if !solvable(design) {
                    return;
                }
                let mut choice = || dice.number() as i32 % 4;
                let (flow, model, shape, regime) = (choice(), choice(), choice(), choice());
                let status =
                    voxelastica_design_conduct(design, flow, model, shape, regime, None, user, &raw mut text, e);
                handles.keep(text);
                status
            }
            22 => {
                // Nothing can be written there.
                let (folder, mut text, user) = (b"/dev/null/folder", ptr::null_mut(), ptr::null_mut());
                let (design, kinds) = (handles.any(dice), dice.number() as u32);
                let (data, length) = (folder.as_ptr().cast(), folder.len());
                voxelastica_design_fabricate(design, data, length, kinds, false, None, user, &raw mut text, e)
            }
            _ => {
                let freed: [Status; 4] = [
                    voxelastica_mesh_free(handles.any(dice)),
                    voxelastica_flower_free(handles.any(dice)),
                    voxelastica_path_free(handles.any(dice)),
                    voxelastica_text_free(handles.any(dice)),
                ];
                freed[0]
            }
        }
    };
    assert_ne!(status, Status::Internal, "a panic");
    if status != Status::Ok && !error.is_null() {
        assert_eq!(voxelastica_error_code(error), status);
        assert!(!voxelastica_error_message(error).is_null());
    }
    voxelastica_error_free(error);
}

/// Reads every value that was lent, so that a checker of memory sees it.
fn sum(lend: impl FnOnce(*mut ArrayF64) -> Status) -> Status {
    let mut array = ArrayF64 { data: ptr::null(), rows: 0, columns: 0, stride: 0 };
    let status = lend(&raw mut array);
    let mut total = 0.0;
    for row in 0..array.rows {
        for column in 0..array.columns {
            // SAFETY: what was lent is live, since nothing was freed in between.
            total += unsafe { array.data.byte_add(row * array.stride).add(column).read() };
        }
    }
    std::hint::black_box(total);
    status
}

/// Whether a design, or what is none, is small enough to be solved many times.
fn solvable(design: *const DesignObject) -> bool {
    let (mut voxels, name) = (0.0, "voxels_per_spoke");
    // SAFETY: the output is writable.
    unsafe {
        voxelastica_design_figure(design, name.as_ptr().cast(), name.len(), &raw mut voxels, ptr::null_mut());
    }
    voxels < 1000.0
}

/// Whether an input is small enough to be computed thousands of times.
fn small(input: *const Input) -> bool {
    let mut text = ptr::null_mut();
    // SAFETY: the output is writable.
    if unsafe { voxelastica_input_json(input, &raw mut text, ptr::null_mut()) } != Status::Ok {
        return true;
    }
    // SAFETY: a text is as long as it says.
    let json = unsafe {
        std::slice::from_raw_parts(voxelastica_text_data(text).cast::<u8>(), voxelastica_text_length(text)).to_vec()
    };
    voxelastica_text_free(text);
    let value: serde_json::Value = serde_json::from_slice(&json).unwrap_or_default();
    let number = |table: &str, key: &str| value[table][key].as_f64().unwrap_or(1.0);
    let longest = number("strips", "length_mm").max(number("strips", "hub_radius_mm"));
    let area = 7.0 * longest.max(number("target", "width_mm"));
    number("strips", "length_mm") * number("strips", "thickness_mm") * area / number("voxels", "size_mm").powi(3) < 1e5
}
