//! Checkpoints: states of a run between two steps, from which the run can resume with bit-identical results.

use super::checkpoint_error::CheckpointError;
use super::connections::SavedMembers;
use super::contacts::{Mode, RestingPoint, Touch};
use super::estimates::Estimates;
use super::events::{Attached, EventState};
use super::every_step::SavedChecks;
use super::group_balance::GroupBalance;
use super::integrator::StepControl;
use super::local_reference::LocalReference;
use super::modes::SavedModes;
use super::recording::{EventRecord, Ledger};
use super::schedule::{Cursor, Schedule};
use super::state::State;
use super::state_range::{UNIT_NORM, attitude_norm};
use super::step_doubling::Errors;
use super::tree_state::TreeState;
use super::wrench_commands::WrenchCommands;
use crate::control::ControlMemory;
use crate::model::BASE_NV;
use crate::number_text::short;
use crate::spatial::InstructionSet;
use crate::world::{Layout, SystemPlace};
use serde::{Deserialize, Serialize};

/// Largest number of steps of a run; counting to twice this number does not overflow.
const MOST_STEPS: usize = usize::MAX / 2;

/// State from which a run can resume, without the rows recorded so far. A run that resumes from a checkpoint
/// and these rows gives results that are bit-identical to those of an uninterrupted run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Checkpoint {
    /// Version of the library that wrote the checkpoint. Other versions may round differently.
    version: String,
    /// Instruction set of the run. Other instruction sets round differently.
    instruction_set: String,
    /// One checkpoint per group of systems.
    groups: Vec<GroupCheckpoint>,
}

/// Checkpoint of one group of systems.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct GroupCheckpoint {
    /// Time of the checkpoint, s.
    pub(super) time: f64,
    pub(super) schedule: Schedule,
    pub(super) progress: Progress,
    pub(super) local_reference: Option<LocalReference>,
    /// Wrenches that the caller of the stepper has commanded and that still act.
    #[serde(default, skip_serializing_if = "WrenchCommands::is_empty")]
    pub(super) wrenches: WrenchCommands,
    pub(super) controllers: SavedControllers,
}

/// State of a group of systems that a step changes, except the state of the controllers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Progress {
    /// Number of steps taken so far.
    pub(super) steps: usize,
    pub(super) cursor: Cursor,
    pub(super) state: State<f64>,
    pub(super) step_control: Option<StepControl>,
    /// Number of consecutive idle steps, in which a mode changed after almost no progress.
    pub(super) idle_steps: usize,
    /// True if the elastic energy of contacts has jumped in the last step.
    #[serde(default)]
    pub(super) has_jumped: bool,
    /// Progress of each tree.
    pub(super) trees: Vec<TreeProgress>,
    /// Progress of each system.
    pub(super) systems: Vec<SystemProgress>,
    pub(super) world: WorldProgress,
}

/// Quantities of a tree, other than its state, that a step changes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct TreeProgress {
    pub(super) modes: SavedModes,
    pub(super) errors: Option<Errors>,
    pub(super) checks: Option<SavedChecks>,
}

/// Quantities of a system, other than its state and its controllers, that a step changes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct SystemProgress {
    /// Number of rows recorded so far.
    pub(super) rows: usize,
    /// Sum of the magnitudes of the work of each step, J.
    pub(super) work_done: f64,
    pub(super) settled: Option<Estimates>,
    /// For each brake of the system, true if it is engaged.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(super) engaged: Vec<bool>,
}

/// Connections, events and contacts of a group of systems, and the totals of its momentum and energy.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct WorldProgress {
    pub(super) members: SavedMembers,
    pub(super) events: Vec<EventState>,
    /// Records of the events that have happened. Empty in the state that is saved before a trial step,
    /// because the records of a trial step are removed separately when the step is undone.
    pub(super) records: Vec<EventRecord>,
    pub(super) attached: Vec<Attached>,
    pub(super) ledger: Ledger,
    pub(super) balance: GroupBalance,
    /// Modes of all pairs of contact pieces.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(super) contacts: Vec<Mode>,
    /// Present or last touch of each declared contact.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(super) touches: Vec<Touch>,
    /// Points at which the pieces of each pair rest on each other; empty without impact laws.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(super) resting: Vec<Option<Vec<RestingPoint>>>,
}

/// State of the controllers and joint torques of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct SavedControllers {
    /// True if the controllers have been updated at the current cut.
    pub(super) controllers_updated: bool,
    /// State of the controllers of each system.
    pub(super) systems: Vec<SystemControllers>,
}

