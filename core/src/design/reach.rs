//! Whether the phases reach the contrast that a design needs.

use super::{Body, STATIONS, thrust, widths};
use crate::elastica::inverse::{self, HubSupport, ThrustChoice};
use crate::error::{Error, Infeasible};
use crate::input::DesignInput;
use crate::micromechanics::PhaseSet;
use crate::target::Target;

/// Refuses contrasts out of the phases' reach, and says which other line of thrust would be within it.
pub(super) fn check(input: &DesignInput, phases: &PhaseSet, body: &Body, target: Option<&Target>) -> Result<(), Error> {
    let (contrast, reach) = (body.contrast(), phases.reach());
    if contrast <= reach * (1.0 + 1e-9) {
        return Ok(());
    }
    let length = input.strips.length_mm;
    let (softest_mm, stiffest_mm) = match body {
        Body::Dome { solution, .. } => {
            let by = |a: &(usize, &f64), b: &(usize, &f64)| a.1.total_cmp(b.1);
            let ratios = || solution.modulus_ratio.iter().enumerate();
            let at = |i: Option<(usize, &f64)>| i.map_or(0.0, |(i, _)| length * i as f64 / (STATIONS - 1) as f64);
            (at(ratios().min_by(by)), at(ratios().max_by(by)))
        }
        Body::Strip { middle_ratio, .. } if *middle_ratio > 1.0 => (0.0, 0.5 * length),
        Body::Strip { .. } => (0.5 * length, 0.0),
    };
    let mut helps = Vec::new();
    if let Some(target) = target {
        let hub_x = target.stations.last().map_or(0.0, |p| p.x);
        let now = thrust(input);
        for (other, words) in [
            ((HubSupport::Free, ThrustChoice::LeastContrast), "choice = \"least-contrast\""),
            ((HubSupport::Held, ThrustChoice::LeastContrast), "a held hub (hub = \"held\")"),
        ] {
            let found = widths(input, &target.stations, hub_x)
                .and_then(|w| inverse::solve(target.curve.as_ref(), &target.stations, &w, other.0, other.1));
            if let Ok(found) = found.as_ref().map(|s| s.contrast)
                && other != now
                && found <= reach
            {
                helps.push(format!("{words} needs only {found:.3}"));
            }
        }
    }
    helps.push(format!("use phases whose moduli differ by a factor of {contrast:.2} or more"));
    let names: Vec<String> = phases.phases().iter().map(|p| format!("{} ({} MPa)", p.name, p.modulus_mpa)).collect();
    Err(Error::infeasible(
        &input.name,
        Infeasible::Contrast {
            contrast,
            reach,
            softest_mm,
            stiffest_mm,
            phases: names.join(" and "),
            help: helps.join(", or "),
        },
    ))
}
