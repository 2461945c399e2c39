//! Evaluates the environment of a run at any state of the robot, for external engines.

use super::body_states::LoadedSystem;
use super::environment_loads::EnvironmentLoads;
use super::error::SimulationError;
use super::settings::Simulation;
use crate::dynamics::{Data, base_rotation, kinematics};
use crate::model::Model;
use crate::spatial::Vec3;
use std::sync::Arc;

/// Evaluates the environment at any state of the robot.
#[derive(Debug)]
pub struct EnvironmentQuery {
    model: Arc<Model>,
    data: Data<f64>,
    loads: EnvironmentLoads,
}

impl Simulation {
    /// Returns a query of the environment of the run, for an [`Engine`](super::Engine).
    pub fn outside(&self) -> EnvironmentQuery {
        let model = Arc::clone(&self.systems[0].model);
        EnvironmentQuery { data: Data::new(&model), loads: self.environment_loads(), model }
    }
}

impl EnvironmentQuery {
    /// Writes to `out`, `(bodies, 6)`, the wrench on each body at time `t`, s, and state `(q, v)` within the step
    /// `interval`, s: the force, N, through the centre of mass of the body and the torque, N m, about it, W axes.
    ///
    /// # Errors
    /// Errors of the orbit and of the effects.
    pub fn wrenches(
        &mut self,
        t: f64,
        interval: (f64, f64),
        (q, v): (&[f64], &[f64]),
        out: &mut [f64],
    ) -> Result<(), SimulationError> {
        let Self { model, data, loads } = self;
        kinematics(model, data, q, v);
        let system = LoadedSystem { data: &mut *data, q, frame_velocity: Vec3::zero() };
        loads.apply_to_one(system, t, interval)?;
        let rot_wb = base_rotation(q);
        for (body, out) in data.bodies.iter().zip(out.chunks_exact_mut(6)) {
            let force = body.external.linear;
            let torque = body.external.angular - body.inertia.com.cross(force);
            (rot_wb * force).write(out);
            (rot_wb * torque).write(&mut out[3..]);
        }
        Ok(())
    }
}
