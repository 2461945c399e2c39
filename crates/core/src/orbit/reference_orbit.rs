//! Interface of reference orbits.

use super::{Axes, Lvlh, OrbitError, OrbitState, PathFrame, StateRows};
use crate::earth::Epoch;
use crate::gravity::Gravity;
use nalgebra::Vector3;
use std::sync::Arc;

/// Reference orbit: a motion whose position, velocity and acceleration are functions of time.
pub trait Orbit: Send + Sync + std::fmt::Debug {
    /// Returns the gravitational parameter of the planet, m³/s²; `None` without a planet.
    fn mu(&self) -> Option<f64>;

    /// Returns the gravity field in which the orbit is in free fall; `None` if the orbit was not integrated
    /// in a given field.
    fn gravity(&self) -> Option<&Arc<Gravity>> {
        None
    }

    /// Returns the state at simulation time `t`, s, axes of `I`.
    ///
    /// # Errors
    /// [`OrbitError`] if `t` is not finite or the orbit is not defined at `t`.
    fn state(&self, t: f64) -> Result<OrbitState, OrbitError>;

    /// Returns the states at two instants, s, bit-identical to those of [`Orbit::state`]; `None` if the orbit
    /// cannot compute both in little more time than one, or if [`Orbit::state`] returns an error for one.
    fn two_states(&self, _: [f64; 2]) -> Option<[OrbitState; 2]> {
        None
    }

    /// Returns the position, m, and velocity, m/s, at simulation time `t`, s, in axes of `I`, without the
    /// acceleration.
    ///
    /// # Errors
    /// The errors of [`Orbit::state`], except those that only the acceleration causes.
    fn position_velocity(&self, t: f64) -> Result<(Vector3<f64>, Vector3<f64>), OrbitError> {
        self.state(t).map(|state| (state.position, state.velocity))
    }

    /// Computes positions and velocities at `times`, s, and writes them to `rows`. If an instant causes an
    /// error, the rows before it have been written.
    ///
    /// The states equal those of [`Orbit::position_velocity`] up to rounding, because some kinds of orbit
    /// evaluate several instants at once on SIMD lanes.
    ///
    /// # Errors
    /// [`OrbitError::WrongRows`] if `rows` does not have one row per time; otherwise the error of
    /// [`Orbit::position_velocity`] at the first instant for which it returns one.
    fn fill(&self, times: &[f64], rows: StateRows<'_>) -> Result<(), OrbitError> {
        fill_each(self, times, rows)
    }

    /// Computes at most `most_steps` integration steps in each direction towards `times`, s. Returns true if
    /// no further step is needed or possible; for an orbit that is not integrated, always returns true.
    ///
    /// Results do not depend on this call. It lets callers divide a long integration into parts that can be
    /// interrupted.
    fn prepare(&self, _times: &[f64], _most_steps: usize) -> bool {
        true
    }

    /// Returns the axes to which the name `I` refers for this orbit.
    fn axes(&self) -> Axes {
        Axes::default()
    }

    /// Returns the epoch at simulation time zero; `None` if the orbit does not define one.
    fn epoch(&self) -> Option<Epoch> {
        None
    }

    /// Returns a phrase that describes the origin of [`OrbitState::velocity`], such as "derivative of the
    /// position".
    fn velocity_source(&self) -> &'static str {
        "derivative of the position"
    }

    /// Returns the time derivative of the position, m/s, at simulation time `t`, s, at which the orbit has
    /// the given `state`. It equals `state.velocity` unless the velocity reported by the orbit model is not
    /// the derivative of the position (SGP4).
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

    /// Returns the frame attached to the reference at simulation time `t`, s: the attitude given for the
    /// reference, or else its local orbital frame.
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

/// Fills `rows` with one evaluation of the orbit per instant.
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
