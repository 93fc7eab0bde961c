//! Heat on voxels against the real CalculiX on the same mesh. Without `ccx` on the path (or named by `VOXELASTICA_CCX`) each
//! test says that it was skipped.

#[allow(dead_code, reason = "shared between test programs")]
mod common;

use std::fmt::Write;
use std::process::Command;

use common::design;
use voxelastica_core::conduction::mesh::VOID;
use voxelastica_core::conduction::pcg::Tolerance;
use voxelastica_core::conduction::pcg::Watch;
use voxelastica_core::conduction::steady::{Boundary, SteadyOptions, plane_nodes, solve};
use voxelastica_core::conduction::strip::{Model, Property, Shape, Strip};
use voxelastica_core::conduction::transient::{Drive, Storage, Transient, TransientOptions, integrate};

const RIM: f64 = 393.15;
const START: f64 = 316.15;

fn spoke(pattern: &str) -> voxelastica_core::Design {
    design(&format!(
        r#"
        [target]
        kind = "hemi-ellipsoid"
        [strips]
        count = 8
        length_mm = 40.0
        hub_radius_mm = 4.0
        thickness_mm = 2.0
        [materials]
        phases = ["PI + 15 % graphite", "PLA + 30 % carbon fibre"]
        [voxels]
        size_mm = 1.0
        pattern = "{pattern}"
        "#
    ))
}

/// A heat-transfer deck of the strip; `procedure` is what stands below `*HEAT TRANSFER`.
fn deck(strip: &Strip, procedure: &str, hub: bool) -> String {
    let mesh = &strip.mesh;
    let used = mesh.used_nodes();
    let [planes, levels, across] = mesh.node_counts();
    let mut deck = String::from("*NODE, NSET=NALL\n");
    for (n, _) in used.iter().enumerate().filter(|(_, u)| **u) {
        let [x, y, z] = mesh.position([n / (levels * across), n / across % levels, n % across]);
        writeln!(deck, "{}, {x:.12}, {y:.12}, {z:.12}", n + 1).unwrap();
    }
    for phase in 0..strip.phases.len() {
        writeln!(deck, "*ELEMENT, TYPE=C3D8, ELSET=PHASE{phase}").unwrap();
        for (cell, _) in mesh.materials().iter().enumerate().filter(|(_, m)| usize::from(**m) == phase && **m != VOID) {
            let nodes = mesh.deck_nodes(mesh.cell(cell)).map(|n| (n + 1).to_string()).join(", ");
            writeln!(deck, "{}, {nodes}", cell + 1).unwrap();
        }
    }
    let k = strip.property(Property::Conductivity).unwrap();
    let c = strip.property(Property::HeatCapacity).unwrap();
    for phase in 0..strip.phases.len() {
        // Density one: the specific heat is then the capacity per volume. W, J and mm.
        writeln!(
            deck,
            "*MATERIAL, NAME=M{phase}\n*CONDUCTIVITY\n{:.9e}\n*SPECIFIC HEAT\n{:.9e}\n*DENSITY\n1.\n\
             *SOLID SECTION, ELSET=PHASE{phase}, MATERIAL=M{phase}",
            k[phase], c[phase]
        )
        .unwrap();
    }
    writeln!(deck, "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nNALL, {START}\n*STEP, INC=10000\n{procedure}\n*BOUNDARY")
        .unwrap();
    let ends: &[(usize, f64)] = if hub { &[(0, RIM), (planes - 1, START)] } else { &[(0, RIM)] };
    for (plane, value) in ends {
        for n in plane_nodes(mesh, *plane).filter(|n| used[*n]) {
            writeln!(deck, "{}, 11, 11, {value}", n + 1).unwrap();
        }
    }
    deck.push_str("*NODE PRINT, NSET=NALL, FREQUENCY=100000\nNT\n*END STEP\n");
    deck
}

