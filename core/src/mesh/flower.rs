//! Where the spokes lie in the flat flower.
//!
//! ```text
//!            spoke 2
//!               |  /          hub at the origin, z up, spoke 1 along +x, the others counter-clockwise;
//!               | /           a spoke's own frame: s from the rim inward, z up, y = z x s
//!   ----- hub (N edges) ----- spoke 1
//! ```

use std::f64::consts::TAU;

/// Spokes around a hub, all in the plane `z = 0`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Flower {
    /// Number of spokes.
    pub count: usize,
    /// Radius of the circle inscribed in the hub, mm.
    pub hub_radius: f64,
    /// Length of a spoke, mm.
    pub length: f64,
}

impl Flower {
    /// Azimuth of a spoke, counted from zero, degrees.
    #[must_use]
    pub fn azimuth_deg(&self, spoke: usize) -> f64 {
        360.0 * spoke as f64 / self.count as f64
    }

    /// Unit vector from the hub outward along a spoke; exact along the axes.
    #[must_use]
    pub fn outward(&self, spoke: usize) -> [f64; 2] {
        let (sin, cos) = (TAU * spoke as f64 / self.count as f64).sin_cos();
        [cos, sin].map(|c| if c.abs() < 1e-14 { 0.0 } else { c })
    }

    /// Position of the point `(s, y)` of a spoke's own frame, mm.
    ///
    /// ```
    /// # use voxelastica_core::mesh::Flower;
    /// let flower = Flower { count: 4, hub_radius: 10.0, length: 100.0 };
    /// assert_eq!(flower.place(0, 0.0, 2.0), [110.0, -2.0]);
    /// assert_eq!(flower.place(1, 100.0, 2.0), [2.0, 10.0]);
    /// ```
    #[must_use]
    pub fn place(&self, spoke: usize, s: f64, y: f64) -> [f64; 2] {
        let [cos, sin] = self.outward(spoke);
        let radius = self.hub_radius + self.length - s;
        [radius * cos + y * sin, radius * sin - y * cos]
    }

    /// Distance of a spoke's rim corners from the axis, or anything else this far along and across, mm.
    #[must_use]
    pub fn reach(&self, half_width: f64) -> f64 {
        (self.hub_radius + self.length).hypot(half_width)
    }
}
