//! Constraints of a model: closed loops and mimic joints that refer to bodies and joints by index.

use super::closed_loop::LoopKind;
use super::frame::Frame;

/// Constraint on the motion of a model: a closed loop or a mimic joint.
#[derive(Clone, Debug, PartialEq)]
pub struct Closure {
    /// Name of the loop or of the mimic joint.
    pub name: String,
    /// Equation that the configuration must satisfy.
    pub constraint: Constraint,
    /// True if the start configuration of a simulation may be moved to satisfy the constraint; false for
    /// mimic joints.
    pub project: bool,
}

/// Equation of a [`Closure`].
#[derive(Clone, Debug, PartialEq)]
#[allow(clippy::large_enum_variant)] // a robot has few constraints
pub enum Constraint {
    /// Joint between two frames.
    Frames {
        /// Kind of the joint.
        kind: LoopKind,
        /// Frames of the joint on both bodies, with the axis of the joint along z.
        frames: [Frame; 2],
        /// Distance between the two origins, m, for [`LoopKind::Distance`]; otherwise zero.
        length: f64,
    },
    /// Coupling of two joints: `q_joint = ratio · q_leader + offset`.
    Mimic {
        /// Index of the mimic joint, in the order of the joints in `v`.
        joint: usize,
        /// Index of the leader, in the order of the joints in `v`.
        leader: usize,
        /// Rate of the joint divided by the rate of the leader.
        ratio: f64,
        /// Position of the joint while its leader is at zero, rad (m).
        offset: f64,
    },
}

impl Closure {
    /// Returns the number of scalar constraints of the closure.
    pub fn rows(&self) -> usize {
        match &self.constraint {
            Constraint::Frames { kind, .. } => kind.rows(),
            Constraint::Mimic { .. } => 1,
        }
    }

    /// Returns the directions in which the closure transmits forces and moments, in the format of
    /// [`LoopKind::directions`]; the list is empty for mimic joints.
    pub fn directions(&self) -> &'static [(usize, bool)] {
        match &self.constraint {
            Constraint::Frames { kind, .. } => kind.directions(),
            Constraint::Mimic { .. } => &[],
        }
    }
}
