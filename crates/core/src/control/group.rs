//! A law on a group of joints for a time.

use super::compliance::Compliance;
use super::computed_torque::{ComputedTorque, unless_at_goal};
use super::controller::Controller;
use super::goal::Goal;
use super::joint_space::{Interface, JointComputedTorque, JointPid};
use super::side_by_side::Drive;
use crate::reference::{JointReference, TaskReference};

/// One of several controls of a robot: which joints, how, from when to when.
///
/// Joints that no running control drives move freely.
pub struct Control {
    /// Its name, for results, recorded columns and messages.
    pub name: String,
    /// Joints it drives, by index; no other control may drive them at the same time.
    pub joints: Vec<usize>,
    /// How.
    pub law: Law,
    /// When it starts.
    pub begin: Begin,
    /// When it stops, s; infinite where nothing but a successor or the end of the run stops it.
    pub end: f64,
    /// What it is to achieve.
    pub goal: Option<Goal>,
    /// Whether its reference is moved to begin where the tool or the joints are when it starts.
    pub starts_at_present: bool,
}

/// When a control starts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Begin {
    /// At this time, s.
    At(f64),
    /// When the goal of the control of this index is decided, or its time is over; that one stops.
    After(usize),
}

/// What drives a group. References run on the control's own clock, from zero at its start.
pub enum Law {
    /// Task-space computed torque.
    TaskComputedTorque(Box<ComputedTorque>, TaskReference),
    /// Joint-space computed torque; the reference has one entry per joint of the group.
    JointComputedTorque(JointComputedTorque, JointReference),
    /// A PID for each joint.
    Pid(JointPid, JointReference),
    /// The tool on a spring and a damper.
    Compliance(Box<Compliance>, TaskReference),
    /// A user's controller, and what it tracks with which frame, if anything.
    User(Box<dyn Controller>, Option<(usize, TaskReference)>),
}

impl Control {
    /// A law on a group of joints, from the start of the run to its end, without a goal.
    pub fn new(name: &str, joints: Vec<usize>, law: Law) -> Self {
        let (begin, end) = (Begin::At(0.0), f64::INFINITY);
        Self { name: name.to_owned(), joints, law, begin, end, goal: None, starts_at_present: false }
    }

    /// The frame it tracks and what it should follow.
    pub fn task(&self) -> Option<(usize, &TaskReference)> {
        match &self.law {
            Law::TaskComputedTorque(law, reference) => Some((law.frame, reference)),
            Law::Compliance(law, reference) => Some((law.frame, reference)),
            Law::User(_, tracked) => tracked.as_ref().map(|(frame, reference)| (*frame, reference)),
            Law::JointComputedTorque(..) | Law::Pid(..) => None,
        }
    }

    /// What its joints should follow.
    pub fn joint_reference(&self) -> Option<&JointReference> {
        match &self.law {
            Law::JointComputedTorque(_, reference) | Law::Pid(_, reference) => Some(reference),
            _ => None,
        }
    }

    /// Whether its joints are led to positions (and not to rates or efforts).
    pub fn tracks_positions(&self) -> bool {
        matches!(self.interface(), None | Some(Interface::Position))
    }

    /// What its PID commands, if it is one.
    pub(super) fn interface(&self) -> Option<Interface> {
        if let Law::Pid(law, _) = &self.law { Some(law.interface) } else { None }
    }

    /// Numbers in its tracking error: 6 of a task (m, rad), one per joint, or none.
    pub fn width(&self) -> usize {
        let is_effort = self.interface() == Some(Interface::Effort);
        match (self.task(), self.joint_reference()) {
            (Some(_), _) => 6,
            (None, Some(_)) if !is_effort => self.joints.len(),
            _ => 0,
        }
    }

    /// When its reference comes to rest, s after the start.
    pub(super) fn duration(&self) -> f64 {
        let task = self.task().map(|(_, reference)| reference.duration());
        task.or_else(|| self.joint_reference().map(|path| path.duration())).unwrap_or(0.0)
    }

    /// How its joints are driven.
    pub(super) fn drive(&self) -> Drive {
        match &self.law {
            Law::TaskComputedTorque(..) => Drive::Task,
            Law::JointComputedTorque(..) => Drive::Acceleration,
            _ => Drive::Effort,
        }
    }

    /// Whether it knows the wrenches of the environment; `None` where the law makes no use of them.
    pub(super) fn compensates_environment(&self) -> Option<bool> {
        match &self.law {
            Law::TaskComputedTorque(law, _) => Some(law.compensate_environment),
            Law::JointComputedTorque(law, _) => Some(law.compensate_environment),
            _ => None,
        }
    }

    /// The acceleration that a drive which compensates friction is to be told for the joint at `place`; zero
    /// where a joint at rest may stay there.
    pub(super) fn asks(&self, place: usize, acceleration: f64) -> f64 {
        match &self.law {
            Law::TaskComputedTorque(law, _) => unless_at_goal(acceleration, law.softest()),
            Law::JointComputedTorque(law, _) => unless_at_goal(acceleration, law.kp.at(place)),
            _ => acceleration,
        }
    }

    /// Whether it knows the friction of the joints.
    pub(super) fn compensates_friction(&self) -> bool {
        match &self.law {
            Law::TaskComputedTorque(law, _) => law.compensate_friction,
            Law::JointComputedTorque(law, _) => law.compensate_friction,
            _ => false,
        }
    }
}
