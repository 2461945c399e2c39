//! Free-floating articulated dynamics for robots in orbit.
//!
//! Each folder uses only those before it in this order: `spatial`, `model`, `geometry`, `dynamics`,
//! `earth`, `gravity`, `orbit`, `environment`, `reference`, `control`, `world`, `contact`, `simulation`,
//! `batch`.
//!
//! # Equation index
//!
//! The concept pages in `docs/concepts` derive these equations and list further functions.
//!
//! | equation | file | function |
//! |-|-|-|
//! | reduced model `M*`, `c*`, `Q*`; generalized Jacobian `Jg` and drift `d` | `dynamics/free_floating.rs` | `kernel`, `reduced_inertia`, `reduce_task` |
//! | signed distance of convex shapes `max over n of (min bᵀn − max aᵀn)` | `geometry/convex.rs` | `closest` |
//! | weights of contact points by area `(A_{i−1} + A_i)/2A` | `geometry/polygon.rs` | `weights` |
//! | forward dynamics by ABA | `dynamics/aba.rs` | `kernel` |
//! | joint with exchanged parent and child `X_cp(q) = X₁⁻¹ R(−a, q) X₀⁻¹` | `model/reroot.rs` | `reversed` |
//! | spring at a joint `τ = −(k + k₃ d²) d` | `model/joint_spring.rs` | `JointSpring::torque` |
//! | velocity after a capture `M v⁺ = Σ J_kᵀ I_k V_k⁻` | `world/impulse.rs` | `connected_velocity` |
//! | momentum projection `v_b = Mbb⁻¹ (h − Mbm q̇)` | `dynamics/momentum.rs` | `projected_base_twist` |
//! | signed distance between two shapes, `max over n of min bᵀn − max aᵀn` | `geometry/closest.rs` | `closest` |
//! | normal force of a contact `F = k xⁿ (1 + d ẋ)` | `contact/normal.rs` | `NormalLaw::force` |
//! | elastic-plastic friction `ż = v` inside the cone, `z = μ N/σ d` on it | `contact/friction.rs` | `Friction::after` |
//! | step of a contact `h = π/(N ω) √(x/x_max)` | `simulation/contacts/step_length.rs` | `longest_step` |
//! | Kepler's equation, ellipse and hyperbola | `orbit/kepler/anomaly.rs` | `solve_ellipse`, `solve_hyperbola` |
//! | `F_k = m_k [g(r_k) − r̈_ref]`; only its tidal part if `gravity_mode: carried` | `environment/differential_gravity.rs` | `GravityMode`, `DifferentialGravity::add` |
//! | common acceleration `ΣF/Σm` by drag and radiation pressure, removed in `carried` mode | `simulation/environment_loads.rs` | `add_relative_to_reference` |
//! | gravity-gradient torque `T = 3μ/r³ r̂ × I r̂`, `T_i = −ε_ijk (I G)_jk` | `environment/gravity_gradient.rs` | `GravityGradient::add`, `torque` |
//! | drag on a face `F = −½ ρ C_D a u`: `a = A (n·u)₊` | `environment/surfaces/face.rs` | `Face::add_drag` |
//! | sums over the faces `−Σ a u`, `−Σ a c × u` | `environment/surfaces/sums.rs` | `DragSums::wrench` |
//! | product of these sums with `½ C_D`; `Drag::add` multiplies by `ρ` | `environment/surfaces/surface_block.rs` | `SurfaceBlock::drag` |
//! | RK4 on SO(3) | `simulation/integrator/rk4.rs` | `rk4` |
//! | computed torque `τ = M* q̈ + c* − Q* + f` | `control/computed_torque.rs` | `kernel` |
//! | computed torque for some joints, given torques for the others | `control/hybrid_dynamics.rs` | `eliminate`, `solve` |

pub mod batch;
pub mod contact;
pub mod control;
pub mod dynamics;
pub mod earth;
pub mod environment;
pub mod geometry;
pub mod gravity;
pub mod model;
pub mod number_text;
pub mod orbit;
pub mod reference;
pub mod simulation;
pub mod spatial;
pub mod text_file;
pub mod world;

#[cfg(doctest)] // runs the examples of this page as doctests
#[doc = include_str!("../../../docs/api/rust.md")]
mod documentation {}
