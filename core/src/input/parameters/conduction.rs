//! Keys of the table `conduction`.

use super::{BASE, Kind, Parameter, between, length};

/// Heat and current through the strip.
pub(super) const CONDUCTION: &[Parameter] = &[
    Parameter {
        key: "conduction.rim_temperature_k",
        kind: length(1e5),
        unit: Some("K"),
        default: Some("393.15"),
        description: "Temperature that the rim is brought to at the start and kept at.",
        ..BASE
    },
    Parameter {
        key: "conduction.start_temperature_k",
        kind: length(1e5),
        unit: Some("K"),
        default: Some("316.15"),
        description: "Temperature everywhere else at the start; in the steady state that of the far end.",
        ..BASE
    },
    Parameter {
        key: "conduction.current_a",
        kind: length(1e9),
        unit: Some("A"),
        default: Some("1.0"),
        description: "Current that enters at the rim; the far end is grounded.",
        ..BASE
    },
    Parameter {
        key: "conduction.electrode",
        kind: Kind::Choice { choices: &["equipotential", "uniform"] },
        default: Some("\"equipotential\""),
        description: "How the current enters: through a metal contact of one potential, or with the same density all over the \
                      cross-section at the rim.",
        ..BASE
    },
    Parameter {
        key: "conduction.heat_times_s",
        kind: Kind::Numbers { least: 0, most: 100 },
        unit: Some("s"),
        default: Some("[100.0, 1000.0, 2000.0]"),
        description: "Times of the temperature fields that are drawn.",
        ..BASE
    },
    Parameter {
        key: "conduction.current_times_s",
        kind: Kind::Numbers { least: 0, most: 100 },
        unit: Some("s"),
        default: Some("[0.0001, 0.001, 0.002]"),
        description: "Times of the potential fields that are drawn.",
        ..BASE
    },
    Parameter {
        key: "conduction.measure_at",
        kind: Kind::Numbers { least: 1, most: 20 },
        default: Some("[0.5, 1.0]"),
        description: "Measuring points on the mid-line as shares of the length from the rim; the last one gives the effective \
                      conductivity by time.",
        ..BASE
    },
    Parameter {
        key: "conduction.threshold",
        kind: between(0.01, 0.999_999),
        default: Some("0.999"),
        description: "The critical time is when a measuring point gets to this share of the final temperature.",
        ..BASE
    },
    Parameter {
        key: "conduction.threshold_of",
        kind: Kind::Choice { choices: &["rise", "value"] },
        default: Some("\"rise\""),
        description: "Whether that share is of the rise from the start, or of the absolute temperature.",
        ..BASE
    },
    Parameter {
        key: "conduction.plateau",
        kind: between(1e-6, 0.5),
        default: Some("0.001"),
        description: "The potential is on its plateau when it is this share off the steady one.",
        ..BASE
    },
    Parameter {
        key: "conduction.time_tolerance",
        kind: between(1e-8, 1e-2),
        default: Some("2e-6"),
        description: "Largest error of a time step, as a share of the rise.",
        ..BASE
    },
    Parameter {
        key: "conduction.graded_elements",
        kind: Kind::Integers { count: 3, least: 1, most: 2000 },
        default: Some("[160, 24, 4]"),
        description: "Elements along, across and through a spoke of the graded model.",
        ..BASE
    },
];
