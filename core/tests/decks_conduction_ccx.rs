//! Decks of heat and of unit cells run by the real CalculiX. Without `ccx` on the path (or named by `VOXELASTICA_CCX`) each
//! test says that it was skipped.

#[allow(dead_code, reason = "shared between test programs")]
mod common;

use std::path::Path;
use std::process::Command;

use common::{design, provenance};
use voxelastica_core::deck::unit_cell::{STRAIN, UnitCellDeck};
use voxelastica_core::input::{DeckKind, DeckSolver};
use voxelastica_core::materials::library;
use voxelastica_core::micromechanics::unit_cell::{BrickKind, CellMesh, CellSize, Layout, LoadedFaces, StretchTest};
use voxelastica_core::results::ccx_dat::{NodePrint, Quantity, parse};
use voxelastica_core::{Design, deck, progress};

const HOT: f64 = 393.15;
const COLD: f64 = 316.15;

/// Runs `deck.inp` in a folder; `None` where there is no solver.
fn run(folder: &Path) -> Option<Vec<NodePrint>> {
    let ccx = std::env::var("VOXELASTICA_CCX").unwrap_or_else(|_| "ccx".to_owned());
    if Command::new(&ccx).arg("-v").output().is_err() {
        println!("SKIPPED: no CalculiX ({ccx})");
        return None;
    }
    let output = Command::new(&ccx).arg("deck").current_dir(folder).env("OMP_NUM_THREADS", "2").output().unwrap();
    let log = String::from_utf8_lossy(&output.stdout);
    assert!(log.contains("Job finished") && !log.contains("*ERROR") && !log.contains("*WARNING reading"), "{log}");
    Some(parse(&std::fs::read_to_string(folder.join("deck.dat")).unwrap()).unwrap())
}

fn run_deck(design: &Design, kind: DeckKind) -> Option<Vec<NodePrint>> {
    let plan = deck::plan(design).into_iter().find(|p| p.kind == kind && p.solver == DeckSolver::Calculix).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let mut out = std::fs::File::create(folder.path().join("deck.inp")).unwrap();
    deck::write(design, &plan, &provenance(), &mut out, &progress::ignore).unwrap();
    run(folder.path())
}

/// Two phases that conduct; the target and the voxels are filled in.
fn conducting(target: &str, strips: &str, voxels: &str) -> Design {
    design(&format!(
        "[target]\n{target}\n[strips]\nlength_mm = 20.0\nthickness_mm = 2.0\n{strips}\n[materials]\nphases = [\"a\", \"b\"]\n\
         [[materials.custom]]\nname = \"a\"\nmodulus_mpa = 3.0\npoisson = 0.3\ndensity_kg_m3 = 1410.0\n\
         conductivity_w_mk = 0.3155\nspecific_heat_j_kgk = 1100.0\n[[materials.custom]]\nname = \"b\"\nmodulus_mpa = 10.0\n\
         poisson = 0.3\ndensity_kg_m3 = 1270.0\nconductivity_w_mk = 2.01\nspecific_heat_j_kgk = 1200.0\n[voxels]\n\
         size_mm = 1.0\n{voxels}\n[decks]\nwrite = [\"voxel_heat\", \"graded_heat\"]\nsolvers = [\"calculix\"]\n\
         calculix_graded_elements = [80, 2, 2]"
    ))
}

/// Heat through the rim at the end of the steady step, mW.
fn steady_heat(blocks: &[NodePrint]) -> f64 {
    blocks.iter().rev().find(|b| b.quantity == Quantity::TotalHeat && b.set == "RIM").unwrap().rows[0].1[0]
}

/// `(T - T_0)/(T_1 - T_0)` at a distance `x` from a face that is suddenly hot, of a slab that is insulated at `L`.
fn slab(fourier: f64, x: f64) -> f64 {
    let mode = |n: u32| {
        let k = (f64::from(n) + 0.5) * std::f64::consts::PI;
        2.0 / k * (k * x).sin() * (-k * k * fourier).exp()
    };
    1.0 - (0..200).map(mode).sum::<f64>()
}

