//! Interface between the equations of motion and the environment, which computes external loads on the trees.

use super::error::SimulationError;
use super::members::Members;
use super::state::State;
use super::tree::Tree;

/// External wrenches on the bodies of all trees of a run.
pub(crate) trait ExternalLoads<S> {
    /// Writes to the data of `trees` the external wrench on each body at time `t`, s, in a step over
    /// `interval`, s. Requires the kinematics of `state` in the trees. Called only if the loads are active.
    fn apply(
        &mut self,
        trees: &mut [Tree<'_, S>],
        members: &mut Members<'_, S>,
        state: &State<S>,
        t: f64,
        interval: (f64, f64),
    ) -> Result<(), SimulationError>;

    /// Returns true if there may be loads. Otherwise the wrenches on all bodies remain zero.
    fn is_active(&self) -> bool;
}

/// Absence of external loads.
pub(crate) struct NoLoads;

impl<S> ExternalLoads<S> for NoLoads {
    fn apply(
        &mut self,
        _: &mut [Tree<'_, S>],
        _: &mut Members<'_, S>,
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
