//! Motion of the frames that are fixed in one system and in which references of another system are given.

use super::error::SimulationError;
use super::run_state::RunState;
use super::settings::Simulation;
use crate::dynamics::{
    Data, forward_dynamics_recursion, frame_acceleration, frame_pose, frame_velocity, kinematics,
};
use crate::model::Model;
use crate::reference::TaskSample;
use crate::spatial::Scalar;
use crate::world::WorldError;

/// Returns the motion in W of the frame with index `frame` of a tree at `q` and `v`. The acceleration is
/// computed without motor torques and external wrenches.
fn motion(model: &Model, q: &[f64], v: &[f64], frame: usize) -> TaskSample<f64> {
    let mut data = Data::<f64>::new(model);
    kinematics(model, &mut data, q, v);
    let (pose, velocity) = (frame_pose(model, &data, q, frame), frame_velocity(model, &data, q, frame));
    let (no_torques, mut a) = (vec![0.0; v.len()], vec![0.0; v.len()]);
    forward_dynamics_recursion(model, &mut data, v, &no_torques, &mut a);
    let acceleration = frame_acceleration(model, &data, q, frame);
    TaskSample { rot_wd: pose.rot_wf, pos_w: pose.pos_w, velocity, acceleration }
}

impl Simulation {
    /// Sets the motion of the frames in which references are given to that at the initial state.
    ///
    /// # Errors
    /// [`WorldError::ReferenceFrame`] for a frame that does not exist, and [`WorldError::OwnReferenceFrame`]
    /// for a frame of the system of the reference itself.
    pub(super) fn place_moving_frames(&self) -> Result<(), SimulationError> {
        for (number, system) in self.systems.iter().enumerate() {
            for moving in system.moving_frames() {
                let name = || system.name.clone();
                if moving.system == number {
                    return Err(WorldError::OwnReferenceFrame { system: name() }.into());
                }
                let other = self.systems.get(moving.system);
                let other = other.filter(|other| moving.frame < other.model.frames().len());
                let (place, frame) = (moving.system, moving.frame);
                let error = || WorldError::ReferenceFrame { system: name(), other: place, frame };
                let other = other.ok_or_else(error)?;
                moving.set_motion(motion(&other.model, &other.q, &other.v, moving.frame));
            }
        }
        Ok(())
    }
}

impl<S: Scalar> RunState<'_, S> {
    /// Sets the motion of the frames in which references are given to that at the current state or, if
    /// `is_within_step`, to that at the state in the row buffer.
    pub(super) fn update_moving_frames(&self, is_within_step: bool) {
        let state = if is_within_step { &self.row_buffers.0 } else { &self.state };
        for (place, moving) in &self.moving_frames {
            let (tree, frame) = self.frame_in_tree(*place);
            let (model, [q, v]) = (&self.equations.trees[tree].model, state.trees[tree].values());
            moving.set_motion(motion(model, &q, &v, frame));
        }
    }
}
