//! State of a control during a run.

use super::computed_torque::task_error;
use super::control::Control;
use super::control_law::{Interface, PidMemory};
use super::error::ControlError;
use super::external::ExternalMemory;
use super::fingers::{Finger, FingerForce, fingers_of, mean_force};
use super::goal::{Goal, Outcome};
use super::grip_force::GripForce;
use super::grip_memory::GripMemory;
use crate::model::Model;
use crate::reference::{Hold, JointPath, JointSample, ReferenceError, TaskReference, TaskSample};
use crate::spatial::{Mat3, Motion, Vec3};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Phase of a control: before its start, active or ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) enum Phase {
    Waiting,
    Running,
    Over,
}

/// Part of the state of a control that a checkpoint stores.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ControlMemory {
    pub(super) phase: Phase,
    /// Time at which the control started, s.
    pub(super) start: f64,
    pub(super) outcome: Outcome,
    /// True if the control holds the pose, or the joint positions, that the robot had when the goal was
    /// missed.
    is_held: bool,
    /// True if the reference is shifted so that it begins at the pose, or at the joint positions, that the
    /// robot has at the start of the control.
    is_shifted: bool,
    /// Shift of the reference, or configuration that is held: a pose (12 numbers: the columns of the rotation
    /// matrix, then the position, m), or one number per joint of the group, rad (m).
    anchor: Vec<f64>,
    pub(super) pid: PidMemory,
    /// Time of the last control tick, s; `None` before the first tick.
    pub(super) last_tick: Option<f64>,
    /// State that a user-defined controller has saved; empty for other laws.
    pub(super) user: Vec<u8>,
    /// State of a law that follows external commands; `None` for other laws.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) external: Option<ExternalMemory>,
    /// State of a grip-force law; `None` for other laws.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) grip: Option<GripMemory>,
}

/// State of a control, with its desired motion and its error at the time of the last evaluation.
#[derive(Debug)]
pub(super) struct ControlState {
    pub(super) memory: ControlMemory,
    /// True if the error is needed at every control tick.
    pub(super) needs_error: bool,
    /// Reference that is at rest at the origin of the frame in which the task reference is given, with the
    /// axes of that frame; its samples are the poses of that frame. `None` without a task.
    frame: Option<TaskReference>,
    pub(super) desired: JointSample,
    pub(super) desired_pose: Option<TaskSample<f64>>,
    /// Pose of the tracked frame: relative to the base if the reference is, otherwise in W.
    pub(super) pose: (Mat3<f64>, Vec3<f64>),
    /// Pose of the tracked frame in the frame of the load to which the reference applies; `None` without a
    /// load, or while the load is not held.
    pub(super) tool_in_load: Option<(Mat3<f64>, Vec3<f64>)>,
    /// Tracking error, desired less actual, of length [`Control::width`].
    pub(super) error: Vec<f64>,
    /// Fingers of a grip-force law; empty for other laws.
    pub(super) fingers: Vec<Finger>,
    /// Contact forces on the fingers at the last evaluation.
    pub(super) finger_forces: Vec<FingerForce>,
}

impl ControlState {
    /// Creates the state of a control before its start; `needs_error` must be true if its law uses the error.
    pub(super) fn new(control: &Control, model: &Model, needs_error: bool) -> Self {
        let k = control.joints.len();
        let task = control.law.task();
        let stay = Hold::new(nalgebra::Matrix3::identity(), nalgebra::Vector3::zeros());
        let frame = task.zip(stay.ok()).map(|((_, reference), stay)| TaskReference {
            path: Arc::new(stay),
            frame: reference.frame.clone(),
        });
        let fingers = control.law.grip().map_or_else(Vec::new, |_| fingers_of(&control.joints, model));
        let memory = ControlMemory {
            phase: Phase::Waiting,
            start: 0.0,
            outcome: Outcome::Unfinished,
            is_held: false,
            is_shifted: false,
            anchor: vec![0.0; if task.is_some() { 12 } else { k }],
            pid: PidMemory { integral: vec![0.0; k], previous: vec![None; k] },
            last_tick: None,
            user: Vec::new(),
            external: None,
            grip: control.law.grip().map(|_| GripMemory::open(k)),
        };
        Self {
            memory,
            needs_error: needs_error
                || control.has_column
                || control.goal.is_some()
                || control.starts_at_present,
            frame,
            desired: JointSample::new(k),
            desired_pose: None,
            pose: (Mat3::identity(), Vec3::zero()),
            tool_in_load: None,
            error: vec![0.0; control.width()],
            finger_forces: vec![FingerForce::default(); fingers.len()],
            fingers,
        }
    }

