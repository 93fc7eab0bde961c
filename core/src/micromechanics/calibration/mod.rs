//! The modulus of mixtures in bending, measured on random cells.
//!
//! - `bending_cell` bends a piece of a strip;
//! - `rule` is the table that many such pieces give;
//! - [`calibrate`] makes the rule of a pair of phases, a pattern and a number of layers.

mod bending_cell;
mod rule;

use std::collections::HashMap;
use std::sync::{Arc, Mutex, OnceLock};

use rayon::prelude::*;

pub use bending_cell::{BendingCellResult, BendingCellSize};
pub use rule::{MixtureRule, RuleCell};

use crate::micromechanics::{PhaseSet, voigt};
use crate::progress::Cancelled;
use crate::voxel::Pattern;
use bending_cell::BendingCell;

/// Slices of a cell.
const SLICES: usize = 12;
/// Half its width.
const HALF_WIDTH: usize = 6;
/// Layers above which the rule hardly changes any more: thicker strips take the rule of this many.
pub const MOST_LAYERS: usize = 24;
/// Parts into which the range of fractions is divided, at least.
const PARTS: usize = 16;
/// Layers that the cells of one fraction have together, at least.
const LAYERS_TOGETHER: usize = 24;
/// Most cells of one fraction.
const MOST_SEEDS: usize = 12;
/// Rules that are kept.
const KEPT: usize = 64;

/// Why there is no rule.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CalibrationError {
    /// Not two phases.
    #[error("a calibrated mixture rule is for two phases, not {phases}; use match = \"modulus\" or \"stiffness\"")]
    Phases {
        /// Number of phases.
        phases: usize,
    },
    /// The equations could not be solved.
    #[error(
        "a cell with {fraction:.3} of the stiffer phase could not be solved in double precision: the moduli differ by a \
         factor of {contrast:.1e}; use phases closer to each other, or match = \"modulus\""
    )]
    Singular {
        /// Volume fraction.
        fraction: f64,
        /// Ratio of the moduli.
        contrast: f64,
    },
    /// The cells do not get stiffer with more of the stiffer phase.
    #[error("the cells do not become stiffer with more of the stiffer phase; use match = \"modulus\"")]
    NotRising,
    /// There is not enough memory.
    #[error("not enough memory for cells of {layers} layers; use match = \"modulus\" or \"stiffness\"")]
    Memory {
        /// Layers of a cell.
        layers: usize,
    },
    /// The user cancelled.
    #[error("cancelled")]
    Cancelled,
}

/// The calibrated rule of two phases that fill strips of `layers` layers by a pattern. Rules are kept in the process.
///
/// # Errors
/// [`CalibrationError`].
pub fn calibrate(
    phases: &PhaseSet,
    pattern: Pattern,
    layers: usize,
    cancelled: Cancelled<'_>,
) -> Result<Arc<MixtureRule>, CalibrationError> {
    type Key = ([u64; 4], Pattern, usize);
    static RULES: OnceLock<Mutex<HashMap<Key, Arc<MixtureRule>>>> = OnceLock::new();
    let [soft, rigid] = phases.phases() else {
        return Err(CalibrationError::Phases { phases: phases.phases().len() });
    };
    let layers = layers.clamp(1, MOST_LAYERS);
    let key = ([soft.modulus_mpa, soft.poisson, rigid.modulus_mpa, rigid.poisson].map(f64::to_bits), pattern, layers);
    let rules = RULES.get_or_init(Mutex::default);
    if let Some(rule) = rules.lock().ok().and_then(|rules| rules.get(&key).cloned()) {
        return Ok(rule);
    }
    let size = BendingCellSize { slices: SLICES, half_width: HALF_WIDTH, layers, elements_per_voxel: 1 };
    let rule = Arc::new(measure(phases, pattern, size, &seeds(pattern, layers), cancelled)?);
    if let Ok(mut rules) = rules.lock() {
        if rules.len() >= KEPT {
            rules.clear();
        }
        rules.insert(key, Arc::clone(&rule));
    }
    Ok(rule)
}

/// Seeds of the cells of one fraction: patterns without chance need one cell, thin strips more than thick ones.
fn seeds(pattern: Pattern, layers: usize) -> Vec<u64> {
    let random = matches!(pattern, Pattern::Random | Pattern::RandomLayered);
    let count = if random { LAYERS_TOGETHER.div_ceil(layers).clamp(1, MOST_SEEDS) } else { 1 };
    (1..=count as u64).collect()
}

/// Parts into which the range of fractions is divided. Patterns whose stiffness has kinks get points there: where a layer is
/// full, or where a slice has a whole number of column pairs, since slices would else take turns between two numbers.
fn parts(pattern: Pattern, size: BendingCellSize) -> usize {
    match pattern {
        Pattern::Random | Pattern::RandomLayered => PARTS,
        Pattern::ThroughThickness => size.layers * PARTS.div_ceil(size.layers),
        Pattern::Centred | Pattern::Split => size.half_width,
        Pattern::OneEdge => 2 * size.half_width,
    }
}

/// Bends cells at evenly spaced fractions and makes the rule of them.
///
/// # Errors
/// [`CalibrationError`].
pub fn measure(
    phases: &PhaseSet,
    pattern: Pattern,
    size: BendingCellSize,
    seeds: &[u64],
    cancelled: Cancelled<'_>,
) -> Result<MixtureRule, CalibrationError> {
    let cell = BendingCell::new(size).ok_or(CalibrationError::Memory { layers: size.layers })?;
    let (soft, rigid) = (phases.softest(), phases.stiffest());
    let parts = parts(pattern, size);
    let tests: Vec<(usize, u64)> = (1..parts).flat_map(|part| seeds.iter().map(move |seed| (part, *seed))).collect();
    let results = tests
        .par_iter()
        .map(|(part, seed)| {
            let fraction = *part as f64 / parts as f64;
            if cancelled() {
                return Err(CalibrationError::Cancelled);
            }
            cell.bend(phases, pattern, (fraction, *seed), cancelled).ok_or_else(|| {
                if cancelled() {
                    CalibrationError::Cancelled
                } else {
                    CalibrationError::Singular { fraction, contrast: rigid / soft }
                }
            })
        })
        .collect::<Result<Vec<_>, _>>()?;
    let mut points = vec![[0.0, soft, soft]];
    let mut scatter = 0.0_f64;
    for results in results.chunks(seeds.len().max(1)) {
        let count = results.len() as f64;
        let fraction = results.iter().map(|r| r.rigid_fraction).sum::<f64>() / count;
        // Pieces of a strip follow each other: their compliances add up.
        let mean = count / results.iter().map(|r| 1.0 / r.bending_mpa).sum::<f64>();
        if results.len() > 1 {
            let variance = results.iter().map(|r| (r.bending_mpa / mean - 1.0).powi(2)).sum::<f64>() / (count - 1.0);
            scatter = scatter.max((variance / count).sqrt());
        }
        points.push([fraction, mean, voigt(&[1.0 - fraction, fraction], &[soft, rigid])]);
    }
    points.push([1.0, rigid, rigid]);
    let cell = RuleCell {
        voxels: [size.slices, 2 * size.half_width, size.layers],
        elements_per_voxel: size.elements_per_voxel,
        seeds: seeds.to_vec(),
    };
    MixtureRule::new(&points, cell, 100.0 * scatter)
}
