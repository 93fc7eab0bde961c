//! The whole pipeline in memory.

use std::path::Path;

use voxelastica_core::input::files::Format;
use voxelastica_core::output::Summary;
use voxelastica_core::{Design, DesignInput, Error, Limits};

const HEMISPHERE: &str = r#"
[target]
kind = "hemi-ellipsoid"
[strips]
count = 8
length_mm = 100.0
hub_radius_mm = 10.0
thickness_mm = 2.0
[materials]
phases = ["FLX9070", "FLX9095"]
[voxels]
size_mm = 0.5
"#;

fn read(text: &str) -> DesignInput {
    DesignInput::from_text(text, Format::Toml, "test.toml", "test", Path::new(".")).unwrap()
}

#[test]
fn the_papers_hemisphere_has_its_published_counts() {
    let design = Design::compute(&read(HEMISPHERE), Limits::default()).unwrap();
    let summary = Summary::of(&design);
    assert!((summary.contrast - 2.3158).abs() < 1e-3);
    assert_eq!(summary.lattice.layers, 4);
    // Shell elements of edge eta: 133 840 in the paper for eight spokes.
    let shells = 8 * summary.voxels_per_spoke / 4;
    assert!((shells as f64 / 133_840.0 - 1.0).abs() < 5e-3, "{shells}");
    assert!(summary.predicted_error_percent.unwrap() < 0.5);
}

#[test]
fn contrast_out_of_reach_names_what_would_help() {
    let text = HEMISPHERE.replace(
        "kind = \"hemi-ellipsoid\"",
        "kind = \"inclination-polynomial\"\ncoefficients_deg = [26.52, -116.3, 162.3, -132, 63.5, -47.14, 18.64, 41.56]",
    );
    let text = text.replace("count = 8", "count = 12").replace("hub_radius_mm = 10.0", "hub_radius_mm = 5.0");
    let error = Design::compute(&read(&text), Limits::default()).err().unwrap();
    assert!(matches!(error, Error::Infeasible { .. }));
    let message = error.to_string();
    assert!(message.contains("held hub") && message.contains("4.065"), "{message}");
}
