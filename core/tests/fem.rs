//! Finite elements of the strip against closed forms: patch test, beam, circle, clamped elastica; the tangent against
//! differences; what is refused.

#[allow(dead_code, reason = "shared between test programs")]
mod common;

use std::sync::atomic::{AtomicUsize, Ordering};

use common::design;
use voxelastica_core::elastica::HubSupport;
use voxelastica_core::elastica::morph::Guide;
use voxelastica_core::fem::assembly::{State, forces, tangent};
use voxelastica_core::fem::element::{EnhancedBrick, Geometry, Isotropic, Law};
use voxelastica_core::fem::mesh::Mesh;
use voxelastica_core::fem::morph::{Lead, solve};
use voxelastica_core::fem::pattern::Pattern;
use voxelastica_core::fem::{FemError, Model, MorphOptions, MorphSolution};
use voxelastica_core::mesh::{Block, Spacing};
use voxelastica_core::progress::{never, unseen};
use voxelastica_core::results::verification::Model as Which;
use voxelastica_core::results::{EmbeddedOptions, EmbeddedVerification, compare, verify_embedded};
use voxelastica_core::target::MeridianPoint;
use voxelastica_core::{Design, Error};

/// A strip of one material; `elements` along, across and through it.
fn strip(size: [f64; 3], elements: [usize; 3], material: Isotropic, law: Law) -> Model {
    let [along, across, through] = elements;
    let widths = Spacing::Width(vec![size[1]; along + 1]);
    let mesh = Mesh::new(&Block::new(size[0], size[2], through, vec![across; along], widths));
    with_bricks(mesh, material, law)
}

fn with_bricks(mesh: Mesh, material: Isotropic, law: Law) -> Model {
    let brick = |element: &[u32; 8]| {
        EnhancedBrick::new(Geometry::of_hexahedron(&element.map(|n| mesh.nodes[n as usize])).unwrap(), material)
    };
    let bricks: Vec<EnhancedBrick> = mesh.elements.iter().map(brick).collect();
    let count = bricks.len();
    Model::new(mesh, law, bricks, (0..count as u32).collect(), vec![0; count])
}

/// Ends led along a curve given by its inclination; `hub` overrides where the hub ends up.
fn guide(length: f64, inclination: impl Fn(f64) -> f64, hub: Option<[f64; 2]>, support: HubSupport) -> Guide {
    let count = 401;
    let step = length / (count - 1) as f64;
    let (mut x, mut z) = (0.0, 0.0);
    let mut stations = Vec::new();
    for i in 0..count {
        let s = i as f64 * step;
        if i > 0 {
            let middle = inclination(s - 0.5 * step);
            x += step * middle.cos();
            z += step * middle.sin();
        }
        let curvature = (inclination(s + 1e-6) - inclination(s - 1e-6)) / 2e-6;
        stations.push(MeridianPoint { s, inclination: inclination(s), curvature, curvature_gradient: 0.0, x, z });
    }
    if let (Some([hub_x, hub_z]), Some(last)) = (hub, stations.last_mut()) {
        (last.x, last.z) = (hub_x, hub_z);
    }
    Guide::Target { stations, support }
}

fn solved(model: &Model, guide: &Guide) -> MorphSolution {
    solve(model, &Lead::new(guide, None), &MorphOptions::default(), &unseen).unwrap()
}

/// A block whose inner nodes, and those of free faces within them, are moved about.
fn distorted(elements: [usize; 3], material: Isotropic, law: Law) -> Model {
    let [along, across, through] = elements;
    let (width, thickness) = (3.0, 2.0);
    let widths = Spacing::Width(vec![width; along + 1]);
    let mut mesh = Mesh::new(&Block::new(8.0, thickness, through, vec![across; along], widths));
    for plane in 1..along {
        for node in mesh.plane(plane) {
            let place = mesh.nodes[node];
            let inside = [true, place[1].abs() < 0.49 * width, place[2].abs() < 0.49 * thickness];
            for k in (0..3).filter(|&k| inside[k]) {
                mesh.nodes[node][k] += 0.2 * ((17 * node + 5 * k) as f64).sin();
            }
        }
    }
    with_bricks(mesh, material, law)
}

