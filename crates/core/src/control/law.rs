//! Control laws together with their references.
//!
//! To add a law, add a file with the type of its gains and its [`ControlLaw`], and a variant of [`Law`] in
//! this file; `docs/howto/controller.md`, "Add a law to the engine", lists all places.

use super::compliance::Compliance;
use super::computed_torque::{ComputedTorque, check_frame};
use super::control_law::{ControlLaw, Interface};
use super::controller::Controller;
use super::error::ControlError;
use super::external::External;
use super::grip_force::GripForce;
use super::joint_computed_torque::JointComputedTorque;
use super::joint_pid::JointPid;
use crate::model::Model;
use crate::reference::{JointReference, TaskReference};

/// Control law and the reference that it tracks. The time of a reference is zero when its control starts.
pub enum Law {
    /// Task-space computed torque.
    TaskComputedTorque(Box<ComputedTorque>, TaskReference),
    /// Joint-space computed torque; the reference has one entry per joint of the group.
    JointComputedTorque(JointComputedTorque, JointReference),
    /// PID controller for each joint; the reference has one entry per joint of the group.
    Pid(JointPid, JointReference),
    /// Compliance control of a frame.
    Compliance(Box<Compliance>, TaskReference),
    /// Law that grips an object with a given force.
    Grip(Box<GripForce>),
    /// Law that follows external commands.
    External(Box<External>),
    /// User-defined controller and, if it tracks a frame, the index and the reference of that frame.
    User(Box<dyn Controller>, Option<(usize, TaskReference)>),
}

impl Law {
    /// Returns the law as a trait object.
    pub(super) fn control_law(&self) -> &dyn ControlLaw {
        match self {
            Self::TaskComputedTorque(law, _) => &**law,
            Self::JointComputedTorque(law, _) => law,
            Self::Pid(law, _) => law,
            Self::Compliance(law, _) => &**law,
            Self::Grip(law) => &**law,
            Self::External(law) => &**law,
            Self::User(controller, _) => controller,
        }
    }

    /// Returns the law as a mutable trait object.
    pub(super) fn control_law_mut(&mut self) -> &mut dyn ControlLaw {
        match self {
            Self::TaskComputedTorque(law, _) => &mut **law,
            Self::JointComputedTorque(law, _) => law,
            Self::Pid(law, _) => law,
            Self::Compliance(law, _) => &mut **law,
            Self::Grip(law) => &mut **law,
            Self::External(law) => &mut **law,
            Self::User(controller, _) => controller,
        }
    }

    /// Returns the tracked frame (index) and its reference, if the law tracks a frame.
    pub fn task(&self) -> Option<(usize, &TaskReference)> {
        match self {
            Self::TaskComputedTorque(law, reference) => Some((law.frame, reference)),
            Self::Compliance(law, reference) => Some((law.frame, reference)),
            Self::User(_, tracked) => tracked.as_ref().map(|(frame, reference)| (*frame, reference)),
            Self::JointComputedTorque(..) | Self::Pid(..) | Self::Grip(_) | Self::External(_) => None,
        }
    }

    /// Returns the reference of the joints, if the law has one.
    pub fn joint_reference(&self) -> Option<&JointReference> {
        match self {
            Self::JointComputedTorque(_, reference) | Self::Pid(_, reference) => Some(reference),
            Self::TaskComputedTorque(..)
            | Self::Compliance(..)
            | Self::Grip(_)
            | Self::External(_)
            | Self::User(..) => None,
        }
    }

    /// Returns the law if it is a grip-force law.
    pub fn grip(&self) -> Option<&GripForce> {
        match self {
            Self::Grip(law) => Some(law),
            _ => None,
        }
    }

    /// Returns the law if it follows external commands.
    pub fn external(&self) -> Option<&External> {
        match self {
            Self::External(law) => Some(law),
            _ => None,
        }
    }

    /// Returns the law as a mutable reference if it follows external commands.
    pub(super) fn external_mut(&mut self) -> Option<&mut External> {
        match self {
            Self::External(law) => Some(law),
            _ => None,
        }
    }

    /// Returns the joint quantity that the joint reference commands.
    pub fn interface(&self) -> Interface {
        self.control_law().interface()
    }

    /// Returns true if the law compensates damping and Coulomb friction of its joints.
    pub fn compensates_friction(&self) -> bool {
        self.control_law().compensates_friction()
    }

    /// Checks that the law and its reference fit a group of joints; `control` is the name of the control in
    /// messages.
    pub(super) fn check(&self, control: &str, joints: &[usize], model: &Model) -> Result<(), ControlError> {
        self.task().map(|(frame, _)| check_frame(model, frame)).transpose()?;
        self.control_law().check_group(control, joints, model)?;
        match self.joint_reference().map(|path| path.count()) {
            Some(got) if got != joints.len() => Err(ControlError::ReferenceLength {
                control: control.to_owned(),
                expected: joints.len(),
                got,
            }),
            _ => Ok(()),
        }
    }
}
