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
        key: "indentation.neighbours",
        kind: Kind::Choice { choices: &["touch", "ignore"] },
        default: Some("\"touch\""),
        description: "Whether neighbouring spokes touch, in finite elements: planes of symmetry stand in the way of a spoke's sides.",
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
    Parameter {
        key: "indentation.graded_elements",
        kind: Kind::Integers { count: 3, least: 1, most: 2000 },
        default: Some("[60, 6, 2]"),
        description: "Elements of the graded strip along, across and through.",
        ..DOME
    },
    Parameter {
        key: "indentation.contact_stiffness_n_mm3",
        kind: length(1e9),
        unit: Some("N/mm^3"),
        default: Some("50.0"),
        description: "Pressure a millimetre of overclosure between indenter and spoke, in decks.",
        ..DOME
    },
    Parameter {
        key: "indentation.loading_rate_per_s",
        kind: length(1e6),
        unit: Some("1/s"),
        default: Some("0.1"),
        description: "Depth over the dome's height and time: the duration of the explicit deck's step.",
        ..DOME
    },
    Parameter {
        key: "indentation.mass_scaling",
        kind: Kind::Number { least: 1.0, exclusive: false, most: 1e12 },
        description: "Factor on the density in the explicit deck; without it mass is not scaled.",
        ..DOME
    },
];
