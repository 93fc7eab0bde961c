//! Parts that hold the flower in its morphed state: a base ring with slots for the rim ends, a hub with seats for the hub
//! ends, and the post of a held hub.
//!
//! Slots and seats are straight and follow from the design ([`seat`]): their bottoms lie where the spokes end, slanted by the
//! inclination there. Parts have planar faces and the flower's symmetry; they are put together from convex cells ([`cells`])
//! of half a period ([`ring`]), so their surfaces are closed by construction.

pub mod cells;
mod error;
mod maker;
pub mod parts;
pub mod ring;
pub mod seat;

pub use error::AssemblyError;
pub use maker::Assembly;
pub use parts::Parts;
