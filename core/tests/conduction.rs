//! Heat and current against closed forms.

use voxelastica_core::conduction::ConductionError;
use voxelastica_core::conduction::mesh::{BrickMesh, Geometry, VOID};
use voxelastica_core::conduction::pcg::{Tolerance, Watch};
use voxelastica_core::conduction::steady::{Boundary, Steady, SteadyOptions, solve};
use voxelastica_core::conduction::transient::{Drive, Storage, Transient, TransientOptions, integrate};

/// A strip of cubes of 0.5 mm whose materials depend on slice, layer and place across.
fn strip(cells: [usize; 3], material: impl Fn([usize; 3]) -> u16) -> BrickMesh {
    let mut materials = Vec::new();
    for i in 0..cells[0] {
        for k in 0..cells[1] {
            for j in 0..cells[2] {
                materials.push(material([i, k, j]));
            }
        }
    }
    BrickMesh::new(cells, materials, Geometry::Cubes(0.5)).unwrap()
}

/// One at the rim, zero at the far end.
fn ends(mesh: &BrickMesh) -> Boundary {
    let mut boundary = Boundary::insulated(mesh);
    boundary.give_plane(mesh, 0, 1.0);
    boundary.give_plane(mesh, mesh.cells()[0], 0.0);
    boundary
}

fn steady(mesh: &BrickMesh, conductivities: &[f64]) -> Result<Steady, ConductionError> {
    solve(mesh, conductivities, &ends(mesh), &SteadyOptions::default(), Watch::silent())
}

/// Numbers between 0 and 1 that look random.
fn random(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
    move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1_u64 << 53) as f64
    }
}

fn mixed(cells: [usize; 3], share: f64, seed: u64) -> BrickMesh {
    let mut next = random(seed);
    let materials = (0..cells.iter().product()).map(|_| u16::from(next() >= share)).collect();
    BrickMesh::new(cells, materials, Geometry::Cubes(0.5)).unwrap()
}

#[track_caller]
fn close(found: f64, exact: f64, tolerance: f64) {
    assert!((found / exact - 1.0).abs() < tolerance, "{found} instead of {exact}");
}

#[test]
fn phases_in_series_and_in_parallel_conduct_as_the_textbook_says() {
    let cells = [40, 4, 12];
    let (area, length, k) = (2.0 * 6.0, 20.0, [0.3155, 2.01]);
    let slices = strip(cells, |[i, ..]| u16::from(i % 5 < 2));
    close(steady(&slices, &k).unwrap().slice_flux[7], area / length / (0.6 / k[0] + 0.4 / k[1]), 1e-7);
    let layers = strip(cells, |[_, k, _]| u16::from(k == 1));
    close(steady(&layers, &k).unwrap().slice_flux[7], area / length * (0.75 * k[0] + 0.25 * k[1]), 1e-7);
    let lanes = strip(cells, |[.., j]| u16::from(j < 3));
    close(steady(&lanes, &k).unwrap().slice_flux[7], area / length * (0.75 * k[0] + 0.25 * k[1]), 1e-7);
}

#[test]
fn odd_numbers_of_cells_and_narrow_strips_are_solved_as_well() {
    for cells in [[7, 1, 1], [33, 3, 5], [1, 1, 1], [2, 9, 3], [65, 2, 17]] {
        let mesh = strip(cells, |_| 0);
        let exact = 2.0 * (cells[1] * cells[2]) as f64 * 0.25 / (0.5 * cells[0] as f64);
        close(steady(&mesh, &[2.0]).unwrap().slice_flux[0], exact, 1e-7);
    }
}

#[test]
fn contrasts_of_ten_to_the_sixteen_are_exact_where_the_answer_is_known() {
    let cells = [40, 4, 12];
    let (area, length, k) = (2.0 * 6.0, 20.0, [1e-7, 2.86e-23]);
    let slices = strip(cells, |[i, ..]| u16::from(i % 5 < 2));
    let found = steady(&slices, &k).unwrap();
    close(found.slice_flux[7], area / length / (0.6 / k[0] + 0.4 / k[1]), 1e-7);
    let apart = found.apart.unwrap();
    assert!(!apart.percolates && apart.floating == 7, "{apart:?}");
    let lanes = strip(cells, |[.., j]| u16::from(j < 3));
    let found = steady(&lanes, &k).unwrap();
    close(found.slice_flux[7], area / length * (0.75 * k[0] + 0.25 * k[1]), 1e-7);
    assert!(found.apart.unwrap().percolates);
    // Series of a conducting half beside an insulating half, then insulation all across.
    let both = strip(cells, |[i, _, j]| u16::from(i >= 20 || j < 6));
    let found = steady(&both, &k).unwrap();
    assert!(found.slice_flux.iter().all(|f| (f / found.slice_flux[0] - 1.0).abs() < 1e-5));
    assert!(found.imbalance < 1e-6);
}

