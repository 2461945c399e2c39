//! Commands that the caller of a stepper sends to a run.

use super::equations::EquationsOfMotion;
use super::error::SimulationError;
use super::external_control::ExternalControl;
use super::members::Place;
use super::run_state::RunState;
use super::stepper::Stepper;
use super::wrench_commands::WrenchCommand;
use crate::control::{Control, External, ExternalCommand, Interface};
use crate::spatial::Scalar;

impl Stepper<'_> {
    /// Sends a command to the control named `control` of the system with index `system`. The law of this
    /// control must be [`External`](crate::control::External). The command takes effect at the next control
    /// tick, or at the current time if that is a tick, and is held until the next command.
    ///
    /// # Errors
    /// [`SimulationError::Control`] for an invalid command, and for a control that does not exist, does not
    /// follow commands or has ended; [`SimulationError::Ended`] if the run has ended. The run does not
    /// change.
    pub fn send(
        &mut self,
        system: usize,
        control: &str,
        command: ExternalCommand,
    ) -> Result<(), SimulationError> {
        self.check()?;
        let (run, system) = self.run_of(system);
        run.send(system, control, command)
    }

    /// Checks a command to a control without sending the command.
    ///
    /// # Errors
    /// The errors of [`Stepper::send`].
    pub fn check_send(
        &self,
        system: usize,
        control: &str,
        command: &ExternalCommand,
    ) -> Result<(), SimulationError> {
        self.check()?;
        let (group, system) = self.places[system];
        self.groups[group].run.check_send(system, control, command)
    }

    /// Applies a wrench at the origin of the frame with index `frame` of the system with index `system`, from
    /// the current time until the next wrench on the same frame. The current step ends at the current time.
    ///
    /// # Errors
    /// [`SimulationError::UnknownFrame`] for a frame that does not exist, [`SimulationError::NotFinite`] for
    /// a wrench that is not finite, [`SimulationError::Ended`] if the run has ended, and
    /// [`SimulationError::EngineOfWorld`] with an external engine; the run does not change. The errors of a
    /// step end the run.
    pub fn wrench(
        &mut self,
        system: usize,
        frame: usize,
        wrench: WrenchCommand,
    ) -> Result<(), SimulationError> {
        self.check()?;
        let (run, system) = self.run_of(system);
        run.check_wrench(system, frame, &wrench)?;
        let result = run.wrench(system, frame, wrench);
        self.ended_by(result)
    }

    /// Returns the controls of a system that follow external commands.
    pub fn external(&self, system: usize) -> Vec<ExternalControl> {
        let (group, system) = self.places[system];
        self.groups[group].run.external(system)
    }
}

impl<S: Scalar> RunState<'_, S> {
    pub(super) fn check_command(&self, system: usize, tau: &[Option<f64>]) -> Result<(), SimulationError> {
        let place = &self.layout.systems()[system];
        let (got, expected) = (tau.len(), place.joints.len());
        if got != expected {
            return Err(SimulationError::WrongLength { name: "tau", expected, got });
        }
        let set = &self.systems[system].controllers.set;
        for (index, value) in tau.iter().enumerate().filter_map(|(j, tau)| Some((j, (*tau)?))) {
            if !value.is_finite() {
                return Err(SimulationError::NotFinite { name: "tau", index, value });
            }
            if let Some(control) = set.driver_of(index, self.time) {
                let (joint, control) = (place.joints[index].clone(), control.name.clone());
                return Err(SimulationError::CommandedJoint { joint, control });
            }
        }
        Ok(())
    }

    /// Sets those joint torques, N m or N, that are not `None`; they are held from the current time on.
    pub(super) fn command(&mut self, system: usize, tau: &[Option<f64>]) -> Result<(), SimulationError> {
        self.cut_at_current_time()?;
        let EquationsOfMotion { trees, members, .. } = &mut self.equations;
        let set = &mut self.systems[system].controllers.set;
        let moved = match members.places[system] {
            Place::Tree(tree) => &mut trees[tree],
            Place::Part(part) => &mut members.parts[part].own,
        };
        set.command(tau);
        for (j, tau) in tau.iter().enumerate() {
            // a control may have become active during the step that ended here
            if let Some(tau) = tau.filter(|_| set.driver_of(j, self.time).is_none()) {
                moved.command[j] = S::of(tau);
            }
        }
        if let Place::Part(part) = members.places[system] {
            let part = &members.parts[part];
            part.drive(&mut trees[part.tree]);
        }
        Ok(())
    }

    /// Sends a command to a control at the current time.
    pub(super) fn send(
        &mut self,
        system: usize,
        control: &str,
        command: ExternalCommand,
    ) -> Result<(), SimulationError> {
        let time = self.time;
        Ok(self.systems[system].controllers.set.send(control, command, time)?)
    }

    /// Checks a command to a control at the current time.
    pub(super) fn check_send(
        &self,
        system: usize,
        control: &str,
        command: &ExternalCommand,
    ) -> Result<(), SimulationError> {
        self.systems[system].controllers.set.check_send(control, command, self.time)?;
        Ok(())
    }

    /// Returns the controls of a system that follow external commands.
    pub(super) fn external(&self, system: usize) -> Vec<ExternalControl> {
        let joints = &self.layout.systems()[system].joints;
        let controls = self.systems[system].controllers.set.external();
        let external = |control: &Control| ExternalControl {
            name: control.name.clone(),
            joints: control.joints.iter().map(|&j| joints[j].clone()).collect(),
            interface: control.law.external().map_or(Interface::Effort, External::interface),
        };
        controls.map(external).collect()
    }

    pub(super) fn check_wrench(
        &self,
        system: usize,
        frame: usize,
        wrench: &WrenchCommand,
    ) -> Result<(), SimulationError> {
        let place = &self.layout.systems()[system];
        if self.mover.is_external() {
            let (what, remedy) = ("a commanded wrench", "define it as an effect of the environment");
            return Err(SimulationError::EngineOfWorld { name: place.name.clone(), what, remedy });
        }
        let count = self.model(system).frames().len();
        if frame >= count {
            return Err(SimulationError::UnknownFrame { frame, count });
        }
        for (name, vector) in [("force", &wrench.force), ("torque", &wrench.torque)] {
            if let Some((index, &value)) = vector.iter().enumerate().find(|(_, x)| !x.is_finite()) {
                return Err(SimulationError::NotFinite { name, index, value });
            }
        }
        Ok(())
    }

    /// Sets the wrench on a frame, which is held from the current time on.
    pub(super) fn wrench(
        &mut self,
        system: usize,
        frame: usize,
        wrench: WrenchCommand,
    ) -> Result<(), SimulationError> {
        self.cut_at_current_time()?;
        let place = (self.numbers[system], frame);
        let frame = self.model(system).frames()[frame].clone();
        self.equations.loads.commands.set(self.schedule.now(), place, &frame, wrench);
        Ok(())
    }

    /// Returns true if the controllers of a system, which a trial step has already updated at `t`, s, are due
    /// again because of a later command.
    pub(super) fn has_new_command(&self, system: usize, t: f64) -> bool {
        let set = &self.systems[system].controllers.set;
        let has_wrench = || self.equations.loads.commands.changed_at() == Some(t);
        set.has_due_command(t) || set.compensates_environment() && has_wrench()
    }
}
