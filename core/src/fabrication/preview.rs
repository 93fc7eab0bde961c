//! Previews: the flat and the morphed flower as binary glTF, coloured by modulus.
//!
//! Spokes and hub are closed solids of the sheet's thickness around the mid-surface; cross-sections stay straight. Positions are in
//! mm in the flower's frame; the root node turns z up into glTF's y up and millimetres into metres. Colours are linear, as
//! glTF wants them.

use std::borrow::Cow;

use gltf::binary::{Glb, Header};
use serde_json::{Value, json};

use super::{Estimate, FOLDER, FabricationError, Job, Made, Maker};
use crate::design::Design;
use crate::error::Error;
use crate::flower::Flower;
use crate::input::FabricationKind;
use crate::output::Provenance;
use crate::output::folder::{Staging, WriteFailure};
use crate::progress::Progress;
use crate::report::{HUB_COLOUR, modulus_colour};
use crate::surface::Strip;

/// Quads along and across a spoke, and the same where there are so many spokes that files would grow large.
const QUADS: [usize; 2] = [96, 8];
const COARSE: [usize; 2] = [48, 2];
/// Spokes above which they are coarse.
const MANY: usize = 64;

/// Triangles with a colour at every vertex.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Solid {
    /// Vertices, mm.
    pub positions: Vec<[f32; 3]>,
    /// Linear colours and opacity.
    pub colours: Vec<[u8; 4]>,
    /// Counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

/// Spokes and hub (empty for a rectangular strip) at a fraction of the morph.
///
/// # Errors
/// [`Error::Infeasible`] where the path of the morph could not be followed.
pub fn solids(design: &Design, fraction: f64) -> Result<[Solid; 2], Error> {
    let infeasible = |error| Error::infeasible(&design.input().name, error);
    let thickness = design.input().strips.thickness_mm;
    let [along, across] = if design.input().count() > MANY { COARSE } else { QUADS };
    let flower = Flower::new(design, Strip::Graded, along, across);
    let mut positions = vec![[0.0_f64; 3]; flower.vertices()];
    let mut normals = positions.clone();
    flower.fill(design, fraction, &mut positions, Some(&mut normals)).map_err(infeasible)?;
    let side = |sign: f64| {
        let half = 0.5 * sign * thickness;
        positions.iter().zip(&normals).map(move |(p, n)| std::array::from_fn(|k| (p[k] + half * n[k]) as f32))
    };
    let mut spokes = Solid { positions: side(1.0).chain(side(-1.0)).collect(), ..Solid::default() };
    let range = flower.modulus_mpa().iter().fold([f64::INFINITY, 0.0_f64], |[l, h], e| [l.min(*e), h.max(*e)]);
    let share =
        |e: &f64| if range[1] - range[0] > 1e-6 * range[1] { (e - range[0]) / (range[1] - range[0]) } else { 0.5 };
    let colour = |e: &f64| linear(modulus_colour(share(e)));
    spokes.colours = flower.modulus_mpa().iter().chain(flower.modulus_mpa()).map(colour).collect();
    let below = flower.vertices() as u32;
    let mut quad = |[a, b, c, d]: [u32; 4]| spokes.triangles.extend([[a, b, c], [a, c, d]]);
    for [a, b, c, d] in flower.quads() {
        quad([a, b, c, d]);
        quad([d + below, c + below, b + below, a + below]);
    }
    let row = across as u32 + 1;
    let one = (along as u32 + 1) * row;
    for first in (0..flower.spokes() as u32).map(|spoke| spoke * one) {
        let last = first + along as u32 * row;
        // Around the spoke in the order of its quads, so that every edge is met once in each direction.
        let rim = (0..across as u32).map(|j| [first + j, first + j + 1]);
        let left = (0..along as u32).map(|i| [first + i * row + row - 1, first + (i + 2) * row - 1]);
        let hub = (0..across as u32).rev().map(|j| [last + j + 1, last + j]);
        let right = (0..along as u32).rev().map(|i| [first + (i + 1) * row, first + i * row]);
        for [from, to] in rim.chain(left).chain(hub).chain(right) {
            quad([to, from, from + below, to + below]);
        }
    }
    let polygon = design.hub_polygon(Strip::Graded, fraction).map_err(infeasible)?;
    Ok([spokes, plate(&polygon, thickness)])
}

