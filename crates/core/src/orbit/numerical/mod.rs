//! Numerically integrated reference orbit, in free fall in the full gravity field.

mod arc;
mod collocation;
mod step;

use super::error::finite;
use super::{Axes, Orbit, OrbitError, OrbitState};
use crate::earth::Epoch;
use crate::gravity::{Gravity, GravityError};
use arc::Arcs;
use nalgebra::Vector3;
use std::sync::Arc;

/// Orbit integrated in a gravity field: `r̈ = g(t, r)`.
///
/// The integrator is Lobatto collocation, of order 16 at the ends of steps. Steps are computed on request,
/// forwards and backwards from the time `t₀` of the initial state, and stored. They do not depend on the
/// requested times, so the state is a function of `t` alone. Position, velocity and acceleration are
/// continuous. Within a step the estimated relative error of the position is at most 1e-14.
#[derive(Debug)]
pub struct Numerical {
    gravity: Arc<Gravity>,
    axes: Axes,
    arcs: Arcs,
}

impl Numerical {
    /// Creates the orbit with position `r` (m, from the planet's centre) and velocity `v` (m/s) at simulation
    /// time `t0` (s), axes of `I`.
    ///
    /// # Errors
    /// [`OrbitError::NotFinite`] and [`OrbitError::TooLarge`] for the state or `t0`,
    /// [`OrbitError::BeginsBelowSurface`] for a position inside the planet, and the errors of
    /// [`Gravity::acceleration`].
    pub fn new(r: Vector3<f64>, v: Vector3<f64>, t0: f64, gravity: Arc<Gravity>) -> Result<Self, OrbitError> {
        for (name, x) in [("position", &r), ("velocity", &v)] {
            x.iter().try_for_each(|&c| finite(name, c).map(drop))?;
        }
        finite("time of the initial state", t0)?;
        let arcs = Arcs::new(t0, r, v, gravity.mu())?;
        gravity.acceleration(t0, &r).map_err(|error| match error {
            GravityError::BelowSurface { distance, minimum } => {
                OrbitError::BeginsBelowSurface { distance, minimum }
            }
            error => error.into(),
        })?;
        Ok(Self { gravity, axes: Axes::default(), arcs })
    }

    /// Returns the same orbit with `axes` as the axes of its states and of gravity. The components of
    /// the initial state do not change.
    #[must_use]
    pub fn with_axes(self, axes: Axes) -> Self {
        Self { axes, ..self }
    }

    /// Returns the acceleration, m/s², at `time`, s, and position `r`, m.
    fn field(&self, time: f64, r: &Vector3<f64>) -> Result<Vector3<f64>, OrbitError> {
        self.gravity.acceleration(time, r).map_err(|error| match error {
            GravityError::BelowSurface { distance, minimum } => {
                OrbitError::BelowSurface { time, distance, minimum }
            }
            error => error.into(),
        })
    }
}

impl Orbit for Numerical {
    fn mu(&self) -> Option<f64> {
        Some(self.gravity.mu())
    }

    fn gravity(&self) -> Option<&Arc<Gravity>> {
        Some(&self.gravity)
    }

    fn axes(&self) -> Axes {
        self.axes
    }

    /// Returns the epoch at time zero that the gravity field or its third bodies define; `None` if they
    /// define none.
    fn epoch(&self) -> Option<Epoch> {
        self.gravity.epoch()
    }

    fn prepare(&self, times: &[f64], most_steps: usize) -> bool {
        self.arcs.prepare(times, most_steps, |time, r| self.field(time, r))
    }

    /// Returns the state at simulation time `t`, s, and integrates up to `t` if no stored step contains it.
    ///
    /// # Errors
    /// [`OrbitError::NotFinite`] and [`OrbitError::TooLarge`] for `t`, [`OrbitError::BelowSurface`] beyond
    /// the time at which the orbit meets the surface of the planet, [`OrbitError::TooManySteps`] too far from
    /// `t₀`, [`OrbitError::StepTooShort`] where the integration fails, and the errors of
    /// [`Gravity::acceleration`].
    fn state(&self, t: f64) -> Result<OrbitState, OrbitError> {
        self.arcs.state(finite("time", t)?, |time, r| self.field(time, r))
    }
}
