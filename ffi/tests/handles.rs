//! Handles: threads, cancellation, panics, leaks. Run under AddressSanitizer and valgrind as well.

mod common;

use std::ffi::c_void;
use std::ptr;
use std::sync::Mutex;

use voxelastica::array::ArrayF64;
use voxelastica::boundary::run;
use voxelastica::design::*;
use voxelastica::error::*;
use voxelastica::flower::*;
use voxelastica::input::*;
use voxelastica::lists::voxelastica_live_objects;
use voxelastica::profile::voxelastica_design_profile;
use voxelastica::status::Status;

/// Tests that count live objects or memory run one after another.
static ALONE: Mutex<()> = Mutex::new(());

/// Few under a checker that is slow.
fn repeats(many: usize) -> usize {
    std::env::var("VOXELASTICA_REPEATS").ok().and_then(|text| text.parse().ok()).unwrap_or(many)
}

fn alone() -> std::sync::MutexGuard<'static, ()> {
    ALONE.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
}

/// Resident memory of this process in bytes, after what was freed was given back.
fn resident() -> u64 {
    let pages: u64 = std::fs::read_to_string("/proc/self/statm").unwrap().split(' ').nth(1).unwrap().parse().unwrap();
    pages * 4096
}

#[test]
fn ten_thousand_designs_leave_memory_where_it_was() {
    let _alone = alone();
    let live = voxelastica_live_objects();
    let text = common::SMALL.replace("size_mm = 1.0", "size_mm = 2.0");
    let cycle = |times: usize| {
        for _ in 0..times {
            let input = common::parse(&text);
            let design = common::compute(input);
            assert_eq!(voxelastica_input_free(input), Status::Ok);
            assert_eq!(voxelastica_design_free(design), Status::Ok);
        }
    };
    let many = repeats(10_000);
    cycle(many / 10);
    let before = resident();
    cycle(many);
    let after = resident();
    assert_eq!(voxelastica_live_objects(), live);
    println!("{many} designs: {before} bytes before, {after} after");
    if many >= 10_000 {
        assert!(after < before + (1 << 20), "{before} bytes before, {after} after");
    }
}

#[test]
fn one_design_is_read_by_several_threads_and_freed_by_another() {
    let _alone = alone();
    let input = common::parse(common::SMALL);
    let design = common::compute(input).addr();
    let input = input.addr();
    let sum = |fraction: f64| {
        let handle: *mut DesignObject = ptr::without_provenance_mut(design);
        let mut flower = ptr::null_mut();
        // SAFETY: outputs are writable, buffers as long as they say.
        unsafe {
            assert_eq!(voxelastica_flower_new(handle, 0, 20, 4, &raw mut flower, ptr::null_mut()), Status::Ok);
            let mut positions = vec![0.0_f64; 3 * voxelastica_flower_vertices(flower)];
            let (data, length) = (positions.as_mut_ptr(), positions.len());
            let status =
                voxelastica_flower_fill_f64(flower, fraction, data, length, ptr::null_mut(), 0, ptr::null_mut());
            assert_eq!(status, Status::Ok);
            assert_eq!(voxelastica_flower_free(flower), Status::Ok);
            positions.iter().map(|p| p.abs()).sum::<f64>()
        }
    };
    let expected: Vec<f64> = (0..repeats(10).min(10)).map(|i| sum(0.1 * i as f64)).collect();
    std::thread::scope(|scope| {
        for _ in 0..4 {
            scope.spawn(|| {
                for (i, wanted) in expected.iter().enumerate() {
                    assert_eq!(sum(0.1 * i as f64), *wanted);
                }
            });
        }
    });
    // A handle moves: freed elsewhere, and seen as freed here.
    let other = std::thread::spawn(move || {
        assert_eq!(voxelastica_input_free(ptr::without_provenance_mut(input)), Status::Ok);
        voxelastica_design_free(ptr::without_provenance_mut(design))
    });
    assert_eq!(other.join().unwrap(), Status::Ok);
    assert_eq!(voxelastica_design_free(ptr::without_provenance_mut(design)), Status::BadHandle);
}

#[test]
fn freeing_while_another_thread_calls_is_safe() {
    let _alone = alone();
    for _ in 0..repeats(20).min(20) {
        let design = common::compute(common::parse(common::SMALL)).addr();
        std::thread::scope(|scope| {
            scope.spawn(|| {
                let mut text = ptr::null_mut();
                // SAFETY: the output is writable.
                let status = unsafe {
                    voxelastica_design_summary(ptr::without_provenance(design), &raw mut text, ptr::null_mut())
                };
                assert!(matches!(status, Status::Ok | Status::BadHandle));
                voxelastica::text::voxelastica_text_free(text);
            });
            assert_eq!(voxelastica_design_free(ptr::without_provenance_mut(design)), Status::Ok);
        });
    }
}

unsafe extern "C" fn cancel_at_once(user: *mut c_void, _done: u64, _total: u64) -> bool {
    // SAFETY: the tests pass a count.
    unsafe { *user.cast::<u32>() += 1 };
    false
}

#[test]
fn a_large_computation_is_cancelled() {
    let _alone = alone();
    let text = common::SMALL
        .replace("length_mm = 20.0", "length_mm = 100.0")
        .replace("thickness_mm = 2.0", "thickness_mm = 20.0")
        .replace("size_mm = 1.0", "size_mm = 0.1");
    let input = common::parse(&text);
    let (mut design, mut error) = (ptr::null_mut(), ptr::null_mut());
    let mut told = 0_u32;
    let user = (&raw mut told).cast();
    // SAFETY: the callback gets what it expects, the outputs are writable.
    let status = unsafe {
        voxelastica_design_compute(input, false, Some(cancel_at_once), user, &raw mut design, &raw mut error)
    };
    assert_eq!(status, Status::Cancelled);
    assert!(design.is_null());
    assert!(common::message(error).starts_with("cancelled"));
    assert_eq!(told, 1);
    voxelastica_input_free(input);
}

#[test]
fn a_panic_is_an_internal_error() {
    let failure = run(|| -> Result<(), _> { panic!("number {}", 7) }).unwrap_err();
    assert_eq!(failure.code, Status::Internal);
    assert!(failure.message.contains("number 7") && failure.message.contains("report"), "{}", failure.message);
    let failure = run(|| -> Result<(), _> { std::panic::panic_any(7) }).unwrap_err();
    assert!(failure.message.contains("without a message"));
}

#[test]
fn arrays_are_lent_and_not_copied() {
    let design = common::compute(common::parse(common::SMALL));
    let lent = |column| {
        let mut array = ArrayF64 { data: ptr::null(), rows: 0, columns: 0, stride: 0 };
        // SAFETY: the output is writable.
        let status = unsafe { voxelastica_design_profile(design, column, &raw mut array, ptr::null_mut()) };
        assert_eq!(status, Status::Ok);
        array
    };
    assert_eq!(lent(5).data, lent(5).data);
    assert_ne!(lent(5).data, lent(6).data);
    assert_eq!(voxelastica_design_free(design), Status::Ok);
    // The handle says so, whatever became of its memory.
    let mut error = ptr::null_mut();
    let mut array = lent_nothing();
    // SAFETY: the outputs are writable.
    let status = unsafe { voxelastica_design_profile(design, 5, &raw mut array, &raw mut error) };
    assert_eq!((status, voxelastica_error_code(error)), (Status::BadHandle, Status::BadHandle));
    assert!(common::message(error).contains("was freed"));
}

fn lent_nothing() -> ArrayF64 {
    ArrayF64 { data: ptr::null(), rows: 0, columns: 0, stride: 0 }
}
