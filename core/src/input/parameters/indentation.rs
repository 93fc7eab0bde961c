//! Keys of the table `indentation`.

use super::{BASE, DOMES, Kind, Parameter, between, length};

/// Rectangular strips are no domes.
const DOME: Parameter = Parameter { targets: DOMES, ..BASE };

/// A dome under load.
pub(super) const INDENTATION: &[Parameter] = &[
    Parameter {
        key: "indentation.depth_mm",
        kind: length(1e5),
        unit: Some("mm"),
        description: "How far the hub is pressed down; by default a tenth of the spoke's length.",
        ..DOME
    },
    Parameter {
        key: "indentation.steps",
        kind: Kind::Integer { least: 4, most: 1000 },
        default: Some("40"),
        description: "Steps of the force-displacement curve.",
        ..DOME
    },
    Parameter {
        key: "indentation.indenter",
        kind: Kind::Choice { choices: &["flat", "hub"] },
        default: Some("\"flat\""),
        description: "What presses: a flat rigid plate that moves with the hub and may touch the spokes, or nothing but the hub.",
        ..DOME
    },
    Parameter {
        key: "indentation.indenter_diameter_mm",
        kind: length(1e5),
        unit: Some("mm"),
        description: "Diameter of the flat indenter; by default 0.339 of the dome's (50 mm on the hemisphere of 100 mm spokes).",
        ..DOME
    },
    Parameter {
        key: "indentation.bending",
        kind: Kind::Choice { choices: &["beam", "plane-strain"] },
        default: Some("\"beam\""),
        description: "How the elastica bends: with E (narrow strips) or E/(1 - nu^2) (wide ones). Real strips lie between.",
        ..DOME
    },
    Parameter {
        key: "indentation.modulus_band_percent",
        kind: between(0.0, 90.0),
        unit: Some("%"),
        default: Some("10.0"),
        description: "Share by which all moduli may be off: the force's band.",
        ..DOME
    },
];
