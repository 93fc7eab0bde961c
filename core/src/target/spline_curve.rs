//! A smooth curve walked by arc length from rim to hub.
//!
//! With `x = rho(0) - rho` and `z` the height above the rim, `v = |r'|`, and primes for derivatives by the spline's own
//! parameter `t`:
//!
//! - arc length `s(t) = int_0^t v dt`, inverted through a table and one step of Newton's method;
//! - inclination `theta = atan2(z', x')`, unwrapped along the curve;
//! - curvature `d theta / d s = (x' z'' - z' x'') / v^3`;
//! - curvature gradient `d^2 theta / d s^2 = (x' z''' - z' x''') / v^4 - 3 (x' z'' - z' x'') (x' x'' + z' z'') / v^6`.

use super::smoothing::PiecewiseCurve;
use super::{MeridianCurve, MeridianPoint};

/// Table entries a knot interval. Eight keep the interpolated inverse within 1e-12 of the length for a dome's profile.
const ENTRIES_PER_INTERVAL: f64 = 8.0;

/// One row of the table that turns arc length into the parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Entry {
    t: f64,
    s: f64,
    speed: f64,
    /// `dv/dt`.
    acceleration: f64,
    inclination: f64,
}

/// A meridian given by a spline, in mm.
#[derive(Debug, Clone, PartialEq)]
pub struct SplineMeridian {
    curve: PiecewiseCurve,
    table: Vec<Entry>,
    rim: [f64; 2],
    length: f64,
}

impl SplineMeridian {
    /// The part of a curve in mm from parameter 0, the rim, to `end`.
    ///
    /// `end` must be positive, and the curve must not stand still on the way.
    pub(super) fn new(curve: PiecewiseCurve, end: f64) -> Self {
        let table = table(&curve, end);
        let rim = curve.at(0.0)[0];
        let length = table.last().map_or(0.0, |entry| entry.s);
        Self { curve, table, rim, length }
    }

    /// Radius of the rim, mm.
    #[must_use]
    pub fn rim_radius(&self) -> f64 {
        self.rim[0]
    }

    /// `[rho, z]` at arc length `s`, mm, with `z` measured from the rim. `s` is clamped to the length.
    #[must_use]
    pub fn position(&self, s: f64) -> [f64; 2] {
        let point = self.at(s);
        [self.rim[0] - point.x, point.z]
    }

    /// The state at arc length `s` in the table's interval that starts at `entry`.
    fn evaluate(&self, s: f64, entry: &Entry, next: &Entry) -> MeridianPoint {
        let t = parameter(&self.curve, s, entry, next);
        let [position, first, second, third] = self.curve.at(t);
        let (dx, dz) = (-first[0], first[1]);
        let (ddx, ddz) = (-second[0], second[1]);
        let v2 = (dx * dx + dz * dz).max(f64::MIN_POSITIVE);
        let turning = dx * ddz - dz * ddx;
        let turning_rate = dx * third[1] + dz * third[0];
        let along = dx * ddx + dz * ddz;
        MeridianPoint {
            s,
            inclination: entry.inclination + wrapped(dz.atan2(dx) - entry.inclination),
            curvature: turning / (v2 * v2.sqrt()),
            curvature_gradient: (turning_rate - 3.0 * turning * along / v2) / (v2 * v2),
            x: self.rim[0] - position[0],
            z: position[1] - self.rim[1],
        }
    }

    fn at_from(&self, s: f64, index: usize) -> Option<MeridianPoint> {
        Some(self.evaluate(s, self.table.get(index)?, self.table.get(index + 1)?))
    }
}

impl MeridianCurve for SplineMeridian {
    fn length(&self) -> f64 {
        self.length
    }

    fn at(&self, s: f64) -> MeridianPoint {
        // A NaN walks to the rim rather than into the result.
        let s = if s > 0.0 { s.min(self.length) } else { 0.0 };
        let index = self.table.partition_point(|entry| entry.s <= s).saturating_sub(1);
        let index = index.min(self.table.len().saturating_sub(2));
        self.at_from(s, index).unwrap_or(MeridianPoint {
            s,
            inclination: 0.0,
            curvature: 0.0,
            curvature_gradient: 0.0,
            x: 0.0,
            z: 0.0,
        })
    }

