//! All spokes of a design at once, prepared for animation: only what changes with the morph is computed again.

use std::f64::consts::TAU;

use crate::design::Design;
use crate::elastica::ElasticaError;
use crate::elastica::forward::Equilibrium;
use crate::surface::Strip;

/// A coordinate that a host's vertex arrays hold.
pub trait Coordinate: Copy {
    /// The nearest value of this type.
    fn from_f64(value: f64) -> Self;
}

impl Coordinate for f32 {
    fn from_f64(value: f64) -> Self {
        value as f32
    }
}

impl Coordinate for f64 {
    fn from_f64(value: f64) -> Self {
        value
    }
}

/// The mid-surfaces of all spokes as grids of quads, in the order and the frame of [`crate::surface::SpokeSurface`], spoke
/// after spoke counter-clockwise.
#[derive(Debug, Clone)]
pub struct Flower {
    strip: Strip,
    spokes: usize,
    along: usize,
    across: usize,
    /// Offset of the hub from the axis; `None` for a rectangular strip.
    hub_radius: Option<f64>,
    /// Arc length and half-width at the rows.
    rows: Vec<(f64, f64)>,
    modulus_mpa: Vec<f64>,
    /// Sine and cosine of the spokes' directions.
    turns: Vec<(f64, f64)>,
}

impl Flower {
    /// Prepares the surfaces of a design with `along` by `across` quads a spoke (at least one each).
    #[must_use]
    pub fn new(design: &Design, strip: Strip, along: usize, across: usize) -> Self {
        let (along, across) = (along.max(1), across.max(1));
        let input = design.input();
        let spokes = input.count();
        let length = input.strips.length_mm;
        let row = |i: usize| {
            let s = length * i as f64 / along as f64;
            let (width, modulus) = design.width_and_modulus(s);
            ((s, 0.5 * width), modulus)
        };
        let (rows, moduli): (Vec<(f64, f64)>, Vec<f64>) = (0..=along).map(row).unzip();
        let spoke = || moduli.iter().flat_map(|m| std::iter::repeat_n(*m, across + 1));
        Self {
            strip,
            spokes,
            along,
            across,
            hub_radius: (!input.is_strip()).then(|| input.hub_radius()),
            modulus_mpa: (0..spokes).flat_map(|_| spoke()).collect(),
            rows,
            turns: (0..spokes).map(|i| (TAU * i as f64 / spokes as f64).sin_cos()).collect(),
        }
    }

    /// Number of spokes.
    #[must_use]
    pub fn spokes(&self) -> usize {
        self.spokes
    }

    /// Number of vertices of all spokes.
    #[must_use]
    pub fn vertices(&self) -> usize {
        self.spokes * (self.along + 1) * (self.across + 1)
    }

    /// Designed modulus at every vertex, MPa.
    #[must_use]
    pub fn modulus_mpa(&self) -> &[f64] {
        &self.modulus_mpa
    }

    /// Vertices of every quad of all spokes, counter-clockwise seen from where the normals point.
    #[must_use]
    pub fn quads(&self) -> Vec<[u32; 4]> {
        let row = self.across + 1;
        let (along, across) = (self.along, self.across);
        let quad = move |first: usize, i: usize, j: usize| {
            let vertex = |i: usize, j: usize| (first + i * row + j) as u32;
            [vertex(i, j), vertex(i, j + 1), vertex(i + 1, j + 1), vertex(i + 1, j)]
        };
        (0..self.spokes)
            .map(|spoke| spoke * (along + 1) * row)
            .flat_map(|first| (0..along).flat_map(move |i| (0..across).map(move |j| quad(first, i, j))))
            .collect()
    }

    /// Vertices (and normals, where wanted) at a fraction of the morph, for the design the flower was made of. Slices
    /// hold one entry a vertex; what is beyond the shorter of the two lengths stays untouched.
    ///
    /// # Errors
    /// [`ElasticaError::NoEquilibrium`] where the path could not be followed; the arrays are untouched then.
    pub fn fill<T: Coordinate>(
        &self,
        design: &Design,
        fraction: f64,
        positions: &mut [[T; 3]],
        mut normals: Option<&mut [[T; 3]]>,
    ) -> Result<(), ElasticaError> {
        let shape = design.strip_shape(self.strip, fraction)?;
        let row = self.across + 1;
        let last = self.rows.last().map_or(0.0, |r| r.0);
        let hub_x = shape.as_ref().and_then(|s| s.x.last().copied()).unwrap_or(last);
        let place = |v: [f64; 3]| v.map(T::from_f64);
        for (i, &(s, half)) in self.rows.iter().enumerate() {
            let ([x, z], inclination) =
                shape.as_ref().map_or(([s, 0.0], 0.0), |shape| (shape.position(s), shape.inclination_at(s)));
            let (sin, cos) = inclination.sin_cos();
            // A dome's spoke runs towards -x, a rectangular strip towards +x: quads shall turn the same way.
            let (radial, outward, side) = match self.hub_radius {
                Some(hub) => (hub + hub_x - x, sin, half),
                None => (x, -sin, -half),
            };
            for (spoke, &(turn_sin, turn_cos)) in self.turns.iter().enumerate() {
                let first = (spoke * (self.along + 1) + i) * row;
                let (base, step) = ([turn_cos * radial, turn_sin * radial], [-turn_sin * side, turn_cos * side]);
                for (j, vertex) in positions.iter_mut().skip(first).take(row).enumerate() {
                    let share = 2.0 * j as f64 / self.across as f64 - 1.0;
                    *vertex = place([base[0] + share * step[0], base[1] + share * step[1], z]);
                }
                if let Some(normals) = normals.as_deref_mut() {
                    let normal = place([turn_cos * outward, turn_sin * outward, cos]);
                    let end = (first + row).min(normals.len());
                    normals[first.min(end)..end].fill(normal);
                }
            }
        }
        Ok(())
    }
}

