//! Rollouts: many runs without an environment, with passive joints, given torques or computed torque.

use super::input::{InputError, check_finite, check_frame, check_quaternions, check_whole};
use super::looped_torque;
use super::rollout_lanes::Lanes;
use super::rollout_settings::{Rollout, RolloutControl};
use super::threads::{Threads, for_each};
use crate::model::Model;
use crate::simulation::Integrator;
use crate::spatial::{Fused, InstructionSet, Lanes4, Lanes8, Real};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

impl Rollout<'_> {
    /// Simulates one run from each of the initial states `q0`, `(B, nq)`, and `v0`, `(B, nv)`, and writes the
    /// recorded states to `q`, `(B, rows, nq)`, and `v`, `(B, rows, nv)`, where `rows` is [`Rollout::rows`].
    /// The results are bit-identical for any number of threads. For a robot with closed loops or mimic
    /// joints, the initial states are first corrected to satisfy these constraints, as in a simulation.
    ///
    /// # Errors
    /// [`InputError`] for invalid inputs, [`InputError::OpenStart`] for the first initial state in which a
    /// loop is open, a mimic joint does not follow its leader or the constraints cannot be satisfied, and
    /// [`InputError::Diverged`] for the first run whose state becomes non-finite, after the results of all
    /// other runs were written.
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
                return Err(InputError::WrongTotal { name, expected: count * expected, got });
            }
        }
        check_finite("q0", q0, model.nq())?;
        check_finite("v0", v0, model.nv())?;
        check_quaternions("q0", q0, model.nq())?;
        if let RolloutControl::Torques(tau) = self.control {
            let expected = self.steps * model.joint_count();
            if tau.len() != count * expected {
                return Err(InputError::WrongTotal {
                    name: "tau",
                    expected: count * expected,
                    got: tau.len(),
                });
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
                looped_torque::check(model, law, reference)?;
                return match InstructionSet::current() {
                    InstructionSet::Baseline => {
                        self.all::<f64>(model, [q0, v0], [q, v], looped_torque::run::<f64>)
                    }
                    InstructionSet::Fused | InstructionSet::Wide => {
                        self.all::<Fused>(model, [q0, v0], [q, v], looped_torque::run::<Fused>)
                    }
                };
            }
        }
        match InstructionSet::current() {
            InstructionSet::Baseline => self.open::<f64>(model, [q0, v0], [q, v]),
            InstructionSet::Fused | InstructionSet::Wide if sticks => {
                self.open::<Fused>(model, [q0, v0], [q, v])
            }
            InstructionSet::Fused if q0.len() == model.nq() => self.open::<Fused>(model, [q0, v0], [q, v]),
            InstructionSet::Fused => self.open::<Lanes4>(model, [q0, v0], [q, v]),
            InstructionSet::Wide => self.open::<Lanes8>(model, [q0, v0], [q, v]),
        }
    }

    /// Simulates all runs of a robot; with computed torque, the robot must not have closed loops or mimic
    /// joints.
    fn open<S: Real>(
        &self,
        model: &Model,
        start: [&[f64]; 2],
        out: [&mut [f64]; 2],
    ) -> Result<(), InputError> {
        self.all::<S>(model, start, out, |lanes, q, v| lanes.run(q, v, Lanes::drive))
    }

    /// Simulates all runs, each group of runs with `simulate`.
    fn all<S: Real>(
        &self,
        model: &Model,
        [q0, v0]: [&[f64]; 2],
        [q, v]: [&mut [f64]; 2],
        simulate: impl Fn(&mut Lanes<'_, S>, &mut [f64], &mut [f64]) + Sync,
    ) -> Result<(), InputError> {
        let count = q0.len() / model.nq();
        let (q_rows, v_rows) = (S::LANES * self.rows() * model.nq(), S::LANES * self.rows() * model.nv());
        let diverged = AtomicUsize::new(count);
        let refused: Mutex<Option<(usize, InputError)>> = Mutex::new(None);
        for_each(
            Threads { count: self.threads, stop: Some(self.stop) },
            q.chunks_mut(q_rows).zip(v.chunks_mut(v_rows)).enumerate(),
            || Lanes::<S>::new(self, model),
            |lanes, (group, (q, v))| {
                let first = group * S::LANES;
                if let Err(error) = lanes.start(q0, v0, first, S::LANES.min(count - first)) {
                    let mut refused = refused.lock().unwrap_or_else(PoisonError::into_inner);
                    if refused.as_ref().is_none_or(|(earlier, _)| first < *earlier) {
                        *refused = Some((first, error));
                    }
                    return;
                }
                simulate(lanes, q, v);
                if let Some(lane) = lanes.diverged() {
                    diverged.fetch_min(first + lane, Ordering::Relaxed);
                }
            },
        )?;
        if let Some((_, error)) = refused.into_inner().unwrap_or_else(PoisonError::into_inner) {
            return Err(error);
        }
        match diverged.into_inner() {
            state if state < count => Err(InputError::Diverged { state }),
            _ => Ok(()),
        }
    }
}
