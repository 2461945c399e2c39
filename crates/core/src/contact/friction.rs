//! Elastic-plastic friction of a contact.

use super::error::{ContactError, at_least, positive};
use crate::number_text::exact;
use crate::spatial::Vec3;
use serde::{Deserialize, Serialize};

/// Default damping ratio of the bristles.
const DAMPING_RATIO: f64 = 0.1;
/// Smallest damping ratio of the bristles. Slipping bristles approach the friction cone at the rate `σ/c`, with
/// the stiffness `σ` and the damping `c`, and the steps of the integrator must resolve this motion. Without
/// damping, the bristles would reach the cone immediately: changes of the normal force would then change their
/// length, and thus their energy, and the direction of their force could change discontinuously.
const LEAST_RATIO: f64 = 0.01;

/// Coulomb friction with elastic bristles.
///
/// In contrast to the LuGre model, a contact whose load stays inside the friction cone does not creep, even
/// under oscillating loads, and returns to its initial position when the load is removed.
///
/// Source: Dupont, Hayward, Armstrong and Altpeter, Single State Elastoplastic Friction Models, IEEE
/// Transactions on Automatic Control 47(5), 2002. The transition between elastic and plastic motion is
/// omitted, as in Simo and Hughes, Computational Inelasticity, 1998, chapter 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Friction {
    /// Coefficient of static friction, at least the kinetic coefficient.
    pub static_coefficient: f64,
    /// Coefficient of kinetic friction.
    pub kinetic_coefficient: f64,
    /// Tangential stiffness `σ`, N/m.
    pub stiffness: f64,
    /// Tangential damping `c` of the bristles, N s/m; `None` selects a damping ratio of 0.1. Damping ratios below
    /// 0.01 are replaced by 0.01.
    pub damping: Option<f64>,
    /// Coefficient of kinetic torsional friction, m: the moment about the normal per unit of normal force
    /// while the contact slips; 0 for contact at a point.
    pub torsional: f64,
}

/// State of the bristles of a contact: their deflection, and whether they slip.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Bristle {
    /// Tangential deflection `z` of the second body relative to the first, m.
    pub deflection: Vec3<f64>,
    /// True if the contact slips, false if it sticks.
    pub is_slipping: bool,
}

/// Friction force on the second body after a displacement, and the state of the bristles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrictionForce {
    /// Tangential force on the second body, N.
    pub force: Vec3<f64>,
    /// Bristles after the displacement.
    pub bristle: Bristle,
    /// Rate of the deflection of the bristles, m/s: the sliding velocity without its plastic part.
    pub elastic_rate: Vec3<f64>,
    /// Margin before the next change between sticking and slipping, relative to the limit `μ N` and
    /// negative beyond the change, with the symbols of [`Friction::after`]: `1 − |σ z + c v|/(μ N)` while
    /// the contact sticks, and `|σ z + c v|/(μ N) − 1` while it slips.
    pub margin: f64,
}

impl Friction {
    /// Returns the friction under the normal force `normal`, N, at the sliding velocity `rate`, m/s, after
    /// the elastic displacement `moved`, m, of the bristles from `start`. The displacement is the integral of
    /// [`FrictionForce::elastic_rate`]. All vectors are tangential.
    ///
    /// With the deflection `z`, the velocity `v = rate`, the normal force `N`, the stiffness `σ` and the
    /// damping `c = damping`, N s/m, of the bristles, and the coefficient `μ`, kinetic if `start` slips and
    /// otherwise static, the trial force is `f = σ z + c v`. A contact sticks while `|f| ≤ μ N`: `ż = v` and
    /// the force on the second body is `F = −f`. Beyond this cone, `F = −μ N f/|f|`, and bristles that slip
    /// transmit this force, `σ z + c ż = μ N f/|f|`. The velocity `v − ż` is that of the slip, parallel to
    /// the force. Force and deflection are continuous where the contact begins or ceases to slip, except for
    /// the difference between static and kinetic friction.
    ///
    /// Source of the return to the cone: Simo and Hughes, Computational Inelasticity, 1998, sections 1.2
    /// and 1.7.
    pub fn after(
        &self,
        start: &Bristle,
        moved: Vec3<f64>,
        rate: Vec3<f64>,
        normal: f64,
        damping: f64,
    ) -> FrictionForce {
        let is_slipping = start.is_slipping;
        let deflection = start.deflection + moved;
        let trial = deflection * self.stiffness + rate * damping;
        let limit = if is_slipping { self.kinetic_coefficient } else { self.static_coefficient } * normal;
        let beyond = trial.norm() - limit;
        let relative = if limit > 0.0 { beyond / limit } else { beyond / f64::MIN_POSITIVE };
        let margin = if is_slipping { relative } else { -relative };
        let bristle = Bristle { deflection, is_slipping: is_slipping && beyond > 0.0 };
        if beyond <= 0.0 {
            return FrictionForce { force: -trial, bristle, elastic_rate: rate, margin };
        }
        let direction = unit(trial);
        let plastic = if is_slipping { beyond / damping } else { 0.0 };
        FrictionForce { force: direction * -limit, bristle, elastic_rate: rate - direction * plastic, margin }
    }

