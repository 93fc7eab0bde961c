//! Properties of library materials that the paper does not give.
//!
//! Specific heats are mixed by mass from those of polymer and filler. Permittivities are those of the polymer alone: graphite
//! and carbon fibres raise them, by how much depends on how the particles lie, and the paper's own times (a plateau to 0.1 %
//! after 2 ms at 1e-7 S/m, hence 3.3) fit the plain polymer. Whoever knows better gives `specific_heat_j_kgk` and
//! `relative_permittivity` in a custom material; every output of conduction names the assumptions it rests on.

use serde::Serialize;

use super::Material;

/// A property that may be assumed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum AssumedProperty {
    /// Specific heat, J/(kg K).
    #[serde(rename = "specific_heat_j_kgk")]
    SpecificHeat,
    /// Permittivity relative to that of vacuum.
    RelativePermittivity,
}

impl AssumedProperty {
    /// Name and unit for readers.
    #[must_use]
    pub fn describe(self) -> [&'static str; 2] {
        match self {
            Self::SpecificHeat => ["specific heat", " J/(kg K)"],
            Self::RelativePermittivity => ["relative permittivity", ""],
        }
    }

    fn of(self, material: &Material) -> Option<f64> {
        match self {
            Self::SpecificHeat => material.specific_heat_j_kgk,
            Self::RelativePermittivity => material.relative_permittivity,
        }
    }
}

/// A value that is assumed, and where it comes from.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Assumption {
    /// The material.
    pub material: &'static str,
    /// Which property.
    pub property: AssumedProperty,
    /// Its value.
    pub value: f64,
    /// Where it comes from.
    pub source: &'static str,
}

impl Assumption {
    /// One line for a reader.
    #[must_use]
    pub fn line(&self) -> String {
        let [property, unit] = self.property.describe();
        format!("assumed: {property} of {} = {}{unit} ({})", self.material, self.value, self.source)
    }
}

/// All of them.
const ASSUMPTIONS: [Assumption; 4] = [
    Assumption {
        material: "PI + 15 % graphite",
        property: AssumedProperty::SpecificHeat,
        value: 1033.0,
        source: "by mass from 1090 J/(kg K) of polyimide, DuPont Kapton HN data sheet, and 710 of graphite",
    },
    Assumption {
        material: "PI + 15 % graphite",
        property: AssumedProperty::RelativePermittivity,
        value: 3.4,
        source: "polyimide without filler at 1 kHz, DuPont Kapton HN data sheet",
    },
    Assumption {
        material: "PLA + 30 % carbon fibre",
        property: AssumedProperty::SpecificHeat,
        value: 1079.0,
        source: "by mass from 1200 J/(kg K) of printed PLA, Zmeskal et al., AIP Conf. Proc. 2305 (2020) 020022, and 795 of carbon fibre, Toray T300 data sheet",
    },
    Assumption {
        material: "PLA + 30 % carbon fibre",
        property: AssumedProperty::RelativePermittivity,
        value: 3.0,
        source: "printed polymers without filler, 2.9 to 3.5, Picha et al., Processes 10 (2022) 1881",
    },
];

/// The assumptions that the values of a material rest on: those of the library material of its name whose value it has.
///
/// A custom material that states its own value rests on none.
#[must_use]
pub fn assumptions(material: &Material) -> Vec<Assumption> {
    let holds =
        |a: &&Assumption| a.material == material.name && a.property.of(material).is_none_or(|value| value == a.value);
    ASSUMPTIONS.iter().filter(holds).cloned().collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::materials::library;

    #[test]
    fn assumed_values_are_in_the_library_and_say_where_they_come_from() {
        let conducting = library().into_iter().filter(|m| m.conductivity_w_mk.is_some());
        for material in conducting {
            assert!(material.specific_heat_j_kgk.is_some() && material.relative_permittivity.is_some());
            assert_eq!(assumptions(&material).len(), 2);
            let own = Material { specific_heat_j_kgk: Some(900.0), ..material };
            assert_eq!(assumptions(&own).len(), 1);
        }
        assert!(assumptions(&library()[0]).is_empty());
        // Mixed by mass.
        assert!((0.85 * 1090.0 + 0.15 * 710.0 - ASSUMPTIONS[0].value).abs() < 1.0);
        assert!((0.7_f64 * 1200.0 + 0.3 * 795.0 - ASSUMPTIONS[2].value).abs() < 1.0);
    }
}
