//! Domes under load: the hub is pressed down and the rim held.
//!
//! Three models give one type of result, [`Indentation`]:
//!
//! - [`elastica`]: the graded strip as a chain of bending links, with a flat indenter as an inequality; milliseconds;
//! - [`solid`]: the finite elements of [`crate::fem`], graded or with every voxel resolved, with the indenter and the
//!   neighbouring spokes as rigid planes;
//! - [`crate::results::pressed`]: CalculiX on the deck of one spoke under load.
//!
//! All figures are those of **one spoke**, above the state at which pressing starts (a held hub carries a force already).
//! `docs/indentation.md` derives both and holds them against CalculiX.

mod band;
mod curve;
pub mod elastica;
mod error;
pub mod output;
pub mod solid;

pub use band::{BandSource, ModulusBand};
pub use curve::{LoadPoint, rigidity, secant, tangent, work};
pub use error::IndentationError;
use serde::Serialize;

use crate::design::Design;
use crate::elastica::morph::Guide;
use crate::input::indentation::{DEPTH_SHARE, INDENTER_SHARE};
use crate::input::{Bending, IndentationInput, Indenter};
use crate::materials::StrainLimits;

/// What a curve was computed with.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum IndentationModel {
    /// The graded strip as an elastica.
    Elastica,
    /// The graded strip in finite elements.
    Graded,
    /// Every voxel in finite elements.
    Voxel,
    /// The graded strip in finite elements, by CalculiX.
    Calculix,
}

impl IndentationModel {
    /// The word of the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Elastica => "elastica",
            Self::Graded => "graded",
            Self::Voxel => "voxel",
            Self::Calculix => "calculix",
        }
    }
}

/// Largest strain of a phase.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PhaseStrain {
    /// Label of the phase, or `GRADED` for a mixture.
    pub label: String,
    /// Largest principal strain on the whole way, dimensionless.
    pub strain: f64,
    /// What the material stands, where that is known.
    pub limit: Option<f64>,
    /// Where it yields, where that is known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub yield_strain: Option<f64>,
}

impl PhaseStrain {
    pub(crate) fn new(label: String, strain: f64, limits: StrainLimits) -> Self {
        Self { label, strain, limit: limits.max_strain, yield_strain: limits.yield_strain }
    }

    /// The strain of a mixture, held against the phase that stands least.
    pub(crate) fn of_mixture(design: &Design, strain: f64) -> Self {
        Self::new("GRADED".to_owned(), strain, StrainLimits::of_mixture(design.phases().phases()))
    }

    /// What the user should know, where the strain is more than the material stands or yields at.
    pub(crate) fn warnings(&self) -> Vec<String> {
        StrainLimits { yield_strain: self.yield_strain, max_strain: self.limit }.warnings(&self.label, self.strain)
    }
}

/// What the user should know about a curve; `lost` is the depth at which its equilibrium becomes unstable.
pub(crate) fn curve_warnings(curve: &[LoadPoint], lost: Option<f64>) -> Vec<String> {
    let mut warnings = Vec::new();
    if let Some(depth) = lost {
        warnings
            .push(format!("from a depth of {depth:.3} mm on this equilibrium is unstable: the dome may bend unevenly"));
    }
    if let Some(pair) = curve.windows(2).find(|p| p[1].force_n < p[0].force_n) {
        warnings.push(format!(
            "the force falls beyond a depth of {:.3} mm: under a weight of {:.4} N a spoke the dome would snap through",
            pair[0].depth_mm, pair[0].force_n
        ));
    }
    warnings
}

