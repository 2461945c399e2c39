//! Length of the steps while bodies touch or approach each other.

use super::mode::{Mode, Phase};
use super::side::SideMotion;
use super::touching::{Loading, Touching};
use crate::contact::{Bristle, ContactLaw, ContactSteps, Friction};
use crate::geometry::Shape;
use std::f64::consts::PI;

/// Depth, as a fraction of the smaller reach, to which pieces may overlap at the end of a step in which they
/// touch, before the instant of the touch-down is located.
const OVERLAP: f64 = 0.25;
/// Smallest exponent other than 1 of an elastic force whose derivatives at zero depth do not limit the order
/// of the integrator.
const SMOOTH: f64 = 4.0;
/// Smallest number of steps in half a period with which the integration of a contact at rest is stable.
const LEAST_STEPS: f64 = 8.0;
/// Phase of an oscillation, rad, after which the influence of a previous amplitude on the step length has
/// decreased by the factor e.
const MEMORY: f64 = 4.0 * PI;

/// Largest rates of a contact at the largest depth of its present motion.
struct Rates {
    /// Largest depth of the present motion, m.
    depth: f64,
    /// Angular frequencies of the oscillations along and across the normal, rad/s.
    frequencies: [f64; 2],
    /// Rates of decay of the motions along and across the normal, 1/s.
    decays: [f64; 2],
    /// Rate at which slipping bristles approach the friction cone, 1/s.
    relaxation: f64,
}

impl Rates {
    /// Computes the frequencies `√(k' W)` and the decay rates `c' W`, 1/s, from the reciprocal effective mass
    /// `W` in `mode`, and the tangent stiffness `k'` and the tangent damping `c'` at the largest depth
    /// `depth`, m.
    fn of(law: &ContactLaw, mode: &Mode, depth: f64) -> Self {
        let [normal, tangential, turning] = mode.mobility;
        // slipping bristles have a constant length and do not oscillate
        let friction = law.friction.filter(|_| !mode.bristle.is_slipping);
        let torsion =
            law.friction.and_then(|friction| friction.torsion()).filter(|_| !mode.twist.is_slipping);
        let rates = |friction: Option<Friction>, mobility: f64| {
            let own = |friction: Friction| {
                [(friction.stiffness * mobility).sqrt(), friction.damping_for(mobility) * mobility]
            };
            friction.map_or([0.0; 2], own)
        };
        let [sliding, twisting] = [rates(friction, tangential), rates(torsion, turning)];
        let relaxation = |friction: Friction, bristle: &Bristle, mobility: f64| {
            if bristle.is_slipping { friction.stiffness / friction.damping_for(mobility) } else { 0.0 }
        };
        let relaxations = law.friction.map_or(0.0, |friction| {
            let twist = friction.torsion().map_or(0.0, |torsion| relaxation(torsion, &mode.twist, turning));
            relaxation(friction, &mode.bristle, tangential).max(twist)
        });
        Self {
            depth,
            frequencies: [(law.normal.tangent_stiffness(depth) * normal).sqrt(), sliding[0].max(twisting[0])],
            decays: [law.normal.tangent_damping(depth) * normal, sliding[1].max(twisting[1])],
            relaxation: relaxations,
        }
    }

    fn fastest(&self) -> f64 {
        self.frequencies.iter().chain(&self.decays).copied().fold(0.0, f64::max)
    }
}

impl Touching {
    /// Returns the largest depth, m, that the present motion will reach, or the present depth as long as the
    /// effective mass is unknown.
    pub(super) fn largest_depth(&self, loading: &Loading) -> f64 {
        match (&self.law, self.mode.mobility[0]) {
            (Some(law), mobility) if mobility > 0.0 => {
                law.normal.largest_depth(1.0 / mobility, loading.depth.max(0.0), loading.rate)
            }
            _ => loading.depth,
        }
    }

