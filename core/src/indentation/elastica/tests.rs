//! Published and closed-form figures of pressed domes.

use std::path::Path;

use super::*;
use crate::input::files::Format;
use crate::input::{Bending, Indenter};
use crate::progress::unseen;
use crate::{DesignInput, Limits};

fn dome(aspect: f64) -> Design {
    let text = format!(
        "[target]\nkind = \"hemi-ellipsoid\"\naspect_ratio = {aspect}\n[strips]\ncount = 8\nlength_mm = 100.0\n\
         hub_radius_mm = 10.0\nthickness_mm = 2.0\n[materials]\nphases = [\"FLX9070\", \"FLX9095\"]\n[voxels]\n\
         size_mm = 1.0\n"
    );
    computed(&text)
}

/// A hemisphere whose hub is held.
fn held() -> Design {
    computed(
        "[target]\nkind = \"hemi-ellipsoid\"\naspect_ratio = 1.0\n[strips]\ncount = 8\nlength_mm = 100.0\nhub_radius_mm = \
         10.0\nthickness_mm = 2.0\n[thrust]\nhub = \"held\"\n[materials]\nphases = [\"FLX9070\", \"FLX9095\"]\n\
         [voxels]\nsize_mm = 1.0\n",
    )
}

fn computed(text: &str) -> Design {
    let input = DesignInput::from_text(text, Format::Toml, "dome.toml", "dome", Path::new(".")).unwrap();
    Design::compute(&input, Limits::default()).unwrap()
}

fn hub() -> IndentationInput {
    IndentationInput { indenter: Indenter::Hub, ..IndentationInput::default() }
}

fn close(found: f64, expected: f64, share: f64) {
    assert!((found / expected - 1.0).abs() <= share, "{found} instead of {expected}");
}

/// The published figures are for a largest modulus of 12.6 MPa; whole voxels leave a little less. Forces are proportional.
fn scale(design: &Design) -> f64 {
    design.peak_modulus() / 12.6
}

#[test]
fn the_hemisphere_without_contact() {
    let design = dome(1.0);
    let (found, scale) = (indent(&design, &hub(), &unseen).unwrap(), scale(&design));
    close(found.secant(0.5).unwrap() / scale, 0.0281, 0.01);
    close(found.secant(1.0).unwrap() / scale, 0.0270, 0.01);
    close(found.tangent_n_mm / scale, 0.0293, 0.01);
    close(found.force_at(10.0).unwrap() / scale, 0.156, 0.01);
    assert!(found.curve.iter().all(|p| p.contact_force_n == 0.0));
    // The tangent is the limit of secants, and K lies between it and the secant at the thickness.
    let fine = IndentationInput { depth_mm: Some(0.01), ..hub() };
    close(indent(&design, &fine, &unseen).unwrap().secant(0.01).unwrap(), found.tangent_n_mm, 1e-3);
    assert!(found.rigidity_n_mm < found.tangent_n_mm && found.rigidity_n_mm > found.secant(2.0).unwrap());
}

#[test]
fn the_multiple_shooting_finds_the_same_forces() {
    use crate::elastica::forward::{EndConditions, solve};
    for design in [dome(1.0), held()] {
        let path = design.graded_path().unwrap().unwrap();
        let (ends, start) = (path.guide().ends(1.0), path.final_shape());
        let found = indent(&design, &IndentationInput { depth_mm: Some(4.0), steps: 8, ..hub() }, &unseen).unwrap();
        let mut shape = start.clone();
        for point in &found.curve[1..] {
            let height = start.z.last().unwrap() - point.depth_mm;
            let ends = EndConditions { height: Some(height), ..ends };
            shape = solve(&design.graded_stiffness_times(|_| 1.0), 100.0, &ends, &shape).unwrap();
            close(point.force_n, start.forces.vertical - shape.forces.vertical, 2e-3);
        }
    }
}

