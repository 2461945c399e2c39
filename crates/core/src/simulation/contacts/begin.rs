//! Modes of a contact at the start of a step.

use super::mode::{Mode, Phase};
use super::side::{Side, SideMotion};
use super::touching::{Loading, Touching};
use crate::contact::{Bristle, ContactError, Friction, FrictionForce};
use crate::simulation::contact_state::ContactState;
use crate::spatial::Vec3;

/// Two pieces count as far apart if the gap between their bounding spheres exceeds the sum of this fraction
/// of the smaller reach and the distance by which they may approach each other within the step. The reach of
/// a piece is the radius of its bounding sphere about the origin of its frame.
pub(super) const FAR: f64 = 0.1;
/// Fraction of the smaller reach that is subtracted from the gap between the pieces themselves to obtain
/// [`Touching::clearance`].
const CLEAR: f64 = 0.01;
/// Safety factor for the distance that pieces travel within the step at their present velocities.
pub(super) const TRAVEL: f64 = 3.0;
/// Sticking bristles without deflection.
const AT_REST: Bristle = Bristle { deflection: Vec3 { x: 0.0, y: 0.0, z: 0.0 }, is_slipping: false };
/// Largest gap at which pieces count as touching after a step of length zero, in units of the rounding error
/// of a distance. The kinematics before and after such a step differ by more than that error.
const TOUCHING: f64 = 1e3;
/// Relative tolerance within which the margin to a change of mode counts as zero.
const REACHED: f64 = 1e-9;

impl Touching {
    /// Determines the mode for the step from `t` to `end`, s. A mode that was determined at `t` is kept.
    /// Returns the loading in the new mode; `None` if the pieces are far apart. `mobility` returns the
    /// reciprocal effective masses and inertia of the sides at the point of contact; see [`Mode::mobility`].
    pub(super) fn begin(
        &mut self,
        (t, end): (f64, f64),
        motions: &[SideMotion; 2],
        state: &ContactState,
        mobility: impl Fn(&[Side; 2], &Loading) -> [f64; 3],
    ) -> Result<Option<Loading>, ContactError> {
        let is_known = self.mode.since == t;
        let travel = TRAVEL * (end - t) * self.fastest([&motions[0], &motions[1]]);
        let is_far = if is_known { self.mode.phase == Phase::Far } else { self.stays_apart(motions, travel) };
        if is_far {
            (self.mode.phase, self.mode.since) = (Phase::Far, t);
            return Ok(None);
        }
        let mut geometry = self.geometry(self.mode.phase, motions)?;
        if !is_known && !self.has_touched() {
            self.clearance = geometry.0.distance - CLEAR * self.smaller_reach();
            if self.takes_clearance(travel) {
                (self.mode.phase, self.mode.since) = (Phase::Far, t);
                return Ok(None);
            }
        }
        let (rounding, is_repeated) = (self.rounding(motions), self.mode.since == Mode::REPEATED);
        let mut before = self.loading(self.mode.phase, &geometry, motions, state);
        let phase = if is_known { self.mode.phase } else { self.next_phase(&before, rounding) };
        if phase.is_closed() && !self.mode.phase.is_closed() {
            geometry = self.geometry(phase, motions)?;
        }
        if phase == Phase::Pressing && self.mode.mobility[0] == 0.0 {
            // whether the bristles stick depends on their damping, and thus on the mobility
            self.mode.mobility = mobility(&self.sides, &self.loading(phase, &geometry, motions, state));
            before = self.loading(self.mode.phase, &geometry, motions, state);
        }
        self.deepest = self.largest_depth(&before);
        if is_known {
            return Ok(Some(before));
        }
        let [bristle, twist] = self.next_bristles(phase, &before, rounding);
        let mobility = if phase == Phase::Apart { [0.0; 3] } else { self.mode.mobility };
        // without friction, the force depends on nothing but the phase
        let is_same = phase == self.mode.phase && self.law.is_none_or(|law| law.friction.is_none());
        self.mode = Mode {
            phase,
            bristle,
            twist,
            turn: state.turn,
            slip: state.slip,
            normal: before.normal_a,
            mobility,
            activity: self.activity(t, &before),
            slack: [0.0; 3],
            since: t,
        };
        let loading = if is_same { before } else { self.loading(phase, &geometry, motions, state) };
        let slack = |margin: f64| if margin > 0.0 { 0.0 } else { f64::MIN_POSITIVE - 2.0 * margin };
        self.mode.slack = self.margins(&loading).map(slack);
        if is_repeated && self.rigid.is_some() {
            self.mode.slack[0] += self.touching_gap(motions); // the step must not be of length zero again
        }
        Ok(Some(loading))
    }

    /// Returns a bound on the rounding error of the distance between the pieces, m.
    pub(super) fn rounding(&self, [a, b]: &[SideMotion; 2]) -> f64 {
        16.0 * f64::EPSILON * (a.frame.pos.norm() + b.frame.pos.norm() + self.smaller_reach())
    }

    /// Returns the smaller reach of both sides, m.
    pub(super) fn smaller_reach(&self) -> f64 {
        self.sides.iter().map(|side| side.reach).fold(f64::MAX, f64::min)
    }

