//! Convex cells cut out of a box by planes.
//!
//! Every plane cuts every cell it passes through, and the cells share their vertices, so cells that touch share whole faces:
//! the surface of any set of cells is closed without further ado.

use std::collections::HashMap;

use crate::fabrication::solid::Point;

/// Points this close to a plane lie on it, mm.
const ON: f64 = 1e-7;

/// The plane `normal . p = offset`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plane {
    /// Unit normal.
    pub normal: Point,
    /// Distance from the origin along the normal, mm.
    pub offset: f64,
}

impl Plane {
    /// Signed distance of a point, mm.
    #[must_use]
    pub fn distance(&self, p: Point) -> f64 {
        (0..3).map(|k| self.normal[k] * p[k]).sum::<f64>() - self.offset
    }
}

/// A convex cell: its faces' vertices, in no particular order of turning.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Cell {
    /// Faces.
    pub faces: Vec<Vec<u32>>,
}

/// Cells and their vertices.
#[derive(Debug, Clone, PartialEq)]
pub struct Cells {
    /// Vertices, mm.
    pub vertices: Vec<Point>,
    /// Cells.
    pub cells: Vec<Cell>,
}

impl Cells {
    /// One box between two corners.
    #[must_use]
    pub fn of_box(low: Point, high: Point) -> Self {
        let corner = |i: usize| std::array::from_fn(|k| if i >> k & 1 == 1 { high[k] } else { low[k] });
        let faces = [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]];
        let cell = Cell { faces: faces.map(|f| f.to_vec()).to_vec() };
        Self { vertices: (0..8).map(corner).collect(), cells: vec![cell] }
    }

    /// Cuts all cells by a plane.
    pub fn cut(&mut self, plane: &Plane) {
        let side = |p: &Point| {
            let distance = plane.distance(*p);
            if distance.abs() <= ON { 0_i8 } else { distance.signum() as i8 }
        };
        let mut sides: Vec<i8> = self.vertices.iter().map(side).collect();
        let mut cuts: HashMap<(u32, u32), u32> = HashMap::new();
        for cell in std::mem::take(&mut self.cells) {
            let has = |wanted: i8| cell.faces.iter().flatten().any(|v| sides[*v as usize] == wanted);
            if !(has(1) && has(-1)) {
                self.cells.push(cell);
                continue;
            }
            let mut parts = [Cell { faces: Vec::new() }, Cell { faces: Vec::new() }];
            let mut section: Vec<u32> = Vec::new();
            for face in &cell.faces {
                let mut halves: [Vec<u32>; 2] = [Vec::new(), Vec::new()];
                for (k, &vertex) in face.iter().enumerate() {
                    let next = face[(k + 1) % face.len()];
                    let (here, there) = (sides[vertex as usize], sides[next as usize]);
                    if here >= 0 {
                        halves[0].push(vertex);
                    }
                    if here <= 0 {
                        halves[1].push(vertex);
                    }
                    if here == 0 {
                        section.push(vertex);
                    }
                    if here * there < 0 {
                        let key = (vertex.min(next), vertex.max(next));
                        let crossing = *cuts.entry(key).or_insert_with(|| {
                            let ends = [key.0, key.1].map(|v| self.vertices[v as usize]);
                            let [a, b] = ends.map(|p| plane.distance(p));
                            let share = a / (a - b);
                            let point = std::array::from_fn(|k| ends[0][k] + share * (ends[1][k] - ends[0][k]));
                            self.vertices.push(point);
                            sides.push(0);
                            (self.vertices.len() - 1) as u32
                        });
                        halves.iter_mut().for_each(|half| half.push(crossing));
                        section.push(crossing);
                    }
                }
                // What only touches the plane has no area on that side.
                for ((part, half), wanted) in parts.iter_mut().zip(halves).zip([1, -1]) {
                    if half.iter().any(|v| sides[*v as usize] == wanted) {
                        part.faces.push(half);
                    }
                }
            }
            section.sort_unstable();
            section.dedup();
            let section = around(&self.vertices, section, plane.normal);
            for mut part in parts {
                part.faces.push(section.clone());
                self.cells.push(part);
            }
        }
    }

    /// Keeps the cells that lie below a plane.
    pub fn keep_below(&mut self, plane: &Plane) {
        self.cut(plane);
        let vertices = &self.vertices;
        self.cells.retain(|cell| plane.distance(centre(vertices, cell)) < 0.0);
    }

    /// Surface of the cells whose middle satisfies a condition: polygons, counter-clockwise seen from outside.
    #[must_use]
    pub fn surface(&self, solid: impl Fn(Point) -> bool) -> Vec<Vec<u32>> {
        let mut faces: HashMap<Vec<u32>, (usize, Vec<u32>)> = HashMap::new();
        let mut order = 0;
        for cell in &self.cells {
            let middle = centre(&self.vertices, cell);
            if !solid(middle) {
                continue;
            }
            for face in &cell.faces {
                let mut key = face.clone();
                key.sort_unstable();
                if faces.remove(&key).is_none() {
                    faces.insert(key, (order, self.outward(face, middle)));
                    order += 1;
                }
            }
        }
        let mut outer: Vec<(usize, Vec<u32>)> = faces.into_values().collect();
        outer.sort_unstable();
        outer.into_iter().map(|(_, face)| face).collect()
    }

    fn outward(&self, face: &[u32], inside: Point) -> Vec<u32> {
        let [a, b, c] = [face[0], face[1], face[2]].map(|v| self.vertices[v as usize]);
        let edge = |p: Point| -> Point { std::array::from_fn(|k| p[k] - a[k]) };
        let normal = cross(edge(b), edge(c));
        let towards: f64 = (0..3).map(|k| normal[k] * (inside[k] - a[k])).sum();
        let mut face = face.to_vec();
        if towards > 0.0 {
            face.reverse();
        }
        face
    }
}