/// Force-displacement curve of one spoke and what follows from it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Indentation {
    /// The model.
    pub model: IndentationModel,
    /// What presses.
    pub indenter: Indenter,
    /// How the elastica bends; absent for solids, which know.
    pub bending: Option<Bending>,
    /// Spokes of the dome: multiply forces and energies by it.
    pub spokes: usize,
    /// Force that pushes the hub of one spoke down before pressing starts, N; of a free hub zero.
    pub start_force_n: f64,
    /// Stiffness at no depth, `dF/dD`, N/mm.
    pub tangent_n_mm: f64,
    /// Rigidity `K`: the slope over depths of at most the thickness, N/mm ([`rigidity`]).
    pub rigidity_n_mm: f64,
    /// Work `W = int F dD` to the full depth, N mm.
    pub work_nmm: f64,
    /// Strain energy gained meanwhile, N mm: `W` and what the force before it does on the way.
    pub strain_energy_nmm: f64,
    /// Specific energy `psi = W/V`, N mm/mm^3 (MJ/m^3).
    pub specific_energy_nmm_mm3: f64,
    /// Volume of a spoke, mm^3.
    pub volume_mm3: f64,
    /// Modulus, mean over the volume, MPa.
    pub mean_modulus_mpa: f64,
    /// Largest strains.
    pub largest_strain: Vec<PhaseStrain>,
    /// Share by which forces vary with all moduli, percent.
    pub modulus_band_percent: f64,
    /// The key that it comes from.
    pub modulus_band_from: BandSource,
    /// Deepest penetration of a rigid plane, mm.
    pub penetration_mm: f64,
    /// Points of the curve; the first has neither depth nor force.
    pub curve: Vec<LoadPoint>,
    /// What the user should know.
    pub warnings: Vec<String>,
}

impl Indentation {
    /// Force over depth at a depth, N/mm; `None` beyond the curve.
    #[must_use]
    pub fn secant(&self, depth_mm: f64) -> Option<f64> {
        secant(&self.curve, depth_mm)
    }

    /// Force at a depth, linear between points, N; `None` beyond the curve.
    #[must_use]
    pub fn force_at(&self, depth_mm: f64) -> Option<f64> {
        curve::force_at(&self.curve, depth_mm)
    }

    /// Work and strain energy, the work of the force before included: they balance, N mm.
    #[must_use]
    pub fn energy_balance(&self) -> [f64; 2] {
        let depth = self.curve.last().map_or(0.0, |p| p.depth_mm);
        [self.work_nmm + self.start_force_n * depth, self.strain_energy_nmm]
    }
}

/// A dome about to be pressed: sizes with defaults filled in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Press {
    /// Final depth, mm.
    pub depth_mm: f64,
    /// Radius that the flat indenter covers, mm; absent where only the hub is pushed.
    pub radius_mm: Option<f64>,
    /// Height of the dome, mm.
    pub height_mm: f64,
}

impl Press {
    /// The press of a design.
    ///
    /// # Errors
    /// [`IndentationError::NotADome`], [`IndentationError::TooDeep`].
    pub fn new(design: &Design, input: &IndentationInput) -> Result<Self, IndentationError> {
        let Some(Guide::Target { .. }) = design.guide() else { return Err(IndentationError::NotADome) };
        let profile = design.profile();
        let height_mm = profile.z.iter().fold(0.0_f64, |m, z| m.max(z.abs()));
        let depth_mm = input.depth_mm.unwrap_or(DEPTH_SHARE * design.input().strips.length_mm);
        if depth_mm > height_mm {
            return Err(IndentationError::TooDeep { depth_mm, height_mm });
        }
        let rim = profile.rho.first().copied().unwrap_or(0.0);
        let diameter = input.indenter_diameter_mm.unwrap_or(INDENTER_SHARE * 2.0 * rim);
        let radius_mm = (input.indenter == Indenter::Flat).then_some(0.5 * diameter);
        Ok(Self { depth_mm, radius_mm, height_mm })
    }
}

/// Volume of a smooth spoke, mm^3, and its modulus, mean over it, MPa.
pub(crate) fn smooth_volume(design: &Design) -> [f64; 2] {
    let profile = design.profile();
    let step = design.input().strips.length_mm / (profile.s.len() - 1) as f64;
    let trapezoid =
        |f: &dyn Fn(usize) -> f64| (1..profile.s.len()).map(|i| 0.5 * step * (f(i - 1) + f(i))).sum::<f64>();
    let area = trapezoid(&|i| profile.width[i]);
    let stiffness = trapezoid(&|i| profile.width[i] * profile.modulus_mpa[i]);
    [area * design.input().strips.thickness_mm, stiffness / area]
}
