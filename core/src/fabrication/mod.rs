//! Files to make the thing.

pub mod triangulate;
pub mod voxel_surface;
