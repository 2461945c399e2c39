//! Margins of the joints of a tree to the next change of a mode, and corrections of the state at such a
//! change.

use super::joint_modes::AT_LIMIT;
use crate::model::{BASE_NQ, BASE_NV};
use crate::simulation::tree::Tree;
use crate::simulation::tree_state::TreeState;
use crate::spatial::Real;

/// One tree with its states at the start and at the end of a step.
pub(super) struct ModesOfStep<'a, 's, S> {
    pub(super) tree: &'a Tree<'s, S>,
    pub(super) start: &'a TreeState<S>,
    pub(super) end: &'a TreeState<S>,
    /// True if changes between slip and rest do not end the step.
    pub(super) ignores_slip: bool,
}

impl<S: Real> ModesOfStep<'_, '_, S> {
    fn joints(&self) -> std::ops::Range<usize> {
        0..self.tree.model.joint_count()
    }

    /// Returns the smallest margin of the joints that are not locked; it is negative beyond a change of mode.
    pub(super) fn least_margin(&self) -> f64 {
        let margin = |j| self.slip_margin(j).min(self.limit_margin(j));
        self.joints().map(margin).fold(f64::INFINITY, f64::min)
    }

    /// Returns the rate at the end of the step of slipping joint `j` in its direction of slip, relative to
    /// the sum of the magnitudes of its rates at both ends of the step; infinity for other joints, for joints
    /// without friction, and if slip is ignored.
    fn slip_margin(&self, j: usize) -> f64 {
        let modes = &self.tree.modes;
        let direction = modes.direction(j);
        if self.ignores_slip || direction == 0.0 || !modes.has_friction(j) {
            return f64::INFINITY;
        }
        let (first, last) = (self.start.v[BASE_NV + j].lane(0), self.end.v[BASE_NV + j].lane(0));
        direction * last / (first.abs() + last.abs()).max(f64::MIN_POSITIVE)
    }

    /// Returns the distance of joint `j` from its nearer position limit at the end of the step, relative to
    /// the distance at the start of the step; infinity for locked joints and for joints without stops.
    fn limit_margin(&self, j: usize) -> f64 {
        let modes = &self.tree.modes;
        let (lower, upper) = modes.limits(j);
        if modes.is_locked(j) || (lower, upper) == (f64::NEG_INFINITY, f64::INFINITY) {
            return f64::INFINITY;
        }
        let (first, last) = (self.start.q[BASE_NQ + j].lane(0), self.end.q[BASE_NQ + j].lane(0));
        let distance = |q: f64| (upper - q).min(q - lower);
        (distance(last) + AT_LIMIT) / (distance(first).abs() + AT_LIMIT)
    }

    /// Returns the index of the first joint that would start to slip and immediately reverse its direction;
    /// `None` if there is none.
    pub(super) fn first_that_slips_back(&self) -> Option<usize> {
        let slips_back = |j: &usize| self.start.v[BASE_NV + j].lane(0) == 0.0 && self.slip_margin(*j) <= 0.0;
        self.joints().find(slips_back)
    }

    /// Returns the rate of the first joint that moves into its stop or, if there is none, of the first joint
    /// that came to rest, rad/s or m/s: the larger of the magnitudes at both ends of the step. Returns `None`
    /// if there is no such joint.
    pub(super) fn rate_of_first_stopped(&self) -> Option<f64> {
        let rate = |state: &TreeState<S>, j: usize| state.v[BASE_NV + j].lane(0).abs();
        let came_to_rest = |j: &usize| rate(self.end, *j) == 0.0 && rate(self.start, *j) > 0.0;
        let stopped = self.tree.first_impact(self.end).or_else(|| self.joints().find(came_to_rest));
        stopped.map(|j| rate(self.start, j).max(rate(self.end, j)))
    }
}

impl<S: Real> Tree<'_, S> {
    /// Removes rounding errors at a change of mode: sets the rates of joints that came to rest to zero, and
    /// moves joints that are beyond a position limit to that limit.
    pub(super) fn snap_to_event(&self, start: &TreeState<S>, state: &mut TreeState<S>) {
        let modes = &self.modes;
        for j in 0..self.model.joint_count() {
            let direction = modes.direction(j) * f64::from(modes.has_friction(j));
            let (first, rate) = (start.v[BASE_NV + j].lane(0), state.v[BASE_NV + j].lane(0));
            if direction != 0.0 && direction * rate <= 1e-13 * first.abs() {
                state.v[BASE_NV + j] = S::of(0.0);
            }
            let (lower, upper) = modes.limits(j);
            let q = state.q[BASE_NQ + j].lane(0);
            if !modes.is_locked(j) && (q > upper || q < lower) {
                state.q[BASE_NQ + j] = S::of(q.clamp(lower, upper));
            }
        }
    }
}
