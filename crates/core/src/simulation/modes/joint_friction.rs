//! Determination of the joints with static friction that slip and of those that stick.

use crate::dynamics::constrained_recursion;
use crate::model::{Axis, BASE_NQ, BASE_NV};
use crate::simulation::tree::Tree;
use crate::spatial::{Force, Motion, Real};

/// Fraction of the torques at a joint by which the holding torque may exceed its bounds before the joint is
/// released, to allow for rounding errors.
const ROUNDING: f64 = 1e-10;

impl<S: Real> Tree<'_, S> {
    /// Determines the modes of the joints for the step that starts at `q` and `v`. Requires the kinematics
    /// and loads of this state in `data`.
    ///
    /// Initially, all joints at rest are locked. A locked joint is released if holding it requires more
    /// torque than friction and stop provide, and a slipping joint that would accelerate against its
    /// direction of slip is locked again. With bounded torques and a positive definite inertia the solution
    /// is unique. In each pass all inconsistent joints change their modes. After more than `n` passes for `n`
    /// joints, only the first inconsistent joint changes its mode, which prevents cycles (Murty's rule).
    ///
    /// Source: Murty, Linear Algebra and its Applications 7(1), 1974.
    pub(crate) fn solve_modes(&mut self, q: &[S], v: &[S]) {
        if !self.modes.is_active() {
            return;
        }
        self.modes.lock_joints_at_rest(q, v);
        if self.modes.locked().is_none() {
            return;
        }
        let (n, mut a) = (self.model.joint_count(), std::mem::take(&mut self.scratch));
        for pass in 0..4 * n + 8 {
            self.update_joint_forces(q, v);
            let Self { model, data, loops, modes, forces, .. } = self;
            let locked = Some((modes.is_locked_each(), modes.accelerations()));
            constrained_recursion(model, data, loops, (v, forces), locked, &mut a);
            let mut has_changed = false;
            for j in 0..n {
                let change = self.mode_change(j, q, v, &a);
                if let Some(direction) = change {
                    self.modes.set_slip(j, direction);
                    has_changed = true;
                    if pass > n {
                        break;
                    }
                }
            }
            if !has_changed {
                break;
            }
        }
        self.scratch = a;
    }

    /// Returns the new mode of joint `j` if it is at rest: its direction of slip, −1 or 1, or 0 if it should
    /// stick. Returns `None` if the joint moves or its present mode is consistent.
    fn mode_change(&self, j: usize, q: &[S], v: &[S], a: &[S]) -> Option<f64> {
        if v[BASE_NV + j].lane(0) != 0.0 {
            return None;
        }
        if self.modes.is_locked(j) {
            let (margin, direction) = self.stick_margin(j, q);
            return (margin < -0.5 * ROUNDING).then_some(direction);
        }
        let direction = self.modes.direction(j);
        (a[BASE_NV + j].lane(0) * direction < 0.0).then_some(0.0)
    }

    /// Returns the additional torque that locked joint `j` can hold before it slips, relative to the torques
    /// that act on the joint, and the direction in which it would slip, −1 or 1. Requires the holding torques
    /// of an ABA recursion in `data`.
    fn stick_margin(&self, j: usize, q: &[S]) -> (f64, f64) {
        let body = &self.data.bodies[j + 1];
        let (lowest, highest) = self.modes.torque_bounds(j, q[BASE_NQ + j].lane(0));
        let (need, friction) = (body.holding_torque.lane(0), self.modes.holding_friction(j));
        let size = |m: Motion<S>, f: Force<S>| {
            m.linear.norm() * f.linear.norm() + m.angular.norm() * f.angular.norm()
        };
        let along_axis = match self.model.nodes()[j + 1].axis {
            Axis::Revolute => body.force.angular,
            Axis::Prismatic => body.force.linear,
        };
        // λ = Uᵀ a' − τ + Sᵀ pA with the magnitude of each term; U and a' refer to the parent's origin
        let terms = size(body.acceleration.referred_to(-body.offset), body.u_force) + along_axis.norm();
        let scale = terms.lane(0) + self.forces[BASE_NV + j].lane(0).abs() + friction + f64::MIN_POSITIVE;
        let (down, up) = ((highest - need) / scale, (need - lowest) / scale);
        if down < up { (down, -1.0) } else { (up, 1.0) }
    }

    /// Returns the smallest stick margin of the locked joints, which is negative if a joint should slip and
    /// infinite if no joint is locked. Requires the kinematics and loads of `q` and `v` in `data`.
    pub(super) fn least_stick_margin(&mut self, q: &[S], v: &[S]) -> f64 {
        self.update_joint_forces(q, v);
        let mut a = std::mem::take(&mut self.scratch);
        if self.modes.locked().is_some() {
            self.accelerate(v, &mut a);
        }
        self.scratch = a;
        let locked = (0..self.model.joint_count()).filter(|&j| self.modes.is_locked(j));
        locked.map(|j| self.stick_margin(j, q).0 + ROUNDING).fold(f64::INFINITY, f64::min)
    }
}
