//! The profile of a spoke: one row a station.

/// Arrays of equal length, rim first; borrowed by hosts without copies.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Profile {
    /// Arc length from the rim, mm.
    pub s: Vec<f64>,
    /// Inclination, rad.
    pub inclination: Vec<f64>,
    /// Horizontal distance from the rim, mm.
    pub x: Vec<f64>,
    /// Height above the rim, mm.
    pub z: Vec<f64>,
    /// Distance from the dome's axis in the morphed state, mm.
    pub rho: Vec<f64>,
    /// Full width, mm.
    pub width: Vec<f64>,
    /// Modulus over its largest value.
    pub modulus_ratio: Vec<f64>,
    /// Modulus, MPa.
    pub modulus_mpa: Vec<f64>,
    /// Fraction of the stiffest phase.
    pub rigid_fraction: Vec<f64>,
}

impl Profile {
    /// Empty arrays with room for some stations.
    #[must_use]
    pub fn with_capacity(stations: usize) -> Self {
        let room = || Vec::with_capacity(stations);
        Self {
            s: room(),
            inclination: room(),
            x: room(),
            z: room(),
            rho: room(),
            width: room(),
            modulus_ratio: room(),
            modulus_mpa: room(),
            rigid_fraction: room(),
        }
    }

    /// Outline of the flat strip as `[x, y]`, x from the rim to the hub: up one edge and back along the other, mm.
    #[must_use]
    pub fn flat_outline(&self) -> Vec<[f64; 2]> {
        let edge = |side: f64| self.s.iter().zip(&self.width).map(move |(s, w)| [*s, side * 0.5 * w]);
        edge(-1.0).chain(edge(1.0).rev()).collect()
    }

    /// Largest curvature between neighbouring stations, 1/mm.
    #[must_use]
    pub fn largest_curvature(&self) -> f64 {
        let turn = |s: &[f64], theta: &[f64]| ((theta[1] - theta[0]) / (s[1] - s[0])).abs();
        self.s.windows(2).zip(self.inclination.windows(2)).map(|(s, theta)| turn(s, theta)).fold(0.0, f64::max)
    }
}
