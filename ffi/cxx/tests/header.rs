//! The committed bridge headers are what cxx makes of the sources.

use std::path::Path;

#[test]
fn the_headers_are_up_to_date() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let bridge: proc_macro2::TokenStream =
        std::fs::read_to_string(root.join("src/bridge.rs")).unwrap().parse().unwrap();
    let made = cxx_gen::generate_header_and_cc(bridge, &cxx_gen::Opt::default()).unwrap().header;
    let committed = root.join("include/voxelastica/bridge.h");
    if std::env::var_os("VOXELASTICA_UPDATE").is_some() {
        std::fs::write(&committed, &made).unwrap();
    }
    let kept = std::fs::read(&committed).unwrap_or_default();
    assert!(
        made == kept,
        "bridge.h differs from the sources; run VOXELASTICA_UPDATE=1 cargo test -p voxelastica-cxx --test header"
    );
}
