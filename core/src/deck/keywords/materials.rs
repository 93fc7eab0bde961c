//! `*MATERIAL` with `*ELASTIC` or `*HYPERELASTIC`, and `*DENSITY`.
//!
//! In large displacements CalculiX takes `*ELASTIC` as St. Venant and Kirchhoff's law, whose stress falls once a fibre is
//! compressed to `1/sqrt(3)` of its length: strips that are bent that sharply kink and stop. There the compressible
//! neo-Hookean law with the same constants in small strains is written, `W = C10 (I1 - 3) + (J - 1)^2 / D1` with
//! `C10 = E / (4 (1 + nu))` and `D1 = 6 (1 - 2 nu) / E`. ABAQUS integrates `*ELASTIC` in rates and needs no such care.
//!
//! A graded modulus is a nodal field whose value is the modulus itself, and the material a table over that field. The
//! modulus is linear in its own field, so two rows are exact; Poisson's ratio and the density mix by volume, which makes
//! them piecewise linear in the modulus, with one more row wherever the mixture of three phases changes its rule.

use crate::deck::DeckError;
use crate::deck::layout::Layout;
use crate::deck::number::real;
use crate::deck::sink::Sink;
use crate::materials::Material;
use crate::micromechanics::PhaseSet;

/// Ratio of the moduli of neighbouring rows where a table is not linear in the modulus; keeps the error below 0.1 %.
const ROW_RATIO: f64 = 1.05;

/// How stress follows strain.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Law {
    /// `*ELASTIC`.
    Linear,
    /// `*HYPERELASTIC, NEO HOOKE`.
    NeoHooke,
}

impl Law {
    fn keyword(self) -> &'static str {
        match self {
            Self::Linear => "*ELASTIC",
            Self::NeoHooke => "*HYPERELASTIC, NEO HOOKE",
        }
    }

    fn constants(self, modulus: f64, poisson: f64) -> String {
        match self {
            Self::Linear => format!("{},{}", real(modulus), real(poisson)),
            Self::NeoHooke => {
                let (c10, d1) = (modulus / (4.0 * (1.0 + poisson)), 6.0 * (1.0 - 2.0 * poisson) / modulus);
                format!("{},{}", real(c10), real(d1))
            }
        }
    }
}

/// A phase's name as the name of a material: legal ones begin with a letter.
pub(crate) fn material_name(material: &Material) -> String {
    let label = material.label();
    if label.starts_with(|c: char| c.is_ascii_digit()) { format!("M_{label}") } else { label }
}

/// A material that does not depend on anything.
pub(crate) fn plain(sink: &mut Sink<'_>, material: &Material, law: Law, density: bool) -> Result<(), DeckError> {
    sink.line(&format!("*MATERIAL, NAME={}", material_name(material)))?;
    sink.line(law.keyword())?;
    sink.line(&law.constants(material.modulus_mpa, material.poisson))?;
    if density && let Some(density) = material.density_tonne_mm3() {
        sink.line("*DENSITY")?;
        sink.line(&real(density))?;
    }
    Ok(())
}

/// A row of a graded material.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Mixture {
    /// MPa.
    pub modulus: f64,
    /// Poisson's ratio.
    pub poisson: f64,
    /// tonne/mm^3, where every phase has one.
    pub density: Option<f64>,
}

/// The mixtures between which everything is linear in the modulus, softest first.
pub(crate) fn mixtures(phases: &PhaseSet) -> Vec<Mixture> {
    let materials = phases.phases();
    let mut moduli = vec![phases.softest(), phases.stiffest()];
    if let [soft, middle, stiff] = materials {
        // Where the stiffest phase vanishes and where the softest does.
        let kept = phases.intermediate_fraction();
        let between = |end: &Material| (1.0 - kept) * end.modulus_mpa + kept * middle.modulus_mpa;
        moduli.extend([between(soft), middle.modulus_mpa, between(stiff)]);
    }
    moduli.sort_by(f64::total_cmp);
    moduli.dedup_by(|a, b| (*a - *b).abs() < 1e-9 * phases.stiffest());
    moduli
        .into_iter()
        .map(|modulus| {
            let fractions = phases.fractions(modulus).values;
            let mean =
                |value: &dyn Fn(&Material) -> f64| materials.iter().zip(fractions).map(|(m, f)| value(m) * f).sum();
            let densities = materials.iter().all(|m| m.density_kg_m3.is_some());
            Mixture {
                modulus,
                poisson: mean(&|m| m.poisson),
                density: densities.then(|| mean(&|m| m.density_tonne_mm3().unwrap_or(0.0))),
            }
        })
        .collect()
}

