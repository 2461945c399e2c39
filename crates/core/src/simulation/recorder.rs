//! Recorder, which adds rows to the trace of one system.

use super::certificate::remove_checked;
use super::checkpoint_error::CheckpointError;
use super::columns::{COLUMNS, CONTACTS, Column, Condition, LOOPS, WRENCHES};
use super::engine::ContactOutput;
use super::environment_loads::EnvironmentLoads;
use super::error::SimulationError;
use super::local_reference::Shift;
use super::trace::{NamedColumn, Trace};
use super::tree::Tree;
use super::tree_state::TreeState;
use crate::control::{Control, ControllerSet, task_error};
use crate::dynamics::{FramePose, base_rotation, frame_pose, momentum_energy_com};
use crate::model::Model;
use crate::orbit::OrbitState;
use crate::reference::TaskSample;
use crate::spatial::{Mat3, Scalar, Vec3, pose_rows};
use nalgebra::Vector3;
use std::borrow::Cow;
use std::hint::black_box;

/// Quantities that a run records in addition to its state.
#[derive(Clone, Default)]
pub(super) struct RecordOptions {
    /// Index of the frame of the tool; `None` without a tool.
    pub(super) tool: Option<usize>,
    /// True if the tool or a control of the tool has a reference.
    pub(super) has_reference: bool,
    /// Names of the effects whose wrenches are recorded.
    pub(super) effects: Vec<String>,
    /// Names of the contacts that the trace of the system records.
    pub(super) contacts: Vec<String>,
    /// Names of the closed loops that the trace of the system records.
    pub(super) loops: Vec<String>,
    /// True if the run has an orbit.
    pub(super) has_orbit: bool,
    /// True if a controller compensates Coulomb friction, a joint has such friction, and the native engine is
    /// used.
    pub(super) compensates_friction: bool,
    /// True if the run records the difference between gravity and the acceleration of the reference orbit,
    /// which `Carried` mode omits from the motion.
    pub(super) records_residual: bool,
}

impl RecordOptions {
    /// Returns the number of values per row that the run records in `column`, or 0 if the column does not
    /// apply.
    fn width(&self, column: &Column, model: &Model) -> usize {
        let is_recorded = match column.condition {
            Condition::Always => true,
            Condition::Springs => model.springs().next().is_some(),
            Condition::FrictionCompensation => self.compensates_friction,
            Condition::Tool => self.tool.is_some(),
            Condition::Reference => self.has_reference,
            Condition::Orbit => self.has_orbit,
            Condition::Carried => self.records_residual,
            Condition::Controls | Condition::Wrenches | Condition::Contacts | Condition::Loops => false,
        };
        if is_recorded { column.row_width(model) } else { 0 }
    }
}

/// Recorder that adds rows to a trace, for which it reserves memory in advance.
pub(super) struct Recorder {
    pub(super) trace: Trace,
    /// Index of the system in the group.
    number: usize,
    options: RecordOptions,
    /// Transformation of the last row to W; `None` if the motion is integrated in W.
    shift: Option<Shift>,
    /// Number of values per row of each column.
    widths: Vec<usize>,
    /// Number of rows that [`Recorder::drop_rows`] and [`Recorder::drop_checked_rows`] have removed,
    /// including rows that were checked and removed before the checkpoint from which the run was resumed.
    dropped: usize,
}

/// Returns a text that describes how the names `got` of the columns of a checkpoint differ from those of this
/// simulation.
fn difference_of_columns(got: &[String], expected: &[String]) -> String {
    let missing_in = |names: &[String], others: &[String]| {
        let quoted = names.iter().filter(|name| !others.contains(name)).map(|name| format!("'{name}'"));
        quoted.collect::<Vec<_>>().join(", ")
    };
    match (missing_in(got, expected).as_str(), missing_in(expected, got).as_str()) {
        ("", "") => "the order of its columns differs from that in this simulation".to_owned(),
        (extra, "") => format!("its rows contain {extra}, which this simulation does not record"),
        ("", lacks) => format!("its rows lack {lacks}, which this simulation records"),
        (extra, lacks) => {
            format!("its rows contain {extra}, whereas this simulation records {lacks}")
        }
    }
}

/// Returns an empty vector with memory for `rows` rows of `width` numbers.
fn reserved(rows: usize, width: usize) -> Result<Vec<f64>, SimulationError> {
    let too_many = || SimulationError::TooManyRows { rows };
    let mut numbers = Vec::new();
    numbers.try_reserve_exact(rows.checked_mul(width).ok_or_else(too_many)?).map_err(|_| too_many())?;
    Ok(numbers)
}

