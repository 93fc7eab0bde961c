//! The inverse and the forward problem against published figures, independent tables and closed forms.

use std::f64::consts::FRAC_PI_2;
use std::path::Path;

use voxelastica_core::elastica::forward::{self, EndConditions, EndForces, Equilibrium, Section, StripStiffness};
use voxelastica_core::elastica::morph::{Guide, MorphPath};
use voxelastica_core::elastica::tessellation::{width, widths};
use voxelastica_core::elastica::{ElasticaError, HubSupport, InverseSolution, ThrustChoice, inverse};
use voxelastica_core::target::{EllipseMeridian, MeridianCurve, MeridianPoint, PolynomialMeridian};

const LENGTH: f64 = 100.0;

struct Shape {
    name: &'static str,
    curve: Box<dyn MeridianCurve>,
    count: usize,
    hub_radius: f64,
}

fn polynomial(name: &'static str, coefficients: &[f64], count: usize, hub_radius: f64) -> Shape {
    Shape { name, curve: Box::new(PolynomialMeridian::new(coefficients, LENGTH).unwrap()), count, hub_radius }
}

fn ellipse(name: &'static str, ratio: f64) -> Shape {
    Shape { name, curve: Box::new(EllipseMeridian::new(ratio, LENGTH).unwrap()), count: 8, hub_radius: 10.0 }
}

fn shapes() -> Vec<Shape> {
    vec![
        polynomial("hemisphere", &[-90.0, 90.0], 8, 10.0),
        polynomial("nose_cone", &[26.52, -116.3, 162.3, -132.0, 63.5, -47.14, 18.64, 41.56], 12, 5.0),
        polynomial("trumpet", &[-11340.0, 49160.0, -86720.0, 79040.0, -38440.0, 8860.0, -564.5, 87.1, 6.467], 8, 5.0),
        polynomial("roof", &[6395.0, -28300.0, 52140.0, -51860.0, 30530.0, -11170.0, 2808.0, -570.8, 89.7], 6, 20.0),
        ellipse("hemi_ellipsoid_0.5", 0.5),
        ellipse("hemi_ellipsoid_2.0", 2.0),
    ]
}

impl Shape {
    fn stations(&self, count: usize) -> (Vec<MeridianPoint>, Vec<f64>) {
        let stations = self.curve.stations(count);
        let end = stations.last().unwrap().x;
        let widths = widths(self.count, stations.iter().map(|p| (p.s, self.hub_radius + end - p.x))).unwrap();
        (stations, widths)
    }

    fn solve(&self, count: usize, support: HubSupport, choice: ThrustChoice) -> InverseSolution {
        let (stations, widths) = self.stations(count);
        inverse::solve(self.curve.as_ref(), &stations, &widths, support, choice).unwrap()
    }
}

fn table(name: &str) -> Vec<Vec<f64>> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/reference").join(format!("{name}.csv"));
    let text = std::fs::read_to_string(path).unwrap();
    text.lines().skip(1).map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect()).collect()
}

#[test]
fn free_standing_designs_reproduce_the_reference_tables() {
    for shape in shapes() {
        let rows = table(shape.name);
        let (stations, widths) = shape.stations(rows.len());
        let solution = shape.solve(rows.len(), HubSupport::Free, ThrustChoice::EqualEnds);
        for (k, row) in rows.iter().enumerate() {
            let p = &stations[k];
            let rho = shape.hub_radius + stations.last().unwrap().x - p.x;
            let own = [p.s, p.inclination.to_degrees(), p.x, p.z, rho, widths[k]];
            for (column, (own, reference)) in own.iter().zip(row).enumerate() {
                let tolerance = if column == 1 { 1e-4 } else { 1e-6 * LENGTH };
                assert!((own - reference).abs() <= tolerance, "{} row {k} column {column}: {own}", shape.name);
            }
            let near = solution.inflections.iter().any(|i| (i.s - p.s).abs() <= 0.01 * LENGTH);
            let tolerance = if near { 1e-3 } else { 1e-4 };
            let own = solution.modulus_ratio[k];
            assert!((own - row[6]).abs() <= tolerance, "{} row {k}: {own} {}", shape.name, row[6]);
        }
    }
}

