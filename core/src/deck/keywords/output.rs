//! Output requests.

use crate::deck::DeckError;
use crate::deck::layout::Layout;
use crate::deck::sink::Sink;

use super::constraints::Reference;

/// Nodes up to which every fifth increment is kept as a field; beyond, only the last one.
const MANY_NODES: u64 = 25_000;

/// Displacements and stresses of the whole model now and then, the mid-line and the reactions in every increment.
pub(crate) fn requests(
    sink: &mut Sink<'_>,
    layout: Layout,
    nodes: u64,
    midlines: &[&str],
    references: &[&Reference],
) -> Result<(), DeckError> {
    if layout.is_abaqus() {
        let references: Vec<&str> = references.iter().map(|r| r.name).collect();
        return abaqus_requests(sink, nodes, "S,LE", midlines, &references);
    }
    calculix_requests(sink, frequency(nodes), midlines, references)
}

/// The same for CalculiX, with how often the whole model is kept.
pub(crate) fn calculix_requests(
    sink: &mut Sink<'_>,
    frequency: u32,
    midlines: &[&str],
    references: &[&Reference],
) -> Result<(), DeckError> {
    for set in midlines {
        sink.line(&format!("*NODE PRINT, NSET={set}"))?;
        sink.line("U")?;
    }
    for set in references.iter().flat_map(|r| [r.name, r.rotation_name]) {
        sink.line(&format!("*NODE PRINT, NSET={set}"))?;
        sink.line("U,RF")?;
    }
    sink.line(&format!("*NODE FILE, FREQUENCY={frequency}"))?;
    sink.line("U")?;
    sink.line(&format!("*EL FILE, FREQUENCY={frequency}"))?;
    sink.line("S")
}

/// The same for ABAQUS, with the elements' variables and the reference nodes' sets.
pub(crate) fn abaqus_requests(
    sink: &mut Sink<'_>,
    nodes: u64,
    variables: &str,
    midlines: &[&str],
    references: &[&str],
) -> Result<(), DeckError> {
    abaqus_requests_at(sink, &every_increment(nodes), variables, midlines, references)
}

/// The whole model now and then, histories in every increment.
pub(crate) fn every_increment(nodes: u64) -> [String; 2] {
    [format!("FREQUENCY={}", frequency(nodes)), "FREQUENCY=1".to_owned()]
}

/// The same with how often fields and histories are kept.
pub(crate) fn abaqus_requests_at(
    sink: &mut Sink<'_>,
    [field, history]: &[String; 2],
    variables: &str,
    midlines: &[&str],
    references: &[&str],
) -> Result<(), DeckError> {
    sink.line(&format!("*OUTPUT, FIELD, {field}"))?;
    sink.line("*NODE OUTPUT")?;
    sink.line("U,COORD")?;
    sink.line("*ELEMENT OUTPUT")?;
    sink.line(variables)?;
    sink.line(&format!("*OUTPUT, HISTORY, {history}"))?;
    for set in midlines {
        sink.line(&format!("*NODE OUTPUT, NSET={set}"))?;
        sink.line("U,COORD")?;
    }
    for set in references {
        sink.line(&format!("*NODE OUTPUT, NSET={set}"))?;
        sink.line("U,UR,RF,RM")?;
    }
    Ok(())
}

/// Every so many increments the whole model is kept.
pub(crate) fn frequency(nodes: u64) -> u32 {
    if nodes > MANY_NODES { 2000 } else { 5 }
}