#[test]
fn a_distorted_mesh_passes_the_patch_test_in_large_strains() {
    // Any homogeneous deformation leaves inner nodes without force, however the mesh is distorted.
    let deformation = [[1.2, 0.1, -0.15], [-0.2, 0.9, 0.05], [0.1, 0.25, 1.1]];
    for law in [Law::SaintVenantKirchhoff, Law::NeoHooke] {
        let model = distorted([4, 3, 3], Isotropic { modulus: 10.0, poisson: 0.3 }, law);
        let nodes = &model.mesh.nodes;
        let moved = |x: &[f64; 3]| [0, 1, 2].map(|k| (0..3).map(|j| deformation[k][j] * x[j]).sum::<f64>() - x[k]);
        let mut state = State::new(&model, nodes.iter().map(moved).collect());
        let found = forces(&model, &mut state, &never).unwrap().unwrap();
        let inner = |x: &[f64; 3]| x[0] > 0.1 && x[0] < 7.9 && x[1].abs() < 1.49 && x[2].abs() < 0.99;
        let left = nodes.iter().zip(&found.of_nodes).filter(|(x, _)| inner(x)).map(|(_, f)| f);
        let left: Vec<f64> = left.flatten().map(|f| f.abs()).collect();
        assert_eq!(left.len(), 3 * 3 * 2 * 2);
        let largest = left.iter().copied().fold(0.0, f64::max);
        println!("{law:?}: {largest:e} N left of {:e}", found.scale);
        assert!(largest < 1e-12 * found.scale, "{law:?}: {largest}");
    }

    // Rigid ends moved apart: without lateral contraction Hooke's law gives the same strain everywhere.
    let model = distorted([4, 2, 2], Isotropic { modulus: 10.0, poisson: 0.0 }, Law::SaintVenantKirchhoff);
    let stretch = 1.15;
    let found = solved(&model, &guide(8.0, |_| 0.0, Some([8.0 * stretch, 0.0]), HubSupport::Held));
    for (node, u) in model.mesh.nodes.iter().zip(&found.state.displacements) {
        let exact = [(stretch - 1.0) * (node[0] - 8.0), 0.0, 0.0];
        assert!((0..3).all(|k| (u[k] - exact[k]).abs() < 1e-6), "{u:?} {exact:?}");
    }
    let strain: f64 = 0.5 * (stretch * stretch - 1.0);
    let force = -found.reactions.rim.horizontal;
    assert!((force - stretch * 10.0 * strain * 6.0).abs() < 1e-5, "{force}");
    assert!((found.elements.principal_strains[3] - 0.15).abs() < 1e-7);
}

#[test]
fn a_guided_beam_has_its_closed_form_stiffness_and_converges() {
    // Both ends clamped, one moved sideways: F = 12 E I d / (L^3 (1 + 12 E I / (k G A L^2))), narrow and without
    // contraction.
    let (length, width, thickness, modulus) = (20.0, 0.5, 1.0, 100.0);
    let material = Isotropic { modulus, poisson: 0.0 };
    let sideways = 1e-4;
    let ends = guide(length, |_| 0.0, Some([length, sideways]), HubSupport::Held);
    let inertia = width * thickness * thickness * thickness / 12.0;
    let shear = 12.0 * modulus * inertia / (5.0 / 6.0 * material.shear() * width * thickness * length * length);
    let exact = 12.0 * modulus * inertia * sideways / (length.powi(3) * (1.0 + shear));
    let errors: Vec<f64> = [5, 10, 20, 40]
        .into_iter()
        .map(|along| {
            let model = strip([length, width, thickness], [along, 2, 2], material, Law::SaintVenantKirchhoff);
            let force = solved(&model, &ends).reactions.hub.vertical;
            (force / exact - 1.0).abs()
        })
        .collect();
    let order = (errors[0] / errors[2]).log2() / 2.0;
    println!("guided beam: errors {errors:?}, order {order:.2}");
    assert!(errors[3] < 2e-3, "{errors:?}");
    assert!(order > 1.7, "{errors:?}");
}