#[test]
fn contrasts_agree_with_the_published_and_the_optimal_ones() {
    let expected = [
        ("hemisphere", 2.316, 2.316, 1.000),
        ("nose_cone", 6.313, 6.31, 1.93),
        ("trumpet", 9.631, 9.26, 2.86),
        ("roof", 9.963, 9.96, 8.87),
        ("hemi_ellipsoid_0.5", 1.741, 1.600, 1.535),
        ("hemi_ellipsoid_2.0", 2.232, 1.768, 1.713),
    ];
    for (shape, (name, equal_ends, free, held)) in shapes().iter().zip(expected) {
        assert_eq!(shape.name, name);
        for (support, choice, expected) in [
            (HubSupport::Free, ThrustChoice::EqualEnds, equal_ends),
            (HubSupport::Free, ThrustChoice::LeastContrast, free),
            (HubSupport::Held, ThrustChoice::LeastContrast, held),
        ] {
            let contrast = shape.solve(1001, support, choice).contrast;
            println!("{name} {support:?} {choice:?}: {contrast:.4}");
            assert!((contrast / expected - 1.0).abs() < 5e-3, "{name} {support:?} {choice:?}: {contrast}");
        }
    }
}

/// `B(s)` of the exact inverse solution in units of `E_max t^3 / 12`, at `2 n + 1` points.
fn smooth_stiffness(shape: &Shape, solution: &InverseSolution, steps: usize) -> StripStiffness {
    let (stations, widths) = shape.stations(2 * steps + 1);
    let section = |(p, w): (&MeridianPoint, &f64)| Section {
        stiffness: w * solution.ratio_at(p, *w, LENGTH),
        neutral_offset: 0.0,
    };
    StripStiffness::Smooth(stations.iter().zip(&widths).map(section).collect())
}

fn forces(solution: &InverseSolution, rim: &MeridianPoint) -> EndForces {
    EndForces {
        rim_moment: solution.thrust.moment(rim.x, rim.z),
        horizontal: solution.thrust.horizontal,
        vertical: solution.thrust.vertical,
    }
}

#[test]
fn the_forward_problem_returns_the_target_of_the_inverse_problem() {
    for shape in shapes() {
        for (support, choice) in
            [(HubSupport::Free, ThrustChoice::EqualEnds), (HubSupport::Held, ThrustChoice::LeastContrast)]
        {
            let solution = shape.solve(1001, support, choice);
            let stiffness = smooth_stiffness(&shape, &solution, 500);
            let (stations, _) = shape.stations(501);
            // A guess that is off, so that Newton's method has something to do.
            let exact = forces(&solution, &stations[0]);
            let guess = EndForces { rim_moment: 1.02 * exact.rim_moment, ..exact };
            let guide = Guide::Target { stations: stations.clone(), support };
            let path = MorphPath::new(stiffness, guide, guess).unwrap();
            let found = path.final_shape();
            let worst = stations
                .iter()
                .zip(found.x.iter().zip(&found.z))
                .map(|(p, (x, z))| (p.x - x).hypot(p.z - z))
                .fold(0.0, f64::max);
            println!("{} {support:?}: {worst:.2e} mm, {} iterations", shape.name, found.iterations);
            assert!(worst < 1e-6 * LENGTH, "{} {support:?}: {worst}", shape.name);
            assert!((found.forces.horizontal - exact.horizontal).abs() < 1e-6 * exact.horizontal.abs().max(1e-3));
            // Half-way, the ends are where they were asked to be and the strip is in equilibrium there.
            let half = path.at(0.5).unwrap();
            let ends = path.guide().ends(0.5);
            assert!((half.x.last().unwrap() - ends.span).abs() < 1e-8 * LENGTH);
            assert!((half.inclination.last().unwrap() - ends.hub_angle).abs() < 1e-8);
            for fraction in [0.0, 1e-5, 1e-3, 0.02, 0.3, 0.99] {
                let at = path.at(fraction).unwrap_or_else(|e| panic!("{} {support:?} {fraction}: {e}", shape.name));
                assert!((at.x.last().unwrap() - path.guide().ends(fraction).span).abs() < 1e-6 * LENGTH);
            }
        }
    }
}

#[test]
fn a_uniform_held_hemisphere_is_exact_and_needs_no_horizontal_force() {
    let shape = &shapes()[0];
    let solution = shape.solve(1001, HubSupport::Held, ThrustChoice::LeastContrast);
    assert!((solution.contrast - 1.0).abs() < 1e-9);
    assert!(solution.thrust.horizontal.abs() < 1e-9);
    // V = w' theta' E t^3/12 with w' = -2 tan(pi/N) cos(theta): M' = -V cos(theta).
    let (modulus, thickness) = (12.6, 2.0_f64);
    let curvature = -FRAC_PI_2 / LENGTH;
    let exact = modulus * thickness.powi(3) / 12.0 * width(8, 1.0) * curvature;
    let total = 8.0 * exact;
    let own = 8.0 * solution.thrust.vertical * modulus * thickness.powi(3) / 12.0;
    assert!((own - total).abs() < 1e-9, "{own} {total}");
    assert!((own + 0.87).abs() < 0.005, "{own}");
}