#[test]
fn both_ways_of_solving_agree_where_both_work() {
    // 1e4 is solved in one system, a little more apart.
    let mesh = mixed([40, 4, 12], 0.3, 3);
    let one = steady(&mesh, &[1.0, 1.000_1e-4]).unwrap();
    let two = steady(&mesh, &[1.0, 0.999_9e-4]).unwrap();
    assert!(one.apart.is_none() && two.apart.is_some());
    close(one.slice_flux[0], two.slice_flux[0], 1e-4);
    // Without percolation.
    let mesh = mixed([40, 4, 12], 0.05, 3);
    let one = steady(&mesh, &[1.0, 1.000_1e-4]).unwrap();
    let two = steady(&mesh, &[1.0, 0.999_9e-4]).unwrap();
    assert!(two.apart.unwrap().floating > 10);
    close(one.slice_flux[0] / 1.000_1, two.slice_flux[0] / 0.999_9, 1e-4);
}

#[test]
fn three_phases_too_far_apart_are_refused_with_a_reason() {
    let mesh = strip([6, 2, 2], |[i, ..]| (i % 3) as u16);
    let error = steady(&mesh, &[1.0, 1e-8, 1e-16]).unwrap_err();
    assert!(matches!(error, ConductionError::Contrast { .. }), "{error}");
    // Two that are near each other are one group.
    steady(&mesh, &[1.0, 0.1, 1e-16]).unwrap();
}

#[test]
fn pure_phases_and_series_and_parallel_bound_every_mixture() {
    let k = [0.3155, 2.01];
    for (share, seed) in [(0.2, 1), (0.5, 2), (0.8, 3)] {
        let mesh = mixed([40, 4, 12], share, seed);
        let volumes = mesh.volumes(2);
        let f = volumes[0] / (volumes[0] + volumes[1]);
        let effective = steady(&mesh, &k).unwrap().slice_flux[0] * 20.0 / 12.0;
        let (series, parallel) = (1.0 / (f / k[0] + (1.0 - f) / k[1]), f * k[0] + (1.0 - f) * k[1]);
        assert!(k[0] < series && series < effective && effective < parallel && parallel < k[1]);
    }
}

#[test]
fn an_isolated_voxel_is_named() {
    let mesh = strip([10, 2, 6], |[i, k, j]| if j == 4 || (j == 5 && (i, k) != (3, 1)) { VOID } else { 0 });
    let error = steady(&mesh, &[1.0]).unwrap_err();
    assert_eq!(
        error,
        ConductionError::Isolated { voxels: 1, slice: 4, layer: 2, across: 6, quantity: "temperature" },
        "{error}"
    );
}

#[test]
fn a_bent_strip_conducts_as_a_part_of_a_ring() {
    // Between the ends of a sector of a ring: k w ln(r2/r1) / angle. At least of second order in the cells' size.
    let (radius, angle, thickness) = (10.0_f64, std::f64::consts::FRAC_PI_2, 4.0);
    let exact = 3.0 * ((radius + 0.5 * thickness) / (radius - 0.5 * thickness)).ln() / angle;
    let error = |n: usize| {
        let size_mm = thickness / n as f64;
        let midline = (0..=4 * n)
            .map(|i| {
                let at = angle * i as f64 / (4 * n) as f64;
                [radius * at.sin(), radius * (1.0 - at.cos()), at]
            })
            .collect();
        let cells = [4 * n, n, 2];
        let geometry = Geometry::Sections { midline, size_mm };
        let mesh = BrickMesh::new(cells, vec![0; cells.iter().product()], geometry).unwrap();
        let flux = steady(&mesh, &[3.0 / (2.0 * size_mm)]).unwrap().slice_flux[0];
        (flux / exact - 1.0).abs()
    };
    let errors = [4, 8, 16].map(error);
    println!("errors {errors:?}, orders {:.2} {:.2}", (errors[0] / errors[1]).log2(), (errors[1] / errors[2]).log2());
    assert!(errors[2] < 1e-3 && (errors[1] / errors[2]).log2() > 1.9);
}

