//! The `.dat` file of CalculiX: what `*NODE PRINT` asked for, increment after increment.
//!
//! ```text
//!  displacements (vx,vy,vz) for set MIDLINE and time  0.1000000E+01
//!
//!         11  3.633802E+01  0.000000E+00  0.000000E+00
//! ```

use super::ResultError;

/// What a block holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// Displacements, mm; of a rotation node, rotations, rad.
    Displacement,
    /// Reaction forces, N; of a rotation node, moments, N mm.
    Force,
}

/// One block: a quantity of a node set at one time.
#[derive(Debug, Clone, PartialEq)]
pub struct NodePrint {
    /// Time.
    pub time: f64,
    /// Name of the node set, in capitals.
    pub set: String,
    /// What is printed.
    pub quantity: Quantity,
    /// Node label and components.
    pub rows: Vec<(u64, [f64; 3])>,
}

/// Reads displacements and forces; other blocks are skipped.
///
/// ```
/// use voxelastica_core::results::ccx_dat::{Quantity, parse};
/// let text = "\n forces (fx,fy,fz) for set RP-RIM and time  0.1000000E+01\n\n  1282 -1.154966E-01  1.0E-15 -9.0E-09\n";
/// let blocks = parse(text)?;
/// assert_eq!((blocks[0].set.as_str(), blocks[0].quantity), ("RP-RIM", Quantity::Force));
/// assert_eq!(blocks[0].rows[0].0, 1282);
/// # Ok::<(), voxelastica_core::results::ResultError>(())
/// ```
///
/// # Errors
/// [`ResultError::Row`] for a line of a block that is no row, as in a file that was cut short or where numbers overflowed,
/// and [`ResultError::Empty`] where there is no block at all.
pub fn parse(text: &str) -> Result<Vec<NodePrint>, ResultError> {
    let mut blocks: Vec<NodePrint> = Vec::new();
    let mut inside = false;
    for (i, line) in text.lines().enumerate() {
        if line.trim().is_empty() {
            continue;
        }
        if is_text(line) {
            let block = header(line);
            inside = block.is_some();
            blocks.extend(block);
        } else if inside && let Some(block) = blocks.last_mut() {
            let Some(row) = row(line) else {
                return Err(ResultError::Row { line: i + 1, text: line.trim().chars().take(60).collect() });
            };
            block.rows.push(row);
        }
    }
    // A last line without its end was cut short, even where it still reads as numbers.
    if inside && !text.ends_with('\n') {
        let last = text.lines().next_back().unwrap_or_default();
        return Err(ResultError::Row { line: text.lines().count(), text: last.trim().chars().take(60).collect() });
    }
    if blocks.is_empty() { Err(ResultError::Empty) } else { Ok(blocks) }
}

/// Rows begin with a label, headers with a word.
fn is_text(line: &str) -> bool {
    line.trim_start().starts_with(|c: char| c.is_ascii_alphabetic()) && line.contains(" time ")
}

fn header(line: &str) -> Option<NodePrint> {
    let line = line.trim();
    let quantity = if line.starts_with("displacements (") {
        Quantity::Displacement
    } else if line.starts_with("forces (") {
        Quantity::Force
    } else {
        return None;
    };
    let (_, rest) = line.split_once(" for set ")?;
    let (set, time) = rest.split_once(" and time ")?;
    Some(NodePrint { time: number(time.trim())?, set: set.trim().to_owned(), quantity, rows: Vec::new() })
}

fn row(line: &str) -> Option<(u64, [f64; 3])> {
    let mut words = line.split_ascii_whitespace();
    let node = words.next()?.parse().ok()?;
    let mut values = [0.0; 3];
    for value in &mut values {
        *value = number(words.next()?)?;
    }
    words.next().is_none().then_some((node, values))
}

/// A finite number. Fortran drops the `E` before an exponent of three digits.
fn number(word: &str) -> Option<f64> {
    let parsed = word.parse().ok().or_else(|| {
        let sign = word.rfind(['+', '-']).filter(|i| *i > 0)?;
        let (mantissa, exponent) = (word.get(..sign)?, word.get(sign..)?);
        format!("{mantissa}E{exponent}").parse().ok()
    });
    parsed.filter(|v: &f64| v.is_finite())
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const DAT: &str = "
 displacements (vx,vy,vz) for set MIDLINE and time  0.5000000E-01

        11  1.633802E+01  0.000000E+00 -2.5E+00
        32  3.633802E+01 1.442423-115  0.000000E+00

 total force (fx,fy,fz) for set RIM and time  0.5000000E-01

       -1.154966E-01  1.442423E-15 -9.029025E-09

 stresses (elem, integ.pnt.,sxx,syy,szz,sxy,sxz,syz) for set EALL and time  0.5000000E-01

         1   1  1.0E+00  1.0E+00  1.0E+00  1.0E+00  1.0E+00  1.0E+00

 forces (fx,fy,fz) for set RP-RIM and time  0.1000000E+01

      1282 -1.154966E-01  1.442423E-15 -9.029025E-09
";

    #[test]
    fn blocks_are_read_and_others_skipped() {
        let blocks = parse(DAT).unwrap();
        assert_eq!(blocks.len(), 2);
        assert_eq!(blocks[0].rows, vec![(11, [16.33802, 0.0, -2.5]), (32, [36.33802, 1.442_423e-115, 0.0])]);
        assert_eq!((blocks[0].time, blocks[1].time), (0.05, 1.0));
        assert_eq!((blocks[1].quantity, blocks[1].set.as_str()), (Quantity::Force, "RP-RIM"));
    }

    #[test]
    fn a_file_cut_short_and_overflowed_numbers_are_errors() {
        let cut = &DAT[..DAT.len() - 9];
        assert!(matches!(parse(cut), Err(ResultError::Row { line: 17, .. })), "{:?}", parse(cut));
        assert!(matches!(parse(&DAT[..DAT.len() - 1]), Err(ResultError::Row { .. })));
        assert!(matches!(parse(&DAT.replace("-2.5E+00", "NaN")), Err(ResultError::Row { line: 4, .. })));
        assert_eq!(parse(""), Err(ResultError::Empty));
    }

    proptest! {
        #[test]
        fn nothing_panics(text in "\\PC*", start in 0_usize..900, end in 0_usize..900, mixed in "[0-9 .E+\\-\n]{0,60}") {
            let _ = parse(&text);
            let (start, end) = (start.min(DAT.len()), end.min(DAT.len()));
            let _ = parse(&format!("{}{mixed}{text}{}", &DAT[..end], &DAT[start..]));
        }
    }
}
