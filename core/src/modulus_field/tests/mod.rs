//! Fits of closed forms, of the paper's shapes and of arbitrary data.

mod paper_shapes;
mod python;

use proptest::prelude::*;

use super::*;
use paper_shapes::{LENGTH_MM, hemi_ellipsoid, inclination_polynomial};

fn stations(count: usize, length: f64) -> Vec<f64> {
    (0..count).map(|i| length * i as f64 / (count - 1) as f64).collect()
}

fn fit(length: f64, count: usize, modulus: impl Fn(f64) -> f64) -> ModulusField {
    let s = stations(count, length);
    let e: Vec<f64> = s.iter().map(|&s| modulus(s)).collect();
    checked(&s, &e, length)
}

/// Fits, and checks everything that holds for every fit.
fn checked(s: &[f64], e: &[f64], length: f64) -> ModulusField {
    let field = ModulusField::fit(s, e, length).unwrap();
    assert!(field.expression.is_ascii() && !field.expression.contains([' ', '\n']), "{}", field.expression);
    for trap in ["--", "+-", "*-", "++", "/-"] {
        assert!(!field.expression.contains(trap), "{trap} in {}", field.expression);
    }
    let mut largest = 0.0_f64;
    for i in 0..=777 {
        let x = length * f64::from(i) / 777.0;
        let value = field.evaluate(x);
        assert!(value > 0.0 && value.is_finite(), "{value} at {x}: {}", field.expression);
        let printed = python::evaluate(&field.expression, x).unwrap();
        assert!((printed / value - 1.0).abs() < 1e-9, "{printed} and {value} at {x}: {}", field.expression);
    }
    for (&s, &e) in s.iter().zip(e) {
        largest = largest.max((field.evaluate(s) / e - 1.0).abs());
    }
    assert!(100.0 * largest <= field.max_error_percent * (1.0 + 1e-6) + 1e-9, "{largest} {}", field.max_error_percent);
    field
}

#[test]
fn the_papers_shapes_need_few_terms() {
    let polynomial = |c: &[f64], n, r| inclination_polynomial(c, n, r, 1001);
    let nose_cone = [26.52, -116.3, 162.3, -132.0, 63.5, -47.14, 18.64, 41.56];
    let trumpet = [-11340.0, 49160.0, -86720.0, 79040.0, -38440.0, 8860.0, -564.5, 87.1, 6.467];
    let roof = [6395.0, -28300.0, 52140.0, -51860.0, 30530.0, -11170.0, 2808.0, -570.8, 89.7];
    // Name, moduli, contrast, terms.
    let shapes = [
        ("hemisphere", polynomial(&[-90.0, 90.0], 8, 0.1), 2.316, 3),
        ("nose cone", polynomial(&nose_cone, 12, 0.05), 6.313, 4),
        ("trumpet", polynomial(&trumpet, 8, 0.05), 9.631, 6),
        ("roof", polynomial(&roof, 6, 0.2), 9.963, 3),
        ("hemi-ellipsoid 0.5", hemi_ellipsoid(0.5, 8, 1001), 1.741, 3),
        ("hemi-ellipsoid 2", hemi_ellipsoid(2.0, 8, 1001), 2.232, 3),
    ];
    for (name, e, contrast, terms) in shapes {
        let lowest = e.iter().copied().fold(f64::INFINITY, f64::min);
        assert!((12.6 / lowest - contrast).abs() < 1e-3, "{name}: contrast {}", 12.6 / lowest);
        let field = checked(&stations(1001, LENGTH_MM), &e, LENGTH_MM);
        assert!(field.meets_target(), "{name}: {}", field.max_error_percent);
        assert!(matches!(field.family, ModulusFamily::Gaussians(_)), "{name}: {:?}", field.family);
        assert_eq!(field.terms, terms, "{name}: {}", field.expression);
    }
}