#[test]
fn clamped_rectangular_strips_reproduce_the_reference_tables() {
    for (name, ratio) in [("rectangular_0.5", 0.5), ("rectangular_1", 1.0), ("rectangular_2", 2.0)] {
        let steps = 800;
        let sections = (0..=2 * steps)
            .map(|i| {
                let xi = f64::from(i) / f64::from(2 * steps);
                Section { stiffness: 1.0 + (ratio - 1.0) * (1.0 - (2.0 * xi - 1.0).abs()), neutral_offset: 0.0 }
            })
            .collect();
        let guide = Guide::Clamped { length_mm: 1.0, shortening: 0.6 };
        let path = MorphPath::new(StripStiffness::Smooth(sections), guide, EndForces::default()).unwrap();
        let found = path.final_shape();
        for row in table(name) {
            let [x, z] = found.position(row[0]);
            assert!((x - row[2]).hypot(z - row[3]) < 1e-6, "{name} at {}: {x} {z} {} {}", row[0], row[2], row[3]);
        }
        assert!(found.forces.vertical.abs() < 1e-8);
    }
}

#[test]
fn a_bilayer_strip_in_pure_bending_has_its_closed_form() {
    // Constant moment: the neutral line is an arc of angle L M / B, the mid-line the concentric one offset by z_n.
    let (length, offset, curvature) = (10.0_f64, 0.3, 0.1);
    let sections = vec![Section { stiffness: 5.0, neutral_offset: offset }; 50];
    let angle = curvature * length;
    let radius = 1.0 / curvature + offset;
    let ends = EndConditions {
        rim_angle: 0.0,
        hub_angle: angle,
        span: radius * angle.sin(),
        height: Some(radius * (1.0 - angle.cos())),
    };
    let guess = Equilibrium {
        s: vec![0.0, length],
        inclination: vec![0.0, angle],
        x: vec![0.0, 0.8 * length],
        z: vec![0.0, 0.4 * length],
        forces: EndForces { rim_moment: 0.4, horizontal: 0.01, vertical: 0.0 },
        iterations: 0,
    };
    let found = forward::solve(&StripStiffness::Slices(sections), length, &ends, &guess).unwrap();
    assert!((found.forces.rim_moment - 0.5).abs() < 1e-9);
    assert!(found.forces.horizontal.abs() < 1e-9 && found.forces.vertical.abs() < 1e-9);
    let [x, z] = found.position(0.37 * length);
    let part = 0.37 * angle;
    assert!((x - radius * part.sin()).abs() < 1e-9 && (z - radius * (1.0 - part.cos())).abs() < 1e-9);
}

#[test]
fn infeasible_targets_say_where_and_what_would_help() {
    let solve = |coefficients: &[f64], support, choice| {
        let shape = polynomial("test", coefficients, 8, 10.0);
        let (stations, widths) = shape.stations(1001);
        inverse::solve(shape.curve.as_ref(), &stations, &widths, support, choice).map(|s| s.contrast)
    };
    // Two inflections: only a held hub reaches them; three: nothing does.
    let two = [300.0, -450.0, 180.0, 0.0];
    let error = solve(&two, HubSupport::Free, ThrustChoice::EqualEnds).unwrap_err();
    assert!(matches!(error, ElasticaError::TooManyInflections { count: 2, allowed: 1, .. }), "{error}");
    assert!(error.to_string().contains("held"), "{error}");
    let three = [-600.0, 1120.0, -672.0, 153.6, 0.0];
    let error = solve(&three, HubSupport::Held, ThrustChoice::LeastContrast).unwrap_err();
    assert!(matches!(error, ElasticaError::TooManyInflections { count: 3, allowed: 2, .. }), "{error}");
    assert!(matches!(
        solve(&[0.0, 30.0], HubSupport::Free, ThrustChoice::EqualEnds),
        Err(ElasticaError::Straight { .. })
    ));
    assert_eq!(solve(&[-90.0, 90.0], HubSupport::Held, ThrustChoice::EqualEnds), Err(ElasticaError::EqualEndsHeld));
}
