//! Several controls of one robot in a run.

use super::check::{check_controls, check_disjoint};
use super::compliance::ComplianceRoom;
use super::computed_torque::friction;
use super::controller::{Controller, Observation};
use super::error::ControlError;
use super::goal::Outcome;
use super::group::{Begin, Control, Law};
use super::progress::{Phase, Progress};
use super::pseudo_inverse::ROWS;
use super::side_by_side::{Drive, SideBySide};
use crate::dynamics::{
    Data, FreeFloating, base_relative_frame, base_rotation, frame_pose, free_floating_frame,
    free_floating_recursion,
};
use crate::model::Model;
use crate::reference::TaskSample;
use crate::spatial::{Mat3, Motion, Scalar, Vec3};

/// Controls with all they need and remember between ticks, allocated once.
pub struct Stack<'a, S> {
    controls: &'a mut [Control],
    progress: Vec<Progress>,
    /// Two instants closer than this, s, are the same.
    same_instant: f64,
    reduced: FreeFloating<S>,
    side_by_side: SideBySide,
    compliance: ComplianceRoom,
    drives: Vec<Drive>,
    q: Vec<f64>,
    v: Vec<f64>,
    tau: Vec<f64>,
    jacobian: Vec<f64>,
    group: [Vec<f64>; 2],
}

impl<'a, S: Scalar> Stack<'a, S> {
    /// Checks the controls, starts the users' controllers afresh, and makes room.
    ///
    /// # Errors
    /// As [`check_controls`], and what a user's controller raises.
    pub fn new(controls: &'a mut [Control], model: &Model, same_instant: f64) -> Result<Self, ControlError> {
        check_controls(controls, model)?;
        for control in controls.iter_mut() {
            if let Law::User(controller, _) = &mut control.law {
                controller.reset()?;
            }
        }
        let (n, tasks) = (model.joint_count(), controls.len());
        let zeros = |count: usize| vec![0.0; count];
        Ok(Self {
            progress: controls.iter().map(Progress::new).collect(),
            controls,
            same_instant,
            reduced: FreeFloating::new(model),
            side_by_side: SideBySide::new(n, tasks),
            compliance: ComplianceRoom::new(n),
            drives: vec![Drive::Effort; n],
            q: zeros(model.nq()),
            v: zeros(model.nv()),
            tau: zeros(n),
            jacobian: zeros(ROWS * n),
            group: [zeros(n), zeros(n)],
        })
    }

    /// Whether a law wants the external wrenches in the data when it is asked.
    pub fn compensates_environment(&self) -> bool {
        self.controls.iter().any(|control| control.compensates_environment() == Some(true))
    }

    /// The controls.
    pub fn controls(&self) -> &[Control] {
        self.controls
    }

    /// Where its tool should be at the last instant looked at, in W or relative to the base as its reference
    /// is; `None` while the control does not run.
    pub fn desired(&self, control: usize) -> Option<TaskSample<f64>> {
        let progress = &self.progress[control];
        (progress.phase == Phase::Running).then_some(progress.desired_pose).flatten()
    }

    /// Desired less actual of a control at the last instant looked at, `(width,)`; zeros while it does not run.
    pub fn error(&self, control: usize) -> &[f64] {
        &self.progress[control].error
    }

    /// What came of the control's goal so far.
    pub fn outcome(&self, control: usize) -> Outcome {
        self.progress[control].outcome
    }

    /// Everything the controls remember, as numbers; users' controllers save themselves.
    pub fn save(&self, out: &mut Vec<f64>) {
        self.progress.iter().for_each(|progress| progress.save(out));
    }

    /// Takes up what [`Stack::save`] wrote.
    ///
    /// # Errors
    /// [`ControlError::WrongSave`] for another number of numbers.
    pub fn load(&mut self, mut from: &[f64]) -> Result<(), ControlError> {
        self.progress.iter_mut().try_for_each(|progress| progress.load(&mut from))?;
        match from.len() {
            0 => Ok(()),
            got => Err(ControlError::WrongSave { what: "many", got }),
        }
    }

    /// The users' controllers, which save and load what they remember themselves.
    pub fn user_controllers(&mut self) -> impl Iterator<Item = &mut dyn Controller> {
        self.controls.iter_mut().filter_map(|control| match &mut control.law {
            Law::User(controller, _) => Some(&mut **controller as &mut dyn Controller),
            _ => None,
        })
    }

    /// Looks at the state at `t`: what every running control should follow, and how far it is from it.
    /// Needs [`kinematics`](crate::dynamics::kinematics).
    ///
    /// # Errors
    /// [`ControlError::Reference`].
    pub fn look(
        &mut self,
        t: f64,
        model: &Model,
        data: &Data<S>,
        q: &[S],
        v: &[S],
    ) -> Result<(), ControlError> {
        self.q.iter_mut().zip(q).for_each(|(to, from)| *to = from.value());
        self.v.iter_mut().zip(v).for_each(|(to, from)| *to = from.value());
        let base = (Vec3::from_slice(&self.q), base_rotation(&self.q));
        for (control, progress) in self.controls.iter().zip(&mut self.progress) {
            if progress.phase == Phase::Over {
                progress.error.fill(0.0);
                continue;
            }
            if let Some((frame, reference)) = control.task() {
                let pose = frame_pose(model, data, q, frame);
                let (rot, pos) = (values(&pose.rot_wf), value(pose.pos_w));
                progress.pose = if reference.is_relative_to_base() {
                    (base.1.transpose() * rot, base.1.transpose_mul(pos - base.0))
                } else {
                    (rot, pos)
                };
            }
            if progress.phase == Phase::Running {
                let looked = progress.look(control, t, &self.q[7..], &self.v[6..]);
                looked.map_err(|source| ControlError::Reference { time: t, source })?;
            }
        }
        Ok(())
    }

