//! A pattern as DXF (AutoCAD 2000), in millimetres.

use std::io;

use dxf::entities::{Entity, EntityType, Line, LwPolyline, Text};
use dxf::enums::{AcadVersion, HorizontalTextJustification, Units, VerticalTextJustification};
use dxf::tables::Layer as LayerEntry;
use dxf::{Color, Drawing, DxfError, LwPolylineVertex, Point as Point3};

use super::polygon::Point;
use super::{Layer, Pattern};
use crate::output::Provenance;
use crate::output::folder::Destination;

/// Writes the drawing.
///
/// # Errors
/// What the writer returns.
pub(super) fn write(pattern: &Pattern, provenance: &Provenance, mut out: &mut dyn Destination) -> io::Result<()> {
    let mut drawing = Drawing::new();
    drawing.header.version = AcadVersion::R2000;
    drawing.header.default_drawing_units = Units::Millimeters;
    let [low, high] = pattern.bounds();
    drawing.header.minimum_drawing_extents = point(low);
    drawing.header.maximum_drawing_extents = point(high);
    drawing.header.project_name = provenance.line();
    forget_time(&mut drawing);
    for layer in Layer::ALL {
        let colour = match layer {
            Layer::Outline => 1,
            Layer::Hub => 6,
            Layer::Marks => 5,
            Layer::Labels => 3,
        };
        let name = layer.name().to_owned();
        drawing.add_layer(LayerEntry { name, color: Color::from_index(colour), ..LayerEntry::default() });
    }
    let mut add = |layer: Layer, shape: EntityType| {
        let mut entity = Entity::new(shape);
        layer.name().clone_into(&mut entity.common.layer);
        drawing.add_entity(entity);
    };
    for (layer, part) in &pattern.parts {
        let vertices = part.iter().map(|[x, y]| LwPolylineVertex { x: *x, y: *y, ..LwPolylineVertex::default() });
        let mut polyline = LwPolyline { vertices: vertices.collect(), ..LwPolyline::default() };
        polyline.set_is_closed(true);
        add(*layer, EntityType::LwPolyline(polyline));
    }
    let line = |[from, to]: &[Point; 2]| EntityType::Line(Line::new(point(*from), point(*to)));
    pattern.slits.iter().for_each(|slit| add(Layer::Outline, line(slit)));
    pattern.marks.iter().for_each(|mark| add(Layer::Marks, line(mark)));
    for label in &pattern.labels {
        let text = Text {
            location: point(label.at),
            second_alignment_point: point(label.at),
            text_height: label.height,
            rotation: label.turn_deg,
            value: label.text.clone(),
            horizontal_text_justification: HorizontalTextJustification::Center,
            vertical_text_justification: VerticalTextJustification::Middle,
            ..Text::default()
        };
        add(Layer::Labels, EntityType::Text(text));
    }
    drawing.save(&mut out).map_err(|error| match error {
        DxfError::IoError(error) => error,
        other => io::Error::other(other.to_string()),
    })
}

fn point([x, y]: Point) -> Point3 {
    Point3::new(x, y, 0.0)
}

/// Takes out what would differ from run to run and from place to place: dates and random identifiers.
fn forget_time(drawing: &mut Drawing) {
    let header = &mut drawing.header;
    header.creation_date_universal = Default::default();
    header.update_date_universal = Default::default();
    header.creation_date = Default::default();
    header.update_date = Default::default();
    // Local dates are written in local time: move them so that it is the same everywhere.
    for date in [&mut header.creation_date, &mut header.update_date] {
        let east = date.naive_local() - date.naive_utc();
        *date -= east;
    }
    header.fingerprint_guid = Default::default();
    header.version_guid = Default::default();
}
