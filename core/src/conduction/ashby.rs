//! Modulus against conductivity: pure phases, mixtures by pattern and fraction, and bounds.

use serde::Serialize;

use super::heat::unit_strip;
use super::pcg::Watch;
use super::steady::{self, Boundary, SteadyOptions};
use super::strip::{Model, Property, Shape, Strip};
use crate::design::{Design, Limits};
use crate::error::Error;
use crate::input::{DesignInput, StripsInput, TargetInput};
use crate::materials::Material;
use crate::micromechanics::{hashin_shtrikman, reuss, voigt};
use crate::voxel::{Match, Pattern};

/// Patterns in the chart.
pub const PATTERNS: [Pattern; 6] = [
    Pattern::Random,
    Pattern::RandomLayered,
    Pattern::Centred,
    Pattern::Split,
    Pattern::ThroughThickness,
    Pattern::OneEdge,
];

/// Fractions of the stiffest phase.
const STEPS: u32 = 10;

/// The coupon: length, width, thickness and voxel, mm.
const COUPON: [f64; 4] = [20.0, 6.0, 2.0, 0.5];

/// From a conductivity per mm to one per m.
const PER_METRE: f64 = 1e3;

/// Points of a bound.
const BOUND_POINTS: u32 = 50;

/// A mixture in the chart.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Mixture {
    /// Its pattern.
    pub pattern: Pattern,
    /// Fraction of the stiffest phase that its voxels have.
    pub rigid_fraction: f64,
    /// Longitudinal modulus: Voigt in every slice, slices one behind the other, MPa.
    pub modulus_mpa: f64,
    /// Conductivity along the coupon by steady flow: W/(m K) or S/m.
    pub conductivity: f64,
}

/// Bounds at one fraction, lower and upper.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Bounds {
    /// Fraction of the stiffest phase.
    pub rigid_fraction: f64,
    /// Reuss and Voigt, MPa.
    pub modulus_mpa: [f64; 2],
    /// Hashin and Shtrikman, MPa.
    pub isotropic_modulus_mpa: [f64; 2],
    /// Series and parallel.
    pub conductivity: [f64; 2],
    /// Hashin and Shtrikman (1962).
    pub isotropic_conductivity: [f64; 2],
}

/// The chart of a pair of phases.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Ashby {
    /// `W/(m K)` or `S/m`.
    pub unit: &'static str,
    /// Thermal or electrical conductivity.
    pub quantity: &'static str,
    /// Name, modulus (MPa) and conductivity of the softest and the stiffest phase.
    pub phases: [(String, f64, f64); 2],
    /// Mixtures, pattern by pattern.
    pub mixtures: Vec<Mixture>,
    /// Bounds by fraction.
    pub bounds: Vec<Bounds>,
}

/// Hashin and Shtrikman's bounds on the conductivity of an isotropic mixture of two phases, lower first:
///
/// ```text
/// k = k_1 + f_2 / (1/(k_2 - k_1) + f_1 / (3 k_1))
/// ```
///
/// with the worse conductor as phase 1 for the lower bound, the better one for the upper.
#[must_use]
pub fn conductivity_bounds(first: f64, second: f64, second_fraction: f64) -> (f64, f64) {
    let one_way = |k1: f64, k2: f64, f2: f64| {
        let difference = k2 - k1;
        k1 + f2 * difference / (1.0 + difference * (1.0 - f2) / (3.0 * k1))
    };
    let (a, b) = (one_way(first, second, second_fraction), one_way(second, first, 1.0 - second_fraction));
    (a.min(b), a.max(b))
}

