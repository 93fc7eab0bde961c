//! The meshes of the solids as NASTRAN bulk data, for programs that read nothing else, such as COMSOL.
//!
//! Coordinates and material constants are written in the long fixed format (16 columns a field), elements in the short one
//! (8 columns). Property and material numbers tell the phases apart: number `i` is the phase `i` of the voxel mesh, or the
//! slice `i` of the graded one. There are no loads; boundary conditions belong to the program that reads the mesh.

use std::ops::Range;

use super::sink::{Rows, Sink};
use super::{Deck, DeckError, graded_solid, voxel_solid};
use crate::design::Design;
use crate::input::model::DeckSolver;
use crate::mesh::Block;
use crate::micromechanics::PhaseSet;
use crate::output::Provenance;

use super::keywords::heading::ascii;
use super::keywords::materials::{Mixture, mixtures};

/// Longest comment line.
const WIDTH: usize = 78;

/// Which property an element has.
enum Properties {
    /// That of its voxel's phase; so many elements lie along a voxel's edge.
    Phase(usize),
    /// That of its slice.
    Slice,
}

/// The mesh.
pub(super) struct NastranMesh<'a> {
    design: &'a Design,
    block: Block,
    properties: Properties,
    /// Name and constants of every property, from number one.
    materials: Vec<(String, Mixture)>,
}

impl<'a> NastranMesh<'a> {
    /// Every voxel its phase.
    pub(super) fn voxels(design: &'a Design) -> Self {
        let (block, per_edge, _) = voxel_solid::block(design, DeckSolver::Nastran);
        let phases = design.phases().phases();
        let constants = |m: &crate::materials::Material| Mixture {
            modulus: m.modulus_mpa,
            poisson: m.poisson,
            density: m.density_tonne_mm3(),
        };
        let materials = phases.iter().map(|m| (m.name.clone(), constants(m))).collect();
        Self { design, block, properties: Properties::Phase(per_edge), materials }
    }

    /// The smooth spoke, one mixture a slice.
    pub(super) fn graded(design: &'a Design) -> Self {
        let (block, moduli) = graded_solid::block(design, DeckSolver::Nastran);
        let material = |(i, ends): (usize, &[f64])| {
            let modulus = 0.5 * (ends[0] + ends[1]);
            (format!("slice {}", i + 1), mixture(design.phases(), modulus))
        };
        let materials = moduli.windows(2).enumerate().map(material).collect();
        Self { design, block, properties: Properties::Slice, materials }
    }

    fn comments(&self, provenance: &Provenance) -> Vec<String> {
        let model = match self.properties {
            Properties::Phase(n) => {
                format!("one spoke of voxels of {} mm, {n} x {n} x {n} bricks each", self.design.grid().size_mm())
            }
            Properties::Slice => "one spoke with its smooth outline, a material a slice".to_owned(),
        };
        let mut text = vec![
            provenance.line(),
            format!("Design: {}", self.design.input().name),
            "Units: mm, N, MPa, tonne, s".to_owned(),
            format!("Model: {model}."),
            format!(
                "Frame: the strip lies along x, rim at x = 0, hub at x = {}, mid-plane z = 0, y across.",
                self.design.input().strips.length_mm
            ),
            "Property i has material i. fractions.csv has the fractions of the phases along x.".to_owned(),
        ];
        if matches!(self.properties, Properties::Phase(_)) {
            text.extend(self.materials.iter().enumerate().map(|(i, (name, _))| format!("Property {}: {name}", i + 1)));
        }
        text
    }

    /// Number of the property of an element.
    fn property(&self, slice: usize, layer: usize, across: usize) -> usize {
        match self.properties {
            Properties::Slice => slice + 1,
            Properties::Phase(n) => {
                let voxels = self.design.grid().slice(slice / n);
                let width = self.block.slice_across(slice) / n;
                usize::from(voxels[layer / n * width + across / n]) + 1
            }
        }
    }
}

/// Constants of a mixture by the rows between which they are linear in the modulus.
fn mixture(phases: &PhaseSet, modulus: f64) -> Mixture {
    let rows = mixtures(phases);
    let at = rows.partition_point(|row| row.modulus < modulus).clamp(1, rows.len() - 1);
    let (a, b) = (rows[at - 1], rows[at]);
    let share = ((modulus - a.modulus) / (b.modulus - a.modulus)).clamp(0.0, 1.0);
    let between = |a: f64, b: f64| a + share * (b - a);
    Mixture {
        modulus,
        poisson: between(a.poisson, b.poisson),
        density: a.density.zip(b.density).map(|(a, b)| between(a, b)),
    }
}

