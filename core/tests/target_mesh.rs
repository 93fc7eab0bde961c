//! Meridians from meshes: axis, roundness and outer surface on shapes with known answers.

use std::f64::consts::{FRAC_PI_2, TAU};

use proptest::prelude::*;
use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::{Rng, SeedableRng};
use voxelastica_core::target::{Axis, FittedMeridian, MeridianCurve, TargetError, TriangleMesh};

/// A surface swept by `[rho, z]` points about z over `turn` radians; points on the axis become poles.
fn swept(profile: &[[f64; 2]], segments: usize, turn: f64) -> TriangleMesh {
    let mut mesh = TriangleMesh::default();
    let closed = (turn - TAU).abs() < 1e-9;
    let columns = if closed { segments } else { segments + 1 };
    let mut rings: Vec<Vec<u32>> = Vec::new();
    for [rho, z] in profile {
        let pole = rho.abs() < 1e-12;
        let first = mesh.vertices.len() as u32;
        let count = if pole { 1 } else { columns };
        for j in 0..count {
            let q = turn * j as f64 / segments as f64 + 0.123;
            mesh.vertices.push([rho * q.cos(), rho * q.sin(), *z]);
        }
        rings.push((0..columns as u32).map(|j| if pole { first } else { first + j }).collect());
    }
    for pair in rings.windows(2) {
        for j in 0..segments {
            let k = if closed { (j + 1) % segments } else { j + 1 };
            let (a, b, c, d) = (pair[0][j], pair[0][k], pair[1][k], pair[1][j]);
            for t in [[a, b, c], [a, c, d]] {
                if t[0] != t[1] && t[1] != t[2] && t[2] != t[0] {
                    mesh.triangles.push(t);
                }
            }
        }
    }
    mesh
}

fn arc(a: f64, b: f64, from: f64, to: f64, count: usize) -> Vec<[f64; 2]> {
    (0..=count)
        .map(|i| from + (to - from) * i as f64 / count as f64)
        .map(|q| [if (q - FRAC_PI_2).abs() < 1e-12 { 0.0 } else { a * q.cos() }, b * q.sin()])
        .collect()
}

/// Rotates and moves by something that is no special angle.
fn moved(mut mesh: TriangleMesh) -> TriangleMesh {
    let rotation = nalgebra::Rotation3::from_euler_angles(0.7, -1.1, 2.3);
    for v in &mut mesh.vertices {
        let p = rotation * nalgebra::Vector3::from(*v) * 37.0 + nalgebra::Vector3::new(120.0, -45.0, 300.0);
        *v = p.into();
    }
    mesh
}

fn moved_axis() -> nalgebra::Vector3<f64> {
    nalgebra::Rotation3::from_euler_angles(0.7, -1.1, 2.3) * nalgebra::Vector3::z()
}

fn noisy(mut mesh: TriangleMesh, sigma: f64, seed: u64) -> TriangleMesh {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
    let mut normal = || (0..12).map(|_| random.next_u64() as f64 / u64::MAX as f64).sum::<f64>() - 6.0;
    for v in &mut mesh.vertices {
        *v = v.map(|c| c + sigma * normal());
    }
    mesh
}

fn fit(mesh: &TriangleMesh, axis: Axis) -> Result<FittedMeridian, TargetError> {
    FittedMeridian::from_mesh(&mesh.vertices, &mesh.triangles, axis, 100.0, 10.0)
}

/// Largest distance between a fitted meridian and the one fitted to the profile's own points, mm, from the rim.
fn difference(fitted: &FittedMeridian, profile: &[[f64; 2]]) -> f64 {
    let reference = FittedMeridian::from_points(profile, 100.0, 10.0).expect("the profile itself");
    let pairs = fitted.curve.stations(201).into_iter().zip(reference.curve.stations(201));
    pairs.map(|(a, b)| (a.x - b.x).hypot(a.z - b.z)).fold(0.0, f64::max)
}

fn tilt_deg(fitted: &FittedMeridian, axis: nalgebra::Vector3<f64>) -> f64 {
    let direction = nalgebra::Vector3::from(fitted.revolution.expect("a mesh").axis_direction);
    direction.cross(&axis).norm().atan2(direction.dot(&axis)).to_degrees()
}

