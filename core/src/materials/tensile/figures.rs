//! Modulus, yield and break of one tensile curve.

use serde::Serialize;

use super::TensileCurve;
use super::straight::{LEAST_IN_WINDOW, Line, line, steepest, straight_part};
use crate::input::InputError;

/// Offset of the yield strength.
pub const OFFSET: f64 = 0.002;
/// Fewest rows of a window that the user gives.
pub const LEAST_GIVEN: usize = 3;
/// Coefficient of determination below which the window is worth a warning.
const DOUBTFUL: f64 = 0.99;
/// Share by which the default window's line may be softer than the steepest.
const SOFTER_IN_TOE: f64 = 0.05;
/// Most times the window follows the zero of its own line.
const ROUNDS: usize = 20;

/// Strains between which the modulus is taken, from the corrected zero on.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Window {
    /// Where it begins.
    pub low: f64,
    /// Where it ends.
    pub high: f64,
}

impl Default for Window {
    /// That of ISO 527.
    fn default() -> Self {
        Self { low: 0.0005, high: 0.0025 }
    }
}

impl Window {
    /// A window.
    ///
    /// # Errors
    /// [`InputError`] for strains that are not `0 <= low < high`.
    pub fn new(low: f64, high: f64) -> Result<Self, InputError> {
        if low >= 0.0 && high > low && high.is_finite() {
            return Ok(Self { low, high });
        }
        Err(InputError::new("window", format!("{low} {high}"), "this must be two rising strains, none negative")
            .help("such as 0.0005 0.0025"))
    }
}

/// Where a window comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum WindowChoice {
    /// That of ISO 527.
    Default,
    /// The user's.
    Given,
    /// The straight part that was found, because the default one holds too few rows or part of a toe.
    Automatic,
}

impl WindowChoice {
    /// A word for readers.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Default => "default",
            Self::Given => "given",
            Self::Automatic => "automatic",
        }
    }
}

/// Where the curve meets the line of the offset.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct YieldPoint {
    /// Strain from the corrected zero on.
    pub strain: f64,
    /// Stress, MPa.
    pub strength_mpa: f64,
}

/// What a tensile curve says of its material.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TensileFigures {
    /// The file.
    pub file: String,
    /// Rows up to the failure.
    pub rows: usize,
    /// Rows after it, which are left out.
    pub rows_after: usize,
    /// Young's modulus: slope of the least-squares line over the window, MPa.
    pub modulus_mpa: f64,
    /// Coefficient of determination of that line.
    pub r_squared: f64,
    /// The window.
    pub window: Window,
    /// Where it comes from.
    pub window_choice: WindowChoice,
    /// Rows in it.
    pub window_rows: usize,
    /// Measured strain that counts as none: where the line meets no stress.
    pub zero_strain: f64,
    /// 0.2 % offset yield; `None` where the curve ends before.
    pub yield_point: Option<YieldPoint>,
    /// Largest stress, MPa.
    pub strength_mpa: f64,
    /// Strain at the last row before the failure.
    pub break_strain: f64,
    /// What the user should know.
    pub warnings: Vec<String>,
}

