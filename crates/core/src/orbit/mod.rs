//! Reference orbits: where the world of the simulation flies.
//!
//! [`Orbit`] is the one trait; each kind is one file. All vectors have inertial axes `I`
//! and are measured from the centre of the planet; metres, seconds, radians.

mod custom_path;
mod error;
mod fixed_frame;
mod frames;
pub mod kepler;
mod numerical;
pub mod relative;
mod rows;
pub mod sgp4;

use crate::gravity::Gravity;
use nalgebra::Vector3;
use std::sync::Arc;

pub use crate::earth::Axes;
use crate::earth::Epoch;
pub use custom_path::{CustomPath, Ends, PathError, PathPoints};
pub use error::OrbitError;
pub use fixed_frame::FixedFrame;
pub use frames::{Lvlh, Nadir, PathFrame};
pub use kepler::{Elements, Kepler, Phase, SecularJ2, Size};
pub use numerical::Numerical;
pub use rows::StateRows;
pub use sgp4::{EarthModel, MeanElements, Sgp4};

/// Gravitational parameter of the Earth, `3.986004418e14 m³/s²`, atmosphere included.
///
/// Source: IERS Conventions (2010), Technical Note 36, table 1.1 (TCG-compatible value).
pub const MU_EARTH: f64 = 3.986_004_418e14;

/// State of the reference at one instant, axes of `I`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrbitState {
    /// Position from the planet's centre, m.
    pub position: Vector3<f64>,
    /// Velocity, m/s.
    pub velocity: Vector3<f64>,
    /// Acceleration, m/s²: the true one, whatever field the reference obeys.
    pub acceleration: Vector3<f64>,
}

/// A reference orbit as a function of time.
pub trait Orbit: Send + Sync + std::fmt::Debug {
    /// Gravitational parameter of the planet, m³/s²; `None` around no planet.
    fn mu(&self) -> Option<f64>;

    /// The gravity field that it obeys, and nothing else; `None` where it follows another law.
    fn gravity(&self) -> Option<&Arc<Gravity>> {
        None
    }

    /// State at `t` seconds of simulation, axes of `I`.
    ///
    /// # Errors
    /// [`OrbitError`] where the orbit is not defined, such as at a time that is not finite.
    fn state(&self, t: f64) -> Result<OrbitState, OrbitError>;

    /// States at two instants, where a kind can work out both at little more than the cost of one; the same bits.
    fn two_states(&self, _: [f64; 2]) -> Option<[OrbitState; 2]> {
        None
    }

    /// Position and velocity alone, m and m/s: what [`Orbit::state`] says of them.
    ///
    /// # Errors
    /// As [`Orbit::state`], but for those of the acceleration.
    fn position_velocity(&self, t: f64) -> Result<(Vector3<f64>, Vector3<f64>), OrbitError> {
        self.state(t).map(|state| (state.position, state.velocity))
    }

    /// Positions and velocities at many instants; rows before the first that is refused are written.
    ///
    /// The same states as those of [`Orbit::position_velocity`], up to rounding: kinds that can work out several
    /// at once on SIMD lanes.
    ///
    /// # Errors
    /// As [`Orbit::position_velocity`], at the first instant that is refused.
    fn fill(&self, times: &[f64], rows: StateRows<'_>) -> Result<(), OrbitError> {
        rows::one_by_one(self, times, rows)
    }

    /// Takes at most `most_steps` integration steps towards `times`. Returns true if no further step is needed.
    ///
    /// What is then asked for is the same, prepared or not: a caller that is to be interruptible prepares in parts.
    fn prepare(&self, _times: &[f64], _most_steps: usize) -> bool {
        true
    }

    /// Axes of `I` in this run.
    fn axes(&self) -> Axes {
        Axes::default()
    }

    /// Instant of time zero, where the orbit says.
    fn epoch(&self) -> Option<Epoch> {
        None
    }

