//! Compliance control: a virtual spring and damper between the tool and its reference.

use super::computed_torque::gain;
use super::control_law::{ControlLaw, EffortInput, EffortWork};
use super::error::ControlError;
use super::gains::{check_matrix, check_numbers};
use crate::model::Model;
use crate::spatial::Motion;

/// Cartesian impedance control without inertia shaping: `τ = Jgᵀ (K e + D ė) − k N q̇`, with the generalized
/// Jacobian `Jg` of the frame and its null-space projector `N`, the joint rates `q̇`, and the pose error `e`
/// and the velocity error `ė` of the frame, desired less actual, linear part first. The errors are in W axes,
/// or in base axes if the reference is relative to the base.
///
/// In free fall there is no gravity load to compensate. Friction is not compensated: the tool may come to
/// rest away from its goal, where the spring torques are below the static friction of the joints. The law is
/// passive: for zero momentum (`ẋ = Jg q̇` with the twist `ẋ` of the frame), no friction and a reference at
/// rest, the power `τᵀ q̇` of the joint torques gives `d/dt (T + U) = −ẋᵀ D ẋ − k |N q̇|² ≤ 0` with the
/// kinetic energy `T` and the spring energy `U = ½ eᵀ K e`. For a reference relative to the base, `ẋ = J q̇`
/// with the Jacobian `J` relative to the base for any momentum, and the law is passive as well. If the robot
/// drifts past a reference fixed in W, the spring pulls the robot, and the robot may gain energy. The
/// rotational spring has a potential energy if its stiffness is the same about all axes, or if the error is
/// small.
///
/// Source: Hogan, J. Dyn. Sys. Meas. Control 107(1), 1985.
#[derive(Clone, Debug)]
pub struct Compliance {
    /// Index of the frame to which the spring is attached.
    pub frame: usize,
    /// Stiffness `K` of the spring, row major `(6, 6)`, N/m and N m/rad.
    pub stiffness: [f64; 36],
    /// Damping `D`, row major `(6, 6)`, N s/m and N m s/rad.
    pub damping: [f64; 36],
    /// Damping `k` of joint motion that does not move the frame, N m s/rad (N s/m for prismatic joints).
    pub null_space_damping: f64,
}

impl Compliance {
    /// Checks the gains.
    ///
    /// # Errors
    /// [`ControlError`] if an entry of `K` or `D` is not finite or exceeds 1e20 in magnitude, if a diagonal
    /// entry is negative, or if the null-space damping is negative, not finite or above 1e20.
    pub fn check(&self) -> Result<(), ControlError> {
        check_matrix("stiffness", &self.stiffness)?;
        check_matrix("damping", &self.damping)?;
        check_numbers("null_space_damping", &[self.null_space_damping])
    }
}

impl ControlLaw for Compliance {
    fn check_group(&self, _: &str, _: &[usize], _: &Model) -> Result<(), ControlError> {
        self.check()
    }

    fn needs_jacobian(&self) -> bool {
        true
    }

    fn efforts(
        &mut self,
        input: &EffortInput<'_>,
        work: EffortWork<'_>,
        tau: &mut [f64],
    ) -> Result<(), ControlError> {
        let &EffortInput { error: (error, velocity_error), jacobian, rates, .. } = input;
        let (k, mut wrench) = (tau.len(), [0.0; 6]);
        let spring = gain(&self.stiffness, Motion::from_slice(error));
        (spring + gain(&self.damping, velocity_error)).write(&mut wrench);
        // τ = Jgᵀ (K e + D ė)
        for (j, tau) in tau.iter_mut().enumerate() {
            *tau = (0..6).map(|i| jacobian[i * k + j] * wrench[i]).sum();
        }
        // − k N q̇
        if self.null_space_damping > 0.0 {
            let null_space_rates = &mut work.scratch[..k];
            work.inverse.factor(jacobian, k, &[0.0]);
            work.inverse.free(jacobian, rates, null_space_rates);
            for (tau, rate) in tau.iter_mut().zip(null_space_rates) {
                *tau -= self.null_space_damping * *rate;
            }
        }
        Ok(())
    }
}
