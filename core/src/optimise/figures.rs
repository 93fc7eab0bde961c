//! What objective and limits are made of, and why a design has none of it.

use serde::Serialize;

use crate::design::{Design, Limits};
use crate::error::{Error, Infeasible};
use crate::fabrication::layout::FlatFlower;
use crate::indentation::elastica;
use crate::input::{DesignInput, Scope};
use crate::progress::Cancelled;

/// How far a dome has to be pressed for what is asked.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Press {
    /// Not at all.
    Never,
    /// To the thickness: rigidity.
    Rigidity,
    /// To the full depth: energy and strain.
    Whole,
}

/// Figures of a design; NaN where it was not pressed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Figures {
    /// Largest over smallest modulus.
    pub contrast: f64,
    /// What the phases reach.
    pub contrast_reach: f64,
    /// Vertical force on the hub of the closed dome, all spokes, beam bending, N.
    pub hub_force_n: f64,
    /// What is printed at once, mm: its sides when flat, and its thickness.
    pub size_mm: [f64; 3],
    /// Fewest voxels across the narrowest slice or through the thickness.
    pub narrowest_voxels: f64,
    /// Largest distance of the voxelised strip from the target, percent of the length.
    pub predicted_error_percent: f64,
    /// Rigidity of a spoke, N/mm.
    pub rigidity_n_mm: f64,
    /// Specific energy, N mm/mm^3.
    pub specific_energy_nmm_mm3: f64,
    /// Largest strain of the faces while the dome is pressed.
    pub largest_strain: f64,
}

/// What became of a design.
#[derive(Debug, Clone, PartialEq)]
pub enum Outcome {
    /// It has figures.
    Designed(Figures),
    /// The phases do not reach its contrast.
    Contrast {
        /// Largest over smallest modulus, over what the phases reach.
        share: f64,
        /// What the design said.
        reason: String,
    },
    /// It is ruled out otherwise, or cannot be pressed.
    Refused {
        /// What the design said.
        reason: String,
    },
}

/// Computes a design by the way of `voxelastica design`, and presses it. Refusals are outcomes, not errors.
///
/// # Errors
/// [`Error::Cancelled`] and [`Error::Internal`].
pub fn compute(input: &DesignInput, press: Press, cancelled: Cancelled<'_>) -> Result<Outcome, Error> {
    match figures(input, press, cancelled) {
        Ok(figures) => Ok(Outcome::Designed(figures)),
        Err(Error::Infeasible { reason, .. }) => {
            let text = one_line(&reason.to_string());
            Ok(match reason {
                Infeasible::Contrast { contrast, reach, .. } => {
                    Outcome::Contrast { share: contrast / reach, reason: text }
                }
                Infeasible::Elastica(_) => Outcome::Refused { reason: text },
            })
        }
        Err(Error::Input(error)) => Ok(Outcome::Refused { reason: one_line(&error.to_string()) }),
        Err(Error::Solver(reason)) => Ok(Outcome::Refused { reason: one_line(&reason) }),
        Err(error) => Err(error),
    }
}

pub(super) fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

fn figures(input: &DesignInput, press: Press, cancelled: Cancelled<'_>) -> Result<Figures, Error> {
    let design = Design::compute_unless(input, Limits::default(), cancelled)?;
    let grid = design.grid();
    let narrowest = grid.half_widths().iter().map(|half| 2 * half).chain([grid.layers()]).min().unwrap_or(0);
    let mut figures = Figures {
        contrast: design.contrast(),
        contrast_reach: design.phases().reach(),
        hub_force_n: (design.forces().vertical * input.count() as f64).abs(),
        size_mm: size(&design),
        narrowest_voxels: narrowest as f64,
        predicted_error_percent: design.predicted_error().map_or(f64::NAN, |e| 100.0 * e),
        rigidity_n_mm: f64::NAN,
        specific_energy_nmm_mm3: f64::NAN,
        largest_strain: f64::NAN,
    };
    let how = input.indentation.clone().unwrap_or_default();
    let share = |_: f64| !cancelled();
    match press {
        Press::Never => {}
        Press::Rigidity => {
            figures.rigidity_n_mm = elastica::indent_for_rigidity(&design, &how, &share)?.rigidity_n_mm;
        }
        Press::Whole => {
            let found = elastica::indent(&design, &how, &share)?;
            figures.rigidity_n_mm = found.rigidity_n_mm;
            figures.specific_energy_nmm_mm3 = found.specific_energy_nmm_mm3;
            figures.largest_strain = found.largest_strain.iter().fold(0.0, |m, s| s.strain.max(m));
        }
    }
    Ok(figures)
}

/// Size of what is printed at once: a spoke, or the flower where the design says so.
fn size(design: &Design) -> [f64; 3] {
    let input = design.input();
    let grid = design.grid();
    let thickness = input.strips.thickness_mm;
    let widest = grid.half_widths().iter().max().map_or(0.0, |half| 2.0 * *half as f64 * grid.size_mm());
    let flower = input.fabrication.as_ref().is_some_and(|f| f.scope == Scope::Flower);
    match FlatFlower::of(design).filter(|_| flower) {
        Some(flat) => [2.0 * flat.reach_mm(design), 2.0 * flat.reach_mm(design), thickness],
        None => [input.strips.length_mm, widest, thickness],
    }
}