    /// Returns true if the pieces cannot touch while they travel the distance `travel`, m, towards each
    /// other, according to their bounding spheres or to the gap that an earlier step computed. The result is
    /// the same as if the present gap were computed.
    fn stays_apart(&mut self, motions: &[SideMotion; 2], travel: f64) -> bool {
        if self.has_touched() {
            return false;
        }
        if self.is_far(motions, travel) {
            self.clearance = 0.0;
            return true;
        }
        self.takes_clearance(travel)
    }

    /// Subtracts `travel`, m, from the clearance and returns true if the clearance exceeds `travel`;
    /// otherwise sets the clearance to zero and returns false.
    fn takes_clearance(&mut self, travel: f64) -> bool {
        let is_clear = self.clearance > travel;
        self.clearance = if is_clear { self.clearance - travel } else { 0.0 };
        is_clear
    }

    /// Returns true if, according to their bounding spheres, the pieces cannot touch while they travel the
    /// distance `travel`, m, towards each other.
    pub(super) fn is_far(&self, [a, b]: &[SideMotion; 2], travel: f64) -> bool {
        let [reach_a, reach_b] = [&self.sides[0], &self.sides[1]].map(|side| side.reach);
        let gap = (b.frame.pos - a.frame.pos).norm() - reach_a - reach_b;
        gap > FAR * reach_a.min(reach_b) + travel
    }

    /// Returns an upper bound on the present speed at which points of the pieces approach each other, m/s.
    pub(super) fn fastest(&self, [a, b]: [&SideMotion; 2]) -> f64 {
        let turning = |motion: &SideMotion, reach: f64| {
            if reach.is_finite() { motion.angular_velocity.norm() * reach } else { 0.0 }
        };
        (b.velocity - a.velocity).norm() + turning(a, self.sides[0].reach) + turning(b, self.sides[1].reach)
    }

    fn next_phase(&self, loading: &Loading, rounding: f64) -> Phase {
        let Loading { depth, rate, .. } = *loading;
        let Some(law) = &self.law else { return Phase::Apart };
        let gap = if self.mode.since == Mode::REPEATED { TOUCHING * rounding } else { rounding };
        let is_apart = depth < -gap || (depth < gap && rate <= 0.0);
        let pressing = law.normal.pressing(depth, rate);
        let least = REACHED * law.normal.pressing(depth.abs(), 0.0).abs();
        let is_pressed = match self.mode.phase {
            Phase::Pressing => pressing > least,
            _ => pressing > 0.0,
        };
        match (is_apart, is_pressed) {
            (true, _) => Phase::Apart,
            (false, true) => Phase::Pressing,
            (false, false) => Phase::Separating,
        }
    }

    /// Returns the bristles of sliding friction and those of torsional friction at the start of the next
    /// step, which begins in `phase`.
    fn next_bristles(&self, phase: Phase, loading: &Loading, rounding: f64) -> [Bristle; 2] {
        let friction = self.law.as_ref().and_then(|law| law.friction).filter(|_| phase == Phase::Pressing);
        let Some(friction) = friction else { return [AT_REST; 2] };
        let Mode { bristle, twist, mobility, .. } = &self.mode;
        let sliding = match &loading.friction {
            Some(found) => continued(bristle, found, loading.sliding),
            None => self.begun(&friction, loading, loading.sliding.norm(), mobility[1], rounding),
        };
        let Some(torsion) = friction.torsion() else { return [sliding, AT_REST] };
        let twisting = match &loading.torsion {
            Some(found) => continued(twist, found, Vec3::new(loading.spin, 0.0, 0.0)),
            None => self.begun(&torsion, loading, loading.spin.abs(), mobility[2], rounding),
        };
        [sliding, twisting]
    }

    /// Returns the bristles of pieces that have just touched, for the sliding speed or the rate of turn
    /// `speed`, m/s or rad/s. The bristles slip if their damping force exceeds the limit of friction or, at a
    /// touch-down without a force, if their elastic force would grow faster than that limit.
    fn begun(
        &self,
        friction: &Friction,
        loading: &Loading,
        speed: f64,
        mobility: f64,
        rounding: f64,
    ) -> Bristle {
        let Some(law) = &self.law else { return AT_REST };
        // σ |v_t| > μ dF/dt
        let growth = law.normal.tangent_stiffness(loading.depth) * loading.rate;
        let limit = friction.static_coefficient * law.normal.force(loading.depth, loading.rate).max(0.0);
        let is_without_force = loading.depth <= rounding && law.normal.force(0.0, loading.rate) <= 0.0;
        let is_slipping = friction.damping_for(mobility) * speed > limit
            || (is_without_force && friction.stiffness * speed > friction.static_coefficient * growth);
        Bristle { is_slipping, ..AT_REST }
    }
}

/// Returns the bristles after the last step, which started with the bristles `before`. `rate` is the present
/// sliding velocity, m/s, or rate of turn, rad/s.
fn continued(before: &Bristle, found: &FrictionForce, rate: Vec3<f64>) -> Bristle {
    let is_slipping = if before.is_slipping {
        found.bristle.is_slipping && found.margin > REACHED
    } else {
        found.margin <= REACHED && found.force.dot(rate) <= 0.0
    };
    Bristle { is_slipping, ..found.bristle }
}
