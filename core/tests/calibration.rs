//! The calibrated mixture rule: closed forms of the bending cells, the rule itself, and designs that use it.

#[allow(dead_code, reason = "shared between test programs")]
mod common;

use std::path::Path;

use voxelastica_core::input::files::Format;
use voxelastica_core::materials::{Material, library};
use voxelastica_core::micromechanics::PhaseSet;
use voxelastica_core::micromechanics::calibration::{
    BendingCellSize, CalibrationError, MixtureRule, calibrate, measure,
};
use voxelastica_core::progress::never;
use voxelastica_core::voxel::Pattern;
use voxelastica_core::{DesignInput, Error};

fn phases(contrast: f64, poisson: f64) -> PhaseSet {
    let phase =
        |name: &str, modulus_mpa| Material { name: name.to_owned(), modulus_mpa, poisson, ..library()[0].clone() };
    PhaseSet::new(vec![phase("soft", 1.0), phase("rigid", contrast)], 0.2).unwrap()
}

fn size(slices: usize, half_width: usize, layers: usize) -> BendingCellSize {
    BendingCellSize { slices, half_width, layers, elements_per_voxel: 1 }
}

fn rule(contrast: f64, pattern: Pattern, size: BendingCellSize, seeds: &[u64]) -> MixtureRule {
    measure(&phases(contrast, 0.3), pattern, size, seeds, &never).unwrap()
}

/// Nearly equal phases bend with their common modulus: the cell imposes pure bending and nothing else.
#[test]
fn nearly_one_phase_bends_with_its_modulus() {
    let rule = rule(1.0 + 1e-9, Pattern::Random, size(6, 3, 3), &[1]);
    for modulus in &rule.bending_mpa {
        assert!((modulus - 1.0).abs() < 1e-8, "{modulus}");
    }
}

/// Two layers of equal thickness: `B = w h^3 (E1^2 + 14 E1 E2 + E2^2) / (12 (E1 + E2))`, and with equal Poisson's ratios the
/// beam solution holds in three dimensions.
#[test]
fn a_bilayer_has_its_textbook_stiffness() {
    let (e1, e2) = (1.0, 4.0);
    let rule = rule(e2, Pattern::ThroughThickness, size(6, 2, 2), &[1]);
    let found = rule.modulus(0.5);
    let exact = (e1 * e1 + 14.0 * e1 * e2 + e2 * e2) / (8.0 * (e1 + e2));
    assert!((found / exact - 1.0).abs() < 1e-9, "{found} {exact}");
}

/// Columns that run along the strip with all layers alike share its curvature: Voigt.
#[test]
fn columns_along_the_strip_bend_as_voigt_says() {
    for pattern in [Pattern::Centred, Pattern::Split, Pattern::OneEdge] {
        let rule = rule(10.0, pattern, size(4, 4, 2), &[1]);
        for (found, voigt) in rule.bending_mpa.iter().zip(&rule.voigt_mpa) {
            assert!((found / voigt - 1.0).abs() < 1e-9, "{pattern:?}: {found} {voigt}");
        }
    }
}

/// Random mixtures are softer than Voigt's rule, the more the higher the contrast, and never than Reuss's.
#[test]
fn random_mixtures_are_softer_than_voigt() {
    let mut worst = Vec::new();
    for contrast in [4.0, 30.0] {
        let rule = rule(contrast, Pattern::Random, size(12, 6, 2), &[1, 2]);
        let ratios: Vec<f64> = rule.bending_mpa.iter().zip(&rule.voigt_mpa).map(|(b, v)| b / v).collect();
        assert!(rule.bending_mpa.windows(2).all(|w| w[1] > w[0]));
        assert_eq!((ratios[0], ratios[ratios.len() - 1]), (1.0, 1.0));
        for (f, b) in rule.rigid_fraction.iter().zip(&rule.bending_mpa) {
            assert!(*b >= 1.0 / ((1.0 - f) + f / contrast) - 1e-9, "{f}: {b}");
            assert!((rule.fraction(*b) - f).abs() < 1e-9);
        }
        println!("contrast {contrast}: {ratios:.3?}, scatter {:.2} %", rule.scatter_percent);
        worst.push(ratios.into_iter().fold(1.0, f64::min));
    }
    // Half-way the measured M/kappa of a random hemisphere with phases 4 to 1 is about 0.85 of Voigt's.
    assert!((0.78..0.92).contains(&worst[0]) && worst[1] < worst[0], "{worst:?}");
}

