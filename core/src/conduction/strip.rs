//! The strip of a design as a mesh for conduction.

use serde::Serialize;

use super::mesh::{BrickMesh, Geometry, VOID};
use super::pcg::Watch;
use super::{ConductionError, memory};
use crate::design::Design;
use crate::elastica::forward::Equilibrium;
use crate::materials::{AssumedProperty, Assumption, Material, assumptions};

/// Which strip conducts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Model {
    /// Every voxel one brick of its phase.
    Voxel,
    /// The smooth outline; in every cross-section the designed mixture, whose phases conduct side by side.
    Graded,
}

/// In which shape it conducts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Shape {
    /// As printed.
    Flat,
    /// At the end of the morph: cross-sections stay plane and normal to the mid-line that the elastica predicts.
    Morphed,
}

/// A property of a material that conduction may need.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Property {
    /// Thermal conductivity, W/(mm K) here.
    Conductivity,
    /// Heat capacity per volume, J/(mm^3 K) here.
    HeatCapacity,
    /// Electrical conductivity, S/mm here.
    ElectricalConductivity,
    /// Permittivity, F/mm here.
    Permittivity,
}

/// Permittivity of vacuum, F/m (CODATA 2018).
pub const VACUUM_PERMITTIVITY: f64 = 8.854_187_812_8e-12;

impl Property {
    /// The value of a material, in W, J, K, s, A, V and mm.
    ///
    /// # Errors
    /// [`ConductionError::MissingProperty`].
    pub fn of(self, material: &Material) -> Result<f64, ConductionError> {
        let need = |value: Option<f64>, property, key| {
            value.ok_or_else(|| ConductionError::MissingProperty { material: material.name.clone(), property, key })
        };
        match self {
            Self::Conductivity => {
                need(material.conductivity_w_mk, "thermal conductivity", "conductivity_w_mk").map(|k| k * 1e-3)
            }
            Self::HeatCapacity => {
                let density = need(material.density_kg_m3, "density", "density_kg_m3")?;
                need(material.specific_heat_j_kgk, "specific heat", "specific_heat_j_kgk").map(|c| c * density * 1e-9)
            }
            Self::ElectricalConductivity => {
                let key = "electrical_conductivity_s_m";
                need(material.electrical_conductivity_s_m, "electrical conductivity", key).map(|s| s * 1e-3)
            }
            Self::Permittivity => {
                need(material.relative_permittivity, "relative permittivity", "relative_permittivity")
                    .map(|e| e * VACUUM_PERMITTIVITY * 1e-3)
            }
        }
    }
}

/// A strip that conducts.
#[derive(Debug, Clone)]
pub struct Strip {
    /// What it is made of.
    pub model: Model,
    /// Its shape.
    pub shape: Shape,
    /// Its bricks; their materials are numbers of `mixtures`.
    pub mesh: BrickMesh,
    /// Fractions of the phases in every material.
    pub mixtures: Vec<Vec<f64>>,
    /// The phases, softest first.
    pub phases: Vec<Material>,
    /// Arc length, mm.
    pub length_mm: f64,
}

impl Strip {
    /// The strip of a design. `elements` are the numbers along, across and through of [`Model::Graded`]. Memory is estimated first.
    ///
    /// # Errors
    /// [`ConductionError::Memory`], [`ConductionError::NoShape`] for a strip that is not morphed, or whose morph was not
    /// found, [`ConductionError::Inverted`].
    pub fn new(design: &Design, model: Model, shape: Shape, elements: [usize; 3]) -> Result<Self, ConductionError> {
        Self::new_unless(design, model, shape, elements, Watch::silent())
    }

    /// As [`Self::new`], unless it is cancelled.
    ///
    /// # Errors
    /// Those of [`Self::new`], and [`ConductionError::Cancelled`].
    pub fn new_unless(
        design: &Design,
        model: Model,
        shape: Shape,
        elements: [usize; 3],
        watch: Watch<'_>,
    ) -> Result<Self, ConductionError> {
        let input = design.input();
        let phases = design.phases().phases().to_vec();
        let (mesh, mixtures) = match model {
            Model::Voxel => voxels(design, shape, watch)?,
            Model::Graded => graded(design, shape, elements, watch)?,
        };
        Ok(Self { model, shape, mesh, mixtures, phases, length_mm: input.strips.length_mm })
    }

    /// A property of every material of the mesh: that of its phases, by volume (phases side by side along the strip).
    ///
    /// # Errors
    /// [`ConductionError::MissingProperty`] for a phase that is present.
    pub fn property(&self, property: Property) -> Result<Vec<f64>, ConductionError> {
        let used = self.used();
        let values: Vec<f64> = self
            .phases
            .iter()
            .zip(&used)
            .map(|(phase, used)| if *used { property.of(phase) } else { Ok(0.0) })
            .collect::<Result<_, _>>()?;
        Ok(self.mixtures.iter().map(|mix| mix.iter().zip(&values).map(|(f, v)| f * v).sum()).collect())
    }

    /// Which phases are present.
    fn used(&self) -> Vec<bool> {
        self.fractions().iter().map(|f| *f > 0.0).collect()
    }

    /// Volume fraction of every phase.
    #[must_use]
    pub fn fractions(&self) -> Vec<f64> {
        let volumes = self.mesh.volumes(self.mixtures.len());
        let whole: f64 = volumes.iter().sum();
        (0..self.phases.len())
            .map(|p| volumes.iter().zip(&self.mixtures).map(|(v, mix)| v * mix[p]).sum::<f64>() / whole)
            .collect()
    }

