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
    let magnitude = value.abs().log10().floor() as i32;
    if (-4..6).contains(&magnitude) {
        format!("{value:.*}", usize::try_from(3 - magnitude).unwrap_or(0))
    } else {
        format!("{value:.3e}")
    }
}