#[test]
fn rules_are_kept_and_cancelled() {
    let set = phases(5.0, 0.3);
    let stopped = calibrate(&set, Pattern::Random, 2, &|| true);
    assert_eq!(stopped.unwrap_err(), CalibrationError::Cancelled);
    let first = calibrate(&set, Pattern::Random, 2, &never).unwrap();
    let again = calibrate(&set, Pattern::Random, 2, &|| true).unwrap();
    assert!(std::sync::Arc::ptr_eq(&first, &again));
}

const DESIGN: &str = r#"
    [target]
    kind = "hemi-ellipsoid"
    [strips]
    count = 8
    length_mm = 40.0
    hub_radius_mm = 4.0
    thickness_mm = 2.0
    [materials]
    phases = ["FLX9070", "FLX9095"]
    [voxels]
    size_mm = 1.0
    match = "calibrated"
"#;

#[test]
fn a_calibrated_design_takes_more_of_the_rigid_phase_and_meets_its_stiffness() {
    let calibrated = common::design(DESIGN);
    let plain = common::design(&DESIGN.replace("calibrated", "modulus"));
    let rule = calibrated.mixture_rule().unwrap();
    let rigid = |d: &voxelastica_core::Design| d.grid().counts(2)[1];
    assert!(rigid(&calibrated) > rigid(&plain));
    let (mut found, mut wanted) = (0.0, 0.0);
    for slice in calibrated.slices() {
        let fraction = f64::from(slice.counts[1]) / f64::from(slice.counts[0] + slice.counts[1]);
        assert!((slice.modulus_mpa - rule.modulus(fraction)).abs() < 1e-12);
        found += slice.section.stiffness;
        wanted += slice.stiffness_target_nmm2;
    }
    assert!((found / wanted - 1.0).abs() < 0.01, "{found} {wanted}");
    assert!(calibrated.predicted_error().unwrap() < 0.01);
    // Recorded, and the same again.
    let again = common::design(DESIGN);
    assert_eq!(again.grid(), calibrated.grid());
}

#[test]
fn three_phases_are_refused_by_name() {
    let text = DESIGN.replace("[\"FLX9070\", \"FLX9095\"]", "[\"TangoBlack\", \"FLX9070\", \"FLX9095\"]");
    let input = DesignInput::from_text(&text, Format::Toml, "test.toml", "test", Path::new("."));
    let error = input
        .map_err(Error::Input)
        .and_then(|input| voxelastica_core::Design::compute(&input, voxelastica_core::Limits::default()).map(|_| ()));
    let error = error.unwrap_err();
    assert_eq!(error.exit_code(), 2);
    assert!(error.to_string().contains("voxels.match") && error.to_string().contains("two phases"), "{error}");
}

