//! Bounds on the modulus of a mixture of isotropic phases.

use crate::materials::Material;

/// Voigt's upper bound `E = sum f_k E_k`: equal strain in all phases.
///
/// A slice of a strip whose phases run along it obeys this law in tension; it is the rule the design uses.
#[must_use]
pub fn voigt(fractions: &[f64], moduli: &[f64]) -> f64 {
    fractions.iter().zip(moduli).map(|(f, e)| f * e).sum()
}

/// Reuss's lower bound `1/E = sum f_k / E_k`: equal stress in all phases.
#[must_use]
pub fn reuss(fractions: &[f64], moduli: &[f64]) -> f64 {
    1.0 / fractions.iter().zip(moduli).map(|(f, e)| f / e).sum::<f64>()
}

/// Hashin and Shtrikman's bounds (1963) on Young's modulus of an isotropic mixture of two phases, lower first.
///
/// With bulk modulus `K`, shear modulus `G` and `f_1 + f_2 = 1`, for phase 1 as the matrix:
///
/// ```text
/// K = K_1 + f_2 / (1/(K_2 - K_1) + 3 f_1 / (3 K_1 + 4 G_1))
/// G = G_1 + f_2 / (1/(G_2 - G_1) + 6 f_1 (K_1 + 2 G_1) / (5 G_1 (3 K_1 + 4 G_1)))
/// E = 9 K G / (3 K + G)
/// ```
///
/// `stiff_fraction` is the volume fraction of `stiff`; the softer phase as the matrix gives the lower bound.
#[must_use]
pub fn hashin_shtrikman(soft: &Material, stiff: &Material, stiff_fraction: f64) -> (f64, f64) {
    let one_way = |matrix: &Material, other: &Material, f_other: f64| {
        let (k1, g1) = moduli(matrix);
        let (k2, g2) = moduli(other);
        let f1 = 1.0 - f_other;
        let mix = |m1: f64, m2: f64, polarisation: f64| {
            let difference = m2 - m1;
            m1 + f_other * difference / (1.0 + difference * f1 * polarisation)
        };
        let k = mix(k1, k2, 3.0 / (3.0 * k1 + 4.0 * g1));
        let g = mix(g1, g2, 6.0 * (k1 + 2.0 * g1) / (5.0 * g1 * (3.0 * k1 + 4.0 * g1)));
        9.0 * k * g / (3.0 * k + g)
    };
    (one_way(soft, stiff, stiff_fraction), one_way(stiff, soft, 1.0 - stiff_fraction))
}

fn moduli(m: &Material) -> (f64, f64) {
    (m.modulus_mpa / (3.0 * (1.0 - 2.0 * m.poisson)), m.modulus_mpa / (2.0 * (1.0 + m.poisson)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::materials::library;

    #[test]
    fn bounds_are_ordered_and_meet_at_the_pure_phases() {
        let all = library();
        let (soft, stiff) = (&all[0], &all[1]);
        let moduli = [soft.modulus_mpa, stiff.modulus_mpa];
        for i in 0..=20 {
            let f = f64::from(i) / 20.0;
            let (low, high) = hashin_shtrikman(soft, stiff, f);
            let (r, v) = (reuss(&[1.0 - f, f], &moduli), voigt(&[1.0 - f, f], &moduli));
            assert!(r <= low + 1e-12 && low <= high + 1e-12 && high <= v + 1e-12, "{f}: {r} {low} {high} {v}");
        }
        let (low, high) = hashin_shtrikman(soft, stiff, 0.0);
        assert!((low - 3.1).abs() < 1e-12 && (high - 3.1).abs() < 1e-12);
    }

    #[test]
    fn a_textbook_porous_solid_has_the_closed_form_of_its_upper_bound() {
        // nu = 0.2 and voids: K and G both fall as (1 - f)/(1 + f), so E does.
        let solid = Material { poisson: 0.2, modulus_mpa: 1.0, ..library()[0].clone() };
        let void = Material { modulus_mpa: 1e-12, ..solid.clone() };
        let (_, high) = hashin_shtrikman(&void, &solid, 0.7);
        assert!((high - 0.7 / 1.3).abs() < 1e-9, "{high}");
    }
}
