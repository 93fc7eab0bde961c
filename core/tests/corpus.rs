//! Replays the fuzzers' corpus: what once was interesting stays tested.

#[path = "../../fuzz/entries.rs"]
mod entries;

fn replay(target: &str, entry: fn(&[u8])) {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../fuzz/corpus").join(target);
    let mut count = 0;
    for file in std::fs::read_dir(&folder).unwrap() {
        entry(&std::fs::read(file.unwrap().path()).unwrap());
        count += 1;
    }
    assert!(count > 0, "{} is empty", folder.display());
    println!("{target}: {count} inputs");
}

#[test]
fn design_files() {
    replay("design_file", entries::design_file);
}

#[test]
fn csv_meridians() {
    replay("csv", entries::csv);
}

#[test]
fn obj_meshes() {
    replay("obj", entries::obj);
}

#[test]
fn gltf_meshes() {
    replay("gltf", entries::gltf);
}

#[test]
fn stl_meshes() {
    replay("stl", entries::stl);
}

#[test]
fn ccx_results() {
    replay("ccx_dat", entries::ccx_dat);
}