impl Deck for NastranMesh<'_> {
    fn nodes(&self) -> u64 {
        self.block.nodes()
    }

    fn elements(&self) -> u64 {
        self.block.elements()
    }

    fn midline(&self) -> Option<Vec<[f64; 3]>> {
        Some(self.block.midline())
    }

    fn write(&self, provenance: &Provenance, sink: &mut Sink<'_>) -> Result<(), DeckError> {
        for paragraph in self.comments(provenance) {
            comment(sink, &paragraph)?;
        }
        sink.line("BEGIN BULK")?;
        for (i, (_, constants)) in self.materials.iter().enumerate() {
            let id = i + 1;
            sink.line(&format!("{:<8}{id:>8}{id:>8}", "PSOLID"))?;
            let density = constants.density.map_or_else(String::new, long);
            sink.line(&format!(
                "{:<8}{id:>16}{:>16}{:>16}{:>16}*",
                "MAT1*",
                long(constants.modulus),
                "",
                long(constants.poisson)
            ))?;
            sink.line(format!("{:<8}{density:>16}", "*").trim_end())?;
        }
        sink.rows(&Grids { block: &self.block })?;
        sink.rows(&Bricks { mesh: self })?;
        sink.line("ENDDATA")
    }
}

/// A comment, wrapped between words.
fn comment(sink: &mut Sink<'_>, text: &str) -> Result<(), DeckError> {
    let mut line = String::from("$");
    for word in ascii(text).split_whitespace() {
        if line.len() > 1 && line.len() + 1 + word.len() > WIDTH {
            sink.line(&line)?;
            line.truncate(1);
        }
        line.push(' ');
        line.push_str(word);
        line.truncate(200);
    }
    sink.line(&line)
}

/// A real number in at most 16 columns: it must have a point or an exponent.
fn long(value: f64) -> String {
    let rounded: f64 = format!("{value:.8e}").parse().unwrap_or(value);
    let plain = format!("{rounded:?}");
    if plain.len() <= 16 && !plain.contains('e') { plain } else { format!("{rounded:.8E}") }
}

/// `GRID*`; one row is one level of one plane.
struct Grids<'a> {
    block: &'a Block,
}

impl Rows for Grids<'_> {
    fn rows(&self) -> usize {
        self.block.planes() * self.group()
    }

    fn group(&self) -> usize {
        self.block.layers() + 1
    }

    fn weight(&self, row: usize) -> usize {
        2 * (self.block.plane_across(row / self.group()) + 1)
    }

    fn render(&self, rows: Range<usize>, out: &mut Vec<u8>) {
        let levels = self.group();
        for row in rows {
            let (plane, level) = (row / levels, row % levels);
            let across = self.block.plane_across(plane);
            let first = self.block.row_start(plane, level, across);
            let (x, z) = (long(self.block.x(plane)), long(self.block.z(plane, level)));
            for index in 0..=across {
                let id = first + index as u64;
                let y = long(self.block.y(plane, index));
                out.extend_from_slice(
                    format!("{:<8}{id:>16}{:>16}{x:>16}{y:>16}*\n{:<8}{z:>16}\n", "GRID*", "", "*").as_bytes(),
                );
            }
        }
    }
}

/// `CHEXA`; one row is one layer of one slice.
struct Bricks<'a> {
    mesh: &'a NastranMesh<'a>,
}

impl Rows for Bricks<'_> {
    fn rows(&self) -> usize {
        self.mesh.block.slices() * self.group()
    }

    fn group(&self) -> usize {
        self.mesh.block.layers()
    }

    fn weight(&self, row: usize) -> usize {
        2 * self.mesh.block.slice_across(row / self.group())
    }

    fn render(&self, rows: Range<usize>, out: &mut Vec<u8>) {
        let (block, layers) = (&self.mesh.block, self.group());
        for row in rows {
            let (slice, layer) = (row / layers, row % layers);
            let across = block.slice_across(slice);
            let first = block.first_element(slice) + (layer * across) as u64;
            let nodes = block.row_connectivity(slice, layer);
            for index in 0..across {
                let (id, property) = (first + index as u64, self.mesh.property(slice, layer, index));
                let [a, b, c, d, e, f, g, h] = nodes.map(|n| n + index as u64);
                out.extend_from_slice(
                    format!(
                        "{:<8}{id:>8}{property:>8}{a:>8}{b:>8}{c:>8}{d:>8}{e:>8}{f:>8}+\n{:<8}{g:>8}{h:>8}\n",
                        "CHEXA", "+"
                    )
                    .as_bytes(),
                );
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::materials::library;

    #[test]
    fn reals_fit_their_fields_and_have_a_point() {
        for value in [0.0, 3.1, 2033.33, 1.145e-9, -1.0 / 3.0, 1e10, -123_456.789_012_345] {
            let text = long(value);
            assert!(text.len() <= 16 && (text.contains('.') || text.contains('E')), "{text}");
            assert!((text.parse::<f64>().unwrap() - value).abs() <= 1e-8 * value.abs());
        }
    }

    #[test]
    fn a_mixture_lies_between_its_phases() {
        let set = PhaseSet::new(library()[..2].to_vec(), 0.2).unwrap();
        let middle = mixture(&set, 7.85);
        assert!((middle.density.unwrap() - 1.1575e-9).abs() < 1e-20 && (middle.poisson - 0.3).abs() < 1e-15);
        assert!((mixture(&set, 12.6).density.unwrap() - 1.17e-9).abs() < 1e-20);
    }
}
