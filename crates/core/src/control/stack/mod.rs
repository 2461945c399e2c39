//! Several controls of one robot in a run.

mod laws;
mod look;
mod sticking;
mod turns;

use crate::control::check::check_controls;
use crate::control::compliance::ComplianceRoom;
use crate::control::controller::Controller;
use crate::control::error::ControlError;
use crate::control::goal::Outcome;
use crate::control::group::{Control, Law};
use crate::control::progress::{Phase, Progress};
use crate::control::pseudo_inverse::ROWS;
use crate::control::side_by_side::{Drive, SideBySide};
use crate::dynamics::{Data, FreeFloating, free_floating_recursion};
use crate::model::Model;
use crate::reference::TaskSample;
use crate::spatial::Scalar;

/// Controls with all they need and remember between ticks, allocated once.
pub struct Stack<'a, S> {
    controls: &'a mut [Control],
    progress: Vec<Progress>,
    /// When `look` was asked last; at that state, `q` and `v`, the answers still hold.
    looked: f64,
    /// Two instants closer than this, s, are the same.
    same_instant: f64,
    reduced: FreeFloating<S>,
    side_by_side: SideBySide,
    compliance: ComplianceRoom,
    drives: Vec<Drive>,
    /// Acceleration asked for, rad/s² (m/s²), of the joints whose friction a law compensates.
    asked: Vec<Option<f64>>,
    /// Whether the plant's friction creeps through rest instead of sticking.
    friction_creeps: bool,
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
            looked: f64::NAN,
            same_instant,
            reduced: FreeFloating::new(model),
            side_by_side: SideBySide::new(n, tasks),
            compliance: ComplianceRoom::new(n),
            drives: vec![Drive::Effort; n],
            asked: vec![None; n],
            friction_creeps: false,
            q: zeros(model.nq()),
            v: zeros(model.nv()),
            tau: zeros(n),
            jacobian: zeros(ROWS * n),
            group: [zeros(n), zeros(n)],
        })
    }

    /// Expects friction as engines have it that do not let joints stick: it changes sign over a small range of rates.
    pub fn expect_creeping_friction(&mut self) {
        self.friction_creeps = true;
    }

    /// Whether a law wants the external wrenches in the data when it is asked.
    pub fn compensates_environment(&self) -> bool {
        self.controls.iter().any(|control| control.compensates_environment() == Some(true))
    }

    /// Accelerations that the last update asked for, rad/s² (m/s²), of the joints whose Coulomb friction a law
    /// compensates: their drives are to add it to the torques.
    pub fn asked(&self) -> &[Option<f64>] {
        &self.asked
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
        self.looked = f64::NAN;
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
        if self.take_turns(t, model)? {
            self.looked = f64::NAN; // others run now
            self.look(t, model, data, q, v)?;
        }
        self.tau.fill(0.0);
        self.drives.fill(Drive::Effort);
        self.asked.fill(None);
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
}