#[test]
fn a_strip_under_pure_bending_closes_to_half_a_circle() {
    let (length, modulus) = (40.0, 12.6);
    let ends = guide(length, |s| std::f64::consts::PI * (0.5 - s / length), None, HubSupport::Free);
    let radius = length / std::f64::consts::PI;
    let material = Isotropic { modulus, poisson: 0.0 };
    let mut errors = Vec::new();
    // The ends are led along the circle, which a chain of bricks closes to only as it gets finer.
    for along in [40, 80, 160] {
        let model = strip([length, 2.0, 0.5], [along, 2, 2], material, Law::SaintVenantKirchhoff);
        let found = solved(&model, &ends);
        let rim = found.reactions.rim;
        let bending = modulus * 2.0 * 0.5_f64.powi(3) / 12.0 / radius;
        println!("{along} along: {rim:?}, moment in closed form {bending}");
        assert!(rim.vertical.abs() < 1e-5 * bending, "{rim:?}");
        assert_eq!(found.negative, 0);
        let off = |p: &[f64; 3]| {
            let angle = p[0] / radius;
            (p[1] - radius * (1.0 - angle.cos())).hypot(p[2] - radius * angle.sin()) / length
        };
        errors.push([found.midline.iter().map(off).fold(0.0, f64::max), (-rim.moment / bending - 1.0).abs()]);
    }
    println!("half circle: errors of place and moment {errors:?}");
    // What is left does not vanish with the mesh: it is the thickness, (t/R)^2, that the closed form does not know.
    assert!(errors.iter().all(|[place, moment]| *place < 2e-4 && *moment < 5e-4), "{errors:?}");
}

#[test]
fn the_tangent_is_the_derivative_of_the_forces() {
    for (law, lift) in [(Law::SaintVenantKirchhoff, true), (Law::NeoHooke, false)] {
        let material = Isotropic { modulus: 3.0, poisson: 0.35 };
        let model = strip([6.0, 3.0, 1.0], [4, 2, 1], material, law);
        let pattern = Pattern::new(&model.mesh, lift, &never).unwrap();
        let displaced = (0..model.mesh.nodes.len()).map(|n| [0, 1, 2].map(|k| 0.1 * ((3 * n + 7 * k) as f64).sin()));
        let mut state = State::new(&model, displaced.collect());
        let mut values = vec![0.0; pattern.rows.len()];
        forces(&model, &mut state, &never).unwrap().unwrap();
        assert!(tangent(&model, &pattern, &state, &mut values, &never).unwrap());
        let residual = |step: f64, direction: &[f64]| {
            let mut moved = state.clone();
            pattern.spread(direction, step, &mut moved.displacements);
            pattern.gather(&forces(&model, &mut moved, &never).unwrap().unwrap().of_nodes)
        };
        for seed in 0..3 {
            let direction: Vec<f64> = (0..pattern.unknowns()).map(|i| ((5 * i + seed) as f64).cos()).collect();
            let exact = pattern.multiply(&values, &direction);
            let (ahead, behind) = (residual(1e-5, &direction), residual(-1e-5, &direction));
            let largest = exact.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
            for i in 0..exact.len() {
                let slope = (ahead[i] - behind[i]) / 2e-5;
                assert!((slope - exact[i]).abs() < 1e-6 * largest, "{law:?} {i}: {slope} {}", exact[i]);
            }
        }
    }
}

fn verified(design: &Design, model: Which) -> EmbeddedVerification {
    verify_embedded(design, &EmbeddedOptions { model, ..EmbeddedOptions::default() }, &unseen).unwrap()
}

