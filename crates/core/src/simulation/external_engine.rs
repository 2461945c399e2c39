//! External engine of a run, with buffers for its input and output.

use super::contacts::Contacts;
use super::engine::{BodyWeld, ContactOutput, EngagedBrake, Engine, StepInput, StepOutput};
use super::error::SimulationError;
use super::recorder::Recorder;
use super::recording::Ledger;
use super::state::State;
use super::state_range::attitude_norm;
use super::tree::Tree;
use crate::model::Model;
use crate::spatial::{Force, Scalar, Vec3};
use std::ops::Range;

/// Largest accepted difference between 1 and the norm of a quaternion that an engine returns.
const UNIT: f64 = 1e-9;

/// External engine of a run. Each system, whether connected or not, is a tree of the run.
pub(super) struct ExternalEngine<'a> {
    engine: &'a mut dyn Engine,
    q: Vec<f64>,
    v: Vec<f64>,
    tau: Vec<f64>,
    /// Index ranges of each system in the vectors of all configurations and of all velocities.
    ranges: Vec<[Range<usize>; 2]>,
    pub(super) welds: Vec<BodyWeld>,
    pub(super) brakes: Vec<EngagedBrake>,
    /// For each declared contact, its index among the outputs of the engine; `None` if the engine does not
    /// compute its force.
    contacts: Vec<Option<usize>>,
    output: StepOutput,
    /// True if the engine completed its last step.
    has_output: bool,
}

impl<'a> ExternalEngine<'a> {
    /// Creates the buffers for an engine that moves systems with these models; `contacts` are the names of
    /// the declared contacts.
    pub(super) fn new(engine: &'a mut dyn Engine, models: &[&Model], contacts: &[String]) -> Self {
        let computed = engine.contacts();
        let output = StepOutput::new(models, computed.len());
        let contacts = contacts.iter().map(|name| computed.iter().position(|own| own == name)).collect();
        let (mut ranges, mut next) = (Vec::new(), [0; 2]);
        for model in models {
            let [nq, nv] = next;
            next = [nq + model.nq(), nv + model.nv()];
            ranges.push([nq..next[0], nv..next[1]]);
        }
        let tau = vec![0.0; models.iter().map(|model| model.joint_count()).sum()];
        let (q, v) = (output.q.clone(), output.v.clone());
        let (welds, brakes) = (Vec::new(), Vec::new());
        Self { engine, q, v, tau, ranges, welds, brakes, contacts, output, has_output: false }
    }

    /// Returns the acceleration of the system with index `system` at the start of the last step, `(nv,)`,
    /// m/s² and rad/s²; `None` if there was no step or the last one failed.
    pub(super) fn first_acceleration(&self, system: usize) -> Option<&[f64]> {
        let [_, range] = &self.ranges[system];
        self.has_output.then(|| &self.output.acceleration[range.clone()])
    }

    /// Adds the acceleration of the system with index `system` at the start of the last step to the last row
    /// in `recorder`, or removes the row if that step failed.
    #[cold]
    pub(super) fn complete_row(&self, system: usize, recorder: &mut Recorder, model: &Model) {
        match self.first_acceleration(system) {
            Some(acceleration) => recorder.record_acceleration(model, acceleration),
            None => recorder.drop_last_row(),
        }
    }

    /// Returns the work done on a system in the last step, including the work of its connections and
    /// contacts, less the energy that its joints dissipated, J.
    #[cold]
    pub(super) fn work_of_step(&self, system: usize) -> f64 {
        let done = &self.output.systems[system];
        done.work + done.weld_work
    }

    /// Returns the output of the last step for the declared contact with index `number`; `None` if that step
    /// failed, or if the engine does not compute its force.
    #[cold]
    pub(super) fn contact(&self, number: usize) -> Option<&ContactOutput> {
        let own = self.contacts[number]?;
        self.has_output.then(|| &self.output.contacts[own])
    }

    /// Adds the impulses and the work of the contacts in the last step to the contact states in `state`.
    pub(super) fn add_exchanged<S>(&self, contacts: &Contacts, state: &mut State<S>) {
        for (contact, own) in self.contacts.iter().enumerate() {
            if let Some(own) = own {
                contacts.add_exchanged(contact, &self.output.contacts[*own], &mut state.contacts);
            }
        }
    }

