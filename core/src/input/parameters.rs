//! The table of keys of a design file: name, type, unit, range, default and description.
//!
//! Checks, JSON Schema, the reference in `docs/design-file.md` and the forms of host programs are all made from it.

mod conduction;
mod fabrication;
mod indentation;

use serde::Serialize;

/// What a key accepts.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(tag = "type", rename_all = "kebab-case")]
pub enum Kind {
    /// A text.
    Text,
    /// A path, relative to the design file.
    Path,
    /// One of several words.
    Choice {
        /// The words.
        choices: &'static [&'static str],
    },
    /// A number.
    Number {
        /// Lower limit.
        least: f64,
        /// Whether the lower limit itself is excluded.
        exclusive: bool,
        /// Upper limit.
        most: f64,
    },
    /// A whole number.
    Integer {
        /// Lower limit.
        least: i64,
        /// Upper limit.
        most: i64,
    },
    /// A list of numbers.
    Numbers {
        /// Fewest entries.
        least: usize,
        /// Most entries.
        most: usize,
    },
    /// A list of whole numbers of fixed length.
    Integers {
        /// Number of entries.
        count: usize,
        /// Lower limit of each.
        least: i64,
        /// Upper limit of each.
        most: i64,
    },
    /// A list of texts.
    Texts {
        /// Fewest entries.
        least: usize,
        /// Most entries.
        most: usize,
    },
    /// A list of words.
    Choices {
        /// The words.
        choices: &'static [&'static str],
    },
    /// A word or a vector of three numbers.
    ChoiceOrVector {
        /// The words.
        choices: &'static [&'static str],
    },
    /// Pairs of numbers.
    Pairs,
    /// Recorded by `design.json`; not meant to be written by hand.
    Recorded,
}

/// One key of the design file.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Parameter {
    /// Dotted key.
    pub key: &'static str,
    /// What it accepts.
    #[serde(flatten)]
    pub kind: Kind,
    /// Unit, where it has one.
    pub unit: Option<&'static str>,
    /// Default as JSON text; `None` where the key is required or has no value unless given.
    pub default: Option<&'static str>,
    /// Whether it must be given (for the targets it applies to).
    pub required: bool,
    /// Target kinds it applies to; empty for all.
    pub targets: &'static [&'static str],
    /// What it means.
    pub description: &'static str,
}

/// Kinds of targets.
pub const TARGET_KINDS: &[&str] = &["hemi-ellipsoid", "inclination-polynomial", "points", "mesh", "strip"];
const DOMES: &[&str] = &["hemi-ellipsoid", "inclination-polynomial", "points", "mesh"];
const FILES: &[&str] = &["points", "mesh"];
const STRIP: &[&str] = &["strip"];

const fn length(most: f64) -> Kind {
    Kind::Number { least: 0.0, exclusive: true, most }
}

const fn between(least: f64, most: f64) -> Kind {
    Kind::Number { least, exclusive: false, most }
}

const BASE: Parameter =
    Parameter { key: "", kind: Kind::Text, unit: None, default: None, required: false, targets: &[], description: "" };

/// Keys by subject, in the order in which a design file is read.
const GROUPS: [&[Parameter]; 4] = [DESIGN, conduction::CONDUCTION, fabrication::FABRICATION, indentation::INDENTATION];

/// Number of keys.
const COUNT: usize = {
    let (mut count, mut group) = (0, 0);
    while group < GROUPS.len() {
        count += GROUPS[group].len();
        group += 1;
    }
    count
};

/// All keys, in the order in which a design file is read.
pub const PARAMETERS: &[Parameter] = &all();

const fn all() -> [Parameter; COUNT] {
    let mut all = [BASE; COUNT];
    let (mut next, mut group) = (0, 0);
    while group < GROUPS.len() {
        let mut i = 0;
        while i < GROUPS[group].len() {
            all[next] = GROUPS[group][i];
            next += 1;
            i += 1;
        }
        group += 1;
    }
    all
}

/// Tables that a design has only where its file has them, so that their defaults change no other design.
pub const OPTIONAL_TABLES: [&str; 3] = ["conduction", "fabrication", "indentation"];