fn cross(a: Point, b: Point) -> Point {
    std::array::from_fn(|k| a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3])
}

fn mean(vertices: &[Point], of: impl Iterator<Item = u32>) -> Point {
    let (mut sum, mut count) = ([0.0; 3], 0.0);
    for vertex in of {
        (0..3).for_each(|k| sum[k] += vertices[vertex as usize][k]);
        count += 1.0;
    }
    sum.map(|s| s / f64::max(count, 1.0))
}

fn centre(vertices: &[Point], cell: &Cell) -> Point {
    mean(vertices, cell.faces.iter().flatten().copied())
}

/// Corners of a convex polygon in order around their middle.
fn around(vertices: &[Point], mut corners: Vec<u32>, normal: Point) -> Vec<u32> {
    let middle = mean(vertices, corners.iter().copied());
    let axis = if normal[0].abs() < 0.6 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] };
    let u = cross(normal, axis);
    let w = cross(normal, u);
    let angle = |v: &u32| {
        let p = vertices[*v as usize];
        let along = |axis: Point| (0..3).map(|k| axis[k] * (p[k] - middle[k])).sum::<f64>();
        along(w).atan2(along(u))
    };
    corners.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
    corners
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_of_a_cut_cube_share_faces_and_fill_it() {
        let mut cells = Cells::of_box([0.0; 3], [2.0, 3.0, 4.0]);
        let half = 0.5_f64.sqrt();
        for plane in [
            Plane { normal: [1.0, 0.0, 0.0], offset: 0.7 },
            Plane { normal: [half, half, 0.0], offset: 1.1 },
            Plane { normal: [0.0, half, -half], offset: 0.3 },
            // Through corners and edges.
            Plane { normal: [0.6, -0.8, 0.0], offset: 0.0 },
            Plane { normal: [0.0, 0.0, 1.0], offset: 4.0 },
        ] {
            cells.cut(&plane);
        }
        let volume = |faces: &[Vec<u32>]| {
            let corner = |v: u32| cells.vertices[v as usize];
            let fans = faces.iter().flat_map(|f| (1..f.len() - 1).map(|k| [f[0], f[k], f[k + 1]]));
            fans.map(|t| crate::fabrication::voxel_surface::signed_volume(&t.map(corner))).sum::<f64>()
        };
        assert!(cells.cells.len() > 8);
        let whole = cells.surface(|_| true);
        assert!((volume(&whole) - 24.0).abs() < 1e-9);
        let low = volume(&cells.surface(|p| p[0] < 0.7));
        assert!((low - 0.7 * 12.0).abs() < 1e-9, "{low}");
        let mut edges: HashMap<(u32, u32), i32> = HashMap::new();
        for face in cells.surface(|p| p[0] < 0.7 || p[1] + p[0] > 1.1 / half) {
            for k in 0..face.len() {
                *edges.entry((face[k], face[(k + 1) % face.len()])).or_insert(0) += 1;
            }
        }
        assert!(edges.iter().all(|((a, b), n)| *n == 1 && edges.get(&(*b, *a)) == Some(&1)));
    }
}
