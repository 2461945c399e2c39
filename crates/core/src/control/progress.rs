//! What a control remembers while a run goes on.

use super::computed_torque::task_error;
use super::error::ControlError;
use super::goal::{Miss, Outcome};
use super::group::Control;
use super::joint_space::{Interface, PidMemory};
use crate::reference::{Hold, JointSample, ReferenceError, TaskReference, TaskSample};
use crate::spatial::{Mat3, Motion, Vec3};
use std::sync::Arc;

/// Whether a control runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Phase {
    Waiting,
    Running,
    Over,
}

/// State of one control, and what it sees at the last instant looked at.
#[derive(Debug)]
pub(super) struct Progress {
    pub(super) phase: Phase,
    /// When it started, s.
    pub(super) start: f64,
    pub(super) outcome: Outcome,
    /// Whether it holds where it was when its goal was missed.
    is_held: bool,
    /// How far the reference is moved to begin at the present, or what is held: a pose (rotation, position) or
    /// joint positions.
    anchor: Vec<f64>,
    is_anchored: bool,
    pub(super) pid: PidMemory,
    /// Last control tick, s.
    pub(super) last: f64,
    /// The frame of the task's reference, as a reference that stays at its origin.
    frame: Option<TaskReference>,
    pub(super) desired: JointSample,
    pub(super) desired_pose: Option<TaskSample<f64>>,
    /// Pose of the tool, in W or relative to the base as its reference is.
    pub(super) pose: (Mat3<f64>, Vec3<f64>),
    /// Desired less actual, `(width,)`.
    pub(super) error: Vec<f64>,
}

impl Progress {
    pub(super) fn new(control: &Control) -> Self {
        let k = control.joints.len();
        let stay = Hold::new(nalgebra::Matrix3::identity(), nalgebra::Vector3::zeros());
        let frame = control.task().zip(stay.ok()).map(|((_, reference), stay)| TaskReference {
            path: Arc::new(stay),
            frame: reference.frame.clone(),
        });
        let pid = PidMemory { integral: vec![0.0; k], previous: vec![f64::NAN; k] };
        Self {
            phase: Phase::Waiting,
            start: 0.0,
            outcome: Outcome::Unfinished,
            is_held: false,
            anchor: vec![0.0; if control.task().is_some() { 12 } else { k }],
            is_anchored: false,
            pid,
            last: f64::NAN,
            frame,
            desired: JointSample::new(k),
            desired_pose: None,
            pose: (Mat3::identity(), Vec3::zero()),
            error: vec![0.0; control.width()],
        }
    }

    /// The control starts at `t`; `q` are all joint positions, the pose is that of the tool now.
    pub(super) fn start(&mut self, control: &Control, t: f64, q: &[f64]) -> Result<(), ReferenceError> {
        (self.phase, self.start, self.is_anchored) = (Phase::Running, t, control.starts_at_present);
        if !control.starts_at_present {
            return Ok(());
        }
        if let (Some(frame), Some((_, reference))) = (&self.frame, control.task()) {
            // from the first pose of the path to that of the tool, in the frame of the reference
            let (frame, first, (rot, pos)) = (frame.sample(t, t)?, reference.path.sample(0.0), self.pose);
            let turn = first.rot_wd.transpose() * frame.rot_wd.transpose() * rot;
            self.put_anchor_pose(turn, frame.rot_wd.transpose_mul(pos - frame.pos_w) - first.pos_w);
        }
        if let Some(path) = control.joint_reference() {
            path.sample(0.0, &mut self.desired);
            for (place, &j) in control.joints.iter().enumerate() {
                self.anchor[place] = q[j] - self.desired.q[place];
            }
        }
        Ok(())
    }

    /// The goal is missed: from now on it holds where it is.
    pub(super) fn hold(&mut self, control: &Control, q: &[f64]) {
        self.is_held = true;
        match control.task() {
            Some(_) => self.put_anchor_pose(self.pose.0, self.pose.1),
            None => self.anchor.iter_mut().zip(&control.joints).for_each(|(to, &j)| *to = q[j]),
        }
    }

    fn put_anchor_pose(&mut self, rot: Mat3<f64>, pos: Vec3<f64>) {
        let columns = [rot.x, rot.y, rot.z, pos];
        columns.into_iter().enumerate().for_each(|(i, v)| v.write(&mut self.anchor[3 * i..]));
    }

    fn anchor_pose(&self) -> (Mat3<f64>, Vec3<f64>) {
        let at = |i: usize| Vec3::from_slice(&self.anchor[3 * i..]);
        (Mat3::from_columns(at(0), at(1), at(2)), at(3))
    }

