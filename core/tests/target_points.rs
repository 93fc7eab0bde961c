//! Meridians from points: closed forms, round trips and every kind of wrong input.

use proptest::prelude::*;
use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::{Rng, SeedableRng};
use voxelastica_core::target::{FittedMeridian, MeridianCurve, TargetError, read_points};

/// Points of the ellipse `(a cos q, b sin q)`, `q` from 0 (rim) to `to`.
fn ellipse(a: f64, b: f64, to: f64, count: usize) -> Vec<[f64; 2]> {
    (0..count).map(|i| to * i as f64 / (count - 1) as f64).map(|q| [a * q.cos(), b * q.sin()]).collect()
}

fn normal(random: &mut Xoshiro256PlusPlus) -> f64 {
    // Twelve uniform numbers: variance 1.
    (0..12).map(|_| random.next_u64() as f64 / u64::MAX as f64).sum::<f64>() - 6.0
}

/// The radius of the circle whose arc from the rim to the hub radius has the given length: `r cos(l / r) = r_h`.
fn circle_radius(length: f64, hub: f64) -> f64 {
    let (mut low, mut high) = (2.0 * length / std::f64::consts::PI, 1000.0 * length);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if middle * (length / middle).cos() < hub { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

#[test]
fn a_quarter_circle_has_its_curvature_everywhere() {
    let radius = circle_radius(100.0, 10.0);
    for count in [20, 60, 200, 1000] {
        let points = ellipse(7.5, 7.5, std::f64::consts::FRAC_PI_2, count);
        let fitted = FittedMeridian::from_points(&points, 100.0, 10.0).expect("a circle");
        assert!((fitted.curve.length() - 100.0).abs() < 1e-9);
        let (mut worst, mut gradient) = (0.0_f64, 0.0_f64);
        for p in fitted.curve.stations(501) {
            worst = worst.max((p.curvature * radius + 1.0).abs());
            gradient = gradient.max(p.curvature_gradient.abs() * radius * radius);
            assert!((p.inclination - (90.0_f64.to_radians() - p.s / radius)).abs() < 1e-4);
        }
        assert!(worst < 1e-3, "{count} points: curvature {worst:e}");
        assert!((fitted.scale * 7.5 - radius).abs() < 1e-4 * radius);
    }
}

#[test]
fn ellipses_have_their_curvature() {
    for aspect in [0.5, 2.0] {
        let points = ellipse(aspect, 1.0, std::f64::consts::FRAC_PI_2, 201);
        let fitted = FittedMeridian::from_points(&points, 100.0, 10.0).expect("an ellipse");
        let (a, b) = (aspect * fitted.scale, fitted.scale);
        let mut worst = 0.0_f64;
        for p in fitted.curve.stations(301) {
            let q = (p.z / b).min(1.0).asin();
            let speed = (a * q.sin()).hypot(b * q.cos());
            worst = worst.max((p.curvature * speed.powi(3) / (a * b) + 1.0).abs());
        }
        assert!(worst < 1e-3, "{worst:e}");
    }
}

#[test]
fn noise_of_a_thousandth_leaves_the_curvature_within_a_few_percent() {
    let radius = circle_radius(100.0, 10.0);
    for (seed, count) in (0..36).map(|seed| (seed, [200, 1000, 20_000][seed as usize / 12])) {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
        let mut points = ellipse(1.0, 1.0, std::f64::consts::FRAC_PI_2, count);
        for p in &mut points {
            *p = [(p[0] + 1e-3 * normal(&mut random)).abs(), p[1] + 1e-3 * normal(&mut random)];
        }
        let fitted = FittedMeridian::from_points(&points, 100.0, 10.0).expect("a noisy circle");
        let mut worst = 0.0_f64;
        for p in fitted.curve.stations(101).iter().filter(|p| p.s > 10.0 && p.s < 90.0) {
            worst = worst.max((p.curvature * radius + 1.0).abs());
        }
        assert!(worst < if count < 1000 { 0.08 } else { 0.05 }, "{count} points: {worst}");
    }
}

#[test]
fn the_profile_of_a_design_comes_back_from_its_own_points() {
    // A hub edge exactly at the hub radius: nothing beyond the cut.
    let radius = circle_radius(100.0, 10.0);
    for count in [41, 201, 1001] {
        let points = ellipse(radius, radius, 100.0 / radius, count);
        let fitted = FittedMeridian::from_points(&points, 100.0, 10.0).expect("its own points");
        assert!((fitted.scale - 1.0).abs() < 1e-4, "{}", fitted.scale);
    }
}

#[test]
fn order_and_unit_of_the_table_do_not_matter() {
    let points = ellipse(1.3, 1.0, std::f64::consts::FRAC_PI_2, 90);
    let table = |points: &mut dyn Iterator<Item = [f64; 2]>, unit: f64| {
        let rows: Vec<String> = points.map(|p| format!("{},{}\n", p[0] * unit, p[1] * unit)).collect();
        format!("# a scan\n RHO , z\n\n{}", rows.concat())
    };
    let fit = |text: String| {
        let table = read_points(text.as_bytes()).expect("a table");
        FittedMeridian::from_points(table.points(), 80.0, 5.0).expect("a dome")
    };
    let reference = fit(table(&mut points.iter().copied(), 1.0));
    for other in [
        fit(table(&mut points.iter().rev().copied(), 1.0)),
        fit(table(&mut points.iter().copied(), 25.4)),
        fit(table(&mut points.iter().rev().map(|p| [p[0], p[1] + 17.0]), 1e-3)),
    ] {
        for (a, b) in reference.curve.stations(21).iter().zip(other.curve.stations(21)) {
            assert!((a.x - b.x).abs() < 1e-6 && (a.z - b.z).abs() < 1e-6, "{a:?} {b:?}");
            assert!((a.curvature - b.curvature).abs() < 1e-6);
        }
    }
}

#[test]
fn arc_length_is_the_parameter() {
    let fitted = FittedMeridian::from_points(&ellipse(2.0, 1.0, 1.57, 100), 100.0, 10.0).expect("an ellipse");
    let stations = fitted.curve.stations(1001);
    let chords: f64 = stations.windows(2).map(|w| (w[1].x - w[0].x).hypot(w[1].z - w[0].z)).sum();
    assert!((chords - 100.0).abs() < 1e-4);
    for (i, p) in stations.iter().enumerate() {
        let single = fitted.curve.at(0.1 * i as f64);
        assert!((p.x - single.x).abs() < 1e-9 && (p.inclination - single.inclination).abs() < 1e-9);
        let h = 1e-3;
        if i > 0 && i < 1000 {
            let (a, b) = (fitted.curve.at(p.s - h), fitted.curve.at(p.s + h));
            assert!((b.x - a.x - 2.0 * h * p.inclination.cos()).abs() < 1e-8);
            assert!((b.z - a.z - 2.0 * h * p.inclination.sin()).abs() < 1e-8);
            assert!((b.inclination - a.inclination - 2.0 * h * p.curvature).abs() < 1e-8);
            assert!((b.curvature - a.curvature - 2.0 * h * p.curvature_gradient).abs() < 1e-7);
        }
    }
    assert_eq!(fitted.curve.at(-1.0), fitted.curve.at(0.0));
    assert_eq!(fitted.curve.at(1e9), fitted.curve.at(fitted.curve.length()));
    assert_eq!(fitted.curve.at(f64::NAN).s, 0.0);
}

#[test]
fn an_onion_dome_unwraps_past_ninety_degrees() {
    // A sphere cut below its equator: the rim is narrower than the belly.
    let points: Vec<[f64; 2]> =
        (0..120).map(|i| -0.5 + (0.5 + 1.5) * f64::from(i) / 119.0).map(|q| [q.cos(), q.sin()]).collect();
    let fitted = FittedMeridian::from_points(&points, 100.0, 4.0).expect("an onion dome");
    let first = fitted.curve.at(0.0);
    assert!((first.inclination - (std::f64::consts::FRAC_PI_2 + 0.5)).abs() < 1e-4);
}

#[test]
fn a_lid_inside_the_hub_does_not_bend_the_curve() {
    // A cone frustum, closed by a flat lid at the hub radius: straight all along.
    let mut points: Vec<[f64; 2]> = (0..=60).map(|i| 4.0 - 0.06 * f64::from(i)).map(|r| [r, 4.0 - r]).collect();
    points.extend((1..=20).map(|i| [0.4 * (1.0 - f64::from(i) / 20.0), 3.6]));
    let hub = 100.0 / (3.6 * 2.0_f64.sqrt()) * 0.4;
    let fitted = FittedMeridian::from_points(&points, 100.0, hub).expect("a cone");
    for p in fitted.curve.stations(101) {
        assert!(p.curvature.abs() < 1e-6 && (p.inclination.to_degrees() - 45.0).abs() < 1e-3, "{p:?}");
    }
}

#[test]
fn a_meridian_that_ends_outside_the_hub_names_the_radius() {
    let points = ellipse(50.0, 50.0, 1.0, 60);
    let error = FittedMeridian::from_points(&points, 100.0, 10.0).expect_err("too short");
    let TargetError::EndsOutsideHub { end_radius_mm, .. } = error else { panic!("{error}") };
    // Scaled to the length 100 the radius of the circle is 100.
    assert!((end_radius_mm - 100.0 * 1.0_f64.cos()).abs() < 0.01, "{end_radius_mm}");
}

#[test]
fn wrong_lengths_are_refused() {
    let points = ellipse(1.0, 1.0, 1.5, 60);
    for (length, hub) in [(0.0, 1.0), (-1.0, 1.0), (f64::NAN, 1.0), (10.0, 0.0), (10.0, f64::INFINITY)] {
        let error = FittedMeridian::from_points(&points, length, hub).expect_err("out of range");
        assert!(matches!(error, TargetError::OutOfRange { .. }), "{error}");
    }
}

/// The message for a table, which must be refused.
fn refused(text: &str) -> String {
    read_points(text.as_bytes()).expect_err("must be refused").to_string()
}

const GOOD: &str = "5,0\n4,3\n3,4\n1.4,4.8\n";

#[test]
fn wrong_tables_are_refused_with_line_column_and_value() {
    for (text, parts) in [
        (format!("rho,z\n{GOOD}0,abc\n"), vec!["line 6", "column z", "`abc`"]),
        (format!("{GOOD}# tip\n\n1 mm,5\n"), vec!["line 7", "column rho", "`1 mm`"]),
        (format!("{GOOD}0,NaN\n"), vec!["line 5", "column z", "NaN"]),
        (format!("{GOOD}inf,5\n"), vec!["line 5", "column rho", "inf"]),
        (format!("{GOOD}0,5,7\n"), vec!["line 5", "3 column(s)"]),
        (format!("{GOOD}0;5\n"), vec!["line 5", "1 column(s)"]),
        (format!("{GOOD}-0.5,5\n"), vec!["line 5", "-0.5", "negative"]),
        (format!("x,y\n{GOOD}0,5\n"), vec!["line 1", "`x,y`", "rho,z"]),
        (GOOD.to_owned(), vec!["4 different", "at least 5"]),
        (format!("{GOOD}1.4,4.8\n1.4,4.8\n"), vec!["4 different"]),
        (String::new(), vec!["0 different"]),
        (format!("{GOOD}\"0\n,5"), vec!["line 6", "1 column(s)"]),
    ] {
        let message = refused(&text);
        for part in parts {
            assert!(message.contains(part), "{text:?}: {message}");
        }
    }
}

#[test]
fn a_curve_that_doubles_back_names_the_line() {
    let message = refused("rho,z\n5,0\n4,1\n3,2\n3.5,1.6\n2,3\n1,4\n");
    assert!(message.contains("doubles back at line"), "{message}");
    let error = FittedMeridian::from_points(&[[3.0, 0.0], [2.0, 1.0], [3.0, 0.1], [1.0, 2.0], [0.0, 3.0]], 1.0, 0.1);
    assert!(matches!(error, Err(TargetError::DoublesBack { .. })), "{error:?}");
}

#[test]
fn a_curve_that_crosses_itself_names_both_segments() {
    // A loop in steps of 30 degrees between two straight ends.
    let mut points: Vec<[f64; 2]> = (0..10).map(|i| [20.0 - f64::from(i), 0.0]).collect();
    points.extend((1..14).map(|i| f64::from(30 * i).to_radians()).map(|q| [11.0 - q.sin(), 1.0 - q.cos()]));
    points.extend((1..10).map(|i| [9.5 - f64::from(i), 0.1]));
    let error = FittedMeridian::from_points(&points, 100.0, 10.0).expect_err("a loop");
    assert!(matches!(error, TargetError::CrossesItself { .. }), "{error}");
}

#[test]
fn a_table_with_byte_order_mark_and_windows_lines_is_read() {
    let table = read_points(b"\xef\xbb\xbfrho_mm,z_mm\r\n5,0\r\n4,3\r\n3,4\r\n1.4,4.8\r\n0,5\r\n").expect("a table");
    assert_eq!(table.lines(), [2, 3, 4, 5, 6]);
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_bytes_make_the_reader_panic(bytes in proptest::collection::vec(any::<u8>(), 0..400)) {
        let _ = read_points(&bytes);
    }

    #[test]
    fn no_numbers_make_the_fit_panic(
        points in proptest::collection::vec(
            (prop_oneof![Just(0.0), 0.0..10.0, any::<f64>()], prop_oneof![-10.0..10.0, any::<f64>()])
                .prop_map(<[f64; 2]>::from),
            0..30,
        ),
        length in prop_oneof![0.0..200.0, any::<f64>()],
        hub in prop_oneof![0.0..20.0, any::<f64>()],
    ) {
        if let Ok(fitted) = FittedMeridian::from_points(&points, length, hub) {
            prop_assert!(fitted.curve.stations(11).iter().all(|p| p.x.is_finite() && p.z.is_finite()));
        }
    }

    #[test]
    fn scale_and_cut_meet_both_conditions(a in 0.3..3.0_f64, length in 10.0..500.0_f64, share in 0.01..0.5_f64) {
        let points = ellipse(a, 1.0, std::f64::consts::FRAC_PI_2, 120);
        let hub = share * length;
        let fitted = FittedMeridian::from_points(&points, length, hub).expect("an ellipse");
        prop_assert!((fitted.curve.length() - length).abs() < 1e-9 * length);
        prop_assert!((fitted.curve.position(length)[0] - hub).abs() < 1e-9 * length);
    }
}
