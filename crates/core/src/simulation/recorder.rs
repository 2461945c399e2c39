//! Writing rows of the trace.

use super::checkpoint::CheckpointError;
use super::driver::at;
use super::error::SimulationError;
use super::plant::Plant;
use super::state::State;
use super::surroundings::Surroundings;
use super::trace::Trace;
use crate::control::task_error;
use crate::dynamics::{FramePose, base_rotation, center_of_mass, frame_pose, kinetic_energy, momentum};
use crate::environment::{DifferentialGravity, Reference, ReferenceMotion};
use crate::orbit::{Orbit, OrbitState};
use crate::reference::{TaskReference, TaskSample};
use crate::spatial::{Mat3, Scalar, Vec3, pose_rows};

/// Fills a trace, row by row, without allocating.
pub(super) struct Recorder<'a> {
    pub(super) trace: Trace,
    tool: Option<usize>,
    reference: Option<&'a TaskReference>,
    /// Parameter of the planet along whose gravity the robot is carried.
    carried_around: Option<f64>,
}

impl<'a> Recorder<'a> {
    pub(super) fn new(
        rows: usize,
        sizes: (usize, usize),
        tool: Option<usize>,
        reference: Option<&'a TaskReference>,
        orbit: Option<&dyn Orbit>,
        motion: ReferenceMotion,
        has_every_step: bool,
    ) -> Result<Self, SimulationError> {
        let (nq, nv) = sizes;
        let mut trace = Trace { has_every_step, ..Trace::default() };
        let mut reserve = |column: fn(&mut Trace) -> &mut Vec<f64>, width: usize| {
            let numbers = rows.checked_mul(width).ok_or(SimulationError::TooManyRows { rows })?;
            column(&mut trace).try_reserve_exact(numbers).map_err(|_| SimulationError::TooManyRows { rows })
        };
        reserve(|t| &mut t.time, 1)?;
        reserve(|t| &mut t.q, nq)?;
        reserve(|t| &mut t.v, nv)?;
        reserve(|t| &mut t.tau, nv - 6)?;
        reserve(|t| &mut t.acceleration, nv)?;
        reserve(|t| &mut t.momentum, 6)?;
        reserve(|t| &mut t.impulse, 6)?;
        reserve(|t| &mut t.kinetic_energy, 1)?;
        reserve(|t| &mut t.work, 1)?;
        reserve(|t| &mut t.dissipated, 1)?;
        reserve(|t| &mut t.center_of_mass, 3)?;
        if tool.is_some() {
            reserve(|t| &mut t.tool_pose, 16)?;
        }
        if reference.is_some() {
            reserve(|t| &mut t.reference_pose, 16)?;
            reserve(|t| &mut t.position_error, 3)?;
            reserve(|t| &mut t.attitude_error, 3)?;
        }
        let carried_around = orbit.and_then(|o| o.mu()).filter(|_| motion == ReferenceMotion::Carried);
        if carried_around.is_some() {
            reserve(|t| &mut t.reference_residual, 3)?;
        }
        if orbit.is_some() {
            reserve(|t| &mut t.position_eci, 3)?;
            reserve(|t| &mut t.velocity_eci, 3)?;
        }
        Ok(Self { trace, tool, reference, carried_around })
    }

    /// Goes on after the rows of an earlier part of the run.
    pub(super) fn go_on_from(&mut self, mut rows: Trace) -> Result<(), CheckpointError> {
        let count = rows.rows();
        for ((name, to), (_, from)) in self.trace.columns_mut().zip(rows.columns_mut()) {
            let is_kept = to.capacity() > 0;
            if is_kept == from.is_empty() || from.len().checked_rem(count).is_some_and(|rest| rest > 0) {
                return Err(CheckpointError::OtherSize { name, got: from.len(), expected: count });
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
    ) -> Result<(), SimulationError> {
        let desired = self.reference.map(|reference| at(reference, t)).transpose()?;
        S::enter(
            #[inline(always)]
            || self.row_kernel(t, state, plant, orbit, desired),
        );
        Ok(())
    }

    #[inline(always)]
    fn row_kernel<S: Scalar>(
        &mut self,
        t: f64,
        state: &State<S>,
        plant: &Plant<'_, S, Surroundings>,
        orbit: Option<OrbitState>,
        desired: Option<TaskSample<f64>>,
    ) {
        let (trace, data, q, v) = (&mut self.trace, &plant.data, &state.q, &state.v);
        trace.time.push(t);
        push(&mut trace.q, q);
        push(&mut trace.v, v);
        push(&mut trace.tau, &plant.command);
        let h = momentum(data, q);
        push_vector(&mut trace.momentum, h.linear);
        push_vector(&mut trace.momentum, h.angular);
        push_vector(&mut trace.impulse, state.impulse.linear);
        push_vector(&mut trace.impulse, state.impulse.angular);
        trace.kinetic_energy.push(kinetic_energy(plant.model, data, v).value());
        trace.work.push(state.work.value());
        trace.dissipated.push(state.dissipated.value());
        push_vector(&mut trace.center_of_mass, center_of_mass(data, q));
        if let Some(tool) = self.tool {
            let pose = frame_pose(plant.model, data, q, tool);
            push_pose(&mut trace.tool_pose, &pose.rot_wf, pose.pos_w);
            if let Some(desired) = desired {
                push_tracking(trace, &desired.lift(), &pose);
            }
        }
        if let Some(orbit) = orbit {
            let origin = orbit.position + Vec3::from_slice(q).to_nalgebra();
            let velocity = orbit.velocity + (base_rotation(q) * Vec3::from_slice(v)).to_nalgebra();
            trace.position_eci.extend_from_slice(origin.as_slice());
            trace.velocity_eci.extend_from_slice(velocity.as_slice());
            let reference = Reference { state: orbit, mu: self.carried_around };
            if let Some(residual) = DifferentialGravity::residual(&reference) {
                trace.reference_residual.extend_from_slice(residual.as_slice());
            }
        }
    }

    /// Completes the last row.
    pub(super) fn accelerated<S: Scalar>(&mut self, a: &[S]) {
        push(&mut self.trace.acceleration, a);
    }
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