#[test]
fn a_constant_modulus_is_one_number() {
    for modulus in [12.6, 1.0 / 3.0, 2033.33, 10_200.0] {
        let field = fit(80.0, 201, |_| modulus);
        assert_eq!(field.max_error_percent, 0.0);
        assert_eq!(field.expression.parse::<f64>().unwrap(), modulus);
        assert!(field.expression.contains('.'));
        assert_eq!(field.family, ModulusFamily::Constant { modulus_mpa: modulus });
        assert_eq!(field.terms, 1);
    }
    // Rounding noise of a solver does not show.
    assert_eq!(fit(80.0, 201, |s| 12.6 + 1e-13 * (40.0 * s).sin()).expression, "12.6");
}

#[test]
fn one_gaussian_is_recovered() {
    let field = fit(100.0, 1001, |s| 12.6 * (-((s - 61.5) / 42.25).powi(2)).exp());
    assert_eq!(field.expression, "12.6*exp(-pow((X-61.5)/42.25,2.0))");
    assert!(field.max_error_percent < 1e-4);
    // The centre may lie off the strip, or on the rim.
    let off = fit(40.0, 201, |s| 3330.0 * (-((s + 12.5) / 30.0).powi(2)).exp());
    assert_eq!(off.expression, "3330.0*exp(-pow((X+12.5)/30.0,2.0))");
    let narrow = fit(100.0, 1001, |s| 9.0 * (-((s - 20.0) / 15.0).powi(2)).exp());
    assert_eq!(narrow.expression, "9.0*exp(-pow((X-20.0)/15.0,2.0))");
}

#[test]
fn a_steep_exponential_is_a_polynomial_of_degree_one() {
    let field = fit(100.0, 1001, |s| 0.62 * (0.08 * s).exp());
    assert_eq!(field.terms, 2, "{}", field.expression);
    assert!(matches!(field.family, ModulusFamily::ExponentialPolynomial(_)));
    assert!(field.meets_target());
}

#[test]
fn strips_of_any_length_and_few_stations_fit() {
    for length in [0.37, 40.0, 73.2, 1234.5678] {
        for count in [20, 21, 201, 2001] {
            let field = fit(length, count, |s| 5.0 + 4.0 * (5.0 * s / length).sin());
            assert!(field.meets_target(), "{length} {count}: {}", field.max_error_percent);
        }
    }
}

#[test]
fn noise_comes_back_with_its_error() {
    let mut state = 1_u64;
    let mut noise = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as f64 / f64::from(1_u32 << 31)
    };
    let s = stations(1001, LENGTH_MM);
    let e: Vec<f64> = s.iter().map(|_| 1.0 + 9.0 * noise()).collect();
    let field = checked(&s, &e, LENGTH_MM);
    assert!(!field.meets_target() && field.max_error_percent < 1000.0, "{}", field.max_error_percent);
    let steps: Vec<f64> = s.iter().map(|&s| if s < 50.0 { 3.1 } else { 12.6 }).collect();
    let field = checked(&s, &steps, LENGTH_MM);
    assert!(!field.meets_target(), "{}", field.expression);
}

#[test]
fn a_corner_is_followed_as_well_as_it_can_be() {
    let field = fit(100.0, 1001, |s| 1.0 + (s - 40.0).abs() / 20.0);
    assert!(field.max_error_percent < 5.0, "{}", field.max_error_percent);
}

#[test]
fn the_same_data_gives_the_same_field() {
    let e = hemi_ellipsoid(0.5, 8, 401);
    let s = stations(401, LENGTH_MM);
    assert_eq!(ModulusField::fit(&s, &e, LENGTH_MM), ModulusField::fit(&s, &e, LENGTH_MM));
}

#[test]
fn json_has_the_keys_hosts_read() {
    let value = serde_json::to_value(fit(100.0, 201, |s| 12.6 * (-((s - 60.0) / 80.0).powi(2)).exp())).unwrap();
    assert_eq!(value["expression"], "12.6*exp(-pow((X-60.0)/80.0,2.0))");
    assert_eq!(value["variable"], "X");
    assert_eq!(value["unit"], "MPa");
    assert!(value["max_error_percent"].as_f64().unwrap() < 0.5);
    assert_eq!(value["terms"], 1);
    assert_eq!(value["family"], "gaussians");
    assert_eq!(value["parameters"][0]["centre_mm"], 60.0);
    let polynomial = serde_json::to_value(fit(100.0, 201, |s| (0.02 * s).exp())).unwrap();
    assert_eq!(polynomial["family"], "exponential-polynomial");
    assert_eq!(polynomial["parameters"]["half_length_mm"], 50.0);
    assert_eq!(serde_json::to_value(fit(100.0, 201, |_| 2.0)).unwrap()["family"], "constant");
}

