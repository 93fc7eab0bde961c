//! Confirming a design with the finite elements inside the library.

use std::io::{self, Write};
use std::time::Instant;

use serde_json::{Map, Value};

use super::comparison::compare;
use super::verification::{
    EmbeddedRecord, Model, ReactionRecord, SolverRecord, Verification, predicted, require_shape,
};
use crate::design::Design;
use crate::error::Error;
use crate::fem::element::Law;
use crate::fem::model::MIXTURE;
use crate::fem::morph::{self, Lead};
use crate::fem::{self, FemError, MorphOptions, MorphSolution, Resolution};
use crate::materials::{Material, StrainLimits};
use crate::output::Provenance;
use crate::output::vtu::{self, Field, Hexahedra};
use crate::progress::Share;

/// Name of the solver in `verification.json`.
pub const SOLVER: &str = "embedded";

/// How a design is verified inside the library.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EmbeddedOptions {
    /// Which model is solved.
    pub model: Model,
    /// Elements along a voxel's edge.
    pub elements_per_voxel_edge: usize,
    /// Processor cores; by default all.
    pub threads: Option<usize>,
    /// How the strip is solved.
    pub morph: MorphOptions,
}

impl Default for EmbeddedOptions {
    fn default() -> Self {
        Self { model: Model::Voxel, elements_per_voxel_edge: 1, threads: None, morph: MorphOptions::default() }
    }
}

/// A verified design: the figures and the solution they are taken from.
#[derive(Debug, Clone)]
pub struct EmbeddedVerification {
    /// The figures, as they stand in `verification.json`.
    pub verification: Verification,
    /// The strip.
    pub model: fem::Model,
    /// Its closed shape.
    pub solution: MorphSolution,
}

/// Solves a design's strip with the finite elements inside the library and compares the deformed mid-line with the target;
/// nothing is read or written.
///
/// # Errors
/// [`Error::Input`] for a strip that takes no shape and for one that does not fit into memory, [`Error::Solver`] where no
/// equilibrium is found, saying where and what was tried, [`Error::Cancelled`].
pub fn verify_embedded(
    design: &Design,
    options: &EmbeddedOptions,
    progress: Share<'_>,
) -> Result<EmbeddedVerification, Error> {
    let guide = require_shape(design)?;
    let start = Instant::now();
    let (resolution, path) = match options.model {
        Model::Voxel => (Resolution::Voxels(options.elements_per_voxel_edge), design.voxel_path()),
        Model::Graded => {
            (Resolution::Graded(design.input().decks.calculix_graded_elements), design.graded_path().ok().flatten())
        }
    };
    let (elements, layers) = size(design, resolution);
    let limit = options.morph.memory_limit.or_else(fem::memory::default_limit);
    fem::memory::require(elements, layers, limit)?;
    let solve = || {
        let model = fem::Model::of_design(design, resolution)?;
        Ok::<_, FemError>((morph::solve(&model, &Lead::new(guide, path), &options.morph, progress)?, model))
    };
    let (solution, model) = match options.threads {
        None => solve(),
        Some(threads) => rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .map_err(|e| Error::Internal(format!("{threads} threads: {e}")))?
            .install(solve),
    }?;
    let comparison = compare(design.profile(), &solution.midline)
        .ok_or_else(|| Error::Internal("a solution without a mid-line".to_owned()))?;
    let verification = Verification {
        provenance: Provenance::of(design.input()),
        model: options.model,
        solver: SolverRecord { name: SOLVER.to_owned(), version: env!("CARGO_PKG_VERSION").to_owned() },
        max_error_percent: comparison.max_error_percent,
        rms_error_percent: comparison.rms_error_percent,
        max_shape_error_percent: comparison.max_shape_error_percent,
        predicted_error_percent: predicted(design, options.model).map(|e| 100.0 * e),
        seconds: start.elapsed().as_secs_f64(),
        increments: solution.steps,
        iterations: solution.iterations,
        embedded: Some(record(design, &model, &solution)),
        midline_mm: solution.midline.clone(),
    };
    Ok(EmbeddedVerification { verification, model, solution })
}

