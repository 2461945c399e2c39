//! Law of rigid impacts: Newton's law of restitution along the normal and Coulomb friction in the tangential
//! plane.

use super::error::ContactError;

/// Law of impacts and of lasting contact between rigid bodies.
///
/// An impact takes no time. At every point, the impulse `p` and the relative velocities `u⁻` before and `u⁺`
/// after it satisfy
///
/// `0 ≤ p_n ⟂ u_n⁺ + e u_n⁻ ≥ 0`, `|p_t| ≤ μ p_n`, and `p_t = −μ p_n u_t⁺/|u_t⁺|` where `u_t⁺ ≠ 0`,
///
/// simultaneously at all points between systems that touch. While the bodies stay in contact, they exert the
/// force that prevents an overlap, limited by the same friction cone.
///
/// Source: Moreau, Unilateral contact and dry friction in finite freedom dynamics, in: Nonsmooth Mechanics
/// and Applications, CISM 302, 1988.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImpactLaw {
    /// Coefficient of restitution `e`, from 0 to 1.
    pub restitution: f64,
    /// Coefficient of friction `μ`, static and kinetic.
    pub friction: f64,
}

impl ImpactLaw {
    /// Speed of separation, m/s, at or below which an impact has no restitution, so that the bodies stay in
    /// contact instead of bouncing infinitely often.
    pub const REST_SPEED: f64 = 1e-5;

    /// Checks the parameters.
    ///
    /// # Errors
    /// [`ContactError::Parameter`] unless the restitution is from 0 to 1 and the friction is finite and not
    /// negative.
    pub fn check(&self) -> Result<(), ContactError> {
        let Self { restitution, friction } = *self;
        if !(0.0..=1.0).contains(&restitution) {
            let range = "from 0 to 1".to_owned();
            return Err(ContactError::Parameter { name: "restitution", got: restitution, range, unit: "" });
        }
        super::error::at_least("coefficient of friction", friction, 0.0, "")
    }
}
