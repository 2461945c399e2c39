//! Seating: the motion of a captured frame, relative to the capturing frame, to its nominal pose, as imposed
//! by latches and grapple fixtures.
//!
//! The captured frame moves along a straight line and rotates about one axis, both with the same time law. In
//! the tree, this motion is represented by a prismatic and a revolute joint whose positions are prescribed
//! functions of time.

use super::event::{RigidPose, Seating, Weld};
use crate::model::{Joint, JointKind};
use crate::reference::TimeLaw;
use nalgebra::{Isometry3, Quaternion, Translation3, Unit, UnitQuaternion, Vector3};

/// Joint of a tree whose position is a prescribed function of time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GivenJoint {
    /// Index of the joint in the tree.
    pub joint: usize,
    /// Position at the end of the motion, rad or m; the position at the start is zero.
    pub travel: f64,
    /// Start of the motion, s.
    pub start: f64,
    /// Time law of the motion.
    pub law: TimeLaw,
}

impl GivenJoint {
    /// Returns the position (rad or m), the rate (rad/s or m/s) and the acceleration (rad/s² or m/s²) of the
    /// joint at the time `t`, s.
    pub fn at(&self, t: f64) -> [f64; 3] {
        let (s, rate, acceleration) = self.law.at(t - self.start);
        [s, rate, acceleration].map(|x| x * self.travel)
    }
}

/// Smallest number of steps into which a seating motion is divided, so that a fixed-step integrator
/// resolves it.
const STEPS: usize = 64;

impl Seating {
    /// Returns the times at which steps must end, s: the end of the motion and, if the motion is shorter
    /// than 64 steps of length `time_step`, s, 63 equally spaced times within it.
    pub fn cuts(&self, time_step: f64) -> impl Iterator<Item = f64> + use<> {
        let Self { start, duration, .. } = *self;
        let parts = if duration < STEPS as f64 * time_step { STEPS } else { 1 };
        (1..=parts).map(move |part| start + duration * (part as f64 / parts as f64))
    }
}

/// Connection that a weld adds to a tree: moving joints, the travel of each, rad or m, and the constant pose
/// of the connected frame after the last joint.
pub(super) struct Chain {
    pub(super) joints: Vec<Joint>,
    pub(super) travels: Vec<f64>,
    pub(super) pose: Isometry3<f64>,
}

impl Weld {
    /// Returns the name of the loop that the weld closes if other welds already connect its systems.
    pub fn loop_name(&self) -> String {
        format!("capture {}", self.capture)
    }

    /// Returns the time at which the captured frame will reach its nominal pose, s; `None` if the frame has
    /// no seating motion.
    pub fn seated_at(&self) -> Option<f64> {
        self.seating.map(|seating| seating.start + seating.duration)
    }

    /// Returns the connection from the capturing frame to the captured frame or, if `is_reversed` is true,
    /// in the opposite direction. `name` is the prefix of the names of its joints.
    ///
    /// `X(s) = (p₀ + s d, exp(s θ n) R₀)` is the pose (position `p`, rotation `R`) of the captured frame in
    /// the capturing frame at the fraction `s` of the motion, with `d = p₁ − p₀` and `exp(θ n) = R₁ R₀ᵀ`; the
    /// indices 0 and 1 denote the start and the nominal pose.
    pub(super) fn chain(&self, name: &str, is_reversed: bool) -> Chain {
        let start = self.pose.isometry();
        let rotation = |turn| Isometry3::from_parts(Translation3::identity(), turn);
        let (mut joints, mut travels) = (Vec::new(), Vec::new());
        let mut add = |what: &str, kind: JointKind, travel: f64| {
            joints.push(Joint::new(&format!("{name}:{what}"), kind, Isometry3::identity()));
            travels.push(travel);
        };
        if let Some(end) = self.seating.map(|seating| seating.pose.isometry()) {
            let path = end.translation.vector - start.translation.vector;
            let sign = if is_reversed { -1.0 } else { 1.0 };
            if let Some((direction, distance)) = Unit::<Vector3<f64>>::try_new_and_get(path, 0.0) {
                add("slide", JointKind::Prismatic(direction.into_inner() * sign), distance);
            }
            if let Some((axis, angle)) = (end.rotation * start.rotation.inverse()).axis_angle() {
                add("turn", JointKind::Revolute(axis.into_inner() * sign), angle);
            }
        }
        // X = T(p₀) · slide · turn · R₀,  X⁻¹ = R₀⁻¹ · turn⁻¹ · slide⁻¹ · T(−p₀)
        let (origin, mut pose) = if is_reversed {
            joints.reverse();
            travels.reverse();
            (rotation(start.rotation.inverse()), Isometry3::from(start.translation.inverse()))
        } else {
            (Isometry3::from(start.translation), rotation(start.rotation))
        };
        match joints.first_mut() {
            Some(first) => first.origin = origin,
            None => pose = origin * pose,
        }
        Chain { joints, travels, pose }
    }
}

impl From<Isometry3<f64>> for RigidPose {
    fn from(pose: Isometry3<f64>) -> Self {
        let q = pose.rotation.coords;
        Self { rotation: [q.x, q.y, q.z, q.w], position: pose.translation.vector.into() }
    }
}

impl RigidPose {
    /// Returns the pose as an isometry.
    pub fn isometry(&self) -> Isometry3<f64> {
        let [x, y, z, w] = self.rotation;
        let rotation = UnitQuaternion::new_unchecked(Quaternion::new(w, x, y, z));
        Isometry3::from_parts(Translation3::from(self.position), rotation)
    }
}
