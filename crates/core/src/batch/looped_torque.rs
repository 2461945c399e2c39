//! Computed torque of robots with closed loops in a rollout, by the same controllers as in a simulation.

use super::input::InputError;
use super::rollout_lanes::Lanes;
use super::rollout_settings::RolloutControl;
use crate::control::{ComputedTorque, Control, ControllerSet, Law, check_controls};
use crate::model::Model;
use crate::reference::TaskReference;
use crate::simulation::{only, only_mut};
use crate::spatial::Scalar;

/// Checks that the law applies to the robot.
///
/// # Errors
/// [`InputError::Controller`] with the errors of [`check_controls`].
pub(super) fn check(
    model: &Model,
    law: &ComputedTorque,
    reference: &TaskReference,
) -> Result<(), InputError> {
    let checked = check_controls(&[control(model, law, reference)], model);
    checked.map_err(|error| InputError::Controller { problem: error.to_string() })
}

/// Simulates one run with computed torque of all joints, and writes the recorded states to `q`, `(rows, nq)`,
/// and `v`, `(rows, nv)`. [`check`] must have accepted the law.
pub(super) fn run<S: Scalar>(lanes: &mut Lanes<'_, S>, q: &mut [f64], v: &mut [f64]) {
    let RolloutControl::ComputedTorque(law, reference) = lanes.settings.control else { return };
    let model = only(&lanes.equations.trees).model.clone();
    let mut controls = [control(&model, law, reference)];
    let mut set = ControllerSet::new(&mut controls, &model, 0.0, false)
        .expect("the control is checked before the rollout");
    lanes.run(q, v, |lanes, step| {
        let t = step as f64 * lanes.settings.time_step;
        let (tree, state) = (only_mut(&mut lanes.equations.trees), only(&lanes.state.trees));
        set.update(t, &tree.model, &mut tree.data, &state.q, &state.v, &mut tree.command)
            .expect("references in an orbital frame are rejected before the rollout");
        tree.modes.requested_mut().copy_from_slice(set.desired_accelerations());
    });
}

fn control(model: &Model, law: &ComputedTorque, reference: &TaskReference) -> Control {
    let law = Law::TaskComputedTorque(Box::new(law.clone()), reference.clone());
    Control::on_all_joints(model, law)
}
