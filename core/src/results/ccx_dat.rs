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
    /// Sum of the reaction forces of the set, N: one row without a node.
    TotalForce,
    /// Sum of the strain energy of the elements of the set, N mm, as first component: one row without a node.
    InternalEnergy,
    /// Temperatures, K, as first components.
    Temperature,
    /// Heat that enters at the nodes, mW, as first components.
    Heat,
    /// Sum of the heat that enters at the set, mW: one row without a node.
    TotalHeat,
}

impl Quantity {
    /// Beginnings of the blocks' headers.
    const HEADERS: [(&'static str, Self); 7] = [
        ("displacements (", Self::Displacement),
        ("forces (", Self::Force),
        ("total force (", Self::TotalForce),
        ("total internal energy ", Self::InternalEnergy),
        ("temperatures ", Self::Temperature),
        ("heat generation ", Self::Heat),
        ("total heat generation ", Self::TotalHeat),
    ];

    /// Numbers in a row, and whether a node's label stands before them.
    fn row(self) -> (usize, bool) {
        match self {
            Self::Displacement | Self::Force => (3, true),
            Self::TotalForce => (3, false),
            Self::Temperature | Self::Heat => (1, true),
            Self::TotalHeat | Self::InternalEnergy => (1, false),
        }
    }
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
    /// Node label, zero for a sum, and components; those of a scalar but the first are zero.
    pub rows: Vec<(u64, [f64; 3])>,
}

/// Reads displacements, forces, temperatures and heat; other blocks are skipped.
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
            let Some(row) = row(line, block.quantity) else {
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
pub(super) fn is_text(line: &str) -> bool {
    line.trim_start().starts_with(|c: char| c.is_ascii_alphabetic()) && line.contains(" time ")
}

fn header(line: &str) -> Option<NodePrint> {
    let line = line.trim();
    let (_, quantity) = Quantity::HEADERS.into_iter().find(|(start, _)| line.starts_with(start))?;
    let (_, rest) = line.split_once(" for set ")?;
    let (set, time) = rest.split_once(" and time ")?;
    Some(NodePrint { time: number(time.trim())?, set: set.trim().to_owned(), quantity, rows: Vec::new() })
}

fn row(line: &str, quantity: Quantity) -> Option<(u64, [f64; 3])> {
    let mut words = line.split_ascii_whitespace();
    let (count, labelled) = quantity.row();
    let node = if labelled { words.next()?.parse().ok()? } else { 0 };
    let mut values = [0.0; 3];
    for value in values.iter_mut().take(count) {
        *value = number(words.next()?)?;
    }
    words.next().is_none().then_some((node, values))
}

/// A finite number. Fortran drops the `E` before an exponent of three digits.
pub(super) fn number(word: &str) -> Option<f64> {
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
    fn temperatures_and_heat_are_read() {
        let text = " temperatures for set MIDLINE and time  0.1000000E+03\n\n        33  3.161535E+02\n\n heat generation \
                    for set RIM and time  0.1000000E+03\n\n         1  2.237834E+00\n\n total heat generation for set RIM \
                    and time  0.1000000E+03\n\n        3.036688E+00\n";
        let blocks = parse(text).unwrap();
        let found: Vec<_> = blocks.iter().map(|b| (b.quantity, b.rows[0])).collect();
        assert_eq!(
            found,
            [
                (Quantity::Temperature, (33, [316.1535, 0.0, 0.0])),
                (Quantity::Heat, (1, [2.237834, 0.0, 0.0])),
                (Quantity::TotalHeat, (0, [3.036688, 0.0, 0.0])),
            ]
        );
    }

    #[test]
    fn blocks_are_read_and_others_skipped() {
        let mut blocks = parse(DAT).unwrap();
        assert_eq!(blocks.len(), 3);
        let total = blocks.remove(1);
        assert_eq!((total.quantity, total.rows[0].0, total.rows[0].1[0]), (Quantity::TotalForce, 0, -0.1154966));
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