fn shapes() -> Vec<(&'static str, Vec<[f64; 2]>)> {
    // The paper's nose cone, walked from the rim by its inclination polynomial; hub radius 5 % of the length.
    let coefficients = [26.52, -116.3, 162.3, -132.0, 63.5, -47.14, 18.64, 41.56];
    let mut nose = vec![[0.0_f64, 0.0_f64]];
    let count = 2000;
    for i in 0..count {
        let xi = (f64::from(i) + 0.5) / f64::from(count);
        let theta: f64 = coefficients.iter().fold(0.0, |sum: f64, c| sum * xi + c).to_radians();
        let [x, z] = *nose.last().expect("not empty");
        nose.push([x + theta.cos() / f64::from(count), z + theta.sin() / f64::from(count)]);
    }
    let width = nose.last().expect("not empty")[0];
    let nose: Vec<[f64; 2]> = nose.iter().step_by(40).map(|[x, z]| [0.05 + width - x, *z]).collect();
    vec![
        ("cap", arc(1.0, 1.0, 0.9, FRAC_PI_2, 24)),
        ("hemisphere", arc(1.0, 1.0, 0.0, FRAC_PI_2, 24)),
        ("onion", arc(1.0, 1.0, -0.4, FRAC_PI_2, 30)),
        ("flat ellipsoid", arc(2.0, 1.0, 0.0, FRAC_PI_2, 32)),
        ("tall ellipsoid", arc(0.5, 1.0, 0.0, FRAC_PI_2, 32)),
        ("nose cone", nose),
    ]
}

#[test]
fn known_shapes_are_found_wherever_they_are() {
    for (name, profile) in shapes() {
        let mesh = moved(swept(&profile, 48, TAU));
        let fitted = fit(&mesh, Axis::Auto).unwrap_or_else(|e| panic!("{name}: {e}"));
        let (gap, tilt) = (difference(&fitted, &profile), tilt_deg(&fitted, moved_axis()));
        let share = fitted.revolution.expect("a mesh").rms_share;
        assert!(gap < 0.05 && tilt < 0.01 && share < 1e-3, "{name}: {gap} {tilt} {share}");
    }
}

#[test]
fn upside_down_is_turned_unless_the_axis_says_so() {
    let profile = arc(1.0, 1.0, 0.0, FRAC_PI_2, 24);
    let mut mesh = swept(&profile, 48, TAU);
    mesh.vertices.iter_mut().for_each(|v| v[2] = -v[2]);
    for axis in [Axis::Auto, Axis::Z, Axis::Vector([0.0, 0.0, -2.0])] {
        let fitted = fit(&mesh, axis).unwrap_or_else(|e| panic!("{axis:?}: {e}"));
        assert!(tilt_deg(&fitted, -nalgebra::Vector3::z()) < 0.01 && difference(&fitted, &profile) < 0.01);
    }
    let error = fit(&mesh, Axis::Vector([0.0, 0.0, 1.0])).map(drop).expect_err("the wrong way");
    assert!(matches!(error, TargetError::AxisReversed { .. }), "{error}");
}

#[test]
fn bases_lids_and_inner_surfaces_do_not_count() {
    for (name, profile) in shapes() {
        // Closed by a flat base with rings of its own, and by one without.
        let mut based: Vec<[f64; 2]> = (0..8).map(|i| [profile[0][0] * f64::from(i) / 8.0, profile[0][1]]).collect();
        based.extend(&profile);
        let mut plain = vec![[0.0, profile[0][1]]];
        plain.extend(&profile);
        // A shell: the inner surface is the outer one, moved inward by 8 % of the rim radius.
        let inner = |w: &[[f64; 2]]| {
            let d = [w[1][0] - w[0][0], w[1][1] - w[0][1]];
            let n = 0.08 * profile[0][0] / d[0].hypot(d[1]);
            [(w[0][0] - n * d[1]).max(0.0), w[0][1] + n * d[0]]
        };
        let mut shell: Vec<[f64; 2]> = profile.clone();
        let mut back: Vec<[f64; 2]> = profile.windows(2).map(inner).take_while(|p| p[0] > 0.02).collect();
        back.push([0.0, back.last().map_or(0.0, |p| p[1])]);
        back.reverse();
        if profile.last().is_some_and(|p| p[0] > 0.0) {
            back.remove(0);
        }
        shell.extend(&back);
        shell.push(profile[0]);
        for (kind, closed) in [("based", based), ("plain", plain), ("shell", shell)] {
            let mesh = moved(swept(&closed, 48, TAU));
            let fitted = fit(&mesh, Axis::Auto).unwrap_or_else(|e| panic!("{kind} {name}: {e}"));
            let (gap, tilt) = (difference(&fitted, &profile), tilt_deg(&fitted, moved_axis()));
            assert!(gap < 0.1 && tilt < 0.05, "{kind} {name}: {gap} {tilt}");
        }
    }
}

