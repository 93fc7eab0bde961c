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
        description: "Share by which all moduli may be off: the force's band; by default the scatter of the phases where every \
                      one has modulus_scatter_percent, else 10.",
        ..DOME
    },
    Parameter {
        key: "indentation.contact_stiffness_n_mm3",
        kind: between(1e-3, 1e9),
        unit: Some("N/mm^3"),
        default: Some("50.0"),
        description: "Decks: pressure between indenter and spokes over their penetration (CalculiX, ABAQUS/Standard).",
        ..DOME
    },
    Parameter {
        key: "indentation.loading_rate_per_s",
        kind: between(1e-6, 1e6),
        unit: Some("1/s"),
        default: Some("0.1"),
        description: "Deck of ABAQUS/Explicit: travel over length or height a second; sets the time of its steps.",
        ..DOME
    },
    Parameter {
        key: "indentation.mass_scaling",
        kind: between(1.0, 1e8),
        default: Some("1.0"),
        description: "Deck of ABAQUS/Explicit: factor on all masses; increments grow with its root. One is the real mass.",
        ..DOME
    },
];
