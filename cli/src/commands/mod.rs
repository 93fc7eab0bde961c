//! The subcommands.

pub mod conduct;
pub mod design;
pub mod lists;
pub mod verify;

/// A number with four significant digits.
pub fn figures(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return "0".to_owned();
    }
    // Rounded first, so that 0.99999 counts as 1.
    let rounded: f64 = format!("{value:.3e}").parse().unwrap_or(value);
    let magnitude = rounded.abs().log10().floor() as i32;
    if (-4..6).contains(&magnitude) {
        format!("{value:.*}", usize::try_from(3 - magnitude).unwrap_or(0))
    } else {
        format!("{value:.3e}")
    }
}
