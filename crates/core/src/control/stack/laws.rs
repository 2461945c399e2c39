//! What the running laws want of the joints.

use super::Stack;
use super::look::value;
use crate::control::controller::Observation;
use crate::control::error::ControlError;
use crate::control::group::Law;
use crate::control::progress::{Phase, Progress};
use crate::control::pseudo_inverse::ROWS;
use crate::dynamics::{Data, FreeFloating, base_relative_frame, free_floating_frame};
use crate::model::Model;
use crate::spatial::{Motion, Scalar};

impl<S: Scalar> Stack<'_, S> {
    /// Efforts of the laws that give them.
    pub(super) fn efforts(
        &mut self,
        t: f64,
        model: &Model,
        data: &Data<S>,
        q: &[S],
        v: &[S],
    ) -> Result<(), ControlError> {
        let n = model.joint_count();
        for (control, progress) in self.controls.iter_mut().zip(&mut self.progress) {
            if progress.phase != Phase::Running {
                continue;
            }
            let [tau, rates] = &mut self.group;
            let (joints, k) = (&control.joints, control.joints.len());
            let (tau, rates) = (&mut tau[..k], &mut rates[..k]);
            rates.iter_mut().zip(joints).for_each(|(to, &j)| *to = self.v[j + 6]);
            match &mut control.law {
                Law::TaskComputedTorque(..) | Law::JointComputedTorque(..) => continue,
                Law::Pid(law, _) => {
                    let dt = if progress.last.is_nan() { 0.0 } else { t - progress.last };
                    for (place, tau) in tau.iter_mut().enumerate() {
                        let now = (self.q[joints[place] + 7], rates[place]);
                        *tau = law.effort(place, now, &progress.desired, dt, &mut progress.pid);
                    }
                }
                Law::Compliance(law, reference) => {
                    let is_relative = reference.is_relative_to_base();
                    look_at(model, data, q, v, law.frame, is_relative, &mut self.reduced);
                    for (i, row) in self.reduced.jacobian.chunks_exact(n).enumerate() {
                        joints
                            .iter()
                            .enumerate()
                            .for_each(|(c, &j)| self.jacobian[i * k + c] = row[j].value());
                    }
                    let lag = progress.lag(&self.reduced);
                    let error = Motion::from_slice(&progress.error);
                    law.torques(&self.jacobian[..6 * k], (error, lag), rates, &mut self.compliance, tau);
                }
                Law::User(controller, _) => {
                    let desired = progress.desired_pose;
                    let now = Observation { time: t, q: &self.q, v: &self.v, model, joints, desired };
                    controller.update(&now, tau)?;
                    if let Some(place) = tau.iter().position(|tau| !tau.is_finite()) {
                        let (control, joint) =
                            (control.name.clone(), model.joints()[joints[place]].name.clone());
                        return Err(ControlError::UserTorque { control, joint, time: t, value: tau[place] });
                    }
                }
            }
            joints.iter().zip(tau).for_each(|(&j, tau)| self.tau[j] = *tau);
        }
        Ok(())
    }

    /// Torques of the laws that want accelerations.
    pub(super) fn accelerations(&mut self, model: &Model, data: &Data<S>, q: &[S], v: &[S]) {
        self.set_up(model);
        self.solve(model, data, q, v);
        while self.lets_go(model) {
            self.solve(model, data, q, v);
        }
        let running = self.controls.iter().zip(&self.progress).filter(|(_, p)| p.phase == Phase::Running);
        for (control, _) in running.filter(|(control, _)| control.compensates_friction()) {
            for (place, &j) in control.joints.iter().enumerate() {
                self.asked[j] = Some(control.asks(place, self.side_by_side.acceleration[j]));
            }
        }
    }

    /// The reduced model, and how each joint is driven.
    fn set_up(&mut self, model: &Model) {
        let Self { side_by_side: room, reduced, .. } = self;
        for (to, from) in room.inertia.iter_mut().zip(&reduced.inertia) {
            *to = from.value();
        }
        for (j, load) in room.load.iter_mut().enumerate() {
            *load = (reduced.bias[j] - reduced.external[j]).value();
        }
        let running = self.controls.iter().zip(&self.progress).filter(|(_, p)| p.phase == Phase::Running);
        let mut knows_friction = false;
        for (control, progress) in running {
            knows_friction |= control.compensates_friction();
            for (place, &j) in control.joints.iter().enumerate() {
                let rate = self.v[j + 6];
                self.drives[j] = control.drive();
                let is_known = control.compensates_friction();
                room.load[j] += if is_known { rate * model.joints()[j].damping } else { 0.0 };
                match &control.law {
                    Law::JointComputedTorque(law, _) => {
                        let error = progress.error[place];
                        room.acceleration[j] = law.command(place, error, rate, &progress.desired);
                    }
                    Law::TaskComputedTorque(law, _) => {
                        room.calming[j] = [law.null_space_damping, law.brake()];
                    }
                    _ => {}
                }
            }
        }
        if knows_friction {
            self.expect_friction(model);
        }
    }

    /// Accelerations of all joints, and the torques of those that want them.
    fn solve(&mut self, model: &Model, data: &Data<S>, q: &[S], v: &[S]) {
        let Self { side_by_side: room, reduced, tau, .. } = self;
        let running = self.controls.iter().zip(&self.progress).filter(|(_, p)| p.phase == Phase::Running);
        room.eliminate(&self.drives, tau);
        for (control, progress) in running {
            let Law::TaskComputedTorque(law, reference) = &control.law else { continue };
            look_at(model, data, q, v, law.frame, reference.is_relative_to_base(), reduced);
            // p̈r − d
            let acceleration = progress.desired_pose.map_or(Motion::zero(), |desired| desired.acceleration);
            let (error, lag) = (Motion::from_slice(&progress.error), progress.lag(reduced));
            let mut command = [0.0; ROWS];
            (law.command(error, lag, acceleration) - motion(reduced.drift)).write(&mut command);
            self.jacobian.iter_mut().zip(&reduced.jacobian).for_each(|(to, from)| *to = from.value());
            room.add_task(&self.jacobian, command, law.damping);
        }
        room.solve(&self.v[6..], tau);
    }
}

impl Progress {
    /// Desired less actual velocity of the tool.
    fn lag<S: Scalar>(&self, reduced: &FreeFloating<S>) -> Motion<f64> {
        let desired = self.desired_pose.map_or(Motion::zero(), |desired| desired.velocity);
        desired - motion(reduced.velocity)
    }
}

/// Jacobian and drift of a frame, in W or as the base sees it.
fn look_at<S: Scalar>(
    model: &Model,
    data: &Data<S>,
    q: &[S],
    v: &[S],
    frame: usize,
    is_relative: bool,
    out: &mut FreeFloating<S>,
) {
    if is_relative {
        base_relative_frame(model, data, v, frame, out);
    } else {
        free_floating_frame(model, data, q, v, frame, out);
    }
}

fn motion<S: Scalar>(m: Motion<S>) -> Motion<f64> {
    Motion::new(value(m.linear), value(m.angular))
}