/// State of the controllers and joint torques of one system.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct SystemControllers {
    /// Joint torques that are held during the current step, `(n,)`, N m or N.
    pub(super) command: Vec<f64>,
    /// Torques commanded by the caller of the stepper, `(n,)`, N m or N; `None` for joints without a command.
    pub(super) commanded: Vec<Option<f64>>,
    /// Accelerations that control laws request for joints whose friction they compensate, `(n,)`, rad/s² or
    /// m/s²; `None` for other joints.
    pub(super) requested: Vec<Option<f64>>,
    /// Torques, `(n,)`, N m or N, and requested accelerations, `(n,)`, rad/s² or m/s², that were held before
    /// the last trial step that updated the controllers; `None` if no trial step has updated them.
    pub(super) held: Option<(Vec<f64>, Vec<Option<f64>>)>,
    pub(super) controls: Vec<ControlMemory>,
}

/// Returns the name of the instruction set that runs use on this machine. It is at most the set with fused
/// multiply-add, because only batches use wider SIMD lanes.
fn own_instruction_set() -> &'static str {
    InstructionSet::current().min(InstructionSet::Fused).name()
}

impl Checkpoint {
    pub(super) fn new(groups: Vec<GroupCheckpoint>) -> Self {
        let (version, instruction_set) =
            (env!("CARGO_PKG_VERSION").to_owned(), own_instruction_set().to_owned());
        Self { version, instruction_set, groups }
    }

    /// Returns the time of the checkpoint, s.
    pub fn time(&self) -> f64 {
        self.groups.first().map_or(0.0, |group| group.time)
    }

    /// Returns the planned end of the run, s; `None` for an open-ended run.
    pub fn duration(&self) -> Option<f64> {
        self.groups.first().and_then(|group| group.schedule.duration())
    }

    /// Returns the number of rows of the first system that were recorded before the checkpoint.
    pub fn rows(&self) -> usize {
        let first = self.groups.first().and_then(|group| group.progress.systems.first());
        first.map_or(0, |system| system.rows)
    }

    /// Returns the checkpoint as JSON, from which [`Checkpoint::from_json`] restores every number bit by bit.
    pub fn to_json(&self) -> String {
        serde_json::to_string(self).expect("numbers, strings and lists can be written")
    }

    /// Reads a checkpoint from the output of [`Checkpoint::to_json`].
    ///
    /// # Errors
    /// [`CheckpointError::Unreadable`] if `text` is damaged, and [`CheckpointError::OtherVersion`] if a
    /// different version wrote it.
    pub fn from_json(text: &str) -> Result<Self, CheckpointError> {
        let own = env!("CARGO_PKG_VERSION");
        let unreadable = |error: serde_json::Error| CheckpointError::Unreadable {
            reason: format!("its text cannot be read ({error})"),
        };
        let value: serde_json::Value = serde_json::from_str(text).map_err(unreadable)?;
        match value.get("version").and_then(|version| version.as_str()) {
            Some(version) if version != own => {
                Err(CheckpointError::OtherVersion { found: version.to_owned(), own: own.to_owned() })
            }
            _ => serde_json::from_str(text).map_err(unreadable),
        }
    }

    /// Returns the checkpoints of the groups, after checking that there are `count` groups and that this run
    /// uses the instruction set of the checkpoint.
    pub(super) fn into_groups(self, count: usize) -> Result<Vec<GroupCheckpoint>, CheckpointError> {
        let own = own_instruction_set();
        if self.instruction_set != own {
            let (found, own) = (self.instruction_set, own.to_owned());
            return Err(CheckpointError::OtherInstructionSet { found, own });
        }
        check_each([("groups of systems", self.groups.len(), count)])?;
        Ok(self.groups)
    }
}

impl GroupCheckpoint {
    /// Checks that a run with this layout, this schedule and `events` events can resume from the checkpoint;
    /// `rows` contains the number of recorded rows of each system.
    pub(super) fn check(
        &self,
        layout: &Layout,
        schedule: &Schedule,
        rows: &[usize],
        events: usize,
    ) -> Result<(), CheckpointError> {
        for (system, &got) in self.progress.systems.iter().zip(rows) {
            if got != system.rows {
                return Err(CheckpointError::MissingRows { got, expected: system.rows });
            }
        }
        self.check_sizes(layout, events)?;
        self.check_counts()?;
        self.check_state()?;
        if !self.schedule.has_cuts_of(schedule) {
            let (duration, step) = (self.schedule.duration(), self.schedule.time_step());
            let what = self.schedule.differences(schedule);
            return Err(CheckpointError::OtherSchedule { duration, step, what });
        }
        let mut there = schedule.clone();
        there.set_cursor(self.progress.cursor);
        if there.is_consistent(self.time) {
            Ok(())
        } else {
            let reason =
                format!("its time, {} s, does not match its position in the schedule", short(self.time));
            Err(CheckpointError::Unreadable { reason })
        }
    }

