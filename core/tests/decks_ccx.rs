//! Decks run by the real CalculiX. Without `ccx` on the path (or named by `VOXELASTICA_CCX`) each test says that it was
//! skipped.

#[allow(dead_code, reason = "shared between test programs")]
mod common;

use std::process::Command;

use common::{design, provenance};
use voxelastica_core::fem::{MorphOptions, Resolution};
use voxelastica_core::indentation::solid::{self, SolidOptions};
use voxelastica_core::input::{DeckKind, DeckSolver, IndentationInput};
use voxelastica_core::output::Summary;
use voxelastica_core::results::ccx_dat::{NodePrint, Quantity, parse};
use voxelastica_core::results::{EmbeddedOptions, pressed, verify_embedded};
use voxelastica_core::solver::ccx::Ccx;
use voxelastica_core::{Design, deck, progress};

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

/// What a run wrote.
struct Run {
    flat: Vec<[f64; 3]>,
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
    fn midline(&self) -> Vec<[f64; 3]> {
        let moved = self.last("MIDLINE", Quantity::Displacement);
        assert_eq!(moved.len(), self.flat.len());
        let rim = moved[0];
        self.flat.iter().zip(&moved).map(|([s, _, z], u)| [*s, s + u[0] - rim[0], z + u[2] - rim[2]]).collect()
    }

    /// Largest distance of the mid-line from the target, as a share of the length: at equal arc length, and to the curve.
    fn errors(&self, design: &Design) -> [f64; 2] {
        let profile = design.profile();
        let length = design.input().strips.length_mm;
        let last = profile.s.len() - 1;
        let point = |i: usize| [profile.x[i], profile.z[i]];
        let mut errors = [0.0_f64; 2];
        for [s, x, z] in self.midline() {
            let at = (s / length * last as f64).clamp(0.0, last as f64);
            let i = (at as usize).min(last - 1);
            let [a, b] = [point(i), point(i + 1)];
            let share = at - i as f64;
            let same = [a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])];
            errors[0] = errors[0].max((x - same[0]).hypot(z - same[1]));
            let nearest = (0..last).map(|i| to_segment([x, z], point(i), point(i + 1))).fold(f64::MAX, f64::min);
            errors[1] = errors[1].max(nearest);
        }
        errors.map(|e| e / length)
    }
}

/// Distance of a point from a segment.
fn to_segment(p: [f64; 2], a: [f64; 2], b: [f64; 2]) -> f64 {
    let (d, e) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
    let along = ((d[0] * e[0] + d[1] * e[1]) / (d[0] * d[0] + d[1] * d[1])).clamp(0.0, 1.0);
    (e[0] - along * d[0]).hypot(e[1] - along * d[1])
}

/// The solver.
fn executable() -> String {
    std::env::var("VOXELASTICA_CCX").unwrap_or_else(|_| "ccx".to_owned())
}

/// Runs a deck; `None` where there is no solver.
fn run(design: &Design, kind: DeckKind) -> Option<Run> {
    let ccx = executable();
    if Command::new(&ccx).arg("-v").output().is_err() {
        println!("SKIPPED: no CalculiX ({ccx})");
        return None;
    }
    let plan = deck::plan(design).into_iter().find(|p| p.kind == kind && p.solver == DeckSolver::Calculix).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let mut out = std::fs::File::create(folder.path().join("deck.inp")).unwrap();
    deck::write(design, &plan, &provenance(), &mut out, &progress::ignore).unwrap();
    let start = std::time::Instant::now();
    let output =
        Command::new(&ccx).arg("deck").current_dir(folder.path()).env("OMP_NUM_THREADS", "2").output().unwrap();
    let log = String::from_utf8_lossy(&output.stdout);
    let iterations = log.matches("iteration ").count();
    println!("{} elements: {iterations} iterations, {:.1} s", plan.elements, start.elapsed().as_secs_f64());
    assert!(log.contains("Job finished") && !log.contains("*ERROR"), "{log}");
    let text = std::fs::read_to_string(folder.path().join("deck.dat")).unwrap();
    Some(Run { flat: deck::midline(design, kind, DeckSolver::Calculix).unwrap(), blocks: parse(&text).unwrap() })
}

