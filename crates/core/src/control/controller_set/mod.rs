//! Evaluation of the list of controls of a run.

mod activation;
mod commands;
mod errors;
mod friction;
mod grips;
mod loads;
mod torques;

use crate::control::check::check_controls;
use crate::control::computed_torque::{ComputedTorque, ComputedTorqueWork, computed_torque};
use crate::control::control::{Begin, Control};
use crate::control::control_law::{ControlLaw, JointCommand};
use crate::control::control_state::{ControlMemory, ControlState};
use crate::control::error::ControlError;
use crate::control::finger_loops::FingerLoops;
use crate::control::goal::Outcome;
use crate::control::hybrid_dynamics::HybridDynamics;
use crate::control::known_tree::KnownTree;
use crate::control::law::Law;
use crate::control::looped_dynamics::{Looped, LoopedDynamics};
use crate::control::normal_force::NormalForce;
use crate::control::pseudo_inverse::{PseudoInverse, ROWS};
use crate::dynamics::{Data, FreeFloating, free_floating_recursion};
use crate::model::Model;
use crate::reference::{TaskReference, TaskSample};
use crate::spatial::Scalar;

/// List of the controls of a run, with their states and with workspaces that are allocated once.
pub struct ControllerSet<'a, S> {
    controls: &'a mut [Control],
    states: Vec<ControlState>,
    /// Time, s, at which desired motions and errors were last evaluated, at the state `q`, `v`; NaN if they
    /// are outdated.
    evaluated_at: f64,
    /// Difference, s, up to which two instants are treated as equal.
    same_instant: f64,
    /// True if a control needs `q` and `v`. A task law on all joints needs them only if its error is
    /// evaluated.
    reads_state: bool,
    /// Workspace of the fast path for a task law on all joints; `None` if no control can use this path.
    whole_robot: Option<Box<ComputedTorqueWork<S>>>,
    reduced: FreeFloating<S>,
    dynamics: HybridDynamics,
    /// Pseudo-inverse for one task, used by the laws that command efforts.
    inverse: PseudoInverse<f64>,
    commands: Vec<JointCommand>,
    /// Desired accelerations, `(n,)`, rad/s² (m/s²), of the joints whose friction a law compensates; `None`
    /// for the other joints.
    desired_accelerations: Vec<Option<f64>>,
    compensates_environment: bool,
    /// True if a joint has Coulomb friction.
    has_friction: bool,
    /// True if the engine has no static friction; the friction near rest is then proportional to the rate.
    friction_creeps: bool,
    q: Vec<f64>,
    v: Vec<f64>,
    tau: Vec<f64>,
    /// External torque commands, `(n,)`, N m (N), for joints without an active control; `None` without a
    /// command.
    commanded: Vec<Option<f64>>,
    jacobian: Vec<f64>,
    /// Indices of the events that have happened.
    events: Vec<usize>,
    /// Efforts of a group, N m (N), its rates, rad/s (m/s), and the workspace of its law.
    group: [Vec<f64>; 3],
    /// Tree of connected robots whose model the laws use; `None` if they use the model of the robot.
    known: Option<Box<KnownTree>>,
    /// Solver for the torques of a robot with closed loops; `None` if the robot has none.
    looped: Option<Box<Looped<S>>>,
    /// Motion of the joints that closed loops impose on the fingers of a grip-force law; `None` without
    /// closed loops or without such a law.
    finger_loops: Option<Box<FingerLoops<S>>>,
    /// Normal forces of the contacts on the robot; empty if no law uses them.
    normal_forces: Vec<NormalForce>,
    /// True if the next update repeats the previous one; see [`ControllerSet::set_repeated`].
    is_repeated: bool,
}