/// Temperatures at the last time that was printed; `None` without ccx.
fn run(deck: &str, nodes: usize) -> Option<Vec<f64>> {
    let program = std::env::var("VOXELASTICA_CCX").unwrap_or_else(|_| "ccx".to_owned());
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("job.inp"), deck).unwrap();
    let Ok(done) = Command::new(&program).arg("job").current_dir(folder.path()).output() else {
        println!("skipped: {program} is not installed");
        return None;
    };
    let log = String::from_utf8_lossy(&done.stdout).into_owned();
    let text = std::fs::read_to_string(folder.path().join("job.dat")).unwrap_or_else(|e| panic!("{e}: {log}"));
    let block = text.rfind("temperatures").unwrap_or_else(|| panic!("no temperatures: {log}"));
    let mut values = vec![f64::NAN; nodes];
    for line in text[block..].lines().skip(1).filter(|l| !l.trim().is_empty()) {
        let mut words = line.split_whitespace();
        let node: usize = words.next().unwrap().parse().unwrap();
        values[node - 1] = words.next().unwrap().parse().unwrap();
    }
    Some(values)
}

fn largest_difference(own: &[f64], other: &[f64], used: &[bool]) -> f64 {
    let pairs = own.iter().zip(other).zip(used).filter(|(_, used)| **used);
    pairs
        .map(|((a, b), _)| (a - b).abs() / (RIM - START))
        .fold(0.0, |m, d| if d.is_nan() { f64::NAN } else { d.max(m) })
}

#[test]
fn steady_heat_on_a_spoke_is_that_of_calculix() {
    for (pattern, shape) in [("random", Shape::Flat), ("through-thickness", Shape::Morphed)] {
        let strip = Strip::new(&spoke(pattern), Model::Voxel, shape, [1; 3]).unwrap();
        let mesh = &strip.mesh;
        let Some(theirs) = run(&deck(&strip, "*HEAT TRANSFER, STEADY STATE", true), mesh.nodes()) else { return };
        let mut boundary = Boundary::insulated(mesh);
        boundary.give_plane(mesh, 0, RIM);
        boundary.give_plane(mesh, mesh.cells()[0], START);
        let k = strip.property(Property::Conductivity).unwrap();
        let ours = solve(mesh, &k, &boundary, &SteadyOptions::default(), Watch::silent()).unwrap();
        let difference = largest_difference(&ours.values, &theirs, &mesh.used_nodes());
        println!(
            "{pattern}, {shape:?}: {} bricks, largest difference {:.5} % of the range",
            strip.mesh.materials().len(),
            100.0 * difference
        );
        assert!(difference < 1e-4, "{pattern}: {difference}");
    }
}

#[test]
fn a_spoke_warms_up_as_in_calculix() {
    let strip = Strip::new(&spoke("random"), Model::Voxel, Shape::Flat, [1; 3]).unwrap();
    let mesh = &strip.mesh;
    // Backward Euler there, of first order: steps of 1 s.
    let Some(theirs) = run(&deck(&strip, "*HEAT TRANSFER, DIRECT\n1., 200.", false), mesh.nodes()) else { return };
    let mut boundary = Boundary::insulated(mesh);
    boundary.give_plane(mesh, 0, RIM);
    let (k, c) = (strip.property(Property::Conductivity).unwrap(), strip.property(Property::HeatCapacity).unwrap());
    let problem = Transient {
        mesh,
        conductivities: &k,
        capacities: &c,
        storage: Storage::Lumped,
        boundary: &boundary,
        drive: Drive::Boundary,
        start: START,
    };
    let options = TransientOptions {
        tolerance: 1e-5,
        range: Some(RIM - START),
        first_step: 0.01,
        end: 400.0,
        solver: Tolerance { relative: 1e-5, iterations: 100 },
    };
    let mut ours = Vec::new();
    integrate(
        &problem,
        &options,
        &mut |step| {
            if step.to >= 200.0 {
                ours = step.field(200.0);
            }
            step.to < 200.0
        },
        Watch::silent(),
    )
    .unwrap();
    let difference = largest_difference(&ours, &theirs, &mesh.used_nodes());
    println!("after 200 s: largest difference {:.4} % of the range", 100.0 * difference);
    assert!(difference < 1e-3, "{difference}");
}
