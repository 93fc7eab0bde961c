//! What strains and stresses in a model are held against.

use super::Material;

/// Strains that a phase, or a mixture of phases, stands.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct StrainLimits {
    /// Where it yields.
    pub yield_strain: Option<f64>,
    /// Largest it stands.
    pub max_strain: Option<f64>,
}

impl StrainLimits {
    /// Those of one phase.
    #[must_use]
    pub fn of(material: &Material) -> Self {
        Self { yield_strain: material.yield_strain, max_strain: material.max_strain }
    }

    /// Those of a mixture, which stands what its weakest phase stands.
    #[must_use]
    pub fn of_mixture(phases: &[Material]) -> Self {
        let least = |pick: fn(&Material) -> Option<f64>| phases.iter().filter_map(pick).reduce(f64::min);
        Self { yield_strain: least(|m| m.yield_strain), max_strain: least(|m| m.max_strain) }
    }

    /// What the user should know of a strain beyond a limit, one sentence a limit.
    #[must_use]
    pub fn warnings(&self, label: &str, strain: f64) -> Vec<String> {
        let percent = 100.0 * strain;
        let beyond = |limit: Option<f64>, what: &str, key: &str| {
            let limit = limit.filter(|limit| strain > *limit)?;
            Some(format!("{label} is strained by {percent:.2} % and {what} {:.2} % ({key})", 100.0 * limit))
        };
        let yields = beyond(self.yield_strain, "yields at", "yield_strain");
        yields.into_iter().chain(beyond(self.max_strain, "stands", "max_strain")).collect()
    }
}

impl Material {
    /// What the user should know of a stress in the material beyond its yield strength.
    #[must_use]
    pub fn stress_warning(&self, stress_mpa: f64) -> Option<String> {
        let limit = self.yield_strength_mpa.filter(|limit| stress_mpa > *limit)?;
        Some(format!(
            "{} is stressed by {stress_mpa:.4} MPa (von Mises) and yields at {limit:.4} MPa (yield_strength_mpa)",
            self.label()
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn warnings_name_phase_value_and_limit() {
        let soft = Material { yield_strain: Some(0.02), max_strain: Some(0.3), ..Material::new("soft one", 1.0, 0.3) };
        let rigid = Material { max_strain: Some(0.1), ..Material::new("rigid", 2.0, 0.3) };
        let mixture = StrainLimits::of_mixture(&[soft.clone(), rigid]);
        assert_eq!(mixture, StrainLimits { yield_strain: Some(0.02), max_strain: Some(0.1) });
        assert!(mixture.warnings("GRADED", 0.02).is_empty());
        let of_soft = StrainLimits::of(&soft).warnings(&soft.label(), 0.05);
        assert_eq!(of_soft, ["SOFT_ONE is strained by 5.00 % and yields at 2.00 % (yield_strain)"]);
        assert_eq!(mixture.warnings("GRADED", 0.2).len(), 2);
        assert_eq!(soft.stress_warning(9.0), None);
        let strong = Material { yield_strength_mpa: Some(8.0), ..soft };
        assert!(strong.stress_warning(9.0).is_some_and(|w| w.contains("9.0000 MPa") && w.contains("8.0000 MPa")));
        assert_eq!(strong.stress_warning(8.0), None);
    }
}
