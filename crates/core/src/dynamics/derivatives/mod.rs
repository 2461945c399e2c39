//! Exact first derivatives of the equations of motion.
//!
//! With respect to `q` they are taken in the tangent of [`integrate`](crate::model::integrate): column `j` is the
//! rate along `q ⊕ ε e_j` at `ε = 0`, the base's three shifts, m, and three turns, rad, in its own axes, then the
//! joints. External wrenches are held constant in the axes of their frames, about their origins: they move along
//! with their bodies. Forces in `tau[..6]` are held constant in base axes. So the dynamics do not see where the
//! base is, and the six columns of the base are zero in derivatives with respect to `q`.
//!
//! A change of joint `j` is a motion of its whole subtree `C`. In axes carried along with it nothing changes
//! but what comes through the joint, a velocity `Ψ̇ = v × S` and an acceleration `Ψ̈ = a × S + v × Ψ̇`:
//!
//! ```text
//! ∂f_C/∂q_j = 2B_C Ψ̇ + I_C Ψ̈ + S ×* f_C        ∂f_C/∂q̇_j = 2B_C S + 2 I_C Ψ̇
//! ```
//!
//! Source: Carpentier and Mansard, Robotics: Science and Systems, 2018; Singh, Russell and Wensing, IEEE Robotics
//! and Automation Letters 7(2), 2022.

mod forward;
mod inverse;
mod inverse_mass;
mod task;
mod terms;

pub use forward::forward_dynamics_derivatives;
pub use inverse::inverse_dynamics_derivatives;
pub use task::free_floating_derivatives;
pub use terms::Derivatives;