#[test]
fn an_ellipse_is_found_to_half_a_percent() {
    for aspect in [0.5, 1.0, 2.0] {
        let mesh = moved(swept(&arc(aspect, 1.0, 0.0, FRAC_PI_2, 32), 64, TAU));
        let fitted = fit(&mesh, Axis::Auto).expect("an ellipsoid");
        let (a, b) = (aspect * 37.0 * fitted.scale, 37.0 * fitted.scale);
        let (mut shape, mut curvature) = (0.0_f64, 0.0_f64);
        for p in fitted.curve.stations(201) {
            let rho = fitted.curve.rim_radius() - p.x;
            shape = shape.max(((rho / a).hypot(p.z / b) - 1.0).abs());
            let q = (p.z / b).min(1.0).asin();
            let speed = (a * q.sin()).hypot(b * q.cos());
            curvature = curvature.max((p.curvature * speed.powi(3) / (a * b) + 1.0).abs());
        }
        assert!(shape < 1e-3 && curvature < 0.02, "{aspect}: {shape} {curvature}");
    }
}

#[test]
fn noise_of_a_hundredth_is_averaged() {
    for (seed, (name, profile)) in shapes().into_iter().enumerate() {
        let mesh = noisy(swept(&profile, 64, TAU), 0.01 * profile[0][0], seed as u64);
        let fitted = fit(&moved(mesh), Axis::Auto).unwrap_or_else(|e| panic!("{name}: {e}"));
        let (gap, tilt) = (difference(&fitted, &profile), tilt_deg(&fitted, moved_axis()));
        let share = fitted.revolution.expect("a mesh").rms_share;
        assert!(gap < 2.0 && tilt < 0.5 && (0.007..0.013).contains(&share), "{name}: {gap} {tilt} {share}");
    }
}

#[test]
fn vertices_need_not_lie_on_rings() {
    // Points spread over a hemisphere, and each row of a grid shifted and swayed; pole and rim stay.
    let mut mesh = swept(&arc(1.0, 1.0, 0.0, FRAC_PI_2, 30), 60, TAU);
    let last = mesh.vertices.len() - 1;
    for (i, v) in mesh.vertices.iter_mut().enumerate() {
        if i < 60 || i == last {
            continue;
        }
        let (z, q) = (v[2].asin(), v[1].atan2(v[0]));
        let (z, q) = (z + 0.02 * (3.0 * q + 7.0 * z).sin() * z.cos(), q + 0.03 * (5.0 * z).sin());
        *v = [z.cos() * q.cos(), z.cos() * q.sin(), z.sin()];
    }
    let fitted = fit(&moved(mesh), Axis::Auto).expect("a hemisphere");
    let gap = difference(&fitted, &arc(1.0, 1.0, 0.0, FRAC_PI_2, 200));
    assert!(gap < 0.05 && tilt_deg(&fitted, moved_axis()) < 0.2, "{gap}");
}

#[test]
fn parts_of_a_turn_need_the_direction_only() {
    for turn in [90.0_f64, 180.0, 270.0] {
        for (name, profile) in shapes() {
            let mesh = moved(swept(&profile, 24, turn.to_radians()));
            let fitted = fit(&mesh, Axis::Vector(moved_axis().into())).unwrap_or_else(|e| panic!("{name} {turn}: {e}"));
            let gap = difference(&fitted, &profile);
            assert!(gap < 0.3, "{turn} degrees of {name}: {gap}");
        }
    }
}

#[test]
fn what_is_not_round_is_refused_with_its_share() {
    let mut stretched = swept(&arc(1.0, 1.0, 0.0, FRAC_PI_2, 40), 80, TAU);
    stretched.vertices.iter_mut().for_each(|v| v[0] *= 1.1);
    let error = fit(&moved(stretched), Axis::Auto).map(drop).expect_err("an oval dome");
    let TargetError::NotARevolution { share_percent, .. } = error else { panic!("{error}") };
    // Normal deviation 0.05 cos(2 phi) sin(alpha)^2; sin^4 is 3/8 on average over even polar angles alpha:
    // 0.05 sqrt(1/2 3/8) / 1.05 = 2.06 %.
    assert!((share_percent - 2.06).abs() < 0.03, "{share_percent}");
    // A cube, coarse and fine.
    for count in [1, 2, 10] {
        let mut cube = TriangleMesh::default();
        for (axis, side) in [(0, 0.0), (0, 1.0), (1, 0.0), (1, 1.0), (2, 0.0), (2, 1.0)] {
            let first = cube.vertices.len() as u32;
            for i in 0..=count {
                for j in 0..=count {
                    let mut p = [side; 3];
                    p[(axis + 1) % 3] = f64::from(i) / f64::from(count);
                    p[(axis + 2) % 3] = f64::from(j) / f64::from(count);
                    cube.vertices.push(p);
                }
            }
            let at = |i: u32, j: u32| first + i * (count + 1) + j;
            for i in 0..count {
                for j in 0..count {
                    cube.triangles.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
                    cube.triangles.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
                }
            }
        }
        for axis in [Axis::Auto, Axis::Z] {
            assert!(fit(&moved(cube.clone()), axis).is_err(), "{count} {axis:?}");
        }
    }
}

