//! Where a run stands between two steps, kept so that it goes on with the same bits.

use super::pair::Memory;
use super::probe::Found;
use super::rereference::OwnReference;
use super::schedule::Schedule;
use super::state::State;
use crate::dynamics::Momentum;
use crate::model::Model;
use crate::number_text::short;
use crate::spatial::{InstructionSet, Scalar, Vec3};
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// Steps that no run takes; so many more can be counted without overflow.
const MOST_STEPS: usize = usize::MAX / 2;

/// Everything of a run that its trace does not hold: continued from here with the rows so far, it
/// leaves the bits of one that was never stopped.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Checkpoint {
    /// Version of this library; the next one may round otherwise.
    version: String,
    /// Instruction set the run used: another one rounds otherwise.
    instruction_set: String,
    /// Rows recorded so far.
    pub(super) rows: usize,
    /// Steps taken so far.
    pub(super) steps: usize,
    pub(super) schedule: Schedule,
    state: StateNumbers,
    /// Torques held, `(n,)`, N m.
    pub(super) command: Vec<f64>,
    /// Accelerations asked for where friction is compensated, `(n,)`, rad/s².
    pub(super) asked: Vec<Option<f64>>,
    /// What the control of an adaptive step remembers.
    pub(super) memory: Memory,
    /// Cuts in a row that got nowhere.
    pub(super) cuts: usize,
    /// What the step-doubling probe found.
    pub(super) probe: Found,
    /// Running checks of every step, where rows are sparse: the bits of their numbers.
    pub(super) follower: Option<Vec<u64>>,
    /// Work of every step so far, whatever its sign, J.
    pub(super) work_done: f64,
    /// What the robot is integrated about, where it drifted far.
    pub(super) own_reference: Option<OwnReference>,
    pub(super) controls: ControlMemory,
}

/// What controllers remember between calls.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct ControlMemory {
    /// Of those built in: the bits of numbers, which may be infinite.
    pub(super) bits: Vec<u64>,
    /// Of the user's own, in their order.
    pub(super) users: Vec<Vec<u8>>,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct StateNumbers {
    q: Vec<f64>,
    v: Vec<f64>,
    /// Momentum at the start of the run, then what was added.
    momentum: [f64; 12],
    work: f64,
    dissipated: f64,
}

/// A checkpoint that cannot be continued from.
#[derive(Clone, Debug, PartialEq, Error)]
#[allow(missing_docs)] // the fields are what the messages say
pub enum CheckpointError {
    #[error("the checkpoint is broken: {reason}; run the scenario again")]
    Unreadable { reason: String },
    #[error(
        "the checkpoint was left by version {found} of onorbit_rs, this is {own}, which may round otherwise: continue \
         with that version or run the scenario again"
    )]
    OtherVersion { found: String, own: String },
    #[error(
        "the checkpoint was left by a run on the instruction set {found}, this one uses {own}, which rounds otherwise: set \
         ONORBIT_INSTRUCTION_SET={found}, or run the scenario again"
    )]
    OtherInstructionSet { found: String, own: String },
    #[error("the checkpoint has {got} {name}, the simulation has {expected}: it is of another scenario")]
    OtherSize { name: &'static str, got: usize, expected: usize },
    #[error(
        "the checkpoint is of a run of {found} s with steps of {step} s, this one differs: it is of another scenario",
        found = short(*found), step = short(*step)
    )]
    OtherSchedule { found: f64, step: f64 },
}

/// What one state is computed with: there are no lanes to widen.
fn own_instruction_set() -> &'static str {
    InstructionSet::current().min(InstructionSet::Fused).name()
}

