//! Keys of the `[fabrication]` table.

use super::{BASE, Kind, Parameter, between, length};

/// The keys, in the order in which a design file is read.
pub(super) const FABRICATION: &[Parameter] = &[
    Parameter {
        key: "fabrication.write",
        kind: Kind::Choices { choices: &["stl", "3mf", "print_stack", "gcvf", "dxf", "svg", "assembly", "gltf"] },
        default: Some("[]"),
        description: "Which files to make the thing are written with the design; voxelastica fabricate writes them later, \
                      and all that apply where this list is empty.",
        ..BASE
    },
    Parameter {
        key: "fabrication.scope",
        kind: Kind::Choice { choices: &["spoke", "flower"] },
        default: Some("\"spoke\""),
        description: "Whether one spoke is printed or all of them, laid flat around the hub; cut patterns and previews always show \
                      all.",
        ..BASE
    },
    Parameter {
        key: "fabrication.printer",
        kind: Kind::Choice { choices: &["J750", "Objet260", "custom"] },
        default: Some("\"J750\""),
        description: "Whose voxels a print stack is made of: Stratasys J750 (600 x 300 dpi, 27 um), Objet 260 Connex \
                      (600 x 600 dpi, 16 um), or custom.",
        ..BASE
    },
    Parameter {
        key: "fabrication.pitch_um",
        kind: Kind::Numbers { least: 3, most: 3 },
        unit: Some("um"),
        description: "Size of a printer's voxel in x, y and z; for printer = \"custom\" only, and required there.",
        ..BASE
    },
    Parameter {
        key: "fabrication.source",
        kind: Kind::Choice { choices: &["voxels", "field"] },
        default: Some("\"voxels\""),
        description: "What a print stack shows: the voxels of the design, or its continuous modulus dithered anew with the \
                      printer's own voxels.",
        ..BASE
    },
    Parameter {
        key: "fabrication.kerf_mm",
        kind: between(0.0, 10.0),
        unit: Some("mm"),
        default: Some("0.0"),
        description: "Width of the cut that the laser burns away; outlines are moved outward by half of it.",
        ..BASE
    },
    Parameter {
        key: "fabrication.three_mf_geometry",
        kind: Kind::Choice { choices: &["mesh", "image-stack"] },
        default: Some("\"mesh\""),
        description: "3MF with one closed mesh a phase, or with the volumetric extension's stack of images.",
        ..BASE
    },
    Parameter {
        key: "fabrication.clearance_mm",
        kind: between(0.0, 10.0),
        unit: Some("mm"),
        default: Some("0.2"),
        description: "Assembly parts: what slots and seats are wider and higher than the spoke.",
        ..BASE
    },
    Parameter {
        key: "fabrication.wall_mm",
        kind: length(100.0),
        unit: Some("mm"),
        default: Some("2.0"),
        description: "Assembly parts: thickness of the walls around slots and seats and of the floor.",
        ..BASE
    },
    Parameter {
        key: "fabrication.base_height_mm",
        kind: length(1e4),
        unit: Some("mm"),
        description: "Assembly parts: height of the base ring; by default what the slots and the floor need.",
        ..BASE
    },
    Parameter {
        key: "fabrication.seat_depth_mm",
        kind: length(1e3),
        unit: Some("mm"),
        default: Some("5.0"),
        description: "Assembly parts: how far a spoke's rim end sits in the base, measured along the spoke.",
        ..BASE
    },
    Parameter {
        key: "fabrication.hub_seat_depth_mm",
        kind: length(1e3),
        unit: Some("mm"),
        default: Some("3.0"),
        description: "Assembly parts: how far a spoke's hub end sits in the hub, measured along the spoke.",
        ..BASE
    },
    Parameter {
        key: "fabrication.post_diameter_mm",
        kind: length(1e3),
        unit: Some("mm"),
        default: Some("6.0"),
        description: "Assembly parts: diameter of the post that holds a held hub.",
        ..BASE
    },
];
