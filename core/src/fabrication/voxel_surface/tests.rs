use std::collections::HashMap;
use std::f64::consts::{FRAC_PI_4, FRAC_PI_6};

use proptest::prelude::*;

use super::contact::{Octants, VOID};
use super::*;
use crate::fabrication::layout::Placement;
use crate::fabrication::stl::Frame;

type Point = [f64; 3];

fn surface(grid: &VoxelGrid) -> VoxelSurface<'_> {
    VoxelSurface::new(grid, 100.0).unwrap()
}

fn triangles(surface: &VoxelSurface<'_>, phase: u8) -> Vec<[Vertex; 3]> {
    let mut all = Vec::new();
    (0..surface.slabs()).for_each(|i| surface.slab(i).triangles(phase, &mut |t| all.push(t)));
    all
}

/// Every directed edge once and its opposite once, and one fan a vertex, whatever equality of vertices is used.
fn assert_manifold<K: std::hash::Hash + Eq + Copy + std::fmt::Debug>(triangles: &[[K; 3]], what: &str) {
    let mut next: HashMap<(K, K), K> = HashMap::new();
    for t in triangles {
        for k in 0..3 {
            let (a, b, c) = (t[k], t[(k + 1) % 3], t[(k + 2) % 3]);
            assert!(a != b, "{what}: collapsed triangle {t:?}");
            assert!(next.insert((a, b), c).is_none(), "{what}: edge {a:?} {b:?} twice");
        }
    }
    let mut fans: HashMap<K, (usize, K)> = HashMap::new();
    for (a, b) in next.keys() {
        assert!(next.contains_key(&(*b, *a)), "{what}: edge {a:?} {b:?} is open");
        let fan = fans.entry(*a).or_insert((0, *b));
        fan.0 += 1;
    }
    for (vertex, (count, first)) in fans {
        let (mut at, mut walked) = (next[&(vertex, first)], 1);
        while at != first {
            at = next[&(vertex, at)];
            walked += 1;
        }
        assert_eq!(walked, count, "{what}: two fans meet at {vertex:?}");
    }
}

/// A reader that welds corners in cells of a micrometre and drops triangles that collapse: every edge still has two.
fn assert_survives_welding(surface: &VoxelSurface<'_>, mesh: &[[Vertex; 3]], angle: f64, what: &str) {
    let placement = Placement { cosine: angle.cos(), sine: angle.sin(), shift: [30.25 * angle, 7.0 * angle, 0.0] };
    let frame = Frame::new(placement, surface.scale().edge_mm);
    let cell = |v: Vertex| {
        let place = frame.place(surface.lattice_point(&v), surface.offset(&v), v.contact);
        place.map(|c| (c as f32 / 0.001_f32).floor() as i32)
    };
    let mut edges: HashMap<([i32; 3], [i32; 3]), i32> = HashMap::new();
    for t in mesh.iter().map(|t| t.map(cell)) {
        if t[0] != t[1] && t[1] != t[2] && t[2] != t[0] {
            (0..3).for_each(|k| *edges.entry((t[k], t[(k + 1) % 3])).or_insert(0) += 1);
        }
    }
    for ((a, b), count) in &edges {
        assert_eq!((*count, edges.get(&(*b, *a))), (1, Some(&1)), "{what} at {angle}: edge {a:?} {b:?} welded");
    }
}

/// A cross of prisms on a spoke turned by 45 degrees, whose corners lay on the boundaries of a reader's cells.
#[test]
fn crossing_prisms_turned_by_45_degrees_survive_welding() {
    let mut grid = VoxelGrid::new(0.5, 2, vec![4, 3, 3, 1, 2, 2]);
    let slices: [&[u8]; 6] = [
        &[1, 0, 0, 1, 0, 1, 1, 0, 0, 0, 1, 1, 0, 0, 1, 1],
        &[1, 1, 0, 0, 1, 0, 1, 1, 1, 1, 1, 0],
        &[0, 1, 0, 1, 1, 0, 0, 0, 0, 1, 1, 0],
        &[0, 1, 1, 0],
        &[0, 1, 0, 0, 0, 0, 1, 1],
        &[0, 0, 1, 0, 0, 1, 0, 1],
    ];
    slices.iter().enumerate().for_each(|(i, labels)| grid.slice_mut(i).copy_from_slice(labels));
    let surface = surface(&grid);
    for turn in (0..8).map(|eighth| f64::from(eighth) * FRAC_PI_4) {
        for phase in 0..2 {
            assert_survives_welding(&surface, &triangles(&surface, phase), turn, &format!("phase {phase}"));
        }
    }
}

