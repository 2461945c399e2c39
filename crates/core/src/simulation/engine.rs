//! External physics engines in place of the native equations of motion.

use super::error::SimulationError;
use super::state_range::attitude_norm;
use super::tree::Tree;
use super::tree_state::TreeState;
use crate::model::Model;
use crate::spatial::{Scalar, Vec3};

/// External physics engine that moves the robot. Controllers, schedule, trace and certificate are the same as in a
/// run with the native equations of motion.
pub trait Engine: Send {
    /// Moves the robot over one step and writes to `output` the state at the end of the step, the acceleration at its
    /// start, and the impulse and work during the step. The output must depend on the input alone, so that a run can
    /// resume from a checkpoint.
    ///
    /// A step of zero length requests the acceleration only.
    ///
    /// # Errors
    /// Any error ends the run.
    fn step(&mut self, input: &StepInput<'_>, output: &mut StepOutput) -> Result<(), SimulationError>;
}

/// Input of a step: its interval, the initial state and the torques.
#[derive(Clone, Copy, Debug)]
pub struct StepInput<'a> {
    /// Start and end of the step, s.
    pub interval: (f64, f64),
    /// Configuration at the start, `(nq,)`, m and rad.
    pub q: &'a [f64],
    /// Velocity at the start, `(nv,)`, m/s and rad/s.
    pub v: &'a [f64],
    /// Joint torques, constant during the step, `(n,)`, N m (N).
    pub tau: &'a [f64],
}

/// Largest deviation from 1 of the norm of the quaternion that an engine returns.
const UNIT: f64 = 1e-9;

/// Result of a step.
#[derive(Clone, Debug)]
pub struct StepOutput {
    /// Configuration at the end, `(nq,)`, m and rad.
    pub q: Vec<f64>,
    /// Velocity at the end, `(nv,)`, m/s and rad/s.
    pub v: Vec<f64>,
    /// Acceleration at the start, `(nv,)`, m/s² and rad/s².
    pub acceleration: Vec<f64>,
    /// Time integral over the step of the external forces and of their moments about the centre of mass, W axes, N s
    /// and N m s.
    pub impulse: [f64; 6],
    /// Work done by motors and external wrenches during the step minus the energy that the joints dissipate, J.
    pub work: f64,
    /// Energy that the joints dissipate during the step, J.
    pub dissipated: f64,
}

impl StepOutput {
    pub(super) fn new(model: &Model) -> Self {
        let (q, v) = (vec![0.0; model.nq()], vec![0.0; model.nv()]);
        Self { q, acceleration: v.clone(), v, impulse: [0.0; 6], work: 0.0, dissipated: 0.0 }
    }

    fn is_finite(&self) -> bool {
        let done = self.impulse.iter().chain([&self.work, &self.dissipated]);
        self.q.iter().chain(&self.v).chain(&self.acceleration).chain(done).all(|x| x.is_finite())
    }
}

/// External engine of a run, with buffers for its input and output.
pub(super) struct ExternalEngine<'a> {
    engine: &'a mut dyn Engine,
    q: Vec<f64>,
    v: Vec<f64>,
    tau: Vec<f64>,
    output: StepOutput,
    /// True if the engine completed its last step.
    has_output: bool,
}

impl<'a> ExternalEngine<'a> {
    pub(super) fn new(engine: &'a mut dyn Engine, model: &Model) -> Self {
        let (output, tau) = (StepOutput::new(model), vec![0.0; model.joint_count()]);
        Self { engine, q: output.q.clone(), v: output.v.clone(), tau, output, has_output: false }
    }

    /// Returns the acceleration at the start of the last step, `(nv,)`; `None` if the engine failed.
    pub(super) fn first_acceleration(&self) -> Option<&[f64]> {
        self.has_output.then_some(&self.output.acceleration[..])
    }

    /// Returns the work done on the robot in the last step minus the energy that its joints dissipated, J.
    pub(super) fn work_of_step(&self) -> f64 {
        self.output.work
    }

    /// Moves `state` over `interval` with the torques of `system`.
    pub(super) fn advance<S: Scalar>(
        &mut self,
        system: &Tree<'_, S>,
        state: &mut TreeState<S>,
        interval: (f64, f64),
    ) -> Result<(), SimulationError> {
        let Self { engine, q, v, tau, output, has_output } = self;
        for (to, from) in [(&mut *q, &state.q), (&mut *v, &state.v)] {
            to.iter_mut().zip(from).for_each(|(to, from)| *to = from.value());
        }
        tau.iter_mut().zip(system.torques()).for_each(|(to, tau)| *to = tau.value());
        *has_output = false;
        engine.step(&StepInput { interval, q, v, tau }, output)?;
        *has_output = true;
        self.check_output(interval.0)?;
        self.update_state(state);
        Ok(())
    }

    /// Checks the output of a step that started at `t`, s.
    fn check_output(&self, t: f64) -> Result<(), SimulationError> {
        if !self.output.is_finite() {
            let (q, v) = (self.q.clone(), self.v.clone());
            return Err(SimulationError::Diverged { time: t, q, v });
        }
        let length = attitude_norm(&self.output.q);
        if (length - 1.0).abs() > UNIT {
            return Err(SimulationError::EngineAttitude { time: t, length });
        }
        Ok(())
    }

    /// Writes the output of a step to `state`.
    fn update_state<S: Scalar>(&self, state: &mut TreeState<S>) {
        let output = &self.output;
        for (to, from) in [(&mut state.q, &output.q), (&mut state.v, &output.v)] {
            to.iter_mut().zip(from).for_each(|(to, from)| *to = S::of(*from));
        }
        let vector = |x: &[f64]| Vec3::new(S::of(x[0]), S::of(x[1]), S::of(x[2]));
        state.impulse.linear += vector(&output.impulse);
        state.impulse.angular += vector(&output.impulse[3..]);
        state.work += S::of(output.work);
        state.dissipated += S::of(output.dissipated);
    }
}