impl<'a, S: Scalar> ControllerSet<'a, S> {
    /// Checks the controls, resets their laws, and allocates the workspaces. Times that differ by at most
    /// `same_instant`, s, are treated as equal. `knows_others` must be true if [`ControllerSet::know`] will
    /// be called.
    ///
    /// # Errors
    /// The errors of [`check_controls`] and of user-defined controllers.
    pub fn new(
        controls: &'a mut [Control],
        model: &Model,
        same_instant: f64,
        knows_others: bool,
    ) -> Result<Self, ControlError> {
        check_controls(controls, model)?;
        for control in controls.iter_mut() {
            control.law.control_law_mut().reset()?;
        }
        let (n, tasks) = (model.joint_count(), controls.len());
        let zeros = |count: usize| vec![0.0; count];
        let is_tree = !knows_others && model.closures().is_empty();
        let is_whole = |control: &Control| is_tree && task_on_all_joints(control, n).is_some();
        let whole_robot = controls.iter().any(is_whole).then(|| Box::new(ComputedTorqueWork::new(model)));
        let needs_error = |control: &Control| control.law.control_law().uses_error() && !is_whole(control);
        let has_grip = controls.iter().any(|control| control.law.grip().is_some());
        let compensates =
            |control: &Control| control.law.control_law().compensates_environment() == Some(true);
        let state = |control: &Control| ControlState::new(control, model, needs_error(control));
        let states: Vec<_> = controls.iter().map(state).collect();
        let reads_state =
            |(control, state): (&Control, &ControlState)| state.needs_error || !is_whole(control);
        Ok(Self {
            reads_state: controls.iter().zip(&states).any(reads_state),
            has_friction: model.has_friction(),
            compensates_environment: controls.iter().any(compensates),
            states,
            controls,
            evaluated_at: f64::NAN,
            same_instant,
            whole_robot,
            reduced: FreeFloating::new(model),
            dynamics: HybridDynamics::new(n, tasks),
            inverse: PseudoInverse::new(1),
            commands: vec![JointCommand::Effort; n],
            desired_accelerations: vec![None; n],
            friction_creeps: false,
            q: zeros(model.nq()),
            v: zeros(model.nv()),
            tau: zeros(n),
            commanded: vec![None; n],
            jacobian: zeros(ROWS * n),
            events: Vec::new(),
            group: [zeros(n), zeros(n), zeros(n)],
            known: None,
            looped: Looped::of_robot(model, tasks).map(Box::new),
            finger_loops: FingerLoops::new(model).filter(|_| has_grip).map(Box::new),
            normal_forces: Vec::new(),
            is_repeated: false,
        })
    }

    /// Sets the tree of connected robots whose model the laws use; with `None`, they use the model of the
    /// robot.
    pub fn know(&mut self, known: Option<KnownTree>) {
        self.known = known.map(Box::new);
    }

    /// Returns the tree of connected robots whose model the laws use; `None` if they use the model of the
    /// robot. The caller must set the state of the tree before an update.
    pub fn known(&mut self) -> Option<&mut KnownTree> {
        self.known.as_deref_mut()
    }

    /// Makes the laws assume the friction of an engine in which joints do not stick: proportional to the rate
    /// near rest.
    pub fn assume_creeping_friction(&mut self) {
        self.friction_creeps = true;
    }

    /// Returns true if a law uses the external wrenches in the data.
    pub fn compensates_environment(&self) -> bool {
        self.compensates_environment
    }

    /// Returns the desired accelerations of the last update, `(n,)`, rad/s² (m/s²), for the joints whose
    /// Coulomb friction a law compensates; the drives of these joints add the friction torque. The entries of
    /// other joints are `None`.
    pub fn desired_accelerations(&self) -> &[Option<f64>] {
        &self.desired_accelerations
    }

    /// Returns the controls.
    pub fn controls(&self) -> &[Control] {
        self.controls
    }

    /// Returns the laws of the active controls, with the indices of the controls.
    pub fn running(&self) -> impl Iterator<Item = (usize, &Law)> {
        let all = self.controls.iter().zip(&self.states).enumerate();
        all.filter(|(_, (_, state))| state.is_running()).map(|(index, (control, _))| (index, &control.law))
    }

    /// Returns the control that drives joint `j` at `t`, s: one that ends after `t` and either is active or
    /// has not yet started although its given start time is reached; `None` if there is no such control.
    pub fn driver_of(&self, j: usize, t: f64) -> Option<&Control> {
        let now = t + self.same_instant;
        let drives = |(control, state): &(&Control, &ControlState)| {
            let is_due = matches!(control.begin, Begin::At(start) if start <= now);
            let is_active = (state.is_running() || state.is_waiting() && is_due) && control.end > now;
            is_active && control.joints.contains(&j)
        };
        self.controls.iter().zip(&self.states).find(drives).map(|(control, _)| control)
    }

