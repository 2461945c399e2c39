//! Integrated quantities of a contact between two pieces.

use crate::spatial::Vec3;
use serde::{Deserialize, Serialize};

/// Displacements, energies and impulses of a contact, integrated while the contact acts.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct ContactState {
    /// Elastic part of the sliding displacement of the second side relative to the first, in axes of the
    /// first side, m. While the contact sticks, or slips without damping, the whole displacement counts as
    /// elastic.
    pub(super) slip: Vec3<f64>,
    /// Elastic part of the angle by which the second side turns about the normal relative to the first, rad.
    pub(super) turn: f64,
    /// Energy that the normal force has removed from the motion, J, by dissipation or by elastic storage.
    pub(super) normal_work: f64,
    /// Energy that the law of the normal force dissipates while the pieces press on each other, J. Except for
    /// errors of the integrator, it is `normal_work` less the elastic energy.
    pub(super) normal_loss: f64,
    /// Energy that friction has removed from the motion, J, by dissipation or by storage in the bristles.
    pub(super) friction_work: f64,
    /// Impulse on the second side, W axes, N s.
    pub(super) impulse: Vec3<f64>,
    /// Angular impulse on the second side, W axes, N m s: the integral of the moments about the point at
    /// which the links of the contact touched last.
    pub(super) angular_impulse: Vec3<f64>,
}

/// Time derivative of [`ContactState`].
pub(super) type ContactRate = ContactState;

impl ContactState {
    /// State of a contact before its pieces touch for the first time.
    pub(super) const ZERO: Self = {
        let zero = Vec3 { x: 0.0, y: 0.0, z: 0.0 };
        Self {
            slip: zero,
            turn: 0.0,
            normal_work: 0.0,
            normal_loss: 0.0,
            friction_work: 0.0,
            impulse: zero,
            angular_impulse: zero,
        }
    };

    /// Returns `self + h rate` with the time step `h`, s.
    pub(super) fn plus(&self, rate: &ContactRate, h: f64) -> Self {
        Self {
            slip: rate.slip.scale_add(h, self.slip),
            turn: rate.turn.mul_add(h, self.turn),
            normal_work: rate.normal_work.mul_add(h, self.normal_work),
            normal_loss: rate.normal_loss.mul_add(h, self.normal_loss),
            friction_work: rate.friction_work.mul_add(h, self.friction_work),
            impulse: rate.impulse.scale_add(h, self.impulse),
            angular_impulse: rate.angular_impulse.scale_add(h, self.angular_impulse),
        }
    }
}
