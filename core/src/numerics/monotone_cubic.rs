//! Interpolation of monotone data that stays monotone.

/// A piecewise cubic through points with rising abscissae whose slopes are limited such that it never overshoots (Fritsch and
/// Carlson 1980, with the weighted harmonic mean of Fritsch and Butland 1984 for the slopes).
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct MonotoneCubic {
    x: Vec<f64>,
    y: Vec<f64>,
    slopes: Vec<f64>,
}

impl MonotoneCubic {
    /// Through at least two points; `None` where abscissae do not rise.
    pub(crate) fn new(x: Vec<f64>, y: Vec<f64>) -> Option<Self> {
        if x.len() < 2 || x.len() != y.len() || x.windows(2).any(|w| w[0].total_cmp(&w[1]).is_ge()) {
            return None;
        }
        let steps: Vec<f64> = x.windows(2).map(|w| w[1] - w[0]).collect();
        let secants: Vec<f64> = y.windows(2).zip(&steps).map(|(w, h)| (w[1] - w[0]) / h).collect();
        let last = x.len() - 1;
        let slopes = (0..x.len())
            .map(|i| match i {
                0 => end_slope(&steps, &secants, 0, 1),
                i if i == last => end_slope(&steps, &secants, last - 1, last.saturating_sub(2)),
                i if secants[i - 1] * secants[i] <= 0.0 => 0.0,
                i => {
                    let (before, after) = (2.0 * steps[i] + steps[i - 1], steps[i] + 2.0 * steps[i - 1]);
                    (before + after) / (before / secants[i - 1] + after / secants[i])
                }
            })
            .collect();
        Some(Self { x, y, slopes })
    }

    /// The value at `x`; outside the data, that of the nearest end.
    pub(crate) fn at(&self, x: f64) -> f64 {
        let last = self.x.len() - 1;
        if x <= self.x[0] {
            return self.y[0];
        }
        if x >= self.x[last] {
            return self.y[last];
        }
        let i = self.x.partition_point(|knot| *knot <= x).clamp(1, last) - 1;
        let h = self.x[i + 1] - self.x[i];
        let t = (x - self.x[i]) / h;
        let (s, t2) = (1.0 - t, t * t);
        (1.0 + 2.0 * t) * s * s * self.y[i] + t * s * s * h * self.slopes[i] + t2 * (3.0 - 2.0 * t) * self.y[i + 1]
            - t2 * s * h * self.slopes[i + 1]
    }
}

/// The slope of a parabola through the three points at an end, limited.
fn end_slope(steps: &[f64], secants: &[f64], near: usize, far: usize) -> f64 {
    let Some(next) = secants.get(far).filter(|_| far != near) else { return secants[near] };
    let slope = ((2.0 * steps[near] + steps[far]) * secants[near] - steps[near] * next) / (steps[near] + steps[far]);
    if slope * secants[near] <= 0.0 {
        0.0
    } else if secants[near] * next <= 0.0 && slope.abs() > 3.0 * secants[near].abs() {
        3.0 * secants[near]
    } else {
        slope
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn smooth_data_are_followed_and_ends_are_kept() {
        let x: Vec<f64> = (0..=16).map(|i| f64::from(i) / 16.0).collect();
        let curve = MonotoneCubic::new(x.clone(), x.iter().map(|x| x.exp()).collect()).unwrap();
        for i in 0..=100 {
            let x = f64::from(i) / 100.0;
            assert!((curve.at(x) - x.exp()).abs() < 1e-4, "{x}");
        }
        assert_eq!((curve.at(-1.0), curve.at(2.0)), (1.0, 1.0_f64.exp()));
        assert!(MonotoneCubic::new(vec![0.0, 0.0], vec![0.0, 1.0]).is_none());
        assert!((MonotoneCubic::new(vec![0.0, 2.0], vec![1.0, 5.0]).unwrap().at(0.5) - 2.0).abs() < 1e-14);
    }

    proptest! {
        #[test]
        fn rising_data_give_a_rising_curve(steps in prop::collection::vec((0.01_f64..1.0, 0.0_f64..10.0), 2..20)) {
            let (mut x, mut y) = (vec![0.0], vec![0.0]);
            for (dx, dy) in steps {
                x.push(x[x.len() - 1] + dx);
                y.push(y[y.len() - 1] + dy);
            }
            let end = x[x.len() - 1];
            let curve = MonotoneCubic::new(x, y).unwrap();
            let values: Vec<f64> = (0..=500).map(|i| curve.at(end * f64::from(i) / 500.0)).collect();
            prop_assert!(values.windows(2).all(|w| w[1] >= w[0] - 1e-9));
        }
    }
}
