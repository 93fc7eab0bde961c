//! `*RIGID BODY` and `*EQUATION` of shells.
//!
//! Shells have rotations of their own, so the nodes of an edge are tied to the rigid body (`TIE NSET`). A rigid body is
//! chosen over a kinematic coupling for the same reasons as in solids, and for one more: ABAQUS/Standard eliminates the
//! first degree of freedom of an equation, and a degree of freedom so eliminated must not take part in a coupling, while
//! equations between the reference nodes of rigid bodies are allowed.

use crate::deck::DeckError;
use crate::deck::sink::Sink;

/// Ties the shell nodes of set `nodes` to the rigid body that moves with the node in set `reference`.
pub(crate) fn rigid_edge(sink: &mut Sink<'_>, nodes: &str, reference: &str) -> Result<(), DeckError> {
    sink.line(&format!("*RIGID BODY, REF NODE={reference}, TIE NSET={nodes}"))
}

/// Makes degree of freedom `dof` of one node follow that of another. It is eliminated: nothing else may prescribe it.
pub(crate) fn follow(sink: &mut Sink<'_>, follower: &str, leader: &str, dof: u8) -> Result<(), DeckError> {
    sink.line("*EQUATION")?;
    sink.line("2")?;
    sink.line(&format!("{follower},{dof},1.,{leader},{dof},-1."))
}
