use std::collections::HashMap;
use std::io::{Cursor, Read};

use quick_xml::Reader;
use quick_xml::events::Event;

use super::*;
use crate::fabrication::solid::{Mesh, PhaseSolid};
use crate::fabrication::voxel_surface::VoxelSurface;
use crate::progress;
use crate::voxel::VoxelGrid;

fn grid() -> VoxelGrid {
    let mut grid = VoxelGrid::new(0.5, 2, vec![2, 1, 2, 2]);
    grid.slice_mut(1).copy_from_slice(&[0, 1, 1, 0]);
    grid.slice_mut(3).copy_from_slice(&[1, 1, 0, 1, 1, 0, 0, 1]);
    grid
}

fn provenance() -> Provenance {
    Provenance { version: "1.2.3".to_owned(), seed: 7, design_sha256: "a".repeat(64) }
}

fn materials() -> Vec<BaseMaterial> {
    ["soft & <light>", "stiff"].map(|n| BaseMaterial { name: n.to_owned(), colour: "#102030".to_owned() }).to_vec()
}

fn parts(bytes: &[u8]) -> HashMap<String, Vec<u8>> {
    let mut archive = zip::ZipArchive::new(Cursor::new(bytes)).unwrap();
    (0..archive.len())
        .map(|i| {
            let mut file = archive.by_index(i).unwrap();
            assert_eq!(file.last_modified(), Some(zip::DateTime::DEFAULT));
            let mut contents = Vec::new();
            file.read_to_end(&mut contents).unwrap();
            (file.name().unwrap().into_owned(), contents)
        })
        .collect()
}

/// Elements in order, with their attributes.
fn elements(xml: &[u8]) -> Vec<(String, HashMap<String, String>)> {
    let mut reader = Reader::from_reader(xml);
    let (mut found, mut buffer) = (Vec::new(), Vec::new());
    loop {
        match reader.read_event_into(&mut buffer).unwrap() {
            Event::Eof => return found,
            Event::Start(e) | Event::Empty(e) => {
                let attributes = e.attributes().map(|a| {
                    let a = a.unwrap();
                    let value = a.normalized_value(quick_xml::XmlVersion::Implicit1_0).unwrap().into_owned();
                    (a.key.as_ref().to_owned(), value)
                });
                found.push((e.name().as_ref().to_owned(), attributes.collect()));
            }
            _ => {}
        }
        buffer.clear();
    }
}

#[test]
fn a_package_holds_each_phase_once_and_places_it() {
    let grid = grid();
    let surface = VoxelSurface::new(&grid, 100.0).unwrap();
    let solids = [0, 1].map(|phase| PhaseSolid { surface, phase, mirrored: false });
    let quarter = Placement { cosine: 0.0, sine: 1.0, shift: [1.0, 2.0, 0.0] };
    let provenance = provenance();
    let object =
        |k: usize| Object { name: format!("phase {k}"), shape: Shape::Solid { solid: &solids[k], material: k } };
    let spoke = Object {
        name: "spoke".to_owned(),
        shape: Shape::Components(vec![(0, Placement::IDENTITY), (1, Placement::IDENTITY)]),
    };
    let document = Document {
        title: "a \"title\"".to_owned(),
        description: "a test".to_owned(),
        provenance: &provenance,
        materials: materials(),
        objects: vec![object(0), object(1), spoke],
        items: vec![(2, Placement::IDENTITY), (2, quarter)],
    };
    let written = || {
        let mut file = Cursor::new(Vec::new());
        document.write(&mut file, &progress::never).unwrap();
        file.into_inner()
    };
    let bytes = written();
    assert_eq!(bytes, written());
    let parts = parts(&bytes);
    let found = elements(&parts["3D/3dmodel.model"]);
    let all = |name: &str| found.iter().filter(|e| e.0 == name).map(|e| e.1.clone()).collect::<Vec<_>>();
    let triangles: u64 = solids.iter().map(|s| s.count(&progress::never).unwrap()).sum();
    assert_eq!(all("triangle").len() as u64, triangles);
    assert_eq!(all("vertex").len() as u64, surface.measure(0).vertices + surface.measure(1).vertices);
    assert_eq!(all("base")[0]["name"], "soft & <light>");
    assert_eq!(all("item")[1]["transform"], "0 1 0 -1 0 0 0 0 1 1 2 0");
    assert_eq!(all("item")[0].get("transform"), None);
    assert_eq!(all("component").len(), 2);
    let objects = all("object");
    assert_eq!((objects.len(), objects[1]["pindex"].as_str()), (3, "1"));
    assert_eq!(all("component")[1]["objectid"], objects[1]["id"]);
    assert!(parts.contains_key("[Content_Types].xml") && parts.contains_key("_rels/.rels"));
}

fn image(png: &[u8]) -> Vec<u8> {
    let mut reader = png::Decoder::new(Cursor::new(png)).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut pixels).unwrap();
    pixels
}

#[test]
fn images_show_the_phases_the_right_way_up() {
    let grid = grid();
    let images = volumetric::PhaseImages::of(&grid, "phases").unwrap();
    assert_eq!((images.files.len(), images.pixels), (2, [4, 4]));
    for (layer, (_, png)) in images.files.iter().enumerate() {
        let pixels = image(png);
        for slice in 0..4 {
            let own = grid.half_widths()[slice];
            for across in 0..2 * own {
                // Row 0 is the largest y.
                let row = 3 - (across + 2 - own);
                let pixel = &pixels[3 * (4 * row + slice)..][..3];
                let phase = usize::from(grid.slice(slice)[layer * 2 * own + across]);
                assert!((0..3).all(|c| (pixel[c] == 255) == (c == phase)), "{layer} {slice} {across}");
            }
        }
    }
    let mirrored = volumetric::PhaseImages::of_mirror_image(&grid, "phases").unwrap();
    for (one, other) in images.files.iter().zip(&mirrored.files) {
        let upside_down: Vec<u8> = image(&one.1).rchunks(12).flatten().copied().collect();
        assert_eq!(upside_down, image(&other.1));
    }
    let whole = Mesh { vertices: vec![[0.0; 3]; 3], triangles: vec![[0, 1, 2]] };
    let provenance = provenance();
    let document = Document {
        title: "strip".to_owned(),
        description: "a test".to_owned(),
        provenance: &provenance,
        materials: materials(),
        objects: vec![Object { name: "strip".to_owned(), shape: Shape::Imaged { solid: &whole, images: &images } }],
        items: vec![(0, Placement::IDENTITY)],
    };
    let mut file = Cursor::new(Vec::new());
    document.write(&mut file, &progress::never).unwrap();
    let parts = parts(file.get_ref());
    let found = elements(&parts["3D/3dmodel.model"]);
    let one = |name: &str| found.iter().find(|e| e.0 == name).unwrap().1.clone();
    assert_eq!(one("v:imagestack")["sheetcount"], "2");
    assert_eq!(one("v:materialmapping")["transform"], "0.5 0 0 0 0.5 0 0 0 1 0 0.5 0.5");
    assert_eq!(one("mesh")["v:volumeid"], one("v:volumedata")["id"]);
    assert_eq!(parts["3D/volumetric/phases/layer0002.png"], images.files[1].1);
    assert_eq!(elements(&parts["3D/_rels/3dmodel.model.rels"]).len(), 3);
}
