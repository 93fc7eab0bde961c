//! The hub as quadrilaterals.
//!
//! A regular polygon with one edge a spoke, cut into one kite a corner: centre, middle of an edge, corner, middle of the
//! next edge. Each kite has as many elements along its sides as half a spoke has across, so nodes on the hub's edges lie
//! where the spokes' hub ends have theirs.
//!
//! ```text
//!     M(i+1) ---- C          node (a, b) of a kite: a from the centre to M(i), b to M(i+1);
//!       |  (a, b) |          the line a = 0 belongs to the next kite; the centre is node one
//!       O ------- M(i)
//! ```

use std::f64::consts::TAU;

use super::Flower;

/// A polygon of quadrilaterals.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HubPlate {
    flower: Flower,
    divisions: usize,
}

impl HubPlate {
    /// The hub of a flower with `divisions` elements along each half of an edge.
    #[must_use]
    pub fn new(flower: Flower, divisions: usize) -> Self {
        Self { flower, divisions }
    }

    /// Number of kites.
    #[must_use]
    pub fn kites(&self) -> usize {
        self.flower.count
    }

    /// Elements along a side of a kite.
    #[must_use]
    pub fn divisions(&self) -> usize {
        self.divisions
    }

    /// Number of nodes.
    #[must_use]
    pub fn nodes(&self) -> u64 {
        1 + self.flower.count as u64 * self.divisions as u64 * (self.divisions as u64 + 1)
    }

    /// Number of elements.
    #[must_use]
    pub fn elements(&self) -> u64 {
        self.flower.count as u64 * (self.divisions as u64).pow(2)
    }

    /// Node `(a, b)` of a kite.
    #[must_use]
    pub fn node(&self, kite: usize, a: usize, b: usize) -> u64 {
        let sides = self.divisions as u64;
        match (a, b) {
            (0, 0) => 1,
            (0, b) => self.node((kite + 1) % self.flower.count, b, 0),
            (a, b) => 2 + kite as u64 * sides * (sides + 1) + (a as u64 - 1) * (sides + 1) + b as u64,
        }
    }

    /// Element `(a, b)` of a kite.
    #[must_use]
    pub fn element(&self, kite: usize, a: usize, b: usize) -> u64 {
        let sides = self.divisions;
        1 + ((kite * sides + a) * sides + b) as u64
    }

    /// Nodes of element `(a, b)` of a kite; their normal points up.
    #[must_use]
    pub fn connectivity(&self, kite: usize, a: usize, b: usize) -> [u64; 4] {
        [(a, b), (a + 1, b), (a + 1, b + 1), (a, b + 1)].map(|(a, b)| self.node(kite, a, b))
    }

    /// Position of node `(a, b)` of a kite, mm: bilinear between the kite's corners.
    #[must_use]
    pub fn position(&self, kite: usize, a: usize, b: usize) -> [f64; 2] {
        let (u, v) = (a as f64 / self.divisions as f64, b as f64 / self.divisions as f64);
        let radius = self.flower.hub_radius;
        let first = self.flower.outward(kite);
        let second = self.flower.outward((kite + 1) % self.flower.count);
        let step = TAU / self.flower.count as f64;
        let to_corner = radius * (0.5 * step).tan();
        // The corner lies on edge `kite`, counter-clockwise from its middle.
        let corner = [radius * first[0] - to_corner * first[1], radius * first[1] + to_corner * first[0]];
        std::array::from_fn(|i| {
            u * (1.0 - v) * radius * first[i] + u * v * corner[i] + (1.0 - u) * v * radius * second[i]
        })
    }
}

#[cfg(test)]
mod tests {
    use std::collections::HashMap;

    use super::*;

    #[test]
    fn kites_tile_the_polygon() {
        for (count, divisions) in [(3, 1), (4, 2), (8, 10), (12, 3)] {
            let plate = HubPlate::new(Flower { count, hub_radius: 10.0, length: 1.0 }, divisions);
            let mut points: HashMap<u64, [f64; 2]> = HashMap::new();
            for (kite, a, b) in cells(count, divisions + 1) {
                let point = plate.position(kite, a, b);
                let known = *points.entry(plate.node(kite, a, b)).or_insert(point);
                assert!((known[0] - point[0]).hypot(known[1] - point[1]) < 1e-12, "{count} {kite} {a} {b}");
            }
            assert_eq!(points.len() as u64, plate.nodes());
            assert_eq!(*points.keys().max().unwrap(), plate.nodes());
            let mut total = 0.0;
            for (kite, a, b) in cells(count, divisions) {
                let corners = plate.connectivity(kite, a, b).map(|n| points[&n]);
                let cross = |i: usize| {
                    let (p, q, r) = (corners[i], corners[(i + 1) % 4], corners[(i + 3) % 4]);
                    (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])
                };
                assert!((0..4).all(|i| cross(i) > 0.0));
                total += 0.5 * (cross(0) + cross(2));
            }
            let expected = count as f64 * (0.5 * TAU / count as f64).tan() * 100.0;
            assert!((total - expected).abs() < 1e-9, "{total} {expected}");
        }
    }

    fn cells(count: usize, sides: usize) -> impl Iterator<Item = (usize, usize, usize)> {
        (0..count).flat_map(move |k| (0..sides).flat_map(move |a| (0..sides).map(move |b| (k, a, b))))
    }
}
