//! Control: a control law for a group of joints during an interval of time.

use super::control_law::Interface;
use super::goal::Goal;
use super::internal_force::InternalForce;
use super::law::Law;
use crate::model::Model;

/// Control law of a run, together with the joints it drives and the time during which it is active.
///
/// Joints without an active control have no motor torque, unless the caller of a stepper commands one.
pub struct Control {
    /// Name used in results, trace columns and messages.
    pub name: String,
    /// Indices of the driven joints; no other control may drive them at the same time.
    pub joints: Vec<usize>,
    /// Control law with its reference.
    pub law: Law,
    /// Frame of a captured system that follows the reference instead of the tracked frame; `None` if the
    /// tracked frame itself follows it. The tracked frame must hold the body of the load frame rigidly.
    pub load: Option<LoadFrame>,
    /// Internal forces of closed loops that the control commands.
    pub internal_forces: Vec<InternalForce>,
    /// Condition under which the control starts.
    pub begin: Begin,
    /// End time, s; infinity for none. A control that starts after this one, or at an event, may stop it
    /// earlier.
    pub end: f64,
    /// Tolerances of the tracking error; `None` if the control has no goal.
    pub goal: Option<Goal>,
    /// True if the reference is shifted so that it begins at the pose, or at the joint positions, that the
    /// robot has at the start of the control.
    pub starts_at_present: bool,
    /// True if the trace has a `tracking` column with the error of this control, provided that the control
    /// has an error. If false, a tracked frame must be the tool of the run, whose error is recorded in
    /// `position_error` and `attitude_error`.
    pub has_column: bool,
}

/// Frame of a captured system that a control of the capturing system moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LoadFrame {
    /// Index of the system in the world.
    pub system: usize,
    /// Index of the frame in the model of the system.
    pub frame: usize,
}

/// Start condition of a control.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Begin {
    /// Start at this time, s.
    At(f64),
    /// Start when the control with this index ends or its goal is decided; that control is then stopped.
    After(usize),
    /// Start when the event with this index in the world happens; active controls of the same joints are then
    /// stopped.
    AfterEvent(usize),
}

impl Control {
    /// Creates a control of a group of joints for the whole run, without a goal.
    pub fn new(name: &str, joints: Vec<usize>, law: Law) -> Self {
        Self {
            name: name.to_owned(),
            joints,
            law,
            load: None,
            internal_forces: Vec::new(),
            begin: Begin::At(0.0),
            end: f64::INFINITY,
            goal: None,
            starts_at_present: false,
            has_column: true,
        }
    }

    /// Creates a control of all joints for the whole run, named `control`. If its law tracks a frame, that
    /// frame is the tool of the run.
    pub fn on_all_joints(model: &Model, law: Law) -> Self {
        let joints = (0..model.joint_count()).collect();
        Self { has_column: false, ..Self::new("control", joints, law) }
    }

    /// Returns the number of components of the tracking error: 6 for a frame (m, then rad), one per joint for
    /// a reference of positions or rates, and 0 without a reference or if the reference commands efforts. A
    /// law that follows external commands has one component per joint, which is zero while no positions are
    /// commanded. A grip-force law has one component, the error of the grip force, N.
    pub fn width(&self) -> usize {
        match (self.law.task(), self.law.joint_reference()) {
            (Some(_), _) => 6,
            (None, Some(_)) if self.law.interface() != Interface::Effort => self.joints.len(),
            (None, None) if self.law.external().is_some() => self.joints.len(),
            (None, None) if self.law.grip().is_some() => 1,
            _ => 0,
        }
    }

    /// Returns the time from the start of the control until its reference comes to rest, s: 0 without a
    /// reference, and infinity if the reference never comes to rest.
    pub(super) fn duration(&self) -> f64 {
        let task = self.law.task().map(|(_, reference)| reference.duration());
        task.or_else(|| self.law.joint_reference().map(|path| path.duration())).unwrap_or(0.0)
    }

    /// Returns the start and end times of the control, s, if they are known before the run and later than
    /// zero.
    pub fn switch_times(&self) -> impl Iterator<Item = f64> {
        let start = if let Begin::At(start) = self.begin { start } else { 0.0 };
        [start, self.end].into_iter().filter(|t| t.is_finite() && *t > 0.0)
    }
}
