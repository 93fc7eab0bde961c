//! Solids with the flower's symmetry, from one half of one period.
//!
//! A period is the wedge of one spoke; seen from the axis, `x` points to the middle of the spoke's end and `y` along it. Its
//! left half, `0 <= y <= x tan(pi/N)`, is cut into cells; mirrored and turned it gives the whole. Faces in the two planes of
//! symmetry are between equal solids and are left out; vertices there are shared exactly.

use std::collections::HashMap;
use std::f64::consts::PI;

use super::cells::{Cells, Plane};
use crate::fabrication::solid::{Mesh, Point};
use crate::mesh::Flower;

/// Points this close to a plane of symmetry lie in it, mm.
const ON: f64 = 1e-7;

/// Where a vertex of the half period lies, and so which copies share it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
enum Place {
    /// On the axis.
    Axis,
    /// In the plane of symmetry at an azimuth that is a multiple of `pi/N`.
    Symmetry(usize),
    /// Within one copy.
    Copy(usize),
}

/// Half a period between two radii and two heights.
#[derive(Debug, Clone)]
pub struct HalfPeriod {
    count: usize,
    cells: Cells,
}

impl HalfPeriod {
    /// Half a period of `count`.
    #[must_use]
    pub fn new(count: usize, radii: [f64; 2], heights: [f64; 2]) -> Self {
        let half = PI / count as f64;
        let widest = radii[1] * half.tan();
        let mut cells = Cells::of_box([radii[0], 0.0, heights[0]], [radii[1], widest, heights[1]]);
        cells.keep_below(&Plane { normal: [-half.sin(), half.cos(), 0.0], offset: 0.0 });
        Self { count, cells }
    }

    /// Cuts it by planes.
    #[must_use]
    pub fn cut(mut self, planes: impl IntoIterator<Item = Plane>) -> Self {
        planes.into_iter().for_each(|plane| self.cells.cut(&plane));
        self
    }

    /// All copies of the cells whose middle satisfies a condition, as one closed surface.
    #[must_use]
    pub fn solid(&self, solid: impl Fn(Point) -> bool) -> Mesh {
        let half = PI / self.count as f64;
        let vertices = &self.cells.vertices;
        let in_middle = |p: &Point| p[1].abs() <= ON;
        let in_mitre = |p: &Point| (half.cos() * p[1] - half.sin() * p[0]).abs() <= ON;
        let polygons: Vec<Vec<u32>> = self
            .cells
            .surface(solid)
            .into_iter()
            .filter(|face| {
                let all = |inside: &dyn Fn(&Point) -> bool| face.iter().all(|v| inside(&vertices[*v as usize]));
                !all(&in_middle) && !all(&in_mitre)
            })
            .collect();
        let mut mesh = Mesh::default();
        let mut numbers: HashMap<(Place, u32), u32> = HashMap::new();
        let flower = Flower { count: self.count, hub_radius: 0.0, length: 0.0 };
        let twice = Flower { count: 2 * self.count, ..flower };
        for copy in 0..2 * self.count {
            let (period, right) = (copy / 2, copy % 2 == 1);
            let mut number = |vertex: u32| {
                let p = vertices[vertex as usize];
                let place = match (in_middle(&p), in_mitre(&p)) {
                    (true, true) => Place::Axis,
                    (true, false) => Place::Symmetry(2 * period),
                    (false, true) if right => Place::Symmetry((2 * period + 2 * self.count - 1) % (2 * self.count)),
                    (false, true) => Place::Symmetry(2 * period + 1),
                    (false, false) => Place::Copy(copy),
                };
                *numbers.entry((place, vertex)).or_insert_with(|| {
                    let [cos, sin] = match place {
                        Place::Symmetry(azimuth) => twice.outward(azimuth),
                        _ => flower.outward(period),
                    };
                    let [x, y] = match place {
                        Place::Axis => [0.0, 0.0],
                        Place::Symmetry(_) => [p[0].hypot(p[1]), 0.0],
                        Place::Copy(_) => [p[0], if right { -p[1] } else { p[1] }],
                    };
                    mesh.vertices.push([cos * x - sin * y, sin * x + cos * y, p[2]]);
                    (mesh.vertices.len() - 1) as u32
                })
            };
            for polygon in &polygons {
                let mut ring: Vec<u32> = polygon.iter().map(|v| number(*v)).collect();
                if right {
                    ring.reverse();
                }
                mesh.triangles.extend((1..ring.len() - 1).map(|k| [ring[0], ring[k], ring[k + 1]]));
            }
        }
        mesh
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ring_and_a_plate_have_their_polygons_volumes_and_are_closed() {
        for count in [3, 4, 8, 12, 31] {
            let tan = (PI / count as f64).tan();
            let area = |radius: f64| count as f64 * radius * radius * tan;
            let plate = HalfPeriod::new(count, [0.0, 7.0], [-1.0, 2.0]);
            let cut = Plane { normal: [1.0, 0.0, 0.0], offset: 3.0 };
            for (mesh, volume) in [
                (plate.solid(|_| true), 3.0 * area(7.0)),
                (HalfPeriod::new(count, [5.0, 7.0], [0.0, 2.0]).solid(|_| true), 2.0 * (area(7.0) - area(5.0))),
                (plate.clone().cut([cut]).solid(|p| p[0] > 3.0), 3.0 * (area(7.0) - area(3.0))),
            ] {
                assert!(mesh.is_closed(), "{count}");
                assert!((mesh.volume() - volume).abs() < 1e-9 * volume, "{count}: {} {volume}", mesh.volume());
            }
        }
    }
}