/// The hemisphere's strip, 40 mm long.
fn hemisphere(more: &str, pattern: &str) -> Design {
    design(&format!(
        "[target]\nkind = \"hemi-ellipsoid\"\n[strips]\ncount = 8\nlength_mm = 40.0\nhub_radius_mm = 4.0\nthickness_mm = \
         2.0\n[materials]\nphases = [\"FLX9070\", \"FLX9095\"]\n[voxels]\nsize_mm = 1.0\npattern = \"{pattern}\"\n{more}"
    ))
}

#[test]
fn a_voxel_hemisphere_takes_its_shape_with_the_designed_forces() {
    let design = hemisphere("", "random");
    let solved = verified(&design, Which::Voxel);
    let (figures, record) = (&solved.verification, solved.verification.embedded.as_ref().unwrap());
    println!("hemisphere: {:.3} %, {} iterations", figures.max_error_percent, figures.iterations);
    assert!(figures.max_error_percent < 1.0 && figures.iterations <= 6 && figures.increments == 1);
    assert!(!record.unstable_branch && record.residual < 1e-6 && record.warnings.is_empty());
    // In equilibrium both ends carry the same force; a free hub carries none upward.
    let reactions = solved.solution.reactions;
    let hub = solved.solution.midline.last().unwrap();
    assert!((reactions.rim.horizontal - reactions.hub.horizontal).abs() < 1e-6 * reactions.rim.horizontal.abs());
    assert!(reactions.hub.vertical.abs() < 1e-6 * reactions.rim.horizontal.abs());
    let moment = reactions.rim.moment - reactions.rim.horizontal * hub[2] - reactions.rim.vertical * hub[1];
    assert!((moment - reactions.hub.moment).abs() < 1e-5 * reactions.rim.moment.abs(), "{reactions:?}");
    // A random mixture is softer than its mean modulus says, but not by half.
    let ratio = reactions.rim.moment / design.forces().rim_moment;
    assert!(ratio > 0.8 && ratio < 1.05, "{ratio}");
    // Once more, byte for byte.
    let again = verified(&design, Which::Voxel);
    assert_eq!(again.solution.midline, solved.solution.midline);
    let (mut one, mut other) = (Vec::new(), Vec::new());
    solved.write_vtu(&mut one).unwrap();
    again.write_vtu(&mut other).unwrap();
    assert_eq!(one, other);
}

#[test]
fn the_path_from_flat_ends_where_the_prediction_leads() {
    let design = hemisphere("[thrust]\nhub = \"held\"", "split");
    let direct = verified(&design, Which::Voxel);
    let mut options = EmbeddedOptions::default();
    options.morph.from_flat = true;
    let led = verify_embedded(&design, &options, &unseen).unwrap();
    assert!(led.verification.increments > 1 && direct.verification.increments == 1);
    for (a, b) in direct.solution.midline.iter().zip(&led.solution.midline) {
        assert!((a[1] - b[1]).hypot(a[2] - b[2]) < 1e-5, "{a:?} {b:?}");
    }
}

#[test]
fn an_odd_number_of_layers_is_solved_without_doubling_the_mesh() {
    let design = design(
        "[target]\nkind = \"hemi-ellipsoid\"\n[strips]\ncount = 8\nlength_mm = 30.0\nhub_radius_mm = 3.0\nthickness_mm = \
         1.5\n[materials]\nphases = [\"FLX9070\", \"FLX9095\"]\n[voxels]\nsize_mm = 0.5\npattern = \"centred\"",
    );
    let solved = verified(&design, Which::Voxel);
    assert_eq!(solved.model.mesh.elements.len(), design.grid().phases().len());
    assert!(solved.verification.max_error_percent < 1.0, "{}", solved.verification.max_error_percent);
}

