//! How long work goes on before it asks again whether to stop: the longest gap of every kind of long work, one line each.
//!
//! One factorisation of the tangent counts as one gap: it cannot be stopped on its way.

use std::path::Path;
use std::sync::Mutex;
use std::time::{Duration, Instant};

use voxelastica_core::conduction::case::{Problem, Regimes, solve};
use voxelastica_core::conduction::pcg::Watch;
use voxelastica_core::conduction::strip::{Model, Shape, Strip};
use voxelastica_core::fabrication::fabricate;
use voxelastica_core::input::FabricationKind;
use voxelastica_core::input::files::Format;
use voxelastica_core::output::write::{WriteOptions, write_design};
use voxelastica_core::results::{EmbeddedOptions, verify_embedded};
use voxelastica_core::{Design, DesignInput, Limits};

/// The longest gaps that are shown.
const SHOWN: usize = 4;

/// Listens to the questions of some work.
struct Clock {
    heard: Mutex<Heard>,
}

struct Heard {
    last: Instant,
    /// The longest gaps and what was told after them.
    longest: Vec<(Duration, f64)>,
    questions: u64,
}

impl Clock {
    fn new() -> Self {
        Self { heard: Mutex::new(Heard { last: Instant::now(), longest: Vec::new(), questions: 0 }) }
    }

    fn ask(&self, told: f64) -> bool {
        if let Ok(mut heard) = self.heard.lock() {
            let gap = heard.last.elapsed();
            let place = heard.longest.partition_point(|(longer, _)| *longer >= gap);
            heard.longest.insert(place, (gap, told));
            heard.longest.truncate(SHOWN);
            (heard.last, heard.questions) = (Instant::now(), heard.questions + 1);
        }
        true
    }

    fn report(&self, what: &str, start: Instant) {
        self.ask(1.0);
        if let Ok(heard) = self.heard.lock() {
            let gaps = heard.longest.iter().map(|(gap, told)| format!("{:.0} (at {told:.3})", 1e3 * gap.as_secs_f64()));
            let gaps = gaps.collect::<Vec<_>>().join(", ");
            println!(
                "{what:<44}{:>8.2} s {:>7} questions; longest gaps, ms: {gaps}",
                start.elapsed().as_secs_f64(),
                heard.questions
            );
        }
    }
}

fn input(length: f64, size: f64, more: &str) -> DesignInput {
    let text = format!(
        "[target]\nkind = \"hemi-ellipsoid\"\n[strips]\ncount = 8\nlength_mm = {length:?}\nhub_radius_mm = {:?}\nthickness_mm \
         = 2.0\n[materials]\nphases = [\"PI + 15 % graphite\", \"PLA + 30 % carbon fibre\"]\n[voxels]\nsize_mm = {size:?}\n{more}",
        0.1 * length
    );
    match DesignInput::from_text(&text, Format::Toml, "bench", "bench", Path::new(".")) {
        Ok(input) => input,
        Err(error) => panic!("{error}"),
    }
}

fn timed(what: &str, work: impl FnOnce(&Clock)) {
    let (clock, start) = (Clock::new(), Instant::now());
    work(&clock);
    clock.report(what, start);
}

fn main() {
    let Ok(folder) = tempfile::tempdir() else { return };
    let fine = input(100.0, 0.2, "[decks]\nwrite = [\"voxel_solid\", \"voxel_shell\"]\n");
    let mut design = None;
    timed("design, L = 100 mm, voxels of 0.2 mm", |clock| {
        design = Design::compute_unless(&fine, Limits::default(), &|| !clock.ask(0.0)).ok();
    });
    let Some(design) = design else { return };
    println!("{} voxels a spoke", design.grid().phases().len());
    timed("  its decks and report", |clock| {
        let written = write_design(&design, folder.path(), WriteOptions::default(), &|_| clock.ask(0.0));
        assert!(written.is_ok());
    });
    let mut strip = None;
    timed("  its strip for conduction", |clock| {
        let progress = |share: f64| clock.ask(share);
        let watch = Watch { progress: &progress, span: [0.0, 1.0] };
        strip = Strip::new_unless(&design, Model::Voxel, Shape::Morphed, [160, 24, 4], watch).ok();
    });
    let Some(strip) = strip else { return };
    let conduction = voxelastica_core::input::ConductionInput::default();
    for (name, problem) in [("  steady heat", Problem::Heat), ("  steady current", Problem::Current)] {
        timed(name, |clock| {
            let progress = |share: f64| clock.ask(share);
            let watch = Watch { progress: &progress, span: [0.0, 1.0] };
            let regimes = Regimes { steady: true, transient: false };
            let _ = solve(&strip, problem, regimes, &conduction, watch);
        });
    }
    let Ok(printed) = Design::compute(&input(60.0, 0.25, "[decks]\nwrite = []\n"), Limits::default()) else { return };
    for kind in FabricationKind::ALL {
        timed(&format!("{}, L = 60 mm, voxels of 0.25 mm", kind.name()), |clock| {
            let options = WriteOptions { allow_large: true };
            let made = fabricate(&printed, folder.path(), &[kind], options, &|_| {}, &|_| clock.ask(0.0));
            assert!(made.is_ok() || matches!(made, Err(voxelastica_core::Error::Input(_))));
        });
    }
    let Ok(voxels) = Design::compute(&input(100.0, 0.5, ""), Limits::default()) else { return };
    timed("morph of 67 000 voxels (one factorisation)", |clock| {
        let _ = verify_embedded(&voxels, &EmbeddedOptions::default(), &|share| clock.ask(share));
    });
    timed("calibrated design", |clock| {
        let calibrated = input(100.0, 0.25, "match = \"calibrated\"\n");
        let _ = Design::compute_unless(&calibrated, Limits::default(), &|| !clock.ask(0.0));
    });
}
