//! Rollouts: many runs without an environment, with passive joints, given torques or computed torque.

use super::gather_scatter::{Strides, gather, scatter};
use super::input::{InputError, check_finite, check_frame, check_quaternions, check_whole};
use super::threads::{Threads, for_each};
use crate::control::{ComputedTorque, ComputedTorqueWork, computed_torque};
use crate::model::{Model, neutral};
use crate::reference::TaskReference;
use crate::simulation::{
    EquationsOfMotion, Integrator, NoLoads, State, StepMethod, StepSettings, Tree, TreeState, only, only_mut,
};
use crate::spatial::{Fused, InstructionSet, Lanes4, Lanes8, Real};
use std::borrow::Cow;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// Control of the joints in a rollout.
#[derive(Clone, Copy, Debug, Default)]
pub enum RolloutControl<'a> {
    /// No commanded torques; damping and friction of the joints still act.
    #[default]
    Passive,
    /// Given joint efforts, `(B, steps, n)`, N m or N, each held during its step.
    Torques(&'a [f64]),
    /// Computed torque that tracks the same reference in all runs. The reference must not be in an orbital
    /// frame.
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

    /// Simulates one run from each of the initial states `q0`, `(B, nq)`, and `v0`, `(B, nv)`, and writes the
    /// recorded states to `q`, `(B, rows, nq)`, and `v`, `(B, rows, nv)`, where `rows` is [`Rollout::rows`].
    /// The results are bit-identical for any number of threads.
    ///
    /// # Errors
    /// [`InputError`] for invalid inputs, and [`InputError::Diverged`] for the first state that becomes
    /// non-finite, after the results of all other states were written.
    pub fn run(
        &self,
        model: &Model,
        q0: &[f64],
        v0: &[f64],
        q: &mut [f64],
        v: &mut [f64],
    ) -> Result<(), InputError> {
        let (count, nq, nv) = (q0.len() / model.nq(), model.nq(), model.nv());
        let rows = self.rows();
        check_whole("q0", q0, nq)?;
        check_whole("v0", v0, nv)?;
        for (name, got, expected) in
            [("q0", q0.len(), nq), ("v0", v0.len(), nv), ("q", q.len(), rows * nq), ("v", v.len(), rows * nv)]
        {
            if got != count * expected {
                return Err(InputError::WrongLength { name, expected, got: got / count.max(1) });
            }
        }
        check_finite("q0", q0, model.nq())?;
        check_finite("v0", v0, model.nv())?;
        check_quaternions(q0, model.nq())?;
        if let RolloutControl::Torques(tau) = self.control {
            let expected = self.steps * model.joint_count();
            if tau.len() != count * expected {
                return Err(InputError::WrongLength { name: "tau", expected, got: tau.len() / count.max(1) });
            }
            check_finite("tau", tau, expected)?;
        }
        if self.integrator == Integrator::DormandPrince {
            return Err(InputError::Adaptive);
        }
        // stick-slip transitions occur at different times in each run, so the runs are simulated one by one
        let sticks = model.has_friction();
        if let RolloutControl::ComputedTorque(law, reference) = self.control {
            check_frame(model, law.frame)?;
            if reference.needs_orbit() {
                return Err(InputError::NeedsOrbit);
            }
            if !model.closures().is_empty() {
                return Err(InputError::LoopedTask);
            }
        }
        let diverged = match InstructionSet::current() {
            InstructionSet::Baseline => self.all::<f64>(model, q0, v0, q, v),
            InstructionSet::Fused | InstructionSet::Wide if sticks => self.all::<Fused>(model, q0, v0, q, v),
            InstructionSet::Fused if q0.len() == model.nq() => self.all::<Fused>(model, q0, v0, q, v),
            InstructionSet::Fused => self.all::<Lanes4>(model, q0, v0, q, v),
            InstructionSet::Wide => self.all::<Lanes8>(model, q0, v0, q, v),
        }?;
        match diverged {
            Some(state) => Err(InputError::Diverged { state }),
            None => Ok(()),
        }
    }

    /// Simulates all runs. Returns the index of the first run whose state becomes non-finite; `None` if all
    /// states remain finite.
    fn all<S: Real>(
        &self,
        model: &Model,
        q0: &[f64],
        v0: &[f64],
        q: &mut [f64],
        v: &mut [f64],
    ) -> Result<Option<usize>, InputError> {
        let count = q0.len() / model.nq();
        let (q_rows, v_rows) = (S::LANES * self.rows() * model.nq(), S::LANES * self.rows() * model.nv());
        let diverged = AtomicUsize::new(count);
        for_each(
            Threads { count: self.threads, stop: Some(self.stop) },
            q.chunks_mut(q_rows).zip(v.chunks_mut(v_rows)).enumerate(),
            || Lanes::<S>::new(self, model),
            |lanes, (group, (q, v))| {
                let first = group * S::LANES;
                lanes.start(q0, v0, first, S::LANES.min(count - first));
                lanes.run(q, v);
                if let Some(lane) = lanes.diverged() {
                    diverged.fetch_min(first + lane, Ordering::Relaxed);
                }
            },
        )?;
        Ok(Some(diverged.into_inner()).filter(|state| *state < count))
    }
}

/// Workspace that simulates a group of runs, one per SIMD lane.
struct Lanes<'a, S> {
    settings: &'a Rollout<'a>,
    equations: EquationsOfMotion<'a, S, NoLoads>,
    state: State<S>,
    stepper: StepMethod<S>,
    work: Option<ComputedTorqueWork<S>>,
    /// Index of the first run.
    first: usize,
    /// Number of runs in the group. Lanes without a run repeat the last run.
    count: usize,
}

impl<'a, S: Real> Lanes<'a, S> {
    fn new(settings: &'a Rollout<'a>, model: &'a Model) -> Self {
        let mut equations = EquationsOfMotion::new(vec![Tree::new(Cow::Borrowed(model), None)], NoLoads);
        let q = neutral(model).into_iter().map(S::of).collect();
        let state = State::at(&mut equations.trees, [(q, vec![S::of(0.0); model.nv()])]);
        let Rollout { integrator, time_step, .. } = *settings;
        let duration = time_step * settings.steps as f64;
        let how = StepSettings { integrator, tolerance: 0.0, time_step, control_period: 0.0, duration };
        let stepper = StepMethod::new(&state, &how);
        let is_controlled = matches!(settings.control, RolloutControl::ComputedTorque(..));
        let work = is_controlled.then(|| ComputedTorqueWork::new(model));
        Self { settings, equations, state, stepper, work, first: 0, count: 0 }
    }

    /// Loads the initial states of `count` runs, starting with run `first`.
    fn start(&mut self, q0: &[f64], v0: &[f64], first: usize, count: usize) {
        (self.first, self.count) = (first, count);
        let (tree, state) = (only_mut(&mut self.equations.trees), only_mut(&mut self.state.trees));
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
    }

    fn run(&mut self, q: &mut [f64], v: &mut [f64]) {
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
            self.drive(step);
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

    /// Computes the motor torques of all runs of the group for step `step`.
    fn drive(&mut self, step: usize) {
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
    fn diverged(&self) -> Option<usize> {
        let state = only(&self.state.trees);
        let numbers = || state.q.iter().chain(&state.v);
        (0..self.count).find(|&lane| !numbers().all(|x| x.lane(lane).is_finite()))
    }
}
