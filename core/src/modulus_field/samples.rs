//! The stations, checked, and the denser grid on which every fit is made and judged.

use super::ModulusFieldError;

/// Fewest stations that describe a modulus.
pub(super) const MINIMUM_STATIONS: usize = 20;
/// Range of moduli in MPa; far beyond any material, and far inside what `exp` can represent.
pub(super) const MODULUS_RANGE_MPA: [f64; 2] = [1e-30, 1e30];
/// Range of strip lengths in mm.
pub(super) const LENGTH_RANGE_MM: [f64; 2] = [1e-6, 1e9];
/// How far a station may lie from its place on the even grid, as a share of the length.
const STATION_TOLERANCE: f64 = 1e-6;
/// Intervals of the dense grid, at the least.
const MINIMUM_INTERVALS: usize = 2000;

/// `ln E` on an even grid over the strip, at least twice as dense as the stations.
pub(super) struct Samples {
    /// Strip length `L`, mm.
    pub length: f64,
    /// `u = 2 X / L - 1` in `[-1, 1]`.
    pub u: Vec<f64>,
    /// `ln(E / MPa)`.
    pub log_modulus: Vec<f64>,
    /// `E`, MPa.
    pub modulus: Vec<f64>,
}

impl Samples {
    /// Checks the stations and interpolates `ln E` between them by the cubic through the four nearest stations.
    ///
    /// The logarithm keeps the interpolant positive; the local cubic is fourth order for smooth data and does not spread
    /// the noise of one station beyond its neighbours.
    pub fn new(s_mm: &[f64], modulus_mpa: &[f64], length_mm: f64) -> Result<Self, ModulusFieldError> {
        check(s_mm, modulus_mpa, length_mm)?;
        let stations: Vec<f64> = modulus_mpa.iter().map(|e| e.ln()).collect();
        let intervals = stations.len() - 1;
        let refinement = MINIMUM_INTERVALS.div_ceil(intervals).max(2);
        let total = intervals * refinement;
        let mut u = Vec::with_capacity(total + 1);
        let mut log_modulus = Vec::with_capacity(total + 1);
        let mut modulus = Vec::with_capacity(total + 1);
        for i in 0..=total {
            let (station, part) = (i / refinement, i % refinement);
            u.push(2.0 * i as f64 / total as f64 - 1.0);
            if part == 0 {
                log_modulus.push(stations[station]);
                modulus.push(modulus_mpa[station]);
            } else {
                let first = station.saturating_sub(1).min(stations.len() - 4);
                let t = (station - first) as f64 + part as f64 / refinement as f64;
                let window = &stations[first..first + 4];
                let y = cubic(window, t);
                log_modulus.push(y);
                // Where nothing changes, not even the last bit does: a constant has no error.
                let level = window.iter().all(|&v| v == window[0]);
                modulus.push(if level { modulus_mpa[first] } else { y.exp() });
            }
        }
        Ok(Self { length: length_mm, u, log_modulus, modulus })
    }

    /// The position `X` in mm of grid point `i`.
    pub fn position(&self, i: usize) -> f64 {
        0.5 * self.length * (1.0 + self.u[i])
    }

    /// Largest relative error of `fit(X)` over the grid; infinite where the fit is not a positive number.
    pub fn largest_error(&self, fit: impl Fn(f64) -> f64) -> f64 {
        let mut largest = 0.0_f64;
        for (i, &e) in self.modulus.iter().enumerate() {
            let value = fit(self.position(i));
            if !(value > 0.0 && value.is_finite()) {
                return f64::INFINITY;
            }
            largest = largest.max((value / e - 1.0).abs());
        }
        largest
    }
}

/// Lagrange's cubic through `y` at 0, 1, 2, 3, at `t`.
fn cubic(y: &[f64], t: f64) -> f64 {
    let (a, b, c) = (t - 1.0, t - 2.0, t - 3.0);
    -y[0] * a * b * c / 6.0 + y[1] * t * b * c / 2.0 - y[2] * t * a * c / 2.0 + y[3] * t * a * b / 6.0
}

fn check(s_mm: &[f64], modulus_mpa: &[f64], length_mm: f64) -> Result<(), ModulusFieldError> {
    let within = |value: f64, [low, high]: [f64; 2]| value >= low && value <= high;
    if !within(length_mm, LENGTH_RANGE_MM) {
        return Err(ModulusFieldError::Length { value_mm: length_mm });
    }
    if s_mm.len() != modulus_mpa.len() {
        return Err(ModulusFieldError::CountMismatch { stations: s_mm.len(), moduli: modulus_mpa.len() });
    }
    if s_mm.len() < MINIMUM_STATIONS {
        return Err(ModulusFieldError::TooFewStations { count: s_mm.len() });
    }
    let step = length_mm / (s_mm.len() - 1) as f64;
    for (index, (&s, &modulus)) in s_mm.iter().zip(modulus_mpa).enumerate() {
        let expected_mm = index as f64 * step;
        // Written so that a station that is not a number fails too.
        let in_place = (s - expected_mm).abs() <= STATION_TOLERANCE * length_mm;
        if !in_place {
            return Err(ModulusFieldError::Station { index, value_mm: s, expected_mm });
        }
        if !within(modulus, MODULUS_RANGE_MPA) {
            return Err(ModulusFieldError::Modulus { s_mm: s, value_mpa: modulus });
        }
    }
    Ok(())
}
