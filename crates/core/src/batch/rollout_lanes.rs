//! Simulation of a group of runs of a rollout, one per SIMD lane.

use super::closed_starts::closed_starts;
use super::gather_scatter::{Strides, gather, scatter};
use super::input::InputError;
use super::rollout_settings::{Rollout, RolloutControl};
use crate::control::{ComputedTorqueWork, computed_torque};
use crate::model::{Model, neutral};
use crate::simulation::{
    EquationsOfMotion, NoLoads, State, StepMethod, StepSettings, Tree, TreeState, only, only_mut,
};
use crate::spatial::Real;
use std::borrow::Cow;
use std::sync::atomic::Ordering;

/// Settings, states and workspace of a group of simulated runs, one per SIMD lane.
pub(super) struct Lanes<'a, S> {
    pub(super) settings: &'a Rollout<'a>,
    pub(super) equations: EquationsOfMotion<'a, S, NoLoads>,
    pub(super) state: State<S>,
    stepper: StepMethod<S>,
    work: Option<ComputedTorqueWork<S>>,
    /// Index of the first run.
    first: usize,
    /// Number of runs in the group. Lanes without a run repeat the last run.
    count: usize,
}

impl<'a, S: Real> Lanes<'a, S> {
    pub(super) fn new(settings: &'a Rollout<'a>, model: &'a Model) -> Self {
        let mut equations = EquationsOfMotion::new(vec![Tree::new(Cow::Borrowed(model), None)], NoLoads);
        let q = neutral(model).into_iter().map(S::of).collect();
        let state = State::at(&mut equations.trees, [(q, vec![S::of(0.0); model.nv()])]);
        let Rollout { integrator, time_step, .. } = *settings;
        let duration = time_step * settings.steps as f64;
        let how = StepSettings { integrator, tolerance: 0.0, time_step, control_period: 0.0, duration };
        let stepper = StepMethod::new(&state, &how);
        let is_controlled =
            matches!(settings.control, RolloutControl::ComputedTorque(..)) && model.closures().is_empty();
        let work = is_controlled.then(|| ComputedTorqueWork::new(model));
        Self { settings, equations, state, stepper, work, first: 0, count: 0 }
    }

    /// Loads the initial states of `count` runs, starting with run `first`, and closes their loops.
    ///
    /// # Errors
    /// [`InputError::OpenStart`] for the first of these states in which a loop is open, a mimic joint does
    /// not follow its leader or the constraints cannot be satisfied.
    pub(super) fn start(
        &mut self,
        q0: &[f64],
        v0: &[f64],
        first: usize,
        count: usize,
    ) -> Result<(), InputError> {
        (self.first, self.count) = (first, count);
        let (tree, state) = (only_mut(&mut self.equations.trees), only_mut(&mut self.state.trees));
        let closed = closed_starts(&tree.model, [q0, v0], (first, count))?;
        let (q0, v0, first) = match &closed {
            Some([q, v]) => (&q[..], &v[..], 0),
            None => (q0, v0, first),
        };
        let (mut q, mut v) = (std::mem::take(&mut state.q), std::mem::take(&mut state.v));
        S::enter(
            #[inline(always)]
            || {
                for (from, to) in [(q0, &mut q), (v0, &mut v)] {
                    gather(from, Strides { first: first * to.len(), stride: to.len(), count }, to);
                }
            },
        );
        *state = TreeState::at(&tree.model, &mut tree.data, q, v);
        self.stepper.reset();
        Ok(())
    }

    /// Simulates the group of runs and writes the recorded states to `q`, `(count, rows, nq)`, and `v`,
    /// `(count, rows, nv)`. `drive` sets the motor torques of the step with the given index.
    pub(super) fn run(&mut self, q: &mut [f64], v: &mut [f64], mut drive: impl FnMut(&mut Self, usize)) {
        let Rollout { steps, time_step, record_every, .. } = *self.settings;
        let mut row = 0;
        for step in 0..steps {
            if self.settings.stop.load(Ordering::Relaxed) {
                return;
            }
            self.equations.project_momentum(&mut self.state);
            if record_every.is_some_and(|every| step % every.max(1) == 0) {
                self.write(row, q, v);
                row += 1;
            }
            drive(self, step);
            self.advance(step as f64 * time_step, (step + 1) as f64 * time_step);
        }
        self.equations.project_momentum(&mut self.state);
        if record_every.is_none_or(|every| steps % every.max(1) == 0) {
            self.write(row, q, v);
        }
    }

    /// Advances by one step, which is divided at the instants at which joints begin to stick or to slip.
    fn advance(&mut self, mut t: f64, end: f64) {
        let Self { equations, state, stepper, .. } = self;
        equations.solve_modes(state);
        // steps return no error, because there is no environment to evaluate
        while let Ok(reached) = stepper.advance(equations, state, (t, end)) {
            if reached >= end {
                break;
            }
            t = reached;
            equations.project_momentum(state);
            equations.solve_modes(state);
        }
    }

    /// Sets the motor torques of all runs of the group for the step with index `step`. Without control, they
    /// do not change.
    pub(super) fn drive(&mut self, step: usize) {
        let Self { equations, state, settings, work, first, count, .. } = self;
        let (tree, state) = (only_mut(&mut equations.trees), only(&state.trees));
        match settings.control {
            RolloutControl::Passive => {}
            RolloutControl::Torques(tau) => {
                let n = tree.command.len();
                let stride = settings.steps * n;
                let strides = Strides { first: *first * stride + step * n, stride, count: *count };
                S::enter(
                    #[inline(always)]
                    || gather(tau, strides, &mut tree.command),
                );
            }
            RolloutControl::ComputedTorque(law, reference) => {
                let Some(work) = work else { return };
                let t = step as f64 * settings.time_step;
                let desired = reference
                    .sample(t, 0.0)
                    .expect("references in an orbital frame are rejected before the rollout")
                    .lift();
                let (data, command) = (&mut tree.data, &mut tree.command);
                let is_relative = reference.is_relative_to_base();
                let (q, v) = (&state.q, &state.v);
                computed_torque(law, &tree.model, data, q, v, &desired, is_relative, work, command);
                work.desired_accelerations(law, tree.modes.requested_mut());
            }
        }
    }

    fn write(&self, row: usize, q: &mut [f64], v: &mut [f64]) {
        let (rows, count, state) = (self.settings.rows(), self.count, only(&self.state.trees));
        S::enter(
            #[inline(always)]
            || {
                for (values, to) in [(&state.q, q), (&state.v, v)] {
                    let width = values.len();
                    scatter(values, Strides { first: row * width, stride: rows * width, count }, to);
                }
            },
        );
    }

    /// Returns the lane of the first run whose state is not finite, or `None`. A state that has become
    /// non-finite remains non-finite.
    pub(super) fn diverged(&self) -> Option<usize> {
        let state = only(&self.state.trees);
        let numbers = || state.q.iter().chain(&state.v);
        (0..self.count).find(|&lane| !numbers().all(|x| x.lane(lane).is_finite()))
    }
}
