//! Change to a local reference orbit; see `local_reference.rs` for the frame of that orbit.

use super::environment_loads::EnvironmentLoads;
use super::error::SimulationError;
use super::tree::Tree;
use super::tree_state::TreeState;
use crate::dynamics::{base_rotation, center_of_mass, momentum};
use crate::spatial::{Scalar, Vec3};
use nalgebra::Vector3;

impl<S: Scalar> Tree<'_, S> {
    /// Sets a local orbit in free fall, which starts at `t`, s, at the centre of mass of this system, as the
    /// reference orbit of `loads`, and transforms `state` to the frame of this orbit. This system must be the
    /// only one on which `loads` act.
    ///
    /// The centre of mass `c` is at rest at the origin of the new frame: `p' = p − c`, `ṗ' = ṗ − P/m`,
    /// `P' = 0` with the position `p` of the base, the momentum `P` and the mass `m`. The kinetic energy in
    /// the new frame is lower by `P²/2m` (König's theorem). Without an orbit, nothing changes.
    pub(super) fn rereference(
        &mut self,
        loads: &mut EnvironmentLoads,
        t: f64,
        state: &mut TreeState<S>,
    ) -> Result<(), SimulationError> {
        let Some(origin) = loads.origin_state(t)? else { return Ok(()) };
        self.project_momentum(state);
        let lift = |v: Vector3<f64>| Vec3::new(S::of(v.x), S::of(v.y), S::of(v.z));
        let com = center_of_mass(&self.data, &state.q).to_nalgebra();
        let momentum = momentum(&self.data, &state.q).linear.to_nalgebra();
        let com_velocity = momentum / self.model.mass();

        let mut local = loads.local_reference().cloned().unwrap_or_default();
        local.momentum_taken = (Vector3::from(local.momentum_taken) + momentum).into();
        local.position = (origin.position + com).into();
        local.velocity = (origin.velocity + com_velocity).into();
        local.work_ahead -= 0.5 * momentum.dot(&com_velocity);
        local.times.push(t);
        loads.set_local_reference(local)?;

        (Vec3::from_slice(&state.q) - lift(com)).write(&mut state.q);
        let velocity_b = base_rotation(&state.q).transpose_mul(lift(com_velocity));
        (Vec3::from_slice(&state.v) - velocity_b).write(&mut state.v);
        state.initial_momentum.linear -= lift(momentum);
        Ok(())
    }
}
