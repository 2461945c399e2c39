//! Evaluation of the active laws.

use super::{ControllerSet, active_loops, running};
use crate::control::control::Control;
use crate::control::control_law::{ControlLaw, EffortInput, EffortWork, JointCommand};
use crate::control::control_state::{ControlMemory, ControlState};
use crate::control::error::ControlError;
use crate::control::known_tree::KnownTree;
use crate::control::looped_dynamics::Looped;
use crate::control::observation::Observation;
use crate::control::pseudo_inverse::ROWS;
use crate::dynamics::{Data, FreeFloating, base_relative_frame, free_floating_frame};
use crate::model::{BASE_NQ, BASE_NV, Model};
use crate::reference::TaskReference;
use crate::spatial::{Motion, Scalar};

impl<S: Scalar> ControllerSet<'_, S> {
    /// Computes the torques of the laws that command efforts; `last` holds the torques of the previous
    /// update.
    pub(super) fn efforts(
        &mut self,
        t: f64,
        model: &Model,
        data: &Data<S>,
        (q, v): (&[S], &[S]),
        last: &[S],
    ) -> Result<(), ControlError> {
        let n = model.joint_count();
        for (control, state) in self.controls.iter_mut().zip(&mut self.states) {
            let law = control.law.control_law();
            if !state.is_running() || law.joint_command() != JointCommand::Effort {
                continue;
            }
            if self.is_repeated && control.law.external().is_none() {
                control.joints.iter().for_each(|&j| self.tau[j] = last[j].value());
                continue;
            }
            let [tau, rates, scratch] = &mut self.group;
            let (joints, k) = (&control.joints[..], control.joints.len());
            let (tau, rates) = (&mut tau[..k], &mut rates[..k]);
            rates.iter_mut().zip(joints).for_each(|(to, &j)| *to = self.v[BASE_NV + j]);
            let mut velocity_error = Motion::zero();
            if let Some((frame, reference)) = control.law.task().filter(|_| law.needs_jacobian()) {
                reduce_to_frame(
                    (model, data, q, v),
                    self.known.as_deref_mut(),
                    (frame, reference),
                    &mut self.reduced,
                );
                let own = (&mut self.known, &mut self.looped);
                let jacobian = (&self.reduced.jacobian[..], &mut self.jacobian[..]);
                driven_jacobian(own, reference.is_relative_to_base(), joints, n, jacobian);
                velocity_error = state.velocity_error(&self.reduced);
            }
            let desired = state.desired_pose;
            let input = EffortInput {
                control: &control.name,
                observation: Observation { time: t, q: &self.q, v: &self.v, model, joints, desired },
                elapsed: state.memory.last_tick.map_or(0.0, |last| t - last),
                desired: &state.desired,
                error: (&state.error, velocity_error),
                jacobian: &self.jacobian[..ROWS * k],
                rates,
                fingers: (&state.fingers, &state.finger_forces),
            };
            let ControlMemory { pid, grip, .. } = &mut state.memory;
            let work = EffortWork { pid, grip: grip.as_mut(), inverse: &mut self.inverse, scratch };
            control.law.control_law_mut().efforts(&input, work, tau)?;
            joints.iter().zip(tau).for_each(|(&j, tau)| self.tau[j] = *tau);
        }
        Ok(())
    }

    /// Computes the torques of the laws that command accelerations of joints or frames, and the desired
    /// accelerations of the joints with friction compensation.
    pub(super) fn accelerations(&mut self, model: &Model, data: &Data<S>, q: &[S], v: &[S]) {
        self.set_up_dynamics(model, q);
        self.solve_dynamics(model, data, q, v);
        while self.release_joint(model) {
            self.solve_dynamics(model, data, q, v);
        }
        for (control, _) in running(self.controls, &self.states) {
            let law = control.law.control_law();
            if has_compensation(law) {
                for (place, &j) in control.joints.iter().enumerate() {
                    let acceleration = self.dynamics.acceleration[j];
                    self.desired_accelerations[j] = Some(law.desired_acceleration(place, acceleration));
                }
            }
        }
    }

    /// Sets the inertia, the loads and the given accelerations of the reduced model, and the command of each
    /// joint.
    fn set_up_dynamics(&mut self, model: &Model, q: &[S]) {
        let Self { dynamics, reduced, known, looped, .. } = self;
        if let Some(looped) = active_loops(known, looped) {
            looped.clear_forces();
            let forces =
                running(self.controls, &self.states).flat_map(|(control, _)| &control.internal_forces);
            forces.for_each(|force| looped.add_force(force));
            dynamics.load.fill(0.0); // `eliminate` adds the loads of the model
        } else {
            for (to, from) in dynamics.inertia.iter_mut().zip(&reduced.inertia) {
                *to = from.value();
            }
            for (j, load) in dynamics.load.iter_mut().enumerate() {
                *load = (reduced.bias[j] - reduced.external[j]).value();
            }
        }
        for (j, spring) in model.springs() {
            dynamics.load[j] -= spring.torque(q[BASE_NQ + j].value());
        }
        let mut compensates_friction = false;
        for (control, state) in running(self.controls, &self.states) {
            let law = control.law.control_law();
            let (command, damping) = (law.joint_command(), law.task_damping());
            let is_compensated = has_compensation(law);
            compensates_friction |= is_compensated;
            for (place, &j) in control.joints.iter().enumerate() {
                let rate = self.v[BASE_NV + j];
                self.commands[j] = command;
                dynamics.load[j] += if is_compensated { rate * model.joints()[j].damping } else { 0.0 };
                match command {
                    JointCommand::Acceleration => {
                        let error = state.error[place];
                        dynamics.acceleration[j] = law.joint_acceleration(place, error, rate, &state.desired);
                        if let Some(effort) = law.feedforward(place) {
                            dynamics.load[j] += effort;
                        }
                    }
                    JointCommand::Task => dynamics.null_damping[j] = [damping.null_space, damping.suppressed],
                    JointCommand::Effort | JointCommand::Held => {}
                }
            }
        }
        if compensates_friction {
            self.assume_friction(model);
        }
    }

    /// Computes the accelerations of all joints, and the torques of the joints with commanded accelerations
    /// or tasks.
    fn solve_dynamics(&mut self, model: &Model, data: &Data<S>, q: &[S], v: &[S]) {
        if active_loops(&mut self.known, &mut self.looped).is_some() {
            self.solve_with_loops(model, data, q, v);
            return;
        }
        let Self { dynamics, reduced, tau, known, .. } = self;
        dynamics.eliminate(&self.commands, tau);
        for (law, state, task) in tasks(self.controls, &self.states) {
            reduce_to_frame((model, data, q, v), known.as_deref_mut(), task, reduced);
            let rows = state.task_acceleration(law, reduced, motion(reduced.drift));
            self.jacobian.iter_mut().zip(&reduced.jacobian).for_each(|(to, from)| *to = from.value());
            dynamics.add_task(&self.jacobian, rows, law.task_damping().pseudo_inverse);
        }
        dynamics.solve(&self.v[BASE_NV..], tau);
    }

    /// Computes the same as [`ControllerSet::solve_dynamics`] for a robot with closed loops.
    fn solve_with_loops(&mut self, model: &Model, data: &Data<S>, q: &[S], v: &[S]) {
        let Self { dynamics, reduced, tau, known, looped, .. } = self;
        if let Some(looped) = active_loops(known, looped) {
            looped.eliminate(dynamics, &self.commands, tau);
        }
        for (law, state, task) in tasks(self.controls, &self.states) {
            reduce_to_frame((model, data, q, v), known.as_deref_mut(), task, reduced);
            self.jacobian.iter_mut().zip(&reduced.jacobian).for_each(|(to, from)| *to = from.value());
            let damping = law.task_damping().pseudo_inverse;
            match known.as_deref_mut().filter(|_| !task.1.is_relative_to_base()) {
                Some(known) => {
                    let rows = state.task_acceleration(law, reduced, known.drift());
                    known.add_task(rows, damping);
                }
                None => {
                    let rows = state.task_acceleration(law, reduced, motion(reduced.drift));
                    if let Some(looped) = active_loops(known, looped) {
                        looped.add_task(&self.jacobian, rows, damping);
                    }
                }
            }
        }
        let (rates, looped) = match known.as_deref_mut() {
            Some(KnownTree { v, looped, .. }) => (&v[..], looped.as_mut().map(|looped| &mut looped.dynamics)),
            None => (&self.v[..], looped.as_mut().map(|looped| &mut looped.dynamics)),
        };
        if let Some(looped) = looped {
            looped.solve(&rates[BASE_NV..], &mut dynamics.acceleration, tau);
        }
    }
}

