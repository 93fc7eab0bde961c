//! Which fractions of two or three phases realise a wanted modulus.

use crate::materials::Material;

/// Fractions of up to three phases in one cross-section, softest first; unused ones are zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fractions {
    /// Volume fractions, summing to one.
    pub values: [f64; 3],
    /// The wanted modulus lay outside what the phases reach, and the nearest one was taken.
    pub clamped: bool,
    /// Three phases: the intermediate fraction had to be reduced.
    pub intermediate_reduced: bool,
}

/// What is wrong with a set of phases.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PhaseError {
    /// Not two or three phases.
    #[error("{count} phases; two or three are needed")]
    Count {
        /// How many were given.
        count: usize,
    },
    /// Phases are not listed softest first.
    #[error(
        "\"{first}\" ({first_mpa} MPa) comes before \"{second}\" ({second_mpa} MPa), but phases go from the softest to the stiffest; swap them"
    )]
    Order {
        /// Name of the earlier phase.
        first: String,
        /// Its modulus.
        first_mpa: f64,
        /// Name of the later phase.
        second: String,
        /// Its modulus.
        second_mpa: f64,
    },
    /// Two phases whose names give the same set name.
    #[error("\"{first}\" and \"{second}\" would share the set name PHASE-{label}; rename one")]
    SameLabel {
        /// Name of a phase.
        first: String,
        /// Name of another.
        second: String,
        /// The label of both.
        label: String,
    },
}

/// Two or three phases, softest first, and how much of the intermediate one a slice keeps.
#[derive(Debug, Clone, PartialEq)]
pub struct PhaseSet {
    phases: Vec<Material>,
    intermediate_fraction: f64,
}

impl PhaseSet {
    /// A set of phases. `intermediate_fraction` is used with three phases only.
    ///
    /// # Errors
    /// [`PhaseError`] for another number of phases, phases that are not sorted by strictly rising modulus, and names
    /// that become the same label.
    pub fn new(phases: Vec<Material>, intermediate_fraction: f64) -> Result<Self, PhaseError> {
        if !(2..=3).contains(&phases.len()) {
            return Err(PhaseError::Count { count: phases.len() });
        }
        for (first, second) in phases.iter().zip(&phases[1..]) {
            if first.modulus_mpa >= second.modulus_mpa {
                return Err(PhaseError::Order {
                    first: first.name.clone(),
                    first_mpa: first.modulus_mpa,
                    second: second.name.clone(),
                    second_mpa: second.modulus_mpa,
                });
            }
        }
        for (i, first) in phases.iter().enumerate() {
            if let Some(second) = phases[i + 1..].iter().find(|p| p.label() == first.label()) {
                return Err(PhaseError::SameLabel {
                    first: first.name.clone(),
                    second: second.name.clone(),
                    label: first.label(),
                });
            }
        }
        Ok(Self { phases, intermediate_fraction })
    }

    /// The phases, softest first.
    #[must_use]
    pub fn phases(&self) -> &[Material] {
        &self.phases
    }

    /// Modulus of each phase, MPa, softest first.
    #[must_use]
    pub fn moduli(&self) -> Vec<f64> {
        self.phases.iter().map(|p| p.modulus_mpa).collect()
    }

    /// Modulus of the softest phase, MPa.
    #[must_use]
    pub fn softest(&self) -> f64 {
        self.phases[0].modulus_mpa
    }

    /// Modulus of the stiffest phase, MPa.
    #[must_use]
    pub fn stiffest(&self) -> f64 {
        self.phases[self.phases.len() - 1].modulus_mpa
    }

    /// Fraction that the intermediate of three phases keeps.
    #[must_use]
    pub fn intermediate_fraction(&self) -> f64 {
        self.intermediate_fraction
    }

    /// Largest contrast that the phases reach.
    #[must_use]
    pub fn reach(&self) -> f64 {
        self.stiffest() / self.softest()
    }

    /// The largest modulus a design of the given contrast is scaled to, MPa.
    ///
    /// Two phases: that of the stiffest. Three: `f_i E_i + (1 - f_i) E_r`, so that the intermediate phase keeps its
    /// fraction there too, or as much more as the contrast needs to keep the smallest modulus within reach.
    #[must_use]
    pub fn default_peak(&self, contrast: f64) -> f64 {
        match self.phases.as_slice() {
            [soft, intermediate, stiff] => {
                let kept = self.intermediate_fraction * intermediate.modulus_mpa
                    + (1.0 - self.intermediate_fraction) * stiff.modulus_mpa;
                kept.max(contrast * soft.modulus_mpa).min(stiff.modulus_mpa)
            }
            _ => self.stiffest(),
        }
    }

