//! Numbering the vertices of a phase's surface, one slab after the other.

use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};

use super::{Slab, Vertex, VoxelSurface};
use crate::fabrication::solid::SolidError;
use crate::progress::Cancelled;

/// Vertices that can be numbered: 3MF allows signed 32-bit numbers.
const MOST_VERTICES: u64 = i32::MAX as u64;

/// Mixes the few words of a [`Vertex`]; its numbers are no secret and no attack.
#[derive(Default)]
pub(super) struct VertexHasher(u64);

impl Hasher for VertexHasher {
    fn finish(&self) -> u64 {
        self.0 ^ (self.0 >> 32)
    }

    fn write(&mut self, bytes: &[u8]) {
        bytes.iter().for_each(|b| self.write_u64(u64::from(*b)));
    }

    fn write_u64(&mut self, word: u64) {
        self.0 = (self.0 ^ word).wrapping_mul(0x9E37_79B9_7F4A_7C15).rotate_left(29);
    }
}

type Numbers = HashMap<u128, u32, BuildHasherDefault<VertexHasher>>;

/// All of a vertex in one number.
fn key(vertex: &Vertex) -> u128 {
    let lattice = vertex.at.iter().fold(0_u128, |key, at| key << 32 | u128::from(at.cast_unsigned()));
    vertex.offset.iter().fold(lattice, |key, offset| key << 8 | u128::from(offset.cast_unsigned()))
}

/// A slab's surface with vertices numbered within it, in the order of their first use.
struct Local {
    vertices: Vec<Vertex>,
    triangles: Vec<[u32; 3]>,
}

fn number(slab: &Slab, phase: u8) -> Local {
    let mut numbers = Numbers::default();
    let mut local = Local { vertices: Vec::new(), triangles: Vec::new() };
    slab.triangles(phase, &mut |triangle| {
        local.triangles.push(triangle.map(|vertex| {
            *numbers.entry(key(&vertex)).or_insert_with(|| {
                local.vertices.push(vertex);
                (local.vertices.len() - 1) as u32
            })
        }));
    });
    local
}

impl VoxelSurface<'_> {
    /// A phase's surface with numbered vertices: `take` gets a slab's new vertices and its triangles. Only vertices in the
    /// plane shared with the next slab are remembered.
    ///
    /// # Errors
    /// [`super::SurfaceError::Cancelled`], [`SolidError::TooMany`], and what `take` returns.
    pub fn indexed(
        &self,
        phase: u8,
        cancelled: Cancelled<'_>,
        take: &mut dyn FnMut(Vec<Vertex>, Vec<[u32; 3]>) -> Result<(), SolidError>,
    ) -> Result<(), SolidError> {
        let mut shared = Numbers::default();
        let mut count = 0_u64;
        self.for_each_slab(
            cancelled,
            |slab| number(slab, phase),
            |index, mut local| {
                let next = self.first_slice(index + 1) as i32;
                let mut remembered = Numbers::default();
                let mut new = Vec::with_capacity(local.vertices.len());
                let mut global = Vec::with_capacity(local.vertices.len());
                for vertex in local.vertices {
                    let key = key(&vertex);
                    let number = shared.get(&key).copied().unwrap_or_else(|| {
                        new.push(vertex);
                        count += 1;
                        (count - 1) as u32
                    });
                    if vertex.at[0] == next {
                        remembered.insert(key, number);
                    }
                    global.push(number);
                }
                if count > MOST_VERTICES {
                    let (what, format) = ("vertices", "3MF");
                    return Err(SolidError::TooMany { count, what, format, limit: MOST_VERTICES });
                }
                shared = remembered;
                local.triangles.iter_mut().flatten().for_each(|v| *v = global[*v as usize]);
                take(new, local.triangles)
            },
        )
    }
}