    /// Where [`OrbitState::velocity`] comes from, in words.
    fn velocity_source(&self) -> &'static str {
        "derivative of the position"
    }

    /// Rate of the position at `t`, m/s, where the orbit is in `state`: that velocity, unless the orbit states another.
    ///
    /// # Errors
    /// As [`Orbit::state`].
    fn rate_of_position(&self, _t: f64, state: &OrbitState) -> Result<Vector3<f64>, OrbitError> {
        Ok(state.velocity)
    }

    /// Instants at which the acceleration jumps, s of simulation; the integrator stops at each.
    fn event_times(&self) -> Vec<f64> {
        Vec::new()
    }

    /// Frame that rides on the reference: the attitude it was given, else its local orbital frame.
    ///
    /// # Errors
    /// As [`Orbit::state`] and [`Orbit::lvlh`].
    fn frame(&self, t: f64) -> Result<PathFrame, OrbitError> {
        self.lvlh(t).map(PathFrame::from)
    }

    /// Local orbital frame at `t` seconds of simulation, in the Hill (RSW) sense.
    ///
    /// # Errors
    /// As [`Orbit::state`], and [`OrbitError::UndefinedFrame`] where the reference stands
    /// still or moves along its own radius.
    fn lvlh(&self, t: f64) -> Result<Lvlh, OrbitError> {
        Lvlh::of(&self.state(t)?)
    }
}

/// Positions and velocities at many instants, axes of `I`.
///
/// `times` (T,) s; `positions` and `velocities` hold T rows of three numbers, row after row,
/// m and m/s, as a numpy array of shape (T, 3) does.
///
/// # Errors
/// [`OrbitError::WrongLength`] when an output does not hold 3 T numbers; otherwise the
/// first error of [`Orbit::position_velocity`], rows before it being written.
pub fn states(
    orbit: &dyn Orbit,
    times: &[f64],
    positions: &mut [f64],
    velocities: &mut [f64],
) -> Result<(), OrbitError> {
    orbit.fill(times, StateRows::new(times.len(), positions, velocities)?)
}

/// Local orbital frames (Hill) at many instants.
///
/// `times` (T,) s; `rotations` holds T row-major `rot_il` (T, 3, 3), `rates` T rates of the frame
/// in its own axes (T, 3), rad/s.
///
/// # Errors
/// [`OrbitError::WrongLength`]; otherwise the first error of [`Orbit::lvlh`].
pub fn lvlh_frames(
    orbit: &dyn Orbit,
    times: &[f64],
    rotations: &mut [f64],
    rates: &mut [f64],
) -> Result<(), OrbitError> {
    frames_at(times, rotations, rates, |t| orbit.lvlh(t).map(PathFrame::from))
}

/// Frames that ride on the reference, at many instants; as [`lvlh_frames`], of [`Orbit::frame`].
///
/// # Errors
/// [`OrbitError::WrongLength`]; otherwise the first error of [`Orbit::frame`].
pub fn path_frames(
    orbit: &dyn Orbit,
    times: &[f64],
    rotations: &mut [f64],
    rates: &mut [f64],
) -> Result<(), OrbitError> {
    frames_at(times, rotations, rates, |t| orbit.frame(t))
}

fn frames_at(
    times: &[f64],
    rotations: &mut [f64],
    rates: &mut [f64],
    frame: impl Fn(f64) -> Result<PathFrame, OrbitError>,
) -> Result<(), OrbitError> {
    for (name, expected, got) in
        [("rotations", 9 * times.len(), rotations.len()), ("rates", 3 * times.len(), rates.len())]
    {
        if got != expected {
            return Err(OrbitError::WrongLength { name, expected, got });
        }
    }
    let rows = rotations.chunks_exact_mut(9).zip(rates.chunks_exact_mut(3));
    for (&t, (rotation, rate)) in times.iter().zip(rows) {
        let frame = frame(t)?;
        rotation.copy_from_slice(frame.rot_ip.transpose().as_slice()); // column major, transposed
        rate.copy_from_slice(frame.rate_p.as_slice());
    }
    Ok(())
}
