//! Interface of reference orbits.

use super::{Axes, Lvlh, OrbitError, OrbitState, PathFrame, StateRows};
use crate::earth::Epoch;
use crate::gravity::Gravity;
use nalgebra::Vector3;
use std::sync::Arc;

/// Reference orbit as a function of time.
pub trait Orbit: Send + Sync + std::fmt::Debug {
    /// Returns the gravitational parameter of the planet, m³/s²; `None` without a planet.
    fn mu(&self) -> Option<f64>;

    /// Returns the gravity field if the orbit is in free fall in this field alone; otherwise `None`.
    fn gravity(&self) -> Option<&Arc<Gravity>> {
        None
    }

    /// Returns the state at simulation time `t`, s, axes of `I`.
    ///
    /// # Errors
    /// [`OrbitError`] if `t` is not finite or the orbit is not defined at `t`.
    fn state(&self, t: f64) -> Result<OrbitState, OrbitError>;

    /// Returns the states at two instants, bit-identical to [`Orbit::state`]; `None` if the orbit has no
    /// method that computes both in little more than the time of one.
    fn two_states(&self, _: [f64; 2]) -> Option<[OrbitState; 2]> {
        None
    }

    /// Returns the position, m, and velocity, m/s, at `t` without computing the acceleration.
    ///
    /// # Errors
    /// The errors of [`Orbit::state`], except those of the acceleration.
    fn position_velocity(&self, t: f64) -> Result<(Vector3<f64>, Vector3<f64>), OrbitError> {
        self.state(t).map(|state| (state.position, state.velocity))
    }

    /// Computes positions and velocities at many instants. Rows before the first error are written.
    ///
    /// The states equal those of [`Orbit::position_velocity`] up to rounding, because some kinds of orbit
    /// evaluate several instants at once on SIMD lanes.
    ///
    /// # Errors
    /// The error of [`Orbit::position_velocity`] at the first instant for which it returns one.
    fn fill(&self, times: &[f64], rows: StateRows<'_>) -> Result<(), OrbitError> {
        fill_each(self, times, rows)
    }

    /// Computes at most `most_steps` integration steps towards `times`. Returns true if no further step is
    /// needed.
    ///
    /// Results do not depend on this call. It lets callers divide a long integration into parts that can be
    /// interrupted.
    fn prepare(&self, _times: &[f64], _most_steps: usize) -> bool {
        true
    }

    /// Returns the axes of `I`.
    fn axes(&self) -> Axes {
        Axes::default()
    }

    /// Returns the epoch at simulation time zero; `None` if the orbit does not define one.
    fn epoch(&self) -> Option<Epoch> {
        None
    }

    /// Returns a phrase that describes how [`OrbitState::velocity`] is obtained.
    fn velocity_source(&self) -> &'static str {
        "derivative of the position"
    }

    /// Returns the time derivative of the position at `t`, m/s. Equals `state.velocity` unless the velocity
    /// reported by the orbit model is not the derivative of the position (SGP4).
    ///
    /// # Errors
    /// The errors of [`Orbit::state`].
    fn rate_of_position(&self, _t: f64, state: &OrbitState) -> Result<Vector3<f64>, OrbitError> {
        Ok(state.velocity)
    }

    /// Returns the simulation times, s, at which the acceleration or one of its derivatives is discontinuous.
    /// The integrator of a run ends a step at each of these times.
    fn event_times(&self) -> Vec<f64> {
        Vec::new()
    }

    /// Returns the frame attached to the reference: the attitude given for it, or else its local orbital
    /// frame.
    ///
    /// # Errors
    /// The errors of [`Orbit::state`] and [`Orbit::lvlh`].
    fn frame(&self, t: f64) -> Result<PathFrame, OrbitError> {
        self.lvlh(t).map(PathFrame::from)
    }

    /// Returns the local orbital frame (Hill, RSW) at simulation time `t`, s.
    ///
    /// # Errors
    /// The errors of [`Orbit::state`], and [`OrbitError::UndefinedFrame`] if the reference is at rest or
    /// moves along its position vector.
    fn lvlh(&self, t: f64) -> Result<Lvlh, OrbitError> {
        Lvlh::of(&self.state(t)?)
    }
}

/// Fills the rows by evaluating the orbit once per instant.
pub(super) fn fill_each(
    orbit: &(impl Orbit + ?Sized),
    times: &[f64],
    mut rows: StateRows<'_>,
) -> Result<(), OrbitError> {
    rows.check(times)?;
    for (index, &t) in times.iter().enumerate() {
        let (position, velocity) = orbit.position_velocity(t)?;
        rows.set(index, &position, &velocity)?;
    }
    Ok(())
}
