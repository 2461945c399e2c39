//! What the bodies of a robot show to wind and light.
//!
//! No part shadows another: where faces overlap as the stream sees them, both are hit.

mod ball;
mod covering;
mod eight_surfaces;
mod error;
mod from_shapes;
mod optics;
mod plate;
mod slab;
mod sums;
mod tube;

pub use covering::{Covering, Surface, Surfaces};
pub use error::SurfaceError;
pub(super) use error::not_negative;
pub use optics::Optics;
