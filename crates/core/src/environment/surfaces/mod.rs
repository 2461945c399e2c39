//! What the bodies of a robot show to wind and light.
//!
//! No part shadows another: where faces overlap as the stream sees them, both are hit.

mod covering;
mod error;
mod from_shapes;
mod part;
mod push;

pub use covering::{Covering, Surface, Surfaces};
pub use error::SurfaceError;
pub(super) use error::not_negative;
pub use part::Optics;
pub(super) use push::Push;
