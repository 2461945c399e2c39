//! Another physics engine in the place of our own equations of motion; the loop around it stays.

use super::error::SimulationError;
use super::plant::World;
use super::run::Run;
use super::settings::Simulation;
use super::surroundings::Surroundings;
use crate::dynamics::{Data, base_rotation, kinematics};
use crate::model::Model;
use crate::spatial::{Scalar, Vec3};
use std::sync::Arc;

/// A robot that something else moves: control, schedule, rows and certificate are those of every run.
pub trait Engine: Send {
    /// Moves the robot across a step: writes the state at its end, the acceleration at its start, and what was
    /// done in between. The state is a function of what is given alone, so that a run can go on from a checkpoint.
    ///
    /// A step of no length asks for the acceleration.
    ///
    /// # Errors
    /// Whatever stops the run.
    fn step(&mut self, now: &Crossing<'_>, crossed: &mut Crossed) -> Result<(), SimulationError>;
}

/// A step to take.
#[derive(Clone, Copy, Debug)]
pub struct Crossing<'a> {
    /// Its start and end, s.
    pub interval: (f64, f64),
    /// Configuration at its start, `(nq,)`.
    pub q: &'a [f64],
    /// Velocity, `(nv,)`.
    pub v: &'a [f64],
    /// Torques held at the joints, `(n,)`, N m (N).
    pub tau: &'a [f64],
}

/// How far from one the length of the quaternion may be that an engine leaves.
const UNIT: f64 = 1e-9;

/// What an engine made of a step.
#[derive(Clone, Debug)]
pub struct Crossed {
    /// Configuration at the end, `(nq,)`.
    pub q: Vec<f64>,
    /// Velocity at the end, `(nv,)`.
    pub v: Vec<f64>,
    /// Acceleration at the start, `(nv,)`.
    pub acceleration: Vec<f64>,
    /// Integral of the external forces and of their moments about the centre of mass, W axes, N s and N m s.
    pub impulse: [f64; 6],
    /// Work of motors and external wrenches less what the joints lost, J.
    pub work: f64,
    /// Energy that the joints lost, J.
    pub dissipated: f64,
}

impl Crossed {
    pub(super) fn new(model: &Model) -> Self {
        let (q, v) = (vec![0.0; model.nq()], vec![0.0; model.nv()]);
        Self { q, acceleration: v.clone(), v, impulse: [0.0; 6], work: 0.0, dissipated: 0.0 }
    }

    fn is_finite(&self) -> bool {
        let done = self.impulse.iter().chain([&self.work, &self.dissipated]);
        self.q.iter().chain(&self.v).chain(&self.acceleration).chain(done).all(|x| x.is_finite())
    }

    /// Length of the attitude's quaternion, which must be one.
    fn length_of_attitude(&self) -> f64 {
        self.q[3..7].iter().map(|x| x * x).sum::<f64>().sqrt()
    }
}

/// An engine at work.
pub(super) struct Foreign<'a> {
    engine: &'a mut dyn Engine,
    q: Vec<f64>,
    v: Vec<f64>,
    tau: Vec<f64>,
    pub(super) crossed: Crossed,
}

impl<'a> Foreign<'a> {
    pub(super) fn new(engine: &'a mut dyn Engine, model: &Model) -> Self {
        let (crossed, tau) = (Crossed::new(model), vec![0.0; model.joint_count()]);
        Self { engine, q: crossed.q.clone(), v: crossed.v.clone(), tau, crossed }
    }
}

impl<S: Scalar> Run<'_, S> {
    /// Kinematics at the start of a step; our own twist is put right by the momentum, another engine's is as it is.
    pub(super) fn settle(&mut self) {
        match self.foreign {
            Some(_) => self.plant.look(&self.state),
            None => self.plant.settle(&mut self.state),
        }
    }

    /// A step of another engine, and the acceleration of its row.
    pub(super) fn step_foreign(&mut self, interval: (f64, f64), is_row: bool) -> Result<(), SimulationError> {
        let asked = self.ask(interval);
        if is_row {
            match (&asked, &self.foreign) {
                (Ok(()), Some(foreign)) => {
                    self.recorder.accelerated(self.plant.model, &foreign.crossed.acceleration);
                }
                _ => self.recorder.drop_last(),
            }
        }
        asked?;
        self.steps += 1;
        self.take_over(interval.0)
    }

    /// Has the engine cross `interval` from the present state.
    fn ask(&mut self, interval: (f64, f64)) -> Result<(), SimulationError> {
        let Self { state, plant, foreign, .. } = self;
        let Some(Foreign { engine, q, v, tau, crossed }) = foreign else { return Ok(()) };
        for (to, from) in [(&mut *q, &state.q), (&mut *v, &state.v), (&mut *tau, &plant.command)] {
            to.iter_mut().zip(from).for_each(|(to, from)| *to = from.value());
        }
        engine.step(&Crossing { interval, q, v, tau }, crossed)
    }

    /// Goes over to what the engine left of a step from `t`, if that is finite.
    fn take_over(&mut self, t: f64) -> Result<(), SimulationError> {
        let Self { state, foreign, recorder, .. } = self;
        let Some(Foreign { crossed, .. }) = foreign else { return Ok(()) };
        if !crossed.is_finite() {
            return Err(self.diverged(t));
        }
        let length = crossed.length_of_attitude();
        if (length - 1.0).abs() > UNIT {
            return Err(SimulationError::EngineAttitude { time: t, length });
        }
        for (to, from) in [(&mut state.q, &crossed.q), (&mut state.v, &crossed.v)] {
            to.iter_mut().zip(from).for_each(|(to, from)| *to = S::of(*from));
        }
        let vector = |x: &[f64]| Vec3::new(S::of(x[0]), S::of(x[1]), S::of(x[2]));
        state.impulse.linear += vector(&crossed.impulse);
        state.impulse.angular += vector(&crossed.impulse[3..]);
        state.work += S::of(crossed.work);
        state.dissipated += S::of(crossed.dissipated);
        recorder.trace.work_done += crossed.work.abs();
        Ok(())
    }
}

/// What acts on the bodies of a robot from outside, at any state of it.
#[derive(Debug)]
pub struct Outside {
    model: Arc<Model>,
    data: Data<f64>,
    surroundings: Surroundings,
}

impl Simulation {
    /// What acts on the robot beside its motors, for an [`Engine`].
    pub fn outside(&self) -> Outside {
        let model = Arc::clone(&self.model);
        Outside { data: Data::new(&model), surroundings: self.surroundings(), model }
    }
}

impl Outside {
    /// Writes the wrench on each body at a state within the step `interval`, `(bodies, 6)`: force, N, through its centre
    /// of mass and torque, N m, about it, W axes.
    ///
    /// # Errors
    /// What orbit or environment refuse.
    pub fn wrenches(
        &mut self,
        t: f64,
        interval: (f64, f64),
        (q, v): (&[f64], &[f64]),
        out: &mut [f64],
    ) -> Result<(), SimulationError> {
        let Self { model, data, surroundings } = self;
        kinematics(model, data, q, v);
        surroundings.apply(data, q, Vec3::zero(), t, interval)?;
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
