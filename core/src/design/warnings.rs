//! What a user should know about a design that is feasible all the same.

use super::Design;
use crate::voxel::Match;

impl Design {
    /// [`Self::warnings`] and what there is to say about the files that are written: the modulus expression, the decks.
    #[must_use]
    pub fn warnings_for_files(&self) -> Vec<String> {
        let mut warnings = self.warnings.clone();
        if let Ok(field) = self.modulus_field()
            && !field.meets_target()
        {
            warnings.push(format!(
                "the closed-form expression of the modulus is up to {:.2} % off, more than {} %; the decks' own fields are exact",
                field.max_error_percent,
                crate::modulus_field::TARGET_ERROR_PERCENT
            ));
        }
        if !self.input.decks.write.is_empty() && crate::deck::offered(self).is_empty() {
            warnings.push(
                "no deck is written: shell decks are for ABAQUS and for domes only (see decks.write and decks.solvers)"
                    .to_owned(),
            );
        }
        let refused = crate::deck::refused_indentations(self);
        warnings.extend(refused.map(|(kind, reason)| format!("{} is not written: {reason}", kind.name())));
        warnings
    }

    pub(super) fn collect_warnings(&mut self) {
        let widest = self.slices.iter().map(|s| (self.grid.size_mm() * 2.0 * s.half_width as f64, s.s_mm)).fold(
            (1.0, 0.0),
            |worst: (f64, f64), (voxels, s)| {
                let excess = voxels / self.width_and_modulus(s).0;
                if excess > worst.0 { (excess, s) } else { worst }
            },
        );
        if widest.0 > 1.2 {
            self.warnings.push(format!(
                "whole voxels are up to {:.1} times as wide as the spoke (at s = {:.2} mm), so neighbouring spokes overlap; \
                 use smaller voxels or fewer spokes",
                widest.0, widest.1
            ));
        }
        let clamped = self.slices.iter().filter(|s| s.clamped).count();
        if clamped > 0 {
            self.warnings.push(format!(
                "{clamped} of {} slices want a modulus outside what the phases reach and take the nearest one",
                self.slices.len()
            ));
        }
        let reduced = self.slices.iter().filter(|s| s.intermediate_reduced).count();
        if reduced > 0 {
            self.warnings.push(format!(
                "{reduced} of {} slices keep less than the wanted fraction of {}",
                self.slices.len(),
                self.phases.phases()[1].name
            ));
        }
        if let Some(error) = self.predicted_error.filter(|e| *e > 0.01) {
            self.warnings.push(format!(
                "the voxelised strip is predicted to miss the target by {:.2} % of its length; smaller voxels, another \
                 pattern{} bring it closer",
                100.0 * error,
                if self.input.voxels.matching != Match::Modulus { "" } else { " or match = \"stiffness\"" }
            ));
        }
        let layers = self.grid.layers();
        let decks = &self.input.decks;
        let odd = |edge: usize| layers * edge % 2 == 1;
        if odd(decks.calculix_elements_per_voxel_edge) || odd(decks.elements_per_voxel_edge) {
            self.warnings.push(format!(
                "an odd number of layers ({layers}) has no nodes on the mid-plane: voxel_solid decks with an odd number of \
                 elements along a voxel's edge use twice as many"
            ));
        }
        if let Some(residual) = self.target.as_ref().and_then(|t| t.fit.as_ref()).map(|f| f.residual_max_mm)
            && residual > 0.01 * self.input.strips.length_mm
        {
            self.warnings
                .push(format!("the smooth meridian is up to {residual:.3} mm from the points it was fitted to"));
        }
    }
}
