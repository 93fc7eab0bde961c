//! `*RIGID BODY`: the end faces move as their reference nodes do.
//!
//! Solids have no rotations of their own, so their faces are pinned to the rigid body (`PIN NSET`). A rigid body is chosen
//! over a kinematic coupling because both solvers have it, it carries finite rotations about the reference node exactly,
//! and it needs no surface. CalculiX keeps the rotation in a node of its own, as degrees of freedom 1 to 3.

use crate::deck::DeckError;
use crate::deck::layout::Layout;
use crate::deck::sink::Sink;

/// Makes the end face in node set `face` rigid about `reference`.
pub(crate) fn rigid_face(
    sink: &mut Sink<'_>,
    layout: Layout,
    face: &str,
    reference: &Reference,
) -> Result<(), DeckError> {
    if layout.is_abaqus() {
        sink.line(&format!("*RIGID BODY, REF NODE={}, PIN NSET={face}", reference.name))
    } else {
        let Reference { node, rotation_node, .. } = reference;
        sink.line(&format!("*RIGID BODY, NSET={face}, REF NODE={node}, ROT NODE={rotation_node}"))
    }
}

/// A reference node; in CalculiX with the node that carries its rotation.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Reference {
    /// Name of its node set.
    pub name: &'static str,
    /// Name of the rotation node's set.
    pub rotation_name: &'static str,
    /// Its label.
    pub node: u64,
    /// Label of the rotation node; unused by ABAQUS.
    pub rotation_node: u64,
    /// Where it is, mm.
    pub position: [f64; 3],
}

impl Reference {
    /// The nodes as [`super::nodes::reference_nodes`] takes them.
    pub(crate) fn nodes(&self, layout: Layout) -> Vec<(&'static str, u64, [f64; 3])> {
        let mut nodes = vec![(self.name, self.node, self.position)];
        if !layout.is_abaqus() {
            nodes.push((self.rotation_name, self.rotation_node, self.position));
        }
        nodes
    }

    /// Node set and degree of freedom of a rotation about axis 1 to 3.
    pub(crate) fn rotation(&self, layout: Layout, axis: u8) -> (&'static str, u8) {
        if layout.is_abaqus() { (self.name, axis + 3) } else { (self.rotation_name, axis) }
    }
}
