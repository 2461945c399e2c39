//! Settings of rollouts.

use crate::control::ComputedTorque;
use crate::reference::TaskReference;
use crate::simulation::Integrator;
use std::sync::atomic::AtomicBool;

/// Control of the joints in a rollout.
#[derive(Clone, Copy, Debug, Default)]
pub enum RolloutControl<'a> {
    /// No commanded torques; damping and friction of the joints still act.
    #[default]
    Passive,
    /// Given joint efforts, `(B, steps, n)`, N m or N, each held during its step.
    Torques(&'a [f64]),
    /// Computed torque that tracks the same reference in all runs. The reference must not be in an orbital
    /// frame. The runs of a robot with closed loops or mimic joints are simulated one at a time on each
    /// thread.
    ComputedTorque(&'a ComputedTorque, &'a TaskReference),
}

/// Parameters of a rollout.
#[derive(Clone, Copy, Debug)]
pub struct Rollout<'a> {
    /// Number of steps.
    pub steps: usize,
    /// Length of a step, s.
    pub time_step: f64,
    /// Method by which the equations of motion are integrated.
    pub integrator: Integrator,
    /// Control law of the joints, or no control.
    pub control: RolloutControl<'a>,
    /// Number of steps between recorded rows, the first of which is the initial state. With `None`, only the
    /// final state is recorded.
    pub record_every: Option<usize>,
    /// Number of threads; all cores if `None`.
    pub threads: Option<usize>,
    /// Flag that another thread sets to stop the rollout early. The contents of the outputs are then
    /// undefined.
    pub stop: &'a AtomicBool,
}

impl Rollout<'_> {
    /// Returns the number of rows recorded per run.
    pub fn rows(&self) -> usize {
        self.record_every.map_or(1, |every| self.steps / every.max(1) + 1)
    }
}
