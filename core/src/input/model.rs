//! The design file as types.

use serde::{Deserialize, Serialize};

use super::InputError;
use super::conduction::ConductionInput;
use super::fabrication::FabricationInput;
use super::indentation::IndentationInput;
use crate::elastica::{HubSupport, ThrustChoice};
use crate::materials::{Material, library};
use crate::micromechanics::PhaseSet;
use crate::voxel::{Lattice, Match, Pattern, Rounding};

/// A complete design: the design file with defaults filled in and the contents of the files it names.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DesignInput {
    /// Name of the design.
    pub name: String,
    /// The target.
    pub target: TargetInput,
    /// Number and size of the spokes.
    pub strips: StripsInput,
    /// How the line of thrust is chosen; absent for rectangular strips.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub thrust: Option<ThrustInput>,
    /// The phases.
    pub materials: MaterialsInput,
    /// The voxels.
    pub voxels: VoxelsInput,
    /// Correction by finite elements; absent where there is none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub refine: Option<RefineInput>,
    /// The decks.
    pub decks: DecksInput,
    /// The files to make the thing; absent where the design file says nothing about them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fabrication: Option<FabricationInput>,
    /// Heat and current; absent where the defaults are meant.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub conduction: Option<ConductionInput>,
    /// The dome under load; absent where the defaults are meant.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub indentation: Option<IndentationInput>,
}

/// The target of a design.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum TargetInput {
    /// A quarter ellipse.
    HemiEllipsoid {
        /// Horizontal over vertical semi-axis.
        aspect_ratio: f64,
    },
    /// The inclination as a polynomial.
    InclinationPolynomial {
        /// Degrees, highest power first.
        coefficients_deg: Vec<f64>,
    },
    /// A meridian given by points.
    Points {
        /// The CSV it was read from.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        file: Option<String>,
        /// `[rho, z]` in any one length unit.
        #[serde(default)]
        meridian: Vec<[f64; 2]>,
        /// Hash of the file's contents.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        content_sha256: Option<String>,
    },
    /// The outer meridian of a mesh.
    Mesh {
        /// The mesh it was read from.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        file: Option<String>,
        /// Axis of revolution.
        axis: AxisInput,
        /// The extracted, smooth meridian from rim to hub, `[rho, z]` in mm.
        #[serde(default)]
        meridian: Vec<[f64; 2]>,
        /// The axis that was found and how far the mesh is from a surface of revolution.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        revolution: Option<RevolutionRecord>,
        /// Hash of the file's contents.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        content_sha256: Option<String>,
    },
    /// A rectangular strip.
    Strip {
        /// Width, mm.
        width_mm: f64,
        /// Modulus in the middle over modulus at the ends.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        modulus_ratio: Option<f64>,
        /// Fraction of the stiffest phase.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        rigid_fraction: Option<f64>,
        /// Final shortening as a share of the length.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        shortening: Option<f64>,
    },
}

/// An axis by name or as a vector.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum AxisInput {
    /// `auto`, `x`, `y` or `z`.
    Named(String),
    /// A direction, from rim to apex.
    Vector([f64; 3]),
}

/// What was found out about a mesh target.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RevolutionRecord {
    /// Direction of the axis, from rim to apex.
    pub axis_direction: [f64; 3],
    /// A point of the axis.
    pub axis_point: [f64; 3],
    /// Distance of the mesh from a surface of revolution, rms over vertices, percent of the rim radius.
    pub rms_percent: f64,
    /// Factor from the mesh's unit to mm.
    pub scale: f64,
    /// Root mean square distance of the mesh's vertices from the smooth meridian, mm.
    pub residual_rms_mm: f64,
    /// Largest of these distances, mm.
    pub residual_max_mm: f64,
}

/// Number and size of the spokes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StripsInput {
    /// Number of spokes; absent for rectangular strips.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub count: Option<usize>,
    /// Arc length, mm.
    pub length_mm: f64,
    /// Hub radius, mm; absent for rectangular strips.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hub_radius_mm: Option<f64>,
    /// Thickness, mm.
    pub thickness_mm: f64,
}