/// A plate around a polygon that is counter-clockwise seen from above.
fn plate(polygon: &[[f64; 3]], thickness: f64) -> Solid {
    let mut solid = Solid::default();
    let Some(z) = polygon.first().map(|p| p[2]) else { return solid };
    let n = polygon.len() as u32;
    for half in [0.5 * thickness, -0.5 * thickness] {
        solid.positions.extend(polygon.iter().map(|p| [p[0] as f32, p[1] as f32, (z + half) as f32]));
        solid.positions.push([0.0, 0.0, (z + half) as f32]);
    }
    for i in 0..n {
        let (a, b, below) = (i, (i + 1) % n, n + 1);
        solid.triangles.extend([
            [n, a, b],
            [n + below, b + below, a + below],
            [a, a + below, b + below],
            [a, b + below, b],
        ]);
    }
    solid.colours = vec![linear(HUB_COLOUR); solid.positions.len()];
    solid
}

/// From sRGB to the linear colours of glTF.
fn linear(colour: [u8; 3]) -> [u8; 4] {
    let [r, g, b] = colour.map(|c| {
        let c = f64::from(c) / 255.0;
        let linear = if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) };
        (255.0 * linear).round() as u8
    });
    [r, g, b, 255]
}

/// A binary glTF file of named solids; empty ones are left out.
///
/// # Errors
/// [`Error::Internal`] where the container cannot be written.
pub fn glb(solids: &[(&str, Solid)], provenance: &Provenance) -> Result<Vec<u8>, Error> {
    let (mut bin, mut views, mut accessors) = (Vec::new(), Vec::<Value>::new(), Vec::<Value>::new());
    let (mut meshes, mut nodes) = (Vec::<Value>::new(), Vec::<Value>::new());
    for (name, solid) in solids.iter().filter(|(_, solid)| !solid.triangles.is_empty()) {
        let mut view = |bytes: Vec<u8>, target: u32| {
            views.push(json!({ "buffer": 0, "byteOffset": bin.len(), "byteLength": bytes.len(), "target": target }));
            bin.extend(bytes);
            views.len() - 1
        };
        let bound = |f: fn(f32, f32) -> f32, start: f32| {
            let fold = |k: usize| solid.positions.iter().map(|p| p[k]).fold(start, f);
            [fold(0), fold(1), fold(2)]
        };
        let positions = view(solid.positions.iter().flatten().flat_map(|c| c.to_le_bytes()).collect(), ARRAY_BUFFER);
        let colours = view(solid.colours.iter().flatten().copied().collect(), ARRAY_BUFFER);
        let indices = view(solid.triangles.iter().flatten().flat_map(|i| i.to_le_bytes()).collect(), ELEMENT_BUFFER);
        let first = accessors.len();
        accessors.extend([
            json!({ "bufferView": positions, "componentType": FLOAT, "count": solid.positions.len(), "type": "VEC3",
                    "min": bound(f32::min, f32::INFINITY), "max": bound(f32::max, f32::NEG_INFINITY) }),
            json!({ "bufferView": colours, "componentType": UNSIGNED_BYTE, "normalized": true,
                    "count": solid.colours.len(), "type": "VEC4" }),
            json!({ "bufferView": indices, "componentType": UNSIGNED_INT, "count": 3 * solid.triangles.len(),
                    "type": "SCALAR" }),
        ]);
        meshes.push(json!({ "name": name, "primitives": [{
            "attributes": { "POSITION": first, "COLOR_0": first + 1 }, "indices": first + 2, "material": 0
        }] }));
        nodes.push(json!({ "name": name, "mesh": meshes.len() - 1 }));
    }
    let children: Vec<usize> = (0..nodes.len()).collect();
    let scale = 1e-3;
    nodes.push(json!({ "name": "flower", "children": children, "matrix":
        [scale, 0.0, 0.0, 0.0, 0.0, 0.0, -scale, 0.0, 0.0, scale, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0] }));
    let root = json!({
        "asset": { "version": "2.0", "generator": provenance.line() },
        "scene": 0,
        "scenes": [{ "nodes": [nodes.len() - 1] }],
        "nodes": nodes,
        "meshes": meshes,
        "materials": [{ "name": "modulus", "pbrMetallicRoughness": { "metallicFactor": 0.0, "roughnessFactor": 0.7 } }],
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{ "byteLength": bin.len() }],
    });
    let container = Glb {
        header: Header { magic: *b"glTF", version: 2, length: 0 },
        json: Cow::Owned(root.to_string().into_bytes()),
        bin: Some(Cow::Owned(bin)),
    };
    container.to_vec().map_err(|e| Error::Internal(format!("glTF: {e}")))
}

const ARRAY_BUFFER: u32 = 34_962;
const ELEMENT_BUFFER: u32 = 34_963;
const FLOAT: u32 = 5126;
const UNSIGNED_BYTE: u32 = 5121;
const UNSIGNED_INT: u32 = 5125;