impl Design {
    /// The mid-line of a spoke at a fraction of the morph (0 flat, 1 closed); `None` for a strip that is only stretched.
    ///
    /// # Errors
    /// [`ElasticaError::NoEquilibrium`] where the path could not be followed.
    pub fn strip_shape(&self, strip: Strip, fraction: f64) -> Result<Option<Equilibrium>, ElasticaError> {
        let path = match strip {
            Strip::Graded => self.graded_path()?,
            Strip::Voxel => self.voxel_path(),
        };
        path.map(|p| p.at(fraction)).transpose()
    }

    /// Corners of the hub at a fraction of the morph, counter-clockwise: the regular polygon between the spokes, whose
    /// edge `i` is the end of spoke `i`. Empty for a rectangular strip.
    ///
    /// # Errors
    /// [`ElasticaError::NoEquilibrium`] where the path could not be followed.
    pub fn hub_polygon(&self, strip: Strip, fraction: f64) -> Result<Vec<[f64; 3]>, ElasticaError> {
        if self.input().is_strip() {
            return Ok(Vec::new());
        }
        let height = self.strip_shape(strip, fraction)?.and_then(|s| s.z.last().copied()).unwrap_or(0.0);
        let count = self.input().count();
        let half = 0.5 * TAU / count as f64;
        let radius = self.input().hub_radius() / half.cos();
        let corner = |i: usize| {
            let (sin, cos) = (half * (2.0 * i as f64 - 1.0)).sin_cos();
            [radius * cos, radius * sin, height]
        };
        Ok((0..count).map(corner).collect())
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::input::files::Format;
    use crate::{DesignInput, Limits};

    fn design(text: &str) -> Design {
        let input = DesignInput::from_text(text, Format::Toml, "test", "test", Path::new("")).unwrap();
        Design::compute(&input, Limits::default()).unwrap()
    }

    #[test]
    fn the_flower_is_the_turned_surfaces_of_its_spokes() {
        let dome = include_str!("../../examples/hemisphere.toml");
        let strip = include_str!("../../examples/rectangular_2.toml");
        for (text, fraction) in [(dome, 0.0), (dome, 0.37), (dome, 1.0), (strip, 0.6)] {
            let design = design(text);
            let flower = Flower::new(&design, Strip::Graded, 20, 4);
            let one = design.spoke_surface(Strip::Graded, fraction, 20, 4).unwrap();
            let mut positions = vec![[0.0_f64; 3]; flower.vertices()];
            let mut normals = positions.clone();
            flower.fill(&design, fraction, &mut positions, Some(&mut normals)).unwrap();
            let vertices = one.positions.len();
            for spoke in 0..flower.spokes() {
                let turned = one.turned(spoke, flower.spokes());
                let close = |a: &[f64; 3], b: &[f64; 3]| (0..3).all(|k| (a[k] - b[k]).abs() < 1e-9);
                let here = spoke * vertices..(spoke + 1) * vertices;
                assert!(positions[here.clone()].iter().zip(&turned.positions).all(|(a, b)| close(a, b)));
                assert!(normals[here.clone()].iter().zip(&turned.normals).all(|(a, b)| close(a, b)));
                assert_eq!(flower.modulus_mpa()[here], turned.modulus_mpa);
            }
            assert_eq!(flower.quads()[..80], one.quads());
        }
    }

    #[test]
    fn the_hub_fills_the_space_between_the_spokes() {
        let design = design(include_str!("../../examples/hemisphere.toml"));
        let hub = design.hub_polygon(Strip::Graded, 1.0).unwrap();
        let spoke = design.spoke_surface(Strip::Graded, 1.0, 10, 2).unwrap();
        let (first, last) = (spoke.positions[30], spoke.positions[32]);
        assert_eq!(hub.len(), 8);
        for k in 0..3 {
            assert!((hub[0][k] - first[k]).abs() < 1e-6 && (hub[1][k] - last[k]).abs() < 1e-6, "{hub:?} {first:?}");
        }
    }
}
