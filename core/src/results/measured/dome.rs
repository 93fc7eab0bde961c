//! The surface that a scan is compared with.

use std::f64::consts::TAU;

use nalgebra::Vector3;

use super::curve::Curve;

/// Which side of the sheet was scanned.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Face {
    /// The middle of the thickness, which is where the target is.
    #[default]
    Middle,
    /// The outer face, half the thickness outside the target.
    Outer,
    /// The inner face.
    Inner,
}

/// How a meridian becomes a surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Surface {
    /// The target's surface of revolution.
    Revolution,
    /// N spokes, straight across their width: what a flower morphs into.
    Spokes,
}

/// A dome in its own frame: z is its axis, upward, z = 0 the plane of the rim, spoke 1 along +x.
#[derive(Debug, Clone)]
pub(super) struct Dome {
    /// `(rho, z)`, rim first.
    pub curve: Curve,
    /// Whether the flat hub is part of it.
    pub hub: bool,
    /// Spokes that are straight across; `None` for a surface of revolution.
    pub spokes: Option<usize>,
    /// How far outside the meridian the scanned face lies, mm.
    pub outside: f64,
}

/// The point of a dome nearest to a point of a scan.
#[derive(Debug, Clone, Copy)]
pub(super) struct Distance {
    /// Distance, positive outside, mm.
    pub signed: f64,
    /// Unit vector along which it grows.
    pub gradient: Vector3<f64>,
    /// Arc length of the nearest point from the rim, mm; `None` on the hub.
    pub s: Option<f64>,
    /// How far the point lies beyond an end of the meridian, mm.
    pub beyond: f64,
}

impl Dome {
    pub fn distance(&self, p: &Vector3<f64>) -> Distance {
        let radius = p.x.hypot(p.y);
        let (direction, rho) = match self.spokes {
            None if radius > 0.0 => (Vector3::new(p.x / radius, p.y / radius, 0.0), radius),
            None => (Vector3::x(), 0.0),
            Some(count) => {
                let sector = TAU / count as f64;
                let (sin, cos) = (sector * (p.y.atan2(p.x) / sector).round()).sin_cos();
                (Vector3::new(cos, sin, 0.0), cos * p.x + sin * p.y)
            }
        };
        let foot = self.curve.nearest([rho, p.z]);
        // From the rim to the hub the radius shrinks, so that the left side is the inner one.
        let out = [-foot.normal[0], -foot.normal[1]];
        let offset = [foot.offset[0] - self.outside * out[0], foot.offset[1] - self.outside * out[1]];
        let length = offset[0].hypot(offset[1]);
        let side = if offset[0] * out[0] + offset[1] * out[1] < 0.0 { -1.0 } else { 1.0 };
        let mut nearest =
            Distance { signed: side * length, gradient: Vector3::z(), s: Some(foot.s), beyond: foot.beyond };
        let mut plane = if length > 1e-12 { offset.map(|c| side * c / length) } else { out };
        if self.hub {
            let [edge, height] = self.curve.end();
            let inside = rho.min(edge);
            let (dx, dz) = (rho - inside, p.z - height - self.outside);
            let away = dx.hypot(dz);
            if rho < edge && away < length {
                nearest = Distance { signed: dz, gradient: Vector3::z(), s: None, beyond: 0.0 };
                plane = [0.0, 1.0];
            }
        }
        nearest.gradient = plane[0] * direction + plane[1] * Vector3::z();
        nearest
    }

    /// Lowest and highest z.
    pub fn heights(&self) -> [f64; 2] {
        let z = || self.curve.points().iter().map(|p| p[1]);
        [z().fold(f64::INFINITY, f64::min), z().fold(f64::NEG_INFINITY, f64::max)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hemisphere(spokes: Option<usize>, outside: f64) -> Dome {
        let curve = Curve::new((0..=900).map(|i| {
            let q = f64::to_radians(0.1 * f64::from(i));
            [60.0 * q, 10.0 + 60.0 * q.cos(), 60.0 * q.sin()]
        }));
        Dome { curve: curve.unwrap(), hub: true, spokes, outside }
    }

    #[test]
    fn distances_of_a_round_and_of_a_faceted_dome() {
        let q = 0.7_f64;
        let at = |radius: f64, phi: f64, count: Option<f64>| {
            let rho =
                (10.0 + radius * q.cos()) / count.map_or(1.0, |n: f64| (phi - (phi * n / TAU).round() * TAU / n).cos());
            Vector3::new(rho * phi.cos(), rho * phi.sin(), radius * q.sin())
        };
        for phi in [0.0, 0.3, 1.9, 4.0, -2.0] {
            let round = hemisphere(None, 1.0).distance(&at(61.5, phi, None));
            assert!((round.signed - 0.5).abs() < 1e-3 && (round.s.unwrap() - 42.0).abs() < 0.1, "{round:?}");
            let spokes = hemisphere(Some(8), 0.0).distance(&at(59.0, phi, Some(8.0)));
            assert!((spokes.signed + 1.0).abs() < 1e-3, "{spokes:?}");
        }
    }

    #[test]
    fn the_gradient_is_that_of_the_distance() {
        for spokes in [None, Some(6)] {
            let dome = hemisphere(spokes, 1.0);
            for p in [[50.0, 20.0, 30.0], [-30.0, 8.0, 61.0], [3.0, 2.0, 62.0], [75.0, 1.0, -4.0]] {
                let p = Vector3::from(p);
                let here = dome.distance(&p);
                for k in 0..3 {
                    let step = 1e-5 * Vector3::ith(k, 1.0);
                    let slope = (dome.distance(&(p + step)).signed - dome.distance(&(p - step)).signed) / 2e-5;
                    assert!((slope - here.gradient[k]).abs() < 2e-3, "{spokes:?} {p} {k}: {slope} {here:?}");
                }
            }
        }
        let hub = hemisphere(None, 0.0).distance(&Vector3::new(2.0, 3.0, 61.0));
        assert!(hub.s.is_none() && (hub.signed - 1.0).abs() < 1e-12);
    }
}