#[test]
fn clamped_strips_take_the_elastica_s_shape() {
    for ratio in ["0.5", "1.0", "2.0"] {
        let design = design(&format!(
            "[target]\nkind = \"strip\"\nwidth_mm = 12.0\nmodulus_ratio = {ratio}\nshortening = 0.6\n[strips]\nlength_mm = \
             40.0\nthickness_mm = 2.0\n[materials]\nphases = [\"FLX9070\", \"FLX9095\"]\n[voxels]\nsize_mm = 1.0\n[decks]\n\
             calculix_graded_elements = [40, 12, 2]"
        ));
        let solved = verified(&design, Which::Graded);
        assert_eq!(solved.model.law, Law::NeoHooke);
        let name = format!(
            "{}/tests/fixtures/reference/rectangular_{}.csv",
            env!("CARGO_MANIFEST_DIR"),
            ratio.trim_end_matches(".0")
        );
        let text = std::fs::read_to_string(name).unwrap();
        let rows: Vec<[f64; 4]> = text
            .lines()
            .skip(1)
            .map(|line| line.split(',').map(|w| w.parse().unwrap()).collect::<Vec<f64>>().try_into().unwrap())
            .collect();
        let off = solved.solution.midline.iter().map(|[s, x, z]| {
            let at = s / 40.0 * (rows.len() - 1) as f64;
            let i = (at as usize).min(rows.len() - 2);
            let value = |k: usize| rows[i][k] + (at - i as f64) * (rows[i + 1][k] - rows[i][k]);
            (x / 40.0 - value(2)).hypot(z / 40.0 - value(3))
        });
        let largest = off.fold(0.0, f64::max);
        let figures = &solved.verification;
        println!(
            "clamped, ratio {ratio}: {:.2} % of L off the published shape, {} iterations",
            100.0 * largest,
            figures.iterations
        );
        assert!(largest < 0.012, "{ratio}: {largest}");
        let record = figures.embedded.as_ref().unwrap();
        assert!(!record.unstable_branch && record.warnings.is_empty(), "{ratio}: {:?}", record.warnings);
    }
}

#[test]
fn a_strain_beyond_what_a_phase_stands_is_a_warning() {
    let custom = |limit: f64| {
        format!(
            "[[materials.custom]]\nname = \"soft\"\nmodulus_mpa = 3.1\npoisson = 0.45\nmax_strain = {limit}\n\
             [[materials.custom]]\nname = \"rigid\"\nmodulus_mpa = 12.6\npoisson = 0.3"
        )
    };
    let text = |limit: f64| {
        format!(
            "[target]\nkind = \"hemi-ellipsoid\"\n[strips]\ncount = 8\nlength_mm = 30.0\nhub_radius_mm = 3.0\nthickness_mm = \
             2.0\n[materials]\nphases = [\"soft\", \"rigid\"]\n{}\n[voxels]\nsize_mm = 1.0",
            custom(limit)
        )
    };
    let warnings = |limit: f64| verified(&design(&text(limit)), Which::Voxel).verification.embedded.unwrap().warnings;
    assert!(warnings(0.5).is_empty());
    let found = warnings(0.02);
    assert!(found.len() == 1 && found[0].contains("SOFT") && found[0].contains("max_strain"), "{found:?}");
}

#[test]
fn what_does_not_fit_is_refused_and_what_is_cancelled_stops() {
    let design = hemisphere("", "random");
    let mut options = EmbeddedOptions::default();
    options.morph.memory_limit = Some(1_000_000);
    let refused = verify_embedded(&design, &options, &unseen).unwrap_err();
    assert_eq!(refused.exit_code(), 2);
    assert!(refused.to_string().contains("GB") && refused.to_string().contains("larger voxels"), "{refused}");

    // Asked often: many times an iteration.
    let asked = AtomicUsize::new(0);
    let whole = verify_embedded(&design, &EmbeddedOptions::default(), &|share| {
        assert!((0.0..=1.0).contains(&share));
        asked.fetch_add(1, Ordering::Relaxed);
        true
    });
    assert!(whole.is_ok() && asked.load(Ordering::Relaxed) > 20, "{asked:?}");
    for stop in [0, 1, 7, 20] {
        let asked = AtomicUsize::new(0);
        let go_on = |_| asked.fetch_add(1, Ordering::Relaxed) < stop;
        let stopped = alone(|| verify_embedded(&design, &EmbeddedOptions::default(), &go_on));
        assert!(matches!(stopped, Err(Error::Cancelled)));
        assert_eq!(asked.load(Ordering::Relaxed), stop + 1);
    }
}

