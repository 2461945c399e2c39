//! Motions of the frames to which the sides of contacts are fixed. Sides share frames, so each motion is
//! computed once per instant.

use crate::dynamics::{frame_pose, frame_velocity};
use crate::geometry::Pose;
use crate::simulation::state::State;
use crate::simulation::tree::Tree;
use crate::spatial::{Real, Vec3};

/// Pose and velocity of a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct FrameMotion {
    /// Pose of the frame in W.
    pub(super) frame: Pose,
    /// Velocity of the origin, W axes, m/s.
    pub(super) velocity: Vec3<f64>,
    /// Angular velocity, W axes, rad/s.
    pub(super) angular_velocity: Vec3<f64>,
}

/// Motions of all frames at one instant, each computed on first use.
#[derive(Clone, Debug, Default)]
pub(super) struct Frames {
    /// For each frame, the index of its tree and its index in the model of the tree.
    places: Vec<(usize, usize)>,
    motions: Vec<Option<FrameMotion>>,
}

impl Frames {
    /// Returns the index of the frame at `place` (tree, frame) in this list, after adding the frame if the
    /// list does not contain it.
    pub(super) fn number(&mut self, place: (usize, usize)) -> usize {
        self.places.iter().position(|known| *known == place).unwrap_or_else(|| {
            self.places.push(place);
            self.motions.push(None);
            self.places.len() - 1
        })
    }

    /// Returns the number of frames.
    pub(super) fn len(&self) -> usize {
        self.places.len()
    }

    /// Discards the stored motions, which must be done before the motions of another state are computed.
    pub(super) fn forget(&mut self) {
        self.motions.fill(None);
    }

    /// Returns the motion of the frame with index `number`. Requires the kinematics of `state` in `trees`.
    pub(super) fn motion<S: Real>(
        &mut self,
        number: usize,
        trees: &[Tree<'_, S>],
        state: &State<S>,
    ) -> &FrameMotion {
        self.motions[number].get_or_insert_with(|| motion(self.places[number], trees, state))
    }

    /// Returns true if the stored motions are those of `state`, whose kinematics are in `trees`.
    pub(super) fn are_of<S: Real>(&self, trees: &[Tree<'_, S>], state: &State<S>) -> bool {
        let known = self.places.iter().zip(&self.motions);
        let mut known = known.filter_map(|(place, own)| Some((*place, own.as_ref()?)));
        known.all(|(place, own)| *own == motion(place, trees, state))
    }
}

fn motion<S: Real>((tree, frame): (usize, usize), trees: &[Tree<'_, S>], state: &State<S>) -> FrameMotion {
    let (tree, q) = (&trees[tree], &state.trees[tree].q);
    S::enter(
        #[inline(always)]
        || {
            let pose = frame_pose(&tree.model, &tree.data, q, frame);
            let velocity = frame_velocity(&tree.model, &tree.data, q, frame);
            FrameMotion {
                frame: Pose { rot: pose.rot_wf.map(|x| x.lane(0)), pos: pose.pos_w.lane(0) },
                velocity: (velocity.linear + tree.frame_velocity()).lane(0),
                angular_velocity: velocity.angular.lane(0),
            }
        },
    )
}
