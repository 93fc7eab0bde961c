//! One writer a keyword group.

pub(super) mod amplitudes;
pub(super) mod boundary;
pub(super) mod constraints;
pub(super) mod elements;
pub(super) mod heading;
pub(super) mod initial;
pub(super) mod materials;
pub(super) mod nodes;
pub(super) mod output;
pub(super) mod sets;
pub(super) mod step;