impl ControlState {
    /// Returns the task acceleration `p̈r − d` of a frame with the drift `d`, m/s² and rad/s².
    fn task_acceleration<S: Scalar>(
        &self,
        law: &dyn ControlLaw,
        reduced: &FreeFloating<S>,
        drift: Motion<f64>,
    ) -> [f64; ROWS] {
        let acceleration = self.desired_pose.map_or(Motion::zero(), |desired| desired.acceleration);
        let (error, velocity_error) = (Motion::from_slice(&self.error), self.velocity_error(reduced));
        let task_acceleration = law.task_acceleration(error, velocity_error, acceleration) - drift;
        let mut rows = [0.0; ROWS];
        task_acceleration.write(&mut rows);
        rows
    }

    /// Returns the velocity error, desired less actual, m/s and rad/s, of the frame to which the reduced
    /// model belongs.
    fn velocity_error<S: Scalar>(&self, reduced: &FreeFloating<S>) -> Motion<f64> {
        let desired = self.desired_pose.map_or(Motion::zero(), |desired| desired.velocity);
        desired - motion(reduced.velocity)
    }
}

/// Returns the laws of the active controls that command accelerations of a frame, each with the state of its
/// control, the index of the frame and its reference.
fn tasks<'c>(
    controls: &'c [Control],
    states: &'c [ControlState],
) -> impl Iterator<Item = (&'c dyn ControlLaw, &'c ControlState, (usize, &'c TaskReference))> {
    running(controls, states).filter_map(|(control, state)| {
        let (law, task) = (control.law.control_law(), control.law.task()?);
        (law.joint_command() == JointCommand::Task).then_some((law, state, task))
    })
}

/// Returns true if a law compensates damping and friction; laws that command efforts never do.
fn has_compensation(law: &dyn ControlLaw) -> bool {
    law.compensates_friction() && law.joint_command() != JointCommand::Effort
}

/// Computes the Jacobian, velocity and drift of a frame, relative to the base if its reference is, otherwise
/// in W.
fn reduce_to_frame<S: Scalar>(
    (model, data, q, v): (&Model, &Data<S>, &[S], &[S]),
    known: Option<&mut KnownTree>,
    (frame, reference): (usize, &TaskReference),
    out: &mut FreeFloating<S>,
) {
    match known {
        _ if reference.is_relative_to_base() => base_relative_frame(model, data, v, frame, out),
        Some(known) => known.reduce_frame(frame, out),
        None => free_floating_frame(model, data, q, v, frame, out),
    }
}

/// Computes the Jacobian, row major `(6, k)`, of the frame of the last [`reduce_to_frame`] with respect to
/// the `k` joints in `joints`, and writes it to `out`. `all` is the Jacobian, `(6, n)`, with respect to all
/// joints of the robot. If the robot has closed loops, the motion of the joints without a motor is included.
fn driven_jacobian<S: Scalar>(
    (known, looped): (&mut Option<Box<KnownTree>>, &mut Option<Box<Looped<S>>>),
    is_relative: bool,
    joints: &[usize],
    n: usize,
    (all, out): (&[S], &mut [f64]),
) {
    let k = joints.len();
    if let Some(known) = known.as_deref_mut().filter(|known| known.looped.is_some() && !is_relative) {
        known.driven_jacobian(joints, &mut out[..ROWS * k]);
    } else if let Some(looped) = active_loops(known, looped) {
        looped.driven_jacobian(all, joints, &mut out[..ROWS * k]);
    } else {
        for (i, row) in all.chunks_exact(n).enumerate() {
            let group = out[i * k..].iter_mut().zip(joints);
            group.for_each(|(to, &j)| *to = row[j].value());
        }
    }
}

fn motion<S: Scalar>(m: Motion<S>) -> Motion<f64> {
    Motion::new(m.linear.map(|x| x.value()), m.angular.map(|x| x.value()))
}
