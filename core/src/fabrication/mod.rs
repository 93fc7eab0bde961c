//! Files to make the thing: solids and voxels to print, outlines to cut, parts to assemble, and a preview.
//!
//! Every kind of file has a [`Maker`], which first says what it would take and then writes. [`Plan`] puts the kinds that were
//! asked for together and refuses what is too large before anything is written; [`fabricate`] writes them into the folder of
//! a design, all or none, with [`record`] of what is there.

mod error;
mod gcvf;
pub mod layout;
pub mod pattern;
mod preview;
mod print_stack;
pub mod raster;
pub mod record;
mod run;
pub mod solid;
mod solids;
pub mod stl;
pub mod three_mf;
pub mod triangulate;
pub mod voxel_surface;

use serde_json::Value;

pub use error::FabricationError;
pub use run::{Fabricated, fabricate, stage};

use crate::design::Design;
use crate::error::Error;
use crate::input::{FabricationInput, FabricationKind};
use crate::output::Provenance;
use crate::output::folder::Staging;
use crate::progress::Progress;

/// Folder of all these files, relative to the design's.
pub const FOLDER: &str = "fabrication";

/// Inclination at the hub, degrees, up to which a hub is level with its spokes, so that the whole flower lies flat in one
/// piece: a fold too small to see or to feel.
pub const LEVEL_HUB_DEG: f64 = 1.0;

/// Whether spokes and hub of a dome are one flat piece.
///
/// Spokes leave the hub at `theta(L)`; where that is not zero the hub is a part of its own.
#[must_use]
pub fn hub_is_level(design: &Design) -> bool {
    let last = design.profile().inclination.last().copied().unwrap_or(0.0);
    !design.input().is_strip() && last.to_degrees().abs() <= LEVEL_HUB_DEG
}

/// What is made, of what and how.
#[derive(Debug, Clone, Copy)]
pub struct Job<'a> {
    /// The design.
    pub design: &'a Design,
    /// How it is made.
    pub input: &'a FabricationInput,
    /// Where the files come from.
    pub provenance: &'a Provenance,
    /// Whether to go beyond the limits.
    pub allow_large: bool,
}

/// What making takes, estimated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Estimate {
    /// Printer's voxels, void included.
    pub voxels: u64,
    /// Bytes that are written.
    pub bytes: u64,
}

impl Estimate {
    /// What progress counts: bytes and voxels alike.
    #[must_use]
    pub fn work(&self) -> u64 {
        self.voxels.saturating_add(self.bytes)
    }
}

/// What was made.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Made {
    /// Files, relative to the design's folder.
    pub files: Vec<String>,
    /// What the report lists: a file or a group of files, and what it is.
    pub listed: Vec<(String, String)>,
    /// Dimensions and counts, for `fabrication.json`.
    pub details: serde_json::Map<String, Value>,
}

/// Makes files of one kind.
pub trait Maker: Sync {
    /// The kind.
    fn kind(&self) -> FabricationKind;

    /// What making takes.
    ///
    /// # Errors
    /// [`FabricationError`] where the design has nothing of the kind or a limit is exceeded.
    fn plan(&self, job: &Job<'_>) -> Result<Estimate, FabricationError>;

    /// Writes the files. `progress` counts up to about [`Estimate::work`].
    ///
    /// # Errors
    /// [`Error::Output`], [`Error::Cancelled`].
    fn write(&self, job: &Job<'_>, staging: &mut Staging, progress: Progress<'_>) -> Result<Made, Error>;
}

/// The makers, in the order in which they write.
const MAKERS: &[&dyn Maker] = &[
    &solids::Stl,
    &solids::ThreeMf,
    &print_stack::PrintStack,
    &print_stack::Gcvf,
    &pattern::DxfPattern,
    &pattern::SvgPattern,
    &preview::Preview,
];

fn maker(kind: FabricationKind) -> Result<&'static dyn Maker, FabricationError> {
    MAKERS.iter().copied().find(|maker| maker.kind() == kind).ok_or(FabricationError::Unknown { kind })
}

