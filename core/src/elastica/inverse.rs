//! From a target meridian and the widths to the modulus: the inverse problem.

use serde::{Deserialize, Serialize};

use super::ElasticaError;
use super::inflection::inflections;
use super::least_contrast::least_contrast;
use super::thrust_line::ThrustLine;
use crate::target::{MeridianCurve, MeridianPoint};

/// Inflections whose distance from the line of thrust is below this share of the length count as lying on it.
const COLLINEAR_SHARE: f64 = 1e-8;

/// Whether a vertical force acts on the hub.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum HubSupport {
    /// No vertical force: the line of thrust is horizontal.
    Free,
    /// A post, a weight or a tie holds the hub at its target height.
    Held,
}

impl HubSupport {
    /// The name used in design files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Free => "free",
            Self::Held => "held",
        }
    }
}

/// How the free parameters of the line of thrust are chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ThrustChoice {
    /// Equal moduli at the rim and the hub (Kansara et al. 2023).
    EqualEnds,
    /// The smallest ratio of the largest to the smallest modulus.
    LeastContrast,
}

/// The modulus along a strip and the line of thrust that goes with it.
#[derive(Debug, Clone)]
pub struct InverseSolution {
    /// Line of thrust in units of `E_max t^3 / 12`.
    pub thrust: ThrustLine,
    /// Zeros of the target's curvature, rim first.
    pub inflections: Vec<MeridianPoint>,
    /// `E / max E` at the stations.
    pub modulus_ratio: Vec<f64>,
    /// `max E / min E` over the stations.
    pub contrast: f64,
}

impl InverseSolution {
    /// `E / max E` at any point of the target where the spoke has the given width.
    #[must_use]
    pub fn ratio_at(&self, point: &MeridianPoint, width: f64, length: f64) -> f64 {
        self.thrust.modulus_at(point, width, length, &self.inflections)
    }
}

pub(super) fn help_for(support: HubSupport) -> &'static str {
    match support {
        HubSupport::Free => "a held hub (hub = \"held\") lets the line of thrust incline",
        HubSupport::Held => "change the target so that its curvature has fewer changes of sign",
    }
}

/// Solves the inverse problem at the given stations (rim first, both ends included).
///
/// # Errors
/// [`ElasticaError`] where the meridian is straight, has more inflections than the line of thrust can pass through, or
/// where the modulus would not be positive along the whole strip.
pub fn solve(
    curve: &dyn MeridianCurve,
    stations: &[MeridianPoint],
    widths: &[f64],
    support: HubSupport,
    choice: ThrustChoice,
) -> Result<InverseSolution, ElasticaError> {
    let length = curve.length();
    let inflections = inflections(curve, stations)?;
    let line = match (support, choice) {
        (HubSupport::Held, ThrustChoice::EqualEnds) => return Err(ElasticaError::EqualEndsHeld),
        (HubSupport::Free, _) if !inflections.is_empty() => horizontal_through(&inflections, length)?,
        (HubSupport::Free, ThrustChoice::EqualEnds) => equal_ends(stations, widths, length)?,
        (HubSupport::Free, ThrustChoice::LeastContrast) => least_contrast(stations, widths, &[], support)?,
        (HubSupport::Held, _) if inflections.len() >= 2 => line_through(&inflections, length)?,
        (HubSupport::Held, _) => least_contrast(stations, widths, &inflections, support)?,
    };
    let line = oriented(line, stations, widths, length, &inflections);
    let ratios: Vec<f64> =
        stations.iter().zip(widths).map(|(p, w)| line.modulus_at(p, *w, length, &inflections)).collect();
    let sampled = ratios.iter().fold(f64::NEG_INFINITY, |m, r| m.max(*r));
    if !sampled.is_finite() || ratios.iter().any(|r| r.is_nan() || *r <= 0.0) {
        return Err(mixed_sign(&ratios, stations, sampled, support, choice));
    }
    let largest = peak(&ratios);
    let smallest = 1.0 / peak(&ratios.iter().map(|r| 1.0 / r).collect::<Vec<_>>());
    Ok(InverseSolution {
        thrust: line.scaled(1.0 / largest),
        modulus_ratio: ratios.iter().map(|r| r / largest).collect(),
        contrast: largest / smallest,
        inflections,
    })
}

/// The largest value of a sampled function: the top of the parabola through the largest sample and its neighbours, so
/// that it does not depend on where the stations happen to lie.
fn peak(values: &[f64]) -> f64 {
    let mut top = 0;
    for (k, value) in values.iter().enumerate() {
        if *value > values[top] {
            top = k;
        }
    }
    let sample = values[top];
    if top == 0 || top + 1 >= values.len() {
        return sample;
    }
    let (before, after) = (values[top - 1], values[top + 1]);
    let bend = 2.0 * sample - before - after;
    let rise = if bend > 0.0 { (after - before).powi(2) / (8.0 * bend) } else { 0.0 };
    // A kink, not a smooth top: the parabola would overshoot.
    sample + rise.min(0.5 * (sample - before.min(after)))
}

