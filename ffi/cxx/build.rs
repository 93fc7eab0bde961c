//! Compiles the bridge's C++ side into this crate.

fn main() {
    cxx_build::bridge("src/bridge.rs").include("include").std("c++17").compile("voxelastica_cxx_bridge");
    println!("cargo:rerun-if-changed=src/bridge.rs");
    println!("cargo:rerun-if-changed=include/voxelastica/progress.hpp");
}