    pub(super) fn is_running(&self) -> bool {
        self.memory.phase == Phase::Running
    }

    pub(super) fn is_waiting(&self) -> bool {
        self.memory.phase == Phase::Waiting
    }

    /// Starts the control at `t`, s. `q` contains the positions of all joints; the pose of the tracked frame
    /// must be up to date.
    pub(super) fn start(&mut self, control: &Control, t: f64, q: &[f64]) -> Result<(), ReferenceError> {
        let memory = &mut self.memory;
        (memory.phase, memory.start, memory.is_shifted) = (Phase::Running, t, control.starts_at_present);
        if !control.starts_at_present {
            return Ok(());
        }
        if let (Some(frame), Some((_, reference))) = (&self.frame, control.law.task()) {
            // shift from the first pose of the path to the pose of the tracked frame, in the frame of the
            // reference
            let (frame, first, (rot, pos)) =
                (frame.sample(t, t)?, reference.path.sample(0.0), self.followed_pose());
            let turn = first.rot_wd.transpose() * frame.rot_wd.transpose() * rot;
            self.set_anchor_pose(turn, frame.rot_wd.transpose_mul(pos - frame.pos_w) - first.pos_w);
        }
        if let Some(path) = control.law.joint_reference() {
            path.sample(0.0, &mut self.desired);
            for (place, &j) in control.joints.iter().enumerate() {
                self.memory.anchor[place] = q[j] - self.desired.q[place];
            }
        }
        Ok(())
    }

    /// Replaces the reference by the present pose or joint positions after a failure of the goal. `q`
    /// contains the positions of all joints.
    pub(super) fn hold(&mut self, control: &Control, q: &[f64]) {
        self.memory.is_held = true;
        match control.law.task() {
            Some(_) => {
                let (rot, pos) = self.followed_pose();
                self.set_anchor_pose(rot, pos);
            }
            None => self.memory.anchor.iter_mut().zip(&control.joints).for_each(|(to, &j)| *to = q[j]),
        }
    }

    /// Returns the pose of the frame to which the reference applies: the frame of the load or, without a
    /// load, the tracked frame.
    fn followed_pose(&self) -> (Mat3<f64>, Vec3<f64>) {
        let (rot, pos) = self.pose;
        match &self.tool_in_load {
            Some((rot_lt, pos_lt)) => {
                let rot_l = rot * rot_lt.transpose();
                (rot_l, pos - rot_l * *pos_lt)
            }
            None => (rot, pos),
        }
    }

    fn set_anchor_pose(&mut self, rot: Mat3<f64>, pos: Vec3<f64>) {
        let columns = [rot.x, rot.y, rot.z, pos];
        columns.into_iter().enumerate().for_each(|(i, v)| v.write(&mut self.memory.anchor[3 * i..]));
    }

    fn anchor_pose(&self) -> (Mat3<f64>, Vec3<f64>) {
        let at = |i: usize| Vec3::from_slice(&self.memory.anchor[3 * i..]);
        (Mat3::from_columns(at(0), at(1), at(2)), at(3))
    }

    /// Evaluates the desired motion and the tracking error at `t`, s. The error of a tracked frame is
    /// computed only if it is needed, and its pose must then be up to date. `q` and `rates` contain the
    /// positions and rates of all joints.
    pub(super) fn evaluate(
        &mut self,
        control: &Control,
        t: f64,
        q: &[f64],
        rates: &[f64],
    ) -> Result<(), ReferenceError> {
        if let Some((_, reference)) = control.law.task() {
            let mut desired = self.sample(reference, t)?;
            if let Some((rot, pos)) = self.tool_in_load {
                desired = desired.carry(&TaskSample::at_rest(rot, pos));
            }
            if self.needs_error {
                let error: Motion<f64> = task_error(&self.pose.0, self.pose.1, &desired);
                error.write(&mut self.error);
            }
            self.desired_pose = Some(desired);
        }
        if let Some(path) = control.law.joint_reference() {
            self.sample_joints(&**path, t);
            let is_rate = control.law.interface() == Interface::Velocity;
            for (place, error) in self.error.iter_mut().enumerate() {
                let j = control.joints[place];
                *error =
                    if is_rate { self.desired.v[place] - rates[j] } else { self.desired.q[place] - q[j] };
            }
        }
        if let Some(law) = control.law.grip() {
            self.error[0] = law.force - mean_force(&self.finger_forces);
        }
        if let Some(law) = control.law.external() {
            self.take_joints(control, q, rates);
            law.sample(t, &mut self.desired);
            for (place, error) in self.error.iter_mut().enumerate() {
                *error = self.desired.q[place] - q[control.joints[place]];
            }
        }
        Ok(())
    }

