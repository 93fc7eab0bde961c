//! Finite elements of the strip: geometrically nonlinear bricks, their assembly and their solution.
//!
//! Nothing here knows about design files or hosts. [`element`] is the brick with enhanced assumed strains.

pub mod element;