impl Recorder {
    pub(super) fn new(
        rows: usize,
        (number, model): (usize, &Model),
        options: RecordOptions,
        controls: &[Control],
        rows_suffice: bool,
    ) -> Result<Self, SimulationError> {
        let tracked = controls.iter().filter(|control| control.has_column && control.width() > 0);
        let column = |name: &str, width| NamedColumn { name: name.to_owned(), width, values: Vec::new() };
        let tracking: Vec<_> = tracked.map(|control| column(&control.name, control.width())).collect();
        let wrenches: Vec<_> =
            options.effects.iter().map(|name| column(name, WRENCHES.row_width(model))).collect();
        let contacts: Vec<_> =
            options.contacts.iter().map(|name| column(name, CONTACTS.row_width(model))).collect();
        let loops: Vec<_> = options.loops.iter().map(|name| column(name, LOOPS.row_width(model))).collect();
        let widths = COLUMNS.iter().map(|column| options.width(column, model));
        let named = tracking.iter().chain(&wrenches).chain(&contacts).chain(&loops);
        let widths: Vec<usize> = widths.chain(named.map(|column| column.width)).collect();
        let mut trace = Trace { rows_suffice, tracking, wrenches, contacts, loops, ..Trace::default() };
        // All columns in one block, which is freed at once. It shows that the memory suffices, and glibc then
        // keeps the freed memory of a trace for the next run, which would otherwise wait for new pages.
        black_box(reserved(rows, widths.iter().sum())?);
        for ((_, column), width) in trace.columns_mut().zip(&widths) {
            *column = reserved(rows, *width)?;
        }
        Ok(Self { trace, number, options, shift: None, widths, dropped: 0 })
    }

    /// Adds the rows recorded before a checkpoint to the trace, which must be empty.
    pub(super) fn resume(&mut self, mut rows: Trace) -> Result<(), CheckpointError> {
        let count = rows.rows();
        self.dropped = rows.rows_recorded() - count;
        self.trace.removed = rows.removed.take();
        if count == 0 && rows.columns().all(|(_, column)| column.is_empty()) {
            return Ok(());
        }
        let names = |trace: &Trace| trace.columns().map(|(name, _)| name.into_owned()).collect::<Vec<_>>();
        let (expected, got) = (names(&self.trace), names(&rows));
        if expected != got {
            return Err(CheckpointError::OtherColumns { difference: difference_of_columns(&got, &expected) });
        }
        for (((name, from), (_, to)), width) in
            rows.columns_mut().zip(self.trace.columns_mut()).zip(&self.widths)
        {
            if from.len() != count * width {
                let (got, expected) = (from.len(), count * width);
                return Err(match name {
                    Cow::Borrowed(name) => CheckpointError::OtherSize { name, got, expected },
                    Cow::Owned(name) => CheckpointError::ColumnLength { name, got, expected },
                });
            }
            to.append(from);
        }
        Ok(())
    }

    /// Adds a row at `t`, s, for a state whose kinematics are in `system`. `orbit` is the state of the
    /// reference orbit, and `desired` the desired motion of the tool together with a flag that is true if the
    /// motion is relative to the base. [`Recorder::record_acceleration`] must then complete the row.
    pub(super) fn record_state<S: Scalar>(
        &mut self,
        t: f64,
        state: &TreeState<S>,
        system: &Tree<'_, S>,
        orbit: Option<OrbitState>,
        desired: Option<(&TaskSample<f64>, bool)>,
    ) {
        S::enter(
            #[inline(always)]
            || self.record_state_kernel(t, state, system, orbit, desired),
        );
    }

    /// Adds the tracking errors of the controls to the last row.
    pub(super) fn record_tracking<S: Scalar>(&mut self, set: &ControllerSet<'_, S>) {
        let controls = set.controls().iter().enumerate();
        let tracked = controls.filter(|(_, control)| control.has_column && control.width() > 0);
        for (column, (i, _)) in self.trace.tracking.iter_mut().zip(tracked) {
            column.values.extend_from_slice(set.error(i));
        }
    }

