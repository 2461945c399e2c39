//! Impacts of joints on the stops at their position limits.

use crate::dynamics::{constrained_recursion, forward_dynamics_recursion, kinetic_energy};
use crate::model::{BASE_NQ, BASE_NV};
use crate::simulation::tree::Tree;
use crate::simulation::tree_state::TreeState;
use crate::spatial::{Force, Motion, Real};

/// Mobility of a joint, relative to its mobility in the tree without loops and held joints, below which the
/// joint counts as immobile.
const IMMOBILE: f64 = 1e-10;

impl<S: Real> Tree<'_, S> {
    /// Returns the index of the first joint that moves into its stop; `None` if there is none.
    pub(in crate::simulation) fn first_impact(&self, state: &TreeState<S>) -> Option<usize> {
        (0..self.model.joint_count()).find(|&j| {
            let stop = self.modes.stop(j, state.q[BASE_NQ + j].lane(0));
            stop * state.v[BASE_NV + j].lane(0) > 0.0
        })
    }

    /// Applies the impulses of all joints that move into their stops. Requires the kinematics of `state` in
    /// `data`, which afterwards holds the kinematics after the impacts, without loads.
    ///
    /// `Δv = M⁻¹ e_j λ`, `λ = −(1 + e) q̇_j / (M⁻¹)_jj` with the unit vector `e_j` of joint `j`, its rate
    /// `q̇_j` before the impact and the coefficient of restitution `e`. The momentum of the tree does not
    /// change, and the dissipated energy is `−½ (1 − e) λ q̇_j`. Joints that rest at their stops stay locked
    /// as long as their stops push against them. Friction exerts no impulse. If `is_endless` is true, joints
    /// do not rebound, which ends an infinite sequence of bounces.
    pub(crate) fn resolve_impacts(&mut self, state: &mut TreeState<S>, is_endless: bool) {
        let n = self.model.joint_count();
        for round in 0..4 * n + 4 {
            let Some(j) = self.first_impact(state) else { break };
            let e = if round < 2 * n && !is_endless { self.modes.restitution[j] } else { 0.0 };
            self.strike(j, e, state);
        }
    }

    /// Returns the joints (indices) that are at a stop and do not move away from it, each with the sign of
    /// rates away from the stop. Joints with prescribed motion and joints that brakes hold are omitted.
    pub(in crate::simulation) fn stops_reached(&self, state: &TreeState<S>) -> Vec<(usize, f64)> {
        let Self { model, modes, .. } = self;
        let joints = 0..if modes.is_active() { model.joint_count() } else { 0 };
        let away = |j: usize| -modes.stop(j, state.q[BASE_NQ + j].lane(0));
        let reached = joints.map(|j| (j, away(j))).filter(|&(j, away)| {
            away != 0.0
                && away * state.v[BASE_NV + j].lane(0) <= 0.0
                && !modes.is_given(j)
                && !modes.is_held(j)
        });
        reached.collect()
    }

    /// Returns the coefficient of restitution of the stops of joint `j`.
    pub(in crate::simulation) fn stop_restitution(&self, j: usize) -> f64 {
        self.modes.restitution[j]
    }

    /// Adds the energy `lost`, J, that an impact of joint `j` on its stop dissipates to the dissipated
    /// energies in `state`.
    pub(in crate::simulation) fn add_stop_loss(&self, j: usize, lost: f64, state: &mut TreeState<S>) {
        state.dissipated += S::of(lost);
        if let Some(share) = self.shares.iter().position(|joints| joints.contains(&j)) {
            state.shares[share] += S::of(lost);
        }
    }

    /// Reverses the rate of joint `j` by an impulse, with the coefficient of restitution `e`; 0 stops the
    /// joint. Returns the impulse, N m s or N s, and the energy lost, J; both are zero for a joint that loops
    /// and other held joints already keep at rest, whose rate is a rounding error. Requires and updates the
    /// kinematics like [`Tree::resolve_impacts`].
    pub(in crate::simulation) fn strike(&mut self, j: usize, e: f64, state: &mut TreeState<S>) -> (f64, f64) {
        let rate = state.v[BASE_NV + j].lane(0);
        let before = self.kinetic_energy(state);
        let Some(response) = self.impulse_response(j, -rate.signum(), state) else {
            state.v[BASE_NV + j] = S::of(0.0);
            self.project_momentum(state);
            return (0.0, 0.0);
        };
        let impulse = -(1.0 + e) * rate / response;
        for (v, change) in state.v.iter_mut().zip(&self.scratch) {
            *v += *change * S::of(impulse.abs());
        }
        state.v[BASE_NV + j] = S::of(-e * rate);
        let lost = -0.5 * (1.0 - e) * impulse * rate;
        self.add_stop_loss(j, lost, state);
        self.project_momentum(state);
        // the drives of joints with prescribed motion do work as well, because they keep their rates during
        // the impulse
        state.work +=
            if self.modes.given().is_empty() { S::of(-lost) } else { self.kinetic_energy(state) - before };
        (impulse, lost)
    }

    /// Returns the kinetic energy of `state`, whose kinematics are in `data`, J.
    fn kinetic_energy(&self, state: &TreeState<S>) -> S {
        kinetic_energy(&self.model, &self.data, &state.v)
    }

    /// Writes the change of velocity caused by a unit impulse with the sign `sign`, 1 or −1, at joint `j` to
    /// `scratch`. Returns `(M⁻¹)_jj`, the change of the rate of that joint per unit impulse; `None` if the
    /// joint cannot move because of closed loops and held joints.
    fn impulse_response(&mut self, j: usize, sign: f64, state: &TreeState<S>) -> Option<f64> {
        let n = self.model.joint_count();
        for body in &mut self.data.bodies {
            (body.velocity, body.external) = (Motion::zero(), Force::zero());
        }
        let mut a = std::mem::take(&mut self.scratch);
        let at_rest = vec![S::of(0.0); BASE_NV + n]; // impacts are rare, so an allocation is acceptable
        let mut impulse = at_rest.clone();
        impulse[BASE_NV + j] = S::of(sign);
        let Self { model, data, loops, modes, .. } = self;
        let mut free = 0.0;
        if !loops.is_empty() {
            forward_dynamics_recursion(model, data, &at_rest, &impulse, &mut a);
            free = a[BASE_NV + j].lane(0) * sign;
        }
        let stop = |i: usize| modes.stop(i, state.q[BASE_NQ + i].lane(0));
        let rests_at_stop = |i: usize| stop(i) != 0.0 && state.v[BASE_NV + i].lane(0) == 0.0;
        let mut locked: Vec<bool> =
            (0..n).map(|i| i != j && (modes.is_given(i) || modes.is_held(i) || rests_at_stop(i))).collect();
        for _ in 0..=n {
            let held = Some((&locked[..], &[][..]));
            constrained_recursion(model, data, loops, (&at_rest, &impulse), held, &mut a);
            // a stop can only push, so a joint on which the stop would have to pull is released
            let pulls = |i: &usize| {
                locked[*i] && !modes.is_held(*i) && data.bodies[i + 1].holding_torque.lane(0) * stop(*i) > 0.0
            };
            let Some(i) = (0..n).find(pulls) else { break };
            locked[i] = false;
        }
        let response = a[BASE_NV + j].lane(0) * sign;
        self.scratch = a;
        (response > IMMOBILE * free).then_some(response)
    }
}
