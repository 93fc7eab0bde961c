//! Decks: what is planned, what is written, how large it is.

use std::path::Path;

use voxelastica_core::deck::{self, DeckPlan};
use voxelastica_core::input::files::Format;
use voxelastica_core::output::Provenance;
use voxelastica_core::{Design, DesignInput, Limits, progress};

const HEMISPHERE: &str = r#"
[target]
kind = "hemi-ellipsoid"
[strips]
count = 8
length_mm = 100.0
hub_radius_mm = 10.0
thickness_mm = 2.0
[materials]
phases = ["FLX9070", "FLX9095"]
[voxels]
size_mm = 0.5
"#;

fn design(text: &str) -> Design {
    let input = DesignInput::from_text(text, Format::Toml, "test.toml", "test", Path::new(".")).unwrap();
    Design::compute(&input, Limits::default()).unwrap()
}

fn written(design: &Design, plan: &DeckPlan) -> String {
    let mut out = Vec::new();
    deck::write(design, plan, &Provenance::of(design.input()), &mut out, &progress::ignore).unwrap();
    String::from_utf8(out).unwrap()
}

#[test]
fn estimates_are_within_ten_percent() {
    let design = design(HEMISPHERE);
    for plan in deck::plan(&design) {
        let bytes = written(&design, &plan).len() as f64;
        assert!((plan.bytes as f64 / bytes - 1.0).abs() < 0.1, "{plan:?} {bytes}");
    }
}

/// Writes the decks of the design file `VOXELASTICA_DESIGN` into the folder `VOXELASTICA_DECKS` and says how long each
/// took: a stopwatch for the developer, with `--release --ignored --nocapture`.
#[test]
#[ignore = "a stopwatch, not a check"]
fn stopwatch() {
    let (Ok(file), Ok(folder)) = (std::env::var("VOXELASTICA_DESIGN"), std::env::var("VOXELASTICA_DECKS")) else {
        println!("nothing to time");
        return;
    };
    let start = std::time::Instant::now();
    let design = design(&std::fs::read_to_string(file).unwrap());
    println!("design {:?}", start.elapsed());
    let start = std::time::Instant::now();
    let plans = deck::plan(&design);
    println!("plan {:?}", start.elapsed());
    for plan in plans {
        let path = Path::new(&folder).join(plan.relative_path());
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        let start = std::time::Instant::now();
        let mut out = std::fs::File::create(&path).unwrap();
        deck::write(&design, &plan, &Provenance::of(design.input()), &mut out, &progress::ignore).unwrap();
        println!("{:?} {plan:?} {}", start.elapsed(), out.metadata().unwrap().len());
    }
}
