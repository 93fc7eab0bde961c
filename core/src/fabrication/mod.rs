//! Files to make the thing.

pub mod layout;
pub mod solid;
pub mod stl;
pub mod three_mf;
pub mod triangulate;
pub mod voxel_surface;
