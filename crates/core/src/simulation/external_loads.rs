//! External loads on the systems: the interface between the equations of motion and the environment.

use super::error::SimulationError;
use super::state::State;
use super::system::System;

/// External wrenches on the bodies of all systems of a run.
pub(crate) trait ExternalLoads<S> {
    /// Writes the external wrench on each body at time `t`, s, in a step over `interval`, s, to the data of
    /// `systems`. Expects the kinematics of `state` in the systems.
    fn apply(
        &mut self,
        systems: &mut [System<'_, S>],
        state: &State<S>,
        t: f64,
        interval: (f64, f64),
    ) -> Result<(), SimulationError>;

    /// Returns true if there are loads; otherwise the wrenches on all bodies stay zero.
    fn is_active(&self) -> bool;
}

/// No external loads.
pub(crate) struct NoLoads;

impl<S> ExternalLoads<S> for NoLoads {
    fn apply(
        &mut self,
        _: &mut [System<'_, S>],
        _: &State<S>,
        _: f64,
        _: (f64, f64),
    ) -> Result<(), SimulationError> {
        Ok(())
    }

    fn is_active(&self) -> bool {
        false
    }
}
