//! One writer a keyword group.

pub(super) mod amplitudes;
pub(super) mod boundary;
pub(super) mod conduction;
pub(super) mod constraints;
pub(super) mod contact;
pub(super) mod elements;
pub(super) mod heading;
pub(super) mod initial;
pub(crate) mod materials;
pub(super) mod nodes;
pub(super) mod output;
pub(super) mod sets;
pub(super) mod shell_elements;
pub(super) mod shell_field;
pub(super) mod shell_nodes;
pub(crate) mod step;
pub(super) mod systems;
pub(super) mod ties;