#[test]
fn unusable_data_is_named() {
    let s = stations(21, 100.0);
    let e = vec![5.0; 21];
    let bad = |s: &[f64], e: &[f64], length| ModulusField::fit(s, e, length).unwrap_err();
    assert_eq!(bad(&s[..19], &e[..19], 100.0), ModulusFieldError::TooFewStations { count: 19 });
    assert_eq!(bad(&[], &[], 100.0), ModulusFieldError::TooFewStations { count: 0 });
    assert_eq!(bad(&s, &e[..20], 100.0), ModulusFieldError::CountMismatch { stations: 21, moduli: 20 });
    for length in [0.0, -1.0, f64::INFINITY] {
        assert_eq!(bad(&s, &e, length), ModulusFieldError::Length { value_mm: length });
    }
    assert!(matches!(bad(&s, &e, f64::NAN), ModulusFieldError::Length { .. }));
    for value_mpa in [0.0, -3.1, f64::INFINITY, 1e-300] {
        let mut e = e.clone();
        e[4] = value_mpa;
        let error = bad(&s, &e, 100.0);
        assert_eq!(error, ModulusFieldError::Modulus { s_mm: 20.0, value_mpa });
        assert!(error.to_string().contains(&value_mpa.to_string()), "{error}");
    }
    let mut moved = s.clone();
    moved[7] = 36.0;
    assert_eq!(bad(&moved, &e, 100.0), ModulusFieldError::Station { index: 7, value_mm: 36.0, expected_mm: 35.0 });
    moved[7] = f64::NAN;
    assert!(matches!(bad(&moved, &e, 100.0), ModulusFieldError::Station { index: 7, .. }));
    assert!(matches!(bad(&s, &e, 90.0), ModulusFieldError::Station { index: 1, .. }));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, ..ProptestConfig::default() })]

    #[test]
    fn any_smooth_positive_modulus_gives_a_positive_field(
        waves in prop::collection::vec((-1.5..1.5, 0.0..6.3, 0.2..4.0), 1..4),
        scale in -6.0..6.0,
        length in 0.5..2000.0,
        count in 20_usize..300,
    ) {
        let waves: Vec<(f64, f64, f64)> = waves;
        let (scale, length): (f64, f64) = (scale, length);
        let field = fit(length, count, |s| {
            let log: f64 = waves.iter().map(|(a, phase, k)| a * (k * s / length * 3.0 + phase).cos()).sum();
            10.0_f64.powf(scale) * log.exp()
        });
        prop_assert!(field.max_error_percent < 25.0, "{}", field.max_error_percent);
    }

    #[test]
    fn any_positive_modulus_gives_a_positive_field(
        logs in prop::collection::vec(-69.0..69.0, 20..60),
    ) {
        let logs: Vec<f64> = logs;
        let s = stations(logs.len(), 100.0);
        let e: Vec<f64> = logs.iter().map(|l| l.exp()).collect();
        prop_assert!(checked(&s, &e, 100.0).max_error_percent.is_finite());
    }
}

/// Strips graded linearly from both ends to the middle: a kink that smooth families cannot follow.
#[test]
fn a_kink_in_the_middle_is_two_straight_lines() {
    let s: Vec<f64> = (0..=1000).map(|i| 0.04 * f64::from(i)).collect();
    for (ends, middle) in [(12.6, 6.3), (6.3, 12.6)] {
        let modulus: Vec<f64> = s.iter().map(|s| middle + (ends - middle) * (s / 20.0 - 1.0).abs()).collect();
        let field = ModulusField::fit(&s, &modulus, 40.0).unwrap();
        assert_eq!(field.terms, 2, "{}", field.expression);
        assert!(field.max_error_percent < 0.05, "{field:?}");
        assert!(field.expression.contains("pow(pow(X-"), "{field:?}");
        assert!((field.evaluate(10.0) - 0.5 * (ends + middle)).abs() < 1e-9);
    }
}
