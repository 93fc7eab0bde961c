//! Invariants of the voxels: counts, residues, symmetry, stiffness.

use proptest::prelude::*;
use voxelastica_core::materials::{Material, library};
use voxelastica_core::micromechanics::PhaseSet;
use voxelastica_core::voxel::counts::{Filling, fill};
use voxelastica_core::voxel::section::{layer_stiffness, section};
use voxelastica_core::voxel::{Lattice, Match, Pattern, Rounding, SliceTarget};

const PATTERNS: [Pattern; 6] = [
    Pattern::Random,
    Pattern::RandomLayered,
    Pattern::Centred,
    Pattern::Split,
    Pattern::ThroughThickness,
    Pattern::OneEdge,
];

fn phases(count: usize, contrast: f64) -> PhaseSet {
    let material =
        |name: &str, modulus: f64| Material { name: name.to_owned(), modulus_mpa: modulus, ..library()[0].clone() };
    let all = match count {
        2 => vec![material("a", 1.0), material("b", contrast)],
        _ => vec![material("a", 1.0), material("b", contrast.sqrt()), material("c", contrast)],
    };
    PhaseSet::new(all, 0.2).unwrap()
}

/// A strip whose width and modulus vary smoothly within the phases' reach.
fn targets(lattice: &Lattice, contrast: f64, phase: f64, rounding: Rounding) -> Vec<SliceTarget> {
    (0..lattice.slices)
        .map(|i| {
            let xi = i as f64 / lattice.slices as f64;
            let width_mm = lattice.size_mm * (4.0 + 14.0 * (1.0 - xi));
            let wave = 0.5 + 0.45 * (6.0 * xi + phase).sin();
            let half_width = lattice.half_width(width_mm, rounding);
            let ratio = 2.0 * half_width as f64 * lattice.size_mm / width_mm;
            SliceTarget { width_mm, modulus_mpa: (1.0 + (contrast - 1.0) * wave) * ratio, half_width }
        })
        .collect()
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 200,
        failure_persistence: Some(Box::new(proptest::test_runner::FileFailurePersistence::WithSource("regressions"))),
        ..ProptestConfig::default()
    })]

    #[test]
    fn counts_add_up_and_the_carried_residue_stays_within_half_a_step(
        pattern in prop::sample::select(PATTERNS.to_vec()),
        count in 2_usize..=3,
        contrast in 1.5_f64..40.0,
        phase in 0.0_f64..6.0,
        layers in 1_usize..6,
        seed in any::<u64>(),
    ) {
        let phases = phases(count, contrast);
        let lattice = Lattice { size_mm: 0.5, slices: 60, layers };
        let targets = targets(&lattice, contrast, phase, Rounding::Nearest);
        let filling = Filling { phases: &phases, pattern, seed, matching: Match::Modulus, rule: None };
        let (grid, slices) = fill(&lattice, &targets, &filling);
        let step = pattern.granule(layers) as f64;
        let mut wanted = 0.0;
        let mut got = 0.0;
        for (i, (slice, target)) in slices.iter().zip(&targets).enumerate() {
            let total: u32 = slice.counts.iter().sum();
            prop_assert_eq!(total as usize, 2 * target.half_width * layers);
            prop_assert_eq!(grid.slice(i).len(), total as usize);
            for k in 0..3 {
                let placed = grid.slice(i).iter().filter(|p| usize::from(**p) == k).count();
                prop_assert_eq!(placed, slice.counts[k] as usize, "every counted voxel is placed");
            }
            prop_assert!(!slice.clamped);
            prop_assert!(slice.modulus_mpa >= 1.0 - 1e-12 && slice.modulus_mpa <= contrast + 1e-12);
            // The sum along the strip never departs by more than half a step of the stiffest phase, for two phases.
            wanted += slice.modulus_target_mpa * f64::from(total);
            got += slice.modulus_mpa * f64::from(total);
            if count == 2 {
                prop_assert!((wanted - got).abs() <= (0.5 * step + 1e-6) * (contrast - 1.0), "slice {}", i);
            }
        }
        prop_assert_eq!(grid.counts(3).iter().sum::<u64>(), lattice.voxels(grid.half_widths()));
    }

    #[test]
    fn inward_rounding_never_exceeds_the_smooth_width(width in 0.5_f64..50.0, size in 0.05_f64..1.0) {
        let lattice = Lattice { size_mm: size, slices: 1, layers: 1 };
        let half = lattice.half_width(width, Rounding::Inward);
        prop_assert!(half == 1 || 2.0 * half as f64 * size <= width * (1.0 + 1e-5));
        let nearest = lattice.half_width(width, Rounding::Nearest);
        prop_assert!(nearest == 1 || (2.0 * nearest as f64 * size - width).abs() <= size * (1.0 + 1e-9));
    }

    #[test]
    fn the_fraction_of_the_stiffest_phase_rises_with_the_modulus(
        contrast in 1.1_f64..100.0, a in 0.0_f64..1.0, b in 0.0_f64..1.0, count in 2_usize..=3,
    ) {
        let phases = phases(count, contrast);
        let at = |t: f64| phases.rigid_fraction(1.0 + (contrast - 1.0) * t);
        let (low, high) = if a < b { (a, b) } else { (b, a) };
        prop_assert!(at(low) <= at(high) + 1e-12);
    }
}

