//! The `[fabrication]` table as types.

use std::fmt;

use serde::{Deserialize, Serialize};

use super::InputError;
use super::check::defaults;

/// A kind of file to make the thing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FabricationKind {
    /// One closed mesh a phase.
    Stl,
    /// A 3MF package.
    #[serde(rename = "3mf")]
    ThreeMf,
    /// A folder of PNG slices at a printer's pitch.
    PrintStack,
    /// GrabCAD's container of PNG slices.
    Gcvf,
    /// Cut lines for a laser cutter.
    Dxf,
    /// The same cut lines as a drawing.
    Svg,
    /// Hub, base ring and post.
    Assembly,
    /// A preview of the flat and the morphed flower.
    Gltf,
}

impl FabricationKind {
    /// All kinds, in the order in which they are written.
    pub const ALL: [Self; 8] =
        [Self::Stl, Self::ThreeMf, Self::PrintStack, Self::Gcvf, Self::Dxf, Self::Svg, Self::Assembly, Self::Gltf];

    /// The word in the design file and on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Stl => "stl",
            Self::ThreeMf => "3mf",
            Self::PrintStack => "print_stack",
            Self::Gcvf => "gcvf",
            Self::Dxf => "dxf",
            Self::Svg => "svg",
            Self::Assembly => "assembly",
            Self::Gltf => "gltf",
        }
    }

    /// The kind with a name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.name() == name)
    }
}

impl fmt::Display for FabricationKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// What is made of the design.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Scope {
    /// One spoke, or the rectangular strip.
    Spoke,
    /// All spokes, laid flat around the hub.
    Flower,
}

/// Whose voxels a print stack is made of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Printer {
    /// Stratasys J750: 600 x 300 dpi, slices of 27 um.
    J750,
    /// Stratasys Objet 260 Connex: 600 x 600 dpi, slices of 16 um.
    Objet260,
    /// Any other; its pitch is given.
    #[serde(rename = "custom")]
    Custom,
}

/// What a print stack shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PrintSource {
    /// The voxels of the design, enlarged or reduced to the printer's.
    Voxels,
    /// The continuous modulus, dithered with the printer's voxels.
    Field,
}

/// How a 3MF package describes the phases.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ThreeMfGeometry {
    /// One closed mesh a phase.
    Mesh,
    /// The volumetric extension's stack of images.
    ImageStack,
}

/// How the thing is made.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FabricationInput {
    /// Kinds that are written with the design.
    pub write: Vec<FabricationKind>,
    /// One spoke or the flower.
    pub scope: Scope,
    /// Whose voxels a print stack is made of.
    pub printer: Printer,
    /// Size of a custom printer's voxel, um.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pitch_um: Option<[f64; 3]>,
    /// What a print stack shows.
    pub source: PrintSource,
    /// Width of a cut, mm.
    pub kerf_mm: f64,
    /// How a 3MF package describes the phases.
    pub three_mf_geometry: ThreeMfGeometry,
    /// What slots and seats are wider and higher than the spoke, mm.
    pub clearance_mm: f64,
    /// Thickness of walls and floors, mm.
    pub wall_mm: f64,
    /// Height of the base ring, mm; absent where it follows from the slots.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub base_height_mm: Option<f64>,
    /// How far a spoke's rim end sits in the base, mm.
    pub seat_depth_mm: f64,
    /// How far a spoke's hub end sits in the hub, mm.
    pub hub_seat_depth_mm: f64,
    /// Diameter of a held hub's post, mm.
    pub post_diameter_mm: f64,
}

/// Least and largest custom pitch, um.
const PITCH_UM: [f64; 2] = [1.0, 10_000.0];

impl FabricationInput {
    /// The defaults of the table of parameters.
    ///
    /// # Errors
    /// [`InputError`] where a default is no value of its type, which a test excludes.
    pub fn defaults() -> Result<Self, InputError> {
        serde_json::from_value(serde_json::Value::Object(defaults("fabrication")))
            .map_err(|error| InputError::new("fabrication", "", error.to_string()))
    }

    /// Rules that concern more than one key.
    ///
    /// # Errors
    /// [`InputError`] naming the keys and what would help.
    pub fn validate(&self) -> Result<(), InputError> {
        let key = "fabrication.pitch_um";
        match (self.printer, self.pitch_um) {
            (Printer::Custom, None) => Err(InputError::new(key, "", "a custom printer needs its pitch")
                .help("write pitch_um = [x, y, z] in um, or name a printer")),
            (Printer::Custom, Some(pitch)) => {
                let [least, most] = PITCH_UM;
                match pitch.iter().position(|p| !(least..=most).contains(p)) {
                    Some(i) => Err(InputError::new(
                        format!("{key}.{i}"),
                        pitch[i],
                        format!("this must be at least {least} um and at most {most} um"),
                    )),
                    None => Ok(()),
                }
            }
            (_, Some(pitch)) => Err(InputError::new(key, format!("{pitch:?}"), "a named printer has its own pitch")
                .help("remove it, or use printer = \"custom\"")),
            (_, None) => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::parameters::{Kind, parameter};

    #[test]
    fn the_table_of_parameters_and_the_types_agree() {
        let defaults = FabricationInput::defaults().unwrap();
        assert_eq!(defaults.printer, Printer::J750);
        assert!(defaults.write.is_empty() && defaults.validate().is_ok());
        let Kind::Choices { choices } = parameter("fabrication.write").unwrap().kind else { panic!() };
        assert_eq!(choices, FabricationKind::ALL.map(FabricationKind::name));
        for kind in FabricationKind::ALL {
            assert_eq!(serde_json::to_value(kind).unwrap(), kind.name());
            assert_eq!(FabricationKind::from_name(kind.name()), Some(kind));
        }
    }

    #[test]
    fn a_pitch_belongs_to_a_custom_printer_and_is_within_reason() {
        let with = |printer, pitch_um| FabricationInput { printer, pitch_um, ..FabricationInput::defaults().unwrap() };
        assert!(with(Printer::Custom, Some([50.0, 50.0, 25.0])).validate().is_ok());
        let error = with(Printer::Custom, None).validate().unwrap_err().to_string();
        assert!(error.contains("pitch_um = [x, y, z]"), "{error}");
        let error = with(Printer::Custom, Some([50.0, 0.0, 25.0])).validate().unwrap_err().to_string();
        assert!(error.contains("pitch_um.1 = 0"), "{error}");
        assert!(with(Printer::Custom, Some([50.0, f64::NAN, 25.0])).validate().is_err());
        assert!(with(Printer::J750, Some([50.0; 3])).validate().is_err());
    }
}
