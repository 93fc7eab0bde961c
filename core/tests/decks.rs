//! Decks: what is planned, what is written, how large it is.

mod common;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use common::{FlatDeck, design, provenance, written};
use proptest::prelude::*;
use voxelastica_core::deck::unit_cell::UnitCellDeck;
use voxelastica_core::deck::{self, DeckError, DeckPlan};
use voxelastica_core::input::{DeckKind, DeckSolver};
use voxelastica_core::materials::Material;
use voxelastica_core::micromechanics::unit_cell::{BrickKind, CellMesh, CellSize, Layout, LoadedFaces};
use voxelastica_core::{Design, progress};

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

/// Small enough to be read by a person.
fn tiny(target: &str, materials: &str, decks: &str) -> Design {
    let write = if decks.contains("write =") { "" } else { "write = [\"graded_solid\", \"voxel_solid\"]\n" };
    let dome = if target.contains("strip") { "" } else { "count = 8\nhub_radius_mm = 1.0" };
    design(&format!(
        "name = \"Kuppel für Zoë\"\n[target]\n{target}\n[strips]\n{dome}\nlength_mm = 10.0\nthickness_mm = 2.0\n\
         {materials}\n[voxels]\nsize_mm = 1.0\n[decks]\n{write}\
         elements_per_voxel_edge = 1\ngraded_elements = [4, 2, 4]\ncalculix_graded_elements = [4, 2, 2]\n{decks}"
    ))
}

const DOME: &str = "kind = \"hemi-ellipsoid\"";
const TWO: &str = "[materials]\nphases = [\"FLX9070\", \"FLX9095\"]";
const THREE: &str = "[materials]\nphases = [\"soft\", \"FLX9070\", \"9 hard\"]\n\
                     [[materials.custom]]\nname = \"soft\"\nmodulus_mpa = 1.0\npoisson = 0.45\ndensity_kg_m3 = 1000\n\
                     [[materials.custom]]\nname = \"9 hard\"\nmodulus_mpa = 20.0\npoisson = 0.3\ndensity_kg_m3 = 1200";

const CONDUCTION: &str = r#"["voxel_heat", "graded_heat", "voxel_current", "graded_current"]"#;
const CONDUCTING: &str = "[materials]\nphases = [\"a\", \"b\"]\n\
     [[materials.custom]]\nname = \"a\"\nmodulus_mpa = 3.0\npoisson = 0.3\ndensity_kg_m3 = 1410.0\n\
     conductivity_w_mk = 0.3155\nspecific_heat_j_kgk = 1100.0\nelectrical_conductivity_s_m = 1e-7\nrelative_permittivity = 4.0\n\
     [[materials.custom]]\nname = \"b\"\nmodulus_mpa = 10.0\npoisson = 0.3\ndensity_kg_m3 = 1270.0\n\
     conductivity_w_mk = 2.01\nspecific_heat_j_kgk = 1200.0\nelectrical_conductivity_s_m = 3e-6\nrelative_permittivity = 5.0";

/// Text equal up to the last digits of numbers, which may differ between mathematical libraries.
fn same(found: &str, golden: &str) -> Result<(), String> {
    if found == golden {
        return Ok(());
    }
    if found.lines().count() != golden.lines().count() {
        return Err(format!("{} lines for {}", found.lines().count(), golden.lines().count()));
    }
    for (i, (a, b)) in found.lines().zip(golden.lines()).enumerate() {
        let words = |l: &str| l.split(',').map(str::to_owned).collect::<Vec<_>>();
        let close = |(a, b): (&String, &String)| {
            a == b
                || matches!((a.parse::<f64>(), b.parse::<f64>()), (Ok(a), Ok(b)) if (a - b).abs() <= 2e-8 * b.abs().max(1e-3))
        };
        let (a_words, b_words) = (words(a), words(b));
        if a_words.len() != b_words.len() || !a_words.iter().zip(&b_words).all(close) {
            return Err(format!("line {}: \"{a}\" for \"{b}\"", i + 1));
        }
    }
    Ok(())
}

