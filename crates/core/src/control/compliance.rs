//! Gravity-free compliance: the tool hangs on a spring and a damper.

use super::computed_torque::gain;
use super::error::ControlError;
use super::gains::{check_matrix, check_numbers};
use super::pseudo_inverse::PseudoInverse;
use crate::spatial::Motion;

/// Cartesian impedance without shaping of the inertia: `τ = Jgᵀ (K e + D ė) − k N q̇`.
///
/// Nothing weighs anything in orbit, so nothing is compensated; nor is friction, which holds the tool off its
/// goal where the spring pulls less than the joints' static friction. It is passive: joint torques work at the
/// rate `τᵀ q̇`, so with the spring's energy `U = ½ eᵀ K e` and zero momentum (`ẋ = Jg q̇`), for a
/// reference at rest
/// `d/dt (T + U) = −ẋᵀ D ẋ − k |N q̇|² ≤ 0`. Relative to the base `ẋ = J q̇` whatever the momentum, and so
/// is the claim. A robot that drifts past a spring fixed in W is pulled by it and may gain energy. The
/// rotational spring has an energy where its stiffness is the same about all axes (or the error small).
///
/// Source: Hogan, J. Dyn. Sys. Meas. Control 107(1), 1985.
#[derive(Clone, Debug)]
pub struct Compliance {
    /// Index of the frame that hangs on the spring.
    pub frame: usize,
    /// `K`, row major `(6, 6)`, N/m and N m/rad.
    pub stiffness: [f64; 36],
    /// `D`, row major `(6, 6)`, N s/m and N m s/rad.
    pub damping: [f64; 36],
    /// `k`, of the motion that the tool does not feel, N m s/rad.
    pub null_space_damping: f64,
}

impl Compliance {
    /// Checks the gains.
    ///
    /// # Errors
    /// [`ControlError`] for gains that are not finite or have a negative diagonal.
    pub fn check(&self) -> Result<(), ControlError> {
        check_matrix("stiffness", &self.stiffness)?;
        check_matrix("damping", &self.damping)?;
        check_numbers("null_space_damping", &[self.null_space_damping])
    }

    /// Torques of a group with the Jacobian `(6, k)` and `rates` `(k,)`.
    pub(super) fn torques(
        &self,
        jacobian: &[f64],
        (error, lag): (Motion<f64>, Motion<f64>),
        rates: &[f64],
        room: &mut ComplianceRoom,
        tau: &mut [f64],
    ) {
        let (k, mut wrench) = (tau.len(), [0.0; 6]);
        (gain(&self.stiffness, error) + gain(&self.damping, lag)).write(&mut wrench);
        // τ = Jgᵀ (K e + D ė)
        for (j, tau) in tau.iter_mut().enumerate() {
            *tau = (0..6).map(|i| jacobian[i * k + j] * wrench[i]).sum();
        }
        if self.null_space_damping > 0.0 {
            let free = &mut room.free[..k];
            room.inverse.factor(jacobian, k, &[0.0]);
            room.inverse.free(jacobian, rates, free);
            tau.iter_mut().zip(free).for_each(|(tau, free)| *tau -= self.null_space_damping * *free);
        }
    }
}

/// Workspace of [`Compliance::torques`].
#[derive(Clone, Debug)]
pub(super) struct ComplianceRoom {
    inverse: PseudoInverse<f64>,
    free: Vec<f64>,
}

impl ComplianceRoom {
    /// For up to `n` joints.
    pub(super) fn new(n: usize) -> Self {
        Self { inverse: PseudoInverse::new(1), free: vec![0.0; n] }
    }
}
