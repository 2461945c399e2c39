//! Reference orbits: the motion of the origin of W.
//!
//! [`Orbit`] is their interface; each kind of orbit has its own file or folder. All vectors are
//! expressed in inertial axes `I`, and positions are measured from the centre of the planet.
//! Units are metres, seconds and radians.

mod arrays;
mod custom_path;
mod error;
mod fixed_frame;
mod frames;
pub mod kepler;
mod lanes;
mod numerical;
mod path_error;
mod reference_orbit;
pub mod relative;
pub mod sgp4;
mod state;
mod state_rows;

pub use crate::earth::Axes;
pub use arrays::{lvlh_frames, path_frames, states};
pub use custom_path::{CustomPath, Ends, PathPoints};
pub use error::OrbitError;
pub use fixed_frame::FixedFrame;
pub use frames::{Lvlh, Nadir, PathFrame};
pub use kepler::{Elements, Kepler, Phase, SecularJ2, Size};
pub use numerical::Numerical;
pub use path_error::PathError;
pub use reference_orbit::Orbit;
pub use sgp4::{EarthModel, MeanElements, Sgp4};
pub use state::OrbitState;
pub use state_rows::StateRows;

/// Gravitational parameter of the Earth including its atmosphere, `3.986004418e14 m³/s²`.
///
/// Source: IERS Conventions (2010), Technical Note 36, table 1.1 (TCG-compatible value).
pub const MU_EARTH: f64 = 3.986_004_418e14;
