//! Mesh files: the same square pyramid in every format, and every kind of damage.

use base64::Engine;
use proptest::prelude::*;
use voxelastica_core::target::{MeshFormat, TargetError, TriangleMesh, read_mesh, read_mesh_file};

const CORNERS: [[f32; 3]; 5] =
    [[1.0, 1.0, 0.0], [-1.0, 1.0, 0.0], [-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 0.0, 1.5]];
const SIDES: [[u32; 3]; 4] = [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]];

const OBJ: &str = "# a pyramid\nmtllib none.mtl\no pyramid\nv 1 1 0\nv -1 1 0\nv -1 -1 0\nv 1 -1 0\nvt 0 0\nvn 0 0 1\n\
                   v 0 0 1.5 0.5 0.5 0.5\nusemtl x\ng sides\nf 1/1/1 2/1/1 5/1/1\nf 2//1 3//1 5//1\nf -3 -2 -1\n\
                   f 4 1 \\\n5\n";

fn triangles_by_position(mesh: &TriangleMesh) -> Vec<[[f64; 3]; 3]> {
    let corner = |i: u32| mesh.vertices[i as usize];
    mesh.triangles.iter().map(|t| t.map(corner)).collect()
}

fn expected() -> Vec<[[f64; 3]; 3]> {
    SIDES.iter().map(|t| t.map(|i| CORNERS[i as usize].map(f64::from))).collect()
}

fn text_stl() -> String {
    let facet = |t: &[u32; 3]| {
        let vertex = |i: &u32| {
            let [x, y, z] = CORNERS[*i as usize];
            format!("vertex {x} {y} {z}\n")
        };
        let vertices: String = t.iter().map(vertex).collect();
        format!("facet normal 0 0 1\nouter loop\n{vertices}endloop\nendfacet\n")
    };
    format!(
        "solid\n{}ENDSOLID\n solid second\n{}endsolid second\n",
        facet(&SIDES[0]),
        SIDES[1..].iter().map(facet).collect::<String>()
    )
}

fn binary_stl(header: &[u8]) -> Vec<u8> {
    let mut bytes = header.to_vec();
    bytes.resize(80, 0);
    bytes.extend(4_u32.to_le_bytes());
    for t in SIDES {
        bytes.extend([0; 12]);
        for i in t {
            bytes.extend(CORNERS[i as usize].iter().flat_map(|c| c.to_le_bytes()));
        }
        bytes.extend([0; 2]);
    }
    bytes
}

fn buffer() -> Vec<u8> {
    let positions = CORNERS.iter().flatten().flat_map(|c| c.to_le_bytes());
    positions.chain(SIDES.iter().flatten().flat_map(|i| (*i as u16).to_le_bytes())).collect()
}

/// A glTF document with the buffer described by `buffer`, the index accessor's count and the node's transform.
fn document(buffer: &str, count: u64, node: &str) -> String {
    format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"children":[1]{node}}},{{"mesh":0}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":5,"type":"VEC3"}},
                     {{"bufferView":1,"componentType":5123,"count":{count},"type":"SCALAR"}}],
        "bufferViews":[{{"buffer":0,"byteLength":60}},{{"buffer":0,"byteOffset":60,"byteLength":24}}],
        "buffers":[{{"byteLength":84{buffer}}}]}}"#
    )
}

