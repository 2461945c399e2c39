//! Writing rows of the trace.

use super::checkpoint::CheckpointError;
use super::error::SimulationError;
use super::plant::Plant;
use super::rereference::Shift;
use super::state::State;
use super::surroundings::Surroundings;
use super::trace::{NamedColumn, Trace};
use crate::control::{Control, Stack, task_error};
use crate::dynamics::{FramePose, base_rotation, frame_pose, motion_of_whole};
use crate::model::Model;
use crate::orbit::OrbitState;
use crate::reference::TaskSample;
use crate::spatial::{Mat3, Scalar, Vec3, pose_rows};
use nalgebra::Vector3;
use std::borrow::Cow;

/// What a run has to record beside its state.
#[derive(Clone)]
pub(super) struct Extras {
    /// Index of the frame to record.
    pub(super) tool: Option<usize>,
    /// Whether something leads it.
    pub(super) has_reference: bool,
    /// Names of the effects whose wrenches are recorded.
    pub(super) effects: Vec<String>,
    /// Whether there is an orbit.
    pub(super) has_orbit: bool,
    /// Whether drives compensate Coulomb friction.
    pub(super) compensates_friction: bool,
    /// Whether the reference carries the robot along, through a field that it may not obey.
    pub(super) is_carried: bool,
}

impl Extras {
    /// Nothing beside the state.
    pub(super) fn none() -> Self {
        Self {
            tool: None,
            has_reference: false,
            effects: Vec::new(),
            has_orbit: false,
            is_carried: false,
            compensates_friction: false,
        }
    }

    /// Numbers per row of a column; none where the run does not have it.
    fn width(&self, column: &str, model: &Model) -> usize {
        let given = |is_given: bool, width: usize| if is_given { width } else { 0 };
        match column {
            "q" => model.nq(),
            "v" | "acceleration" => model.nv(),
            "tau" => model.joint_count(),
            "friction_compensation" => given(self.compensates_friction, model.joint_count()),
            "momentum" | "impulse" => 6,
            "center_of_mass" => 3,
            "tool_pose" => given(self.tool.is_some(), 16),
            "reference_pose" => given(self.has_reference, 16),
            "position_error" | "attitude_error" => given(self.has_reference, 3),
            "position_eci" | "velocity_eci" => given(self.has_orbit, 3),
            "reference_residual" => given(self.is_carried, 3),
            _ => 1,
        }
    }
}

/// Fills a trace, row by row, without allocating.
pub(super) struct Recorder {
    pub(super) trace: Trace,
    extras: Extras,
    /// What takes the last row to W, where it was integrated elsewhere.
    shift: Option<Shift>,
    /// Numbers per row of each column.
    widths: Vec<usize>,
}

impl Recorder {
    pub(super) fn new(
        rows: usize,
        model: &Model,
        extras: Extras,
        controls: &[Control],
        has_every_step: bool,
    ) -> Result<Self, SimulationError> {
        let tracked = controls.iter().filter(|control| control.width() > 0);
        let column = |name: &str, width| NamedColumn { name: name.to_owned(), width, values: Vec::new() };
        let tracking: Vec<_> = tracked.map(|control| column(&control.name, control.width())).collect();
        let wrenches: Vec<_> =
            extras.effects.iter().map(|name| column(name, 6 * model.nodes().len())).collect();
        let bare = Trace::default();
        let widths = bare.columns().map(|(name, _)| extras.width(&name, model));
        let widths: Vec<usize> =
            widths.chain(tracking.iter().chain(&wrenches).map(|column| column.width)).collect();
        let mut trace = Trace { has_every_step, tracking, wrenches, ..Trace::default() };
        for ((_, column), width) in trace.columns_mut().zip(&widths) {
            let numbers = rows.checked_mul(*width).ok_or(SimulationError::TooManyRows { rows })?;
            column.try_reserve_exact(numbers).map_err(|_| SimulationError::TooManyRows { rows })?;
        }
        Ok(Self { trace, extras, shift: None, widths })
    }

    /// Goes on after the rows of an earlier part of the run.
    pub(super) fn go_on_from(&mut self, mut rows: Trace) -> Result<(), CheckpointError> {
        let count = rows.rows();
        let names = |trace: &Trace| trace.columns().map(|(name, _)| name.into_owned()).collect::<Vec<_>>();
        let (own, given) = (names(&self.trace), names(&rows));
        if own != given {
            return Err(CheckpointError::OtherSize {
                name: "columns",
                got: given.len(),
                expected: own.len(),
            });
        }
        for (((name, from), (_, to)), width) in
            rows.columns_mut().zip(self.trace.columns_mut()).zip(&self.widths)
        {
            if from.len() != count * width {
                let name =
                    if let Cow::Borrowed(name) = name { name } else { "rows of a control or an effect" };
                let (got, expected) = (from.len(), count * width);
                return Err(CheckpointError::OtherSize { name, got, expected });
            }
            to.append(from);
        }
        Ok(())
    }

