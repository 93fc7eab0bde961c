//! Which values a point takes.

use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::{Rng, SeedableRng};
use serde_json::Value;

use super::MOST_POINTS;
use super::axis::AxisInput;
use super::input::{SampleInput, SweepInput};
use crate::input::InputError;

/// The points of a sweep, by number.
#[derive(Debug, Clone)]
pub struct Sampling {
    axes: Vec<AxisInput>,
    plan: Plan,
}

#[derive(Debug, Clone)]
enum Plan {
    /// Values of every axis; the last one varies fastest.
    Grid { counts: Vec<u64>, points: u64 },
    /// Share of the range of every axis, for every point.
    Hypercube { shares: Vec<Vec<f64>>, points: u64 },
}

impl Sampling {
    /// The points of a sweep.
    ///
    /// # Errors
    /// [`InputError`] for too many points, none, or a range without a count.
    pub fn new(input: &SweepInput) -> Result<Self, InputError> {
        let axes = input.axes.clone();
        let plan = match input.sample {
            SampleInput::Grid => {
                let counts: Vec<u64> = axes.iter().enumerate().map(|(i, a)| a.grid(i)).collect::<Result<_, _>>()?;
                let points = counts.iter().try_fold(1_u64, |p, n| p.checked_mul(*n)).filter(|p| *p <= MOST_POINTS);
                let Some(points) = points else {
                    let shown = counts.iter().map(u64::to_string).collect::<Vec<_>>().join(" x ");
                    let problem = format!("these are more than {MOST_POINTS} points");
                    return Err(InputError::new("axes", shown, problem).help("use fewer values or a Latin hypercube"));
                };
                Plan::Grid { counts, points }
            }
            SampleInput::LatinHypercube { points, seed } => {
                let most = MOST_POINTS / axes.len().max(1) as u64;
                if !(1..=most).contains(&points) {
                    let problem = format!("a Latin hypercube of {} axes has 1 to {most} points", axes.len());
                    return Err(InputError::new("sample.points", points, problem));
                }
                Plan::Hypercube { shares: hypercube(axes.len(), points, seed), points }
            }
        };
        Ok(Self { axes, plan })
    }

    /// Number of points.
    #[must_use]
    pub fn points(&self) -> u64 {
        match &self.plan {
            Plan::Grid { points, .. } | Plan::Hypercube { points, .. } => *points,
        }
    }

    /// Values of a point, one an axis.
    #[must_use]
    pub fn values(&self, point: u64) -> Vec<Value> {
        match &self.plan {
            Plan::Grid { counts, .. } => {
                let mut rest = point;
                let mut places: Vec<u64> = counts
                    .iter()
                    .rev()
                    .map(|n| {
                        let place = rest % n;
                        rest /= n;
                        place
                    })
                    .collect();
                places.reverse();
                let value = |(axis, (place, count)): (&AxisInput, (u64, &u64))| match &axis.values {
                    Some(values) => values.get(place as usize).cloned().unwrap_or_default(),
                    None => axis.at(place as f64 / (count - 1) as f64),
                };
                self.axes.iter().zip(places.into_iter().zip(counts)).map(value).collect()
            }
            Plan::Hypercube { shares, .. } => {
                let share = |k: usize| shares[k][point as usize];
                self.axes.iter().enumerate().map(|(k, axis)| axis.at(share(k))).collect()
            }
        }
    }
}

/// A Latin hypercube: on every axis each of `points` equal parts holds one point, at a random place within it.
pub(crate) fn hypercube(axes: usize, points: u64, seed: u64) -> Vec<Vec<f64>> {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
    let unit = |random: &mut Xoshiro256PlusPlus| (random.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
    (0..axes)
        .map(|_| {
            let mut parts: Vec<u32> = (0..points as u32).collect();
            for i in (1..parts.len()).rev() {
                parts.swap(i, (unit(&mut random) * (i + 1) as f64) as usize);
            }
            parts.iter().map(|part| (f64::from(*part) + unit(&mut random)) / points as f64).collect()
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_part_of_a_hypercube_holds_one_point() {
        for axis in hypercube(4, 257, 7) {
            let mut parts: Vec<usize> = axis.iter().map(|s| (s * 257.0) as usize).collect();
            parts.sort_unstable();
            assert_eq!(parts, (0..257).collect::<Vec<_>>());
        }
        assert_eq!(hypercube(2, 20, 3), hypercube(2, 20, 3));
        assert_ne!(hypercube(2, 20, 3), hypercube(2, 20, 4));
    }
}