/// How the line of thrust is chosen.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ThrustInput {
    /// Support of the hub.
    pub hub: HubSupport,
    /// Choice of the free parameters; by default equal ends with a free hub, least contrast with a held one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub choice: Option<ThrustChoice>,
}

impl ThrustInput {
    /// The choice with its default filled in.
    #[must_use]
    pub fn resolved_choice(&self) -> ThrustChoice {
        self.choice.unwrap_or(match self.hub {
            HubSupport::Free => ThrustChoice::EqualEnds,
            HubSupport::Held => ThrustChoice::LeastContrast,
        })
    }
}

/// The phases.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MaterialsInput {
    /// Names, softest first.
    pub phases: Vec<String>,
    /// Fraction that the intermediate of three phases keeps.
    pub intermediate_fraction: f64,
    /// Custom materials.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub custom: Vec<Material>,
}

/// The voxels.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct VoxelsInput {
    /// Edge, mm.
    pub size_mm: f64,
    /// Arrangement.
    pub pattern: Pattern,
    /// Seed.
    pub seed: u64,
    /// Which property meets its target.
    #[serde(rename = "match")]
    pub matching: Match,
    /// Rounding of the half-width.
    pub rounding: Rounding,
}

/// Correction of the modulus by finite elements.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RefineInput {
    /// Solutions that may be spent on it; zero for none.
    #[serde(default)]
    pub iterations: usize,
    /// Factors of the voxels' modulus at evenly spaced arc lengths, rim first, that were found.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub correction: Vec<f64>,
    /// Largest distance from the target, percent of the length: without a correction, and after every step.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub errors_percent: Vec<f64>,
}

impl RefineInput {
    /// Most factors of a correction.
    pub const MOST_FACTORS: usize = 1001;
    /// Smallest and largest factor.
    pub const FACTORS: [f64; 2] = [0.01, 100.0];

    /// The factor at a share of the strip's length, linear between the recorded ones; one without a correction.
    #[must_use]
    pub fn factor(&self, share: f64) -> f64 {
        let (Some(last), Some(first)) = (self.correction.len().checked_sub(1), self.correction.first()) else {
            return 1.0;
        };
        let at = (share * last as f64).clamp(0.0, last as f64);
        let i = (at as usize).min(last.saturating_sub(1));
        let (low, high) = (self.correction.get(i).unwrap_or(first), self.correction.get(i + 1).unwrap_or(first));
        low + (at - i as f64) * (high - low)
    }

    fn validate(&self) -> Result<(), InputError> {
        let [least, most] = Self::FACTORS;
        if self.correction.len() > Self::MOST_FACTORS {
            let problem = format!("a correction has at most {} factors", Self::MOST_FACTORS);
            return Err(InputError::new("refine.correction", self.correction.len(), problem));
        }
        match self.correction.iter().position(|f| !(least..=most).contains(f)) {
            Some(i) => {
                let problem = format!("factors lie between {least} and {most}");
                Err(InputError::new(format!("refine.correction.{i}"), self.correction[i], problem)
                    .help("design again with iterations and without a correction"))
            }
            None => Ok(()),
        }
    }
}

/// A kind of deck.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DeckKind {
    /// All spokes and the hub as shells, smooth width, graded modulus.
    GradedShell,
    /// One spoke as a solid, smooth width, graded modulus.
    GradedSolid,
    /// One spoke, every voxel its phase.
    VoxelSolid,
    /// All spokes as shells on the voxel outline.
    VoxelShell,
    /// Heat in one spoke, every voxel its phase.
    VoxelHeat,
    /// Heat in one spoke, smooth width, one mixture a slice.
    GradedHeat,
    /// Current in one spoke, every voxel its phase.
    VoxelCurrent,
    /// Current in one spoke, smooth width, one mixture a slice.
    GradedCurrent,
    /// One spoke as a graded solid, morphed and then pressed.
    GradedSolidIndentation,
    /// All spokes as shells of smooth width, morphed and then pressed.
    GradedShellIndentation,
    /// All spokes as shells on the voxel outline, morphed and then pressed in explicit dynamics.
    VoxelShellIndentation,
}

