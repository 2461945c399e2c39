//! Writing rows of the trace.

use super::error::SimulationError;
use super::plant::Plant;
use super::state::State;
use super::surroundings::Surroundings;
use super::trace::{Trace, Tracking};
use crate::control::{Control, Stack, task_error};
use crate::dynamics::{FramePose, base_rotation, center_of_mass, frame_pose, kinetic_energy, momentum};
use crate::orbit::OrbitState;
use crate::reference::TaskSample;
use crate::spatial::{Mat3, Scalar, Vec3, pose_rows};

/// Fills a trace, row by row, without allocating.
pub(super) struct Recorder {
    pub(super) trace: Trace,
    tool: Option<usize>,
    has_reference: bool,
}

impl Recorder {
    pub(super) fn new(
        rows: usize,
        sizes: (usize, usize),
        tool: Option<usize>,
        has_reference: bool,
        has_orbit: bool,
        has_every_step: bool,
        controls: &[Control],
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
        reserve(|t| &mut t.center_of_mass, 3)?;
        if tool.is_some() {
            reserve(|t| &mut t.tool_pose, 16)?;
        }
        if has_reference {
            reserve(|t| &mut t.reference_pose, 16)?;
            reserve(|t| &mut t.position_error, 3)?;
            reserve(|t| &mut t.attitude_error, 3)?;
        }
        if has_orbit {
            reserve(|t| &mut t.position_eci, 3)?;
            reserve(|t| &mut t.velocity_eci, 3)?;
        }
        for control in controls.iter().filter(|control| control.width() > 0) {
            let (name, width, mut error) = (control.name.clone(), control.width(), Vec::new());
            let numbers = rows.checked_mul(width).ok_or(SimulationError::TooManyRows { rows })?;
            error.try_reserve_exact(numbers).map_err(|_| SimulationError::TooManyRows { rows })?;
            trace.tracking.push(Tracking { name, width, error });
        }
        Ok(Self { trace, tool, has_reference })
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
            column.error.extend_from_slice(stack.error(control));
        }
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
        push(&mut trace.tau, &plant.command);
        let h = momentum(data, q);
        push_vector(&mut trace.momentum, h.linear);
        push_vector(&mut trace.momentum, h.angular);
        push_vector(&mut trace.impulse, state.impulse.linear);
        push_vector(&mut trace.impulse, state.impulse.angular);
        trace.kinetic_energy.push(kinetic_energy(plant.model, data, v).value());
        trace.work.push(state.work.value());
        push_vector(&mut trace.center_of_mass, center_of_mass(data, q));
        if let Some(tool) = self.tool {
            let pose = frame_pose(plant.model, data, q, tool);
            push_pose(&mut trace.tool_pose, &pose.rot_wf, pose.pos_w);
            if self.has_reference {
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

    /// Completes the last row.
    pub(super) fn accelerated<S: Scalar>(&mut self, a: &[S]) {
        push(&mut self.trace.acceleration, a);
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