    /// Returns the damping of the bristles, N s/m, of a contact with the reciprocal effective mass `mobility`,
    /// 1/kg. This is [`Friction::damping`], or that of a damping ratio of 0.1 if none is given, but at least
    /// that of a damping ratio of 0.01. If `mobility` is 0 because the mass is unknown, it is the given
    /// damping, or 0 if none is given.
    pub fn damping_for(&self, mobility: f64) -> f64 {
        // c = 2 ζ √(σ m)
        let critical = if mobility > 0.0 { 2.0 * (self.stiffness / mobility).sqrt() } else { 0.0 };
        self.damping.unwrap_or(DAMPING_RATIO * critical).max(LEAST_RATIO * critical)
    }

    /// Returns the law of the moment about the normal, N m, as a function of the angle of twist, rad; `None`
    /// without torsional friction. The coefficients of the returned law are in m, its stiffness in N m/rad
    /// and its damping in N m s/rad. A patch with the effective radius `r = τ/μ`, where `τ` and `μ` are the
    /// coefficients of torsional and kinetic friction, has the torsional stiffness `σ r²`; `μ = 0` is treated
    /// as 1.
    pub fn torsion(&self) -> Option<Self> {
        if self.torsional == 0.0 {
            return None;
        }
        let has_sliding = self.kinetic_coefficient > 0.0;
        let radius = if has_sliding { self.torsional / self.kinetic_coefficient } else { self.torsional };
        let ratio = if has_sliding { self.static_coefficient / self.kinetic_coefficient } else { 1.0 };
        Some(Self {
            static_coefficient: self.torsional * ratio,
            kinetic_coefficient: self.torsional,
            stiffness: self.stiffness * radius * radius,
            damping: self.damping.map(|damping| damping * radius * radius),
            torsional: 0.0,
        })
    }

    /// Returns the elastic energy, J, of bristles with the deflection `z`, m, and the stiffness `σ`:
    /// `½ σ z²`.
    pub fn elastic_energy(&self, deflection: Vec3<f64>) -> f64 {
        0.5 * self.stiffness * deflection.dot(deflection)
    }

    /// Checks the parameters.
    ///
    /// # Errors
    /// [`ContactError::Parameter`] for a coefficient or a damping below 0, a static coefficient below the
    /// kinetic one, a stiffness that is not positive, or a parameter that is not finite.
    pub fn check(&self) -> Result<(), ContactError> {
        at_least("coefficient of static friction", self.static_coefficient, 0.0, "")?;
        at_least("coefficient of kinetic friction", self.kinetic_coefficient, 0.0, "")?;
        if self.static_coefficient < self.kinetic_coefficient {
            let kinetic = exact(self.kinetic_coefficient);
            let (name, got) = ("coefficient of static friction", self.static_coefficient);
            let range = format!("at least {kinetic}, the coefficient of kinetic friction");
            return Err(ContactError::Parameter { name, got, range, unit: "" });
        }
        at_least("coefficient of torsional friction", self.torsional, 0.0, "m")?;
        positive("tangential stiffness", self.stiffness, "N/m")?;
        at_least("tangential damping", self.damping.unwrap_or(0.0), 0.0, "N s/m")
    }
}

fn unit(v: Vec3<f64>) -> Vec3<f64> {
    let length = v.norm();
    if length > 0.0 { v * (1.0 / length) } else { Vec3::zero() }
}
