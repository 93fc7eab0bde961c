//! Lines through parts of a curve.

use std::ops::Range;

/// Fewest rows of a window that the program chooses, or takes by default.
pub const LEAST_IN_WINDOW: usize = 6;
/// Coefficient of determination from which on a part counts as straight.
pub const STRAIGHT: f64 = 0.9995;
/// Share of the largest stress below which a straight part begins.
pub const FOOT: f64 = 0.1;
/// Share of the largest stress by which a straight part rises at least.
pub const LEAST_RISE: f64 = 0.05;
/// Share of its slope that a straight part may lose over its length.
pub const SOFTENING: f64 = 0.01;
/// Most beginnings that are tried; those of finer curves are spread evenly.
const BEGINNINGS: usize = 300;

/// A least-squares line of stress over strain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Line {
    /// Slope, MPa.
    pub slope: f64,
    /// Strain at which it meets no stress.
    pub zero: f64,
    /// Coefficient of determination.
    pub r_squared: f64,
}

/// Sums about the first row, from which a line follows without losing digits.
#[derive(Debug, Clone, Copy, Default)]
struct Sums {
    count: f64,
    origin: [f64; 2],
    mean: [f64; 2],
    xx: f64,
    xy: f64,
    yy: f64,
}

impl Sums {
    /// Welford's update.
    fn add(&mut self, strain: f64, stress: f64) {
        if self.count == 0.0 {
            self.origin = [strain, stress];
        }
        let (x, y) = (strain - self.origin[0], stress - self.origin[1]);
        self.count += 1.0;
        let [dx, dy] = [x - self.mean[0], y - self.mean[1]];
        self.mean[0] += dx / self.count;
        self.mean[1] += dy / self.count;
        self.xx += dx * (x - self.mean[0]);
        self.xy += dx * (y - self.mean[1]);
        self.yy += dy * (y - self.mean[1]);
    }

    /// The line, where strains differ and stress rises with them.
    fn line(&self) -> Option<Line> {
        let slope = self.xy / self.xx;
        if !(slope > 0.0 && slope.is_finite() && self.yy > 0.0) {
            return None;
        }
        let zero = self.origin[0] + self.mean[0] - (self.origin[1] + self.mean[1]) / slope;
        Some(Line { slope, zero, r_squared: (slope * self.xy / self.yy).min(1.0) })
    }
}

/// The line through some rows; `None` where strains do not differ or stress does not rise.
#[must_use]
pub fn line(strains: &[f64], stresses: &[f64]) -> Option<Line> {
    let mut sums = Sums::default();
    strains.iter().zip(stresses).for_each(|(e, s)| sums.add(*e, *s));
    sums.line()
}

/// Rows at which a straight part may begin: those up to the first that carries [`FOOT`] of the largest stress. Later ones would
/// take the hardening of a plastic or the upturn of a rubber for its beginning.
fn beginnings(stresses: &[f64], peak: usize) -> impl Iterator<Item = usize> {
    let foot = stresses[..=peak].iter().position(|s| *s >= FOOT * stresses[peak]).unwrap_or(peak);
    (0..=foot).step_by(1 + foot / BEGINNINGS)
}

/// The steepest line over `width` of strain that begins in the foot of the curve and ends before its peak: the straight part
/// behind a toe. Of equal ones the first.
#[must_use]
pub fn steepest(strains: &[f64], stresses: &[f64], peak: usize, width: f64, least: usize) -> Option<Line> {
    let mut best: Option<Line> = None;
    for start in beginnings(stresses, peak) {
        let end = start + strains[start..=peak].partition_point(|e| *e <= (strains[start] + width) * (1.0 + 1e-12));
        if end - start < least {
            continue;
        }
        let found = line(&strains[start..end], &stresses[start..end]);
        if let Some(found) = found.filter(|f| best.is_none_or(|b| f.slope > b.slope * (1.0 + 1e-9))) {
            best = Some(found);
        }
    }
    best
}

