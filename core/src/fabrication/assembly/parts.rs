//! Base ring, hub and post as solids.

use super::cells::Plane;
use super::error::AssemblyError;
use super::ring::HalfPeriod;
use super::seat::{End, Seat};
use crate::design::Design;
use crate::elastica::HubSupport;
use crate::fabrication::solid::{Mesh, Point};
use crate::input::FabricationInput;

/// Least radius of what is inside the slots, mm.
const LEAST_INSIDE_MM: f64 = 1.0;

/// Least diameter of a post, mm.
const LEAST_POST_MM: f64 = 2.0;

/// Radius of the post's foot over that of the post, before its arms.
const FOOT: f64 = 3.0;

/// A part with a body between two radii and two heights, cut off at the mouths of its slots.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    /// Least and largest distance from the axis, mm.
    pub radii_mm: [f64; 2],
    /// Lowest and highest point, mm above the rim's plane.
    pub heights_mm: [f64; 2],
}

/// A held hub's post.
#[derive(Debug, Clone, PartialEq)]
pub struct Post {
    /// Diameter across flats, mm.
    pub diameter_mm: f64,
    /// Lower and upper end, mm above the rim's plane.
    pub heights_mm: [f64; 2],
    /// Depth of its socket in the hub, mm.
    pub socket_mm: f64,
    /// Radius of its foot, which fits into the base ring, mm.
    pub foot_radius_mm: f64,
    /// Thickness of the foot, mm.
    pub foot_mm: f64,
}

/// All parts of a design.
#[derive(Debug, Clone, PartialEq)]
pub struct Parts {
    /// Slots of the base.
    pub rim_seat: Seat,
    /// Slots of the hub.
    pub hub_seat: Seat,
    /// The base ring.
    pub base: Body,
    /// The hub.
    pub hub: Body,
    /// The post of a held hub.
    pub post: Option<Post>,
    clearance_mm: f64,
}

impl Parts {
    /// Dimensions of the parts of a dome.
    ///
    /// # Errors
    /// [`AssemblyError`] where they do not fit.
    pub fn of(design: &Design, input: &FabricationInput) -> Result<Self, AssemblyError> {
        let rim_seat = Seat::of(design, input, End::Rim)?;
        let hub_seat = Seat::of(design, input, End::Hub)?;
        let wall = input.wall_mm;

        let [radii_mm, [low, high]] = rim_seat.envelope(wall);
        room_inside("base", radii_mm[0], LEAST_INSIDE_MM)?;
        let least_mm = high - low;
        let height = input.base_height_mm.unwrap_or(least_mm);
        if height < least_mm - 1e-9 {
            return Err(AssemblyError::BaseTooLow { height_mm: height, least_mm });
        }
        let base = Body { radii_mm, heights_mm: [high - height, high] };
        runs_through(design, &rim_seat, &base, "base")?;

        let [[_, outer], heights_mm] = hub_seat.envelope(wall);
        let half = 0.5 * hub_seat.thickness_mm;
        let core = hub_seat.point(0.0, -half)[0].min(hub_seat.point(hub_seat.depth_mm, -half)[0]);
        room_inside("hub", core, LEAST_INSIDE_MM.max(0.5 * wall))?;
        let hub = Body { radii_mm: [0.0, outer], heights_mm };
        runs_through(design, &hub_seat, &hub, "hub")?;

        let held = design.input().thrust.as_ref().is_some_and(|thrust| thrust.hub == HubSupport::Held);
        let post = if held { Some(post(design, input, &base, &hub, core)?) } else { None };
        Ok(Self { rim_seat, hub_seat, base, hub, post, clearance_mm: input.clearance_mm })
    }

    /// The base ring, in the flower's morphed frame: axis along z, the rim's plane at `z = 0`.
    ///
    /// # Errors
    /// [`AssemblyError::TooFine`].
    pub fn base_mesh(&self) -> Result<Mesh, AssemblyError> {
        let seat = &self.rim_seat;
        let mouth = seat.across_plane(seat.depth_mm);
        let half = HalfPeriod::new(seat.count, self.base.radii_mm, self.base.heights_mm);
        let mesh = half.cut(seat.planes()).cut([mouth]).solid(|p| mouth.distance(p) < 0.0 && !seat.is_void(p));
        checked(mesh, "base")
    }

