//! `*NSET` and `*ELSET`.

use crate::deck::DeckError;
use crate::deck::sink::Sink;

/// A node set of consecutive labels; `options` is appended to the keyword line (an instance).
pub(crate) fn node_range(
    sink: &mut Sink<'_>,
    name: &str,
    options: &str,
    first: u64,
    last: u64,
) -> Result<(), DeckError> {
    sink.line(&format!("*NSET, NSET={name}{options}, GENERATE"))?;
    sink.line(&format!("{first},{last},1"))
}

/// A node set in the order given.
pub(crate) fn node_list(
    sink: &mut Sink<'_>,
    name: &str,
    options: &str,
    nodes: impl Iterator<Item = u64>,
) -> Result<(), DeckError> {
    sink.line(&format!("*NSET, NSET={name}{options}"))?;
    sink.list(nodes)
}

/// An element set of consecutive labels; `options` is appended to the keyword line (an instance).
pub(crate) fn element_range(
    sink: &mut Sink<'_>,
    name: &str,
    options: &str,
    first: u64,
    last: u64,
) -> Result<(), DeckError> {
    sink.line(&format!("*ELSET, ELSET={name}{options}, GENERATE"))?;
    sink.line(&format!("{first},{last},1"))
}

/// An element set of ranges of consecutive labels, ends included.
pub(crate) fn element_ranges(
    sink: &mut Sink<'_>,
    name: &str,
    ranges: impl Iterator<Item = (u64, u64)>,
) -> Result<(), DeckError> {
    sink.line(&format!("*ELSET, ELSET={name}, GENERATE"))?;
    for (first, last) in ranges {
        sink.line(&format!("{first},{last},1"))?;
    }
    Ok(())
}
