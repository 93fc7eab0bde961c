//! A straight slot that holds a spoke's end at the inclination it has there.
//!
//! ```text
//!            n ^   wall               In the meridian plane: r outwards, z up. d = (-cos t, sin t) runs along the spoke,
//!    mouth  ___|_________             rim to hub, n = (sin t, cos t) is its outer normal, t the inclination at the end.
//!      <-d  :  | t + c   | bottom     The bottom of the slot is the spoke's end; the slot is as wide as the spoke there and
//!           :__|_________|            as high as its thickness, both plus the clearance c.
//! ```

use std::f64::consts::PI;

use super::cells::Plane;
use super::error::AssemblyError;
use crate::design::Design;
use crate::fabrication::solid::Point;
use crate::input::FabricationInput;

/// An end of a spoke.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// Rim, in the base.
    Rim,
    /// Hub.
    Hub,
}

impl End {
    fn name(self) -> &'static str {
        match self {
            Self::Rim => "rim",
            Self::Hub => "hub",
        }
    }
}

/// A slot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Seat {
    /// Which end it holds.
    pub end: End,
    /// Distance of the slot's bottom, at mid-thickness, from the axis, mm.
    pub radius_mm: f64,
    /// Its height above the rim's plane, mm.
    pub height_mm: f64,
    /// Inclination of the slot, rad.
    pub inclination: f64,
    /// Width, along the rim: the spoke's, smooth or of voxels, whichever is larger, and the clearance, mm.
    pub width_mm: f64,
    /// Height of the slot: thickness and clearance, mm.
    pub thickness_mm: f64,
    /// Depth along the spoke, mm.
    pub depth_mm: f64,
    /// Number of slots.
    pub count: usize,
}

impl Seat {
    /// The slot of a design's rim or hub end, as deep as asked for or as the spoke's curve allows: within the slot neither
    /// face may come further than half the clearance from where it is at the end.
    ///
    /// # Errors
    /// [`AssemblyError::TooCurved`], [`AssemblyError::SlotsCollide`].
    pub fn of(design: &Design, input: &FabricationInput, end: End) -> Result<Self, AssemblyError> {
        let profile = design.profile();
        let last = profile.s.len() - 1;
        let at = if end == End::Rim { 0 } else { last };
        let (thickness, clearance) = (design.input().strips.thickness_mm, input.clearance_mm);
        let count = design.input().count();
        let tan = (PI / count as f64).tan();
        if clearance * (tan - 1.0) >= thickness {
            let most_mm = thickness / (tan - 1.0);
            return Err(AssemblyError::SlotsCollide { count, clearance_mm: clearance, most_mm });
        }
        let mut seat = Self {
            end,
            radius_mm: profile.rho[at],
            height_mm: profile.z[at],
            inclination: profile.inclination[at],
            width_mm: 0.0,
            thickness_mm: thickness + clearance,
            depth_mm: if end == End::Rim { input.seat_depth_mm } else { input.hub_seat_depth_mm },
            count,
        };
        seat.limit_depth(design, clearance)?;
        seat.width_mm = seat.widest(design) + clearance;
        Ok(seat)
    }

    /// Directions along the spoke and outwards across it, `(r, z)`.
    fn axes(&self) -> [[f64; 2]; 2] {
        let (sin, cos) = self.inclination.sin_cos();
        [[-cos, sin], [sin, cos]]
    }

    /// Distance from the bottom towards the mouth, and across the slot, of a point `(r, z)`.
    #[must_use]
    pub fn within(&self, r: f64, z: f64) -> [f64; 2] {
        let [along, across] = self.axes();
        let (dr, dz) = (r - self.radius_mm, z - self.height_mm);
        let inwards = if self.end == End::Rim { 1.0 } else { -1.0 };
        [inwards * (along[0] * dr + along[1] * dz), across[0] * dr + across[1] * dz]
    }

    /// The point `(r, z)` at a distance from the bottom towards the mouth, and across.
    #[must_use]
    pub fn point(&self, depth: f64, across: f64) -> [f64; 2] {
        let [along, normal] = self.axes();
        let inwards = if self.end == End::Rim { depth } else { -depth };
        [
            self.radius_mm + inwards * along[0] + across * normal[0],
            self.height_mm + inwards * along[1] + across * normal[1],
        ]
    }

    /// The plane at a distance from the bottom towards the mouth; its normal points to the mouth.
    #[must_use]
    pub fn across_plane(&self, depth: f64) -> Plane {
        let [along, _] = self.axes();
        let sign = if self.end == End::Rim { 1.0 } else { -1.0 };
        let normal = [sign * along[0], 0.0, sign * along[1]];
        let [r, z] = self.point(depth, 0.0);
        Plane { normal, offset: normal[0] * r + normal[2] * z }
    }

    /// The plane at a distance across the slot.
    #[must_use]
    pub fn along_plane(&self, across: f64) -> Plane {
        let [_, [sin, cos]] = self.axes();
        let [r, z] = self.point(0.0, across);
        Plane { normal: [sin, 0.0, cos], offset: sin * r + cos * z }
    }