#[test]
fn iterations_do_not_grow_with_the_mesh() {
    let count = |n: usize| steady(&mixed([20 * n, n, 6 * n], 0.5, 9), &[0.3155, 2.01]).unwrap().iterations.count;
    let counts = [2, 4, 8].map(count);
    println!("iterations {counts:?}");
    assert!(counts[2] as f64 <= 1.5 * counts[0] as f64, "{counts:?}");
}

/// A million voxels, for the developer: `--release --ignored --nocapture`.
#[test]
#[ignore = "long"]
fn a_million_voxels() {
    for n in [4, 8, 14, 20] {
        let mesh = mixed([20 * n, n, 6 * n], 0.5, 9);
        let start = std::time::Instant::now();
        let found = steady(&mesh, &[0.3155, 2.01]).unwrap();
        let seconds = start.elapsed().as_secs_f64();
        println!("{} voxels: {} iterations, {seconds:.2} s", mesh.materials().len(), found.iterations.count);
        assert!(found.iterations.count <= 12);
    }
}

/// Rise at the insulated end of a slab whose other end jumps by one at t = 0: Carslaw and Jaeger's series.
fn slab(fourier: f64) -> f64 {
    let term = |n: i32| {
        let m = (f64::from(n) + 0.5) * std::f64::consts::PI;
        2.0 * f64::from(1 - 2 * (n % 2)) / m * (-m * m * fourier).exp()
    };
    1.0 - (0..60).map(term).sum::<f64>()
}

#[test]
fn a_slab_warms_up_as_its_series_says() {
    // 40 mm long, alpha = 1 mm^2/s: Fourier number t / 1600 s.
    let mesh = strip([80, 1, 1], |_| 0);
    let mut boundary = Boundary::insulated(&mesh);
    boundary.give_plane(&mesh, 0, 393.15);
    let problem = Transient {
        mesh: &mesh,
        conductivities: &[1e-3],
        capacities: &[1e-3],
        storage: Storage::Lumped,
        boundary: &boundary,
        drive: Drive::Boundary,
        start: 316.15,
    };
    let options = TransientOptions {
        tolerance: 2e-6,
        range: Some(77.0),
        first_step: 0.01,
        end: 6000.0,
        solver: Tolerance { relative: 1e-5, iterations: 200 },
    };
    let end = mesh.node([80, 0, 0]);
    let times = [100.0, 300.0, 1000.0, 2000.0];
    let (mut worst, mut crossing) = (0.0_f64, None);
    let effort = integrate(
        &problem,
        &options,
        &mut |step| {
            for t in times.iter().filter(|t| **t > step.from && **t <= step.to) {
                let rise = (step.at_node(end, *t) - 316.15) / 77.0;
                println!("t = {t}: {rise:.6}, series {:.6}", slab(t / 1600.0));
                worst = worst.max((rise - slab(t / 1600.0)).abs());
            }
            let excess = |t: f64| (step.at_node(end, t) - 316.15) / 77.0 - 0.999;
            if crossing.is_none() && excess(step.to) >= 0.0 {
                let (mut low, mut high) = (step.from, step.to);
                for _ in 0..60 {
                    let middle = 0.5 * (low + high);
                    if excess(middle) < 0.0 { low = middle } else { high = middle }
                }
                crossing = Some(high);
            }
            crossing.is_none()
        },
        Watch::silent(),
    )
    .unwrap();
    // 1 - 4/pi exp(-pi^2 F / 4) = 0.999.
    let exact = 1600.0 * (4.0 / std::f64::consts::PI / 0.001).ln() * 4.0 / std::f64::consts::PI.powi(2);
    println!("critical time {crossing:?}, series {exact:.2}; {effort:?}");
    assert!(worst < 3e-4, "{worst}");
    close(crossing.unwrap(), exact, 1e-3);
}

const VACUUM: f64 = 8.854_187_8e-15;

