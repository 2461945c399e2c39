//! Checks of the certificate for one tree, evaluated at every step of a run whose rows are not sufficient for
//! them.

use super::certificate::{BaseMotion, MassMotion, PairChecks, Stream, Sums};
use super::environment_loads::EnvironmentLoads;
use super::error::SimulationError;
use super::integrator::{FirstStage, StepEnds};
use super::recorder::{RecordOptions, Recorder};
use super::tree::Tree;
use super::tree_state::TreeState;
use crate::dynamics::center_of_mass;
use crate::model::Model;
use crate::spatial::{Quat, Scalar, Vec3};
use serde::{Deserialize, Serialize};

/// Motion of the base and of the centre of mass at one end of a step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct End {
    base: BaseMotion,
    whole: MassMotion,
}

/// Checks of one tree that compare successive steps, evaluated during the run.
pub(super) struct EveryStep {
    stream: Stream,
    /// Motion at the start of the current step. After the step, it also contains the accelerations and forces
    /// at both ends of the step.
    start: Option<End>,
    /// Trace rows at both ends of the last step for which the base rows of inverse dynamics were checked.
    rows: Recorder,
}

/// State of [`EveryStep`] between two steps, for checkpoints.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct SavedChecks {
    sums: Sums,
    start: Option<End>,
}

impl EveryStep {
    pub(super) fn new(number: usize, model: &Model) -> Result<Self, SimulationError> {
        let rows = Recorder::new(2, (number, model), RecordOptions::default(), &[], true)?;
        Ok(Self { stream: Stream::new(model), start: None, rows })
    }

    /// Returns the results of the checks over all steps so far.
    pub(super) fn checks(&self) -> PairChecks {
        self.stream.checks()
    }

    pub(super) fn save(&self) -> SavedChecks {
        SavedChecks { sums: self.stream.sums(), start: self.start }
    }

    pub(super) fn restore(&mut self, saved: SavedChecks) {
        self.stream.set_sums(saved.sums);
        self.start = saved.start;
    }

    /// Excludes the current step from the checks.
    pub(super) fn skip(&mut self) {
        self.start = None;
    }

    /// Adds the step that ends at `state` at the time `t`, s. Requires that the base twist of `state` has
    /// been projected onto the momentum, and that `system` contains the kinematics of `state`.
    pub(super) fn end<S: Scalar>(&mut self, t: f64, state: &TreeState<S>, system: &Tree<'_, S>) {
        if let Some(start) = self.start.take().filter(|start| start.base.time < t) {
            let mut now = End::of(t, state, system);
            // the accelerations at the end of the step are stored with its start
            now.base.change_before = start.base.change_before;
            now.base.changes = start.base.changes;
            now.whole.force_before = start.whole.force_before;
            self.stream.add((&start.base, &start.whole), (&now.base, &now.whole));
        }
    }

    /// Stores the start of a step at `t`, s, before the step is computed. Requires the kinematics of `state`
    /// in `system`.
    pub(super) fn start<S: Scalar>(&mut self, t: f64, state: &TreeState<S>, system: &Tree<'_, S>) {
        self.start = Some(End::of(t, state, system));
    }

    /// Adds the accelerations and forces at both ends of the step, which are those of its first and last
    /// stages.
    pub(super) fn add_stages(&mut self, step: &StepEnds<'_, impl Scalar>) {
        let Some(End { base, whole }) = &mut self.start else { return };
        let first = &step.first.acceleration;
        base.change_after = value(Vec3::from_slice(&first[3..]));
        let last = &step.last.a;
        base.change_before = value(Vec3::from_slice(&last[3..]));
        base.changes = last[3..].iter().map(|x| x.value().abs()).sum::<f64>() + base.rates * base.rates;
        whole.force_after = value(step.first.force);
        whole.force_before = value(step.last.wrench.linear);
    }

    /// Records the start of a step whose base rows are checked. Requires the kinematics and loads of `state`
    /// in `system`.
    pub(super) fn record_start<S: Scalar>(
        &mut self,
        t: f64,
        state: &TreeState<S>,
        system: &Tree<'_, S>,
        loads: &mut EnvironmentLoads,
    ) -> Result<(), SimulationError> {
        self.rows.truncate(0);
        self.record_end(t, state, system, loads)
    }

    /// Records the end of a step whose base rows are checked. Requires that the base twist of `state` has
    /// been projected onto the momentum, and that `system` contains the kinematics and loads of `state`.
    pub(super) fn record_end<S: Scalar>(
        &mut self,
        t: f64,
        state: &TreeState<S>,
        system: &Tree<'_, S>,
        loads: &mut EnvironmentLoads,
    ) -> Result<(), SimulationError> {
        self.rows.record_state(t, state, system, None, None);
        self.rows.record_wrenches(&system.model, loads, t)
    }

    /// Adds the acceleration of the first stage to the row at the start of the step, which completes the row.
    pub(super) fn complete_start<S: Scalar>(&mut self, model: &Model, first: &FirstStage<S>) {
        self.rows.record_acceleration(model, &first.acceleration);
    }

    /// Adds the acceleration of the first stage of the next step to the row at the end of the step, and
    /// checks the base rows.
    pub(super) fn complete_end<S: Scalar>(&mut self, model: &Model, first: &FirstStage<S>) {
        self.rows.record_acceleration(model, &first.acceleration);
        self.stream.add_rows(model, &self.rows.trace);
    }
}

impl End {
    /// Returns the motion at `state`, without accelerations and forces. Requires that the base twist of
    /// `state` has been projected onto the momentum.
    fn of<S: Scalar>(time: f64, state: &TreeState<S>, system: &Tree<'_, S>) -> Self {
        let attitude = Quat { v: value(Vec3::from_slice(&state.q[3..])), w: state.q[6].value() };
        let rate = value(Vec3::from_slice(&state.v[3..]));
        let rates: f64 = state.v[3..].iter().map(|x| x.value().abs()).sum();
        let zero = Vec3::zero();
        let base = BaseMotion {
            time,
            attitude,
            rate,
            change_before: zero,
            change_after: zero,
            rates,
            changes: rates * rates,
            is_cut: false,
        };
        let whole = MassMotion {
            time,
            mass: system.model.mass(),
            center: value(center_of_mass(&system.data, &state.q)),
            momentum: value(state.momentum().linear),
            impulse: value(state.impulse.linear),
            force_before: zero,
            force_after: zero,
        };
        Self { base, whole }
    }
}

fn value<S: Scalar>(v: Vec3<S>) -> Vec3<f64> {
    Vec3::new(v.x.value(), v.y.value(), v.z.value())
}
