//! Decks run by the real CalculiX. Without `ccx` on the path (or named by `VOXELASTICA_CCX`) each test says that it was
//! skipped.

use std::path::Path;
use std::process::Command;

use voxelastica_core::deck;
use voxelastica_core::input::files::Format;
use voxelastica_core::input::{DeckKind, DeckSolver};
use voxelastica_core::output::{Provenance, Summary};
use voxelastica_core::results::ccx_dat::{NodePrint, Quantity, parse};
use voxelastica_core::{Design, DesignInput, Limits, progress};

/// A hemisphere of eight spokes: `hub` and the graded mesh are filled in.
fn hemisphere(length: f64, hub: &str, voxel: f64) -> Design {
    let text = format!(
        r#"
        [target]
        kind = "hemi-ellipsoid"
        aspect_ratio = 1.0
        [strips]
        count = 8
        length_mm = {length:?}
        hub_radius_mm = {:?}
        thickness_mm = 2.0
        [thrust]
        hub = "{hub}"
        [materials]
        phases = ["FLX9070", "FLX9095"]
        [voxels]
        size_mm = {voxel:?}
        [decks]
        calculix_graded_elements = [60, 6, 2]
        "#,
        length / 10.0
    );
    design(&text)
}

fn design(text: &str) -> Design {
    let input = DesignInput::from_text(text, Format::Toml, "test.toml", "test", Path::new(".")).unwrap();
    Design::compute(&input, Limits::default()).unwrap()
}

/// The last increment of a run.
struct Run {
    blocks: Vec<NodePrint>,
}

impl Run {
    /// Rows of a node set at the end of the step.
    fn last(&self, set: &str, quantity: Quantity) -> Vec<[f64; 3]> {
        let block = self.blocks.iter().rev().find(|b| b.set == set && b.quantity == quantity).unwrap();
        assert!((block.time - 1.0).abs() < 1e-6, "the step ended at {}", block.time);
        block.rows.iter().map(|r| r.1).collect()
    }

    /// Mid-line nodes as `[s, x, z]` with the rim at the origin.
    fn midline(&self, length: f64) -> Vec<[f64; 3]> {
        let moved = self.last("MIDLINE", Quantity::Displacement);
        let step = length / (moved.len() - 1) as f64;
        let rim = moved[0];
        let place = |(i, u): (usize, &[f64; 3])| {
            let s = i as f64 * step;
            [s, s + u[0] - rim[0], u[2] - rim[2]]
        };
        moved.iter().enumerate().map(place).collect()
    }

    /// Largest distance of the mid-line from the target, as a share of the length: at equal arc length, and to the curve.
    fn errors(&self, design: &Design) -> [f64; 2] {
        let profile = design.profile();
        let length = design.input().strips.length_mm;
        let last = profile.s.len() - 1;
        let mut errors = [0.0_f64; 2];
        for [s, x, z] in self.midline(length) {
            let at = (s / length * last as f64).clamp(0.0, last as f64);
            let i = (at as usize).min(last - 1);
            let between = |v: &[f64]| v[i] + (at - i as f64) * (v[i + 1] - v[i]);
            errors[0] = errors[0].max((x - between(&profile.x)).hypot(z - between(&profile.z)));
            let nearest = profile.x.iter().zip(&profile.z).map(|(a, b)| (x - a).hypot(z - b)).fold(f64::MAX, f64::min);
            errors[1] = errors[1].max(nearest);
        }
        errors.map(|e| e / length)
    }
}

/// Runs a deck; `None` where there is no solver.
fn run(design: &Design, kind: DeckKind) -> Option<Run> {
    let ccx = std::env::var("VOXELASTICA_CCX").unwrap_or_else(|_| "ccx".to_owned());
    if Command::new(&ccx).arg("-v").output().is_err() {
        println!("SKIPPED: no CalculiX ({ccx})");
        return None;
    }
    let plan = deck::plan(design).into_iter().find(|p| p.kind == kind && p.solver == DeckSolver::Calculix).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let mut out = std::fs::File::create(folder.path().join("deck.inp")).unwrap();
    deck::write(design, &plan, &Provenance::of(design.input()), &mut out, &progress::ignore).unwrap();
    let start = std::time::Instant::now();
    let output =
        Command::new(&ccx).arg("deck").current_dir(folder.path()).env("OMP_NUM_THREADS", "2").output().unwrap();
    println!("{} elements: {:.1} s", plan.elements, start.elapsed().as_secs_f64());
    let log = String::from_utf8_lossy(&output.stdout);
    assert!(log.contains("Job finished") && !log.contains("*ERROR"), "{log}");
    let text = std::fs::read_to_string(folder.path().join("deck.dat")).unwrap();
    Some(Run { blocks: parse(&text).unwrap() })
}

/// A reaction lies between those of a narrow and a wide strip, give or take the mesh and the short spoke.
fn between(value: f64, beam: f64, plane_strain: f64) {
    println!("reaction {value:.5}, beam {beam:.5}, plane strain {plane_strain:.5}");
    let (low, high) = if beam < plane_strain { (beam, plane_strain) } else { (plane_strain, beam) };
    let slack = 0.02 * beam.abs();
    assert!((low - slack..=high + slack).contains(&value), "{value} is not between {low} and {high}");
}

#[test]
fn the_graded_hemisphere_takes_its_shape_with_the_designed_reactions() {
    let design = hemisphere(100.0, "free", 1.0);
    let Some(run) = run(&design, DeckKind::GradedSolid) else { return };
    let [material, nearest] = run.errors(&design);
    println!("graded hemisphere: {:.3} % at equal s, {:.3} % to the curve", 100.0 * material, 100.0 * nearest);
    assert!(material < 0.0015, "{material}");
    let thrust = Summary::of(&design).thrust.per_spoke;
    let force = |set: &str| run.last(set, Quantity::Force)[0];
    between(force("RP-RIM")[0], thrust.beam.horizontal_n, thrust.plane_strain.horizontal_n);
    between(force("RP-RIM-ROT")[1], thrust.beam.rim_moment_nmm, thrust.plane_strain.rim_moment_nmm);
    between(-force("RP-HUB")[0], thrust.beam.horizontal_n, thrust.plane_strain.horizontal_n);
    between(-force("RP-HUB-ROT")[1], thrust.beam.hub_moment_nmm, thrust.plane_strain.hub_moment_nmm);
    assert!(force("RP-RIM")[2].abs() < 1e-5, "a free hub carries no vertical force");
}

#[test]
fn the_voxelised_hemisphere_stays_near_its_target() {
    let design = hemisphere(40.0, "free", 1.0);
    let Some(run) = run(&design, DeckKind::VoxelSolid) else { return };
    let [material, nearest] = run.errors(&design);
    println!("voxel hemisphere: {:.3} % at equal s, {:.3} % to the curve", 100.0 * material, 100.0 * nearest);
    assert!(material < 0.015, "{material}");
}