/// A reaction lies between those of a narrow and a wide strip, give or take the mesh and the short spoke.
fn between(value: f64, beam: f64, plane_strain: f64) {
    println!("reaction {value:.5}, beam {beam:.5}, plane strain {plane_strain:.5}");
    let (low, high) = if beam < plane_strain { (beam, plane_strain) } else { (plane_strain, beam) };
    let slack = 0.02 * beam.abs();
    assert!((low - slack..=high + slack).contains(&value), "{value} is not between {low} and {high}");
}

#[test]
#[ignore = "needs ccx: scripts/test runs it where there is one"]
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
#[ignore = "needs ccx: scripts/test runs it where there is one"]
fn the_voxelised_hemisphere_stays_near_its_target() {
    let design = hemisphere(40.0, "free", 1.0);
    let Some(run) = run(&design, DeckKind::VoxelSolid) else { return };
    let [material, nearest] = run.errors(&design);
    println!("voxel hemisphere: {:.3} % at equal s, {:.3} % to the curve", 100.0 * material, 100.0 * nearest);
    assert!(material < 0.015, "{material}");
}

#[test]
#[ignore = "needs ccx: scripts/test runs it where there is one"]
fn the_finite_elements_inside_agree_with_calculix_on_the_same_mesh() {
    for (pattern, hub) in [("random", "free"), ("through-thickness", "free"), ("centred", "held")] {
        let text = format!(
            "[target]\nkind = \"hemi-ellipsoid\"\n[strips]\ncount = 8\nlength_mm = 30.0\nhub_radius_mm = 3.0\n\
             thickness_mm = 2.0\n[thrust]\nhub = \"{hub}\"\n[materials]\nphases = [\"FLX9070\", \"FLX9095\"]\n[voxels]\n\
             size_mm = 1.0\npattern = \"{pattern}\"\nmatch = \"stiffness\""
        );
        let design = design(&text);
        let Some(run) = run(&design, DeckKind::VoxelSolid) else { return };
        let inside = verify_embedded(&design, &EmbeddedOptions::default(), &progress::unseen).unwrap();
        let pairs = run.midline().into_iter().zip(inside.verification.midline_mm);
        let off = pairs.map(|(a, b)| (a[1] - b[1]).hypot(a[2] - b[2])).fold(0.0, f64::max) / 30.0;
        let rim = inside.solution.reactions.rim;
        let [force] = run.last("RP-RIM", Quantity::Force)[..] else { panic!("one reference node") };
        let [moment] = run.last("RP-RIM-ROT", Quantity::Force)[..] else { panic!("one reference node") };
        println!("{pattern}, {hub}: {:.4} % of L apart; H {} {}", 100.0 * off, force[0], rim.horizontal);
        println!("  V {} {}, moment {} {}", force[2], rim.vertical, moment[1], rim.moment);
        assert!(off < 0.0005, "{pattern}, {hub}: {off}");
        assert!((rim.moment - moment[1]).abs() < 0.005 * rim.moment.abs(), "{} {}", rim.moment, moment[1]);
        // A held hub nearly cancels the horizontal force: what compares is the whole thrust.
        let thrust = rim.horizontal.hypot(rim.vertical);
        let apart = (rim.horizontal - force[0]).hypot(rim.vertical.abs() - force[2].abs());
        assert!(apart < 0.02 * thrust, "{pattern}, {hub}: {apart} of {thrust} N");
    }
}