/// Largest relative error of the rim's potential under 1 A that is switched on at t = 0.
fn charged(mesh: &BrickMesh, sigma: &[f64], epsilon: &[f64], drive: Drive, exact: impl Fn(f64) -> f64) -> f64 {
    let mut boundary = Boundary::insulated(mesh);
    boundary.give_plane(mesh, mesh.cells()[0], 0.0);
    boundary.load_rim(mesh, 1.0);
    if drive == Drive::Electrode {
        boundary.give_plane(mesh, 0, 0.0);
    }
    let problem = Transient {
        mesh,
        conductivities: sigma,
        capacities: epsilon,
        storage: Storage::Gradient,
        boundary: &boundary,
        drive,
        start: 0.0,
    };
    let options = TransientOptions {
        tolerance: 1e-5,
        range: None,
        first_step: 1e-6,
        end: 2e-3,
        solver: Tolerance { relative: 1e-5, iterations: 200 },
    };
    let rim = mesh.node([0, 1, 2]);
    let (mut worst, mut seen) = (0.0_f64, 0);
    let check = &mut |step: &voxelastica_core::conduction::transient::StepView<'_>| {
        for t in [1e-4_f64, 1e-3, 2e-3].iter().filter(|t| **t > step.from && **t <= step.to) {
            worst = worst.max((step.at_node(rim, *t) / exact(*t) - 1.0).abs());
            seen += 1;
        }
        true
    };
    let effort = integrate(&problem, &options, check, Watch::silent()).unwrap();
    println!("{drive:?}: {worst:.1e}, {effort:?}");
    assert_eq!(seen, 3);
    worst
}

#[test]
fn charges_relax_with_the_time_constant_of_their_phase() {
    // A uniform strip under a current: V(t) = R I (1 - exp(-t sigma / eps)), R = L / (sigma A).
    let mesh = strip([20, 2, 4], |_| 0);
    let (sigma, epsilon) = (1e-10, 3.4 * VACUUM);
    let exact = |t: f64| 10.0 / (sigma * 2.0) * (1.0 - (-t * sigma / epsilon).exp());
    for drive in [Drive::Boundary, Drive::Electrode] {
        assert!(charged(&mesh, &[sigma], &[epsilon], drive, exact) < 1e-3);
    }
}

/// Maxwell and Wagner's two layers. Across the current each charges on its own, and charge gathers between them; along it both
/// have one field and one time constant.
#[test]
fn charge_gathers_between_phases_as_maxwell_and_wagner_say() {
    let (sigma, epsilon) = ([1e-10, 3e-11], [3.4 * VACUUM, 7.0 * VACUUM]);
    let layers = strip([20, 2, 4], |[i, ..]| u16::from(i >= 8));
    let across = |t: f64| {
        let layer = |k: usize, d: f64| d / (sigma[k] * 2.0) * (1.0 - (-t * sigma[k] / epsilon[k]).exp());
        layer(0, 4.0) + layer(1, 6.0)
    };
    for drive in [Drive::Boundary, Drive::Electrode] {
        assert!(charged(&layers, &sigma, &epsilon, drive, across) < 1e-3);
    }
    let columns = strip([20, 2, 4], |[.., j]| u16::from(j >= 1));
    let total = |of: [f64; 2]| 0.25 * of[0] + 0.75 * of[1];
    let along = |t: f64| 10.0 / (total(sigma) * 2.0) * (1.0 - (-t * total(sigma) / total(epsilon)).exp());
    assert!(charged(&columns, &sigma, &epsilon, Drive::Electrode, along) < 1e-3);
}

#[test]
fn a_problem_too_large_for_memory_is_refused_before_it_starts() {
    let mesh = strip([20, 2, 4], |_| 0);
    let options = SteadyOptions { memory: Some(1 << 20), ..SteadyOptions::default() };
    let error = solve(&mesh, &[1.0], &ends(&mesh), &options, Watch::silent()).unwrap_err();
    assert!(matches!(error, ConductionError::Memory { .. }), "{error}");
}

#[test]
fn a_solution_stops_wherever_it_is_cancelled_and_asks_often() {
    use std::sync::atomic::{AtomicUsize, Ordering};
    let mesh = mixed([80, 4, 24], 0.5, 1);
    // In one system, and with the phases apart.
    for conductivities in [[1.0, 5.0], [1e-12, 1.0]] {
        let run = |stop: usize| {
            let asked = AtomicUsize::new(0);
            let progress = |_: f64| asked.fetch_add(1, Ordering::Relaxed) < stop;
            let watch = Watch { progress: &progress, span: [0.0, 1.0] };
            let found = solve(&mesh, &conductivities, &ends(&mesh), &SteadyOptions::default(), watch).map(|_| ());
            (found, asked.into_inner())
        };
        let (whole, questions) = run(usize::MAX);
        whole.unwrap();
        // Every application of the operator and every sweep of the smoother asks, and so does setting them up.
        assert!(questions > 100, "{questions}");
        for k in 0..60 {
            let stop = k * questions / 60;
            let (stopped, asked) = run(stop);
            assert_eq!(stopped, Err(ConductionError::Cancelled), "question {stop} of {questions}");
            // Threads that run already may ask once more each; nothing new begins.
            assert!(asked <= stop + 64, "{asked} questions, the answer to {stop} was no");
        }
    }
}
