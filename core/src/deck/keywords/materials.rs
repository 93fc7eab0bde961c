//! `*MATERIAL` with `*ELASTIC` and `*DENSITY`.
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

/// A material that does not depend on anything.
pub(crate) fn plain(sink: &mut Sink<'_>, name: &str, material: &Material, density: bool) -> Result<(), DeckError> {
    sink.line(&format!("*MATERIAL, NAME={name}"))?;
    sink.line("*ELASTIC")?;
    sink.line(&format!("{},{}", real(material.modulus_mpa), real(material.poisson)))?;
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

/// A material over a nodal field equal to the modulus: field variable 1 in ABAQUS, the temperature in CalculiX.
pub(crate) fn graded(sink: &mut Sink<'_>, name: &str, phases: &PhaseSet, layout: Layout) -> Result<(), DeckError> {
    let rows = mixtures(phases);
    // ABAQUS takes the temperature before the field; none is given.
    let (options, blank) = if layout.is_abaqus() { (", DEPENDENCIES=1", ",") } else { ("", "") };
    sink.line(&format!("*MATERIAL, NAME={name}"))?;
    sink.line(&format!("*ELASTIC{options}"))?;
    for row in &rows {
        let modulus = real(row.modulus);
        sink.line(&format!("{modulus},{},{blank}{modulus}", real(row.poisson)))?;
    }
    if rows.iter().all(|r| r.density.is_some()) {
        sink.line(&format!("*DENSITY{options}"))?;
        for row in &rows {
            sink.line(&format!("{},{blank}{}", real(row.density.unwrap_or(0.0)), real(row.modulus)))?;
        }
    }
    Ok(())
}