/// The straight part at the beginning of a curve: of all parts that begin in its foot, end before its peak, are [`STRAIGHT`] and
/// rise by [`LEAST_RISE`] of the largest stress, the steepest of the shortest; and on from there as long as it stays straight and
/// its slope within [`SOFTENING`].
#[must_use]
pub fn straight_part(strains: &[f64], stresses: &[f64], peak: usize) -> Option<(Range<usize>, Line)> {
    let rise = LEAST_RISE * stresses[peak];
    let mut best: Option<(Range<usize>, Line)> = None;
    for start in beginnings(stresses, peak) {
        let long_enough = |i: &usize| i + 1 >= start + LEAST_IN_WINDOW && stresses[*i] - stresses[start] >= rise;
        let Some(end) = (start..=peak).find(long_enough) else { continue };
        let found = line(&strains[start..=end], &stresses[start..=end]).filter(|l| l.r_squared >= STRAIGHT);
        if let Some(found) = found.filter(|f| best.as_ref().is_none_or(|(_, b)| f.slope > b.slope * (1.0 + 1e-9))) {
            best = Some((start..end + 1, found));
        }
    }
    let (shortest, steepest) = best?;
    let mut longest = (shortest.clone(), steepest);
    let mut sums = Sums::default();
    for i in shortest.start..=peak {
        sums.add(strains[i], stresses[i]);
        if i < shortest.end {
            continue;
        }
        let straight = |l: &Line| l.r_squared >= STRAIGHT && l.slope >= (1.0 - SOFTENING) * steepest.slope;
        match sums.line().filter(straight) {
            Some(found) => longest = (shortest.start..i + 1, found),
            None => break,
        }
    }
    Some(longest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_those_of_closed_forms() {
        let strains: Vec<f64> = (0..20).map(|i| 7.0 + 1e-4 * f64::from(i)).collect();
        let on_line: Vec<f64> = strains.iter().map(|e| 2000.0 * (e - 6.9)).collect();
        let found = line(&strains, &on_line).unwrap();
        assert!((found.slope / 2000.0 - 1.0).abs() < 1e-9 && (found.zero - 6.9).abs() < 1e-9);
        assert!((found.r_squared - 1.0).abs() < 1e-12);
        // y = x^2 over [0, 1]: slope 1, zero 1/6, R^2 = 15/16.
        let x: Vec<f64> = (0..=20_000).map(|i| f64::from(i) / 20_000.0).collect();
        let y: Vec<f64> = x.iter().map(|x| x * x).collect();
        let square = line(&x, &y).unwrap();
        assert!((square.slope - 1.0).abs() < 1e-6 && (square.zero - 1.0 / 6.0).abs() < 1e-4);
        assert!((square.r_squared - 15.0 / 16.0).abs() < 1e-4);
        assert_eq!(line(&[0.0, 0.0], &[0.0, 1.0]), None);
        assert_eq!(line(&[0.0, 1.0], &[1.0, 0.0]), None);
    }

    #[test]
    fn the_beginning_is_found_and_not_the_hardening() {
        // 10 MPa to 5 %, then 4 MPa to 60 %: the second part is longer, but no beginning.
        let strains: Vec<f64> = (0..=120).map(|i| 0.005 * f64::from(i)).collect();
        let stress = |e: &f64| 10.0 * e.min(0.05) + 4.0 * (e - 0.05).max(0.0);
        let stresses: Vec<f64> = strains.iter().map(stress).collect();
        let (rows, found) = straight_part(&strains, &stresses, 120).unwrap();
        assert!(rows.start == 0 && (11..=13).contains(&rows.end), "{rows:?}");
        assert!((found.slope - 10.0).abs() < 0.2, "{found:?}");
        let steep = steepest(&strains, &stresses, 120, 0.03, 3).unwrap();
        assert!((steep.slope - 10.0).abs() < 1e-9 && steep.zero.abs() < 1e-12);
    }
}
