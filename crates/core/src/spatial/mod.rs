//! Spatial algebra for a generic scalar (vectors, rotations, motions, forces and inertias), curves through
//! given points, and the choice of the instruction set.
//!
//! The algebraic types are plain data with `#[inline(always)]` methods, so that the arithmetic is compiled
//! for the instruction set of the kernel that uses it. Linear parts precede angular parts.

mod articulated;
mod coriolis;
mod cpu_features;
mod fused;
mod inertia;
mod instruction_set;
mod lanes;
mod mat3;
mod motion;
mod quintic_spline;
mod real_f64;
mod rotation;
mod rotation_spline;
mod scalar;
mod sine;
mod solve;
mod spline;
mod sym3;
mod vec3;

pub use articulated::{ArticulatedInertia, InverseArticulated};
pub use coriolis::Coriolis;
pub use fused::Fused;
pub use inertia::{InverseInertia, RigidInertia, SpatialInertia};
pub use instruction_set::InstructionSet;
pub(crate) use lanes::{Lanes4, Lanes8};
pub use mat3::{Mat3, pose_rows};
pub use motion::{Force, Motion};
pub use rotation::{Quat, dexp_inv, dexp_inv_exact, exp_so3, log_rotation, log_so3};
pub use rotation_spline::RotationSpline;
pub use scalar::{ColumnKernel, Real, Scalar};
pub use solve::{cholesky_factor, cholesky_solve, dot};
pub(crate) use spline::KnotInterval;
pub use spline::{Ends, Spline, SplineError};
pub use sym3::Sym3;
pub use vec3::Vec3;