    /// Subtracts from the totals of a group the impulses that connections and contacts exchanged between its
    /// systems in the last step. Their work remains in the totals; the energy that they absorb is added to
    /// the dissipated energy.
    #[cold]
    pub(super) fn remove_exchanged(&self, ledger: &mut Ledger) {
        for done in &self.output.systems {
            let impulse = Force::from_slice(&done.weld_impulse);
            ledger.impulse.linear += -impulse.linear;
            ledger.impulse.angular += -impulse.angular;
            ledger.dissipated -= done.weld_work;
        }
    }

    /// Advances `state` over `interval`, s, with the joint torques of the trees.
    pub(super) fn advance<S: Scalar>(
        &mut self,
        trees: &[Tree<'_, S>],
        state: &mut State<S>,
        interval: (f64, f64),
    ) -> Result<(), SimulationError> {
        let Self { engine, q, v, tau, ranges, welds, brakes, output, has_output, .. } = self;
        for (state, [q_range, v_range]) in state.trees.iter().zip(ranges) {
            for (to, from) in [(&mut q[q_range.clone()], &state.q), (&mut v[v_range.clone()], &state.v)] {
                to.iter_mut().zip(from).for_each(|(to, from)| *to = from.value());
            }
        }
        let torques = trees.iter().flat_map(|tree| tree.torques());
        tau.iter_mut().zip(torques).for_each(|(to, tau)| *to = tau.value());
        *has_output = false;
        engine.step(&StepInput { interval, q, v, tau, welds, brakes }, output)?;
        *has_output = true;
        self.check_output(trees, interval.0)?;
        self.update_state(state);
        Ok(())
    }

    /// Checks that the output of a step of `trees` that started at `t`, s, is finite and has unit
    /// quaternions.
    fn check_output<S: Scalar>(&self, trees: &[Tree<'_, S>], t: f64) -> Result<(), SimulationError> {
        let is_finite = |[q, v]: &&[Range<usize>; 2]| {
            let values = self.output.q[q.clone()].iter().chain(&self.output.v[v.clone()]);
            values.chain(&self.output.acceleration[v.clone()]).all(|x| x.is_finite())
        };
        if !self.output.is_finite() {
            let number = self.ranges.iter().position(|range| !is_finite(&range)).unwrap_or(0);
            let [q, v] = &self.ranges[number];
            let (q, v) = (self.q[q.clone()].to_vec(), self.v[v.clone()].to_vec());
            let systems = format!("'{}'", trees[number].model.name());
            return Err(SimulationError::Diverged { time: t, systems, q, v });
        }
        for ([q, _], tree) in self.ranges.iter().zip(trees) {
            let length = attitude_norm(&self.output.q[q.clone()]);
            if (length - 1.0).abs() > UNIT {
                let system = tree.model.name().to_owned();
                return Err(SimulationError::EngineAttitude { time: t, system, length });
            }
        }
        Ok(())
    }

    /// Writes the configurations and velocities at the end of a step to `state`, and adds the impulses and
    /// the work of the step.
    fn update_state<S: Scalar>(&self, state: &mut State<S>) {
        let output = &self.output;
        let vector = |x: &[f64]| Vec3::new(S::of(x[0]), S::of(x[1]), S::of(x[2]));
        for ((state, [q, v]), done) in state.trees.iter_mut().zip(&self.ranges).zip(&output.systems) {
            for (to, from) in [(&mut state.q, &output.q[q.clone()]), (&mut state.v, &output.v[v.clone()])] {
                to.iter_mut().zip(from).for_each(|(to, from)| *to = S::of(*from));
            }
            let both: [f64; 6] = std::array::from_fn(|k| done.impulse[k] + done.weld_impulse[k]);
            state.impulse.linear += vector(&both);
            state.impulse.angular += vector(&both[3..]);
            state.work += S::of(done.work + done.weld_work);
            state.dissipated += S::of(done.dissipated);
        }
        state.orbital += vector(&output.orbital);
    }
}
