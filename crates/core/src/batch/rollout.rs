//! Many runs at once, in empty space: passive, with given torques, or under computed torque.

use super::input::{InputError, check_finite, check_frame, check_quaternions, check_whole};
use super::side_by_side::{Places, gather, scatter};
use super::threads::{Threads, for_each};
use crate::control::{ComputedTorque, ComputedTorqueWork, computed_torque};
use crate::model::{Model, neutral};
use crate::reference::TaskReference;
use crate::simulation::{Integrator, Nothing, Plant, State, Stepper, Stepping};
use crate::spatial::{Fused, InstructionSet, Lanes4, Lanes8, Real};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// What drives the joints in a rollout.
#[derive(Clone, Copy, Debug, Default)]
pub enum RolloutControl<'a> {
    /// Nothing.
    #[default]
    Passive,
    /// Given torques, `(B, steps, n)`, N m.
    Torques(&'a [f64]),
    /// Computed torque towards one reference for all, in no orbit's frame.
    ComputedTorque(&'a ComputedTorque, &'a TaskReference),
}

/// How to roll out.
#[derive(Clone, Copy, Debug)]
pub struct Rollout<'a> {
    /// Number of steps.
    pub steps: usize,
    /// Step, s.
    pub time_step: f64,
    /// How to step.
    pub integrator: Integrator,
    /// What drives the joints.
    pub control: RolloutControl<'a>,
    /// Every how many steps a row is written, the start being the first; only the end if `None`.
    pub record_every: Option<usize>,
    /// Number of threads; all cores if `None`.
    pub threads: Option<usize>,
    /// Set from elsewhere to stop early; what is written then is of no use.
    pub stop: &'a AtomicBool,
}

impl Rollout<'_> {
    /// Rows written per state.
    pub fn rows(&self) -> usize {
        self.record_every.map_or(1, |every| self.steps / every.max(1) + 1)
    }

    /// Rolls out states `q0`, `(B, nq)`, and `v0`, `(B, nv)`, into `q`, `(B, rows, nq)`, and `v`,
    /// `(B, rows, nv)`. The bits do not depend on the number of threads.
    ///
    /// # Errors
    /// [`InputError`] for a start that no kernel takes, and [`InputError::Diverged`] for the first
    /// state that did not stay finite; all others are written then.
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
        // joints that stick and slip do so each at its own time: one state after the other
        let sticks = model.has_friction();
        if let RolloutControl::ComputedTorque(law, reference) = self.control {
            check_frame(model, law.frame)?;
            if reference.needs_orbit() {
                return Err(InputError::NeedsOrbit);
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

    /// Rolls all out; returns the first that did not stay finite.
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

/// As many runs as the scalar has lanes, one group of runs after the other.
struct Lanes<'a, S> {
    settings: &'a Rollout<'a>,
    plant: Plant<'a, S, Nothing>,
    state: State<S>,
    stepper: Stepper<S>,
    work: Option<ComputedTorqueWork<S>>,
    /// Number of the first run.
    first: usize,
    /// Runs wanted; further lanes repeat the last.
    count: usize,
}

impl<'a, S: Real> Lanes<'a, S> {
    fn new(settings: &'a Rollout<'a>, model: &'a Model) -> Self {
        let mut plant = Plant::new(model, Nothing, None);
        let q = neutral(model).into_iter().map(S::of).collect();
        let state = State::at(model, &mut plant.data, q, vec![S::of(0.0); model.nv()]);
        let Rollout { integrator, time_step, .. } = *settings;
        let duration = time_step * settings.steps as f64;
        let how = Stepping { integrator, tolerance: 0.0, time_step, duration };
        let stepper = Stepper::new(model, &state, &how);
        let is_controlled = matches!(settings.control, RolloutControl::ComputedTorque(..));
        let work = is_controlled.then(|| ComputedTorqueWork::new(model));
        Self { settings, plant, state, stepper, work, first: 0, count: 0 }
    }

    /// Takes up the runs from `first` on.
    fn start(&mut self, q0: &[f64], v0: &[f64], first: usize, count: usize) {
        (self.first, self.count) = (first, count);
        let (mut q, mut v) = (std::mem::take(&mut self.state.q), std::mem::take(&mut self.state.v));
        S::enter(
            #[inline(always)]
            || {
                for (from, to) in [(q0, &mut q), (v0, &mut v)] {
                    gather(from, Places { first: first * to.len(), stride: to.len(), count }, to);
                }
            },
        );
        self.state = State::at(self.plant.model, &mut self.plant.data, q, v);
        self.stepper.restart();
    }

    fn run(&mut self, q: &mut [f64], v: &mut [f64]) {
        let Rollout { steps, time_step, record_every, .. } = *self.settings;
        let mut row = 0;
        for step in 0..steps {
            if self.settings.stop.load(Ordering::Relaxed) {
                return;
            }
            self.plant.settle(&mut self.state);
            if record_every.is_some_and(|every| step % every.max(1) == 0) {
                self.write(row, q, v);
                row += 1;
            }
            self.drive(step);
            self.advance(step as f64 * time_step, (step + 1) as f64 * time_step);
        }
        self.plant.settle(&mut self.state);
        if record_every.is_none_or(|every| steps % every.max(1) == 0) {
            self.write(row, q, v);
        }
    }

    /// One step, in pieces where joints stop or break away.
    fn advance(&mut self, mut t: f64, end: f64) {
        let Self { plant, state, stepper, .. } = self;
        plant.decide(&state.q, &state.v);
        // in empty space nothing refuses a step
        while let Ok(reached) = stepper.advance(plant, state, (t, end)) {
            if reached >= end {
                break;
            }
            t = reached;
            plant.settle(state);
            plant.decide(&state.q, &state.v);
        }
    }

    /// Torques for a step.
    fn drive(&mut self, step: usize) {
        let Self { plant, state, settings, work, first, count, .. } = self;
        match settings.control {
            RolloutControl::Passive => {}
            RolloutControl::Torques(tau) => {
                let n = plant.command.len();
                let stride = settings.steps * n;
                let places = Places { first: *first * stride + step * n, stride, count: *count };
                S::enter(
                    #[inline(always)]
                    || gather(tau, places, &mut plant.command),
                );
            }
            RolloutControl::ComputedTorque(law, reference) => {
                let Some(work) = work else { return };
                let t = step as f64 * settings.time_step;
                let desired = reference.sample(t, 0.0).expect("no frame of an orbit: checked").lift();
                let (data, command) = (&mut plant.data, &mut plant.command);
                let is_relative = reference.is_relative_to_base();
                let (q, v) = (&state.q, &state.v);
                computed_torque(law, plant.model, data, q, v, &desired, is_relative, work, command);
                work.ask(law, plant.contacts.asked_mut());
            }
        }
    }

    fn write(&self, row: usize, q: &mut [f64], v: &mut [f64]) {
        let (rows, count) = (self.settings.rows(), self.count);
        S::enter(
            #[inline(always)]
            || {
                for (values, to) in [(&self.state.q, q), (&self.state.v, v)] {
                    let width = values.len();
                    scatter(values, Places { first: row * width, stride: rows * width, count }, to);
                }
            },
        );
    }

    /// The first of the runs whose state is not finite. One that was not once never is again.
    fn diverged(&self) -> Option<usize> {
        let numbers = || self.state.q.iter().chain(&self.state.v);
        (0..self.count).find(|&lane| !numbers().all(|x| x.lane(lane).is_finite()))
    }
}
