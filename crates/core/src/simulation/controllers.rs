//! Controllers of one system of a run, and the desired pose of its tool.

use super::error::SimulationError;
use super::schedule::SAME_INSTANT;
use super::tree::Tree;
use super::tree_state::TreeState;
use crate::control::{Control, ControlError, ControllerSet};
use crate::model::Model;
use crate::reference::{TaskReference, TaskSample};
use crate::spatial::Scalar;

/// Controllers of one system, its tool, and a reference of the tool that is recorded but not tracked.
pub(super) struct Controllers<'a, S> {
    pub(super) set: ControllerSet<'a, S>,
    tool: Option<usize>,
    reference: Option<&'a TaskReference>,
    /// Sample of `reference` at its last evaluation; `None` before the first evaluation.
    sample: Option<TaskSample<f64>>,
}

impl<'a, S: Scalar> Controllers<'a, S> {
    pub(super) fn new(
        controls: &'a mut [Control],
        (tool, reference): (Option<usize>, Option<&'a TaskReference>),
        model: &Model,
        time_step: f64,
        knows_others: bool,
    ) -> Result<Self, SimulationError> {
        let set = ControllerSet::new(controls, model, SAME_INSTANT * time_step, knows_others)?;
        Ok(Self { set, tool, reference, sample: None })
    }

    /// Updates the tracking errors of the controls at `t`, s. Returns the desired motion of the tool and
    /// whether it is relative to the base; `None` if no reference is active. Requires the kinematics of
    /// `state` in `system`.
    pub(super) fn desired(
        &mut self,
        t: f64,
        state: &TreeState<S>,
        system: &Tree<'_, S>,
    ) -> Result<Option<(&TaskSample<f64>, bool)>, SimulationError> {
        if self.reference.is_none() && self.set.controls().is_empty() {
            return Ok(None);
        }
        self.set.update_errors(t, &system.model, &system.data, &state.q, &state.v)?;
        if let Some(reference) = self.reference {
            let sample = reference.sample(t, 0.0);
            let sample = sample.map_err(|source| SimulationError::Reference { time: t, source })?;
            return Ok(Some((self.sample.insert(sample), reference.is_relative_to_base())));
        }
        Ok(self.set.controls().iter().enumerate().find_map(|(i, control)| {
            let (_, reference) = control.law.task().filter(|(frame, _)| Some(*frame) == self.tool)?;
            Some((self.set.desired(i)?, reference.is_relative_to_base()))
        }))
    }

    /// Updates the controllers at `t`, s, and sets the joint torques of the system and the accelerations that
    /// the controllers request. Without controls, does nothing. Requires the kinematics of `state` in
    /// `system`.
    pub(super) fn update(
        &mut self,
        t: f64,
        state: &TreeState<S>,
        system: &mut Tree<'_, S>,
    ) -> Result<(), SimulationError> {
        if self.set.controls().is_empty() {
            return Ok(());
        }
        let Tree { model, data, command, modes, .. } = system;
        self.set.update(t, model, data, &state.q, &state.v, command)?;
        modes.requested_mut().copy_from_slice(self.set.desired_accelerations());
        let overflow = command.iter().map(|tau| tau.value()).enumerate().find(|(_, tau)| !tau.is_finite());
        let overflow = overflow.map(|(joint, value)| {
            let joint = model.joints()[joint].name.clone();
            ControlError::Overflow { joint, time: t, value }
        });
        overflow.map_or(Ok(()), |error| Err(error.into()))
    }
}
