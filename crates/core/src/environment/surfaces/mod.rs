//! Surfaces of bodies, which are exposed to the atmosphere and to sunlight.
//!
//! Parts do not shadow each other: faces that overlap in the direction of the stream all contribute.

mod covering;
mod cylinder;
mod error;
mod face;
mod face_pair;
mod from_shapes;
mod optics;
mod parts;
mod sphere;
mod sums;
mod surface;
mod surface_block;

pub use covering::{Covering, Surfaces};
pub use error::SurfaceError;
pub(super) use error::not_negative;
pub use optics::Optics;
pub use surface::Surface;
pub(super) use surface_block::SurfaceBlock;
