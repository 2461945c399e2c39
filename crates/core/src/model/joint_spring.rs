//! Spring at a joint, with a linear and a cubic term.

use super::error::{ModelError, ModelWarning};
use crate::spatial::Real;

/// Largest accepted magnitude of a stiffness, a cubic stiffness or a rest position, in SI units.
const LARGEST: f64 = 1e20;

/// Spring at a joint, with the torque (force) `τ = −k d − k₃ d³` at the deflection `d = q − q₀` from the rest
/// position `q₀`.
///
/// The torque depends on the position alone, so that the spring stores the energy `½ k d² + ¼ k₃ d⁴` and
/// dissipates none. The damping of the joint is a separate property ([`Joint::damping`](super::Joint)).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointSpring {
    /// Stiffness `k` at the rest position, N m/rad (N/m).
    pub stiffness: f64,
    /// Cubic stiffness `k₃`, N m/rad³ (N/m³): positive for a spring that hardens with its deflection,
    /// negative for one that softens.
    pub cubic_stiffness: f64,
    /// Joint position `q₀` at which the spring exerts no torque, rad (m).
    pub rest_position: f64,
}

impl JointSpring {
    /// Creates a spring from its stiffness, N m/rad (N/m), its cubic stiffness, N m/rad³ (N/m³), and its rest
    /// position, rad (m). Returns `None` if all three are zero, which means that there is no spring.
    pub fn new(stiffness: f64, cubic_stiffness: f64, rest_position: f64) -> Option<Self> {
        let is_given = [stiffness, cubic_stiffness, rest_position] != [0.0; 3];
        is_given.then_some(Self { stiffness, cubic_stiffness, rest_position })
    }

    /// Returns the torque (force) on the joint at the position `q`, rad (m): `−(k + k₃ d²) d`, N m (N).
    #[inline(always)]
    pub fn torque<S: Real>(&self, q: S) -> S {
        let d = q - S::of(self.rest_position);
        -((d * d).mul_add(S::of(self.cubic_stiffness), S::of(self.stiffness)) * d)
    }

    /// Returns the elastic energy at the position `q`, rad (m): `½ k d² + ¼ k₃ d⁴`, J.
    #[inline(always)]
    pub fn energy<S: Real>(&self, q: S) -> S {
        let d = q - S::of(self.rest_position);
        let square = d * d;
        square.mul_add(S::of(0.25 * self.cubic_stiffness), S::of(0.5 * self.stiffness)) * square
    }

    /// Returns the tangent stiffness at the position `q`, rad (m): `k + 3 k₃ d²`, N m/rad (N/m).
    pub fn tangent_stiffness(&self, q: f64) -> f64 {
        let d = q - self.rest_position;
        self.stiffness + 3.0 * self.cubic_stiffness * d * d
    }

    /// Returns the deflection, rad (m), above which the tangent stiffness of a softening spring is negative:
    /// `√(k / (−3 k₃))`. Returns `None` for a spring whose tangent stiffness is never negative.
    pub fn softening_limit(&self) -> Option<f64> {
        (self.cubic_stiffness < 0.0).then(|| (self.stiffness / (-3.0 * self.cubic_stiffness)).sqrt())
    }

    /// Checks the spring of the joint with the name `joint`.
    ///
    /// # Errors
    /// [`ModelError`] for a value that is not finite or exceeds 1e20 in magnitude, a negative stiffness, a
    /// rest position without any stiffness, or a negative cubic stiffness without a linear one.
    pub(super) fn check(&self, joint: &str, is_prismatic: bool) -> Result<(), ModelError> {
        let [linear, cubic] = if is_prismatic { ["N/m", "N/m3"] } else { ["N m/rad", "N m/rad3"] };
        let Self { stiffness, cubic_stiffness, rest_position } = *self;
        for (what, value) in [
            ("the stiffness of the spring", stiffness),
            ("the cubic stiffness of the spring", cubic_stiffness),
            ("the rest position of the spring", rest_position),
        ] {
            if !value.is_finite() {
                return Err(ModelError::NotFinite { what, name: joint.to_owned() });
            }
            if value.abs() > LARGEST {
                let expected = "at most 1e20 in magnitude, in SI units";
                return Err(ModelError::OutOfRange { what, name: joint.to_owned(), value, expected });
            }
        }
        if stiffness < 0.0 {
            let what = "the stiffness of the spring";
            return Err(ModelError::Negative {
                joint: joint.to_owned(),
                what,
                value: stiffness,
                unit: linear,
            });
        }
        if stiffness == 0.0 && cubic_stiffness == 0.0 {
            return Err(ModelError::NoStiffness { joint: joint.to_owned() });
        }
        if stiffness == 0.0 && cubic_stiffness < 0.0 {
            return Err(ModelError::RepellingSpring {
                joint: joint.to_owned(),
                cubic_stiffness,
                unit: cubic,
            });
        }
        Ok(())
    }

    /// Returns a warning if the tangent stiffness is negative at a position within the position limits of the
    /// joint with the name `joint`, or at any position if the joint has no such limits.
    pub(super) fn warning(
        &self,
        joint: &str,
        is_prismatic: bool,
        limits: Option<(f64, f64)>,
    ) -> Option<ModelWarning> {
        let limit = self.softening_limit()?;
        let (lower, upper) = limits.unwrap_or((f64::NEG_INFINITY, f64::INFINITY));
        let reached = (self.rest_position - lower).max(upper - self.rest_position);
        let unit = if is_prismatic { "m" } else { "rad" };
        let is_reached = reached > limit;
        is_reached.then(|| ModelWarning::SofteningSpring { joint: joint.to_owned(), deflection: limit, unit })
    }
}