/// Keys of the design itself.
const DESIGN: &[Parameter] = &[
    Parameter {
        key: "name",
        description: "Name of the design, used in file names; by default the file's stem.",
        ..BASE
    },
    Parameter {
        key: "target.kind",
        kind: Kind::Choice { choices: TARGET_KINDS },
        required: true,
        description: "What the target is: a dome given in one of four ways, or a rectangular strip.",
        ..BASE
    },
    Parameter {
        key: "target.aspect_ratio",
        kind: between(0.05, 20.0),
        default: Some("1.0"),
        targets: &["hemi-ellipsoid"],
        description: "Horizontal over vertical semi-axis; the spoke is the quarter ellipse from rim to hub edge.",
        ..BASE
    },
    Parameter {
        key: "target.coefficients_deg",
        kind: Kind::Numbers { least: 1, most: 21 },
        unit: Some("deg"),
        required: true,
        targets: &["inclination-polynomial"],
        description: "Inclination as a polynomial of the arc length from rim (0) to hub (1), highest power first.",
        ..BASE
    },
    Parameter {
        key: "target.file",
        kind: Kind::Path,
        targets: FILES,
        description: "points: a CSV with columns rho,z in any one length unit; mesh: an .obj, .gltf, .glb or .stl file.",
        ..BASE
    },
    Parameter {
        key: "target.axis",
        kind: Kind::ChoiceOrVector { choices: &["auto", "x", "y", "z"] },
        default: Some("\"auto\""),
        targets: &["mesh"],
        description: "Axis of revolution of the mesh, pointing from rim to apex, or auto to find it.",
        ..BASE
    },
    Parameter {
        key: "target.width_mm",
        kind: length(1e5),
        unit: Some("mm"),
        required: true,
        targets: STRIP,
        description: "Width of the rectangular strip.",
        ..BASE
    },
    Parameter {
        key: "target.modulus_ratio",
        kind: between(1e-3, 1e3),
        targets: STRIP,
        description: "Modulus in the middle over modulus at the ends, linear in between.",
        ..BASE
    },
    Parameter {
        key: "target.rigid_fraction",
        kind: between(0.0, 1.0),
        targets: STRIP,
        description: "The same volume fraction of the stiffest phase along the whole strip.",
        ..BASE
    },
    Parameter {
        key: "target.shortening",
        kind: between(1e-3, 0.9),
        targets: STRIP,
        description: "Clamped ends are pushed together by this share of the length; without it the strip is stretched.",
        ..BASE
    },
    Parameter {
        key: "target.meridian",
        kind: Kind::Pairs,
        targets: FILES,
        description: "The meridian itself, [rho, z] pairs in any one length unit, in place of a file.",
        ..BASE
    },
    Parameter {
        key: "target.content_sha256",
        kind: Kind::Recorded,
        targets: FILES,
        description: "Hash of the file the meridian was taken from.",
        ..BASE
    },
    Parameter {
        key: "target.revolution",
        kind: Kind::Recorded,
        targets: &["mesh"],
        description: "The axis that was found and the distance of the mesh from a surface of revolution.",
        ..BASE
    },
    Parameter {
        key: "strips.count",
        kind: Kind::Integer { least: 3, most: 1000 },
        required: true,
        targets: DOMES,
        description: "Number of spokes.",
        ..BASE
    },
    Parameter {
        key: "strips.length_mm",
        kind: length(1e5),
        unit: Some("mm"),
        required: true,
        description: "Arc length of a spoke from rim to hub edge.",
        ..BASE
    },
    Parameter {
        key: "strips.hub_radius_mm",
        kind: length(1e5),
        unit: Some("mm"),
        required: true,
        targets: DOMES,
        description: "Radius of the circle inscribed in the hub.",
        ..BASE
    },
    Parameter {
        key: "strips.thickness_mm",
        kind: length(1e4),
        unit: Some("mm"),
        required: true,
        description: "Thickness of the sheet.",
        ..BASE
    },
    Parameter {
        key: "thrust.hub",
        kind: Kind::Choice { choices: &["free", "held"] },
        default: Some("\"free\""),
        targets: DOMES,
        description: "Whether a vertical force (a post, a weight, a tie) may act on the hub.",
        ..BASE
    },
    Parameter {
        key: "thrust.choice",
        kind: Kind::Choice { choices: &["equal-ends", "least-contrast"] },
        targets: DOMES,
        description: "How the line of thrust is chosen: equal moduli at both ends (the default with a free hub), or the \
                      least contrast (always with a held hub).",
        ..BASE
    },
    Parameter {
        key: "materials.phases",
        kind: Kind::Texts { least: 2, most: 3 },
        required: true,
        description: "Two or three materials, softest first: names from the library or of custom materials.",
        ..BASE
    },
    Parameter {
        key: "materials.intermediate_fraction",
        kind: between(0.0, 0.9),
        default: Some("0.2"),
        description: "Three phases: the fraction the intermediate phase keeps.",
        ..BASE
    },
    Parameter {
        key: "materials.custom.name",
        required: true,
        description: "Name of a custom material; it hides a library material of that name.",
        ..BASE
    },
    Parameter {
        key: "materials.custom.modulus_mpa",
        kind: length(1e7),
        unit: Some("MPa"),
        required: true,
        description: "Young's modulus.",
        ..BASE
    },
    Parameter {
        key: "materials.custom.poisson",
        kind: between(0.0, 0.499),
        required: true,
        description: "Poisson's ratio.",
        ..BASE
    },
    Parameter {
        key: "materials.custom.density_kg_m3",
        kind: length(1e5),
        unit: Some("kg/m^3"),
        description: "Density.",
        ..BASE
    },
    Parameter {
        key: "materials.custom.conductivity_w_mk",
        kind: length(1e6),
        unit: Some("W/(m K)"),
        description: "Thermal conductivity.",
        ..BASE
    },
    Parameter {
        key: "materials.custom.specific_heat_j_kgk",
        kind: length(1e6),
        unit: Some("J/(kg K)"),
        description: "Specific heat.",
        ..BASE
    },
    Parameter {
        key: "materials.custom.electrical_conductivity_s_m",
        kind: length(1e9),
        unit: Some("S/m"),
        description: "Electrical conductivity.",
        ..BASE
    },
    Parameter {
        key: "materials.custom.relative_permittivity",
        kind: between(1.0, 1e6),
        description: "Permittivity relative to that of vacuum.",
        ..BASE
    },
    Parameter {
        key: "materials.custom.max_strain",
        kind: length(100.0),
        description: "Largest principal strain the material stands.",
        ..BASE
    },
    Parameter {
        key: "materials.custom.modulus_scatter_percent",
        kind: between(0.0, 90.0),
        unit: Some("%"),
        description: "Standard deviation of the modulus over its mean: where every phase has one, the band of forces in \
                      indentation is made of them.",
        ..BASE
    },
    Parameter {
        key: "materials.custom.yield_strength_mpa",
        kind: length(1e6),
        unit: Some("MPa"),
        description: "Stress at which the material yields (0.2 % offset).",
        ..BASE
    },
    Parameter {
        key: "materials.custom.yield_strain",
        kind: length(100.0),
        description: "Strain at which the material yields.",
        ..BASE
    },
    Parameter {
        key: "voxels.size_mm",
        kind: length(1e4),
        unit: Some("mm"),
        required: true,
        description: "Voxel edge; length and thickness must be whole multiples of it.",
        ..BASE
    },
    Parameter {
        key: "voxels.pattern",
        kind: Kind::Choice {
            choices: &["random", "random-layered", "centred", "split", "through-thickness", "one-edge"],
        },
        default: Some("\"random\""),
        description: "Where the phases sit in a cross-section.",
        ..BASE
    },
    Parameter {
        key: "voxels.seed",
        kind: Kind::Integer { least: 0, most: i64::MAX },
        default: Some("1"),
        description: "Seed of the random patterns.",
        ..BASE
    },
    Parameter {
        key: "voxels.match",
        kind: Kind::Choice { choices: &["modulus", "stiffness", "calibrated"] },
        default: Some("\"modulus\""),
        description: "What meets its target in a slice: the mean modulus, the bending stiffness of plane sections, or (two \
                      phases) the modulus in bending by a rule calibrated on random cells.",
        ..BASE
    },
    Parameter {
        key: "voxels.rounding",
        kind: Kind::Choice { choices: &["nearest", "inward"] },
        default: Some("\"nearest\""),
        description: "How the half-width is rounded to voxels; inward avoids overlaps of neighbouring spokes.",
        ..BASE
    },
    Parameter {
        key: "refine.iterations",
        kind: Kind::Integer { least: 0, most: 20 },
        description: "Most rounds of solving and correcting the modulus; a round solves one strip, of small ones several. None without this table.",
        ..BASE
    },
    Parameter {
        key: "refine.correction",
        kind: Kind::Recorded,
        description: "Factors of the voxels' modulus from rim to hub that were found.",
        ..BASE
    },
    Parameter {
        key: "refine.errors_percent",
        kind: Kind::Recorded,
        description: "Largest distance from the target before and after every step.",
        ..BASE
    },
    Parameter {
        key: "decks.write",
        kind: Kind::Choices {
            choices: &[
                "graded_shell",
                "graded_solid",
                "voxel_solid",
                "voxel_shell",
                "voxel_heat",
                "graded_heat",
                "voxel_current",
                "graded_current",
                "graded_solid_indentation",
                "graded_shell_indentation",
                "voxel_shell_indentation",
            ],
        },
        default: Some("[\"graded_shell\", \"graded_solid\", \"voxel_solid\", \"voxel_shell\"]"),
        description: "Which decks are written; an empty list writes none. Heat and current need phases that have the \
                      conductivities, voxel_shell_indentation their densities.",
        ..BASE
    },
    Parameter {
        key: "decks.solvers",
        kind: Kind::Choices { choices: &["abaqus", "calculix", "nastran"] },
        default: Some("[\"abaqus\", \"calculix\"]"),
        description: "For which solvers; shells and current are for ABAQUS only, nastran writes the meshes of the solids for \
                      COMSOL and others.",
        ..BASE
    },
    Parameter {
        key: "decks.elements_per_voxel_edge",
        kind: Kind::Integer { least: 1, most: 8 },
        default: Some("2"),
        description: "Elements along a voxel's edge in ABAQUS's voxel_solid deck.",
        ..BASE
    },
    Parameter {
        key: "decks.calculix_elements_per_voxel_edge",
        kind: Kind::Integer { least: 1, most: 8 },
        default: Some("1"),
        description: "Elements along a voxel's edge in CalculiX's voxel_solid deck.",
        ..BASE
    },
    Parameter {
        key: "decks.graded_elements",
        kind: Kind::Integers { count: 3, least: 2, most: 2000 },
        default: Some("[100, 12, 4]"),
        description: "Elements along, across and through a spoke in ABAQUS's graded_solid deck; the last two even.",
        ..BASE
    },
    Parameter {
        key: "decks.calculix_graded_elements",
        kind: Kind::Integers { count: 3, least: 2, most: 2000 },
        default: Some("[80, 6, 2]"),
        description: "Elements along, across and through a spoke in CalculiX's graded_solid deck; the last two even.",
        ..BASE
    },
    Parameter {
        key: "decks.shell_elements",
        kind: Kind::Integers { count: 2, least: 2, most: 2000 },
        default: Some("[96, 20]"),
        description: "Elements along and across a spoke in the graded_shell deck; the last one even.",
        ..BASE
    },
    Parameter {
        key: "decks.solid_element",
        kind: Kind::Choice { choices: &["C3D8R", "C3D8I", "C3D8"] },
        default: Some("\"C3D8R\""),
        description: "Element type of ABAQUS's solid decks.",
        ..BASE
    },
    Parameter {
        key: "decks.shell_element",
        kind: Kind::Choice { choices: &["S4R", "S4"] },
        default: Some("\"S4R\""),
        description: "Element type of ABAQUS's shell decks.",
        ..BASE
    },
    Parameter {
        key: "decks.style",
        kind: Kind::Choice { choices: &["parts", "flat"] },
        default: Some("\"parts\""),
        description: "ABAQUS decks with parts, instances and an assembly, or flat.",
        ..BASE
    },
];

/// The parameter with a dotted key.
#[must_use]
pub fn parameter(key: &str) -> Option<&'static Parameter> {
    PARAMETERS.iter().find(|p| p.key == key)
}

impl Parameter {
    /// Whether it applies to a kind of target.
    #[must_use]
    pub fn applies_to(&self, target_kind: &str) -> bool {
        self.targets.is_empty() || self.targets.contains(&target_kind)
    }
}