/// Compares with `tests/golden`, or rewrites it where `VOXELASTICA_UPDATE_GOLDEN` is set.
#[test]
fn decks_are_the_golden_ones() {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/golden");
    let update = std::env::var_os("VOXELASTICA_UPDATE_GOLDEN").is_some();
    let clamped = "kind = \"strip\"\nwidth_mm = 4.0\nmodulus_ratio = 2.0\nshortening = 0.6";
    let coupon = "kind = \"strip\"\nwidth_mm = 4.0\nrigid_fraction = 0.5";
    let held = format!("[thrust]\nhub = \"held\"\n{TWO}");
    let cases = [
        ("dome_parts", tiny(DOME, TWO, "solvers = [\"abaqus\"]")),
        ("dome_flat", tiny(DOME, TWO, "style = \"flat\"")),
        ("pressed", tiny(DOME, TWO, "write = [\"graded_solid_indentation\"]")),
        ("held", tiny(DOME, &held, "solvers = [\"calculix\"]")),
        ("clamped", tiny(clamped, THREE, "solvers = [\"calculix\"]")),
        ("coupon", tiny(coupon, TWO, "solvers = [\"calculix\", \"nastran\"]")),
        ("conducting", tiny(DOME, CONDUCTING, &format!("style = \"flat\"\nwrite = {CONDUCTION}"))),
    ];
    let mut wrong = Vec::new();
    let mut check = |name: &str, relative: &str, text: &str| {
        let path = folder.join(format!("{name}_{}", relative.replace('/', "_")));
        if update {
            std::fs::create_dir_all(&folder).unwrap();
            std::fs::write(&path, text).unwrap();
        }
        let golden = std::fs::read_to_string(&path).unwrap_or_default();
        if let Err(difference) = same(text, &golden) {
            wrong.push(format!("{}: {difference}", path.display()));
        }
    };
    for (name, design) in &cases {
        for plan in deck::plan(design) {
            let text = written(design, &plan);
            check(name, &plan.relative_path(), &text);
            assert_eq!(text, written(design, &plan), "the same design gives the same bytes");
        }
    }
    let [soft, rigid] = [Material::new("soft", 3.1, 0.3), Material::new("rigid", 12.6, 0.3)];
    let size = CellSize::new(2).unwrap();
    let mesh = CellMesh { elements_per_voxel: 1, element: BrickKind::Enhanced, faces: LoadedFaces::Sliding };
    for solver in [DeckSolver::Abaqus, DeckSolver::Calculix] {
        let layout = Layout::read("10/01", size).unwrap();
        let deck = UnitCellDeck { size, layout, phases: [&soft, &rigid], mesh, axis: 0, solver };
        let mut out = Vec::new();
        deck.write(&provenance(), &mut out).unwrap();
        check("stretch", &deck.relative_path(), &String::from_utf8(out).unwrap());
    }
    assert!(wrong.is_empty(), "{}\nVOXELASTICA_UPDATE_GOLDEN=1 rewrites them", wrong.join("\n"));
}

#[test]
fn flat_and_parts_describe_the_same_mesh() {
    for kind in [DeckKind::GradedSolid, DeckKind::VoxelSolid] {
        let text = |style| {
            let design = tiny(DOME, TWO, style);
            let plan = deck::plan(&design).into_iter().find(|p| p.kind == kind && p.solver == DeckSolver::Abaqus);
            written(&design, &plan.unwrap())
        };
        let (flat, parts) = (text("style = \"flat\""), text("style = \"parts\""));
        let part = |text: &str, from: &str, to: &str| text[text.find(from).unwrap()..text.find(to).unwrap()].to_owned();
        // Only the reference nodes are elsewhere.
        assert!(part(&flat, "*NODE\n", "*ELEMENT").starts_with(&part(&parts, "*NODE\n", "*ELEMENT")));
        assert!(part(&flat, "*ELEMENT", "*SOLID SECTION") == part(&parts, "*ELEMENT", "*SOLID SECTION"));
    }
}