/// Runs work in a single thread: of several, each may have a question on its lips when another is told no.
fn alone<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap().install(work)
}

#[test]
fn a_strip_that_cannot_take_its_ends_says_where_and_what_was_tried() {
    // The hub is to be further away than the strip is long, by far: the neo-Hookean law has an answer, the path is short
    // of steps only where elements would fold; a rim turned by ten turns is one.
    let material = Isotropic { modulus: 1.0, poisson: 0.3 };
    let model = strip([6.0, 2.0, 2.0], [3, 2, 2], material, Law::NeoHooke);
    let ends = guide(6.0, |s| 60.0 * (1.0 - s / 6.0), Some([-3.0, 0.0]), HubSupport::Held);
    let failed = solve(&model, &Lead::new(&ends, None), &MorphOptions::default(), &unseen).unwrap_err();
    let FemError::Diverged { fraction, tried, .. } = &failed else { panic!("{failed}") };
    assert!(*fraction > 0.0 && tried.contains("prediction") && tried.contains("from flat"), "{failed}");
}

#[test]
fn refinement_brings_the_strip_closer_and_is_computed_again_from_its_record() {
    let input = hemisphere("", "random").input().clone();
    let limits = voxelastica_core::Limits::default();
    let refined = voxelastica_core::refine::refine(&input, limits, 2, &EmbeddedOptions::default(), &unseen).unwrap();
    println!("refinement: {:?} % of L", refined.errors_percent);
    let best = refined.errors_percent.iter().copied().fold(f64::INFINITY, f64::min);
    assert!(best < 0.5 * refined.errors_percent[0], "{:?}", refined.errors_percent);
    // The record alone gives the same voxels, and they are what was solved.
    let text = serde_json::to_string(refined.design.input()).unwrap();
    let again: voxelastica_core::DesignInput = serde_json::from_str(&text).unwrap();
    let again = Design::compute(&again, limits).unwrap();
    assert_eq!(again.grid(), refined.design.grid());
    let figures = compare(again.profile(), &verified(&again, Which::Voxel).solution.midline).unwrap();
    assert!((figures.max_error_percent - best).abs() < 1e-3, "{} {best}", figures.max_error_percent);
    let summary = voxelastica_core::output::Summary::of(&again).refinement.unwrap();
    assert_eq!(summary.error_after_percent, best);
    assert_eq!(summary.error_before_percent, refined.errors_percent[0]);
}

#[test]
fn a_single_no_ends_a_refinement_wherever_it_is() {
    let input = design(
        "[target]\nkind = \"hemi-ellipsoid\"\n[strips]\ncount = 8\nlength_mm = 20.0\nhub_radius_mm = 2.0\nthickness_mm = \
         1.0\n[materials]\nphases = [\"FLX9070\", \"FLX9095\"]\n[voxels]\nsize_mm = 0.5\n",
    );
    let (limits, options) = (voxelastica_core::Limits::default(), EmbeddedOptions::default());
    let run = |stop: usize| {
        let asked = AtomicUsize::new(0);
        let go_on = |_| asked.fetch_add(1, Ordering::Relaxed) != stop;
        let done = alone(|| voxelastica_core::refine::refine(input.input(), limits, 1, &options, &go_on));
        (done, asked.into_inner())
    };
    let (whole, asked) = run(usize::MAX);
    assert!(whole.is_ok());
    // Many of the questions are asked while the next voxels are chosen among dozens of designs.
    for stop in (0..16).map(|i| asked * i / 16) {
        let (stopped, asked) = run(stop);
        assert!(matches!(stopped, Err(Error::Cancelled)), "{stop}");
        assert_eq!(asked, stop + 1);
    }
}
