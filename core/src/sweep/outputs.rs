//! The figures of a point, and the models that have them.

use serde::{Deserialize, Serialize};

/// What is computed of every point.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SweepModel {
    /// The design.
    #[default]
    Design,
    /// The design, and its dome pressed as an elastica.
    Elastica,
    /// The design, and its graded strip morphed by the finite elements inside.
    Graded,
    /// The design, and every voxel morphed by the finite elements inside.
    Voxel,
    /// The design, and its voxel deck solved by CalculiX.
    Ccx,
    /// The design, and steady heat and current through its flat voxels.
    Conduct,
    /// The design, solved elsewhere: results come by `sweep --record`.
    External,
}

/// A figure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Output {
    /// Column of the table, with its unit.
    pub name: &'static str,
    /// What it is.
    pub description: &'static str,
    /// Models that have it; empty for all.
    models: &'static [SweepModel],
}

const fn of_all(name: &'static str, description: &'static str) -> Output {
    Output { name, description, models: &[] }
}

const fn of(models: &'static [SweepModel], name: &'static str, description: &'static str) -> Output {
    Output { name, description, models }
}

const PRESSED: &[SweepModel] = &[SweepModel::Elastica];
const MORPHED: &[SweepModel] = &[SweepModel::Graded, SweepModel::Voxel, SweepModel::Ccx, SweepModel::External];
const INSIDE: &[SweepModel] = &[SweepModel::Graded, SweepModel::Voxel];
const CONDUCTED: &[SweepModel] = &[SweepModel::Conduct];

/// All figures, in the order of the table.
pub const OUTPUTS: &[Output] = &[
    of_all("contrast", "largest over smallest designed modulus"),
    of_all("peak_modulus_mpa", "largest designed modulus"),
    of_all("mean_modulus_mpa", "designed modulus, mean over the volume of a spoke"),
    of_all("compression", "1 - x(L)/L"),
    of_all("height_mm", "height of the dome"),
    of_all("rim_radius_mm", "radius of the dome"),
    of_all("horizontal_n", "horizontal force at the rim of a spoke, beam bending"),
    of_all("vertical_n", "vertical force on the hub of a spoke, beam bending"),
    of_all("volume_mm3", "volume of a smooth spoke"),
    of_all("voxels", "voxels of a spoke"),
    of_all("rigid_share", "share of the stiffest phase in them"),
    of_all(
        "predicted_error_percent",
        "largest distance of the voxelised strip from the target, by the elastica, percent of the length",
    ),
    of(PRESSED, "tangent_n_mm", "stiffness of a spoke at no depth"),
    of(PRESSED, "rigidity_n_mm", "rigidity K of a spoke: slope up to the thickness"),
    of(PRESSED, "force_n", "force on a spoke at the full depth"),
    of(PRESSED, "work_nmm", "work W of a spoke to the full depth"),
    of(PRESSED, "specific_energy_nmm_mm3", "specific energy psi = W/V"),
    of(PRESSED, "bending_strain", "largest strain of the faces on the way"),
    of(
        PRESSED,
        "contact_depth_mm",
        "depth at which the indenter first touches beside the hub; nothing where it never does",
    ),
    of(MORPHED, "max_error_percent", "largest distance of the solved strip from the target, percent of the length"),
    of(MORPHED, "rms_error_percent", "root mean square of that distance"),
    of(INSIDE, "rim_horizontal_n", "horizontal reaction at the rim of a spoke"),
    of(INSIDE, "rim_moment_nmm", "moment at the rim of a spoke"),
    of(INSIDE, "largest_strain", "largest principal strain of any phase"),
    of(INSIDE, "unstable", "1 where the equilibrium is unstable"),
    of(CONDUCTED, "conductivity_w_mk", "effective thermal conductivity by steady flow"),
    of(CONDUCTED, "electrical_conductivity_s_m", "effective electrical conductivity by steady flow"),
];

impl SweepModel {
    /// Whether the model has a figure.
    #[must_use]
    pub fn has(self, output: &Output) -> bool {
        output.models.is_empty() || output.models.contains(&self)
    }

    /// The word of the sweep file.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Design => "design",
            Self::Elastica => "elastica",
            Self::Graded => "graded",
            Self::Voxel => "voxel",
            Self::Ccx => "ccx",
            Self::Conduct => "conduct",
            Self::External => "external",
        }
    }
}

/// What a figure is; of a key, its description in the design file.
#[must_use]
pub fn describe(column: &str) -> String {
    if let Some(output) = OUTPUTS.iter().find(|o| o.name == column) {
        return output.description.to_owned();
    }
    crate::input::parameters::parameter(column).map_or_else(String::new, |p| p.description.to_owned())
}
