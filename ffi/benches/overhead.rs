//! What the C ABI costs: the same design by Rust and by C functions in turn, so that both see the same machine. Prints
//! the medians in seconds as JSON; `scripts/benchmarks` shows them.

use std::ffi::c_void;
use std::path::Path;
use std::ptr;
use std::time::Instant;

use voxelastica::design::{voxelastica_design_compute, voxelastica_design_free};
use voxelastica::input::{voxelastica_input_free, voxelastica_input_parse_toml};
use voxelastica_core::input::files::Format;
use voxelastica_core::{Design, DesignInput, Limits};

const TOML: &str = include_str!("../../examples/hemisphere.toml");
const PAIRS: usize = 400;

fn by_rust() {
    let input = DesignInput::from_text(TOML, Format::Toml, "hemisphere", "hemisphere", Path::new("")).expect("right");
    std::hint::black_box(Design::compute(&input, Limits::default()).expect("feasible"));
}

fn by_c() {
    let (mut input, mut design) = (ptr::null_mut(), ptr::null_mut());
    let (text, length, name) = (TOML.as_ptr().cast(), TOML.len(), b"hemisphere".as_ptr().cast());
    // SAFETY: texts are as long as they say, outputs are writable.
    unsafe {
        voxelastica_input_parse_toml(
            text,
            length,
            name,
            10,
            ptr::null(),
            0,
            None,
            ptr::null_mut(),
            &raw mut input,
            ptr::null_mut(),
        );
        voxelastica_design_compute(input, false, None, ptr::null_mut(), &raw mut design, ptr::null_mut());
    }
    voxelastica_input_free(input);
    voxelastica_design_free(design);
}

unsafe extern "C" fn note(user: *mut c_void, _done: u64, _total: u64) -> bool {
    // SAFETY: `cancelled` passes an instant.
    unsafe { (*user.cast::<Option<Instant>>()).get_or_insert_with(Instant::now) };
    false
}

/// Seconds from the wish to cancel until the call returns, for a design of eight million voxels.
fn cancelled() -> f64 {
    let text = TOML.replace("size_mm = 0.5", "size_mm = 0.1").replace("thickness_mm = 2.0", "thickness_mm = 20.0");
    let (mut input, mut design) = (ptr::null_mut(), ptr::null_mut());
    let mut wish: Option<Instant> = None;
    let (nobody, none) = (ptr::null_mut(), ptr::null_mut());
    // SAFETY: texts are as long as they say, outputs are writable, the callback gets what it expects.
    unsafe {
        let text = (text.as_ptr().cast(), text.len());
        voxelastica_input_parse_toml(
            text.0,
            text.1,
            ptr::null(),
            0,
            ptr::null(),
            0,
            None,
            nobody,
            &raw mut input,
            none,
        );
        voxelastica_design_compute(input, true, Some(note), (&raw mut wish).cast(), &raw mut design, none);
    }
    let late = wish.map_or(0.0, |wish| wish.elapsed().as_secs_f64());
    voxelastica_input_free(input);
    voxelastica_design_free(design);
    late
}

fn seconds(work: fn()) -> f64 {
    let start = Instant::now();
    work();
    start.elapsed().as_secs_f64()
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

fn main() {
    // `cargo bench --no-run` builds this; `cargo test --benches` shall not measure.
    if !std::env::args().any(|a| a == "--bench") {
        return;
    }
    (0..20).for_each(|_| {
        by_rust();
        by_c();
    });
    let pairs: Vec<(f64, f64)> = (0..PAIRS)
        .map(|i| {
            // Whoever comes first has the colder caches.
            if i % 2 == 0 {
                let rust = seconds(by_rust);
                (rust, seconds(by_c))
            } else {
                let c = seconds(by_c);
                (seconds(by_rust), c)
            }
        })
        .collect();
    let rust = median(pairs.iter().map(|p| p.0).collect());
    let c = median(pairs.iter().map(|p| p.1).collect());
    let ratio = median(pairs.iter().map(|p| p.1 / p.0).collect());
    let late = median((0..9).map(|_| cancelled()).collect());
    println!("{{\"rust\": {rust:.9}, \"c\": {c:.9}, \"ratio\": {ratio:.6}, \"cancel\": {late:.6}}}");
}
