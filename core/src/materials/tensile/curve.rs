//! A tensile curve up to where the specimen failed.

use crate::input::InputError;

/// Fewest rows of a curve.
pub const LEAST_ROWS: usize = 3;
/// Stress over that of the row before, beyond the peak, below which the specimen has failed.
pub const DROP: f64 = 0.8;
/// Stress over the peak, beyond it, below which the specimen has failed.
pub const LEFT: f64 = 0.5;

/// Strains and engineering stresses up to the failure of the specimen, strains never falling.
#[derive(Debug, Clone, PartialEq)]
pub struct TensileCurve {
    file: String,
    strains: Vec<f64>,
    stresses_mpa: Vec<f64>,
    /// Rows after the failure, which are not used.
    rows_after: usize,
}

impl TensileCurve {
    /// A curve from rows in the order of the test. The specimen has failed after the first row, from that of the largest stress on,
    /// that is followed by a stress of less than [`DROP`] of its own or [`LEFT`] of the largest; later rows are left out.
    ///
    /// # Errors
    /// [`InputError`] for too few rows, for stresses none of which is positive, and for a strain that falls before the failure.
    pub fn new(file: &str, strains: Vec<f64>, stresses_mpa: Vec<f64>, lines: &[usize]) -> Result<Self, InputError> {
        let whole = |problem: String, help: &str| InputError::new("", "", problem).help(help).in_file(file);
        let rows = strains.len().min(stresses_mpa.len());
        if rows < LEAST_ROWS {
            return Err(whole(format!("this file holds {rows} row(s); at least {LEAST_ROWS} are needed"), ""));
        }
        let peak = peak(&stresses_mpa);
        let largest = stresses_mpa[peak];
        if largest <= 0.0 {
            return Err(whole("no stress is positive".to_owned(), "tension is positive"));
        }
        let fails = |i: &usize| stresses_mpa[i + 1] < DROP * stresses_mpa[*i] || stresses_mpa[i + 1] < LEFT * largest;
        let last = (peak..rows - 1).find(fails).unwrap_or(rows - 1);
        if let Some(i) = (1..=last).find(|i| strains[*i] < strains[i - 1]) {
            let problem = format!("the strain falls, from {} before", strains[i - 1]);
            let mut error = InputError::new("strain", strains[i], problem).help(
                "up to the failure strains must not fall: leave out rows of unloading, or smooth the extensometer",
            );
            error.line = lines.get(i).copied();
            return Err(error.in_file(file));
        }
        let (mut strains, mut stresses_mpa) = (strains, stresses_mpa);
        strains.truncate(last + 1);
        stresses_mpa.truncate(last + 1);
        Ok(Self { file: file.to_owned(), strains, stresses_mpa, rows_after: rows - 1 - last })
    }

    /// The file as the user named it.
    #[must_use]
    pub fn file(&self) -> &str {
        &self.file
    }

    /// Strains as measured.
    #[must_use]
    pub fn strains(&self) -> &[f64] {
        &self.strains
    }

    /// Force over the area before the test, MPa.
    #[must_use]
    pub fn stresses_mpa(&self) -> &[f64] {
        &self.stresses_mpa
    }

    /// Rows after the failure, which are left out.
    #[must_use]
    pub fn rows_after(&self) -> usize {
        self.rows_after
    }

    /// Place of the largest stress, the first of equal ones.
    #[must_use]
    pub fn peak(&self) -> usize {
        peak(&self.stresses_mpa)
    }
}

fn peak(stresses: &[f64]) -> usize {
    (0..stresses.len()).fold(0, |best, i| if stresses[i] > stresses[best] { i } else { best })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(rows: &[[f64; 2]]) -> Result<TensileCurve, String> {
        let lines: Vec<usize> = (2..rows.len() + 2).collect();
        let [strains, stresses] = [0, 1].map(|k| rows.iter().map(|row| row[k]).collect());
        TensileCurve::new("a.csv", strains, stresses, &lines).map_err(|e| e.to_string())
    }

    #[test]
    fn rows_after_the_failure_are_left_out() {
        let broken = curve(&[[0.0, 0.0], [0.1, 1.0], [0.2, 2.0], [0.3, 1.9], [0.3, 0.1], [0.1, 0.0]]).unwrap();
        assert_eq!((broken.strains().len(), broken.rows_after(), broken.peak()), (4, 2, 2));
        // A slow end below half of the peak.
        let torn = curve(&[[0.0, 0.0], [0.1, 2.0], [0.2, 1.7], [0.3, 1.4], [0.4, 1.15], [0.5, 0.95]]).unwrap();
        assert_eq!((torn.strains().len(), torn.rows_after()), (5, 1));
        let whole = curve(&[[0.0, 0.0], [0.1, 1.0], [0.2, 2.0]]).unwrap();
        assert_eq!((whole.strains().len(), whole.rows_after()), (3, 0));
    }

    #[test]
    fn strains_that_fall_are_refused_with_their_line() {
        let error = curve(&[[0.0, 0.0], [0.2, 1.0], [0.1, 2.0], [0.3, 3.0]]).unwrap_err();
        assert!(error.contains("a.csv:4: strain = 0.1: the strain falls, from 0.2"), "{error}");
        assert!(curve(&[[0.0, 0.0], [0.1, -1.0], [0.2, -2.0]]).unwrap_err().contains("tension is positive"));
        assert!(curve(&[[0.0, 0.0], [0.1, 1.0]]).unwrap_err().contains("2 row(s)"));
    }
}