/// Writes `fabrication/flat.glb` and, for what morphs, `fabrication/morphed.glb`.
pub struct Preview;

impl Maker for Preview {
    fn kind(&self) -> FabricationKind {
        FabricationKind::Gltf
    }

    fn plan(&self, job: &Job<'_>) -> Result<Estimate, FabricationError> {
        let count = job.design.input().count();
        let [along, across] = if count > MANY { COARSE } else { QUADS };
        let vertices = 2 * count * (along + 1) * (across + 1);
        // 16 bytes a vertex, and two triangles of 12 bytes for each.
        Ok(Estimate { voxels: 0, bytes: 2 * 41 * vertices as u64 + 8192 })
    }

    fn write(&self, job: &Job<'_>, staging: &mut Staging, progress: Progress<'_>) -> Result<Made, Error> {
        let mut made = Made::default();
        let states: &[(&str, f64)] =
            if job.design.guide().is_some() { &[("flat", 0.0), ("morphed", 1.0)] } else { &[("flat", 0.0)] };
        let mut done = 0;
        for (name, fraction) in states {
            let [spokes, hub] = solids(job.design, *fraction)?;
            let triangles = spokes.triangles.len() + hub.triangles.len();
            let bytes = glb(&[("spokes", spokes), ("hub", hub)], job.provenance)?;
            let path = format!("{FOLDER}/{name}.glb");
            staging.write(&path, |out| out.write_all(&bytes).map_err(WriteFailure::from))?;
            done += bytes.len() as u64;
            if !progress(done) {
                return Err(Error::Cancelled);
            }
            made.listed.push((path.clone(), format!("the {name} state, {triangles} triangles")));
            made.details.insert(format!("{name}_triangles"), json!(triangles));
            made.files.push(path);
        }
        Ok(made)
    }
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;
    use std::path::Path;

    use super::*;
    use crate::input::files::Format;
    use crate::{DesignInput, Limits};

    #[test]
    fn solids_are_closed_and_have_the_designs_volume_and_the_file_is_read_back() {
        for (text, morphs) in [
            (include_str!("../../../examples/hemisphere.toml"), true),
            (include_str!("../../../examples/rectangular_2.toml"), true),
            (include_str!("../../../examples/coupon_1.toml"), false),
        ] {
            let input = DesignInput::from_text(text, Format::Toml, "test", "test", Path::new("")).unwrap();
            let design = Design::compute(&input, Limits::default()).unwrap();
            assert_eq!(design.guide().is_some(), morphs);
            let volumes = crate::output::Summary::of(&design).volume_mm3;
            for fraction in [0.0, 1.0] {
                let [spokes, hub] = solids(&design, fraction).unwrap();
                let expected = [volumes.spoke_smooth * input.count() as f64, volumes.hub];
                for (solid, expected) in [&spokes, &hub].into_iter().zip(expected) {
                    let edges: HashSet<(u32, u32)> =
                        solid.triangles.iter().flat_map(|[a, b, c]| [(*a, *b), (*b, *c), (*c, *a)]).collect();
                    assert_eq!(edges.len(), 3 * solid.triangles.len());
                    assert!(edges.iter().all(|(a, b)| edges.contains(&(*b, *a))));
                    let at = |i: &u32| solid.positions[*i as usize].map(f64::from);
                    let volume: f64 = solid
                        .triangles
                        .iter()
                        .map(|[a, b, c]| {
                            let (a, b, c) = (at(a), at(b), at(c));
                            (a[0] * (b[1] * c[2] - b[2] * c[1])
                                + a[1] * (b[2] * c[0] - b[0] * c[2])
                                + a[2] * (b[0] * c[1] - b[1] * c[0]))
                                / 6.0
                        })
                        .sum();
                    assert!((volume - expected).abs() <= 2e-3 * expected, "{volume} {expected}");
                }
                let provenance = Provenance::of(&input);
                let triangles = spokes.triangles.len();
                let bytes = glb(&[("spokes", spokes), ("hub", hub)], &provenance).unwrap();
                let read = gltf::Gltf::from_slice(&bytes).unwrap();
                let blob = read.blob.as_deref().unwrap();
                let mesh = read.meshes().next().unwrap();
                let primitive = mesh.primitives().next().unwrap();
                let reader = primitive.reader(|_| Some(blob));
                assert_eq!(reader.read_indices().unwrap().into_u32().count(), 3 * triangles);
                assert_eq!(
                    reader.read_positions().unwrap().count(),
                    reader.read_colors(0).unwrap().into_rgba_u8().count()
                );
            }
        }
    }
}
