//! Latches: captures that happen once two frames are close to each other and their relative velocity is
//! small.

use super::tree::Tree;
use super::tree_state::TreeState;
use crate::dynamics::{frame_pose, frame_velocity};
use crate::spatial::{Real, log_rotation};
use crate::world::Envelope;

/// Fraction by which a value may exceed its bound in the envelope, to allow for rounding errors.
const ROUNDING: f64 = 1e-9;

/// Latch whose capture has not happened.
#[derive(Clone, Debug)]
pub(crate) struct Latch {
    /// Index of the capture among the events of the group.
    pub(super) event: usize,
    /// For the capturing and the captured frame, the index of the tree and the index of the frame in its
    /// model.
    pub(super) frames: [(usize, usize); 2],
    pub(super) envelope: Envelope,
    /// Indices of the declared contacts that must touch.
    pub(super) touching: Vec<usize>,
    /// True if these contacts touched at the start of the step.
    pub(super) is_touching: bool,
    /// True while the conditions hold.
    pub(super) is_held: bool,
}

impl Latch {
    /// Returns the relative margin of the condition that is closest to its bound; it is positive inside the
    /// envelope. Requires the kinematics of `states`, relative to W, in `trees`.
    ///
    /// `min(1 − d/d_max, 1 − θ/θ_max, 1 − v/v_max, 1 − ω/ω_max)`, with the distance `d` of the origins `p_a`
    /// of the capturing and `p_b` of the captured frame, the angle `θ` between the frames, the velocity of
    /// the captured frame's origin as observed in the capturing frame, `v = |v_b − v_a − ω_a × (p_b − p_a)|`,
    /// and `ω = |ω_b − ω_a|`.
    pub(super) fn inside<S: Real>(&self, trees: &[Tree<'_, S>], states: &[TreeState<S>]) -> f64 {
        let [by, of] = self.frames.map(|(tree, frame)| {
            let (tree, q) = (&trees[tree], &states[tree].q);
            (frame_pose(&tree.model, &tree.data, q, frame), frame_velocity(&tree.model, &tree.data, q, frame))
        });
        let offset = of.0.pos_w - by.0.pos_w;
        let turn = log_rotation(&(by.0.rot_wf.transpose() * of.0.rot_wf)).norm().lane(0);
        let rates = of.1 - by.1.referred_to(offset);
        let values = [offset.norm().lane(0), turn, rates.linear.norm().lane(0), rates.angular.norm().lane(0)];
        let bounds = [self.envelope.within, self.envelope.slower_than].concat();
        values.iter().zip(bounds).map(|(value, bound)| 1.0 - value / bound).fold(f64::INFINITY, f64::min)
    }

    /// Returns true if the bounds of the envelope are met within the tolerance for rounding; required contacts
    /// are not checked. `inside` is a value of [`Latch::inside`].
    pub(super) fn holds(inside: f64) -> bool {
        inside >= -ROUNDING
    }

    /// Returns the margin to the next change of [`Latch::is_held`], negative if the change is overdue;
    /// `inside` is a value of [`Latch::inside`]. The margin is infinite while a required contact does not
    /// touch, because contacts begin and cease to touch only between steps.
    pub(super) fn margin(&self, inside: f64) -> f64 {
        if !self.is_touching {
            return f64::INFINITY;
        }
        if self.is_held { inside + 2.0 * ROUNDING } else { -inside }
    }
}
