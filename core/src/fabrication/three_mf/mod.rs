//! 3MF: solids with their materials in one package.
//!
//! The core specification (1.3, ISO/IEC 25422): base materials, one object a phase, and components that place each different
//! spoke, stored once, around the hub. As an option ([`volumetric`]) a spoke is one object whose material at every point is
//! looked up in a stack of images, by the volumetric extension.
//!
//! Everything streams: a mesh's vertices, then its triangles, are rendered a slab at a time.

mod model;
mod package;
pub mod volumetric;

use super::layout::Placement;
use super::solid::{Solid, SolidError};
use crate::output::Provenance;
use crate::output::folder::Destination;
use crate::progress::Cancelled;
use volumetric::PhaseImages;

/// A base material.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct BaseMaterial {
    /// Its name.
    pub name: String,
    /// Its colour on a screen, `#rrggbb`.
    pub colour: String,
}

/// What an object is.
pub enum Shape<'a> {
    /// A solid of one material, given by its index.
    Solid {
        /// The solid.
        solid: &'a dyn Solid,
        /// Index of its material.
        material: usize,
    },
    /// A solid whose materials are looked up in images.
    Imaged {
        /// The solid.
        solid: &'a dyn Solid,
        /// The images.
        images: &'a PhaseImages,
    },
    /// Earlier objects, by index, put together.
    Components(Vec<(usize, Placement)>),
}

/// An object.
pub struct Object<'a> {
    /// Its name.
    pub name: String,
    /// What it is.
    pub shape: Shape<'a>,
}

/// A package's contents.
pub struct Document<'a> {
    /// Title.
    pub title: String,
    /// What it shows.
    pub description: String,
    /// Where it comes from.
    pub provenance: &'a Provenance,
    /// Materials.
    pub materials: Vec<BaseMaterial>,
    /// Objects; components refer to earlier ones.
    pub objects: Vec<Object<'a>>,
    /// Objects to be built, by index, and where.
    pub items: Vec<(usize, Placement)>,
}

/// Largest coordinate that is written with full precision, mm.
const REACH_MM: f64 = 1000.0;

impl Document<'_> {
    /// Writes the package.
    ///
    /// # Errors
    /// What reading the solids or writing the file returns.
    pub fn write(&self, out: &mut dyn Destination, cancelled: Cancelled<'_>) -> Result<(), SolidError> {
        let mut package = package::Package::new(out)?;
        let images = self.objects.iter().filter_map(|object| match &object.shape {
            Shape::Imaged { images, .. } => Some(images.files.as_slice()),
            _ => None,
        });
        let files: Vec<(String, Vec<u8>)> = images.flatten().cloned().collect();
        if !files.is_empty() {
            package.images(&files)?;
        }
        model::write(self, package.model()?, cancelled)?;
        package.finish()
    }
}

#[cfg(test)]
mod tests;