    /// Torques, `(n,)`, N m, at `t`; joints that no control drives get none.
    ///
    /// Needs [`kinematics`](crate::dynamics::kinematics) at `q`, `v`, and in `data` the external
    /// wrenches to compensate.
    ///
    /// # Errors
    /// [`ControlError`]: running controls with a joint in common, a reference that is not defined, what a
    /// user's controller raises or returns.
    pub fn update(
        &mut self,
        t: f64,
        model: &Model,
        data: &mut Data<S>,
        q: &[S],
        v: &[S],
        tau: &mut [S],
    ) -> Result<(), ControlError> {
        self.look(t, model, data, q, v)?;
        if self.advance(t, model)? {
            self.look(t, model, data, q, v)?;
        }
        self.tau.fill(0.0);
        self.drives.fill(Drive::Effort);
        let is_running = |control: &Control, law: fn(&Law) -> bool, p: &Progress| {
            p.phase == Phase::Running && law(&control.law)
        };
        let any = |law: fn(&Law) -> bool| {
            self.controls.iter().zip(&self.progress).any(|(control, p)| is_running(control, law, p))
        };
        let has_accelerations =
            any(|law| matches!(law, Law::TaskComputedTorque(..) | Law::JointComputedTorque(..)));
        if has_accelerations || any(|law| matches!(law, Law::Compliance(..))) {
            free_floating_recursion(model, data, q, v, 0, &mut self.reduced);
        }
        self.efforts(t, model, data, q, v)?;
        if has_accelerations {
            self.accelerations(model, data, q, v);
        }
        for progress in &mut self.progress {
            if progress.phase == Phase::Running {
                progress.last = t;
            }
        }
        tau.iter_mut().zip(&self.tau).for_each(|(to, from)| *to = S::of(*from));
        Ok(())
    }

    /// Stops, judges and starts what is due at `t`; whether anything changed.
    fn advance(&mut self, t: f64, model: &Model) -> Result<bool, ControlError> {
        let Self { controls, progress, same_instant, .. } = self;
        let now = t + *same_instant;
        let mut has_changed = false;
        for (control, progress) in controls.iter().zip(progress.iter_mut()) {
            if progress.phase == Phase::Running
                && let Some(goal) = &control.goal
                && !progress.outcome.is_decided()
            {
                let (task, is_task) = progress.components();
                let errors = if is_task { &task[..] } else { &progress.error };
                progress.outcome = goal.judge(t, now - progress.start, control.duration(), errors);
                if progress.outcome.miss().is_some() {
                    progress.hold(control, &self.q[7..]);
                    has_changed = true;
                }
            }
            if progress.phase != Phase::Over && control.end <= now {
                progress.phase = Phase::Over;
                has_changed = true;
            }
        }
        for i in 0..controls.len() {
            let is_due = match controls[i].begin {
                Begin::At(start) => start <= now,
                Begin::After(before) => {
                    let before = &progress[before];
                    before.phase == Phase::Over || before.outcome.is_decided()
                }
            };
            if progress[i].phase == Phase::Waiting && is_due {
                if let Begin::After(before) = controls[i].begin {
                    progress[before].phase = Phase::Over;
                }
                let started = progress[i].start(&controls[i], t, &self.q[7..]);
                started.map_err(|source| ControlError::Reference { time: t, source })?;
                has_changed = true;
            }
        }
        if has_changed {
            let running = |i: &usize| progress[*i].phase == Phase::Running;
            for i in (0..controls.len()).filter(running) {
                for j in (0..i).filter(running) {
                    check_disjoint(&controls[j], &controls[i], model, t)?;
                }
            }
        }
        Ok(has_changed)
    }

    /// Efforts of the laws that give them.
    fn efforts(
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
    fn accelerations(&mut self, model: &Model, data: &Data<S>, q: &[S], v: &[S]) {
        let Self { side_by_side: room, reduced, tau, .. } = self;
        let running = self.controls.iter().zip(&self.progress).filter(|(_, p)| p.phase == Phase::Running);
        let knows_friction = running.clone().any(|(control, _)| control.compensates_friction());
        for (to, from) in room.inertia.iter_mut().zip(&reduced.inertia) {
            *to = from.value();
        }
        for (j, load) in room.load.iter_mut().enumerate() {
            *load = (reduced.bias[j] - reduced.external[j]).value();
        }
        let rub = |j: usize| friction(&model.joints()[j], self.v[j + 6]);
        for (control, progress) in running.clone() {
            for (place, &j) in control.joints.iter().enumerate() {
                self.drives[j] = control.drive();
                room.load[j] += if control.compensates_friction() { rub(j) } else { 0.0 };
                match &control.law {
                    Law::JointComputedTorque(law, _) => {
                        let (error, rate) = (progress.error[place], self.v[j + 6]);
                        room.acceleration[j] = law.command(place, error, rate, &progress.desired);
                    }
                    Law::TaskComputedTorque(law, _) => {
                        room.calming[j] = [law.null_space_damping, law.brake()];
                    }
                    _ => {}
                }
            }
        }
        for j in (0..self.drives.len()).filter(|&j| knows_friction && self.drives[j] == Drive::Effort) {
            room.load[j] += rub(j);
        }
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

fn value<S: Scalar>(v: Vec3<S>) -> Vec3<f64> {
    Vec3::new(v.x.value(), v.y.value(), v.z.value())
}

fn values<S: Scalar>(m: &Mat3<S>) -> Mat3<f64> {
    Mat3::from_columns(value(m.x), value(m.y), value(m.z))
}

fn motion<S: Scalar>(m: Motion<S>) -> Motion<f64> {
    Motion::new(value(m.linear), value(m.angular))
}