impl Checkpoint {
    pub(super) fn new<S: Scalar>(
        state: &State<S>,
        (command, asked): (&[S], &[Option<f64>]),
        schedule: &Schedule,
        (rows, steps): (usize, usize),
        (memory, cuts): (Memory, usize),
        (probe, follower): (Found, Option<Vec<u64>>),
        work_done: f64,
        own_reference: Option<&OwnReference>,
        controls: ControlMemory,
    ) -> Self {
        let numbers = |x: &[S]| x.iter().map(|x| x.value()).collect();
        let mut momentum = [0.0; 12];
        let parts = [&state.start, &state.impulse].into_iter().flat_map(|h| [h.linear, h.angular]);
        for (to, v) in momentum.chunks_exact_mut(3).zip(parts) {
            to.copy_from_slice(&[v.x.value(), v.y.value(), v.z.value()]);
        }
        let [q, v] = [&state.q, &state.v].map(|x| numbers(x));
        Self {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            instruction_set: own_instruction_set().to_owned(),
            rows,
            steps,
            schedule: schedule.clone(),
            state: StateNumbers {
                q,
                v,
                momentum,
                work: state.work.value(),
                dissipated: state.dissipated.value(),
            },
            command: numbers(command),
            asked: asked.to_vec(),
            memory,
            cuts,
            probe,
            follower,
            work_done,
            own_reference: own_reference.cloned(),
            controls,
        }
    }

    /// Time reached, s.
    pub fn time(&self) -> f64 {
        self.schedule.now()
    }

    /// Number of rows of the trace that belong to it.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// As text; every number is read back to the same bits.
    pub fn to_json(&self) -> String {
        serde_json::to_string(self).expect("plain numbers and strings")
    }

    /// From [`Checkpoint::to_json`].
    ///
    /// # Errors
    /// [`CheckpointError::Unreadable`], and [`CheckpointError::OtherVersion`].
    pub fn from_json(text: &str) -> Result<Self, CheckpointError> {
        let own = env!("CARGO_PKG_VERSION");
        let unreadable = |error: serde_json::Error| CheckpointError::Unreadable { reason: error.to_string() };
        let loose: serde_json::Value = serde_json::from_str(text).map_err(unreadable)?;
        match loose.get("version").and_then(|version| version.as_str()) {
            Some(version) if version != own => {
                Err(CheckpointError::OtherVersion { found: version.to_owned(), own: own.to_owned() })
            }
            _ => serde_json::from_str(text).map_err(unreadable),
        }
    }

    /// Whether a run of this robot on this machine can go on from here.
    pub(super) fn check(
        &self,
        model: &Model,
        schedule: &Schedule,
        rows: usize,
    ) -> Result<(), CheckpointError> {
        let own = own_instruction_set();
        if self.instruction_set != own {
            let (found, own) = (self.instruction_set.clone(), own.to_owned());
            return Err(CheckpointError::OtherInstructionSet { found, own });
        }
        for (name, got, expected) in [
            ("coordinates", self.state.q.len(), model.nq()),
            ("velocities", self.state.v.len(), model.nv()),
            ("torques", self.command.len(), model.joint_count()),
            ("accelerations", self.asked.len(), model.joint_count()),
            ("drifts", self.probe.drifts.len(), model.joint_count() + 1),
            ("rows", self.rows, rows),
        ]
        .into_iter()
        .chain(self.probe.watch.joints().map(|got| ("watched joints", got, model.joint_count())))
        {
            if got != expected {
                return Err(CheckpointError::OtherSize { name, got, expected });
            }
        }
        if self.probe.step > self.steps || self.steps.max(self.cuts) > MOST_STEPS {
            let (steps, cuts, probed) = (self.steps, self.cuts, self.probe.step);
            let reason =
                format!("no run counts {steps} steps, {cuts} cuts and a last probe at step {probed}");
            return Err(CheckpointError::Unreadable { reason });
        }
        if !self.schedule.cuts_like(schedule) {
            let (found, step) = self.schedule.duration_and_step();
            return Err(CheckpointError::OtherSchedule { found, step });
        }
        Ok(())
    }

    /// The state, bit for bit.
    pub(super) fn state<S: Scalar>(&self) -> State<S> {
        let numbers = |x: &[f64]| x.iter().map(|x| S::of(*x)).collect();
        let vector = |i: usize| {
            let m = &self.state.momentum[3 * i..];
            Vec3::new(S::of(m[0]), S::of(m[1]), S::of(m[2]))
        };
        State {
            q: numbers(&self.state.q),
            v: numbers(&self.state.v),
            start: Momentum { linear: vector(0), angular: vector(1) },
            impulse: Momentum { linear: vector(2), angular: vector(3) },
            work: S::of(self.state.work),
            dissipated: S::of(self.state.dissipated),
        }
    }
}