    /// Fractions whose Voigt average is `modulus_mpa`, or the nearest the phases reach.
    ///
    /// Two phases: `f_r = (E - E_s)/(E_r - E_s)`. Three: the intermediate phase keeps its fraction, and the softest and
    /// the stiffest are solved for; where one of them would be negative it is absent, and the intermediate fraction is
    /// the one that then gives `E`.
    #[must_use]
    pub fn fractions(&self, modulus_mpa: f64) -> Fractions {
        let (soft, stiff) = (self.softest(), self.stiffest());
        let wanted = modulus_mpa.clamp(soft, stiff);
        let clamped = (wanted - modulus_mpa).abs() > 1e-9 * stiff;
        match self.phases.as_slice() {
            [_, intermediate, _] => {
                let middle = intermediate.modulus_mpa;
                let keep = self.intermediate_fraction;
                let rigid = (wanted - soft - keep * (middle - soft)) / (stiff - soft);
                let (values, reduced) = if rigid < 0.0 {
                    let f = (wanted - soft) / (middle - soft);
                    ([1.0 - f, f, 0.0], true)
                } else if rigid + keep > 1.0 {
                    let f = (stiff - wanted) / (stiff - middle);
                    ([0.0, f, 1.0 - f], true)
                } else {
                    ([1.0 - keep - rigid, keep, rigid], false)
                };
                Fractions { values, clamped, intermediate_reduced: reduced }
            }
            _ => {
                let rigid = (wanted - soft) / (stiff - soft);
                Fractions { values: [1.0 - rigid, rigid, 0.0], clamped, intermediate_reduced: false }
            }
        }
    }

    /// Fraction of the stiffest phase for a modulus, MPa.
    #[must_use]
    pub fn rigid_fraction(&self, modulus_mpa: f64) -> f64 {
        self.fractions(modulus_mpa).values[self.phases.len() - 1]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::materials::library;
    use crate::micromechanics::voigt;

    fn three() -> PhaseSet {
        let mut middle = library()[0].clone();
        middle.name = "middle".into();
        middle.modulus_mpa = 6.0;
        PhaseSet::new(vec![library()[0].clone(), middle, library()[1].clone()], 0.2).unwrap()
    }

    #[test]
    fn fractions_average_to_the_wanted_modulus_and_stay_between_zero_and_one() {
        let two = PhaseSet::new(library()[..2].to_vec(), 0.0).unwrap();
        for set in [two, three()] {
            for i in 0..=100 {
                let wanted = 3.1 + (12.6 - 3.1) * f64::from(i) / 100.0;
                let fractions = set.fractions(wanted);
                assert!((voigt(&fractions.values, &set.moduli()) - wanted).abs() < 1e-12);
                assert!((fractions.values.iter().sum::<f64>() - 1.0).abs() < 1e-12);
                assert!(fractions.values.iter().all(|f| (-1e-12..=1.0 + 1e-12).contains(f)), "{fractions:?}");
                assert!(!fractions.clamped);
            }
            assert!(set.fractions(13.0).clamped && set.fractions(1.0).clamped);
        }
    }

    #[test]
    fn three_phases_keep_the_intermediate_fraction_where_they_can() {
        let set = three();
        assert!((set.fractions(8.0).values[1] - 0.2).abs() < 1e-12);
        assert!(set.fractions(12.5).intermediate_reduced && set.fractions(3.2).intermediate_reduced);
        assert!((set.default_peak(2.0) - (0.2 * 6.0 + 0.8 * 12.6)).abs() < 1e-12);
        assert!((set.default_peak(4.0) - 12.4).abs() < 1e-12);
    }

    #[test]
    fn wrong_sets_are_refused() {
        let all = library();
        assert!(matches!(PhaseSet::new(all[..1].to_vec(), 0.2), Err(PhaseError::Count { count: 1 })));
        let error = PhaseSet::new(vec![all[1].clone(), all[0].clone()], 0.2).unwrap_err();
        assert!(error.to_string().contains("swap"), "{error}");
    }
}
