//! A strip to be morphed: its mesh, its bricks and their law.

use super::FemError;
use super::element::{EnhancedBrick, Geometry, Isotropic, Law, shape};
use super::mesh::Mesh;
use crate::design::Design;
use crate::mesh::{Block, Spacing};

/// Strain at the faces from which on St. Venant and Kirchhoff's law would soften too much in compression.
pub const LARGE_STRAIN: f64 = 0.1;

/// Phase of an element that is a mixture.
pub const MIXTURE: u8 = u8::MAX;

/// A strip of bricks.
#[derive(Debug, Clone)]
pub struct Model {
    /// Nodes and elements.
    pub mesh: Mesh,
    /// Law of all bricks.
    pub law: Law,
    /// Phase of every element, softest first, or [`MIXTURE`].
    pub phases: Vec<u8>,
    bricks: Vec<EnhancedBrick>,
    brick_of: Vec<u32>,
}

/// Elements of a voxel strip and of a graded one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Resolution {
    /// Every voxel its phase; elements along a voxel's edge.
    Voxels(usize),
    /// A smooth outline; elements along, across and through the strip.
    Graded([usize; 3]),
}

impl Model {
    /// A model of given bricks: `brick_of` and `phases` have one entry an element.
    #[must_use]
    pub fn new(mesh: Mesh, law: Law, bricks: Vec<EnhancedBrick>, brick_of: Vec<u32>, phases: Vec<u8>) -> Self {
        Self { mesh, law, phases, bricks, brick_of }
    }

    /// The strip of a design.
    ///
    /// # Errors
    /// [`FemError::Inverted`] where the outline of a graded strip folds an element.
    pub fn of_design(design: &Design, resolution: Resolution) -> Result<Self, FemError> {
        let law = law(design);
        match resolution {
            Resolution::Voxels(per_edge) => Self::voxels(design, per_edge.max(1), law),
            Resolution::Graded(elements) => Self::graded(design, elements, law),
        }
    }

    /// The brick of an element.
    #[must_use]
    pub fn brick(&self, element: usize) -> &EnhancedBrick {
        &self.bricks[self.brick_of[element] as usize]
    }

    fn voxels(design: &Design, per_edge: usize, law: Law) -> Result<Self, FemError> {
        let (grid, strips) = (design.grid(), &design.input().strips);
        let across = grid.half_widths().iter().flat_map(|n| std::iter::repeat_n(2 * n * per_edge, per_edge)).collect();
        let edge = grid.size_mm() / per_edge as f64;
        let layers = grid.layers() * per_edge;
        let block = Block::new(strips.length_mm, strips.thickness_mm, layers, across, Spacing::Even(edge));
        let mesh = Mesh::new(&block);
        let geometry = Geometry::of_box([edge; 3]).map_err(|reason| FemError::Inverted { element: 1, reason })?;
        let material = |m: &crate::materials::Material| Isotropic { modulus: m.modulus_mpa, poisson: m.poisson };
        let bricks = design.phases().phases().iter().map(|m| EnhancedBrick::new(geometry.clone(), material(m)));
        let mut phases = Vec::with_capacity(mesh.elements.len());
        for (i, half_width) in grid.half_widths().iter().enumerate() {
            let voxels = grid.slice(i);
            for _ in 0..per_edge {
                for layer in 0..layers {
                    let row = &voxels[layer / per_edge * 2 * half_width..][..2 * half_width];
                    phases.extend(row.iter().flat_map(|phase| std::iter::repeat_n(*phase, per_edge)));
                }
            }
        }
        let brick_of = phases.iter().map(|p| u32::from(*p)).collect();
        Ok(Self::new(mesh, law, bricks.collect(), brick_of, phases))
    }

    fn graded(design: &Design, [along, across, through]: [usize; 3], law: Law) -> Result<Self, FemError> {
        let (strips, phases) = (&design.input().strips, design.phases());
        let station = |i: usize| design.width_and_modulus(strips.length_mm * i as f64 / along as f64);
        let (widths, moduli): (Vec<f64>, Vec<f64>) = (0..=along).map(station).unzip();
        let block =
            Block::new(strips.length_mm, strips.thickness_mm, through, vec![across; along], Spacing::Width(widths));
        let mesh = Mesh::new(&block);
        let mixture = |modulus: f64| {
            let fractions = phases.fractions(modulus).values;
            let poisson = phases.phases().iter().zip(fractions).map(|(m, f)| m.poisson * f).sum();
            Isotropic { modulus, poisson }
        };
        let mut bricks = Vec::with_capacity(mesh.elements.len());
        for slice in 0..along {
            let materials = std::array::from_fn(|point| {
                let share = 0.5 * (1.0 + shape::gauss_point(point)[0]);
                mixture((1.0 - share) * moduli[slice] + share * moduli[slice + 1])
            });
            for element in mesh.slices[slice]..mesh.slices[slice + 1] {
                let corners = mesh.elements[element].map(|n| mesh.nodes[n as usize]);
                let geometry = Geometry::of_hexahedron(&corners)
                    .map_err(|reason| FemError::Inverted { element: element + 1, reason })?;
                bricks.push(EnhancedBrick::graded(geometry, materials));
            }
        }
        let count = mesh.elements.len();
        Ok(Self::new(mesh, law, bricks, (0..count as u32).collect(), vec![MIXTURE; count]))
    }
}

/// The law a design's strip needs.
fn law(design: &Design) -> Law {
    let strain = 0.5 * design.input().strips.thickness_mm * design.profile().largest_curvature();
    if strain > LARGE_STRAIN { Law::NeoHooke } else { Law::SaintVenantKirchhoff }
}
