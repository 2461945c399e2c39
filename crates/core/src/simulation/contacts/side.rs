//! One side of a contact, and its motion.

use super::frames::FrameMotion;
use crate::dynamics::base_rotation;
use crate::geometry::{Pose, Shape};
use crate::simulation::tree::Tree;
use crate::simulation::tree_state::TreeState;
use crate::spatial::{Force, Real, Vec3};
use crate::world::FrameIndex;

/// Convex piece of one side, fixed to a frame of a tree.
#[derive(Clone, Debug)]
pub(super) struct Side {
    /// Frame to which the piece is declared to be fixed.
    pub(super) declared: FrameIndex,
    /// Index of the tree, and index of the frame in the model of the tree.
    pub(super) place: (usize, usize),
    /// Index of the frame in the list of the frames of all contacts.
    pub(super) number: usize,
    pub(super) shape: Shape,
    pub(super) pose: Pose,
    /// Index of the piece among those of its side of the contact.
    pub(super) piece: usize,
    /// Distance from the origin of the frame to the farthest point of the shape, m; infinite for a
    /// half-space.
    pub(super) reach: f64,
}

/// Pose and velocity of a side.
#[derive(Clone, Copy)]
pub(super) struct SideMotion {
    /// Pose of the shape in W.
    pub(super) shape: Pose,
    /// Pose of the frame in W.
    pub(super) frame: Pose,
    /// Velocity of the origin of the frame, W axes, m/s.
    pub(super) velocity: Vec3<f64>,
    /// Angular velocity, W axes, rad/s.
    pub(super) angular_velocity: Vec3<f64>,
}

impl Side {
    /// Returns the motion of the side from the motion of its frame.
    #[inline]
    pub(super) fn motion(&self, motion: &FrameMotion) -> SideMotion {
        let FrameMotion { frame, velocity, angular_velocity } = *motion;
        let shape = Pose { rot: frame.rot * self.pose.rot, pos: frame.rot * self.pose.pos + frame.pos };
        SideMotion { shape, frame, velocity, angular_velocity }
    }

    /// Adds a force, N, at `point` and a moment, N m, to the wrench on the body of the side; all are in W.
    pub(super) fn add_wrench<S: Real>(
        &self,
        trees: &mut [Tree<'_, S>],
        states: &[TreeState<S>],
        wrench: [Vec3<f64>; 2],
        point: Vec3<f64>,
    ) {
        let (tree, frame) = self.place;
        let (tree, q) = (&mut trees[tree], &states[tree].q);
        let body = tree.model.frames()[frame].body;
        let body = &mut tree.data.bodies[body];
        S::enter(
            #[inline(always)]
            || {
                let rot_wb = base_rotation(q);
                let [force, moment] = wrench.map(|vector| rot_wb.transpose_mul(Vec3::of(&vector)));
                let arm = rot_wb.transpose_mul(Vec3::of(&point) - Vec3::from_slice(q)) - body.pos_b;
                body.external += Force::at(force, moment, arm);
            },
        );
    }
}

impl SideMotion {
    /// Returns the velocity in W, m/s, of the material point of the side that is at `point` in W, m.
    pub(super) fn velocity_at(&self, point: Vec3<f64>) -> Vec3<f64> {
        self.velocity + self.angular_velocity.cross(point - self.frame.pos)
    }
}