#[test]
fn estimates_are_within_ten_percent() {
    let design = design(HEMISPHERE);
    let plans = deck::plan(&design);
    assert!(plans.len() >= 4);
    for plan in plans {
        let bytes = written(&design, &plan).len() as f64;
        assert!((plan.bytes as f64 / bytes - 1.0).abs() < 0.1, "{plan:?} {bytes}");
    }
}

#[test]
fn progress_counts_every_byte_and_cancels() {
    let design = design(HEMISPHERE);
    for plan in deck::plan(&design) {
        let seen = AtomicU64::new(0);
        let mut out = Vec::new();
        let watch = |bytes| {
            assert!(seen.swap(bytes, Ordering::Relaxed) <= bytes);
            true
        };
        deck::write(&design, &plan, &provenance(), &mut out, &watch).unwrap();
        assert_eq!(seen.load(Ordering::Relaxed), out.len() as u64);

        let mut half = Vec::new();
        let stop = |bytes| bytes < out.len() as u64 / 2;
        let result = deck::write(&design, &plan, &provenance(), &mut half, &stop);
        assert!(matches!(result, Err(DeckError::Cancelled)), "{result:?}");
        assert!(half.len() < out.len() && out.starts_with(&half));
    }
}

#[test]
fn a_failing_writer_is_reported() {
    struct Full;
    impl std::io::Write for Full {
        fn write(&mut self, _: &[u8]) -> std::io::Result<usize> {
            Err(std::io::ErrorKind::StorageFull.into())
        }
        fn flush(&mut self) -> std::io::Result<()> {
            Ok(())
        }
    }
    let design = tiny(DOME, TWO, "");
    for plan in deck::plan(&design) {
        let result = deck::write(&design, &plan, &provenance(), &mut Full, &progress::ignore);
        assert!(matches!(result, Err(DeckError::Io(ref e)) if e.kind() == std::io::ErrorKind::StorageFull));
    }
}

/// Decks that can be read flat.
fn flat_plans(design: &Design) -> Vec<DeckPlan> {
    deck::plan(design).into_iter().filter(|p| matches!(p.kind, DeckKind::GradedSolid | DeckKind::VoxelSolid)).collect()
}

