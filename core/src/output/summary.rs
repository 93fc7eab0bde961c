//! The figures that sum up a design.

use std::f64::consts::PI;

use serde::Serialize;

use crate::design::Design;
use crate::elastica::forward::EndForces;

/// `summary` of `design.json`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Summary {
    /// Largest over smallest designed modulus.
    pub contrast: f64,
    /// Contrast that the phases reach.
    pub contrast_reach: f64,
    /// Forces at the end of the morph.
    pub thrust: Thrust,
    /// `1 - x(L)/L`.
    pub compression: f64,
    /// Inclination at the rim, degrees.
    pub rim_angle_deg: f64,
    /// Inclination at the hub, degrees.
    pub hub_angle_deg: f64,
    /// Height of the hub above the rim, mm.
    pub height_mm: f64,
    /// Distance of the rim from the axis in the morphed state, mm.
    pub rim_radius_mm: f64,
    /// Largest distance of the voxelised strip's predicted mid-line from the target, percent of the length.
    pub predicted_error_percent: Option<f64>,
    /// What finite elements corrected, where they did.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub refinement: Option<Refined>,
    /// Volumes.
    pub volume_mm3: Volumes,
    /// Slices and layers of the voxel lattice.
    pub lattice: LatticeSummary,
    /// Voxels of one spoke by phase.
    pub voxels: serde_json::Map<String, serde_json::Value>,
    /// Voxels of one spoke.
    pub voxels_per_spoke: u64,
}

/// A correction of the modulus by finite elements: largest distance of the strip's mid-line from the target.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Refined {
    /// Without a correction, percent of the length.
    pub error_before_percent: f64,
    /// With the one that was kept.
    pub error_after_percent: f64,
    /// Solutions that were spent.
    pub solutions: usize,
}

impl Refined {
    fn of(design: &Design) -> Option<Self> {
        let errors = &design.input().refine.as_ref()?.errors_percent;
        let best = errors.iter().copied().fold(f64::INFINITY, f64::min);
        Some(Self { error_before_percent: *errors.first()?, error_after_percent: best, solutions: errors.len() })
    }
}

/// Forces of one spoke and of all, for beam bending and for plane strain across the width.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Thrust {
    /// One spoke.
    pub per_spoke: Bending,
    /// All spokes.
    pub total: Bending,
}

/// The two limits of bending: a narrow strip (beam) and a wide one (plane strain, stiffer by `1/(1 - nu^2)`).
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Bending {
    /// Beam bending.
    pub beam: Forces,
    /// Plane strain.
    pub plane_strain: Forces,
}

/// Reactions at the ends.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Forces {
    /// Horizontal force `H`, N; positive when the seat pushes the rim inward.
    pub horizontal_n: f64,
    /// Vertical force `V`, N; positive when the hub is pushed up.
    pub vertical_n: f64,
    /// Moment at the rim, N mm.
    pub rim_moment_nmm: f64,
    /// Moment at the hub, N mm.
    pub hub_moment_nmm: f64,
}

/// Volumes, mm^3.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Volumes {
    /// One spoke with smooth edges.
    pub spoke_smooth: f64,
    /// One spoke of voxels.
    pub spoke_voxels: f64,
    /// The hub: a regular polygon of the spokes' thickness.
    pub hub: f64,
    /// Smooth spokes and hub.
    pub flower: f64,
}

/// The voxel lattice.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct LatticeSummary {
    /// Slices along the spoke.
    pub slices: usize,
    /// Layers through the thickness.
    pub layers: usize,
    /// Slices whose wanted modulus lies outside what the phases reach.
    pub clamped_slices: usize,
}

impl Summary {
    /// Sums up a design.
    #[must_use]
    pub fn of(design: &Design) -> Self {
        let input = design.input();
        let profile = design.profile();
        let last = profile.s.len() - 1;
        let length = input.strips.length_mm;
        let (count, thickness) = (input.count() as f64, input.strips.thickness_mm);
        let spoke_smooth = thickness * simpson(&profile.width, length);
        let hub =
            if input.is_strip() { 0.0 } else { count * (PI / count).tan() * input.hub_radius().powi(2) * thickness };
        let counts = design.grid().counts(design.phases().phases().len());
        let labels = design.phases().phases().iter().map(crate::materials::Material::label);
        Self {
            contrast: design.contrast(),
            contrast_reach: design.phases().reach(),
            thrust: thrust(design),
            compression: 1.0 - profile.x[last] / length,
            rim_angle_deg: profile.inclination[0].to_degrees(),
            hub_angle_deg: profile.inclination[last].to_degrees(),
            height_mm: profile.z[last],
            rim_radius_mm: profile.rho[0],
            predicted_error_percent: design.predicted_error().map(|e| 100.0 * e),
            refinement: Refined::of(design),
            volume_mm3: Volumes {
                spoke_smooth,
                spoke_voxels: design.grid().volume_mm3(),
                hub,
                flower: count * spoke_smooth + hub,
            },
            lattice: LatticeSummary {
                slices: design.grid().slices(),
                layers: design.grid().layers(),
                clamped_slices: design.slices().iter().filter(|s| s.clamped).count(),
            },
            voxels: labels.zip(counts.iter().map(|n| (*n).into())).collect(),
            voxels_per_spoke: counts.iter().sum(),
        }
    }
}

/// Composite Simpson rule over an odd number of evenly spaced samples.
fn simpson(values: &[f64], length: f64) -> f64 {
    let last = values.len() - 1;
    let weight = |i: usize| if i == 0 || i == last { 1.0 } else { 2.0 + 2.0 * (i % 2) as f64 };
    values.iter().enumerate().map(|(i, v)| weight(i) * v).sum::<f64>() * length / (3.0 * last as f64)
}

fn thrust(design: &Design) -> Thrust {
    let profile = design.profile();
    let last = profile.s.len() - 1;
    // A clamped strip's forces are those of its equilibrium; a dome's follow from the line of thrust.
    let forces = match (design.inverse(), design.graded_path()) {
        (None, Ok(Some(path))) => path.final_shape().forces,
        _ => design.forces(),
    };
    let hub_moment = forces.moment(profile.x[last], profile.z[last]);
    let of = |factor: f64| scaled(&forces, hub_moment, factor);
    let plane_strain = 1.0 / (1.0 - design.mean_poisson().powi(2));
    let count = design.input().count() as f64;
    Thrust {
        per_spoke: Bending { beam: of(1.0), plane_strain: of(plane_strain) },
        total: Bending { beam: of(count), plane_strain: of(count * plane_strain) },
    }
}

fn scaled(forces: &EndForces, hub_moment: f64, factor: f64) -> Forces {
    Forces {
        horizontal_n: factor * forces.horizontal,
        vertical_n: factor * forces.vertical,
        rim_moment_nmm: factor * forces.rim_moment,
        hub_moment_nmm: factor * hub_moment,
    }
}
