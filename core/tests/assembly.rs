//! Base ring, hub and post: measured on the written meshes, and with the morphed spokes put into them.

use std::io::Cursor;
use std::path::Path;

use voxelastica_core::fabrication::assembly::Parts;
use voxelastica_core::fabrication::assembly::seat::{End, Seat};
use voxelastica_core::fabrication::layout::Placement;
use voxelastica_core::fabrication::solid::{Mesh, Point};
use voxelastica_core::fabrication::stl;
use voxelastica_core::input::FabricationInput;
use voxelastica_core::input::files::Format;
use voxelastica_core::output::Provenance;
use voxelastica_core::{Design, DesignInput, Limits, progress};

fn example(name: &str) -> Design {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../examples/{name}.toml"));
    Design::compute(&DesignInput::read(&path).unwrap(), Limits::default()).unwrap()
}

fn held(name: &str) -> Design {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../examples/{name}.toml"));
    let text = std::fs::read_to_string(path).unwrap();
    let text = if text.contains("[thrust]") { text } else { format!("{text}\n[thrust]\nhub = \"held\"\n") };
    let input = DesignInput::from_text(&text, Format::Toml, "held.toml", "held", Path::new(".")).unwrap();
    Design::compute(&input, Limits::default()).unwrap()
}

/// Triangles of the file a mesh is written to.
fn written(mesh: &Mesh) -> Vec<[Point; 3]> {
    let provenance = Provenance { version: "0".to_owned(), seed: 1, design_sha256: "0".repeat(64) };
    let mut file = Cursor::new(Vec::new());
    let body = stl::Body { solid: mesh, placement: Placement::IDENTITY };
    stl::write(&mut file, &provenance, &[body], &progress::never).unwrap();
    file.set_position(0);
    let read = stl_io::read_stl(&mut file).unwrap();
    read.validate().unwrap();
    let corner = |k: usize| read.vertices[k].0.map(f64::from);
    read.faces.iter().map(|f| f.vertices.map(corner)).collect()
}

fn sub(a: Point, b: Point) -> Point {
    std::array::from_fn(|k| a[k] - b[k])
}

fn dot(a: Point, b: Point) -> f64 {
    (0..3).map(|k| a[k] * b[k]).sum()
}

fn cross(a: Point, b: Point) -> Point {
    std::array::from_fn(|k| a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3])
}

/// Distance to the first face along a ray, and that face's unit normal (Moeller and Trumbore 1997).
fn hit(mesh: &[[Point; 3]], from: Point, direction: Point) -> Option<(f64, Point)> {
    let mut nearest: Option<(f64, Point)> = None;
    for [a, b, c] in mesh {
        let (e1, e2) = (sub(*b, *a), sub(*c, *a));
        let h = cross(direction, e2);
        let det = dot(e1, h);
        if det.abs() < 1e-12 {
            continue;
        }
        let s = sub(from, *a);
        let u = dot(s, h) / det;
        let q = cross(s, e1);
        let v = dot(direction, q) / det;
        let t = dot(e2, q) / det;
        if u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 1e-9 && nearest.is_none_or(|(best, _)| t < best) {
            let n = cross(e1, e2);
            let length = dot(n, n).sqrt();
            nearest = Some((t, n.map(|x| x / length)));
        }
    }
    nearest
}

/// How often a surface winds around a point.
fn winding(mesh: &[[Point; 3]], point: Point) -> i32 {
    let angle = |t: &[Point; 3]| {
        let [a, b, c] = t.map(|p| sub(p, point));
        let [la, lb, lc] = [a, b, c].map(|v| dot(v, v).sqrt());
        let denominator = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
        2.0 * dot(a, cross(b, c)).atan2(denominator)
    };
    (mesh.iter().map(angle).sum::<f64>() / (4.0 * std::f64::consts::PI)).round() as i32
}