    /// What is assumed about a property of the phases that are present.
    #[must_use]
    pub fn assumptions(&self, property: AssumedProperty) -> Vec<Assumption> {
        let used = self.used();
        let present = self.phases.iter().zip(&used).filter(|(_, used)| **used);
        present.flat_map(|(p, _)| assumptions(p)).filter(|a| a.property == property).collect()
    }

    /// Nodes and weights that give the value on the mid-line at a share of the length from the rim.
    #[must_use]
    pub fn midline_point(&self, share: f64) -> Vec<(usize, f64)> {
        let [slices, layers, across] = self.mesh.cells();
        let split = |at: f64, last: usize| {
            let low = (at.floor().max(0.0) as usize).min(last.saturating_sub(1));
            let rest = (at - low as f64).clamp(0.0, 1.0);
            [(low, 1.0 - rest), (low + 1, rest)]
        };
        let mut weights = Vec::new();
        for (plane, a) in split(share * slices as f64, slices) {
            for (level, b) in split(0.5 * layers as f64, layers) {
                for (place, c) in split(0.5 * across as f64, across) {
                    if a * b * c > 0.0 {
                        weights.push((self.mesh.node([plane, level, place]), a * b * c));
                    }
                }
            }
        }
        weights
    }
}

type MeshAndMixtures = (BrickMesh, Vec<Vec<f64>>);

fn voxels(design: &Design, shape: Shape, watch: Watch<'_>) -> Result<MeshAndMixtures, ConductionError> {
    let grid = design.grid();
    let most = grid.half_widths().iter().copied().max().unwrap_or(1);
    let cells = [grid.slices(), grid.layers(), 2 * most];
    memory::require_cells(cells, None)?;
    let mut materials = Vec::with_capacity(cells.iter().product());
    for (i, half) in grid.half_widths().iter().enumerate() {
        watch.at(0.0)?;
        for layer in grid.slice(i).chunks(2 * half) {
            let side = most - half;
            materials.extend(std::iter::repeat_n(VOID, side));
            materials.extend(layer.iter().map(|phase| u16::from(*phase)));
            materials.extend(std::iter::repeat_n(VOID, side));
        }
    }
    let size_mm = grid.size_mm();
    let geometry = match shape {
        Shape::Flat => Geometry::Cubes(size_mm),
        Shape::Morphed => {
            let path =
                design.voxel_path().ok_or_else(|| no_shape(design, "the elastica found none for these voxels"))?;
            let midline = (0..=grid.slices()).map(|i| section(path.final_shape(), i as f64 * size_mm)).collect();
            Geometry::Sections { midline, size_mm }
        }
    };
    let count = design.phases().phases().len();
    let pure = |p: usize| (0..count).map(|q| if p == q { 1.0 } else { 0.0 }).collect();
    Ok((BrickMesh::new_unless(cells, materials, geometry, watch)?, (0..count).map(pure).collect()))
}

fn graded(
    design: &Design,
    shape: Shape,
    [along, across, through]: [usize; 3],
    watch: Watch<'_>,
) -> Result<MeshAndMixtures, ConductionError> {
    let strips = &design.input().strips;
    let cells = [along, through, across];
    memory::require_cells(cells, None)?;
    let path = match shape {
        Shape::Flat => None,
        Shape::Morphed => {
            let found = design.graded_path().map_err(|e| ConductionError::NoShape { reason: e.to_string() })?;
            Some(found.ok_or_else(|| no_shape(design, ""))?.final_shape())
        }
    };
    let mut positions = Vec::with_capacity((along + 1) * (through + 1) * (across + 1));
    for i in 0..=along {
        watch.at(0.0)?;
        let s = strips.length_mm * i as f64 / along as f64;
        let (width, _) = design.width_and_modulus(s);
        let [x, z, inclination] = path.map_or([s, 0.0, 0.0], |shape| section(shape, s));
        let (sin, cos) = inclination.sin_cos();
        for k in 0..=through {
            let height = strips.thickness_mm * (k as f64 / through as f64 - 0.5);
            for j in 0..=across {
                positions.push([x - height * sin, width * (j as f64 / across as f64 - 0.5), z + height * cos]);
            }
        }
    }
    let count = design.phases().phases().len();
    let mixtures = (0..along)
        .map(|i| {
            let s = strips.length_mm * (i as f64 + 0.5) / along as f64;
            let (_, modulus) = design.width_and_modulus(s);
            design.phases().fractions(modulus).values[..count].iter().map(|f| f.clamp(0.0, 1.0)).collect()
        })
        .collect();
    let materials = (0..along).flat_map(|i| std::iter::repeat_n(i as u16, through * across)).collect();
    Ok((BrickMesh::new_unless(cells, materials, Geometry::Free(positions), watch)?, mixtures))
}

fn section(shape: &Equilibrium, s: f64) -> [f64; 3] {
    let [x, z] = shape.position(s);
    [x, z, shape.inclination_at(s)]
}

fn no_shape(design: &Design, otherwise: &str) -> ConductionError {
    let reason = match design.guide() {
        None => "this strip is stretched, not morphed",
        Some(_) => otherwise,
    };
    ConductionError::NoShape { reason: reason.to_owned() }
}
