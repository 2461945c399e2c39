//! Elastic-plastic friction of a contact.

use super::error::{ContactError, at_least, positive};
use crate::spatial::Vec3;
use serde::{Deserialize, Serialize};

/// Default damping ratio of the bristles.
const DAMPING_RATIO: f64 = 0.1;
/// Damping ratio below which slipping bristles lie on the friction cone immediately. Bristles with more
/// damping approach the cone at the rate `σ/c`, with stiffness `σ` and damping `c`, which a step must
/// resolve.
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
    /// Tangential damping `c` of the bristles, N s/m; `None` selects a damping ratio of 0.1.
    pub damping: Option<f64>,
    /// Coefficient of kinetic torsional friction, m: the moment about the normal per unit of normal force
    /// while the contact slips; 0 for contact at a point.
    pub torsional: f64,
}

/// Deflection of the bristles of a contact, and whether they slip.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Bristle {
    /// Tangential deflection `z` of the second body relative to the first, m.
    pub deflection: Vec3<f64>,
    /// True if the contact slips, false if it sticks.
    pub is_slipping: bool,
}

/// Damping `c` of the bristles, N s/m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BristleDamping {
    /// Damping while the contact sticks.
    pub sticking: f64,
    /// Damping while the contact slips; 0 if slipping bristles lie on the friction cone immediately.
    pub slipping: f64,
}

/// Friction on the second body after a displacement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrictionForce {
    /// Tangential force on the second body, N.
    pub force: Vec3<f64>,
    /// Bristles after the displacement.
    pub bristle: Bristle,
    /// Rate of the deflection of the bristles, m/s: the sliding velocity without its plastic part. For
    /// slipping bristles without damping, the sliding velocity itself.
    pub elastic_rate: Vec3<f64>,
    /// Distance from the next change between sticking and slipping, negative beyond it, with the symbols of
    /// [`Friction::after`]: `1 − |σ z + c v|/(μ N)` while the contact sticks, and `|σ z + c v|/(μ N) − 1`
    /// while it slips; for slipping bristles without damping that are on the cone, the cosine of the angle
    /// between bristles and velocity.
    pub margin: f64,
}

impl Friction {
    /// Returns the friction under the normal force `normal`, N, at the sliding velocity `rate`, m/s, after
    /// the elastic displacement `moved`, m, of the bristles from `start`. The displacement is the integral of
    /// [`FrictionForce::elastic_rate`]. All vectors are tangential.
    ///
    /// With the deflection `z`, the velocity `v = rate`, the normal force `N`, the stiffness `σ` and damping
    /// `c` of the bristles, and the coefficient `μ`, kinetic if `start` slips and otherwise static, the trial
    /// force is `f = σ z + c v`. A contact sticks while `|f| ≤ μ N`: `ż = v` and `F = −f`. Beyond this cone,
    /// `F = −μ N f/|f|`, and bristles that slip carry this force, `σ z + c ż = μ N f/|f|`. The velocity
    /// `v − ż` is that of the slip, parallel to the force. Force and deflection are continuous where the
    /// contact begins or ceases to slip, except for the difference between static and kinetic friction.
    ///
    /// Without damping, slipping bristles have the length `μ N/σ` and turn towards the velocity,
    /// `ḋ = (1 − d dᵀ) v/|z|`. Here `d` is the unit vector along the bristles. For a constant velocity, the
    /// angle `φ` between `d` and `v` obeys `tan φ/2 = tan φ₀/2 exp(−s/|z|)` with the path `s`.
    ///
    /// Source of the return to the cone: Simo and Hughes, Computational Inelasticity, 1998, sections 1.2
    /// and 1.7.
    pub fn after(
        &self,
        start: &Bristle,
        moved: Vec3<f64>,
        rate: Vec3<f64>,
        normal: f64,
        damping: BristleDamping,
    ) -> FrictionForce {
        let is_slipping = start.is_slipping;
        if is_slipping && damping.slipping == 0.0 {
            return self.on_cone(start, moved, rate, normal, damping.sticking);
        }
        let deflection = start.deflection + moved;
        let trial = deflection * self.stiffness + rate * damping.sticking;
        let limit = if is_slipping { self.kinetic_coefficient } else { self.static_coefficient } * normal;
        let beyond = trial.norm() - limit;
        let relative = if limit > 0.0 { beyond / limit } else { beyond / f64::MIN_POSITIVE };
        let margin = if is_slipping { relative } else { -relative };
        let bristle = Bristle { deflection, is_slipping: is_slipping && beyond > 0.0 };
        if beyond <= 0.0 {
            return FrictionForce { force: -trial, bristle, elastic_rate: rate, margin };
        }
        let direction = unit(trial);
        let plastic = if is_slipping { beyond / damping.slipping } else { 0.0 };
        FrictionForce { force: direction * -limit, bristle, elastic_rate: rate - direction * plastic, margin }
    }