    /// Sets the indices of the events that have happened.
    pub fn set_events(&mut self, happened: &[usize]) {
        self.events.clear();
        self.events.extend_from_slice(happened);
    }

    /// Returns true if an event that has happened starts a control that has not yet started.
    pub fn is_started_by_event(&self) -> bool {
        let starts = |(control, state): (&Control, &ControlState)| {
            let event = matches!(control.begin, Begin::AfterEvent(event) if self.events.contains(&event));
            event && state.is_waiting()
        };
        self.controls.iter().zip(&self.states).any(starts)
    }

    /// Returns the external torque commands, `(n,)`, N m (N); `None` for a joint without a command.
    pub fn commanded(&self) -> &[Option<f64>] {
        &self.commanded
    }

    /// Sets the external torque commands, `(n,)`, N m (N), which are held until the next call. `None` leaves
    /// the command of a joint unchanged. Torques of active controls take precedence.
    pub fn command(&mut self, tau: &[Option<f64>]) {
        for (held, tau) in self.commanded.iter_mut().zip(tau) {
            *held = tau.or(*held);
        }
    }

    /// Returns the desired pose and motion of a control (index) at the time of the last evaluation, relative
    /// to the base if the reference is, otherwise in W; `None` without a tracked frame or while the control
    /// is not active.
    pub fn desired(&self, control: usize) -> Option<&TaskSample<f64>> {
        let state = &self.states[control];
        state.desired_pose.as_ref().filter(|_| state.is_running())
    }

    /// Returns the tracking error of a control (index), desired less actual, of length [`Control::width`], at
    /// the time of the last evaluation; zero if the control is not active or has not yet been evaluated. For
    /// a robot without closures that knows no other robots, the error of computed torque of a frame with all
    /// joints is also zero unless the control has a goal, a shifted reference or a trace column.
    pub fn error(&self, control: usize) -> &[f64] {
        &self.states[control].error
    }

    /// Returns the present outcome of the goal of a control (index); [`Outcome::Unfinished`] without a goal.
    pub fn outcome(&self, control: usize) -> Outcome {
        self.states[control].memory.outcome
    }

    /// Returns the states of all controls, including user-defined controllers, for a checkpoint.
    ///
    /// # Errors
    /// The errors of a user-defined controller.
    pub fn save(&self) -> Result<Vec<ControlMemory>, ControlError> {
        let states = self.controls.iter().zip(&self.states);
        let saved = states.map(|(control, state)| {
            let mut memory = state.memory.clone();
            memory.user = control.law.control_law().save()?;
            memory.external = control.law.external().map(|law| law.memory().clone());
            Ok(memory)
        });
        saved.collect()
    }

    /// Restores the states returned by [`ControllerSet::save`].
    ///
    /// # Errors
    /// [`ControlError::OtherControls`] and [`ControlError::OtherMemory`] for states of different controls,
    /// and the errors of a user-defined controller.
    pub fn load(&mut self, saved: &[ControlMemory]) -> Result<(), ControlError> {
        let (got, expected) = (saved.len(), self.controls.len());
        if got != expected {
            return Err(ControlError::OtherControls { got, expected });
        }
        self.evaluated_at = f64::NAN;
        for ((control, state), memory) in self.controls.iter_mut().zip(&mut self.states).zip(saved) {
            state.restore(control, memory)?;
            control.law.control_law_mut().load(&memory.user)?;
            let Control { name, joints, law, .. } = control;
            if let Some(law) = law.external_mut() {
                let is_own = |memory| law.restore(memory, name, joints.len());
                if !memory.external.as_ref().is_some_and(is_own) {
                    return Err(ControlError::OtherMemory { control: name.clone() });
                }
            }
        }
        Ok(())
    }

