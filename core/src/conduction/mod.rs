//! Heat and current in strips of bricks: steady and transient conduction, effective conductivities, the Ashby chart.
//!
//! The equations are `div(k grad T) = rho c dT/dt` and `div(sigma grad phi + epsilon d(grad phi)/dt) = 0`, on trilinear
//! eight-node bricks ([`brick`]) that fill a box with voids ([`mesh`]): the voxels of a spoke, flat or morphed, or its smooth, graded
//! outline ([`strip`]).
//!
//! - [`steady`] solves by conjugate gradients without a matrix, preconditioned by geometric multigrid (Galerkin's coarse
//!   operators); seven to ten iterations whatever the number of voxels. Phases whose conductivities differ by more than
//!   [`steady::LARGEST_CONTRAST`] are solved apart, so that 1e16 loses nothing to rounding;
//! - [`transient`] integrates by TR-BDF2 with steps that keep an error;
//! - [`case`] asks the questions of the paper on a strip and answers them; [`ashby`] charts mixtures; [`output`] writes files.
//!
//! A uniform strip has its textbook conductance:
//!
//! ```
//! use voxelastica_core::conduction::mesh::{BrickMesh, Geometry};
//! use voxelastica_core::conduction::pcg::Watch;
//! use voxelastica_core::conduction::steady::{Boundary, SteadyOptions, solve};
//!
//! // 20 x 3 x 2 mm in cubes of 0.5 mm, 2 W/(m K) = 2e-3 W/(mm K), 77 K between the ends: k A / L times 77 K.
//! let mesh = BrickMesh::new([40, 4, 6], vec![0; 960], Geometry::Cubes(0.5))?;
//! let mut boundary = Boundary::insulated(&mesh);
//! boundary.give_plane(&mesh, 0, 393.15);
//! boundary.give_plane(&mesh, 40, 316.15);
//! let found = solve(&mesh, &[2e-3], &boundary, &SteadyOptions::default(), Watch::silent())?;
//! assert!((found.slice_flux[0] - 2e-3 * 6.0 / 20.0 * 77.0).abs() < 1e-8);
//! # Ok::<(), voxelastica_core::conduction::ConductionError>(())
//! ```
//!
//! Units are mm, s, K, W, V and A: conductivities per mm, capacities per mm^3. Heat capacities are lumped on the nodes, as ABAQUS does
//! for its bricks of first order. The flux through every cross-section is compared with what enters before it; a solution that is not
//! balanced is an error. Work is cancelled between products with the operator, of which one takes about 10 ms a million voxels.

pub mod ashby;
pub mod brick;
pub mod case;
mod components;
mod contrast;
mod current;
mod error;
mod galerkin;
mod heat;
pub mod memory;
pub mod mesh;
mod multigrid;
mod operator;
pub mod output;
pub mod pcg;
pub mod steady;
mod stencil;
pub mod strip;
mod transfer;
pub mod transient;

pub use error::ConductionError;