impl DeckKind {
    /// The name in design files and the stem of the deck's file.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::GradedShell => "graded_shell",
            Self::GradedSolid => "graded_solid",
            Self::VoxelSolid => "voxel_solid",
            Self::VoxelShell => "voxel_shell",
            Self::VoxelHeat => "voxel_heat",
            Self::GradedHeat => "graded_heat",
            Self::VoxelCurrent => "voxel_current",
            Self::GradedCurrent => "graded_current",
            Self::GradedSolidIndentation => "graded_solid_indentation",
            Self::GradedShellIndentation => "graded_shell_indentation",
            Self::VoxelShellIndentation => "voxel_shell_indentation",
        }
    }

    /// Whether the dome is pressed after the morph.
    #[must_use]
    pub fn is_indentation(self) -> bool {
        matches!(self, Self::GradedSolidIndentation | Self::GradedShellIndentation | Self::VoxelShellIndentation)
    }

    /// The mechanical deck on whose mesh it is.
    #[must_use]
    pub fn mesh(self) -> Self {
        match self {
            Self::VoxelHeat | Self::VoxelCurrent => Self::VoxelSolid,
            Self::GradedHeat | Self::GradedCurrent | Self::GradedSolidIndentation => Self::GradedSolid,
            Self::GradedShellIndentation => Self::GradedShell,
            Self::VoxelShellIndentation => Self::VoxelShell,
            other => other,
        }
    }

    /// Keys of a material that the deck cannot do without.
    fn needs(self) -> &'static [(&'static str, MaterialValue)] {
        match self {
            Self::VoxelHeat | Self::GradedHeat => &[("conductivity_w_mk", |m| m.conductivity_w_mk)],
            Self::VoxelCurrent | Self::GradedCurrent => &[
                ("conductivity_w_mk", |m| m.conductivity_w_mk),
                ("electrical_conductivity_s_m", |m| m.electrical_conductivity_s_m),
            ],
            Self::VoxelShellIndentation => &[("density_kg_m3", |m| m.density_kg_m3)],
            _ => &[],
        }
    }
}

/// A value that a material may have.
type MaterialValue = fn(&Material) -> Option<f64>;

/// A solver that decks are written for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum DeckSolver {
    /// ABAQUS.
    Abaqus,
    /// CalculiX.
    Calculix,
    /// Any program that reads meshes as NASTRAN bulk data, such as COMSOL.
    Nastran,
}

impl DeckSolver {
    /// The folder of its decks and their ending.
    #[must_use]
    pub fn folder_and_ending(self) -> (&'static str, &'static str) {
        match self {
            Self::Abaqus => ("abaqus", "inp"),
            Self::Calculix => ("calculix", "inp"),
            Self::Nastran => ("nastran", "bdf"),
        }
    }
}

/// How an ABAQUS deck is laid out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum DeckStyle {
    /// Parts, instances and an assembly.
    Parts,
    /// One flat model.
    Flat,
}

/// The decks.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DecksInput {
    /// Kinds to write.
    pub write: Vec<DeckKind>,
    /// Solvers to write for.
    pub solvers: Vec<DeckSolver>,
    /// Elements along a voxel's edge, ABAQUS.
    pub elements_per_voxel_edge: usize,
    /// Elements along a voxel's edge, CalculiX.
    pub calculix_elements_per_voxel_edge: usize,
    /// Elements along, across and through a spoke, ABAQUS.
    pub graded_elements: [usize; 3],
    /// Elements along, across and through a spoke, CalculiX.
    pub calculix_graded_elements: [usize; 3],
    /// Elements along and across a spoke of the graded shell.
    pub shell_elements: [usize; 2],
    /// Solid element of ABAQUS decks.
    pub solid_element: String,
    /// Shell element of ABAQUS decks.
    pub shell_element: String,
    /// Layout of ABAQUS decks.
    pub style: DeckStyle,
}

