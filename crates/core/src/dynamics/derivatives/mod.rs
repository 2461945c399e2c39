//! Exact first derivatives of the equations of motion.
//!
//! Derivatives with respect to `q` are in the tangent space of [`integrate`](crate::model::integrate): column
//! `j` is the derivative along `q ⊕ ε e_j` at `ε = 0`. The first six columns are the translation, m, and the
//! rotation, rad, of the base in base axes; the columns of the joints follow. External wrenches are held
//! constant in the axes of their frames, about the frame origins, so they move with their bodies. Forces in
//! `tau[..6]` are held constant in base axes. The dynamics are therefore independent of the pose of the base,
//! and the first six columns of the derivatives of generalized forces and accelerations with respect to `q`
//! are zero. For accelerations and twists in W axes, the first three of these columns are zero, but the other
//! three are not, because a rotation of the base rotates these vectors.
//!
//! A change of the position of joint `j` moves its whole subtree `C`. In axes that move with the subtree, the
//! forces change only because of the velocity `Ψ̇ = v × S` and the acceleration `Ψ̈ = a × S + v × Ψ̇` of the
//! joint axis, with the motion subspace `S` of the joint and the twist `v` and acceleration `a` of its body.
//! With the composite inertia `I_C`, the Coriolis operator `2B_C` and the force `f_C` through the joint, the
//! derivatives of this force are
//!
//! ```text
//! ∂f_C/∂q_j = 2B_C Ψ̇ + I_C Ψ̈ + S ×* f_C        ∂f_C/∂q̇_j = 2B_C S + 2 I_C Ψ̇
//! ```
//!
//! Source: Carpentier and Mansard, Robotics: Science and Systems, 2018; Singh, Russell and Wensing, IEEE
//! Robotics and Automation Letters 7(2), 2022.

mod forward;
mod inverse;
mod inverse_mass;
mod task;
mod terms;

pub use forward::forward_dynamics_derivatives;
pub use inverse::inverse_dynamics_derivatives;
pub use task::free_floating_derivatives;
pub use terms::Derivatives;