/// Kinds of files that are to be made of a design.
pub struct Plan {
    input: FabricationInput,
    allow_large: bool,
    steps: Vec<(&'static dyn Maker, Estimate)>,
}

impl Plan {
    /// What a design itself asks for (`fabrication.write`).
    ///
    /// # Errors
    /// [`Error::Input`] where a kind does not go with the design or exceeds a limit.
    pub fn of_design(design: &Design, provenance: &Provenance, allow_large: bool) -> Result<Self, Error> {
        let input = design.input().fabrication()?;
        let kinds = input.write.clone();
        Self::new(design, provenance, input, &kinds, allow_large)
    }

    /// Some kinds; none named means those of the design, or where it names none, all that it can have.
    ///
    /// # Errors
    /// Those of [`Plan::of_design`].
    pub fn of_kinds(
        design: &Design,
        provenance: &Provenance,
        kinds: &[FabricationKind],
        allow_large: bool,
    ) -> Result<Self, Error> {
        let input = design.input().fabrication()?;
        let asked = if kinds.is_empty() { input.write.clone() } else { kinds.to_vec() };
        if !asked.is_empty() {
            return Self::new(design, provenance, input, &asked, allow_large);
        }
        let job = Job { design, input: &input, provenance, allow_large };
        let mut steps = Vec::new();
        for &maker in MAKERS {
            match maker.plan(&job) {
                Ok(estimate) => steps.push((maker, estimate)),
                Err(FabricationError::NotApplicable { .. }) => {}
                Err(error) => return Err(error.into()),
            }
        }
        Ok(Self { input, allow_large, steps })
    }

    fn new(
        design: &Design,
        provenance: &Provenance,
        input: FabricationInput,
        kinds: &[FabricationKind],
        allow_large: bool,
    ) -> Result<Self, Error> {
        let job = Job { design, input: &input, provenance, allow_large };
        let mut steps = Vec::new();
        for kind in FabricationKind::ALL.into_iter().filter(|kind| kinds.contains(kind)) {
            let maker = maker(kind)?;
            steps.push((maker, maker.plan(&job)?));
        }
        Ok(Self { input, allow_large, steps })
    }

    /// How it is made.
    #[must_use]
    pub fn input(&self) -> &FabricationInput {
        &self.input
    }

    /// Whether nothing is to be made.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.steps.is_empty()
    }

    /// The kinds, in the order in which they are written.
    #[must_use]
    pub fn kinds(&self) -> Vec<FabricationKind> {
        self.steps.iter().map(|(maker, _)| maker.kind()).collect()
    }

    /// What all kinds take together.
    #[must_use]
    pub fn estimate(&self) -> Estimate {
        let sum = |f: fn(&Estimate) -> u64| self.steps.iter().map(|(_, e)| f(e)).fold(0, u64::saturating_add);
        Estimate { voxels: sum(|e| e.voxels), bytes: sum(|e| e.bytes) }
    }

    /// Writes all kinds.
    ///
    /// # Errors
    /// Those of [`Maker::write`].
    pub fn write(
        &self,
        design: &Design,
        provenance: &Provenance,
        staging: &mut Staging,
        progress: Progress<'_>,
    ) -> Result<Vec<(FabricationKind, Made)>, Error> {
        let job = Job { design, input: &self.input, provenance, allow_large: self.allow_large };
        let mut before = 0;
        let mut all = Vec::with_capacity(self.steps.len());
        for (maker, estimate) in &self.steps {
            let counted = |done: u64| progress(before + done.min(estimate.work()));
            all.push((maker.kind(), maker.write(&job, staging, &counted)?));
            before += estimate.work();
            if !progress(before) {
                return Err(Error::Cancelled);
            }
        }
        Ok(all)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_maker_has_its_own_kind_in_the_order_of_writing() {
        let kinds: Vec<FabricationKind> = MAKERS.iter().map(|maker| maker.kind()).collect();
        assert!(kinds.windows(2).all(|pair| pair[0] < pair[1]), "{kinds:?}");
    }
}