fn single(p: Point) -> [u32; 3] {
    p.map(|c| (c as f32 + 0.0).to_bits())
}

/// All that is asked of the surfaces of a grid.
fn assert_good(grid: &VoxelGrid, phases: u8, what: &str) {
    let surface = surface(grid);
    let mut total = 0.0;
    for phase in 0..phases {
        let mesh = triangles(&surface, phase);
        let what = format!("{what}, phase {phase}");
        assert_manifold(&mesh, &what);
        let turn = |p: Point| [0.8 * p[0] - 0.6 * p[1] + 100.0, 0.6 * p[0] + 0.8 * p[1], p[2]];
        for place in [&|p| p, &turn] as [&dyn Fn(Point) -> Point; 2] {
            let merged: Vec<[[u32; 3]; 3]> =
                mesh.iter().map(|t| t.map(|v| single(place(surface.position(&v))))).collect();
            assert_manifold(&merged, &format!("{what}, in single precision"));
        }
        // Of three phases, some contacts are too slender for a turned grid.
        let turned = [0.1, FRAC_PI_6, FRAC_PI_4, 2.2].into_iter().filter(|_| !grid.phases().contains(&2));
        for angle in [0.0, std::f64::consts::FRAC_PI_2].into_iter().chain(turned) {
            assert_survives_welding(&surface, &mesh, angle, &what);
        }
        let measure = surface.measure(phase);
        assert_eq!(measure.triangles, surface.count(phase, &crate::progress::never).unwrap());
        let cube = grid.size_mm().powi(3);
        let count = grid.phases().iter().filter(|p| **p == phase).count() as f64;
        let share = measure.volume_mm3 - count * cube;
        assert!(share.abs() <= 1e-4 * cube * (1.0 + grid.phases().len() as f64), "{what}: {share}");
        if phase == 0 {
            assert!(share >= -1e-12 * cube, "{what}: the softest phase lost {share}");
        }
        total += measure.volume_mm3;
    }
    let volume = grid.volume_mm3();
    assert!((total - volume).abs() < 1e-11 * volume.max(1.0), "{what}: phases fill {total} of {volume}");
}

/// A grid of two slices, two layers and two voxels across.
fn octants(labels: [u8; 8]) -> VoxelGrid {
    let mut grid = VoxelGrid::new(0.5, 2, vec![1, 1]);
    for (o, label) in labels.iter().enumerate() {
        let place = 2 * (o >> 2 & 1) + (o >> 1 & 1);
        grid.slice_mut(o & 1)[place] = *label;
    }
    grid
}

#[test]
fn every_configuration_of_two_and_three_phases_around_a_vertex_is_right() {
    for number in 0..3_usize.pow(8) {
        let labels: [u8; 8] = std::array::from_fn(|o| (number / 3_usize.pow(o as u32) % 3) as u8);
        assert_good(&octants(labels), 3, &format!("{labels:?}"));
    }
}