    /// Returns the friction of slipping bristles without damping, after the displacement `moved`, m. Bristles
    /// inside the friction cone stick, with the damping `damping`, N s/m. The other arguments are those of
    /// [`Friction::after`].
    fn on_cone(
        &self,
        start: &Bristle,
        moved: Vec3<f64>,
        rate: Vec3<f64>,
        normal: f64,
        damping: f64,
    ) -> FrictionForce {
        let trial = start.deflection + moved;
        let elastic = trial * self.stiffness + rate * damping;
        let limit = self.kinetic_coefficient * normal;
        let beyond = elastic.norm() - limit;
        if beyond <= 0.0 {
            let margin = if limit > 0.0 { beyond / limit } else { 0.0 };
            let bristle = Bristle { deflection: trial, is_slipping: false };
            return FrictionForce { force: -elastic, bristle, elastic_rate: rate, margin };
        }
        let length = limit / self.stiffness;
        let direction = turned(start.deflection, rate, moved.norm(), length);
        let bristle = Bristle { deflection: direction * length, is_slipping: true };
        let margin = cosine(direction, rate);
        FrictionForce { force: direction * -limit, bristle, elastic_rate: rate, margin }
    }

    /// Returns the damping of the bristles of a contact with the reciprocal effective mass `mobility`, 1/kg.
    /// If no damping is given, it is 0 for `mobility` 0.
    pub fn damping_for(&self, mobility: f64) -> BristleDamping {
        // c = 2 ζ √(σ m)
        let with_ratio = |ratio: f64| {
            if mobility > 0.0 { 2.0 * ratio * (self.stiffness / mobility).sqrt() } else { 0.0 }
        };
        let sticking = self.damping.unwrap_or_else(|| with_ratio(DAMPING_RATIO));
        let is_resolved = mobility > 0.0 && sticking >= with_ratio(LEAST_RATIO);
        BristleDamping { sticking, slipping: if is_resolved { sticking } else { 0.0 } }
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
        at_least("coefficient of kinetic friction", self.kinetic_coefficient, 0.0, "")?;
        at_least("coefficient of static friction", self.static_coefficient, self.kinetic_coefficient, "")?;
        at_least("coefficient of torsional friction", self.torsional, 0.0, "m")?;
        positive("tangential stiffness", self.stiffness, "N/m")?;
        at_least("tangential damping", self.damping.unwrap_or(0.0), 0.0, "N s/m")
    }
}

fn cosine(unit: Vec3<f64>, rate: Vec3<f64>) -> f64 {
    let speed = rate.norm();
    if speed > 0.0 { unit.dot(rate) / speed } else { 0.0 }
}

fn unit(v: Vec3<f64>) -> Vec3<f64> {
    let length = v.norm();
    if length > 0.0 { v * (1.0 / length) } else { Vec3::zero() }
}

/// Returns the unit vector along slipping bristles of length `length`, m, that pointed along `from`, after
/// sliding by `path`, m, at the velocity `rate`, m/s. If the velocity or the length is zero, this is the
/// direction of `from`.
fn turned(from: Vec3<f64>, rate: Vec3<f64>, path: f64, length: f64) -> Vec3<f64> {
    let (from, to) = (unit(from), unit(rate));
    if rate.norm() == 0.0 || length <= 0.0 {
        return from;
    }
    let cosine = from.dot(to).clamp(-1.0, 1.0);
    let across = from - to * cosine;
    let sine = across.norm();
    if sine == 0.0 {
        return if cosine < 0.0 { from } else { to };
    }
    // tan φ/2 = sin φ/(1 + cos φ) = (1 − cos φ)/sin φ; only one form is finite near φ = π
    let tangent = if cosine < 0.0 { (1.0 - cosine) / sine } else { sine / (1.0 + cosine) };
    let half = tangent.min(1e100) * (-path / length).exp();
    let scale = 1.0 / (1.0 + half * half);
    // cos φ = (1 − tan² φ/2)/(1 + tan² φ/2),  sin φ = 2 tan φ/2/(1 + tan² φ/2)
    to * ((1.0 - half * half) * scale) + across * (2.0 * half * scale / sine)
}