    /// Sets the desired positions and rates to the present ones; `q` and `rates` contain the positions and
    /// rates of all joints.
    pub(super) fn take_joints(&mut self, control: &Control, q: &[f64], rates: &[f64]) {
        for (place, &j) in control.joints.iter().enumerate() {
            (self.desired.q[place], self.desired.v[place]) = (q[j], rates[j]);
        }
    }

    fn sample(&self, reference: &TaskReference, t: f64) -> Result<TaskSample<f64>, ReferenceError> {
        let memory = &self.memory;
        match &self.frame {
            _ if memory.is_held => {
                let (rot, pos) = self.anchor_pose();
                Ok(TaskSample::at_rest(rot, pos))
            }
            Some(frame) if memory.is_shifted => {
                let (rot, pos) = self.anchor_pose();
                let mut inner = reference.path.sample(t - memory.start);
                inner.rot_wd = inner.rot_wd * rot;
                inner.pos_w += pos;
                Ok(frame.sample(t, t)?.carry(&inner))
            }
            _ => reference.sample(t, memory.start),
        }
    }

    fn sample_joints(&mut self, path: &dyn JointPath, t: f64) {
        let memory = &self.memory;
        path.sample(t - memory.start, &mut self.desired);
        if memory.is_shifted {
            self.desired.q.iter_mut().zip(&memory.anchor).for_each(|(q, shift)| *q += shift);
        }
        if memory.is_held {
            self.desired.q.copy_from_slice(&memory.anchor);
            self.desired.v.fill(0.0);
            self.desired.a.fill(0.0);
        }
    }

    /// Returns the outcome of the goal at `t`, s, which is `clock` seconds after the start of the control.
    pub(super) fn judge(&self, goal: &Goal, control: &Control, t: f64, clock: f64) -> Outcome {
        if let Some(law) = control.law.grip() {
            return self.judge_grip(law, goal, t, clock);
        }
        if self.frame.is_none() {
            return goal.judge(t, clock, control.duration(), &self.error);
        }
        let error = Motion::from_slice(&self.error);
        let distances = [error.linear.norm(), error.angular.norm()];
        goal.judge(t, clock, control.duration(), &distances)
    }

    /// Returns the outcome of the goal of a grip-force law. The goal cannot succeed before the desired force
    /// has its final value, because the impact of the fingers on the object may produce this force for an
    /// instant.
    fn judge_grip(&self, law: &GripForce, goal: &Goal, t: f64, clock: f64) -> Outcome {
        let is_rising = self.memory.grip.as_ref().is_some_and(|grip| grip.reference < law.force);
        match goal.judge(t, clock, 0.0, &self.error) {
            Outcome::Succeeded { .. } if is_rising => Outcome::Unfinished,
            outcome => outcome,
        }
    }

    /// Restores the state from a checkpoint.
    ///
    /// # Errors
    /// [`ControlError::OtherMemory`] if the state does not fit this control.
    pub(super) fn restore(&mut self, control: &Control, memory: &ControlMemory) -> Result<(), ControlError> {
        let grip = |m: &ControlMemory| m.grip.as_ref().map_or(usize::MAX, GripMemory::joints);
        let sizes = |m: &ControlMemory| [m.anchor.len(), m.pid.integral.len(), m.pid.previous.len(), grip(m)];
        let components = if self.frame.is_some() { 2 } else { self.error.len() };
        let is_known = memory.outcome.miss().is_none_or(|miss| miss.component < components);
        if sizes(memory) != sizes(&self.memory) || !is_known {
            return Err(ControlError::OtherMemory { control: control.name.clone() });
        }
        self.memory.clone_from(memory);
        Ok(())
    }
}
