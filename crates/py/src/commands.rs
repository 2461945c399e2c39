//! Commands to joints, and wrenches on bodies, that the caller of a stepper sends to a run.

use crate::arrays::{Input, vector, wrong_shape};
use crate::errors::{IntoPython, fields, raise};
use crate::stepper::PyStepper;
use crate::torques::torques;
use onorbit_core::control::{ExternalCommand, Interface, JointTrajectory, Setpoint};
use onorbit_core::simulation::{WrenchAxes, WrenchCommand};
use pyo3::prelude::*;
use pyo3::types::PyDict;

type Optional<'a, 'py> = Option<&'a Bound<'py, PyAny>>;

impl PyStepper {
    /// Sets the joint torques, N m (N for prismatic joints), that the caller commands to a system.
    pub(crate) fn command_system(&self, system: usize, tau: &Bound<'_, PyAny>) -> PyResult<()> {
        let torques = torques(&self.systems.models[system], tau)?;
        self.try_with(tau.py(), |stepper| stepper.command(system, &torques))
    }

    /// Sends a constant command to a control of a system. `values` are the positions (rad or m), their first
    /// and second time derivatives, and the efforts (N m or N), each `None` if it is not commanded. If
    /// `check_only` is true, the command is checked but not sent.
    pub(crate) fn send_to(
        &self,
        py: Python<'_>,
        system: usize,
        control: &str,
        values: [Optional<'_, '_>; 4],
        check_only: bool,
    ) -> PyResult<()> {
        let command = ExternalCommand::Setpoint(setpoint(values)?);
        self.try_with(py, |stepper| match check_only {
            true => stepper.check_send(system, control, &command),
            false => stepper.send(system, control, command),
        })
    }

    /// Sends a trajectory to a control of a system: the simulation time of its start, s (default: the present
    /// time), times after the start, s, and positions, rad or m, with optional velocities and accelerations.
    pub(crate) fn send_trajectory_to(
        &self,
        py: Python<'_>,
        system: usize,
        control: &str,
        (start, times, positions): (Option<f64>, &Bound<'_, PyAny>, &Bound<'_, PyAny>),
        derivatives: [Optional<'_, '_>; 2],
    ) -> PyResult<()> {
        let start = start.map_or_else(|| self.time(py), Ok)?;
        let command = ExternalCommand::Trajectory(trajectory(start, times, positions, derivatives)?);
        self.try_with(py, |stepper| stepper.send(system, control, command))
    }

    /// Applies a wrench at the origin of the frame `body` of a system: force, N, torque, N m, and the axes in
    /// which both are expressed, `"world"` or `"body"`.
    pub(crate) fn wrench_on(
        &self,
        py: Python<'_>,
        system: usize,
        body: &str,
        (force, torque, axes): (Optional<'_, '_>, Optional<'_, '_>, &str),
    ) -> PyResult<()> {
        let frame = self.systems.models[system].frame(body).map_err(|error| error.into_python(py))?;
        let wrench = wrench(py, force, torque, axes)?;
        self.try_with(py, |stepper| stepper.wrench(system, frame, wrench))
    }

    /// Returns the names of the joints of each external control of a system.
    pub(crate) fn external_of(&self, py: Python<'_>, system: usize) -> PyResult<Py<PyDict>> {
        let names = PyDict::new(py);
        for control in self.with(py, |stepper| stepper.external(system))? {
            names.set_item(control.name, control.joints)?;
        }
        Ok(names.unbind())
    }

    /// Returns the quantity that the gains of each external control of a system can track: `"position"`,
    /// `"velocity"` or, without gains, `"effort"`.
    pub(crate) fn interfaces_of(&self, py: Python<'_>, system: usize) -> PyResult<Py<PyDict>> {
        let interfaces = PyDict::new(py);
        for control in self.with(py, |stepper| stepper.external(system))? {
            let interface = match control.interface {
                Interface::Position => "position",
                Interface::Velocity => "velocity",
                Interface::Effort => "effort",
            };
            interfaces.set_item(control.name, interface)?;
        }
        Ok(interfaces.unbind())
    }
}

/// Reads a constant command to k joints: positions, velocities, accelerations and efforts, each (k,) or
/// `None`.
fn setpoint(values: [Optional<'_, '_>; 4]) -> PyResult<Setpoint> {
    let read = |value: Optional<'_, '_>, name| value.map(|value| array(value, name, 1)).transpose();
    let [position, velocity, acceleration, effort] = values;
    Ok(Setpoint {
        position: read(position, "position")?,
        velocity: read(velocity, "velocity")?,
        acceleration: read(acceleration, "acceleration")?,
        effort: read(effort, "effort")?,
    })
}

/// Reads a motion of k joints through K points. It starts at simulation time `start`, s. The `times`, (K,),
/// s, are relative to the start; positions, velocities and accelerations are (K, k).
fn trajectory(
    start: f64,
    times: &Bound<'_, PyAny>,
    positions: &Bound<'_, PyAny>,
    derivatives: [Optional<'_, '_>; 2],
) -> PyResult<JointTrajectory> {
    let read = |value: Optional<'_, '_>, name| value.map(|value| array(value, name, 2)).transpose();
    let [velocities, accelerations] = derivatives;
    Ok(JointTrajectory {
        start,
        times: array(times, "times", 1)?,
        positions: array(positions, "positions", 2)?,
        velocities: read(velocities, "velocities")?,
        accelerations: read(accelerations, "accelerations")?,
    })
}

/// Reads a wrench whose force, N, and torque, N m, are in the axes `frame`; a missing force or torque is
/// zero.
fn wrench(
    py: Python<'_>,
    force: Optional<'_, '_>,
    torque: Optional<'_, '_>,
    frame: &str,
) -> PyResult<WrenchCommand> {
    let axes = match frame {
        "world" => WrenchAxes::World,
        "body" => WrenchAxes::Body,
        other => {
            let message = format!("frame is '{other}'; the choices are 'world' and 'body'");
            return Err(raise(py, "InputError", &message, &fields!(py, "name": "frame", "got": other)));
        }
    };
    Ok(WrenchCommand {
        force: vector(force, "force", [0.0; 3])?,
        torque: vector(torque, "torque", [0.0; 3])?,
        axes,
    })
}

/// Reads the numbers of an array with `axes` axes: one (joints or times) or two (times and joints).
fn array(value: &Bound<'_, PyAny>, name: &str, axes: usize) -> PyResult<Vec<f64>> {
    let input = Input::new(value, name)?;
    if input.shape().len() != axes {
        let expected = if axes == 1 { "(k,), one number per joint" } else { "(K, k), one row per time" };
        let expected = if name == "times" { "(K,)" } else { expected };
        return Err(wrong_shape(value.py(), name, expected, input.shape()));
    }
    Ok(input.data().to_vec())
}
