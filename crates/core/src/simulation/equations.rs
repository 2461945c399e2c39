//! Equations of motion of all trees of a run: computes the time derivatives of the state from state, loads and
//! joint torques.

use super::error::SimulationError;
use super::external_loads::ExternalLoads;
use super::state::{Rate, State};
use super::tree::Tree;
use crate::dynamics::Data;
use crate::model::Model;
use crate::spatial::Real;

/// Equations of motion of all trees under external loads and constant joint torques.
///
/// Every evaluation first computes the kinematics of all trees, then the loads once for all of them, then the rates
/// of each.
pub(crate) struct EquationsOfMotion<'a, S, W> {
    /// The trees, in the order of the run.
    pub(crate) trees: Vec<Tree<'a, S>>,
    pub(crate) loads: W,
}

impl<'a, S: Real, W: ExternalLoads<S>> EquationsOfMotion<'a, S, W> {
    /// Returns the equations of motion of `models`. `restitution` is that of the stops at the position limits of
    /// joints; `None` means no stops.
    pub(crate) fn new(models: &[&'a Model], loads: W, restitution: Option<f64>) -> Self {
        Self { trees: models.iter().map(|model| Tree::new(model, restitution)).collect(), loads }
    }

    /// Computes the kinematics of `state` and projects every base twist onto the momentum of its tree.
    pub(crate) fn project_momentum(&mut self, state: &mut State<S>) {
        for (tree, state) in self.trees.iter_mut().zip(&mut state.trees) {
            tree.project_momentum(state);
        }
    }

    /// Computes the kinematics of `state` in W.
    pub(crate) fn update_kinematics(&mut self, state: &State<S>) {
        for (tree, state) in self.trees.iter_mut().zip(&state.trees) {
            tree.update_kinematics(state);
        }
    }

    /// Restores kinematics and loads at the start of a step, which a trial step has overwritten.
    pub(super) fn restore(&mut self, start: &[Data<S>]) {
        for (tree, start) in self.trees.iter_mut().zip(start) {
            tree.restore(start);
        }
    }

    /// Computes the external wrenches on all trees at time `t`, s, in a step over `interval`, s. Expects the
    /// kinematics of `state` in the trees.
    pub(crate) fn apply_loads(
        &mut self,
        t: f64,
        interval: (f64, f64),
        state: &State<S>,
    ) -> Result<(), SimulationError> {
        self.loads.apply(&mut self.trees, state, t, interval)
    }

    /// Computes the rates at `state`. Expects its kinematics and loads in the trees.
    pub(crate) fn rates(&mut self, state: &State<S>, rate: &mut Rate<S>) {
        let is_loaded = self.loads.is_active();
        for ((tree, state), rate) in self.trees.iter_mut().zip(&state.trees).zip(&mut rate.trees) {
            tree.rates(state, is_loaded, rate);
        }
    }

    /// Computes the kinematics, loads and rates of a stage after the first.
    pub(crate) fn evaluate(
        &mut self,
        t: f64,
        interval: (f64, f64),
        state: &State<S>,
        rate: &mut Rate<S>,
    ) -> Result<(), SimulationError> {
        for (tree, state) in self.trees.iter_mut().zip(&state.trees) {
            tree.update_stage_kinematics(state);
        }
        self.apply_loads(t, interval, state)?;
        self.rates(state, rate);
        Ok(())
    }

    /// Returns true if a joint of any tree has friction or stops.
    pub(crate) fn has_modes(&self) -> bool {
        self.trees.iter().any(|tree| tree.modes.is_active())
    }

    /// Returns true if a joint of any tree is locked.
    pub(super) fn any_locked(&self) -> bool {
        self.trees.iter().any(|tree| tree.modes.locked().is_some())
    }

    /// Determines the modes of all joints for the step that starts at `state`. Expects its kinematics and loads in
    /// the trees.
    pub(crate) fn solve_modes(&mut self, state: &State<S>) {
        for (tree, state) in self.trees.iter_mut().zip(&state.trees) {
            tree.solve_modes(&state.q, &state.v);
        }
    }
}