    /// All planes of the slot.
    #[must_use]
    pub fn planes(&self) -> [Plane; 4] {
        let half = 0.5 * self.thickness_mm;
        [
            self.across_plane(0.0),
            self.along_plane(half),
            self.along_plane(-half),
            Plane { normal: [0.0, 1.0, 0.0], offset: 0.5 * self.width_mm },
        ]
    }

    /// Whether a point of the half period is in the slot, which is open towards its mouth.
    #[must_use]
    pub fn is_void(&self, p: Point) -> bool {
        let [depth, across] = self.within(p[0], p[2]);
        depth > 0.0 && across.abs() < 0.5 * self.thickness_mm && p[1].abs() < 0.5 * self.width_mm
    }

    /// Least and largest radius and height of the slot with walls around it.
    #[must_use]
    pub fn envelope(&self, wall: f64) -> [[f64; 2]; 2] {
        let half = 0.5 * self.thickness_mm + wall;
        let corners = [(-wall, half), (-wall, -half), (self.depth_mm, half), (self.depth_mm, -half)]
            .map(|(d, n)| self.point(d, n));
        [0, 1].map(|k| {
            let values = corners.map(|c| c[k]);
            [values.into_iter().fold(f64::INFINITY, f64::min), values.into_iter().fold(f64::NEG_INFINITY, f64::max)]
        })
    }

    /// Whether walls stand between neighbouring slots, at their outer side: a slot is wider than the wedge it lies in by the
    /// clearance, so only where it is further out than the spoke's middle does something remain between two of them.
    #[must_use]
    pub fn is_walled(&self) -> bool {
        let half = 0.5 * self.thickness_mm;
        let outermost = self.point(0.0, half)[0].max(self.point(self.depth_mm, half)[0]);
        outermost * (PI / self.count as f64).tan() > 0.5 * self.width_mm + 1e-6
    }

    /// Stations of the profile in the slot: those up to its depth.
    fn stations<'a>(&self, design: &'a Design, depth: f64) -> impl Iterator<Item = usize> + use<'a> {
        let profile = design.profile();
        let length = profile.s.last().copied().unwrap_or(0.0);
        let end = self.end;
        (0..profile.s.len()).filter(move |i| {
            let from_end = if end == End::Rim { profile.s[*i] } else { length - profile.s[*i] };
            from_end <= depth + 1e-9
        })
    }

    fn limit_depth(&mut self, design: &Design, clearance: f64) -> Result<(), AssemblyError> {
        let profile = design.profile();
        let half = 0.5 * design.input().strips.thickness_mm;
        let room = half + 0.5 * clearance;
        // Stations from the end on, and those whose faces may reach back into the slot.
        let mut stations: Vec<usize> = self.stations(design, self.depth_mm + 2.0 * half).collect();
        if self.end == End::Hub {
            stations.reverse();
        }
        let face = |i: usize, side: f64| {
            let (sin, cos) = profile.inclination[i].sin_cos();
            self.within(profile.rho[i] + side * sin, profile.z[i] + side * cos)
        };
        let least_mm = half.min(self.depth_mm);
        let (mut depth, mut needed) = (self.depth_mm, 0.0_f64);
        for side in [-half, half] {
            for pair in stations.windows(2) {
                let [[d0, n0], [d1, n1]] = [pair[0], pair[1]].map(|i| face(i, side));
                let (n0, n1) = (n0.abs(), n1.abs());
                if d1.min(d0) <= least_mm {
                    needed = needed.max(2.0 * (n1 - half));
                }
                if n1 > room {
                    let share = ((room - n0) / (n1 - n0)).clamp(0.0, 1.0);
                    depth = depth.min(d0 + (d1 - d0) * share).min(d1);
                }
            }
        }
        if depth < least_mm {
            let clearance_mm = (105.0 * needed).ceil() / 100.0;
            return Err(AssemblyError::TooCurved {
                end: self.end.name(),
                depth_mm: depth.max(0.0),
                least_mm,
                clearance_mm,
            });
        }
        self.depth_mm = depth;
        Ok(())
    }

    /// Largest width of the spoke in the slot, smooth or of voxels, mm.
    fn widest(&self, design: &Design) -> f64 {
        let profile = design.profile();
        let smooth = self.stations(design, self.depth_mm).map(|i| profile.width[i]).fold(0.0, f64::max);
        let grid = design.grid();
        let slices = grid.slices();
        let held = ((self.depth_mm / grid.size_mm()).ceil() as usize).clamp(1, slices);
        let widths = grid.half_widths();
        let own = if self.end == End::Rim { &widths[..held] } else { &widths[slices - held..] };
        let voxels = 2.0 * own.iter().copied().max().unwrap_or(0) as f64 * grid.size_mm();
        smooth.max(voxels)
    }
}
