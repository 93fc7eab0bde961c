//! Writing into the folder of a design.

use std::path::Path;

use super::record::{self, Earlier};
use super::{Made, Plan};
use crate::design::Design;
use crate::error::Error;
use crate::input::FabricationKind;
use crate::output::folder::Staging;
use crate::output::write::{WriteOptions, require_room};
use crate::output::{Provenance, json};
use crate::progress::Progress;

/// What was made and where its record goes.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Fabricated {
    /// Kinds made now.
    pub made: Vec<(FabricationKind, Made)>,
    /// Kinds of an earlier run for the same design that were left as they are.
    pub kept: Vec<String>,
    /// Files written now, `fabrication.json` included, relative to the design's folder.
    pub files: Vec<String>,
}

/// Writes files to make a design into its folder, beside what `design` wrote. Either all files get their final names or
/// none. No kinds means those of the design, or where it names none, all that it can have. `total` is told once how much
/// work there is, and `progress` how much of it is done; it may cancel.
///
/// # Errors
/// [`Error::Input`] for a kind that does not go with the design or a limit, [`Error::Output`], [`Error::Cancelled`].
pub fn fabricate(
    design: &Design,
    folder: &Path,
    kinds: &[FabricationKind],
    options: WriteOptions,
    total: &dyn Fn(u64),
    progress: Progress<'_>,
) -> Result<Fabricated, Error> {
    let provenance = Provenance::of(design.input());
    let plan = Plan::of_kinds(design, &provenance, kinds, options.allow_large)?;
    total(plan.estimate().work());
    require_room(folder, plan.estimate().bytes, options)?;
    let earlier = Earlier::read(folder);
    let mut staging = Staging::new(folder)?;
    let made = stage(&plan, design, &provenance, &earlier, &mut staging, progress)?;
    earlier.remove(folder, &made.files, &earlier.staying(&provenance, &made.made));
    staging.commit()?;
    Ok(made)
}

/// Writes what a plan has, and the record, where there is anything.
///
/// # Errors
/// Those of [`fabricate`].
pub fn stage(
    plan: &Plan,
    design: &Design,
    provenance: &Provenance,
    earlier: &Earlier,
    staging: &mut Staging,
    progress: Progress<'_>,
) -> Result<Fabricated, Error> {
    if plan.is_empty() {
        return Ok(Fabricated::default());
    }
    let made = plan.write(design, provenance, staging, progress)?;
    let staying = earlier.staying(provenance, &made);
    let kept = staying.keys().cloned().collect();
    let document = record::document(plan.input(), provenance, &made, staying);
    let text = json::to_text(&document).map_err(|e| Error::Internal(format!("fabrication.json: {e}")))?;
    staging.write_text(record::FILE, &text)?;
    let files = made.iter().flat_map(|(_, made)| made.files.iter().cloned()).chain([record::FILE.to_owned()]).collect();
    Ok(Fabricated { made, kept, files })
}
