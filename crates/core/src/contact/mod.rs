//! Contact laws: compliant normal forces, elastic-plastic friction, and rigid impacts.
//!
//! | Equation | Function |
//! |-|-|
//! | `F = k xⁿ (1 + d ẋ)` | [`NormalLaw::force`] |
//! | `F = k x + c ẋ` | [`NormalLaw::force`] |
//! | `d v₀ (1 + e) = ln[(1 + d v₀)/(1 − e d v₀)]` | [`dissipation_for`] |
//! | `ż = v` if `\|f\| ≤ μ N`, else `σ z + c ż = μ N f/\|f\|`; `f = σ z + c v` | [`Friction::after`] |
//! | `0 ≤ p_n ⟂ u_n⁺ + e u_n⁻ ≥ 0`, `\|p_t\| ≤ μ p_n` | [`ImpactLaw`] |
//!
//! The normal force `F` depends on the depth `x`; the other symbols are defined in the documentation of the
//! functions.

mod coulomb;
mod declared;
mod error;
mod friction;
mod impact;
mod links;
mod materials;
mod normal;
mod point_impulse;
mod restitution;

pub(crate) use coulomb::{Block, ImpulseProblem, MOST_SWEEPS, Unsolved};
pub use declared::{Contact, ContactLaw, ContactSide, ContactSteps};
pub use error::ContactError;
pub use friction::{Bristle, Friction, FrictionForce};
pub use impact::ImpactLaw;
pub use links::{LinkShapes, links_matching};
pub use materials::{MATERIAL_PAIRS, MaterialPair, material_pair};
pub use normal::NormalLaw;
pub use restitution::dissipation_for;
