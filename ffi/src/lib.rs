//! Voxelastica as a native library.
//!
//! C hosts include `voxelastica.h` and link `libvoxelastica`; Python hosts use the package in `ffi/python`; C++ hosts use
//! the classes in `ffi/cxx`, which stand on the safe functions of this crate. `docs/embedding.md` shows all three.
//!
//! Guaranteed:
//!
//! - Every function `voxelastica_<type>_<verb>` returns a [`status::Status`] or a plain value. No panic unwinds into the
//!   caller; it is returned as `Internal`.
//! - Null pointers, wrong lengths, texts that are not UTF-8, and handles that are null, freed or of another type are
//!   errors. A handle is a number that is looked up and never dereferenced, and no number is given out twice.
//! - An output is written only when the call succeeds. An error object is written only when it fails.
//! - Handles may move between threads, and several threads may read one handle at once. Freeing a handle while another
//!   thread's call uses it is safe; arrays that it lent end with it.
//!
//! Not guaranteed: a pointer that is not null must point to what the header says; that cannot be checked.

mod arguments;
pub mod array;
pub mod boundary;
pub mod conduct;
pub mod design;
pub mod error;
pub mod fabricate;
pub mod failure;
pub mod flower;
pub mod input;
pub mod lists;
pub mod mesh;
pub mod outputs;
pub mod path;
pub mod profile;
pub mod progress;
mod registry;
pub mod status;
pub mod text;
pub mod verify;
pub mod voxels;