    /// The hub, in the same frame.
    ///
    /// # Errors
    /// [`AssemblyError::TooFine`].
    pub fn hub_mesh(&self) -> Result<Mesh, AssemblyError> {
        let seat = &self.hub_seat;
        let mouth = seat.across_plane(seat.depth_mm);
        let half = HalfPeriod::new(seat.count, self.hub.radii_mm, self.hub.heights_mm);
        let mut cut = half.cut(seat.planes()).cut([mouth]);
        let socket = self.post.as_ref().map(|post| {
            let radius = 0.5 * (post.diameter_mm + self.clearance_mm);
            (radius, self.hub.heights_mm[0] + post.socket_mm)
        });
        if let Some((radius, top)) = socket {
            cut = cut.cut([upright(radius), level(top)]);
        }
        let in_socket = |p: Point| socket.is_some_and(|(radius, top)| p[0] < radius && p[2] < top);
        checked(cut.solid(|p| mouth.distance(p) < 0.0 && !seat.is_void(p) && !in_socket(p)), "hub")
    }

    /// The post, in the same frame.
    ///
    /// # Errors
    /// [`AssemblyError::TooFine`].
    pub fn post_mesh(&self) -> Option<Result<Mesh, AssemblyError>> {
        let post = self.post.as_ref()?;
        let (radius, foot) = (0.5 * post.diameter_mm, post.heights_mm[0] + post.foot_mm);
        let disc = (FOOT * radius).min(post.foot_radius_mm);
        let outer = post.foot_radius_mm.max(radius);
        let arm = Plane { normal: [0.0, 1.0, 0.0], offset: radius };
        let half = HalfPeriod::new(self.rim_seat.count, [0.0, outer], post.heights_mm);
        let cut = half.cut([upright(radius), upright(disc), level(foot), arm]);
        let solid = |p: Point| p[0] < radius || (p[2] < foot && (p[0] < disc || p[1] < radius));
        Some(checked(cut.solid(solid), "post"))
    }
}

fn upright(radius: f64) -> Plane {
    Plane { normal: [1.0, 0.0, 0.0], offset: radius }
}

fn level(height: f64) -> Plane {
    Plane { normal: [0.0, 0.0, 1.0], offset: height }
}

fn checked(mesh: Mesh, part: &'static str) -> Result<Mesh, AssemblyError> {
    if mesh.is_closed() { Ok(mesh) } else { Err(AssemblyError::TooFine { part }) }
}

fn room_inside(part: &'static str, radius_mm: f64, least_mm: f64) -> Result<(), AssemblyError> {
    if radius_mm < least_mm { Err(AssemblyError::NoRoomInside { part, radius_mm, least_mm }) } else { Ok(()) }
}

/// Refuses where the dome, outside its slot, comes into a part's body.
fn runs_through(design: &Design, seat: &Seat, body: &Body, part: &'static str) -> Result<(), AssemblyError> {
    let profile = design.profile();
    let half = 0.5 * design.input().strips.thickness_mm;
    for i in 0..profile.s.len() {
        let (sin, cos) = profile.inclination[i].sin_cos();
        for side in [-half, half] {
            let (r, z) = (profile.rho[i] + side * sin, profile.z[i] + side * cos);
            let [depth, across] = seat.within(r, z);
            let held = depth >= -1e-9 && across.abs() <= 0.5 * seat.thickness_mm + 1e-9;
            let inside = (body.radii_mm[0]..body.radii_mm[1]).contains(&r)
                && (body.heights_mm[0]..body.heights_mm[1]).contains(&z)
                && depth < seat.depth_mm;
            if inside && !held {
                return Err(AssemblyError::RunsThrough { part, s_mm: profile.s[i] });
            }
        }
    }
    Ok(())
}

fn post(design: &Design, input: &FabricationInput, base: &Body, hub: &Body, core: f64) -> Result<Post, AssemblyError> {
    let (clearance, wall) = (input.clearance_mm, input.wall_mm);
    let room = 2.0 * (core - 0.5 * wall) - clearance;
    let diameter_mm = input.post_diameter_mm.min(room);
    if diameter_mm < LEAST_POST_MM {
        return Err(AssemblyError::PostTooThin { diameter_mm, least_mm: LEAST_POST_MM });
    }
    let [bottom, top] = hub.heights_mm;
    let socket_mm = (top - bottom - wall).max(0.5 * (top - bottom));
    let heights_mm = [base.heights_mm[0], bottom + socket_mm];
    let profile = design.profile();
    let half = 0.5 * design.input().strips.thickness_mm;
    for i in 0..profile.s.len() {
        let inner = profile.rho[i] - half * profile.inclination[i].sin().abs();
        if profile.z[i] < bottom && inner < 0.5 * diameter_mm {
            return Err(AssemblyError::RunsThrough { part: "post", s_mm: profile.s[i] });
        }
    }
    let foot_mm = wall.min(0.5 * (bottom - base.heights_mm[0])).max(0.1 * wall);
    Ok(Post { diameter_mm, heights_mm, socket_mm, foot_radius_mm: base.radii_mm[0] - 0.5 * clearance, foot_mm })
}