/// Computes the chart for the softest and the stiffest phase of a design.
///
/// # Errors
/// [`Error::Input`] for phases without that property, others of [`steady::solve`]; [`Error::Cancelled`].
pub fn chart(input: &DesignInput, property: Property, watch: Watch<'_>) -> Result<Ashby, Error> {
    let (unit, quantity) = match property {
        Property::ElectricalConductivity => ("S/m", "electrical conductivity"),
        _ => ("W/(m K)", "thermal conductivity"),
    };
    let set = input.phase_set()?;
    let (soft, stiff) = match set.phases() {
        [soft, .., stiff] => (soft.clone(), stiff.clone()),
        _ => return Err(Error::Internal("a set of less than two phases".to_owned())),
    };
    let [k_soft, k_stiff] = [&soft, &stiff].map(|m| property.of(m));
    let (k_soft, k_stiff) = (k_soft? * PER_METRE, k_stiff? * PER_METRE);
    let mut mixtures = Vec::new();
    let total = PATTERNS.len() * (STEPS as usize - 1);
    for pattern in PATTERNS {
        for step in 1..STEPS {
            let share = mixtures.len() as f64 / total as f64;
            watch.at(share)?;
            let fraction = f64::from(step) / f64::from(STEPS);
            let part = watch.part(share, share);
            mixtures.push(mixture(input, [&soft, &stiff], pattern, fraction, property, part)?);
        }
    }
    let bounds = (0..=BOUND_POINTS)
        .map(|i| {
            let f = f64::from(i) / f64::from(BOUND_POINTS);
            let (fractions, moduli) = ([1.0 - f, f], [soft.modulus_mpa, stiff.modulus_mpa]);
            let (low, high) = hashin_shtrikman(&soft, &stiff, f);
            let (k_low, k_high) = conductivity_bounds(k_soft, k_stiff, f);
            Bounds {
                rigid_fraction: f,
                modulus_mpa: [reuss(&fractions, &moduli), voigt(&fractions, &moduli)],
                isotropic_modulus_mpa: [low, high],
                conductivity: [reuss(&fractions, &[k_soft, k_stiff]), voigt(&fractions, &[k_soft, k_stiff])],
                isotropic_conductivity: [k_low, k_high],
            }
        })
        .collect();
    let phases = [(soft.name, soft.modulus_mpa, k_soft), (stiff.name, stiff.modulus_mpa, k_stiff)];
    Ok(Ashby { unit, quantity, phases, mixtures, bounds })
}

/// One coupon, filled and solved.
fn mixture(
    input: &DesignInput,
    phases: [&Material; 2],
    pattern: Pattern,
    fraction: f64,
    property: Property,
    watch: Watch<'_>,
) -> Result<Mixture, Error> {
    let [length_mm, width_mm, thickness_mm, size_mm] = COUPON;
    let mut coupon = input.clone();
    coupon.target =
        TargetInput::Strip { width_mm, modulus_ratio: None, rigid_fraction: Some(fraction), shortening: None };
    coupon.strips = StripsInput { count: None, length_mm, hub_radius_mm: None, thickness_mm };
    coupon.thrust = None;
    coupon.materials.phases = phases.map(|p| p.name.clone()).to_vec();
    coupon.voxels.size_mm = size_mm;
    coupon.voxels.pattern = pattern;
    coupon.voxels.matching = Match::Modulus;
    let design = Design::compute(&coupon, Limits::default())?;
    let strip = Strip::new_unless(&design, Model::Voxel, Shape::Flat, [1; 3], watch)?;
    let conductivities = strip.property(property)?;
    let mesh = &strip.mesh;
    let mut boundary = Boundary::insulated(mesh);
    boundary.give_plane(mesh, 0, 1.0);
    boundary.give_plane(mesh, mesh.cells()[0], 0.0);
    let options = SteadyOptions::default();
    let found = steady::solve(mesh, &conductivities, &boundary, &options, watch)?;
    let (unit, _) = unit_strip(&strip, watch)?;
    let slices = design.slices();
    let compliance = slices.iter().map(|s| 1.0 / s.modulus_mpa).sum::<f64>() / slices.len() as f64;
    Ok(Mixture {
        pattern,
        rigid_fraction: strip.fractions().last().copied().unwrap_or(0.0),
        modulus_mpa: 1.0 / compliance,
        conductivity: PER_METRE * found.slice_flux[0] / unit,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn isotropic_bounds_lie_between_series_and_parallel_and_have_maxwells_limit() {
        for i in 0..=10 {
            let f = f64::from(i) / 10.0;
            let (low, high) = conductivity_bounds(0.3155, 2.01, f);
            let (series, parallel) = (reuss(&[1.0 - f, f], &[0.3155, 2.01]), voigt(&[1.0 - f, f], &[0.3155, 2.01]));
            assert!(series <= low + 1e-12 && low <= high + 1e-12 && high <= parallel + 1e-12);
        }
        // Few perfectly conducting spheres: k_1 (1 + 3 f).
        let (low, _) = conductivity_bounds(1.0, 1e12, 1e-4);
        assert!((low - 1.000_3).abs() < 1e-7);
    }
}