/// Turns the sign of all forces such that most of the strip has a positive modulus.
fn oriented(
    line: ThrustLine,
    stations: &[MeridianPoint],
    widths: &[f64],
    length: f64,
    inflections: &[MeridianPoint],
) -> ThrustLine {
    let positive =
        stations.iter().zip(widths).filter(|(p, w)| line.modulus_at(p, **w, length, inflections) > 0.0).count();
    if 2 * positive >= stations.len() { line } else { line.scaled(-1.0) }
}

/// `E(0) = E(L)`: `h = (w_0 theta'_0 - w_L theta'_L) / z(L)`, `m_0 = w_0 theta'_0`.
fn equal_ends(stations: &[MeridianPoint], widths: &[f64], length: f64) -> Result<ThrustLine, ElasticaError> {
    let (Some(rim), Some(hub)) = (stations.first(), stations.last()) else {
        return Err(ElasticaError::Straight { largest_curvature: 0.0, length_mm: length });
    };
    let (Some(w_rim), Some(w_hub)) = (widths.first(), widths.last()) else {
        return Err(ElasticaError::NoWidth { radius_mm: 0.0, at_mm: 0.0 });
    };
    if hub.z.abs() <= COLLINEAR_SHARE * length {
        return Err(ElasticaError::EqualEndsUndetermined { height_mm: hub.z });
    }
    let anchor_moment = w_rim * rim.curvature;
    let horizontal = (anchor_moment - w_hub * hub.curvature) / hub.z;
    Ok(ThrustLine { anchor: [rim.x, rim.z], anchor_moment, horizontal, vertical: 0.0 })
}

/// The horizontal line through all inflections, which must share one height.
fn horizontal_through(inflections: &[MeridianPoint], length: f64) -> Result<ThrustLine, ElasticaError> {
    let at = &inflections[0];
    if inflections.iter().any(|i| (i.z - at.z).abs() > COLLINEAR_SHARE * length) {
        return Err(too_many(inflections, 1, HubSupport::Free));
    }
    Ok(ThrustLine { anchor: [at.x, at.z], anchor_moment: 0.0, horizontal: -1.0 / length, vertical: 0.0 })
}

/// The line through two inflections, on which all others must lie.
fn line_through(inflections: &[MeridianPoint], length: f64) -> Result<ThrustLine, ElasticaError> {
    let (a, b) = (&inflections[0], &inflections[inflections.len() - 1]);
    let (dx, dz) = (b.x - a.x, b.z - a.z);
    let distance = dx.hypot(dz);
    if distance <= COLLINEAR_SHARE * length {
        return Err(too_many(inflections, 2, HubSupport::Held));
    }
    // m = (dx (z - z_a) - dz (x - x_a)) / distance / length
    let line = ThrustLine {
        anchor: [a.x, a.z],
        anchor_moment: 0.0,
        horizontal: -dx / (distance * length),
        vertical: dz / (distance * length),
    };
    if inflections.iter().any(|i| line.moment(i.x, i.z).abs() > COLLINEAR_SHARE) {
        return Err(too_many(inflections, 2, HubSupport::Held));
    }
    Ok(line)
}

fn too_many(inflections: &[MeridianPoint], allowed: usize, support: HubSupport) -> ElasticaError {
    let positions: Vec<String> = inflections.iter().map(|i| format!("{:.2}", i.s)).collect();
    let help = match (support, inflections.len()) {
        (HubSupport::Free, 2) => help_for(HubSupport::Free),
        _ => help_for(HubSupport::Held),
    };
    ElasticaError::TooManyInflections {
        count: inflections.len(),
        positions: positions.join(", "),
        allowed,
        support,
        help,
    }
}

fn mixed_sign(
    ratios: &[f64],
    stations: &[MeridianPoint],
    largest: f64,
    support: HubSupport,
    choice: ThrustChoice,
) -> ElasticaError {
    let bad = |r: &f64| r.is_nan() || *r <= 0.0;
    let first = ratios.iter().position(bad).unwrap_or(0);
    let run = ratios[first..].iter().take_while(|r| bad(r)).count().max(1);
    let lowest = ratios.iter().fold(0.0_f64, |m, r| m.min(*r)) / largest.abs();
    let help = match (support, choice) {
        (HubSupport::Free, ThrustChoice::EqualEnds) => "choice = \"least-contrast\" or hub = \"held\" may avoid it",
        (HubSupport::Free, ThrustChoice::LeastContrast) => help_for(HubSupport::Free),
        (HubSupport::Held, _) => help_for(HubSupport::Held),
    };
    ElasticaError::MixedSign {
        from_mm: stations[first].s,
        to_mm: stations[first + run - 1].s,
        lowest,
        help: help.to_owned(),
    }
}