/// Rows between which a law's constants are linear in the modulus.
fn law_rows(mixtures: &[Mixture], law: Law) -> Vec<Mixture> {
    let mut rows: Vec<Mixture> = mixtures.iter().take(1).copied().collect();
    for ends in mixtures.windows(2) {
        let ratio = ends[1].modulus / ends[0].modulus;
        let parts = if law == Law::Linear { 1 } else { (ratio.ln() / ROW_RATIO.ln()).ceil().max(1.0) as i32 };
        for part in 1..=parts {
            let modulus = ends[0].modulus * ratio.powf(f64::from(part) / f64::from(parts));
            let share = (modulus - ends[0].modulus) / (ends[1].modulus - ends[0].modulus);
            let poisson = ends[0].poisson + share * (ends[1].poisson - ends[0].poisson);
            rows.push(if part == parts { ends[1] } else { Mixture { modulus, poisson, density: None } });
        }
    }
    rows
}

/// A material over a nodal field equal to the modulus: field variable 1 in ABAQUS, the temperature in CalculiX.
pub(crate) fn graded(
    sink: &mut Sink<'_>,
    name: &str,
    phases: &PhaseSet,
    law: Law,
    layout: Layout,
) -> Result<(), DeckError> {
    let rows = mixtures(phases);
    // ABAQUS takes the temperature before the field; none is given.
    let (options, blank) = if layout.is_abaqus() { (", DEPENDENCIES=1", ",") } else { ("", "") };
    sink.line(&format!("*MATERIAL, NAME={name}"))?;
    sink.line(&format!("{}{options}", law.keyword()))?;
    for row in law_rows(&rows, law) {
        sink.line(&format!("{},{blank}{}", law.constants(row.modulus, row.poisson), real(row.modulus)))?;
    }
    if rows.iter().all(|r| r.density.is_some()) {
        sink.line(&format!("*DENSITY{options}"))?;
        for row in &rows {
            sink.line(&format!("{},{blank}{}", real(row.density.unwrap_or(0.0)), real(row.modulus)))?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::materials::library;

    fn with_poisson(i: usize, poisson: f64) -> Material {
        Material { poisson, ..library()[i].clone() }
    }

    #[test]
    fn two_phases_mix_linearly_in_the_modulus() {
        let set = PhaseSet::new(vec![with_poisson(0, 0.45), with_poisson(1, 0.3)], 0.2).unwrap();
        let rows = mixtures(&set);
        assert_eq!(rows.len(), 2);
        assert_eq!((rows[0].modulus, rows[0].poisson), (3.1, 0.45));
        assert!((rows[1].density.unwrap() - 1.17e-9).abs() < 1e-20);
    }

    #[test]
    fn three_phases_have_a_row_at_every_kink() {
        let middle = Material { modulus_mpa: 6.0, ..with_poisson(2, 0.4) };
        let set = PhaseSet::new(vec![with_poisson(0, 0.45), middle, with_poisson(1, 0.3)], 0.2).unwrap();
        let rows = mixtures(&set);
        for i in 0..=200 {
            let modulus = 3.1 + 9.5 * f64::from(i) / 200.0;
            let fractions = set.fractions(modulus).values;
            let exact = 0.45 * fractions[0] + 0.4 * fractions[1] + 0.3 * fractions[2];
            let pair = rows.windows(2).find(|w| modulus <= w[1].modulus + 1e-9).unwrap();
            let share = (modulus - pair[0].modulus) / (pair[1].modulus - pair[0].modulus);
            let table = pair[0].poisson + share * (pair[1].poisson - pair[0].poisson);
            assert!((table - exact).abs() < 1e-9, "{modulus}: {table} {exact}");
        }
    }

    #[test]
    fn the_neo_hookean_table_has_the_bulk_modulus_between_its_rows() {
        let set = PhaseSet::new(library()[..2].to_vec(), 0.2).unwrap();
        let rows = law_rows(&mixtures(&set), Law::NeoHooke);
        assert!(rows.len() < 40);
        for pair in rows.windows(2) {
            let (a, b) = (pair[0].modulus, pair[1].modulus);
            let middle = 0.5 * (1.0 / a + 1.0 / b);
            assert!((middle * 0.5 * (a + b) - 1.0).abs() < 1e-3);
        }
    }
}