    /// Adds a row for a state whose kinematics are in the plant; the acceleration follows with
    /// [`Recorder::accelerated`].
    pub(super) fn row<S: Scalar>(
        &mut self,
        t: f64,
        state: &State<S>,
        plant: &Plant<'_, S, Surroundings>,
        orbit: Option<OrbitState>,
        desired: Option<(TaskSample<f64>, bool)>,
    ) {
        S::enter(
            #[inline(always)]
            || self.row_kernel(t, state, plant, orbit, desired),
        );
    }

    /// Adds the tracking errors of several controls to the row.
    pub(super) fn tracked<S: Scalar>(&mut self, stack: &Stack<'_, S>) {
        let tracked = (0..stack.controls().len()).filter(|&i| stack.controls()[i].width() > 0);
        for (column, control) in self.trace.tracking.iter_mut().zip(tracked) {
            column.values.extend_from_slice(stack.error(control));
        }
    }

    /// Adds the wrench of every effect on every body to the row, and puts the row in W.
    pub(super) fn felt<S: Scalar>(
        &mut self,
        plant: &mut Plant<'_, S, Surroundings>,
        t: f64,
    ) -> Result<(), SimulationError> {
        let (model, surroundings) = (plant.model, &mut plant.surroundings);
        self.shift = surroundings.shift(t, model.mass())?;
        let trace = &mut self.trace;
        if self.extras.is_carried {
            let residual = surroundings.residual(t)?;
            trace.reference_residual.extend(residual.iter().flat_map(|residual| residual.iter()));
        }
        if let Some(shift) = &self.shift {
            shift.row(trace, model);
        }
        let gravity = trace.wrenches.len().wrapping_sub(1); // the last of the effects
        for (effect, column) in trace.wrenches.iter_mut().enumerate() {
            let shift = self.shift.as_ref().filter(|_| effect == gravity);
            for (wrench, node) in surroundings.wrenches_of(effect, t)?.iter().zip(model.nodes()) {
                let force = wrench.force + shift.map_or_else(Vector3::zeros, |shift| shift.pull(node.mass));
                column.values.extend(force.iter().chain(wrench.torque.iter()));
            }
        }
        Ok(())
    }

    #[inline(always)]
    fn row_kernel<S: Scalar>(
        &mut self,
        t: f64,
        state: &State<S>,
        plant: &Plant<'_, S, Surroundings>,
        orbit: Option<OrbitState>,
        desired: Option<(TaskSample<f64>, bool)>,
    ) {
        let (trace, data, q, v) = (&mut self.trace, &plant.data, &state.q, &state.v);
        trace.time.push(t);
        push(&mut trace.q, q);
        push(&mut trace.v, v);
        let joints = 0..plant.model.joint_count();
        trace.tau.extend(joints.clone().map(|j| plant.torque(j).value()));
        if self.extras.compensates_friction {
            trace.friction_compensation.extend(joints.map(|j| plant.compensation(j)));
        }
        let (h, energy, com) = motion_of_whole(plant.model, data, q, v);
        push_vector(&mut trace.momentum, h.linear);
        push_vector(&mut trace.momentum, h.angular);
        push_vector(&mut trace.impulse, state.impulse.linear);
        push_vector(&mut trace.impulse, state.impulse.angular);
        trace.kinetic_energy.push(energy.value());
        trace.work.push(state.work.value());
        trace.dissipated.push(state.dissipated.value());
        push_vector(&mut trace.center_of_mass, com);
        if let Some(tool) = self.extras.tool {
            let pose = frame_pose(plant.model, data, q, tool);
            push_pose(&mut trace.tool_pose, &pose.rot_wf, pose.pos_w);
            if self.extras.has_reference {
                let desired = desired.map(|(desired, is_relative)| {
                    let desired = desired.lift();
                    if is_relative { carried_by_base(q, &desired) } else { desired }
                });
                // a tool that nothing leads for a while is where it should be
                let here = || TaskSample::at_rest(pose.rot_wf, pose.pos_w);
                push_tracking(trace, &desired.unwrap_or_else(here), &pose);
            }
        }
        if let Some(orbit) = orbit {
            let origin = orbit.position + Vec3::from_slice(q).to_nalgebra();
            let velocity = orbit.velocity + (base_rotation(q) * Vec3::from_slice(v)).to_nalgebra();
            trace.position_eci.extend_from_slice(origin.as_slice());
            trace.velocity_eci.extend_from_slice(velocity.as_slice());
        }
    }

    /// Takes a row back that is not complete.
    pub(super) fn drop_last(&mut self) {
        let rows = self.trace.rows().saturating_sub(1);
        for ((_, column), width) in self.trace.columns_mut().zip(&self.widths) {
            column.truncate(rows * width);
        }
    }

    /// Takes all rows back.
    pub(super) fn clear(&mut self) {
        self.trace.columns_mut().for_each(|(_, column)| column.clear());
    }

    /// Completes the last row.
    pub(super) fn accelerated<S: Scalar>(&mut self, model: &Model, a: &[S]) {
        push(&mut self.trace.acceleration, a);
        if let Some(shift) = &self.shift {
            shift.acceleration(&mut self.trace, model);
        }
    }
}

/// The pose of a sample relative to the base, in W.
#[inline(always)]
fn carried_by_base<S: Scalar>(q: &[S], relative: &TaskSample<S>) -> TaskSample<S> {
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