impl DesignInput {
    /// Whether the target is a rectangular strip and not a dome.
    #[must_use]
    pub fn is_strip(&self) -> bool {
        matches!(self.target, TargetInput::Strip { .. })
    }

    /// Number of spokes; one for a rectangular strip.
    #[must_use]
    pub fn count(&self) -> usize {
        self.strips.count.unwrap_or(1)
    }

    /// Hub radius, mm; zero for a rectangular strip.
    #[must_use]
    pub fn hub_radius(&self) -> f64 {
        self.strips.hub_radius_mm.unwrap_or(0.0)
    }

    /// How the thing is made: the design file's table, or its defaults.
    ///
    /// # Errors
    /// None in practice: the defaults of the table of parameters are values of its own types.
    pub fn fabrication(&self) -> Result<FabricationInput, InputError> {
        self.fabrication.clone().map_or_else(FabricationInput::defaults, Ok)
    }

    /// The phases, from the custom materials and the library.
    ///
    /// # Errors
    /// [`InputError`] for a name that is not known (naming the closest), for two custom materials of one name, and for
    /// phases in the wrong order.
    pub fn phase_set(&self) -> Result<PhaseSet, InputError> {
        let known: Vec<Material> = self.materials.custom.iter().cloned().chain(library()).collect();
        for (i, custom) in self.materials.custom.iter().enumerate() {
            if self.materials.custom[..i].iter().any(|other| other.name == custom.name) {
                let key = format!("materials.custom.{i}.name");
                return Err(InputError::new(key, quoted(&custom.name), "two custom materials have this name"));
            }
        }
        let mut phases = Vec::new();
        for (i, name) in self.materials.phases.iter().enumerate() {
            let key = format!("materials.phases.{i}");
            let Some(material) = known.iter().find(|m| m.name == *name) else {
                return Err(unknown_material(&key, name, &known));
            };
            material.check_label(&key)?;
            phases.push(material.clone());
        }
        let names: Vec<String> = self.materials.phases.iter().map(|p| quoted(p)).collect();
        PhaseSet::new(phases, self.materials.intermediate_fraction)
            .map_err(|error| InputError::new("materials.phases", format!("[{}]", names.join(", ")), error.to_string()))
    }

