//! Surfaces of spokes, flat and at any fraction of the morph.

use std::f64::consts::TAU;

use crate::design::Design;
use crate::elastica::ElasticaError;

/// Which strip's shape is taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Strip {
    /// The smooth, graded one: the design itself.
    Graded,
    /// The voxelised one, as the forward model predicts it.
    Voxel,
}

/// The mid-surface of one spoke as a grid of quads, `along + 1` by `across + 1` vertices, rim first, from one edge to the
/// other.
///
/// A dome's spoke lies in the flower's frame: hub on the z axis, spoke 1 along +x, z up from the plane of the rim. A
/// rectangular strip lies along x with its rim at the origin.
#[derive(Debug, Clone, PartialEq)]
pub struct SpokeSurface {
    /// Quads along the spoke.
    pub along: usize,
    /// Quads across it.
    pub across: usize,
    /// Vertices, mm; vertex `(i, j)` stands at `i (across + 1) + j`.
    pub positions: Vec<[f64; 3]>,
    /// Unit normals, up in the flat state and outward in the morphed one.
    pub normals: Vec<[f64; 3]>,
    /// Designed modulus, MPa.
    pub modulus_mpa: Vec<f64>,
}

impl SpokeSurface {
    /// The surface turned about the z axis to the place of spoke `index` (from zero) of `count`, counter-clockwise.
    #[must_use]
    pub fn turned(&self, index: usize, count: usize) -> Self {
        let (sin, cos) = (TAU * index as f64 / count.max(1) as f64).sin_cos();
        let turn = |p: &[f64; 3]| [cos * p[0] - sin * p[1], sin * p[0] + cos * p[1], p[2]];
        Self {
            positions: self.positions.iter().map(turn).collect(),
            normals: self.normals.iter().map(turn).collect(),
            ..self.clone()
        }
    }

    /// Vertices of every quad, counter-clockwise seen from where the normals point.
    #[must_use]
    pub fn quads(&self) -> Vec<[u32; 4]> {
        let row = self.across + 1;
        let vertex = |i: usize, j: usize| (i * row + j) as u32;
        (0..self.along)
            .flat_map(|i| {
                (0..self.across).map(move |j| [vertex(i, j), vertex(i, j + 1), vertex(i + 1, j + 1), vertex(i + 1, j)])
            })
            .collect()
    }
}

impl Design {
    /// The surface of spoke 1 at a fraction of the morph (0 flat, 1 closed). Cross-sections stay straight and keep their
    /// width.
    ///
    /// # Errors
    /// [`ElasticaError::NoEquilibrium`] where the path could not be followed.
    pub fn spoke_surface(
        &self,
        strip: Strip,
        fraction: f64,
        along: usize,
        across: usize,
    ) -> Result<SpokeSurface, ElasticaError> {
        let path = match strip {
            Strip::Graded => self.graded_path()?,
            Strip::Voxel => self.voxel_path(),
        };
        let shape = path.map(|p| p.at(fraction)).transpose()?;
        let (along, across) = (along.max(1), across.max(1));
        let length = self.input().strips.length_mm;
        let vertices = (along + 1) * (across + 1);
        let mut surface = SpokeSurface {
            along,
            across,
            positions: Vec::with_capacity(vertices),
            normals: Vec::with_capacity(vertices),
            modulus_mpa: Vec::with_capacity(vertices),
        };
        let hub_x = shape.as_ref().and_then(|s| s.x.last().copied()).unwrap_or(length);
        for i in 0..=along {
            let s = length * i as f64 / along as f64;
            let ([x, z], inclination) = match &shape {
                Some(shape) => (shape.position(s), shape.inclination_at(s)),
                None => ([s, 0.0], 0.0),
            };
            let (width, modulus) = self.width_and_modulus(s);
            let (sin, cos) = inclination.sin_cos();
            let (radial, normal) = if self.input().is_strip() {
                (x, [-sin, 0.0, cos])
            } else {
                (self.input().hub_radius() + hub_x - x, [sin, 0.0, cos])
            };
            for j in 0..=across {
                let share = j as f64 / across as f64 - 0.5;
                // A dome's spoke runs towards -x, a rectangular strip towards +x: quads shall turn the same way.
                let y = if self.input().is_strip() { -share * width } else { share * width };
                surface.positions.push([radial, y, z]);
                surface.normals.push(normal);
                surface.modulus_mpa.push(modulus);
            }
        }
        Ok(surface)
    }
}