/// The figures of docs/micromechanics.md: `--ignored --nocapture`.
#[test]
#[ignore = "long"]
fn tables_for_the_documentation() {
    let middle = |rule: &MixtureRule| [0.25, 0.5, 0.75].map(|f| rule.modulus(f) / (1.0 - f + f * rule.modulus(1.0)));
    for contrast in [4.0, 30.0, 3279.6] {
        for pattern in [Pattern::Random, Pattern::RandomLayered, Pattern::ThroughThickness] {
            for layers in [2, 4] {
                let rule = rule(contrast, pattern, size(12, 6, layers), &[1, 2, 3, 4, 5, 6]);
                println!(
                    "{contrast:.2} {pattern:?} {layers} layers: {:.3?} scatter {:.2} % interpolation {:.2} %",
                    middle(&rule),
                    rule.scatter_percent,
                    rule.interpolation_error_percent
                );
            }
        }
    }
    for (what, size, seeds) in [
        ("length 8", size(8, 6, 2), 1..=12),
        ("length 12", size(12, 6, 2), 1..=12),
        ("length 24", size(24, 6, 2), 1..=6),
        ("width 6", size(12, 3, 2), 1..=12),
        ("width 24", size(12, 12, 2), 1..=6),
        ("8 layers", size(12, 6, 8), 1..=3),
        ("16 layers", size(12, 6, 16), 1..=2),
        ("24 layers", size(12, 6, 24), 1..=1),
        ("2 elements", BendingCellSize { elements_per_voxel: 2, ..size(12, 6, 2) }, 1..=3),
        ("3 elements", BendingCellSize { elements_per_voxel: 3, ..size(12, 6, 2) }, 1..=1),
    ] {
        let start = std::time::Instant::now();
        let seeds: Vec<u64> = seeds.collect();
        for contrast in [4.0, 30.0] {
            let rule = rule(contrast, Pattern::Random, size, &seeds);
            println!(
                "{contrast} {what}: {:.3?} scatter {:.2} % {:.1?}",
                middle(&rule),
                rule.scatter_percent,
                start.elapsed()
            );
        }
    }
}

/// What the calibrated counts do to the morph, every voxel resolved: `--ignored --nocapture`.
#[test]
#[ignore = "long"]
fn calibrated_designs_miss_their_target_less() {
    use voxelastica_core::fem::morph::{Lead, MorphOptions, solve};
    use voxelastica_core::fem::{Model, Resolution};
    let roof = "kind = \"inclination-polynomial\"\ncoefficients_deg = [6395, -28300, 52140, -51860, 30530, -11170, 2808, \
                -570.8, 89.7]";
    let high = "phases = [\"soft\", \"rigid\"]\n[[materials.custom]]\nname = \"soft\"\nmodulus_mpa = 1.0\npoisson = 0.3\n\
                [[materials.custom]]\nname = \"rigid\"\nmodulus_mpa = 30.0\npoisson = 0.3";
    let hemisphere = DESIGN.to_owned();
    let roof = DESIGN
        .replace("kind = \"hemi-ellipsoid\"", roof)
        .replace("count = 8", "count = 6")
        .replace("hub_radius_mm = 4.0", "hub_radius_mm = 8.0")
        .replace("phases = [\"FLX9070\", \"FLX9095\"]", high);
    for (name, text, patterns) in
        [("hemisphere", hemisphere, vec!["random", "centred"]), ("roof 30:1", roof, vec!["random", "random-layered"])]
    {
        for pattern in patterns {
            for seed in 1..=4 {
                let errors = ["modulus", "calibrated"].map(|matching| {
                    let text = text.replace("\"calibrated\"", &format!("\"{matching}\""));
                    let text = format!("{text}\n    pattern = \"{pattern}\"\n    seed = {seed}\n");
                    let design = common::design(&text);
                    let model = Model::of_design(&design, Resolution::Voxels(1)).unwrap();
                    let lead = Lead::new(design.guide().unwrap(), design.voxel_path());
                    let found = solve(&model, &lead, &MorphOptions::default(), &|_| true).unwrap();
                    let profile = design.profile();
                    let last = profile.s.len() - 1;
                    let miss = |[s, x, z]: &[f64; 3]| {
                        let i = (s / 40.0 * last as f64).round() as usize;
                        (x - profile.x[i]).hypot(z - profile.z[i]) / 40.0
                    };
                    let largest = found.midline.iter().map(miss).fold(0.0, f64::max);
                    let rms = (found.midline.iter().map(|p| miss(p).powi(2)).sum::<f64>() / found.midline.len() as f64)
                        .sqrt();
                    let thrust = voxelastica_core::output::Summary::of(&design).thrust.per_spoke;
                    let force = found.reactions.rim.horizontal;
                    [100.0 * largest, 100.0 * rms, force, thrust.beam.horizontal_n, thrust.plane_strain.horizontal_n]
                });
                println!("{name} {pattern} seed {seed}: modulus {:.3?}, calibrated {:.3?}", errors[0], errors[1]);
            }
        }
    }
}
