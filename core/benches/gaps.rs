//! How long work goes on before it asks again whether to stop: the longest gaps of every kind of long work, one line each;
//! and of a morph how long it takes to return once it is to stop.
//!
//! A factorisation of the tangent cannot be stopped on its way, nor can the analysis of its structure before the first; the
//! morph and what is made of morphs show these as their longest gaps. Words after `--` choose the cases whose names have one.

use std::path::Path;
use std::sync::Mutex;
use std::time::{Duration, Instant};

use voxelastica_core::conduction::case::{Problem, Regimes, solve};
use voxelastica_core::conduction::pcg::Watch;
use voxelastica_core::conduction::strip::{Model, Shape, Strip};
use voxelastica_core::fabrication::fabricate;
use voxelastica_core::fem::{MorphOptions, Resolution};
use voxelastica_core::indentation::{self, solid::SolidOptions};
use voxelastica_core::input::files::Format;
use voxelastica_core::input::{FabricationKind, IndentationInput};
use voxelastica_core::output::write::{WriteOptions, write_design};
use voxelastica_core::progress::Share;
use voxelastica_core::refine::refine;
use voxelastica_core::results::verification::Model as SolverModel;
use voxelastica_core::results::{EmbeddedOptions, verify_embedded};
use voxelastica_core::{Design, DesignInput, Limits};

/// The longest gaps that are shown: more than a refinement with two corrections has factorisations.
const SHOWN: usize = 12;

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

fn is_chosen(what: &str) -> bool {
    let mut words = std::env::args().skip(1).filter(|word| !word.starts_with('-')).peekable();
    words.peek().is_none() || words.any(|word| what.contains(&word))
}

fn timed(what: &str, work: impl FnOnce(&Clock)) {
    if !is_chosen(what) {
        return;
    }
    let (clock, start) = (Clock::new(), Instant::now());
    work(&clock);
    clock.report(what, start);
}

/// Stops some work after a time: how long it then takes to return.
fn stopped(what: &str, after: f64, work: impl FnOnce(Share<'_>)) {
    if !is_chosen(what) {
        return;
    }
    let start = Instant::now();
    let asked = Mutex::new(None);
    work(&|_| {
        let goes_on = start.elapsed().as_secs_f64() < after;
        if !goes_on && let Ok(mut asked) = asked.lock() {
            asked.get_or_insert(Instant::now());
        }
        goes_on
    });
    let total = start.elapsed().as_secs_f64();
    match asked.into_inner() {
        Ok(Some(asked)) => println!(
            "{what}, to stop at {after} s: asked {:.0} ms later, returned after another {:.0} ms",
            1e3 * (total - after - asked.elapsed().as_secs_f64()),
            1e3 * asked.elapsed().as_secs_f64()
        ),
        _ => println!("{what}, to stop at {after} s: was done before"),
    }
}

fn main() {
    let Ok(folder) = tempfile::tempdir() else { return };
    let fine = input(100.0, 0.2, "[decks]\nwrite = [\"voxel_solid\", \"voxel_shell\"]\n");
    timed("design, L = 100 mm, voxels of 0.2 mm", |clock| {
        let _ = Design::compute_unless(&fine, Limits::default(), &|| !clock.ask(0.0));
    });
    let Ok(design) = Design::compute(&fine, Limits::default()) else { return };
    println!("{} voxels a spoke", design.grid().phases().len());
    timed("  its decks and report", |clock| {
        let written = write_design(&design, folder.path(), WriteOptions::default(), &|_| clock.ask(0.0));
        assert!(written.is_ok());
    });
    timed("  its strip for conduction", |clock| {
        let progress = |share: f64| clock.ask(share);
        let _ = morphed(&design, Watch { progress: &progress, span: [0.0, 1.0] });
    });
    let conduction = voxelastica_core::input::ConductionInput::default();
    for (name, problem) in [("  steady heat", Problem::Heat), ("  steady current", Problem::Current)] {
        timed(name, |clock| {
            let progress = |share: f64| clock.ask(share);
            let watch = Watch { progress: &progress, span: [0.0, 1.0] };
            let Some(strip) = morphed(&design, watch) else { return };
            let regimes = Regimes { steady: true, transient: false };
            let _ = solve(&strip, problem, regimes, &conduction, watch);
        });
    }
    let Ok(voxels) = Design::compute(&input(100.0, 0.5, ""), Limits::default()) else { return };
    for (name, problem) in [("heat in time", Problem::Heat), ("current in time", Problem::Current)] {
        timed(&format!("{name}, 67 000 voxels"), |clock| {
            let progress = |share: f64| clock.ask(share);
            let watch = Watch { progress: &progress, span: [0.0, 1.0] };
            let Some(strip) = morphed(&voxels, watch) else { return };
            let regimes = Regimes { steady: false, transient: true };
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
    timed("morph of 67 000 voxels", |clock| {
        let _ = verify_embedded(&voxels, &EmbeddedOptions::default(), &|share| clock.ask(share));
    });
    for seconds in [0.05, 0.2, 0.8, 1.5, 6.0, 7.5, 13.0, 14.0] {
        stopped("morph of 67 000 voxels", seconds, |progress| {
            let _ = verify_embedded(&voxels, &EmbeddedOptions::default(), progress);
        });
    }
    timed("morph of a graded strip", |clock| {
        let options = EmbeddedOptions { model: SolverModel::Graded, ..EmbeddedOptions::default() };
        let _ = verify_embedded(&voxels, &options, &|share| clock.ask(share));
    });
    for (name, length, size, more) in [
        ("refinement, 67 000 voxels", 100.0, 0.5, ""),
        ("refinement, calibrated, 10 704 voxels", 40.0, 0.5, "match = \"calibrated\"\n"),
        ("refinement, L = 40 mm, voxels of 1 mm", 40.0, 1.0, ""),
    ] {
        timed(name, |clock| {
            let (input, options) = (input(length, size, more), EmbeddedOptions::default());
            let _ = refine(&input, Limits::default(), 2, &options, &|share| clock.ask(share));
        });
    }
    timed("dome pressed, graded", |clock| {
        let options = SolidOptions {
            resolution: Resolution::Graded(voxels.input().decks.calculix_graded_elements),
            neighbours: true,
            morph: MorphOptions::default(),
        };
        let pressed = indentation::solid::indent(&voxels, &IndentationInput::default(), &options, &|s| clock.ask(s));
        assert!(pressed.is_ok());
    });
    timed("dome pressed, elastica", |clock| {
        let pressed = indentation::elastica::indent(&voxels, &IndentationInput::default(), &|s| clock.ask(s));
        assert!(pressed.is_ok());
    });
    timed("calibrated design", |clock| {
        let calibrated = input(100.0, 0.25, "match = \"calibrated\"\n");
        let _ = Design::compute_unless(&calibrated, Limits::default(), &|| !clock.ask(0.0));
    });
}

fn morphed(design: &Design, watch: Watch<'_>) -> Option<Strip> {
    Strip::new_unless(design, Model::Voxel, Shape::Morphed, [160, 24, 4], watch).ok()
}
