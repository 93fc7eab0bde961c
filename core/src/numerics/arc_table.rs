//! Positions along a curve that is known by its inclination alone.

use super::quadrature::gauss_legendre;

/// Cached positions `x(s) = int cos(theta)`, `z(s) = int sin(theta)` at evenly spaced arc lengths.
///
/// A position between two cached ones costs one five-point quadrature.
#[derive(Debug, Clone)]
pub(crate) struct ArcTable {
    step: f64,
    positions: Vec<[f64; 2]>,
}

impl ArcTable {
    /// Integrates `inclination` over `[0, length]` in `intervals` pieces.
    pub(crate) fn new(length: f64, intervals: usize, inclination: impl Fn(f64) -> f64) -> Self {
        let step = length / intervals as f64;
        let mut positions = Vec::with_capacity(intervals + 1);
        let mut here = [0.0; 2];
        positions.push(here);
        for i in 0..intervals {
            here = advance(here, i as f64 * step, (i + 1) as f64 * step, &inclination);
            positions.push(here);
        }
        Self { step, positions }
    }

    /// `[x, z]` at arc length `s`, which must lie in the table's range.
    pub(crate) fn position(&self, s: f64, inclination: impl Fn(f64) -> f64) -> [f64; 2] {
        let last = self.positions.len() - 1;
        let index = ((s / self.step).round().max(0.0) as usize).min(last);
        let start = index as f64 * self.step;
        if s == start { self.positions[index] } else { advance(self.positions[index], start, s, &inclination) }
    }
}

fn advance(from: [f64; 2], a: f64, b: f64, inclination: &impl Fn(f64) -> f64) -> [f64; 2] {
    let [dx, dz] = gauss_legendre(a, b, |s| {
        let (sin, cos) = inclination(s).sin_cos();
        [cos, sin]
    });
    [from[0] + dx, from[1] + dz]
}

#[cfg(test)]
mod tests {
    use super::ArcTable;

    #[test]
    fn a_circular_arc_has_its_closed_form_position_everywhere() {
        let radius = 40.0;
        let length = radius * std::f64::consts::FRAC_PI_2;
        let inclination = |s: f64| std::f64::consts::FRAC_PI_2 - s / radius;
        let table = ArcTable::new(length, 64, inclination);
        for i in 0..=97 {
            let s = length * f64::from(i) / 97.0;
            let [x, z] = table.position(s, inclination);
            let angle = s / radius;
            assert!((x - radius * (1.0 - angle.cos())).abs() < 1e-11);
            assert!((z - radius * angle.sin()).abs() < 1e-11);
        }
    }
}