    /// What the control should follow at `t`, and how far its joints at `q`, `rates` (all joints) or its
    /// tool are from it.
    pub(super) fn look(
        &mut self,
        control: &Control,
        t: f64,
        q: &[f64],
        rates: &[f64],
    ) -> Result<(), ReferenceError> {
        if let Some((_, reference)) = control.task() {
            let desired = self.sample(reference, t)?;
            let error: Motion<f64> = task_error(&self.pose.0, self.pose.1, &desired);
            error.write(&mut self.error);
            self.desired_pose = Some(desired);
        }
        if let Some(path) = control.joint_reference() {
            self.sample_joints(&**path, t);
            let is_rate = matches!(control.interface(), Some(Interface::Velocity));
            for (place, error) in self.error.iter_mut().enumerate() {
                let j = control.joints[place];
                *error =
                    if is_rate { self.desired.v[place] - rates[j] } else { self.desired.q[place] - q[j] };
            }
        }
        Ok(())
    }

    fn sample(&self, reference: &TaskReference, t: f64) -> Result<TaskSample<f64>, ReferenceError> {
        let (rot, pos) = self.anchor_pose();
        match &self.frame {
            _ if self.is_held => Ok(TaskSample::at_rest(rot, pos)),
            Some(frame) if self.is_anchored => {
                let mut inner = reference.path.sample(t - self.start);
                inner.rot_wd = inner.rot_wd * rot;
                inner.pos_w += pos;
                Ok(frame.sample(t, t)?.carry(&inner))
            }
            _ => reference.sample(t, self.start),
        }
    }

    fn sample_joints(&mut self, path: &dyn crate::reference::JointPath, t: f64) {
        path.sample(t - self.start, &mut self.desired);
        if self.is_anchored {
            self.desired.q.iter_mut().zip(&self.anchor).for_each(|(q, shift)| *q += shift);
        }
        if self.is_held {
            self.desired.q.copy_from_slice(&self.anchor);
            self.desired.v.fill(0.0);
            self.desired.a.fill(0.0);
        }
    }

    /// Errors as a goal sees them: of a task its distance, m, and angle, rad.
    pub(super) fn components(&self) -> ([f64; 2], bool) {
        if self.frame.is_none() {
            return ([0.0; 2], false);
        }
        let error = Motion::from_slice(&self.error);
        ([error.linear.norm(), error.angular.norm()], true)
    }

    /// Everything it remembers, as numbers.
    pub(super) fn save(&self, out: &mut Vec<f64>) {
        let code = [Phase::Waiting, Phase::Running, Phase::Over].iter().position(|p| *p == self.phase);
        let (kind, miss) = match self.outcome {
            Outcome::Unfinished => (0.0, None),
            Outcome::Succeeded { time } => (1.0, Some(Miss { component: 0, time, error: 0.0 })),
            Outcome::PathToleranceViolated(miss) => (2.0, Some(miss)),
            Outcome::GoalToleranceViolated(miss) => (3.0, Some(miss)),
        };
        let miss = miss.map_or([0.0; 3], |miss| [miss.component as f64, miss.time, miss.error]);
        out.extend([code.unwrap_or(0) as f64, self.start, kind, miss[0], miss[1], miss[2], self.last]);
        out.extend([self.is_held, self.is_anchored].map(f64::from));
        for numbers in [&self.anchor, &self.pid.integral, &self.pid.previous] {
            out.extend(numbers);
        }
    }

    /// Takes up what [`Progress::save`] wrote, from the front of `from`.
    pub(super) fn load(&mut self, from: &mut &[f64]) -> Result<(), ControlError> {
        let got = from.len();
        let mut take = |count: usize| {
            let (head, tail) =
                from.split_at_checked(count).ok_or(ControlError::WrongSave { what: "few", got })?;
            *from = tail;
            Ok::<_, ControlError>(head)
        };
        let head = take(9)?;
        let miss = Miss { component: head[3] as usize, time: head[4], error: head[5] };
        self.phase = [Phase::Waiting, Phase::Running, Phase::Over][(head[0] as usize).min(2)];
        self.outcome = match head[2] as usize {
            1 => Outcome::Succeeded { time: miss.time },
            2 => Outcome::PathToleranceViolated(miss),
            3 => Outcome::GoalToleranceViolated(miss),
            _ => Outcome::Unfinished,
        };
        (self.start, self.last) = (head[1], head[6]);
        (self.is_held, self.is_anchored) = (head[7] != 0.0, head[8] != 0.0);
        for numbers in [&mut self.anchor, &mut self.pid.integral, &mut self.pid.previous] {
            let count = numbers.len();
            numbers.copy_from_slice(take(count)?);
        }
        Ok(())
    }
}