fn grids(phases: u8) -> impl Strategy<Value = VoxelGrid> {
    let widths = prop::collection::vec(1_usize..5, 1..7);
    (widths, 1_usize..4).prop_flat_map(move |(widths, layers)| {
        let empty = VoxelGrid::new(0.5, layers, widths);
        prop::collection::vec(0..phases, empty.phases().len()).prop_map(move |labels| {
            let mut grid = empty.clone();
            for i in 0..grid.slices() {
                let range = grid.offsets()[i]..grid.offsets()[i + 1];
                grid.slice_mut(i).copy_from_slice(&labels[range]);
            }
            grid
        })
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 96, ..ProptestConfig::default() })]

    #[test]
    fn random_grids_of_two_phases_have_manifold_complementary_surfaces(grid in grids(2), slices in 1_usize..4) {
        assert_good(&grid, 2, "two phases");
        let mut surface = surface(&grid);
        surface.slices_per_slab = slices;
        for phase in 0..2 {
            assert_manifold(&triangles(&surface, phase), "in slabs");
        }
    }

    #[test]
    fn random_grids_of_three_phases_have_manifold_complementary_surfaces(grid in grids(3), slices in 1_usize..4) {
        assert_good(&grid, 3, "three phases");
        let mut surface = surface(&grid);
        surface.slices_per_slab = slices;
        for phase in 0..3 {
            assert_manifold(&triangles(&surface, phase), "in slabs");
        }
    }

    #[test]
    fn points_lie_in_the_solid_of_their_voxels_phase_and_in_no_other(
        grid in grids(3), points in prop::collection::vec([0.01_f64..0.99, 0.01..0.99, 0.01..0.99], 40),
    ) {
        let surface = surface(&grid);
        let meshes: Vec<Vec<[Point; 3]>> = (0..3)
            .map(|p| triangles(&surface, p).iter().map(|t| t.map(|v| surface.position(&v))).collect())
            .collect();
        let widest = *grid.half_widths().iter().max().unwrap() as f64;
        for [a, b, c] in points {
            let (s, y) = (a * grid.slices() as f64, (2.0 * b - 1.0) * widest);
            let z = c * grid.layers() as f64;
            // Away from where the rule for contacts changes anything.
            if [s, y, z].iter().any(|x| (x - x.round()).abs() < 0.01) {
                continue;
            }
            let (slice, half) = (s as usize, grid.half_widths()[s as usize] as f64);
            let label = if y.abs() < half {
                grid.slice(slice)[z as usize * 2 * half as usize + (y + half) as usize]
            } else {
                VOID
            };
            let point = [s * 0.5, y * 0.5, (z - 0.5 * grid.layers() as f64) * 0.5];
            for (phase, mesh) in meshes.iter().enumerate() {
                prop_assert_eq!(winding(mesh, point), i32::from(label == phase as u8));
            }
        }
    }
}

/// How often a surface winds around a point, by the solid angles of its triangles (van Oosterom and Strackee 1983).
fn winding(mesh: &[[Point; 3]], point: Point) -> i32 {
    let angle = |t: &[Point; 3]| {
        let [a, b, c] = t.map(|p| std::array::from_fn::<f64, 3, _>(|k| p[k] - point[k]));
        let dot = |a: Point, b: Point| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let [la, lb, lc] = [a, b, c].map(|v| dot(v, v).sqrt());
        let numerator = 6.0 * signed_volume(&[a, b, c]);
        2.0 * numerator.atan2(la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb)
    };
    (mesh.iter().map(angle).sum::<f64>() / (4.0 * std::f64::consts::PI)).round() as i32
}

#[test]
fn a_uniform_bar_is_one_box() {
    let grid = VoxelGrid::new(0.5, 4, vec![3; 20]);
    let measure = surface(&grid).measure(0);
    assert_eq!((measure.vertices, measure.triangles), (8, 12));
    assert!((measure.volume_mm3 - 20.0 * 6.0 * 4.0 * 0.125).abs() < 1e-10);
    assert_eq!(surface(&grid).measure(1), Measure::default());
}

#[test]
fn what_single_precision_cannot_hold_is_refused() {
    let grid = VoxelGrid::new(0.5, 4, vec![3; 20]);
    assert!(VoxelSurface::new(&grid, 500.0).is_ok());
    let error = VoxelSurface::new(&grid, 5000.0).unwrap_err();
    assert!(error.to_string().contains("5000 mm"), "{error}");
}

#[test]
fn void_is_a_label_of_its_own() {
    assert_eq!(Octants([VOID; 8]).code(), u16::MAX);
    assert!(template::template(u16::MAX).is_none());
}