    fn stations(&self, count: usize) -> Vec<MeridianPoint> {
        let last = count.max(2) - 1;
        let mut index = 0;
        (0..=last)
            .map(|i| {
                let s = (self.length * i as f64 / last as f64).min(self.length);
                while index + 2 < self.table.len() && self.table.get(index + 1).is_some_and(|entry| entry.s <= s) {
                    index += 1;
                }
                self.at_from(s, index).unwrap_or_else(|| self.at(s))
            })
            .collect()
    }
}

/// `angle` less the whole turns that bring it nearest to zero.
fn wrapped(angle: f64) -> f64 {
    use std::f64::consts::TAU;
    angle - TAU * (angle / TAU).round()
}

pub(super) fn speed(curve: &PiecewiseCurve, t: f64) -> f64 {
    let [_, first] = curve.position_and_velocity(t);
    (first[0] * first[0] + first[1] * first[1]).sqrt()
}

/// Arc length between two parameters at most a knot interval apart: Gauss's rule with five points.
pub(super) fn arc(curve: &PiecewiseCurve, from: f64, to: f64) -> f64 {
    const NODES: [(f64, f64); 3] = [
        (0.0, 0.568_888_888_888_888_9),
        (0.538_469_310_105_683, 0.478_628_670_499_366_5),
        (0.906_179_845_938_664, 0.236_926_885_056_189_1),
    ];
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    let [centre, inner, outer] = NODES;
    let pair =
        |(node, weight): (f64, f64)| weight * (speed(curve, middle - half * node) + speed(curve, middle + half * node));
    half * (centre.1 * speed(curve, middle) + pair(inner) + pair(outer))
}

fn table(curve: &PiecewiseCurve, end: f64) -> Vec<Entry> {
    let count = ((end / curve.step() * ENTRIES_PER_INTERVAL).ceil() as usize).max(16);
    let mut table: Vec<Entry> = Vec::with_capacity(count + 1);
    let mut s = 0.0;
    for i in 0..=count {
        let t = end * i as f64 / count as f64;
        let [_, first, second, _] = curve.at(t);
        let speed = first[0].hypot(first[1]);
        let angle = first[1].atan2(-first[0]);
        let inclination = table.last().map_or(angle, |before| before.inclination + wrapped(angle - before.inclination));
        if let Some(before) = table.last() {
            s += arc(curve, before.t, t);
        }
        let acceleration = (first[0] * second[0] + first[1] * second[1]) / speed.max(f64::MIN_POSITIVE);
        table.push(Entry { t, s, speed, acceleration, inclination });
    }
    table
}

/// The parameter at arc length `s` between two entries: the quintic through `t`, `dt/ds = 1/v` and
/// `d^2 t/ds^2 = -v'/v^3` at both, improved by one step of Newton's method.
fn parameter(curve: &PiecewiseCurve, s: f64, entry: &Entry, next: &Entry) -> f64 {
    let width = next.s - entry.s;
    if width.is_nan() || width <= 0.0 {
        return entry.t;
    }
    let w = ((s - entry.s) / width).clamp(0.0, 1.0);
    let slope = |e: &Entry| width / e.speed;
    let bend = |e: &Entry| -width * width * e.acceleration / (e.speed * e.speed * e.speed);
    let rise = next.t - entry.t - slope(entry) - 0.5 * bend(entry);
    let tilt = slope(next) - slope(entry) - bend(entry);
    let turn = bend(next) - bend(entry);
    let c3 = 10.0 * rise - 4.0 * tilt + 0.5 * turn;
    let c4 = -15.0 * rise + 7.0 * tilt - turn;
    let c5 = 6.0 * rise - 3.0 * tilt + 0.5 * turn;
    let t = entry.t + w * (slope(entry) + w * (0.5 * bend(entry) + w * (c3 + w * (c4 + w * c5))));
    let t = t.clamp(entry.t, next.t);
    let (near, sign) = if w < 0.5 { (entry, 1.0) } else { (next, -1.0) };
    let reached = near.s + sign * arc(curve, near.t.min(t), near.t.max(t));
    (t + (s - reached) / speed(curve, t).max(f64::MIN_POSITIVE)).clamp(entry.t, next.t)
}