/// Elements of a strip, and how many of them lie above each other.
fn size(design: &Design, resolution: Resolution) -> (u64, usize) {
    match resolution {
        Resolution::Voxels(per_edge) => {
            let elements = design.grid().phases().len() as u64 * (per_edge as u64).saturating_pow(3);
            (elements, design.grid().layers() * per_edge)
        }
        Resolution::Graded([along, across, through]) => ((along * across * through) as u64, through),
    }
}

fn record(design: &Design, model: &fem::Model, solution: &MorphSolution) -> EmbeddedRecord {
    let (rim, hub) = (solution.reactions.rim, solution.reactions.hub);
    let phases = design.phases().phases();
    let mixture = model.phases.first() == Some(&MIXTURE);
    let largest: Vec<(String, Option<f64>, StrainLimits)> = if mixture {
        let strains = solution.elements.principal_strains.iter().copied().fold(f64::MIN, f64::max);
        vec![("GRADED".to_owned(), Some(strains), StrainLimits::of_mixture(phases))]
    } else {
        let strains = solution.elements.largest_by_phase(&model.phases, phases.len());
        phases.iter().zip(strains).map(|(m, e)| (m.label(), e, StrainLimits::of(m))).collect()
    };
    let mut warnings = Vec::new();
    if solution.is_unstable() {
        warnings.push(format!(
            "this equilibrium is unstable: the strip would leave it by itself in {} direction{}, so the real one may take \
             another shape",
            solution.negative,
            if solution.negative == 1 { "" } else { "s" }
        ));
    }
    for (label, strain, limits) in &largest {
        warnings.extend(strain.iter().flat_map(|strain| limits.warnings(label, *strain)));
    }
    // The stress of a mixture is that of no phase.
    if !mixture {
        let stresses = solution.elements.largest_von_mises_by_phase(&model.phases, phases.len());
        let warning = |(m, stress): (&Material, Option<f64>)| m.stress_warning(stress?);
        warnings.extend(phases.iter().zip(stresses).filter_map(warning));
    }
    EmbeddedRecord {
        elements: model.mesh.elements.len(),
        unknowns: solution.unknowns,
        residual: solution.residual,
        unstable_branch: solution.is_unstable(),
        negative_eigenvalues: solution.negative,
        reactions: ReactionRecord {
            rim_horizontal_n: rim.horizontal,
            hub_horizontal_n: hub.horizontal,
            rim_vertical_n: rim.vertical,
            hub_vertical_n: hub.vertical,
            rim_moment_nmm: rim.moment,
            hub_moment_nmm: hub.moment,
        },
        largest_principal_strain: largest
            .into_iter()
            .filter_map(|(label, strain, _)| Some((label, Value::from(strain?))))
            .collect::<Map<String, Value>>(),
        warnings,
    }
}

impl EmbeddedVerification {
    /// Writes the strip as a VTU file: flat positions, displacements, and for every element its phase, strain, stress and
    /// largest principal strain.
    ///
    /// # Errors
    /// What the writer returns.
    pub fn write_vtu(&self, out: &mut dyn Write) -> io::Result<()> {
        let (model, results) = (&self.model, &self.solution.elements);
        let law = match model.law {
            Law::SaintVenantKirchhoff => "St. Venant-Kirchhoff",
            Law::NeoHooke => "compressible neo-Hookean",
        };
        let comment = format!(
            " {}. mm, MPa. Points are flat: warp by displacement_mm. Cells: means of Green-Lagrange strain (xx yy zz xy yz \
             xz, shears doubled) and second Piola-Kirchhoff stress; {law} law. ",
            self.verification.provenance.line()
        );
        let grid = Hexahedra {
            points: &model.mesh.nodes,
            cells: &model.mesh.elements,
            point_fields: vec![Field::vectors("displacement_mm", &self.solution.state.displacements)],
            cell_fields: vec![
                Field::labels("phase", &model.phases),
                Field::vectors("green_lagrange_strain", &results.strains),
                Field::vectors("second_piola_kirchhoff_stress_mpa", &results.stresses),
                Field::scalars("largest_principal_strain", results.principal_strains.iter().copied()),
            ],
        };
        vtu::write(&grid, &comment, out)
    }
}

impl From<FemError> for Error {
    fn from(error: FemError) -> Self {
        match error {
            FemError::Cancelled => Self::Cancelled,
            FemError::Memory { .. } => Self::Input(crate::InputError::new("voxels.size_mm", "", error.to_string())),
            other => Self::Solver(other.to_string()),
        }
    }
}
