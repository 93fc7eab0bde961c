//! The committed header is what cbindgen makes of the sources.

use std::path::Path;

#[test]
fn the_header_is_up_to_date() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let config = cbindgen::Config::from_file(root.join("cbindgen.toml")).unwrap();
    let mut made = Vec::new();
    cbindgen::Builder::new().with_crate(root).with_config(config).generate().unwrap().write(&mut made);
    let made = String::from_utf8(made).unwrap();
    let committed = root.join("include/voxelastica.h");
    if std::env::var_os("VOXELASTICA_UPDATE").is_some() {
        std::fs::write(&committed, &made).unwrap();
    }
    let kept = std::fs::read_to_string(&committed).unwrap_or_default();
    assert!(
        made == kept,
        "ffi/include/voxelastica.h differs from the sources; run VOXELASTICA_UPDATE=1 cargo test -p voxelastica-ffi --test header"
    );
}
