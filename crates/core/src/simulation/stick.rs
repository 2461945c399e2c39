//! Who slips and who sticks, and what happens at stops.

use super::plant::{Plant, World};
use super::state::State;
use crate::dynamics::locked_dynamics_recursion;
use crate::model::Axis;
use crate::spatial::{Force, Motion, Real};

/// Share of the torques at a joint within which it still sticks: rounding must not break it away.
const ROUNDING: f64 = 1e-10;

impl<S: Real, W: World<S>> Plant<'_, S, W> {
    /// Modes of the joints for the step that starts here. Needs kinematics and wrenches.
    ///
    /// Joints at rest are locked; one that needs more torque than friction and stop have slips the
    /// way it is pushed, and one that would then move the other way sticks after all. Torques within
    /// bounds and a positive definite inertia have one solution. All joints change at once while
    /// that settles; then, as long as they go in circles, only the first of them (Murty).
    ///
    /// Source: Murty, Linear Algebra and its Applications 7(1), 1974.
    pub(crate) fn decide(&mut self, q: &[S], v: &[S]) {
        if !self.contacts.is_active() {
            return;
        }
        self.contacts.guess(q, v);
        if self.contacts.locked().is_none() {
            return;
        }
        let (n, mut a) = (self.model.joint_count(), std::mem::take(&mut self.scratch));
        for pass in 0..4 * n + 8 {
            self.drive(v);
            let Self { model, data, contacts, forces, .. } = self;
            locked_dynamics_recursion(model, data, v, forces, contacts.modes(), &mut a);
            let mut is_settled = true;
            for j in 0..n {
                let change = self.revision(j, q, v, &a);
                if let Some(change) = change {
                    if change == 0.0 {
                        self.contacts.lock(j)
                    } else {
                        self.contacts.release(j, change)
                    }
                    is_settled = false;
                    if pass > n {
                        break;
                    }
                }
            }
            if is_settled {
                break;
            }
        }
        self.scratch = a;
    }

    /// What a joint at rest should do instead: slip in a direction, or stick (0).
    fn revision(&self, j: usize, q: &[S], v: &[S], a: &[S]) -> Option<f64> {
        if v[j + 6].lane(0) != 0.0 {
            return None;
        }
        if self.contacts.is_locked(j) {
            let (margin, direction) = self.hold(j, q);
            return (margin < -0.5 * ROUNDING).then_some(direction);
        }
        let direction = self.contacts.direction(j);
        (a[j + 6].lane(0) * direction < 0.0).then_some(0.0)
    }

    /// What a locked joint has left before it slips, as a share of the torques there, and the direction it
    /// would slip in. Needs the torques of a recursion.
    fn hold(&self, j: usize, q: &[S]) -> (f64, f64) {
        let body = &self.data.bodies[j + 1];
        let (lowest, highest) = self.contacts.room(j, q[j + 7].lane(0));
        let (need, friction) = (body.drive.lane(0), self.contacts.holding_friction(j));
        let size = |m: Motion<S>, f: Force<S>| {
            m.linear.norm() * f.linear.norm() + m.angular.norm() * f.angular.norm()
        };
        let along_axis = match self.model.nodes()[j + 1].axis {
            Axis::Revolute => body.force.angular,
            Axis::Prismatic => body.force.linear,
        };
        // λ = Uᵀ a' − τ + Sᵀ pA, all its terms by their size; U and a' about the parent's origin
        let terms = size(body.acceleration.referred_to(-body.offset), body.reach) + along_axis.norm();
        let scale = terms.lane(0) + self.forces[j + 6].lane(0).abs() + friction + f64::MIN_POSITIVE;
        let (down, up) = ((highest - need) / scale, (need - lowest) / scale);
        if down < up { (down, -1.0) } else { (up, 1.0) }
    }

    /// Smallest of what the locked joints have left; negative when one should have slipped. Needs
    /// kinematics and wrenches.
    pub(super) fn least_hold(&mut self, q: &[S], v: &[S]) -> f64 {
        self.drive(v);
        let mut a = std::mem::take(&mut self.scratch);
        let Self { model, data, contacts, forces, .. } = self;
        if let Some(locked) = contacts.locked() {
            locked_dynamics_recursion(model, data, v, forces, locked, &mut a);
        }
        self.scratch = a;
        let locked = (0..self.model.joint_count()).filter(|&j| self.contacts.is_locked(j));
        locked.map(|j| self.hold(j, q).0 + ROUNDING).fold(f64::INFINITY, f64::min)
    }

    /// The first joint that runs into its stop, if one does.
    pub(super) fn hits(&self, state: &State<S>) -> Option<usize> {
        (0..self.model.joint_count()).find(|&j| {
            let stop = self.contacts.stop(j, state.q[j + 7].lane(0));
            stop * state.v[j + 6].lane(0) > 0.0
        })
    }

    /// Lets every joint that runs into a stop bounce off it, or stay there. Needs kinematics; leaves
    /// them, without wrenches.
    ///
    /// `Δv = M⁻¹ e_j λ`, `λ = −(1 + e) q̇_j / (M⁻¹)_jj`: no momentum changes, and the energy lost is
    /// `−½ (1 − e) λ q̇_j`. Joints that stand at their stops take part as long as these push; friction
    /// has no impulse.
    pub(crate) fn bounce(&mut self, state: &mut State<S>, restitution: f64) {
        let n = self.model.joint_count();
        for round in 0..4 * n + 4 {
            let Some(j) = self.hits(state) else { break };
            let rate = state.v[j + 6].lane(0);
            let e = if round < 2 * n { restitution } else { 0.0 };
            let response = self.respond(j, -rate.signum(), state);
            let impulse = -(1.0 + e) * rate / response;
            for (v, change) in state.v.iter_mut().zip(&self.scratch) {
                *v += *change * S::of(impulse.abs());
            }
            state.v[j + 6] = S::of(-e * rate);
            let lost = S::of(-0.5 * (1.0 - e) * impulse * rate);
            state.work += -lost;
            state.dissipated += lost;
            self.settle(state);
        }
    }

    /// Puts what a unit impulse at a joint changes into `scratch`; returns that joint's own share, per
    /// unit of signed impulse.
    fn respond(&mut self, j: usize, sign: f64, state: &State<S>) -> f64 {
        let n = self.model.joint_count();
        for body in &mut self.data.bodies {
            (body.velocity, body.external) = (Motion::zero(), Force::zero());
        }
        let mut a = std::mem::take(&mut self.scratch);
        let still = vec![S::of(0.0); n + 6]; // an impact is no step: it may allocate
        let mut push = still.clone();
        push[j + 6] = S::of(sign);
        let stop = |i: usize| self.contacts.stop(i, state.q[i + 7].lane(0));
        let mut locked: Vec<bool> =
            (0..n).map(|i| i != j && stop(i) != 0.0 && state.v[i + 6].lane(0) == 0.0).collect();
        for _ in 0..=n {
            locked_dynamics_recursion(self.model, &mut self.data, &still, &push, &locked, &mut a);
            // a stop that would have to pull lets go
            let pulls = |i: &usize| locked[*i] && self.data.bodies[i + 1].drive.lane(0) * stop(*i) > 0.0;
            let Some(i) = (0..n).find(pulls) else { break };
            locked[i] = false;
        }
        let own = a[j + 6].lane(0) * sign;
        self.scratch = a;
        own
    }
}
