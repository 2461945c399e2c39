//! Loads that act on systems from outside: the interface between equations of motion and environment.

use super::error::SimulationError;
use super::state::State;
use super::system::System;

/// External wrenches on the bodies of all systems of a run.
pub(crate) trait ExternalLoads<S> {
    /// Writes the external wrench on each body to the data of `systems`, which have the kinematics of `state`, at `t`
    /// in a step over `interval`, s.
    fn apply(
        &mut self,
        systems: &mut [System<'_, S>],
        state: &State<S>,
        t: f64,
        interval: (f64, f64),
    ) -> Result<(), SimulationError>;

    /// Returns false if there are no loads, so that the wrenches on the bodies stay zero.
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
