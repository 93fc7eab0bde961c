//! `profile.csv` and `slices.csv`.

use std::io::Write;

use crate::design::Design;

/// Writes `profile.csv`: one row a station, rim first.
///
/// # Errors
/// What the writer returns.
pub fn write_profile(design: &Design, out: &mut dyn Write) -> std::io::Result<()> {
    let profile = design.profile();
    let mut csv = csv::Writer::from_writer(out);
    csv.write_record([
        "s_mm",
        "theta_deg",
        "x_mm",
        "z_mm",
        "rho_mm",
        "width_mm",
        "modulus_ratio",
        "modulus_mpa",
        "rigid_fraction",
    ])?;
    for i in 0..profile.s.len() {
        let row = [
            profile.s[i],
            profile.inclination[i].to_degrees(),
            profile.x[i],
            profile.z[i],
            profile.rho[i],
            profile.width[i],
            profile.modulus_ratio[i],
            profile.modulus_mpa[i],
            profile.rigid_fraction[i],
        ];
        csv.write_record(row.map(number))?;
    }
    csv.flush()
}

/// Writes `slices.csv`: one row a voxel slice, rim first.
///
/// # Errors
/// What the writer returns.
pub fn write_slices(design: &Design, out: &mut dyn Write) -> std::io::Result<()> {
    let labels: Vec<String> = design.phases().phases().iter().map(|p| format!("count_{}", p.label())).collect();
    let mut csv = csv::Writer::from_writer(out);
    let mut header: Vec<&str> = vec!["slice", "s_mm", "width_voxels", "layers", "voxels"];
    header.extend(labels.iter().map(String::as_str));
    header.extend(["modulus_target_mpa", "modulus_mpa", "stiffness_target_nmm2", "stiffness_nmm2"]);
    csv.write_record(&header)?;
    let layers = design.grid().layers();
    for (i, slice) in design.slices().iter().enumerate() {
        let width = 2 * slice.half_width;
        let mut row = vec![
            (i + 1).to_string(),
            number(slice.s_mm),
            width.to_string(),
            layers.to_string(),
            (width * layers).to_string(),
        ];
        row.extend(slice.counts[..labels.len()].iter().map(u32::to_string));
        row.extend(
            [slice.modulus_target_mpa, slice.modulus_mpa, slice.stiffness_target_nmm2, slice.section.stiffness]
                .map(number),
        );
        csv.write_record(&row)?;
    }
    csv.flush()
}

/// Writes `nastran/fractions.csv`: every fifth station of the profile, with the fractions of the phases there.
///
/// # Errors
/// What the writer returns.
pub fn write_fractions(design: &Design, out: &mut dyn Write) -> std::io::Result<()> {
    let phases = design.phases().phases();
    let profile = design.profile();
    let mut csv = csv::Writer::from_writer(out);
    let labels = phases.iter().map(|p| format!("fraction_{}", p.label()));
    csv.write_record(["x_mm", "width_mm", "modulus_mpa"].map(str::to_owned).into_iter().chain(labels))?;
    for i in (0..profile.s.len()).step_by(5) {
        let fractions = design.fractions(profile.modulus_mpa[i]).values;
        let row = [profile.s[i], profile.width[i], profile.modulus_mpa[i]].into_iter();
        csv.write_record(row.chain(fractions.into_iter().take(phases.len())).map(number))?;
    }
    csv.flush()
}

/// Ten significant digits, without trailing zeros: more than any input is known to, and the same on every platform.
pub(crate) fn number(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return "0".to_owned();
    }
    let rounded: f64 = format!("{value:.9e}").parse().unwrap_or(value);
    format!("{rounded}")
}

#[cfg(test)]
mod tests {
    use super::number;

    #[test]
    fn numbers_are_short_and_exact_to_ten_digits() {
        assert_eq!(number(0.1 + 0.2), "0.3");
        assert_eq!(number(-0.0), "0");
        assert_eq!(number(63.661_977_236_758), "63.66197724");
        assert_eq!(number(1e-12), "0.000000000001");
    }
}
