//! What the `.dat` file of CalculiX says of elements: strains (`*EL PRINT`, `E`) and contact (`*CONTACT PRINT`, `CDIS`).
//!
//! ```text
//!  strains (elem, integ.pnt.,exx,eyy,ezz,exy,exz,eyz) for set SPOKE and time  0.2000000E+01
//!
//!          1   1 -3.211362E-03 -1.300936E-04  9.193057E-04 -6.005504E-04  6.804160E-04 -1.052351E-04
//!
//!  relative contact displacement (slave element+face,normal,tang1,tang2) for all contact elements and time 0.2000000E+01
//!
//!        619          2 -1.547013E-03  0.000000E+00  0.000000E+00
//! ```

use nalgebra::Matrix3;

use super::ResultError;
use super::ccx_dat::{is_text, number};

/// The largest principal strain of a set at one time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LargestStrain {
    /// Time.
    pub time: f64,
    /// Largest principal stretch less one, over the integration points.
    pub strain: f64,
}

/// Elements in contact at one time.
#[derive(Debug, Clone, PartialEq)]
pub struct ContactPrint {
    /// Time.
    pub time: f64,
    /// Element of the dependent surface and clearance there, mm; negative where the surfaces penetrate.
    pub clearances: Vec<(u64, f64)>,
}

/// Reads the strains of all sets; Green's, as CalculiX prints them in large displacements.
///
/// # Errors
/// [`ResultError::Row`] for a line that is no row.
pub fn largest_strains(text: &str) -> Result<Vec<LargestStrain>, ResultError> {
    let mut found: Vec<LargestStrain> = Vec::new();
    blocks(text, "strains (", 8, |time, row| match row {
        None => found.push(LargestStrain { time, strain: f64::NEG_INFINITY }),
        Some([_, _, xx, yy, zz, xy, xz, yz]) => {
            if let Some(block) = found.last_mut() {
                let green = Matrix3::new(*xx, *xy, *xz, *xy, *yy, *yz, *xz, *yz, *zz);
                let largest = green.symmetric_eigenvalues().max();
                block.strain = block.strain.max((1.0 + 2.0 * largest).max(0.0).sqrt() - 1.0);
            }
        }
        Some(_) => {}
    })?;
    Ok(found)
}

/// Reads which elements are in contact. Times at which nothing touches have no row.
///
/// # Errors
/// [`ResultError::Row`] for a line that is no row.
pub fn contacts(text: &str) -> Result<Vec<ContactPrint>, ResultError> {
    let mut found: Vec<ContactPrint> = Vec::new();
    blocks(text, "relative contact displacement (", 5, |time, row| match row {
        None => found.push(ContactPrint { time, clearances: Vec::new() }),
        Some([element, _, normal, ..]) => {
            if let Some(block) = found.last_mut() {
                block.clearances.push((*element as u64, *normal));
            }
        }
        Some(_) => {}
    })?;
    Ok(found)
}

/// Calls `take` with the time of every block that begins so, and with every row of `columns` numbers in it.
fn blocks(
    text: &str,
    beginning: &str,
    columns: usize,
    mut take: impl FnMut(f64, Option<&[f64]>),
) -> Result<(), ResultError> {
    let mut inside = None;
    let mut row = Vec::with_capacity(columns);
    for (i, line) in text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty()) {
        if is_text(line) {
            let time = line.rsplit_once(" time ").and_then(|(_, time)| number(time.trim()));
            inside = time.filter(|_| line.trim_start().starts_with(beginning));
            if let Some(time) = inside {
                take(time, None);
            }
        } else if let Some(time) = inside {
            row.clear();
            row.extend(line.split_ascii_whitespace().map_while(number));
            if row.len() != columns || line.split_ascii_whitespace().count() != columns {
                return Err(ResultError::Row { line: i + 1, text: line.trim().chars().take(60).collect() });
            }
            take(time, Some(&row));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = " total internal energy for set SPOKE and time  0.1000000E+01\n\n        3.5E+00\n\
        \n strains (elem, integ.pnt.,exx,eyy,ezz,exy,exz,eyz) for set SPOKE and time  0.1000000E+01\n\n\
        1   1  0.0E+00  0.0E+00  0.0E+00  1.0E-01  0.0E+00  0.0E+00\n\
        1   2  5.0E-02  0.0E+00  0.0E+00  0.0E+00  0.0E+00  0.0E+00\n\
        \n relative contact displacement (slave element+face,normal,tang1,tang2) for all contact elements and time 0.1E+01\n\n\
        619          2 -1.5E-03  0.0E+00  0.0E+00\n\
        \n relative contact displacement (slave element+face,normal,tang1,tang2) for all contact elements and time 0.2E+01\n\n";

    #[test]
    fn strains_become_stretches() {
        let found = largest_strains(TEXT).unwrap();
        assert_eq!(found.len(), 1);
        assert!((found[0].strain - (1.2_f64.sqrt() - 1.0)).abs() < 1e-12, "{}", found[0].strain);
    }

    #[test]
    fn contact_may_be_open() {
        let found = contacts(TEXT).unwrap();
        assert_eq!(found[0], ContactPrint { time: 1.0, clearances: vec![(619, -1.5e-3)] });
        assert_eq!(found[1], ContactPrint { time: 2.0, clearances: Vec::new() });
    }

    #[test]
    fn a_row_that_was_cut_short_is_named() {
        let error = largest_strains(&TEXT.replace("1   2  5.0E-02  0.0E+00", "1   2  5.0E-02")).unwrap_err();
        assert!(error.to_string().contains("line 8"), "{error}");
    }
}
