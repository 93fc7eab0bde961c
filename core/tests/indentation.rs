//! Domes pressed in finite elements: a clamped strip under a rigid plane in closed form, the hemisphere against CalculiX and between
//! the limits of the elastica, and what rounded voxels do.

#[allow(dead_code, reason = "shared between test programs")]
mod common;

use std::sync::atomic::{AtomicUsize, Ordering};

use common::design;
use voxelastica_core::fem::assembly::State;
use voxelastica_core::fem::contact::{Contact, Obstacle};
use voxelastica_core::fem::element::{EnhancedBrick, Geometry, Isotropic, Law};
use voxelastica_core::fem::mesh::Mesh;
use voxelastica_core::fem::newton::Solver;
use voxelastica_core::fem::{Model, MorphOptions, Resolution};
use voxelastica_core::indentation::solid::{SolidOptions, indent};
use voxelastica_core::indentation::{Indentation, IndentationError, elastica};
use voxelastica_core::input::{Bending, IndentationInput, Indenter};
use voxelastica_core::mesh::{Block, Spacing};
use voxelastica_core::progress::{never, unseen};
use voxelastica_core::{Design, fem::FemError};

fn hemisphere(length: f64, more: &str) -> Design {
    design(&format!(
        "[target]\nkind = \"hemi-ellipsoid\"\n[strips]\ncount = 8\nlength_mm = {length:?}\nhub_radius_mm = {:?}\nthickness_mm = \
         2.0\n[materials]\nphases = [\"FLX9070\", \"FLX9095\"]\n[voxels]\nsize_mm = 1.0\n{more}",
        0.1 * length
    ))
}

fn options(resolution: Resolution, neighbours: bool) -> SolidOptions {
    SolidOptions { resolution, neighbours, morph: MorphOptions::default() }
}

/// Work is energy within a hundredth of what was turned over: a preload that gives way takes part of it back.
fn balanced(found: &Indentation) {
    let [work, energy] = found.energy_balance();
    let turned = found.work_nmm.abs().max(energy.abs());
    assert!(
        (work - energy).abs() < 0.01 * turned,
        "{work} N mm of work, {energy} N mm of energy, {turned} turned over"
    );
}

#[test]
fn a_plane_presses_the_middle_of_a_clamped_strip_as_beams_say() {
    // E I = 10 * 2 * 1^3 / 12; F = 192 E I d / L^3 at a small depth d, and the rigid plane over the whole strip touches there only.
    let (length, width, thickness) = (40.0, 2.0, 1.0);
    let block = Block::new(length, thickness, 2, vec![2; 40], Spacing::Width(vec![width; 41]));
    let mesh = Mesh::new(&block);
    let material = Isotropic { modulus: 10.0, poisson: 0.0 };
    let brick = |e: &[u32; 8]| {
        EnhancedBrick::new(Geometry::of_hexahedron(&e.map(|n| mesh.nodes[n as usize])).unwrap(), material)
    };
    let bricks: Vec<EnhancedBrick> = mesh.elements.iter().map(brick).collect();
    let count = bricks.len();
    let model = Model::new(mesh, Law::SaintVenantKirchhoff, bricks, (0..count as u32).collect(), vec![0; count]);
    let mut solver = Solver::new(&model, false, None, &never).unwrap();
    let depth = 0.02;
    let middle = model.mesh.plane(20).end - 3..model.mesh.plane(20).end;
    let obstacle = |node| Obstacle { node, normal: [0.0, 0.0, 1.0], offset: 0.5 * thickness - depth, multiplier: 0.0 };
    solver.contact = Contact { obstacles: middle.map(obstacle).collect(), stiffness: 10.0 };
    let mut state = State::new(&model, vec![[0.0; 3]; model.mesh.nodes.len()]);
    let mut turns = 0;
    loop {
        solver.solve(&mut state, &never, &|_, _| {}).unwrap();
        turns += 1;
        if solver.contact.settle(&model.mesh, &state) < 1e-6 || turns == 20 {
            break;
        }
    }
    assert!(turns < 20);
    let force: f64 = solver.contact.forces(&model.mesh, &state).map(|(_, p)| p).sum();
    let beam = 192.0 * 10.0 * width * thickness.powi(3) / 12.0 * depth / length.powi(3);
    println!("{force:.6} N, beam {beam:.6} N, {turns} turns");
    assert!((force / beam - 1.0).abs() < 0.02, "{force} {beam}");
    // Half of it taken back, half of the force stays: the multipliers give way.
    solver.contact.obstacles.iter_mut().for_each(|o| o.offset += 0.5 * depth);
    for _ in 0..10 {
        solver.solve(&mut state, &never, &|_, _| {}).unwrap();
        solver.contact.settle(&model.mesh, &state);
    }
    let half: f64 = solver.contact.forces(&model.mesh, &state).map(|(_, p)| p).sum();
    assert!((half / force - 0.5).abs() < 0.01, "{half} {force}");
}

