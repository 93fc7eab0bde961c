//! Bending stiffness of a slice of voxels.

use crate::elastica::forward::Section;

/// The section of a slice from the axial stiffness of its layers.
///
/// For layer `k` with `EA_k = eta^2 sum E` at height `z_k` above the mid-plane:
///
/// ```text
/// z_n = sum EA_k z_k / sum EA_k
/// B   = sum EA_k ((z_k - z_n)^2 + eta^2 / 12)
/// ```
///
/// `layer_stiffness` holds `EA_k` in N, lowest layer first; the result is in N mm^2 and mm.
#[must_use]
pub fn section(layer_stiffness: &[f64], size_mm: f64) -> Section {
    let layers = layer_stiffness.len() as f64;
    let height = |k: usize| (k as f64 + 0.5 - 0.5 * layers) * size_mm;
    let axial: f64 = layer_stiffness.iter().sum();
    let first: f64 = layer_stiffness.iter().enumerate().map(|(k, ea)| ea * height(k)).sum();
    let offset = first / axial;
    let stiffness = layer_stiffness
        .iter()
        .enumerate()
        .map(|(k, ea)| ea * ((height(k) - offset).powi(2) + size_mm * size_mm / 12.0))
        .sum();
    Section { stiffness, neutral_offset: offset }
}

/// Axial stiffness `EA_k` of every layer of a slice whose voxels are listed layer by layer.
#[must_use]
pub fn layer_stiffness(phases: &[u8], layers: usize, moduli: &[f64], size_mm: f64) -> Vec<f64> {
    let area = size_mm * size_mm;
    phases
        .chunks_exact(phases.len() / layers.max(1))
        .map(|layer| area * layer.iter().map(|p| moduli[usize::from(*p)]).sum::<f64>())
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_homogeneous_slice_has_e_w_t3_over_12() {
        let phases = vec![0_u8; 6 * 4];
        let found = section(&layer_stiffness(&phases, 4, &[3.1], 0.5), 0.5);
        let exact = 3.1 * 3.0 * 2.0_f64.powi(3) / 12.0;
        assert!((found.stiffness - exact).abs() < 1e-12 * exact);
        assert!(found.neutral_offset.abs() < 1e-15);
    }

    #[test]
    fn a_bilayer_has_its_textbook_neutral_axis_and_stiffness() {
        // Two layers of thickness h: E1 below, E2 above. Neutral axis (E2 - E1)/(E1 + E2) h/2 above the interface.
        let (e1, e2, h, w) = (1.0, 4.0, 0.5, 3.0);
        let phases = [[0_u8; 6], [1_u8; 6]].concat();
        let found = section(&layer_stiffness(&phases, 2, &[e1, e2], h), h);
        let offset = (e2 - e1) / (e1 + e2) * h / 2.0;
        let exact = w * h.powi(3) / 12.0 * (e1 * e1 + 14.0 * e1 * e2 + e2 * e2) / (e1 + e2);
        assert!((found.neutral_offset - offset).abs() < 1e-12);
        assert!((found.stiffness - exact).abs() < 1e-12, "{} {exact}", found.stiffness);
    }
}