    /// Adds the residual of the reference orbit at `t`, s, and the recorded wrenches on every body to the
    /// last row, and transforms the row to W.
    pub(super) fn record_wrenches(
        &mut self,
        model: &Model,
        loads: &mut EnvironmentLoads,
        t: f64,
    ) -> Result<(), SimulationError> {
        if loads.local_reference().is_some() || self.shift.is_some() {
            self.shift = loads.shift(t, model)?;
        }
        let trace = &mut self.trace;
        if self.options.records_residual {
            let residual = loads.reference_residual(t)?;
            trace.reference_residual.extend(residual.iter().flat_map(|residual| residual.iter()));
        }
        if let Some(shift) = &self.shift {
            shift.transform_row(trace, model);
        }
        let gravity = loads.effect_count().wrapping_sub(1); // gravity is the last effect
        for (effect, column) in trace.wrenches.iter_mut().enumerate() {
            let shift = self.shift.as_ref().filter(|_| effect == gravity);
            for (wrench, node) in loads.wrenches_of(effect, t)?.of_system(self.number).zip(model.nodes()) {
                let force =
                    wrench.force + shift.map_or_else(Vector3::zeros, |shift| shift.inertial_force(node.mass));
                column.values.extend(force.iter().chain(wrench.torque.iter()));
            }
        }
        Ok(())
    }

    /// Adds the values `row` of the contact `name` to the last row.
    pub(super) fn record_contact(&mut self, name: &str, row: &[f64]) {
        if let Some(column) = self.trace.contacts.iter_mut().find(|column| column.name == name) {
            column.values.extend_from_slice(row);
        }
    }

    /// Replaces the force and the power of the contact `name` in the last row by those in `done`, the output
    /// of an external engine.
    pub(super) fn record_contact_force(&mut self, name: &str, done: &ContactOutput) {
        let part = |name: &str| CONTACTS.parts.iter().find(|part| part.name == name).map(|part| part.start);
        let column = self.trace.contacts.iter_mut().find(|column| column.name == name);
        if let (Some(column), Some(force), Some(power)) = (column, part("force"), part("power"))
            && let Some(row) = column.values.len().checked_sub(column.width)
        {
            column.values[row + force..row + force + 3].copy_from_slice(&done.force);
            column.values[row + power] = done.power;
        }
    }

    #[inline(always)]
    fn record_state_kernel<S: Scalar>(
        &mut self,
        t: f64,
        state: &TreeState<S>,
        system: &Tree<'_, S>,
        orbit: Option<OrbitState>,
        desired: Option<(&TaskSample<f64>, bool)>,
    ) {
        let (trace, data, q, v) = (&mut self.trace, &system.data, &state.q, &state.v);
        trace.time.push(t);
        push(&mut trace.q, q);
        push(&mut trace.v, v);
        trace.tau.extend(system.torques().map(|tau| tau.value()));
        if self.options.compensates_friction {
            let compensations = system.modes.compensations();
            trace.friction_compensation.extend(compensations.map(|torque| torque.unwrap_or(0.0)));
        }
        let (h, energy, com) = momentum_energy_com(&system.model, data, q, v);
        push_vector(&mut trace.momentum, h.linear);
        push_vector(&mut trace.momentum, h.angular);
        push_vector(&mut trace.impulse, state.impulse.linear);
        push_vector(&mut trace.impulse, state.impulse.angular);
        trace.kinetic_energy.push(energy.value());
        trace.work.push(state.work.value());
        trace.dissipated.push(state.dissipated.value());
        trace.spring_energy.extend(system.spring_energy(q).map(|energy| energy.value()));
        push_vector(&mut trace.center_of_mass, com);
        if let Some(tool) = self.options.tool {
            let pose = frame_pose(&system.model, data, q, tool);
            push_pose(&mut trace.tool_pose, &pose.rot_wf, pose.pos_w);
            if self.options.has_reference {
                let desired = desired.map(|(desired, is_relative)| {
                    let desired = desired.lift();
                    if is_relative { relative_to_base(q, &desired) } else { desired }
                });
                // without an active reference, the desired pose is set to the actual pose
                let actual = || TaskSample::at_rest(pose.rot_wf, pose.pos_w);
                push_tracking(trace, &desired.unwrap_or_else(actual), &pose);
            }
        }
        if let Some(orbit) = orbit {
            let origin = orbit.position + Vec3::from_slice(q).to_nalgebra();
            let velocity = orbit.velocity + (base_rotation(q) * Vec3::from_slice(v)).to_nalgebra();
            trace.position_eci.extend_from_slice(origin.as_slice());
            trace.velocity_eci.extend_from_slice(velocity.as_slice());
            trace.reference_position_eci.extend_from_slice(orbit.position.as_slice());
            trace.reference_velocity_eci.extend_from_slice(orbit.velocity.as_slice());
        }
    }

