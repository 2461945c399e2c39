//! Constraints in addition to the tree of a robot: joints that close kinematic loops, and couplings of mimic
//! joints to other joints.

use nalgebra::Isometry3;

/// Smallest accepted distance between the two origins of a loop of kind [`LoopKind::Distance`], m. If the
/// origins coincided, the direction of the force would be undefined.
pub(super) const SHORTEST: f64 = 1e-6;

/// Joint between two frames of a robot that closes a kinematic loop. The joint is a constraint; the tree of
/// the robot does not contain it.
#[derive(Clone, Debug, PartialEq)]
pub struct Loop {
    /// Name, unique among the loops of the robot.
    pub name: String,
    /// Kind of the joint.
    pub kind: LoopKind,
    /// Names of the two frames that the joint connects.
    pub frames: [String; 2],
    /// Pose of the joint in each of the two frames. The axis of the joint is the z axis of these poses.
    pub poses: [Isometry3<f64>; 2],
    /// Distance between the two origins for [`LoopKind::Distance`], m; `None` means the distance at zero
    /// joint positions. Other kinds do not use the length, but it is checked for them as well.
    pub length: Option<f64>,
    /// True if the start configuration of a simulation is moved to the nearest one that closes the loop. If
    /// false, a start configuration that does not close the loop is an error.
    pub project: bool,
}

/// Kind of a joint that closes a loop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LoopKind {
    /// No relative motion: six constraints.
    Weld,
    /// Rotation about the common z axis: five constraints.
    Revolute,
    /// Rotation about the common origin: three constraints.
    Spherical,
    /// Translation along the common z axis: five constraints.
    Prismatic,
    /// Constant distance between the two origins: one constraint.
    Distance,
}

/// Coupling of a joint to another joint, its leader: `q = ratio · q_leader + offset`.
#[derive(Clone, Debug, PartialEq)]
pub struct Mimic {
    /// Name of the leader.
    pub leader: String,
    /// Rate of the joint divided by the rate of the leader.
    pub ratio: f64,
    /// Position of the joint while its leader is at zero, rad (m).
    pub offset: f64,
}

impl LoopKind {
    /// Returns the number of scalar constraints of a joint of this kind.
    pub fn rows(self) -> usize {
        match self {
            Self::Weld => 6,
            Self::Revolute | Self::Prismatic => 5,
            Self::Spherical => 3,
            Self::Distance => 1,
        }
    }

    /// Returns the directions in which the joint transmits forces and moments, in the axes of the first
    /// frame. Each is a pair of the index of an axis (0 to 2) and a flag: true for a moment about the axis,
    /// false for a force along it. The list is empty for [`LoopKind::Distance`], whose force has no fixed
    /// direction.
    pub fn directions(self) -> &'static [(usize, bool)] {
        const ALL: [(usize, bool); 6] = [(0, false), (1, false), (2, false), (0, true), (1, true), (2, true)];
        const PRISMATIC: [(usize, bool); 5] = [(0, false), (1, false), (0, true), (1, true), (2, true)];
        match self {
            Self::Weld => &ALL,
            Self::Revolute => &ALL[..5],
            Self::Spherical => &ALL[..3],
            Self::Prismatic => &PRISMATIC,
            Self::Distance => &[],
        }
    }
}