#[test]
fn matching_the_stiffness_meets_it_where_matching_the_modulus_does_not() {
    let phases = phases(2, 4.0);
    let lattice = Lattice { size_mm: 0.25, slices: 80, layers: 8 };
    let targets = targets(&lattice, 4.0, 1.0, Rounding::Nearest);
    let rms = |matching: Match, pattern: Pattern| {
        let (_, slices) =
            fill(&lattice, &targets, &Filling { phases: &phases, pattern, seed: 3, matching, rule: None });
        let errors = slices.iter().map(|s| (s.section.stiffness / s.stiffness_target_nmm2 - 1.0).powi(2));
        (errors.sum::<f64>() / slices.len() as f64).sqrt()
    };
    for pattern in PATTERNS {
        let (modulus, stiffness) = (rms(Match::Modulus, pattern), rms(Match::Stiffness, pattern));
        println!("{pattern:?}: {modulus:.4} {stiffness:.4}");
        assert!(stiffness <= modulus + 1e-3, "{pattern:?}: {modulus} {stiffness}");
        // Patterns that move whole layers or columns at a time are as coarse as their step.
        let limit = if pattern.granule(lattice.layers) == 1 { 0.05 } else { 0.2 };
        assert!(stiffness < limit, "{pattern:?}: {stiffness}");
    }
    assert!(rms(Match::Modulus, Pattern::ThroughThickness) > 0.1);
}

#[test]
fn stiffness_matching_carries_its_residue_and_never_drifts() {
    let phases = phases(2, 4.0);
    let lattice = Lattice { size_mm: 0.5, slices: 200, layers: 4 };
    let targets = targets(&lattice, 4.0, 0.3, Rounding::Nearest);
    for pattern in [Pattern::Random, Pattern::ThroughThickness, Pattern::OneEdge] {
        let filling = Filling { phases: &phases, pattern, seed: 5, matching: Match::Stiffness, rule: None };
        let (grid, slices) = fill(&lattice, &targets, &filling);
        let drift: f64 = slices.iter().map(|s| s.section.stiffness - s.stiffness_target_nmm2).sum();
        let one = 0.25 * 3.0 * 4.0 / 4.0;
        assert!(drift.abs() <= 3.0 * one, "{pattern:?}: {drift}");
        for (i, slice) in slices.iter().enumerate() {
            let again = section(&layer_stiffness(grid.slice(i), 4, &phases.moduli(), 0.5), 0.5);
            assert_eq!(again, slice.section);
        }
    }
}

#[test]
fn one_phase_limits_are_pure() {
    let phases = phases(2, 4.0);
    let lattice = Lattice { size_mm: 0.5, slices: 10, layers: 4 };
    for (modulus, full) in [(1.0, 0), (4.0, 1)] {
        let targets = vec![SliceTarget { width_mm: 4.0, modulus_mpa: modulus, half_width: 4 }; 10];
        for pattern in PATTERNS {
            for matching in [Match::Modulus, Match::Stiffness] {
                let (grid, _) =
                    fill(&lattice, &targets, &Filling { phases: &phases, pattern, seed: 1, matching, rule: None });
                assert!(grid.phases().iter().all(|p| *p == full), "{pattern:?} {matching:?} {modulus}");
            }
        }
    }
}