#[test]
fn a_sphere_is_cut_at_its_equator() {
    let ball = moved(swept(&arc(1.0, 1.0, -FRAC_PI_2, FRAC_PI_2, 40), 48, TAU));
    let fitted = fit(&ball, Axis::Vector(moved_axis().into())).expect("a sphere");
    assert!(difference(&fitted, &arc(1.0, 1.0, 0.0, FRAC_PI_2, 40)) < 0.1);
}

#[test]
fn wrong_meshes_are_refused() {
    let good = swept(&arc(1.0, 1.0, 0.0, FRAC_PI_2, 12), 24, TAU);
    let refused = |mesh: &TriangleMesh, axis| fit(mesh, axis).map(drop).expect_err("wrong").to_string();
    assert!(refused(&TriangleMesh::default(), Axis::Auto).contains("0 vertices"));
    let mut mesh = good.clone();
    mesh.vertices[5][1] = f64::NAN;
    assert!(refused(&mesh, Axis::Auto).contains("vertex 5"));
    let mut mesh = good.clone();
    mesh.triangles[3][2] = 100_000;
    assert!(refused(&mesh, Axis::Auto).contains("triangle 3 refers to vertex 100000"));
    assert!(refused(&good, Axis::Vector([0.0; 3])).contains("no direction"));
    assert!(refused(&good, Axis::Vector([f64::NAN, 0.0, 1.0])).contains("no direction"));
    // All triangles without area; a flat disc; one triangle.
    let flat = TriangleMesh { vertices: vec![[0.0; 3]; 3], triangles: vec![[0, 1, 2]] };
    assert!(refused(&flat, Axis::Auto).contains("triangle"));
    let disc = swept(&[[0.0, 0.0], [0.5, 0.0], [1.0, 0.0]], 12, TAU);
    assert!(refused(&disc, Axis::Auto).contains("refine the mesh"));
    let one = TriangleMesh { vertices: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], triangles: vec![[0, 1, 2]] };
    assert!(refused(&one, Axis::Auto).contains("refine the mesh"));
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, cases: 64, ..ProptestConfig::default() })]

    #[test]
    fn no_mesh_makes_the_fit_panic(
        vertices in proptest::collection::vec(
            (-1.0..1.0, -1.0..1.0, prop_oneof![-1.0..1.0, Just(0.0)]).prop_map(<[f64; 3]>::from),
            30..120,
        ),
        corners in proptest::collection::vec(0_u32..130, 3..600),
        axis in prop_oneof![Just(Axis::Auto), Just(Axis::X), Just(Axis::Vector([1.0, 2.0, -1.0]))],
    ) {
        let triangles: Vec<[u32; 3]> = corners.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect();
        let _ = FittedMeridian::from_mesh(&vertices, &triangles, axis, 100.0, 10.0);
        let inside = |t: &&[u32; 3]| t.iter().all(|&i| (i as usize) < vertices.len());
        let triangles: Vec<[u32; 3]> = triangles.iter().filter(inside).copied().collect();
        let _ = FittedMeridian::from_mesh(&vertices, &triangles, axis, 100.0, 10.0);
    }

    #[test]
    fn position_and_size_do_not_matter(
        angles in [-3.0..3.0_f64, -3.0..3.0, -3.0..3.0],
        shift in [-1e3..1e3_f64, -1e3..1e3, -1e3..1e3],
        size in 1e-3..1e3_f64,
        aspect in 0.4..2.5_f64,
    ) {
        let profile = arc(aspect, 1.0, 0.0, FRAC_PI_2, 24);
        let mut mesh = swept(&profile, 32, TAU);
        let rotation = nalgebra::Rotation3::from_euler_angles(angles[0], angles[1], angles[2]);
        for v in &mut mesh.vertices {
            *v = (rotation * nalgebra::Vector3::from(*v) * size + nalgebra::Vector3::from(shift)).into();
        }
        let fitted = fit(&mesh, Axis::Auto).expect("an ellipsoid");
        prop_assert!(difference(&fitted, &profile) < 0.01);
        prop_assert!(tilt_deg(&fitted, rotation * nalgebra::Vector3::z()) < 0.01);
    }
}
