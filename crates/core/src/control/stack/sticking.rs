//! Friction of the joints whose efforts are given: which of them stick.

use super::Stack;
use crate::control::side_by_side::Drive;
use crate::model::Model;
use crate::spatial::Scalar;

/// Rates, rad/s (m/s), over which friction that creeps changes sign: the sign of a smaller one is chance.
const CREEP: f64 = 1e-2;

impl<S: Scalar> Stack<'_, S> {
    /// Adds damping and friction of the joints whose efforts are given to their loads; those at rest that have
    /// friction are taken to be held by it.
    pub(super) fn expect_friction(&mut self, model: &Model) {
        for (j, joint) in model.joints().iter().enumerate() {
            if self.drives[j] != Drive::Effort {
                continue;
            }
            let rate = self.v[j + 6];
            self.side_by_side.load[j] += rate * joint.damping;
            if self.friction_creeps {
                self.side_by_side.load[j] += joint.friction * (rate / CREEP).clamp(-1.0, 1.0);
            } else if rate != 0.0 {
                self.side_by_side.load[j] += joint.friction * rate.signum();
            } else if joint.static_friction > 0.0 {
                self.drives[j] = Drive::Held;
            }
        }
    }

    /// Releases the first held joint that its friction cannot hold, to slip the way it is pushed; whether there
    /// was one. Needs the accelerations of all joints.
    pub(super) fn lets_go(&mut self, model: &Model) -> bool {
        let excess = |j: &usize| {
            let holding = self.side_by_side.holding(*j, self.tau[*j]);
            self.drives[*j] == Drive::Held && holding.abs() > model.joints()[*j].static_friction
        };
        let Some(j) = (0..self.drives.len()).find(excess) else { return false };
        // friction acts as the torque that was to hold the joint, as far as it goes: τ − l, l = … − f sign(λ)
        let holding = self.side_by_side.holding(j, self.tau[j]);
        self.side_by_side.load[j] -= model.joints()[j].friction * holding.signum();
        self.drives[j] = Drive::Effort;
        true
    }
}
