//! What `voxelastica.hpp` stands on: the library's classes for C++, by `cxx`.
//!
//! C++ programs include `voxelastica/voxelastica.hpp`, whose classes own what is here, give views and throw
//! `voxelastica::Error`. Nothing panics into C++: every body runs inside `voxelastica`'s boundary, and a panic arrives as
//! an exception with the code `Internal`.

pub mod bridge;