#[test]
#[ignore = "needs ccx: scripts/test runs it where there is one"]
fn a_strip_of_one_phase_heats_as_the_series_says() {
    let target = "kind = \"strip\"\nwidth_mm = 4.0\nrigid_fraction = 1.0";
    let design = conducting(target, "", "");
    let Some(blocks) = run_deck(&design, DeckKind::VoxelHeat) else { return };
    // k A / L dT, with 8 mm^2 over 20 mm.
    let exact = 2.01 * 8.0 / 20.0 * (HOT - COLD);
    assert!((steady_heat(&blocks) / exact - 1.0).abs() < 1e-6, "{} {exact}", steady_heat(&blocks));
    let diffusivity = 2.01 / (1.27e-9 * 1.2e9);
    let temperatures: Vec<_> = blocks.iter().filter(|b| b.quantity == Quantity::Temperature).collect();
    // The pictures of the transient step; the last block is the steady one.
    assert!(temperatures.len() >= 3, "{:?}", temperatures.iter().map(|b| b.time).collect::<Vec<_>>());
    for block in &temperatures[..temperatures.len() - 1] {
        let fourier = diffusivity * block.time / 400.0;
        for (i, (_, [t, ..])) in block.rows.iter().enumerate() {
            let (found, exact) = ((t - COLD) / (HOT - COLD), slab(fourier, i as f64 / 20.0));
            // Backward Euler with increments of at most 2 K.
            assert!((found - exact).abs() < 0.008, "t = {}, node {i}: {found} {exact}", block.time);
        }
    }
    let last = &temperatures[temperatures.len() - 2].rows;
    assert!((last[20].1[0] - COLD) / (HOT - COLD) > 0.999, "{:?}", last[20]);
}

/// Columns along the strip conduct in parallel, a graded spoke in series.
#[test]
#[ignore = "needs ccx: scripts/test runs it where there is one"]
fn steady_heat_is_that_of_conductors_in_parallel_and_in_series() {
    let target = "kind = \"strip\"\nwidth_mm = 4.0\nrigid_fraction = 0.5";
    let columns = conducting(target, "", "pattern = \"centred\"");
    let Some(blocks) = run_deck(&columns, DeckKind::VoxelHeat) else { return };
    let exact = 0.5 * (0.3155 + 2.01) * 8.0 / 20.0 * (HOT - COLD);
    assert!((steady_heat(&blocks) / exact - 1.0).abs() < 1e-6, "{} {exact}", steady_heat(&blocks));

    let spoke = conducting("kind = \"hemi-ellipsoid\"", "count = 12\nhub_radius_mm = 8.0", "");
    let Some(blocks) = run_deck(&spoke, DeckKind::GradedHeat) else { return };
    let resistance: f64 = (0..2000)
        .map(|i| {
            let (width, modulus) = spoke.width_and_modulus(20.0 * (f64::from(i) + 0.5) / 2000.0);
            let rigid = spoke.rigid_fraction(modulus);
            0.01 / ((0.3155 * (1.0 - rigid) + 2.01 * rigid) * width * 2.0)
        })
        .sum();
    let (found, exact) = (steady_heat(&blocks), (HOT - COLD) / resistance);
    println!("graded spoke: {found} mW, in series {exact} mW");
    // The heat spreads as the spoke widens: a little more resistance than in series.
    assert!((found / exact - 1.0).abs() < 0.01, "{found} {exact}");
}

/// The same mesh and element: the solver's modulus and ours.
#[test]
#[ignore = "needs ccx: scripts/test runs it where there is one"]
fn unit_cells_have_the_moduli_that_calculix_finds() {
    let size = CellSize::new(3).unwrap();
    let layout = Layout::read("110/100/001", size).unwrap();
    let [soft, rigid] = [library()[0].clone(), library()[1].clone()];
    for element in [BrickKind::Trilinear, BrickKind::Enhanced] {
        for faces in [LoadedFaces::Sliding, LoadedFaces::Clamped] {
            let mesh = CellMesh { elements_per_voxel: 2, element, faces };
            let moduli = StretchTest::new(size, [&soft, &rigid], &mesh).unwrap().moduli(layout).unwrap();
            for (axis, modulus) in moduli.into_iter().enumerate() {
                let phases = [&soft, &rigid];
                let deck = UnitCellDeck { size, layout, phases, mesh, axis, solver: DeckSolver::Calculix };
                let folder = tempfile::tempdir().unwrap();
                let mut out = std::fs::File::create(folder.path().join("deck.inp")).unwrap();
                deck.write(&provenance(), &mut out).unwrap();
                let Some(blocks) = run(folder.path()) else { return };
                let force = blocks.iter().find(|b| b.quantity == Quantity::TotalForce).unwrap().rows[0].1[axis];
                let area = if axis == 2 { 9.0 } else { 3.0 };
                let found = force / (area * STRAIN);
                println!("{element:?} {faces:?} {axis}: {found} by CalculiX, {modulus} here");
                assert!((found / modulus - 1.0).abs() < 2e-6, "{found} {modulus}");
            }
        }
    }
}
