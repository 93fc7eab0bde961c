//! `*CONDUCTIVITY` and what belongs to heat and current: materials, initial temperature, loads, procedures.
//!
//! In mm, tonne, s and K a power is in mW = N mm/s. So a thermal conductivity of 1 W/(m K) is 1 N/(s K); a specific heat of
//! 1 J/(kg K) is 1e6 mm^2/(s^2 K). With the current in A, Joule's heat is in mW where the potential is in mV; then an
//! electrical conductivity of 1 S/m = 1 A/(V m) is 1e-6 A/(mV mm).

use crate::deck::DeckError;
use crate::deck::number::real;
use crate::deck::sink::Sink;
use crate::materials::Material;

/// How a region conducts, in the decks' units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Conductor {
    /// Thermal conductivity, N/(s K).
    pub thermal: Option<f64>,
    /// Density, tonne/mm^3.
    pub density: Option<f64>,
    /// Specific heat, mm^2/(s^2 K).
    pub specific_heat: Option<f64>,
    /// Electrical conductivity, A/(mV mm).
    pub electrical: Option<f64>,
}

impl Conductor {
    /// One phase.
    pub(crate) fn of(material: &Material) -> Self {
        Self {
            thermal: material.conductivity_w_mk,
            density: material.density_tonne_mm3(),
            specific_heat: material.specific_heat_j_kgk.map(|c| c * 1e6),
            electrical: material.electrical_conductivity_s_m.map(|s| s * 1e-6),
        }
    }

    /// Phases side by side along the strip: conductivities and heat capacities mix by volume, so the specific heat by mass.
    pub(crate) fn mixed(phases: &[Material], fractions: &[f64]) -> Self {
        let parts = || phases.iter().map(Self::of).zip(fractions).filter(|(_, f)| **f > 0.0);
        let mean = |value: &dyn Fn(&Self) -> Option<f64>| parts().map(|(part, f)| Some(value(&part)? * f)).sum();
        let density: Option<f64> = mean(&|c| c.density);
        let heat: Option<f64> = mean(&|c| Some(c.density? * c.specific_heat?));
        Self {
            thermal: mean(&|c| c.thermal),
            density,
            specific_heat: heat.zip(density).map(|(heat, density)| heat / density),
            electrical: mean(&|c| c.electrical),
        }
    }

    /// Thermal diffusivity `k/(rho c)`, mm^2/s.
    pub(crate) fn diffusivity(&self) -> Option<f64> {
        Some(self.thermal? / (self.density? * self.specific_heat?))
    }
}

/// A conducting material; what it has no value for is left out. With `current`, electrical conduction without Joule's heat.
pub(crate) fn material(sink: &mut Sink<'_>, name: &str, conductor: &Conductor, current: bool) -> Result<(), DeckError> {
    sink.line(&format!("*MATERIAL, NAME={name}"))?;
    let mut property = |keyword: &str, value: Option<f64>| match value {
        Some(value) => {
            sink.line(keyword)?;
            sink.line(&real(value))
        }
        None => Ok(()),
    };
    property("*DENSITY", conductor.density)?;
    property("*CONDUCTIVITY", conductor.thermal)?;
    property("*SPECIFIC HEAT", conductor.specific_heat)?;
    if current {
        property("*ELECTRICAL CONDUCTIVITY", conductor.electrical)?;
        property("*JOULE HEAT FRACTION", Some(0.0))?;
    }
    Ok(())
}

/// Gives the nodes of a set a temperature, K.
pub(crate) fn initial_temperature(sink: &mut Sink<'_>, set: &str, kelvin: f64) -> Result<(), DeckError> {
    sink.line("*INITIAL CONDITIONS, TYPE=TEMPERATURE")?;
    sink.line(&format!("{set},{}", real(kelvin)))
}

/// Holds degree of freedom `dof` of a node set at a value: 9 is the potential, 11 the temperature.
pub(crate) fn held(sink: &mut Sink<'_>, set: &str, dof: u8, value: f64) -> Result<(), DeckError> {
    sink.line("*BOUNDARY")?;
    sink.line(&format!("{set},{dof},{dof},{}", real(value)))
}

/// Named times, s, eight a line.
pub(crate) fn time_points(sink: &mut Sink<'_>, name: &str, times: &[f64]) -> Result<(), DeckError> {
    sink.line(&format!("*TIME POINTS, NAME={name}"))?;
    for times in times.chunks(8) {
        sink.line(&times.iter().map(|t| real(*t)).collect::<Vec<_>>().join(","))?;
    }
    Ok(())
}

/// How a transient step goes forward, s and K.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Transient {
    /// Time in which the rim gets hot.
    pub rise: f64,
    /// Duration.
    pub period: f64,
    /// Largest change of a temperature in one increment.
    pub change: f64,
    /// Times at which temperatures are wanted; the last one is the period.
    pub times: Vec<f64>,
}