#[test]
fn the_hemisphere_is_calculix_s_between_the_limits_of_the_elastica() {
    let design = hemisphere(100.0, "");
    // Published for a largest modulus of 12.6 MPa.
    let scale = design.peak_modulus() / 12.6;
    let mesh = Resolution::Graded([60, 6, 2]);
    for (indenter, expected, tolerance) in [
        (Indenter::Hub, vec![(1.0, 0.0286), (10.0, 0.167)], 0.02),
        (Indenter::Flat, vec![(1.0, 0.0286), (5.0, 0.119), (10.0, 0.243)], 0.05),
    ] {
        let input = IndentationInput { indenter, steps: 20, ..IndentationInput::default() };
        let found = indent(&design, &input, &options(mesh, false), &unseen).unwrap();
        let plate = IndentationInput { bending: Bending::PlaneStrain, ..input.clone() };
        let limits = [input, plate].map(|input| elastica::indent(&design, &input, &unseen).unwrap());
        for (depth, calculix) in expected {
            let force = found.force_at(depth).unwrap();
            let [beam, plate] = [0, 1].map(|k| limits[k].force_at(depth).unwrap());
            println!("{indenter:?} {depth}: {:.5} N, CalculiX {calculix}", force / scale);
            assert!((force / scale / calculix - 1.0).abs() < tolerance, "{indenter:?}, {depth} mm: {}", force / scale);
            assert!(beam < force && force < plate, "{depth}: {beam} {force} {plate}");
        }
        balanced(&found);
        assert!(found.penetration_mm < 0.01 * 2.0);
        assert!(found.curve.iter().all(|p| p.contact_force_n >= 0.0));
        // Newton's method keeps its speed with contact.
        assert!(found.curve[2..].iter().all(|p| p.iterations <= 8), "{:?}", found.curve);
    }
}

#[test]
fn voxels_rounded_outward_press_on_their_neighbours() {
    let input = IndentationInput { steps: 16, depth_mm: Some(1.2), ..IndentationInput::default() };
    let rigidity = |rounding: &str, neighbours: bool| {
        let design = hemisphere(40.0, &format!("rounding = \"{rounding}\"\n"));
        let found = indent(&design, &input, &options(Resolution::Voxels(1), neighbours), &unseen).unwrap();
        balanced(&found);
        assert!(found.penetration_mm < 0.02);
        found.rigidity_n_mm
    };
    let [alone, between] = [false, true].map(|neighbours| rigidity("nearest", neighbours));
    let [inward_alone, inward_between] = [false, true].map(|neighbours| rigidity("inward", neighbours));
    println!("nearest {alone} {between}, inward {inward_alone} {inward_between}");
    assert!(between > 1.2 * alone);
    assert!(between / alone > inward_between / inward_alone);
}

#[test]
fn pressing_stops_wherever_it_is_cancelled() {
    let design = hemisphere(20.0, "");
    let input = IndentationInput { steps: 4, ..IndentationInput::default() };
    let run = |stop: usize| {
        let asked = AtomicUsize::new(0);
        let progress = |share: f64| {
            assert!((0.0..=1.0).contains(&share));
            asked.fetch_add(1, Ordering::Relaxed) < stop
        };
        let found = indent(&design, &input, &options(Resolution::Graded([12, 2, 2]), true), &progress).map(|_| ());
        (found, asked.into_inner())
    };
    let (whole, questions) = run(usize::MAX);
    whole.unwrap();
    for k in 0..40 {
        let (stopped, _) = run(k * questions / 40);
        let cancelled = [IndentationError::Cancelled, IndentationError::FiniteElements(FemError::Cancelled)];
        assert!(stopped.is_err_and(|e| cancelled.contains(&e)), "{k}");
    }
}