fn check_mesh(design: &Design, plan: &DeckPlan, per_edge: usize) {
    let text = written(design, plan);
    let deck = FlatDeck::read(&text);
    let (nodes, elements) = (deck.nodes.len() as u64, deck.elements.len() as u64);
    assert_eq!((nodes, elements), (plan.nodes, plan.elements));
    assert!(deck.nodes.keys().copied().eq(1..=nodes) && deck.elements.keys().copied().eq(1..=elements));
    assert!(!text.contains("-0,") && !text.contains("NaN") && !text.contains("inf"));

    let references: BTreeSet<u64> =
        deck.node_sets.iter().filter(|(name, _)| name.starts_with("RP-")).flat_map(|(_, n)| n.clone()).collect();
    let used: BTreeSet<u64> = deck.elements.values().flatten().copied().collect();
    assert!(used.is_disjoint(&references));
    assert_eq!(used.len() + references.len(), deck.nodes.len(), "every node belongs to an element or is a reference");
    let mut volume = 0.0;
    for element in deck.elements.keys() {
        let corners = deck.corner_volumes(*element);
        assert!(corners.iter().all(|v| *v > 0.0), "element {element}: {corners:?}");
        volume += corners.iter().sum::<f64>() / 8.0;
    }

    let strips = &design.input().strips;
    let at = |set: &str| deck.node_sets[set].iter().map(|n| deck.nodes[n]).collect::<Vec<_>>();
    let midline = &deck.node_sets["MIDLINE"];
    assert!(midline.windows(2).all(|w| w[0] < w[1]));
    let line = at("MIDLINE");
    assert_eq!((line[0][0], line[line.len() - 1][0]), (0.0, strips.length_mm));
    assert!(line.windows(2).all(|w| w[0][0] < w[1][0]) && line.iter().all(|p| p[1] == 0.0));
    for (set, x) in [("RIM", 0.0), ("HUB", strips.length_mm)] {
        let end = deck.nodes.iter().filter(|(id, p)| p[0] == x && !references.contains(id)).count();
        assert_eq!((at(set).len(), at(set).iter().all(|p| p[0] == x)), (end, true));
    }
    let rigid = |set: &str| deck.node_sets[set].len();
    assert_eq!((rigid("RP-RIM"), rigid("RP-HUB")), (1, 1));

    if plan.kind == DeckKind::VoxelSolid {
        let cube = per_edge.pow(3) as u64;
        let phases = design.phases().phases();
        for (phase, count) in phases.iter().zip(design.grid().counts(phases.len())) {
            let set = deck.element_sets.get(&format!("PHASE-{}", phase.label()));
            assert_eq!(set.map_or(0, Vec::len) as u64, count * cube);
        }
        let mut all: BTreeSet<u64> = BTreeSet::new();
        for (i, slice) in design.slices().iter().enumerate() {
            let set = &deck.element_sets[&format!("SLICE-{}", i + 1)];
            assert_eq!(set.len() as u64, u64::from(slice.counts.iter().sum::<u32>()) * cube);
            let size = design.grid().size_mm();
            let (from, to) = (i as f64 * size - 1e-7, (i + 1) as f64 * size + 1e-7);
            assert!(set.iter().flat_map(|e| &deck.elements[e]).all(|n| (from..=to).contains(&deck.nodes[n][0])));
            all.extend(set);
        }
        assert_eq!(all.len(), deck.elements.len());
        assert!((volume / design.grid().volume_mm3() - 1.0).abs() < 1e-6);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 32, failure_persistence: None, ..ProptestConfig::default() })]
    #[test]
    fn meshes_are_sound(
        count in 3_usize..13,
        layers in 1_usize..5,
        per_edge in 1_usize..4,
        aspect in 0.4_f64..2.2,
        seed in 0_u64..1000,
        graded in (2_usize..9, 1_usize..4, 1_usize..3),
        clamped in any::<bool>(),
    ) {
        let size = 2.0 / layers as f64;
        let target = if clamped {
            "kind = \"strip\"\nwidth_mm = 5.0\nmodulus_ratio = 1.5\nshortening = 0.3".to_owned()
        } else {
            format!("kind = \"hemi-ellipsoid\"\naspect_ratio = {aspect:?}")
        };
        let dome = if clamped { String::new() } else { format!("count = {count}\nhub_radius_mm = 1.2") };
        let (along, across, through) = (graded.0, 2 * graded.1, 2 * graded.2);
        let design = design(&format!(
            "[target]\n{target}\n[strips]\n{dome}\nlength_mm = 12.0\nthickness_mm = 2.0\n{TWO}\n\
             [voxels]\nsize_mm = {size:?}\nseed = {seed}\n[decks]\nstyle = \"flat\"\nsolid_element = \"C3D8I\"\n\
             elements_per_voxel_edge = {per_edge}\ncalculix_elements_per_voxel_edge = {per_edge}\n\
             graded_elements = [{along}, {across}, {through}]\ncalculix_graded_elements = [{along}, {across}, {through}]"
        ));
        let doubled = if layers * per_edge % 2 == 1 { 2 * per_edge } else { per_edge };
        for plan in flat_plans(&design) {
            check_mesh(&design, &plan, doubled);
        }
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
        deck::write(&design, &plan, &provenance(), &mut out, &progress::ignore).unwrap();
        println!("{:?} {plan:?} {}", start.elapsed(), out.metadata().unwrap().len());
    }
}