#[test]
fn the_indenter_takes_over_once_the_moment_at_the_hub_changes_sign() {
    let design = dome(1.0);
    let (found, scale) = (indent(&design, &IndentationInput::default(), &unseen).unwrap(), scale(&design));
    let first = found.curve.iter().find(|p| p.contact_force_n > 0.0).unwrap();
    assert!((3.2..3.6).contains(&first.depth_mm), "{}", first.depth_mm);
    // CalculiX on a solid strip, which is stiffer than a beam and less so than plane strain.
    let plate = IndentationInput { bending: Bending::PlaneStrain, ..IndentationInput::default() };
    let plate = indent(&design, &plate, &unseen).unwrap();
    for (depth, solid) in [(1.0, 0.0286), (5.0, 0.119), (10.0, 0.243)] {
        let [beam, plate] = [&found, &plate].map(|f| f.force_at(depth).unwrap() / scale);
        assert!(beam < solid && solid < plate, "{depth}: {beam} {solid} {plate}");
        close(plate / beam, 1.0 / 0.91, 1e-9);
    }
    // No penetration, no tension, and where it lies on the plate the strip is flat and carries no moment there.
    assert!(found.penetration_mm < 0.01 * 2.0, "{}", found.penetration_mm);
    assert!(found.curve.iter().all(|p| p.contact_force_n >= 0.0));
    let [work, energy] = found.energy_balance();
    close(work, energy, 0.01);
}

#[test]
fn work_is_energy_with_a_hub_that_carries_a_force_before() {
    let design = held();
    let found = indent(&design, &IndentationInput::default(), &unseen).unwrap();
    assert!(found.start_force_n.abs() > 1e-3);
    let [work, energy] = found.energy_balance();
    close(work, energy, 0.01);
}

#[test]
fn hemi_ellipsoids_are_least_rigid_near_the_hemisphere() {
    let unit = 12.6 * 8.0 / (12.0 * 1e4);
    let expected = [54.4, 42.7, 37.3, 34.5, 33.4, 33.4, 34.2];
    for (i, expected) in expected.into_iter().enumerate() {
        let design = dome(0.6 + 0.1 * i as f64);
        let found = indent(&design, &hub(), &unseen).unwrap();
        close(found.secant(0.5).unwrap() / (unit * scale(&design)), expected, 0.01);
        close(indent_for_rigidity(&design, &hub(), &unseen).unwrap().rigidity_n_mm, found.rigidity_n_mm, 1e-3);
    }
}

#[test]
fn all_domes_are_pressed_with_and_without_contact() {
    for shape in ["-90.0, 90.0", "26.52, -116.3, 162.3, -132.0, 63.5, -47.14, 18.64, 41.56"] {
        let text = format!(
            "[target]\nkind = \"inclination-polynomial\"\ncoefficients_deg = [{shape}]\n[strips]\ncount = 12\nlength_mm \
             = 100.0\nhub_radius_mm = 5.0\nthickness_mm = 2.0\n[materials]\nphases = [\"TangoBlack\", \"FLX9095\"]\n\
             [voxels]\nsize_mm = 1.0\n"
        );
        let design = computed(&text);
        for indenter in [Indenter::Flat, Indenter::Hub] {
            let input = IndentationInput { indenter, ..IndentationInput::default() };
            let found = indent(&design, &input, &unseen).unwrap();
            let [work, energy] = found.energy_balance();
            close(work, energy, 0.01);
            assert!(found.penetration_mm < 0.02, "{}", found.penetration_mm);
        }
    }
}

#[test]
fn what_cannot_be_pressed_says_so() {
    let strip = computed(
        "[target]\nkind = \"strip\"\nwidth_mm = 12.0\nmodulus_ratio = 2.0\nshortening = 0.5\n[strips]\nlength_mm = 40.0\n\
         thickness_mm = 2.0\n[materials]\nphases = [\"FLX9070\", \"FLX9095\"]\n[voxels]\nsize_mm = 1.0\n",
    );
    assert_eq!(indent(&strip, &hub(), &unseen), Err(IndentationError::NotADome));
    let deep = IndentationInput { depth_mm: Some(200.0), ..hub() };
    let error = indent(&dome(1.0), &deep, &unseen).unwrap_err();
    assert!(error.to_string().contains("height"), "{error}");
    for stop in 0..5 {
        let asked = std::sync::atomic::AtomicUsize::new(0);
        let until = |_: f64| asked.fetch_add(1, std::sync::atomic::Ordering::Relaxed) < stop;
        assert_eq!(indent(&dome(1.0), &hub(), &until), Err(IndentationError::Cancelled));
        assert_eq!(asked.into_inner(), stop + 1);
    }
}