/// Slant, radius, thickness and width of the slot of spoke 1, from rays shot inside it.
fn assert_slot(mesh: &[[Point; 3]], seat: &Seat, design: &Design, clearance: f64, what: &str) {
    let profile = design.profile();
    let at = if seat.end == End::Rim { 0 } else { profile.s.len() - 1 };
    let angle = profile.inclination[at];
    let (sin, cos) = angle.sin_cos();
    let inwards = if seat.end == End::Rim { 1.0 } else { -1.0 };
    let (along, normal) = ([-inwards * cos, 0.0, inwards * sin], [sin, 0.0, cos]);
    let start = |depth: f64, y: f64, across: f64| -> Point {
        let end = [profile.rho[at], 0.0, profile.z[at]];
        std::array::from_fn(|k| end[k] + depth * along[k] + across * normal[k] + if k == 1 { y } else { 0.0 })
    };
    let back = |v: Point| v.map(|x| -x);
    let middle = start(0.5 * seat.depth_mm, 0.1, 0.0);
    let (up, top) = hit(mesh, middle, normal).unwrap();
    let (down, bottom) = hit(mesh, middle, back(normal)).unwrap();
    let thickness = design.input().strips.thickness_mm;
    assert!((up + down - thickness - clearance).abs() < 0.01, "{what}: {up} {down}");
    assert!((up - down).abs() < 0.01, "{what}: not centred, {up} {down}");
    for face in [top, back(bottom)] {
        // The walls face into the slot: their normals are minus and plus the slot's.
        let slant = (-face[0]).atan2(-face[2]);
        let off = (slant - angle).to_degrees();
        assert!((off - 360.0 * (off / 360.0).round()).abs() < 0.1 && face[1].abs() < 1e-3, "{what}: {off} deg");
    }
    let (floor, face) = hit(mesh, middle, back(along)).unwrap();
    assert!((floor - 0.5 * seat.depth_mm).abs() < 0.01, "{what}: bottom at {floor}");
    assert!(dot(face, along) > 0.999_99);
    assert!(hit(mesh, start(seat.depth_mm + 0.01, 0.1, 0.0), back(along)).unwrap().0 > seat.depth_mm - 0.01);
    if seat.is_walled() {
        let half = 0.5 * seat.thickness_mm;
        let depth =
            if start(0.0, 0.0, half)[0] >= start(seat.depth_mm, 0.0, half)[0] { 0.02 } else { seat.depth_mm - 0.02 };
        let outermost = start(depth, 0.0, half - 0.003);
        let side = |y: f64| hit(mesh, outermost, [0.0, y, 0.0]).unwrap();
        let ((left, l), (right, r)) = (side(1.0), side(-1.0));
        assert!((left + right - seat.width_mm).abs() < 0.01, "{what}: width {left} {right} {}", seat.width_mm);
        assert!(l[1] < -0.9999 && r[1] > 0.9999);
        assert!(seat.width_mm >= profile.width[at] + clearance - 1e-9);
    }
}

/// Points of the thick, morphed spokes.
fn spoke_points(design: &Design) -> Vec<Point> {
    let profile = design.profile();
    let half = 0.5 * design.input().strips.thickness_mm - 1e-4;
    let mut points = Vec::new();
    for i in (0..profile.s.len()).step_by(4).chain(0..40).chain(960..1001) {
        let (sin, cos) = profile.inclination[i].sin_cos();
        for across in [-half, 0.0, half] {
            for share in [-0.4999, -0.27, 0.0, 0.38, 0.4999] {
                let radius = profile.rho[i] + across * sin;
                points.push([radius, share * profile.width[i], profile.z[i] + across * cos]);
            }
        }
    }
    points
}