/// Takes modulus, yield and break from a curve. Without a window that of ISO 527 is taken where it holds enough rows and no toe, else the
/// straight part at the curve's beginning ([`straight_part`]).
///
/// # Errors
/// [`InputError`] naming the file, where no window can be laid.
pub fn evaluate(curve: &TensileCurve, window: Option<Window>) -> Result<TensileFigures, InputError> {
    let (strains, stresses) = (curve.strains(), curve.stresses_mpa());
    let (line, window, choice, rows) = match window {
        Some(given) => {
            let (line, rows) = within(curve, given, LEAST_GIVEN).ok_or_else(|| {
                let problem =
                    format!("it holds fewer than {LEAST_GIVEN} rows before the peak, or stress does not rise in it");
                InputError::new("window", format!("{} {}", given.low, given.high), problem)
                    .help("choose another one, or leave it out")
                    .in_file(curve.file())
            })?;
            (line, given, WindowChoice::Given, rows)
        }
        None => match within(curve, Window::default(), LEAST_IN_WINDOW).filter(|(line, _)| !in_toe(curve, line)) {
            Some((line, rows)) => (line, Window::default(), WindowChoice::Default, rows),
            None => {
                let (rows, line) = straight_part(strains, stresses, curve.peak()).ok_or_else(|| {
                    InputError::new("window", "", "no straight part was found at the beginning of the curve")
                        .help("give the strains between which the modulus is taken with --window LOW HIGH")
                        .in_file(curve.file())
                })?;
                let window = Window { low: strains[rows.start] - line.zero, high: strains[rows.end - 1] - line.zero };
                (line, window, WindowChoice::Automatic, rows.len())
            }
        },
    };
    let mut warnings = Vec::new();
    if line.r_squared < DOUBTFUL {
        warnings.push(format!(
            "{}: the curve is not straight between strains of {} and {} (R2 = {:.4}); choose another --window",
            curve.file(),
            window.low,
            window.high,
            line.r_squared
        ));
    }
    let last = strains.len() - 1;
    Ok(TensileFigures {
        file: curve.file().to_owned(),
        rows: strains.len(),
        rows_after: curve.rows_after(),
        modulus_mpa: line.slope,
        r_squared: line.r_squared,
        window,
        window_choice: choice,
        window_rows: rows,
        zero_strain: line.zero,
        yield_point: yield_point(strains, stresses, &line),
        strength_mpa: stresses[curve.peak()],
        break_strain: strains[last] - line.zero,
        warnings,
    })
}

/// The line over a window that counts from the corrected zero, and how many rows it is through. The zero is first that of the
/// steepest line as wide as the window (the straight part behind a toe), then that of the window's own line, until its rows
/// stay the same.
fn within(curve: &TensileCurve, window: Window, least: usize) -> Option<(Line, usize)> {
    let peak = curve.peak();
    let (strains, stresses) = (&curve.strains()[..=peak], &curve.stresses_mpa()[..=peak]);
    let mut found = steepest(strains, stresses, peak, window.high - window.low, least)?;
    let mut rows = 0..0;
    for _ in 0..ROUNDS {
        // Strains are sums of decimal fractions: a row on the edge belongs to the window.
        let slack = 1e-9 * window.high;
        let start = strains.partition_point(|e| *e < found.zero + window.low - slack);
        let end = strains.partition_point(|e| *e <= found.zero + window.high + slack);
        if end < start + least || (start..end) == rows {
            break;
        }
        rows = start..end;
        found = line(&strains[rows.clone()], &stresses[rows.clone()])?;
    }
    (rows.len() >= least).then_some((found, rows.len()))
}

/// Whether a line over the default window is softer than the steepest one of its width by more than [`SOFTER_IN_TOE`]: a toe
/// reaches into the window.
fn in_toe(curve: &TensileCurve, found: &Line) -> bool {
    let window = Window::default();
    steepest(curve.strains(), curve.stresses_mpa(), curve.peak(), window.high - window.low, LEAST_IN_WINDOW)
        .is_some_and(|steepest| found.slope < (1.0 - SOFTER_IN_TOE) * steepest.slope)
}

