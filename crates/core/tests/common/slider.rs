//! A mass on a prismatic joint along x, with all centres of mass on that line, for which closed forms exist.

use nalgebra::{Isometry3, Matrix3, Vector3};
use onorbit_core::control::{Control, ControlError, Controller, Law, Observation};
use onorbit_core::model::{
    Inertial, Joint, JointKind, Limits, Link, Model, ModelBuilder, ModelError, neutral,
};
use onorbit_core::simulation::{Integrator, Simulation, Trace};
use std::sync::Arc;

/// Masses of base and slider, kg.
pub const BASE: f64 = 20.0;
pub const SLIDER: f64 = 5.0;
/// Reduced mass `M m/(M + m)` at the joint, kg.
pub const REDUCED: f64 = BASE * SLIDER / (BASE + SLIDER);

fn inertial(mass: f64) -> Option<Inertial> {
    Some(Inertial { mass, com: Vector3::zeros(), inertia: Matrix3::identity() * (0.1 * mass) })
}

/// Returns joint `slide` with friction, N, damping, N s/m, and limits, m; at `offset` along x, m.
pub fn slider(friction: f64, damping: f64, limits: Option<(f64, f64)>, offset: f64) -> Model {
    slider_with(
        |joint| {
            (joint.friction, joint.damping) = (friction, damping);
            joint.limits = Limits { position: limits, ..Limits::default() };
        },
        offset,
    )
}

/// Returns joint `slide`, which `change` may alter, at `offset` along x, m.
pub fn slider_with(change: impl Fn(&mut Joint), offset: f64) -> Model {
    try_slider_with(change, offset).unwrap()
}

/// As [`slider_with`], or the error.
pub fn try_slider_with(change: impl Fn(&mut Joint), offset: f64) -> Result<Model, ModelError> {
    let mut builder = ModelBuilder::new("slider", Link::new("base", inertial(BASE)))?;
    let origin = Isometry3::translation(offset, 0.0, 0.0);
    let mut joint = Joint::new("slide", JointKind::Prismatic(Vector3::x()), origin);
    change(&mut joint);
    builder.add("base", joint, Link::new("block", inertial(SLIDER)))?;
    builder.build()
}

/// Returns a simulation at rest except for the slider's rate, m/s.
pub fn moving(model: Model, rate: f64, integrator: Integrator, time_step: f64) -> Simulation {
    let (q, mut v) = (neutral(&model), vec![0.0; model.nv()]);
    v[6] = rate;
    let mut simulation = Simulation::new(Arc::new(model), q, v);
    (simulation.integrator, simulation.time_step) = (integrator, time_step);
    simulation
}

pub fn run(simulation: &mut Simulation, duration: f64) -> Trace {
    simulation.run(duration).unwrap().only()
}

/// Controller with a force at the joint, N, as a function of time.
pub struct Force(pub fn(f64) -> f64);

impl Controller for Force {
    fn update(&mut self, now: &Observation<'_>, tau: &mut [f64]) -> Result<(), ControlError> {
        tau.fill((self.0)(now.time));
        Ok(())
    }
}

pub fn driven(mut simulation: Simulation, force: fn(f64) -> f64) -> Simulation {
    simulation.systems[0].controls =
        vec![Control::on_all_joints(&simulation.systems[0].model, Law::User(Box::new(Force(force)), None))];
    simulation
}

pub const INTEGRATORS: [Integrator; 3] =
    [Integrator::Rk4, Integrator::DormandPrince, Integrator::SemiImplicitEuler];