    /// Rules that concern more than one key.
    ///
    /// # Errors
    /// [`InputError`] naming the keys and what would help.
    pub fn validate(&self) -> Result<(), InputError> {
        if let Some(thrust) = &self.thrust
            && thrust.hub == HubSupport::Held
            && thrust.choice == Some(ThrustChoice::EqualEnds)
        {
            let problem =
                "equal ends fix the line of thrust without a vertical force, so they do not go with hub = \"held\"";
            return Err(InputError::new("thrust.choice", "\"equal-ends\"", problem)
                .help("use choice = \"least-contrast\" or hub = \"free\""));
        }
        if let TargetInput::Strip { modulus_ratio, rigid_fraction, .. } = &self.target
            && modulus_ratio.is_some() == rigid_fraction.is_some()
        {
            return Err(InputError::new("target", "", "a strip needs either modulus_ratio or rigid_fraction")
                .help("modulus_ratio grades it along its length, rigid_fraction makes it uniform"));
        }
        if let TargetInput::Points { file, meridian, .. } | TargetInput::Mesh { file, meridian, .. } = &self.target {
            if file.is_none() && meridian.is_empty() {
                return Err(
                    InputError::new("target.file", "", "this key is missing").help("name the file of the target")
                );
            }
            if let Some(pair) = meridian.iter().find(|pair| pair.iter().any(|c| !c.is_finite())) {
                return Err(InputError::new("target.meridian", format!("{pair:?}"), "coordinates must be finite"));
            }
        }
        if let Some(radius) = self.strips.hub_radius_mm
            && radius >= 1e3 * self.strips.length_mm
        {
            let problem =
                format!("the hub is more than a thousand times longer than the spoke of {} mm", self.strips.length_mm);
            return Err(InputError::new("strips.hub_radius_mm", radius, problem));
        }
        if self.strips.thickness_mm > self.strips.length_mm / 5.0 {
            let problem = format!("a strip of {} mm is too thick to bend as a strip", self.strips.length_mm);
            return Err(InputError::new("strips.thickness_mm", self.strips.thickness_mm, problem)
                .help("use at most a fifth of the length"));
        }
        for (key, counts) in [
            ("decks.graded_elements", &self.decks.graded_elements[1..]),
            ("decks.calculix_graded_elements", &self.decks.calculix_graded_elements[1..]),
            ("decks.shell_elements", &self.decks.shell_elements[1..]),
        ] {
            if let Some(odd) = counts.iter().find(|n| *n % 2 == 1) {
                return Err(InputError::new(key, odd, "the numbers across and through the spoke must be even")
                    .help("an even number has nodes on the mid-line"));
            }
        }
        if self.decks.solid_element == "C3D8R" && self.decks.graded_elements[2] < 4 {
            let problem = "C3D8R needs at least four elements through the thickness to bend";
            return Err(InputError::new("decks.graded_elements", format!("{:?}", self.decks.graded_elements), problem)
                .help("use four or more, or solid_element = \"C3D8I\""));
        }
        if let Some(fabrication) = &self.fabrication {
            fabrication.validate()?;
        }
        if let Some(conduction) = &self.conduction {
            conduction.validate()?;
        }
        if let Some(indentation) = &self.indentation {
            indentation.validate()?;
        }
        if let Some(refine) = &self.refine {
            refine.validate()?;
        }
        let size = self.voxels.size_mm;
        Lattice::new(self.strips.length_mm, self.strips.thickness_mm, size)
            .map_err(|error| InputError::new("voxels.size_mm", size, error.to_string()))?;
        let legal = |c: char| !c.is_control() && !"/\\:*?\"<>|".contains(c);
        if !self.name.chars().all(legal) || self.name.starts_with('.') || self.name.chars().count() > 100 {
            return Err(InputError::new("name", quoted(&self.name), "this is not usable as a file name")
                .help("use at most 100 letters, digits, blanks, - and _"));
        }
        if self.voxels.matching == Match::Calibrated && self.materials.phases.len() != 2 {
            let problem = format!("a calibrated mixture rule is for two phases, not {}", self.materials.phases.len());
            return Err(InputError::new("voxels.match", "\"calibrated\"", problem)
                .help("use match = \"modulus\" or \"stiffness\""));
        }
        let phases = self.phase_set()?;
        for kind in &self.decks.write {
            for (key, value) in kind.needs() {
                if let Some(lacking) = phases.phases().iter().find(|m| value(m).is_none()) {
                    let problem = format!("this deck needs {key}, which {} does not have", quoted(&lacking.name));
                    return Err(InputError::new("decks.write", quoted(kind.name()), problem)
                        .help("use phases that have it, or give it in a [[materials.custom]] table of that name"));
                }
            }
        }
        Ok(())
    }
}

fn quoted(text: &str) -> String {
    format!("\"{text}\"")
}

fn unknown_material(key: &str, name: &str, known: &[Material]) -> InputError {
    let lower = name.to_lowercase();
    let closest = known
        .iter()
        .map(|m| (strsim::jaro_winkler(&m.name.to_lowercase(), &lower), m))
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .filter(|(likeness, _)| *likeness > 0.8);
    let names: Vec<&str> = known.iter().map(|m| m.name.as_str()).collect();
    let help = match closest {
        Some((_, material)) => format!("did you mean \"{}\"? Known are: {}", material.name, names.join(", ")),
        None => format!("known are: {}; or add a [[materials.custom]] table", names.join(", ")),
    };
    InputError::new(key, quoted(name), "this material is not known").help(help)
}
