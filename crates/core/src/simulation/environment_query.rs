//! Evaluation of the environment of a run at any state of its systems, for external engines.

use super::body_states::LoadedSystem;
use super::environment_loads::EnvironmentLoads;
use super::error::SimulationError;
use super::settings::Simulation;
use crate::dynamics::{Data, base_rotation, kinematics};
use crate::model::Model;
use crate::spatial::Vec3;
use std::sync::Arc;

/// Environment of a run, which an external engine can evaluate at any state of the systems.
#[derive(Debug)]
pub struct EnvironmentQuery {
    systems: Vec<(Arc<Model>, Data<f64>)>,
    loads: EnvironmentLoads,
}

impl Simulation {
    /// Creates a query of the environment of this run, for an [`Engine`](super::Engine).
    pub fn outside(&self) -> EnvironmentQuery {
        let models = self.systems.iter().map(|system| Arc::clone(&system.model));
        let systems = models.map(|model| (Arc::clone(&model), Data::new(&model))).collect();
        EnvironmentQuery { systems, loads: self.environment_loads() }
    }
}

impl EnvironmentQuery {
    /// Computes the wrench of all effects on each body at time `t`, s, and state `(q, v)`, in a step over
    /// `interval`, s. `out`, `(bodies, 6)`, receives the force, N, through the centre of mass of the body and
    /// the torque, N m, about it, in W axes. `q`, `v` and `out` hold the values of all systems, one system
    /// after another.
    ///
    /// # Errors
    /// [`SimulationError::Orbit`] and [`SimulationError::Environment`] if the orbit or an effect cannot be
    /// evaluated.
    pub fn wrenches(
        &mut self,
        t: f64,
        interval: (f64, f64),
        (mut q, mut v): (&[f64], &[f64]),
        out: &mut [f64],
    ) -> Result<(), SimulationError> {
        let Self { systems, loads } = self;
        let mut loaded = Vec::with_capacity(systems.len());
        for (model, data) in systems {
            let (own_q, own_v);
            (own_q, q) = q.split_at(model.nq());
            (own_v, v) = v.split_at(model.nv());
            kinematics(model, data, own_q, own_v);
            loaded.push(LoadedSystem { data, q: own_q, frame_velocity: Vec3::zero() });
        }
        loads.apply_to(&mut loaded, t, interval)?;
        let mut rows = out.chunks_exact_mut(6);
        for LoadedSystem { data, q, .. } in &loaded {
            let rot_wb = base_rotation(q);
            for (body, out) in data.bodies.iter().zip(&mut rows) {
                let force = body.external.linear;
                let torque = body.external.angular - body.inertia.com.cross(force);
                (rot_wb * force).write(out);
                (rot_wb * torque).write(&mut out[3..]);
            }
        }
        Ok(())
    }
}
