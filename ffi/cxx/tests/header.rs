//! The committed bridge headers are what cxx makes of the sources.

use std::path::Path;

fn hold(made: &[u8], name: &str) {
    let committed = Path::new(env!("CARGO_MANIFEST_DIR")).join("include/voxelastica").join(name);
    if std::env::var_os("VOXELASTICA_UPDATE").is_some() {
        std::fs::write(&committed, made).unwrap();
    }
    let kept = std::fs::read(&committed).unwrap_or_default();
    assert!(
        made == kept,
        "{name} differs from the sources; run VOXELASTICA_UPDATE=1 cargo test -p voxelastica-cxx --test header"
    );
}

#[test]
fn the_bridges_header_is_up_to_date() {
    let sources = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/bridge.rs");
    let bridge: proc_macro2::TokenStream = std::fs::read_to_string(sources).unwrap().parse().unwrap();
    let made = cxx_gen::generate_header_and_cc(bridge, &cxx_gen::Opt::default()).unwrap().header;
    hold(&made, "bridge.h");
}

#[test]
fn the_header_of_cxx_is_that_of_the_version_in_use() {
    hold(cxx_gen::HEADER.as_bytes(), "cxx.h");
}