fn embedded() -> String {
    let text = base64::engine::general_purpose::STANDARD.encode(buffer());
    format!(r#","uri":"data:application/octet-stream;base64,{text}""#)
}

fn glb(json: &str) -> Vec<u8> {
    let mut json = json.as_bytes().to_vec();
    json.resize(json.len().next_multiple_of(4), b' ');
    let data = buffer();
    let mut bytes = b"glTF".to_vec();
    bytes.extend(2_u32.to_le_bytes());
    bytes.extend((12 + 8 + json.len() as u32 + 8 + data.len() as u32).to_le_bytes());
    bytes.extend((json.len() as u32).to_le_bytes());
    bytes.extend(b"JSON");
    bytes.extend(&json);
    bytes.extend((data.len() as u32).to_le_bytes());
    bytes.extend(b"BIN\0");
    bytes.extend(&data);
    bytes
}

#[test]
fn every_format_gives_the_same_triangles() {
    for (name, bytes, format) in [
        ("obj", OBJ.as_bytes().to_vec(), MeshFormat::Obj),
        ("text stl", text_stl().into_bytes(), MeshFormat::Stl),
        ("binary stl", binary_stl(b"pyramid"), MeshFormat::Stl),
        ("binary stl that looks like text", binary_stl(b"solid pyramid"), MeshFormat::Stl),
        ("gltf", document(&embedded(), 12, "").into_bytes(), MeshFormat::Gltf),
        ("glb", glb(&document("", 12, "")), MeshFormat::Gltf),
    ] {
        let mesh = read_mesh(&bytes, format).unwrap_or_else(|e| panic!("{name}: {e}"));
        assert_eq!(triangles_by_position(&mesh), expected(), "{name}");
        assert_eq!(mesh.vertices.len(), 5, "{name}");
    }
}

#[test]
fn nodes_move_what_is_below_them() {
    // Twice as large, a quarter turn about z, moved up by 10.
    let half = 0.5_f32.sqrt();
    let node = format!(r#","scale":[2,2,2],"rotation":[0,0,{half},{half}],"translation":[0,0,10]"#);
    let mesh = read_mesh(document(&embedded(), 12, &node).as_bytes(), MeshFormat::Gltf).expect("a pyramid");
    for (v, c) in mesh.vertices.iter().zip(CORNERS.map(|c| c.map(f64::from))) {
        let moved = [-2.0 * c[1], 2.0 * c[0], 2.0 * c[2] + 10.0];
        assert!(v.iter().zip(moved).all(|(a, b)| (a - b).abs() < 1e-6), "{v:?} {moved:?}");
    }
}

#[test]
fn strips_and_fans_become_triangles() {
    let with_mode =
        |mode: u32| document(&embedded(), 5, "").replace(r#""indices":1"#, &format!(r#""indices":1,"mode":{mode}"#));
    let read = |mode| read_mesh(with_mode(mode).as_bytes(), MeshFormat::Gltf).map(|m| m.triangles);
    // The first five indices are 0 1 4 1 2.
    assert_eq!(read(5), Ok(vec![[0, 1, 4], [4, 1, 1], [4, 1, 2]]));
    assert_eq!(read(6), Ok(vec![[0, 1, 4], [0, 4, 1], [0, 1, 2]]));
    assert!(matches!(read(1), Err(TargetError::EmptyMesh { .. })));
}

#[test]
fn files_beside_the_document_are_read_and_no_others() {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, bytes: &[u8]| std::fs::write(folder.path().join(name), bytes).expect("written");
    std::fs::create_dir(folder.path().join("parts")).expect("a folder");
    write("parts/a pyramid.bin", &buffer());
    write("good.gltf", document(r#","uri":"parts/a%20pyramid.bin""#, 12, "").as_bytes());
    let mesh = read_mesh_file(&folder.path().join("good.gltf")).expect("a pyramid");
    assert_eq!(triangles_by_position(&mesh), expected());
    for uri in [
        "../secret.bin",
        "/etc/passwd",
        "http://example.org/a.bin",
        "parts/../../a.bin",
        "C:/a.bin",
        "..\\a.bin",
        "",
        "%2e%2e/a",
        "%zz",
    ] {
        write("bad.gltf", document(&format!(r#","uri":{uri:?}"#), 12, "").as_bytes());
        let error = read_mesh_file(&folder.path().join("bad.gltf")).expect_err(uri);
        assert!(matches!(error, TargetError::BufferUri { .. }), "{uri}: {error}");
    }
    write("bad.gltf", document(r#","uri":"missing.bin""#, 12, "").as_bytes());
    let error = read_mesh_file(&folder.path().join("bad.gltf")).expect_err("missing");
    assert!(error.to_string().contains("missing.bin"), "{error}");
    write("mesh.STL", &binary_stl(b""));
    assert!(read_mesh_file(&folder.path().join("mesh.STL")).is_ok());
    for name in ["mesh.ply", "mesh", "none.obj"] {
        assert!(read_mesh_file(&folder.path().join(name)).is_err());
    }
    assert!(matches!(read_mesh_file(folder.path()), Err(TargetError::MeshFormat { .. })));
}

#[test]
fn damage_is_named() {
    let gltf = |text: String| (text.into_bytes(), MeshFormat::Gltf);
    let obj = |text: &str| (text.as_bytes().to_vec(), MeshFormat::Obj);
    let stl = |bytes: &[u8]| (bytes.to_vec(), MeshFormat::Stl);
    let good = document(&embedded(), 12, "");
    let mut short_header = glb(&document("", 12, ""));
    short_header[8..12].copy_from_slice(&[3, 0, 0, 0]);
    let mut huge = binary_stl(b"");
    huge[80..84].copy_from_slice(&u32::MAX.to_le_bytes());
    let mut nan = binary_stl(b"");
    nan[96..100].copy_from_slice(&f32::NAN.to_le_bytes());
    for ((bytes, format), part) in [
        (obj(""), "0 vertices"),
        (obj("v 0 0 0\nv 1 0 0\nv 0 1 0\n"), "0 triangles"),
        (obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n"), "line 4: the face refers to vertex 4, the file has 3"),
        (obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 0\n"), "line 4: `0` refers to no vertex"),
        (obj("v 0 0 0\nf 1 1 -2\n"), "`-2` refers to no vertex"),
        (obj("v 0 0 zero\n"), "line 1: `zero` is not a finite number"),
        (obj("v 0 0 nan\n"), "`nan` is not a finite number"),
        (obj("v 0 0\n"), "fewer than three"),
        (obj("v 0 0 0\nf 1 1 x\n"), "`x` is not a vertex index"),
        (stl(b""), "0"),
        (stl(&huge), "4294967295 facets, its bytes hold 4"),
        (stl(&nan), "NaN"),
        (stl(b"solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 zero\n"), "STL file cannot be read"),
        (stl(b"solid x\nendsolid x\n"), "0 triangles"),
        (gltf(String::from("{}")), "glTF file cannot be read"),
        (gltf(good.replace("\"count\":12", "\"count\":13")), "declares 13 elements, its bytes hold 12"),
        (gltf(good.replace("\"count\":5", "\"count\":4000000000000")), "4000000000000 vertices"),
        (gltf(good.replace("\"byteLength\":60", "\"byteLength\":600")), "declares 600 bytes"),
        (gltf(good.replace("\"byteOffset\":60", "\"byteOffset\":18446744073709551615")), "glTF"),
        (gltf(good.replace("\"count\":5", "\"count\":4")), "triangle 0 refers to vertex 4, the mesh has 4"),
        (gltf(good.replace("\"children\":[1]", "\"children\":[0]")), "twice"),
        (gltf(good.replace("\"children\":[1]", "\"children\":[7]")), "node 7"),
        (gltf(good.replace("\"mesh\":0", "\"mesh\":9")), "mesh 9"),
        (gltf(good.replace("\"POSITION\":0", "\"POSITION\":1")), "Vec3"),
        (gltf(good.replace("\"asset\"", "\"extensionsRequired\":[\"KHR_draco_mesh_compression\"],\"asset\"")), "draco"),
        (gltf(document("", 12, "")), "neither an address"),
        (gltf(document(r#","uri":"a.bin""#, 12, "")), "embed"),
        (gltf(document(r#","uri":"data:;base64,####""#, 12, "")), "data:"),
        (gltf(document(&embedded(), 12, r#","scale":[1e39,1,1]"#)), ""),
        ((short_header, MeshFormat::Gltf), "declares 3 bytes"),
    ] {
        let error = read_mesh(&bytes, format).map(drop).expect_err(part).to_string();
        assert!(error.contains(part), "{part}: {error}");
    }
}

fn mutated(good: Vec<u8>) -> impl Strategy<Value = Vec<u8>> {
    let length = good.len();
    (proptest::collection::vec((0..length, any::<u8>()), 0..12), 0..=length).prop_map(move |(changes, end)| {
        let mut bytes = good.clone();
        for (place, byte) in changes {
            bytes[place] = byte;
        }
        bytes.truncate(if end % 3 == 0 { end } else { length });
        bytes
    })
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, cases: 1000, ..ProptestConfig::default() })]

    #[test]
    fn no_bytes_make_a_reader_panic(bytes in proptest::collection::vec(any::<u8>(), 0..300)) {
        for format in [MeshFormat::Obj, MeshFormat::Gltf, MeshFormat::Stl] {
            let _ = read_mesh(&bytes, format);
        }
    }

    #[test]
    fn damaged_files_do_not_make_a_reader_panic(
        obj in mutated(OBJ.as_bytes().to_vec()),
        text in mutated(text_stl().into_bytes()),
        binary in mutated(binary_stl(b"solid")),
        gltf in mutated(document(&embedded(), 12, r#","scale":[2,2,2]"#).into_bytes()),
        glb in mutated(glb(&document("", 12, ""))),
    ) {
        let _ = read_mesh(&obj, MeshFormat::Obj);
        let _ = read_mesh(&text, MeshFormat::Stl);
        let _ = read_mesh(&binary, MeshFormat::Stl);
        let _ = read_mesh(&gltf, MeshFormat::Gltf);
        let _ = read_mesh(&glb, MeshFormat::Gltf);
    }
}