    /// Computes the joint torques `tau`, `(n,)`, N m (N), at `t`, s, and the state `q`, `(nq,)`, and `v`,
    /// `(nv,)`. Joints without an active control have the torque of an external command, or zero.
    ///
    /// Requires up-to-date kinematics ([`kinematics`](crate::dynamics::kinematics)) and, in `data`, the
    /// external wrenches that are to be compensated.
    ///
    /// # Errors
    /// [`ControlError`] for active controls with a joint in common, a reference that is not defined at `t`, a
    /// load that is not held, or a user-defined controller that fails or returns a torque that is not finite.
    pub fn update(
        &mut self,
        t: f64,
        model: &Model,
        data: &mut Data<S>,
        q: &[S],
        v: &[S],
        tau: &mut [S],
    ) -> Result<(), ControlError> {
        self.update_errors(t, model, data, q, v)?;
        if self.activate(t, model)? | self.follow_commands(t) {
            self.evaluated_at = f64::NAN; // the set of active controls has changed
            self.update_errors(t, model, data, q, v)?;
        }
        self.check_loads(t)?;
        if !self.task_of_whole_robot(model, data, q, v, tau) {
            self.torques_of_groups(t, model, data, (q, v), tau)?;
            tau.iter_mut().zip(&self.tau).for_each(|(to, from)| *to = S::of(*from));
        }
        for state in self.states.iter_mut().filter(|state| state.is_running()) {
            state.memory.last_tick = Some(t);
        }
        Ok(())
    }

    /// Computes the torques and returns true if the only active control is a task law on all joints (fast
    /// path). Otherwise returns false.
    fn task_of_whole_robot(
        &mut self,
        model: &Model,
        data: &mut Data<S>,
        q: &[S],
        v: &[S],
        tau: &mut [S],
    ) -> bool {
        let Some(work) = &mut self.whole_robot else { return false };
        let Some((control, state)) = running(self.controls, &self.states).next() else { return false };
        let Some((law, reference)) = task_on_all_joints(control, tau.len()) else { return false };
        let Some(desired) = &state.desired_pose else { return false };
        let is_relative = reference.is_relative_to_base();
        computed_torque(law, model, data, q, v, &desired.lift(), is_relative, work, tau);
        if self.has_friction {
            work.desired_accelerations(law, &mut self.desired_accelerations);
        }
        true
    }

    /// Computes the torques of all joints from the laws of the active controls; `last` holds the torques of
    /// the previous update.
    fn torques_of_groups(
        &mut self,
        t: f64,
        model: &Model,
        data: &mut Data<S>,
        (q, v): (&[S], &[S]),
        last: &[S],
    ) -> Result<(), ControlError> {
        // laws that solve for accelerations take the efforts of the other joints into account
        self.tau.iter_mut().zip(&self.commanded).for_each(|(tau, held)| *tau = held.unwrap_or(0.0));
        self.commands.fill(JointCommand::Effort);
        self.desired_accelerations.fill(None);
        let laws = || running(self.controls, &self.states).map(|(control, _)| control.law.control_law());
        let has_accelerations = laws().any(|law| law.joint_command() != JointCommand::Effort);
        if has_accelerations || laws().any(ControlLaw::needs_jacobian) {
            match &mut self.known {
                Some(known) => known.reduce(&mut self.reduced),
                None => {
                    free_floating_recursion(model, data, q, v, 0, &mut self.reduced);
                    if let Some(looped) = &mut self.looped {
                        looped.update(model, data, &self.reduced);
                    }
                }
            }
        }
        self.efforts(t, model, data, (q, v), last)?;
        if has_accelerations {
            self.accelerations(model, data, q, v);
        }
        Ok(())
    }
}

/// Returns the solver for the torques of the tree whose model the laws use; `None` if it has no closed loops.
fn active_loops<'l, S>(
    known: &'l mut Option<Box<KnownTree>>,
    own: &'l mut Option<Box<Looped<S>>>,
) -> Option<&'l mut LoopedDynamics> {
    match known {
        Some(known) => known.looped.as_mut().map(|looped| &mut looped.dynamics),
        None => own.as_mut().map(|looped| &mut looped.dynamics),
    }
}

/// Returns the active controls, each with its state.
fn running<'c>(
    controls: &'c [Control],
    states: &'c [ControlState],
) -> impl Iterator<Item = (&'c Control, &'c ControlState)> {
    controls.iter().zip(states).filter(|(_, state)| state.is_running())
}

/// Returns the law and the reference of a control if it tracks a frame by computed torque with all `n`
/// joints; otherwise `None`.
fn task_on_all_joints(control: &Control, n: usize) -> Option<(&ComputedTorque, &TaskReference)> {
    match &control.law {
        Law::TaskComputedTorque(law, reference) if control.joints.len() == n => Some((law, reference)),
        _ => None,
    }
}
