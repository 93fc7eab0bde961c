//! Which voxels to solve next.
//!
//! Voxels are whole: a slice of a few dozen of them answers a change of its modulus by steps, and a symmetric pattern by
//! steps of two columns. So a correction is chosen by what the voxels that it leads to are expected to do: their mid-line by
//! the elastica, corrected by what the solved strips taught ([`Mapping`]).

use nalgebra::DVector;

use crate::design::{Design, Limits};
use crate::error::Error;
use crate::input::DesignInput;
use crate::input::model::RefineInput;
use crate::progress::Cancelled;
use crate::results::MidlinePoint;
use crate::voxel::VoxelGrid;

use super::corrected;
use super::mapping::{KNOTS, Mapping, Penalty, Sensitivity, at, line};

/// Penalties of the least squares with their weights, and parts of the step, that are tried.
const PENALTIES: [(Penalty, [f64; 3]); 2] = [(Penalty::Size, [0.02, 0.05, 0.15]), (Penalty::Bends, [0.05, 0.2, 0.8])];
const SIZES: [f64; 6] = [0.3, 0.5, 0.7, 0.85, 1.0, 1.15];
/// Changes of the factor's logarithm at a single knot.
const TOUCHES: [f64; 2] = [0.15, -0.15];
/// Weight of the mean misfit beside the largest.
const MEAN: f64 = 0.1;

/// A correction, and the design it leads to.
pub(super) struct Proposal {
    pub(super) factors: Vec<f64>,
    pub(super) design: Design,
    /// Misfit that is expected of it, mm.
    expected: f64,
}

/// The best strip so far, and what is known of the others.
pub(super) struct Best<'a> {
    pub(super) design: &'a Design,
    pub(super) factors: &'a [f64],
    /// Its mid-line by the finite elements.
    pub(super) midline: &'a [MidlinePoint],
    /// The same and that of the elastica, of all solved strips.
    pub(super) lines: &'a [[DVector<f64>; 2]],
    /// Its place among them.
    pub(super) index: usize,
    /// The voxels that were solved.
    pub(super) solved: &'a [VoxelGrid],
    pub(super) limits: Limits,
    pub(super) iterations: usize,
    /// Whether to stop: choosing computes dozens of designs.
    pub(super) cancelled: Cancelled<'a>,
}

/// Mid-lines of a solved strip at the stations of its finite elements: by them, and by the elastica of its voxels; `None`
/// where it does not answer.
pub(super) fn lines(design: &Design, midline: &[MidlinePoint]) -> Option<[DVector<f64>; 2]> {
    let path = design.shape_of_slices()?;
    let fine = DVector::from_iterator(2 * midline.len(), midline.iter().flat_map(|[_, x, z]| [*x, *z]));
    Some([fine, line(midline, |s| path.final_shape().position(s))])
}

impl Best<'_> {
    /// The voxels, other than those solved, that promise to come closest to the target: at most `most` by every
    /// penalty, the most promising first; none where the elastica does not answer.
    ///
    /// # Errors
    /// [`Error::Cancelled`].
    pub(super) fn next(&self, most: usize) -> Result<Vec<Proposal>, Error> {
        let mut promising: Vec<Proposal> = Vec::new();
        for candidates in self.candidates()?.unwrap_or_default() {
            let end = promising.len() + most;
            for tried in candidates {
                let known = |other: &Proposal| other.design.grid() == tried.design.grid();
                if !promising.iter().any(known) && !self.solved.contains(tried.design.grid()) {
                    let start = end - most;
                    let place = start + promising[start..].partition_point(|other| other.expected <= tried.expected);
                    promising.insert(place, tried);
                    promising.truncate(end);
                }
            }
        }
        promising.sort_by(|a, b| a.expected.total_cmp(&b.expected));
        Ok(promising)
    }

    /// The best strip with another modulus about one knot, in turn the second of which is softer; none where that changes
    /// no voxel, or only to what was solved.
    ///
    /// # Errors
    /// [`Error::Cancelled`].
    pub(super) fn touched(&self, turn: usize) -> Result<Option<Proposal>, Error> {
        let (knot, touch) = (turn / TOUCHES.len(), TOUCHES[turn % TOUCHES.len()]);
        let change: [f64; KNOTS] = std::array::from_fn(|i| if i == knot { touch } else { 0.0 });
        let factors = corrected(self.design, self.factors, |share| at(&change, share));
        let design = self.designed(&factors)?.filter(|design| !self.solved.contains(design.grid()));
        Ok(design.map(|design| Proposal { factors, design, expected: f64::NAN }))
    }

    /// Number of turns of [`Self::touched`].
    pub(super) const TURNS: usize = KNOTS * TOUCHES.len();

    /// Corrections by every penalty.
    fn candidates(&self) -> Result<Option<[Vec<Proposal>; 2]>, Error> {
        let Some(own) = self.lines.get(self.index) else { return Ok(None) };
        let target = line(self.midline, |s| self.design.profile().position(s));
        let mapping = Mapping::new(own, self.lines);
        let misfit = &own[0] - &target;
        let Some(sensitivity) = Sensitivity::new(self.design, self.midline, &misfit, &mapping) else {
            return Ok(None);
        };
        let mut candidates = <[Vec<Proposal>; 2]>::default();
        for ((penalty, weights), found) in PENALTIES.into_iter().zip(&mut candidates) {
            for change in weights.iter().filter_map(|weight| sensitivity.change(penalty, *weight)) {
                for size in SIZES {
                    let factors = corrected(self.design, self.factors, |share| size * at(&change, share));
                    found.extend(self.expect(factors, &mapping, &target)?);
                }
            }
        }
        Ok(Some(candidates))
    }

    /// The design of a correction; none where there is none.
    fn designed(&self, factors: &[f64]) -> Result<Option<Design>, Error> {
        let mut input: DesignInput = self.design.input().clone();
        let correction = factors.to_vec();
        input.refine = Some(RefineInput { iterations: self.iterations, correction, errors_percent: Vec::new() });
        match Design::compute_unless(&input, self.limits, self.cancelled) {
            Err(Error::Cancelled) => Err(Error::Cancelled),
            design => Ok(design.ok()),
        }
    }

    /// What is to be expected of a correction.
    fn expect(&self, factors: Vec<f64>, mapping: &Mapping, target: &DVector<f64>) -> Result<Option<Proposal>, Error> {
        let Some(design) = self.designed(&factors)? else { return Ok(None) };
        let (Some(path), Some([fine, coarse])) = (design.shape_of_slices(), self.lines.get(self.index)) else {
            return Ok(None);
        };
        let moved = line(self.midline, |s| path.final_shape().position(s)) - coarse;
        let off = fine + mapping.fine(&moved) - target;
        let distances = off.as_slice().chunks_exact(2).map(|d| d[0].hypot(d[1]));
        let (largest, sum) = distances.fold((0.0_f64, 0.0), |(largest, sum), d| (largest.max(d), sum + d * d));
        let expected = largest + MEAN * (sum / self.midline.len() as f64).sqrt();
        Ok(Some(Proposal { factors, design, expected }))
    }
}