    /// Checks that the state and the commanded wrenches are finite, the attitudes are unit quaternions, and
    /// the step control is valid.
    fn check_state(&self) -> Result<(), CheckpointError> {
        let Progress { state, step_control, .. } = &self.progress;
        let has_unit_attitude = |state: &TreeState<f64>| (attitude_norm(&state.q) - 1.0).abs() <= UNIT_NORM;
        let is_step = |step: f64| step == 0.0 || step.is_normal() && step > 0.0;
        let has_step = step_control.as_ref().is_none_or(|control| {
            is_step(control.step) && control.trees.iter().all(|system| system.size >= 0.0)
        });
        let reason = if !self.wrenches.is_finite() {
            "a commanded wrench is not finite"
        } else if !state.is_finite() {
            "its state is not finite"
        } else if !state.trees.iter().all(has_unit_attitude) {
            "an attitude is not a unit quaternion"
        } else if !has_step {
            "its step size is negative or not finite, or an error scale is negative"
        } else {
            return Ok(());
        };
        Err(CheckpointError::Unreadable { reason: reason.to_owned() })
    }

    fn check_sizes(&self, layout: &Layout, events: usize) -> Result<(), CheckpointError> {
        let Self { progress, controllers, .. } = self;
        let (count, trees) = (layout.systems().len(), progress.trees.len());
        let scales = progress.step_control.as_ref().map(|control| control.trees.len());
        check_each([
            ("systems", progress.systems.len(), count),
            ("systems with controllers", controllers.systems.len(), count),
            ("events", progress.world.events.len(), events),
            ("trees with states", progress.state.trees.len(), trees),
            ("trees with error scales", scales.unwrap_or(trees), trees),
        ])?;
        controllers
            .systems
            .iter()
            .zip(layout.systems())
            .try_for_each(|(saved, place)| saved.check_sizes(place))
    }

    /// Checks that the states of the trees have the same sizes as `expected`.
    pub(super) fn check_trees<S>(&self, expected: &State<S>) -> Result<(), CheckpointError> {
        let progress = &self.progress;
        check_each([("trees", progress.trees.len(), expected.trees.len())])?;
        for ((state, tree), own) in progress.state.trees.iter().zip(&progress.trees).zip(&expected.trees) {
            check_each([
                ("coordinates", state.q.len(), own.q.len()),
                ("velocities", state.v.len(), own.v.len()),
                ("members of a tree", state.shares.len(), own.shares.len()),
            ])?;
            tree.check_sizes(own.v.len() - BASE_NV)?;
        }
        Ok(())
    }

    fn check_counts(&self) -> Result<(), CheckpointError> {
        let Progress { steps, idle_steps, trees, .. } = &self.progress;
        let errors = trees.iter().filter_map(|tree| tree.errors.as_ref());
        let probed = errors.map(|errors| errors.step).max().unwrap_or(0);
        if probed > *steps || *steps.max(idle_steps) > MOST_STEPS {
            let reason = format!(
                "the number of steps ({steps}), that of idle steps ({idle_steps}) and the index of the last step with an error \
                 estimate ({probed}) are inconsistent"
            );
            return Err(CheckpointError::Unreadable { reason });
        }
        Ok(())
    }
}

impl TreeProgress {
    fn check_sizes(&self, n: usize) -> Result<(), CheckpointError> {
        check_each([
            ("locked joints", self.modes.locked.len(), n),
            ("directions of slip", self.modes.direction.len(), n),
        ])?;
        check_each(self.errors.iter().flat_map(|errors| {
            let jumps = errors.jumps.joints().map(|got| ("joints with jumps of acceleration", got, n));
            [("step-doubling errors", errors.drifts.len(), n + 1)].into_iter().chain(jumps)
        }))
    }
}

impl SystemControllers {
    fn check_sizes(&self, place: &SystemPlace) -> Result<(), CheckpointError> {
        let n = place.tau.len();
        check_each([
            ("torques", self.command.len(), n),
            ("commands", self.commanded.len(), n),
            ("accelerations", self.requested.len(), n),
            ("held torques", self.held.as_ref().map_or(n, |(command, _)| command.len()), n),
            ("held accelerations", self.held.as_ref().map_or(n, |(_, requested)| requested.len()), n),
        ])
    }
}

/// Returns an error for the first entry `(name, got, expected)` whose two numbers differ.
pub(super) fn check_each(
    sizes: impl IntoIterator<Item = (&'static str, usize, usize)>,
) -> Result<(), CheckpointError> {
    match sizes.into_iter().find(|(_, got, expected)| got != expected) {
        Some((name, got, expected)) => Err(CheckpointError::OtherSize { name, got, expected }),
        None => Ok(()),
    }
}
