//! Materials: the built-in library, custom ones, and what tensile tests say of them.

mod assumptions;
mod limits;
pub mod tensile;

pub use assumptions::{AssumedProperty, Assumption, assumptions};
pub use limits::StrainLimits;
use serde::{Deserialize, Serialize};

/// An isotropic material. Only modulus and Poisson's ratio are needed for a design.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// Name, as used in `materials.phases`.
    pub name: String,
    /// Young's modulus, MPa.
    pub modulus_mpa: f64,
    /// Poisson's ratio.
    pub poisson: f64,
    /// Density, kg/m^3.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub density_kg_m3: Option<f64>,
    /// Thermal conductivity, W/(m K).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub conductivity_w_mk: Option<f64>,
    /// Specific heat, J/(kg K).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub specific_heat_j_kgk: Option<f64>,
    /// Electrical conductivity, S/m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub electrical_conductivity_s_m: Option<f64>,
    /// Permittivity relative to that of vacuum.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub relative_permittivity: Option<f64>,
    /// Largest principal strain the material stands, dimensionless.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub max_strain: Option<f64>,
    /// Standard deviation of the modulus over it, percent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub modulus_scatter_percent: Option<f64>,
    /// Stress at which it yields (0.2 % offset), MPa.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub yield_strength_mpa: Option<f64>,
    /// Strain at which it yields, dimensionless.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub yield_strain: Option<f64>,
}

impl Material {
    /// A material of which nothing but its elasticity is known.
    #[must_use]
    pub fn new(name: &str, modulus_mpa: f64, poisson: f64) -> Self {
        Self {
            name: name.to_owned(),
            modulus_mpa,
            poisson,
            density_kg_m3: None,
            conductivity_w_mk: None,
            specific_heat_j_kgk: None,
            electrical_conductivity_s_m: None,
            relative_permittivity: None,
            max_strain: None,
            modulus_scatter_percent: None,
            yield_strength_mpa: None,
            yield_strain: None,
        }
    }

    /// Density in ABAQUS's consistent mm set, tonne/mm^3.
    #[must_use]
    pub fn density_tonne_mm3(&self) -> Option<f64> {
        self.density_kg_m3.map(|d| d * 1e-12)
    }

    /// The name as a label: capitals, every run of other characters than A-Z and 0-9 as one underscore.
    ///
    /// ```
    /// # use voxelastica_core::materials::library;
    /// assert_eq!(library()[4].label(), "PI_15_GRAPHITE");
    /// ```
    #[must_use]
    pub fn label(&self) -> String {
        label(&self.name)
    }
}

/// A name as a label: capitals, every run of other characters than A-Z and 0-9 as one underscore, none at the ends.
#[must_use]
pub fn label(name: &str) -> String {
    let mut label = String::with_capacity(name.len());
    for c in name.chars().map(|c| c.to_ascii_uppercase()) {
        if c.is_ascii_alphanumeric() {
            label.push(c);
        } else if !label.ends_with('_') && !label.is_empty() {
            label.push('_');
        }
    }
    if label.ends_with('_') {
        label.pop();
    }
    label
}

/// The materials of Kansara et al. (2023): two PolyJet elastomers, two PolyJet resins, two filled thermoplastics.
///
/// Moduli in MPa, densities in kg/m^3, conductivities in W/(m K) and S/m; Poisson's ratio is 0.3 throughout, as in the
/// paper. (Its body text swaps FLX9070 and FLX9095; its appendix and these values have the softer one as FLX9070.)
/// Specific heats and permittivities are not in the paper: they are [`assumptions`].
#[must_use]
pub fn library() -> Vec<Material> {
    let plain = |name: &str, modulus_mpa: f64, density: f64| Material {
        density_kg_m3: Some(density),
        ..Material::new(name, modulus_mpa, 0.3)
    };
    let conducting = |name: &str, modulus: f64, density: f64, heat: f64, current: f64| Material {
        conductivity_w_mk: Some(heat),
        electrical_conductivity_s_m: Some(current),
        ..plain(name, modulus, density)
    };
    let mut library = vec![
        plain("FLX9070", 3.1, 1145.0),
        plain("FLX9095", 12.6, 1170.0),
        plain("TangoBlack", 0.62, 1145.0),
        plain("VeroClear", 2033.33, 1170.0),
        conducting("PI + 15 % graphite", 3330.0, 1410.0, 0.3155, 1e-7),
        conducting("PLA + 30 % carbon fibre", 10200.0, 1270.0, 2.01, 2.86e-23),
    ];
    for material in &mut library {
        for assumption in assumptions(material) {
            match assumption.property {
                AssumedProperty::SpecificHeat => material.specific_heat_j_kgk = Some(assumption.value),
                AssumedProperty::RelativePermittivity => material.relative_permittivity = Some(assumption.value),
            }
        }
    }
    library
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_are_legal_and_unique_in_the_library() {
        let labels: Vec<String> = library().iter().map(Material::label).collect();
        assert_eq!(labels[5], "PLA_30_CARBON_FIBRE");
        let unique: std::collections::HashSet<_> = labels.iter().collect();
        assert_eq!(unique.len(), labels.len());
        assert_eq!(label(" ä-- b "), "B");
    }
}
