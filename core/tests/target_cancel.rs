//! Reading and fitting meshes stops when asked, whatever it is doing.

use std::f64::consts::{FRAC_PI_2, TAU};
use std::fmt::Write;
use std::sync::atomic::{AtomicUsize, Ordering};

use base64::Engine;
use voxelastica_core::input::files::Format;
use voxelastica_core::target::{Axis, FittedMeridian, MeshFormat, TargetError, TriangleMesh, read_mesh_unless};
use voxelastica_core::{DesignInput, Error};

/// A hemisphere of 201 rings of 200 vertices.
fn dome() -> TriangleMesh {
    let (rings, around) = (200_usize, 200_usize);
    let mut mesh = TriangleMesh::default();
    for i in 0..=rings {
        let q = FRAC_PI_2 * i as f64 / (rings as f64 + 1.0);
        for j in 0..around {
            let phi = TAU * j as f64 / around as f64;
            mesh.vertices.push([q.cos() * phi.cos(), q.cos() * phi.sin(), q.sin()]);
        }
    }
    let vertex = |i: usize, j: usize| (i * around + j % around) as u32;
    for i in 0..rings {
        for j in 0..around {
            let (a, b, c, d) = (vertex(i, j), vertex(i, j + 1), vertex(i + 1, j + 1), vertex(i + 1, j));
            mesh.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    mesh
}

fn obj(mesh: &TriangleMesh) -> Vec<u8> {
    let mut text = String::new();
    // Faces first: their vertices come later in the file.
    for [a, b, c] in &mesh.triangles {
        writeln!(text, "f {} {} {}", a + 1, b + 1, c + 1).unwrap();
    }
    for [x, y, z] in &mesh.vertices {
        writeln!(text, "v {x:.7} {y:.7} {z:.7}").unwrap();
    }
    text.into_bytes()
}

fn stl(mesh: &TriangleMesh) -> Vec<u8> {
    let mut text = String::from("solid dome\n");
    for triangle in &mesh.triangles {
        text.push_str("facet normal 0 0 1\nouter loop\n");
        for [x, y, z] in triangle.map(|i| mesh.vertices[i as usize]) {
            writeln!(text, "vertex {x:.7} {y:.7} {z:.7}").unwrap();
        }
        text.push_str("endloop\nendfacet\n");
    }
    text.push_str("endsolid dome\n");
    text.into_bytes()
}

fn gltf(mesh: &TriangleMesh) -> Vec<u8> {
    let positions = mesh.vertices.iter().flatten().flat_map(|c| (*c as f32).to_le_bytes());
    let bytes: Vec<u8> = positions.chain(mesh.triangles.iter().flatten().flat_map(|i| i.to_le_bytes())).collect();
    let (vertices, indices) = (mesh.vertices.len(), 3 * mesh.triangles.len());
    let text = base64::engine::general_purpose::STANDARD.encode(&bytes);
    format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":{vertices},"type":"VEC3"}},
                     {{"bufferView":1,"componentType":5125,"count":{indices},"type":"SCALAR"}}],
        "bufferViews":[{{"buffer":0,"byteLength":{}}},{{"buffer":0,"byteOffset":{0},"byteLength":{}}}],
        "buffers":[{{"byteLength":{},"uri":"data:application/octet-stream;base64,{text}"}}]}}"#,
        12 * vertices,
        4 * indices,
        bytes.len()
    )
    .into_bytes()
}

/// Runs work to its end, counting how often it asks; then stops it at some of these questions. Once told to stop, it may
/// ask a few times more, from threads that run already, but must end as cancelled.
fn stops_wherever_it_asks<T>(what: &str, fewest: usize, work: impl Fn(&(dyn Fn() -> bool + Sync)) -> Result<T, bool>) {
    let asked = AtomicUsize::new(0);
    let counting = || {
        asked.fetch_add(1, Ordering::Relaxed);
        false
    };
    assert!(work(&counting).is_ok(), "{what}");
    let total = asked.load(Ordering::Relaxed);
    assert!(total >= fewest, "{what}: asked {total} times");
    for share in 0..6 {
        let limit = share * (total - 1) / 5;
        let asked = AtomicUsize::new(0);
        let result = work(&|| asked.fetch_add(1, Ordering::Relaxed) >= limit);
        assert_eq!(result.err(), Some(true), "{what}: told to stop at question {limit} of {total}");
    }
}

#[test]
fn readers_stop_in_every_format() {
    let mesh = dome();
    for (name, bytes, format, fewest) in [
        ("obj", obj(&mesh), MeshFormat::Obj, 20),
        ("stl", stl(&mesh), MeshFormat::Stl, 40),
        ("gltf", gltf(&mesh), MeshFormat::Gltf, 40),
    ] {
        let back = read_mesh_unless(&bytes, format, &|| false).unwrap();
        assert_eq!(back.triangles.len(), mesh.triangles.len(), "{name}");
        stops_wherever_it_asks(name, fewest, |cancelled| {
            read_mesh_unless(&bytes, format, cancelled).map_err(|e| e == TargetError::Cancelled)
        });
    }
}

#[test]
fn fitting_stops() {
    let mesh = dome();
    stops_wherever_it_asks("fit", 100, |cancelled| {
        FittedMeridian::from_mesh_unless(&mesh.vertices, &mesh.triangles, Axis::Auto, 100.0, 10.0, cancelled)
            .map_err(|e| e == TargetError::Cancelled)
    });
}

#[test]
fn a_design_file_with_a_mesh_stops_and_says_so() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("dome.obj"), obj(&dome())).unwrap();
    let text = "[target]\nkind = \"mesh\"\nfile = \"dome.obj\"\n[strips]\ncount = 8\nlength_mm = 100.0\nhub_radius_mm = \
                10.0\nthickness_mm = 2.0\n[materials]\nphases = [\"FLX9070\", \"FLX9095\"]\n[voxels]\nsize_mm = 1.0\n";
    let path = folder.path().join("mesh.toml");
    std::fs::write(&path, text).unwrap();
    let read = |cancelled: &(dyn Fn() -> bool + Sync)| {
        DesignInput::read_unless(&path, cancelled).map_err(|e| matches!(e, Error::Cancelled))
    };
    stops_wherever_it_asks("design file", 100, read);
    let parse = |cancelled: &(dyn Fn() -> bool + Sync)| {
        DesignInput::from_text_unless(text, Format::Toml, "mesh.toml", "mesh", folder.path(), cancelled)
            .map_err(|e| matches!(e, Error::Cancelled))
    };
    stops_wherever_it_asks("design text", 100, parse);
}