fn assert_fits(design: &Design, what: &str) -> Parts {
    let input = FabricationInput::defaults().unwrap();
    let parts = Parts::of(design, &input).unwrap_or_else(|e| panic!("{what}: {e}"));
    let base = written(&parts.base_mesh().unwrap());
    let hub = written(&parts.hub_mesh().unwrap());
    assert_slot(&base, &parts.rim_seat, design, input.clearance_mm, &format!("{what}, base"));
    assert_slot(&hub, &parts.hub_seat, design, input.clearance_mm, &format!("{what}, hub"));
    let post = parts.post_mesh().map(|mesh| written(&mesh.unwrap()));
    for point in spoke_points(design) {
        // The bottoms of the slots touch the spoke's ends.
        let close = |seat: &Seat| seat.within(point[0], point[2])[0].abs() < 1e-3;
        if close(&parts.rim_seat) || close(&parts.hub_seat) {
            continue;
        }
        assert_eq!(winding(&base, point), 0, "{what}: the base cuts {point:?}");
        assert_eq!(winding(&hub, point), 0, "{what}: the hub cuts {point:?}");
        if let Some(post) = &post {
            assert_eq!(winding(post, point), 0, "{what}: the post cuts {point:?}");
        }
    }
    parts
}

#[test]
fn slots_are_where_the_design_says_and_spokes_sit_in_them() {
    for name in ["hemisphere", "nose_cone", "trumpet", "roof", "hemi_ellipsoid_2.0", "points"] {
        let parts = assert_fits(&example(name), name);
        assert!(parts.rim_seat.depth_mm > 1.0 && parts.hub_seat.depth_mm > 0.9, "{name}: {parts:?}");
    }
}

#[test]
fn a_held_hub_gets_a_post_of_the_right_height_that_fits_its_socket() {
    let design = held("hemisphere");
    let parts = assert_fits(&design, "held hemisphere");
    let post = parts.post.clone().unwrap();
    let [mesh, hub] = [parts.post_mesh().unwrap().unwrap(), parts.hub_mesh().unwrap()];
    let highest = |mesh: &Mesh| mesh.vertices.iter().map(|p| p[2]).fold(f64::NEG_INFINITY, f64::max);
    let lowest = |mesh: &Mesh| mesh.vertices.iter().map(|p| p[2]).fold(f64::INFINITY, f64::min);
    // From the table the base stands on to the bottom of the socket.
    assert!((lowest(&mesh) - lowest(&parts.base_mesh().unwrap())).abs() < 1e-9);
    let (ceiling, _) = hit(&written(&hub), [0.05, 0.02, lowest(&hub) - 1.0], [0.0, 0.0, 1.0]).unwrap();
    assert!((lowest(&hub) - 1.0 + ceiling - highest(&mesh)).abs() < 1e-3);
    let (wall, _) = hit(&written(&hub), [0.05, 0.02, lowest(&hub) + 0.1], [1.0, 0.0, 0.0]).unwrap();
    assert!((wall + 0.05 - 0.5 * (post.diameter_mm + 0.2)).abs() < 0.01, "{wall}");
    // It stands inside the ring.
    let reach = mesh.vertices.iter().map(|p| p[0]).fold(0.0, f64::max);
    assert!((reach + 0.1 - parts.base.radii_mm[0]).abs() < 1e-6, "{reach}");
    assert!(Parts::of(&example("hemisphere"), &FabricationInput::defaults().unwrap()).unwrap().post.is_none());
}

#[test]
fn what_does_not_fit_is_refused_with_what_would_help() {
    let design = example("roof");
    let defaults = FabricationInput::defaults().unwrap();
    let refused = |input: FabricationInput| Parts::of(&design, &input).unwrap_err();
    let tight = refused(FabricationInput { clearance_mm: 0.02, ..defaults.clone() }).to_string();
    assert!(tight.contains("clearance_mm = "), "{tight}");
    // What it proposes does.
    let proposed: f64 = tight.split("clearance_mm = ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
    assert!(Parts::of(&design, &FabricationInput { clearance_mm: proposed, ..defaults.clone() }).is_ok(), "{tight}");
    let low = refused(FabricationInput { base_height_mm: Some(1.0), ..defaults.clone() });
    assert_eq!(low.key(), "fabrication.base_height_mm");
    let thick = refused(FabricationInput { wall_mm: 90.0, ..defaults.clone() });
    assert!(thick.to_string().contains("wall_mm"), "{thick}");
    let high = Parts::of(&design, &FabricationInput { base_height_mm: Some(12.0), ..defaults }).unwrap();
    let [floor, top] = high.base.heights_mm;
    assert!((top - floor - 12.0).abs() < 1e-12);
}