/// The table of all shapes, for the developer: `--ignored --nocapture`, ten minutes.
#[test]
#[ignore = "needs ccx: scripts/test runs it where there is one"]
fn the_pressed_hemisphere_agrees_with_the_finite_elements_inside_and_the_published_trial() {
    let ccx = Ccx { executable: executable().into(), threads: 2 };
    if ccx.version().is_err() {
        println!("SKIPPED: no CalculiX ({})", executable());
        return;
    }
    let design = hemisphere(100.0, "free", 0.5);
    let input = IndentationInput { steps: 20, ..IndentationInput::default() };
    let folder = tempfile::tempdir().unwrap();
    let found = pressed::press(&design, &input, &ccx, folder.path(), &|_| true).unwrap();
    // The trial's figures are for a largest modulus of 12.6 MPa, which voxels of half a millimetre do not quite reach.
    let scale = design.profile().modulus_mpa.iter().copied().fold(0.0, f64::max) / 12.6;
    for (depth, force) in [(1.0, 0.0286), (5.0, 0.119), (9.9, 0.241)] {
        let ours = found.force_at(depth).unwrap();
        println!("{depth} mm: {ours:.5} N, published {:.5}", force * scale);
        assert!((ours / (force * scale) - 1.0).abs() < 0.05, "{depth}: {ours}");
    }
    let options =
        SolidOptions { resolution: Resolution::Graded([60, 6, 2]), neighbours: false, morph: MorphOptions::default() };
    let inside = solid::indent(&design, &input, &options, &|_| true).unwrap();
    println!("K {:.6}, inside {:.6}", found.rigidity_n_mm, inside.rigidity_n_mm);
    assert!((found.rigidity_n_mm / inside.rigidity_n_mm - 1.0).abs() < 0.02);
    assert!((found.tangent_n_mm / inside.tangent_n_mm - 1.0).abs() < 0.02);
    let [work, energy] = found.energy_balance();
    assert!((work / energy - 1.0).abs() < 0.01, "{work} {energy}");
    assert!(found.penetration_mm > 0.0 && found.penetration_mm < 0.02, "{}", found.penetration_mm);
    assert!(found.curve.iter().all(|p| p.contact_force_n >= 0.0));
    assert!((found.largest_strain[0].strain / inside.largest_strain[0].strain - 1.0).abs() < 0.05);
}

#[test]
#[ignore = "long"]
fn every_shape_of_the_paper() {
    let polynomial = |coefficients: &str, count, hub, support: &str, phases: [&str; 2], mesh: &str| {
        format!(
            "[target]\nkind = \"inclination-polynomial\"\ncoefficients_deg = [{coefficients}]\n[strips]\ncount = {count}\n\
             length_mm = 100.0\nhub_radius_mm = {hub}\nthickness_mm = 2.0\n[thrust]\nhub = \"{support}\"\n[materials]\n\
             phases = {phases:?}\n[voxels]\nsize_mm = 1.0\n[decks]\ncalculix_graded_elements = {mesh}"
        )
    };
    let strip = |ratio: f64| {
        format!(
            "[target]\nkind = \"strip\"\nwidth_mm = 12.0\nmodulus_ratio = {ratio:?}\nshortening = 0.6\n[strips]\n\
             length_mm = 40.0\nthickness_mm = 2.0\n[materials]\nphases = [\"FLX9070\", \"FLX9095\"]\n[voxels]\nsize_mm = 1.0"
        )
    };
    let (nose, trumpet, roof, hemisphere) = (
        "26.52, -116.3, 162.3, -132, 63.5, -47.14, 18.64, 41.56",
        "-11340, 49160, -86720, 79040, -38440, 8860, -564.5, 87.1, 6.467",
        "6395, -28300, 52140, -51860, 30530, -11170, 2808, -570.8, 89.7",
        "-90, 90",
    );
    let (near, far) = (["FLX9070", "FLX9095"], ["TangoBlack", "VeroClear"]);
    let cases = [
        ("hemisphere, held", polynomial(hemisphere, 8, 10.0, "held", near, "[60, 6, 2]"), 0.0015),
        ("nose cone, held", polynomial(nose, 12, 5.0, "held", near, "[80, 4, 2]"), 0.004),
        ("trumpet, held", polynomial(trumpet, 8, 5.0, "held", near, "[80, 4, 2]"), 0.002),
        ("roof, held", polynomial(roof, 6, 20.0, "held", far, "[80, 4, 2]"), 0.004),
        ("nose cone, free", polynomial(nose, 12, 5.0, "free", far, "[80, 4, 2]"), 0.001),
        ("trumpet, free", polynomial(trumpet, 8, 5.0, "free", far, "[80, 4, 2]"), 0.002),
        ("roof, free", polynomial(roof, 6, 20.0, "free", far, "[80, 4, 2]"), 0.005),
        ("strip, 0.5", strip(0.5), 0.03),
        ("strip, 1", strip(1.0), 0.03),
        ("strip, 2", strip(2.0), 0.03),
    ];
    for (name, text, limit) in cases {
        let design = design(&text);
        let Some(run) = run(&design, DeckKind::GradedSolid) else { return };
        let [material, nearest] = run.errors(&design);
        println!("{name}: {:.3} % at equal s, {:.3} % to the curve", 100.0 * material, 100.0 * nearest);
        assert!(material < limit, "{name}: {material}");
    }
}