    /// Returns a trace that contains only the last row.
    pub(super) fn last_row(&self) -> Trace {
        let trace = &self.trace;
        let named = |columns: &[NamedColumn]| {
            let empty = |column: &NamedColumn| NamedColumn {
                name: column.name.clone(),
                width: column.width,
                values: Vec::new(),
            };
            columns.iter().map(empty).collect()
        };
        let [tracking, wrenches, contacts, loops] =
            [&trace.tracking, &trace.wrenches, &trace.contacts, &trace.loops].map(|of| named(of));
        let mut row = Trace { tracking, wrenches, contacts, loops, ..Trace::default() };
        for (((_, to), (_, from)), width) in row.columns_mut().zip(trace.columns()).zip(&self.widths) {
            to.extend_from_slice(&from[from.len() - width..]);
        }
        row
    }

    /// Removes the last row, which is incomplete.
    pub(super) fn drop_last_row(&mut self) {
        self.truncate(self.trace.rows().saturating_sub(1));
    }

    /// Removes all rows except the first one and the last `keep` (at least 16), after adding them to the
    /// checks of the certificate; see [`drop_checked_rows`](super::drop_checked_rows).
    pub(super) fn drop_checked_rows(&mut self, keep: usize, model: &Model) {
        self.dropped += remove_checked(&mut self.trace, keep, model, &self.widths);
    }

    /// Removes all rows except the first one and the last `keep`. The remaining rows are then not sufficient
    /// for the checks that compare successive steps.
    pub(super) fn drop_rows(&mut self, keep: usize) {
        let excess = self.trace.rows().saturating_sub(keep + 1);
        if excess == 0 {
            return;
        }
        self.trace.remove(excess, &self.widths);
        self.trace.rows_suffice = false;
        self.trace.removed = None;
        self.dropped += excess;
    }

    /// Returns the number of rows recorded so far, including those that were dropped.
    pub(super) fn rows_recorded(&self) -> usize {
        self.trace.rows() + self.dropped
    }

    /// Removes the rows recorded after the first `recorded` rows; `recorded` is a value that
    /// [`Recorder::rows_recorded`] returned.
    pub(super) fn truncate_to(&mut self, recorded: usize) {
        self.truncate(recorded.saturating_sub(self.dropped));
    }

    /// Removes all rows except the first `rows`.
    pub(super) fn truncate(&mut self, rows: usize) {
        for ((_, column), width) in self.trace.columns_mut().zip(&self.widths) {
            column.truncate(rows * width);
        }
    }

    /// Completes the last row with the acceleration `a`, `(nv,)`, m/s² and rad/s².
    pub(super) fn record_acceleration<S: Scalar>(&mut self, model: &Model, a: &[S]) {
        push(&mut self.trace.acceleration, a);
        if let Some(shift) = &self.shift {
            shift.transform_acceleration(&mut self.trace, model);
        }
    }
}

/// Returns the desired pose in W, with zero velocity, from a sample that is relative to the base.
#[inline(always)]
fn relative_to_base<S: Scalar>(q: &[S], relative: &TaskSample<S>) -> TaskSample<S> {
    let rot_wb = base_rotation(q);
    TaskSample::at_rest(rot_wb * relative.rot_wd, rot_wb * relative.pos_w + Vec3::from_slice(q))
}

#[inline(always)]
fn push_tracking<S: Scalar>(trace: &mut Trace, desired: &TaskSample<S>, pose: &FramePose<S>) {
    let error = task_error(&pose.rot_wf, pose.pos_w, desired);
    push_pose(&mut trace.reference_pose, &desired.rot_wd, desired.pos_w);
    push_vector(&mut trace.position_error, error.linear);
    push_vector(&mut trace.attitude_error, error.angular);
}

fn push<S: Scalar>(column: &mut Vec<f64>, values: &[S]) {
    column.extend(values.iter().map(|x| x.value()));
}

fn push_vector<S: Scalar>(column: &mut Vec<f64>, v: Vec3<S>) {
    column.extend([v.x.value(), v.y.value(), v.z.value()]);
}

fn push_pose<S: Scalar>(column: &mut Vec<f64>, r: &Mat3<S>, p: Vec3<S>) {
    push(column, &pose_rows(r, p));
}