/// Where the curve first falls to the line of the modulus that starts at the offset, linear between rows.
fn yield_point(strains: &[f64], stresses: &[f64], line: &Line) -> Option<YieldPoint> {
    let above = |i: usize| stresses[i] - line.slope * (strains[i] - line.zero - OFFSET);
    (1..strains.len()).find_map(|i| {
        let (before, after) = (above(i - 1), above(i));
        if !(before > 0.0 && after <= 0.0) {
            return None;
        }
        let share = before / (before - after);
        let between = |values: &[f64]| values[i - 1] + share * (values[i] - values[i - 1]);
        Some(YieldPoint { strain: between(strains) - line.zero, strength_mpa: between(stresses) })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(step: f64, end: f64, stress: impl Fn(f64) -> f64) -> TensileCurve {
        let strains: Vec<f64> = (0..=(end / step).round() as usize).map(|i| step * i as f64).collect();
        let stresses: Vec<f64> = strains.iter().map(|e| stress(*e)).collect();
        let lines: Vec<usize> = (0..strains.len()).collect();
        TensileCurve::new("a.csv", strains, stresses, &lines).unwrap()
    }

    /// E = 2000 MPa to 1 %, then 100 MPa.
    fn bilinear(e: f64) -> f64 {
        2000.0 * e.min(0.01) + 100.0 * (e - 0.01).max(0.0)
    }

    /// It meets 2000 (e - 0.002) at e = 0.01 + 4 / 1900.
    const YIELD: f64 = 0.01 + 4.0 / 1900.0;

    #[test]
    fn a_bilinear_curve_gives_its_modulus_and_yield() {
        let found = evaluate(&curve(1e-4, 0.05, bilinear), None).unwrap();
        assert!((found.modulus_mpa / 2000.0 - 1.0).abs() < 1e-9 && found.zero_strain.abs() < 1e-12, "{found:?}");
        assert!((found.r_squared - 1.0).abs() < 1e-12);
        assert_eq!((found.window_choice, found.window_rows), (WindowChoice::Default, 21));
        let at = found.yield_point.unwrap();
        assert!((at.strain - YIELD).abs() < 1e-12 && (at.strength_mpa - bilinear(YIELD)).abs() < 1e-9, "{at:?}");
        assert!((found.break_strain - 0.05).abs() < 1e-12 && (found.strength_mpa - bilinear(0.05)).abs() < 1e-9);
        // Broken before: no yield.
        let brittle = evaluate(&curve(1e-4, 0.01, bilinear), None).unwrap();
        assert_eq!(brittle.yield_point, None);
        assert!(brittle.warnings.is_empty());
    }

    #[test]
    fn ramberg_and_osgoods_curve_yields_at_its_yield_strength() {
        // e = s/E + 0.002 (s/s_y)^n meets the offset line at s_y exactly.
        for (modulus, yield_mpa, n) in [(2000.0, 40.0, 12), (70_000.0, 300.0, 20)] {
            let stresses: Vec<f64> = (0..=600).map(|i| 1.2 * yield_mpa * f64::from(i) / 600.0).collect();
            let strain = |s: &f64| s / modulus + 0.002 * (s / yield_mpa).powi(n);
            let strains: Vec<f64> = stresses.iter().map(strain).collect();
            let lines: Vec<usize> = (0..strains.len()).collect();
            let curve = TensileCurve::new("a.csv", strains, stresses, &lines).unwrap();
            let found = evaluate(&curve, None).unwrap();
            assert!((found.modulus_mpa / modulus - 1.0).abs() < 1e-3, "{found:?}");
            assert!((found.yield_point.unwrap().strength_mpa / yield_mpa - 1.0).abs() < 1e-3, "{found:?}");
        }
    }

    #[test]
    fn a_toe_is_taken_off() {
        // Slack: nothing up to 0.3 %.
        let slack = evaluate(&curve(1e-4, 0.05, |e| bilinear((e - 0.003).max(0.0))), None).unwrap();
        // A parabola up to 0.1 % that goes over into the line: the line meets no stress at half of it.
        let parabola = |e: f64| if e < 0.001 { 2000.0 * e * e / 0.002 } else { bilinear(e - 0.0005) };
        let curved = evaluate(&curve(1e-4, 0.05, parabola), None).unwrap();
        for (found, zero) in [(slack, 0.003), (curved, 0.0005)] {
            assert!((found.modulus_mpa / 2000.0 - 1.0).abs() < 1e-9, "{found:?}");
            assert!((found.zero_strain - zero).abs() < 1e-10, "{found:?}");
            let at = found.yield_point.unwrap();
            assert!((at.strain - YIELD).abs() < 1e-9 && (at.strength_mpa - bilinear(YIELD)).abs() < 1e-6, "{at:?}");
            assert!((found.break_strain - (0.05 - zero)).abs() < 1e-9);
        }
    }

    #[test]
    fn a_toe_that_reaches_into_the_window_moves_it() {
        // Compliance that dies out within 1.5 MPa, as of grips that settle; the default window lies between 0.5 and 2.5.
        let stresses: Vec<f64> = (0..=400).map(|i| 0.06 * f64::from(i)).collect();
        let strains: Vec<f64> = stresses.iter().map(|s| s / 1000.0 + 8e-4 * (1.0 - (-s / 1.5).exp())).collect();
        let lines: Vec<usize> = (0..strains.len()).collect();
        let found = evaluate(&TensileCurve::new("a.csv", strains, stresses, &lines).unwrap(), None).unwrap();
        assert_eq!(found.window_choice, WindowChoice::Automatic);
        assert!((found.modulus_mpa / 1000.0 - 1.0).abs() < 0.02, "{found:?}");
        assert!((found.zero_strain / 8e-4 - 1.0).abs() < 0.2, "{found:?}");
    }

    #[test]
    fn noise_moves_the_modulus_as_least_squares_says() {
        // Deviations of +-0.05 MPa in turn, 201 rows: the slope's standard error is 0.05 / sqrt(sum dx^2).
        let noisy = |e: f64| bilinear(e) + if ((e / 1e-5).round() as i64) % 2 == 0 { 0.05 } else { -0.05 };
        let found = evaluate(&curve(1e-5, 0.05, noisy), None).unwrap();
        let error = 0.05 / (201.0_f64.powi(3) / 12.0).sqrt() / 1e-5;
        assert!((found.modulus_mpa - 2000.0).abs() < 3.0 * error, "{} +- {error}", found.modulus_mpa);
        assert!(found.r_squared > 0.998 && found.r_squared < 1.0);
        assert!((found.yield_point.unwrap().strength_mpa - bilinear(YIELD)).abs() < 0.2);
    }

    #[test]
    fn a_soft_curve_takes_the_straight_part_at_its_beginning() {
        // Neo-Hookean rubber of E = 3 MPa, rows every 0.5 %: the default window holds one.
        let rubber = |e: f64| (1.0 + e) - (1.0 + e).powi(-2);
        let coarse = curve(5e-3, 1.5, rubber);
        let found = evaluate(&coarse, None).unwrap();
        assert_eq!(found.window_choice, WindowChoice::Automatic);
        assert!(found.r_squared >= super::super::straight::STRAIGHT && found.window_rows >= LEAST_IN_WINDOW);
        // Curved everywhere: what is straight to that degree is softer by a tenth at most.
        assert!((0.9..1.0).contains(&(found.modulus_mpa / 3.0)), "{found:?}");
        let given = evaluate(&coarse, Some(Window::new(0.0, 0.02).unwrap())).unwrap();
        assert!(((0.97..1.0).contains(&(given.modulus_mpa / 3.0))) && given.window_rows == 4, "{given:?}");
    }

    #[test]
    fn windows_that_cannot_be_laid_are_refused() {
        let plain = curve(1e-4, 0.05, bilinear);
        for (low, high) in [(0.002, 0.001), (-0.1, 0.1), (0.0, f64::NAN), (0.0, f64::INFINITY)] {
            assert!(Window::new(low, high).unwrap_err().to_string().contains("window = "));
        }
        let error = evaluate(&plain, Some(Window::new(0.2, 0.3).unwrap())).unwrap_err().to_string();
        assert!(error.contains("a.csv: window = 0.2 0.3: it holds fewer than 3 rows"), "{error}");
        let steps = curve(0.1, 0.4, |e| e);
        assert!(evaluate(&steps, None).unwrap_err().to_string().contains("--window LOW HIGH"));
        let bent = evaluate(&curve(1e-4, 0.01, |e| 2000.0 * e.powi(2)), Some(Window::new(0.0, 0.01).unwrap())).unwrap();
        assert!(bent.warnings.len() == 1 && bent.warnings[0].contains("not straight"), "{bent:?}");
    }
}