    /// Returns the longest permitted step, s, from a state with these motions and this loading.
    ///
    /// While the bodies press on each other, the step is `h = π/(N ω)` with the largest rate `ω` of the
    /// contact and `N` steps. The local error is proportional to the amplitude `a` of the oscillation and to
    /// `N⁻⁵`, so that `N ∝ a^(1/4)` suffices for a contact that comes to rest. For exponents `1 < n < 4`,
    /// derivatives of `xⁿ` are unbounded at touch-down and lift-off, where the step is therefore shortened to
    /// `h √(x/x_max)`, but not below `h π/N`, with the depth `x` and its largest value `x_max` in the present
    /// motion. This restores order four: the sum of the local errors `h⁵ x^(n−4)` then converges.
    ///
    /// While the bodies do not press on each other, they may overlap by at most a quarter of the smaller
    /// reach at the end of the step. The step is not limited for bodies that are far apart, and for contacts
    /// with neither compliant forces nor an impact law.
    ///
    /// With an external engine (`has_engine`) the touch-down is not located. A step then extends beyond the
    /// touch-down by at most the length of a step during the impact.
    pub(super) fn longest_step(
        &self,
        steps: ContactSteps,
        motions: &[SideMotion; 2],
        loading: &Loading,
        has_engine: bool,
    ) -> f64 {
        let Some(law) = &self.law else {
            let gap = (-loading.depth).max(0.0);
            let is_rigid = self.rigid.is_some() && self.mode.phase != Phase::Far;
            let [a, b] = motions;
            return if is_rigid {
                (gap + OVERLAP * self.smaller_reach()) / self.fastest([a, b])
            } else {
                f64::INFINITY
            };
        };
        match self.mode.phase {
            Phase::Far => f64::INFINITY,
            Phase::Apart | Phase::Separating => {
                let [a, b] = motions;
                let (gap, speed) = ((-loading.depth).max(0.0), self.fastest([a, b]));
                if has_engine && speed > 0.0 {
                    let depth = law.normal.largest_depth(1.0 / self.mode.mobility[0], 0.0, speed);
                    let fastest = Rates::of(law, &self.mode, depth).fastest();
                    gap / speed + PI / (steps.count as f64 * fastest)
                } else {
                    (gap + OVERLAP * self.smaller_reach()) / speed
                }
            }
            Phase::Pressing => {
                let rates = Rates::of(law, &self.mode, self.deepest);
                let lively = steps.count as f64 * self.mode.activity.powf(0.25);
                let count = lively.max(LEAST_STEPS.min(steps.count as f64));
                // slipping bristles follow the cone: their steps need only be stable
                let h = (PI / (count * rates.fastest())).min(1.0 / rates.relaxation);
                let is_smooth =
                    !steps.is_graded || law.normal.exponent() == 1.0 || law.normal.exponent() >= SMOOTH;
                let fraction = if is_smooth {
                    1.0
                } else {
                    (loading.depth.max(0.0) / rates.depth).sqrt().max(PI / count)
                };
                h * fraction.min(1.0)
            }
        }
    }

    /// Returns the elastic energy at the largest depth of the present motion, J. Returns zero for pieces that
    /// do not press on each other, and for a sphere on any piece except a torus, because the force is then
    /// smooth. The nearest point of a torus may jump along its circle.
    pub(super) fn energy(&self) -> f64 {
        let any = |is: fn(&Shape) -> bool| self.sides.iter().any(|side| is(&side.shape));
        let is_smooth = any(|shape| matches!(shape, Shape::Sphere { .. }))
            && !any(|shape| matches!(shape, Shape::Torus { .. }));
        match &self.law {
            Some(law) if self.mode.phase == Phase::Pressing && !is_smooth => {
                law.normal.elastic_energy(self.deepest)
            }
            _ => 0.0,
        }
    }

    /// Returns the amplitude of the oscillation of the contact relative to its depth and to the length of
    /// slipping bristles: the present amplitude or, if larger, the previous amplitude, which decays within a
    /// few periods. It is at most 1. For pieces that do not press on each other, it is 1.
    pub(super) fn activity(&self, t: f64, loading: &Loading) -> f64 {
        let Some(law) = &self.law else { return 1.0 };
        if self.mode.phase != Phase::Pressing || self.mode.mobility[0] == 0.0 {
            return 1.0;
        }
        let rates = Rates::of(law, &self.mode, self.deepest);
        let [normal, tangential] = rates.frequencies;
        let remembered = self.mode.activity * (-(t - self.mode.since) * normal / MEMORY).exp();
        let mut activity = remembered.max(loading.rate.abs() / (normal * rates.depth));
        if let Some(friction) = law.friction.filter(|_| tangential > 0.0) {
            let length = friction.kinetic_coefficient * loading.normal_force() / friction.stiffness;
            activity = activity.max(loading.sliding.norm() / (tangential * length).max(f64::MIN_POSITIVE));
        }
        activity.min(1.0)
    }
}
