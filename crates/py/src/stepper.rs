//! The class `Stepper`: a run that the caller advances.

use crate::arrays::constant;
use crate::checkpoint::{PyCheckpoint, Since, checkpoint_of};
use crate::errors::SimulationErrorExt;
use crate::interrupt::period;
use crate::shared_run::SharedRun;
use crate::stepper_advance::ended;
use crate::world::{PyEventRecord, PySystemStepper, Systems};
use numpy::PyArrayDyn;
use onorbit_core::number_text::short;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::Arc;

type Optional<'a, 'py> = Option<&'a Bound<'py, PyAny>>;

/// Run that the caller advances, as returned by :meth:`Simulation.start`.
///
/// The times to which a run is advanced do not influence its motion: the steps are those of
/// :meth:`Simulation.run`. A state within a step is computed by dense output (adaptive steps) or by a shorter
/// trial step. After the run has ended, the methods raise ``SimulationError``.
#[pyclass(name = "Stepper", frozen, module = "onorbit_rs")]
pub(crate) struct PyStepper {
    pub(crate) run: SharedRun,
    pub(crate) number: u64,
    pub(crate) systems: Arc<Systems>,
}

#[pymethods]
impl PyStepper {
    /// Current simulation time, s.
    #[getter]
    pub(crate) fn time(&self, py: Python<'_>) -> PyResult<f64> {
        self.with(py, |stepper| stepper.time())
    }

    /// Planned end of the run, s; None if the run has no planned end.
    #[getter]
    fn duration(&self, py: Python<'_>) -> PyResult<Option<f64>> {
        self.with(py, |stepper| stepper.duration())
    }

    /// Configuration at the current time as a read-only (nq,) array: base position in W, m; base quaternion
    /// xyzw; joint positions, rad or m.
    #[getter]
    fn q<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        self.state(py, self.only("q")?).map(|(q, _)| constant(py, &q))
    }

    /// Velocity at the current time as a read-only (nv,) array: base twist in base axes, m/s and rad/s; joint
    /// rates, rad/s or m/s.
    #[getter]
    fn v<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        self.state(py, self.only("v")?).map(|(_, v)| constant(py, &v))
    }

    /// Advance the run by a time interval.
    ///
    /// Parameters
    /// ----------
    /// dt : float
    ///     Simulated time by which the run advances, s; positive.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     If ``dt`` is not positive and finite, or extends beyond the planned end; the run is unchanged.
    /// RunInterrupted
    ///     At Ctrl-C, before the requested time; its attribute ``trace`` contains the rows so far, and the
    ///     run can be advanced further.
    /// SimulationError
    ///     If the run diverges; its attribute ``trace`` contains the rows so far, and the run has ended.
    fn advance(&self, py: Python<'_>, dt: f64) -> PyResult<()> {
        let mut runs = self.run.lock(py)?;
        let after = runs.with(self.number, |stepper| stepper.time_after(dt)).ok_or_else(|| ended(py))?;
        let t = after.map_err(|error| error.into_python_with(py, None))?;
        self.advance_locked(py, &mut runs, t, None, &mut |py, _, _| py.check_signals())
    }

    /// Advance the run to a given time.
    ///
    /// Parameters
    /// ----------
    /// t : float
    ///     Simulation time, s, not before the current time.
    /// wall_s : float, optional
    ///     Wall-clock time, s, after which the call returns early, at the end of a step. Default: no limit.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     If ``t`` is not finite, before the current time, or after the planned end, or if ``wall_s`` is
    ///     negative or not finite; the run is unchanged.
    /// RunInterrupted
    ///     At Ctrl-C, before the requested time; its attribute ``trace`` contains the rows so far, and the
    ///     run can be advanced further.
    /// SimulationError
    ///     If the run diverges; its attribute ``trace`` contains the rows so far, and the run has ended.
    #[pyo3(signature = (t, *, wall_s=None))]
    fn advance_to(&self, py: Python<'_>, t: f64, wall_s: Option<f64>) -> PyResult<()> {
        let limit = wall_s.map(|seconds| period(py, "wall_s", seconds)).transpose()?;
        let mut runs = self.run.lock(py)?;
        self.advance_locked(py, &mut runs, t, limit, &mut |py, _, _| py.check_signals())
    }

    /// Set the joint torques, which are held from the current time until the next command.
    ///
    /// The current time becomes the end of a step. The trace is bit-identical to that of a controller that
    /// returns these torques at these times, except that the steps of an adaptive integrator may differ.
    ///
    /// Parameters
    /// ----------
    /// tau : (n,) array or dict of float
    ///     Torques of all joints, or torques by joint name, N m (N for a prismatic joint). Joints that are
    ///     not named keep their torques.
    ///
    /// Raises
    /// ------
    /// ShapeError
    ///     If the array does not have one entry per joint.
    /// InputError
    ///     If a torque is not finite, or a name is not that of a joint.
    /// ControlError
    ///     If a torque is given for a joint that has an active controller.
    fn command(&self, tau: &Bound<'_, PyAny>) -> PyResult<()> {
        self.command_system(self.only("command")?, tau)
    }

    /// Send a command to the joints of an :class:`External` controller.
    ///
    /// The command takes effect at the next update of the controllers, or now if one is due. It is held until
    /// the next command, or until the timeout of the controller. At least one of ``position``, ``velocity``
    /// and ``effort`` must be given.
    ///
    /// Parameters
    /// ----------
    /// control : str
    ///     Name of the control, a key of :attr:`external`; ``control`` for a single controller of all joints.
    /// position : (k,) array, optional
    ///     Positions of the ``k`` joints, rad or m; requires ``kp`` above zero. Without ``velocity``, the
    ///     joints rest at these positions.
    /// velocity : (k,) array, optional
    ///     Velocities, rad/s or m/s; requires ``kd`` above zero. Without ``position``, there is no position
    ///     error.
    /// effort : (k,) array, optional
    ///     Torques, N m (N for a prismatic joint), which are added to those computed from position and
    ///     velocity; without both, they are the torques of the joints.
    /// acceleration : (k,) array, optional
    ///     Accelerations, rad/s² or m/s², which are added to those computed from position and velocity;
    ///     requires one of these.
    /// check_only : bool
    ///     If True, the command is checked but not sent.
    ///
    /// Raises
    /// ------
    /// ControlError, ShapeError, InputError
    ///     If there is no such :class:`External` control or the control has ended, if a gain that the command
    ///     requires is zero, if the command lacks a required array, or if an array has the wrong length or is
    ///     not finite; the run is unchanged.
    #[pyo3(signature = (control, *, position=None, velocity=None, effort=None, acceleration=None, check_only=false))]
    fn send(
        &self,
        py: Python<'_>,
        control: &str,
        position: Optional<'_, '_>,
        velocity: Optional<'_, '_>,
        effort: Optional<'_, '_>,
        acceleration: Optional<'_, '_>,
        check_only: bool,
    ) -> PyResult<()> {
        let system = self.only("send")?;
        self.send_to(py, system, control, [position, velocity, acceleration, effort], check_only)
    }

    /// Send a motion through points to the joints of an :class:`External` controller.
    ///
    /// The motion between the points is interpolated as in the joint_trajectory_controller of ROS: linearly,
    /// by cubic polynomials if velocities are given, and by quintic polynomials if accelerations are given as
    /// well. It begins when the trajectory takes effect, with the state desired at that time or, if there is
    /// none, with the actual state. After the last point, its positions are held.
    ///
    /// Parameters
    /// ----------
    /// control : str
    ///     Name of the control, as for :meth:`send`.
    /// times : (K,) array
    ///     Times of the ``K`` points after ``start``, s; increasing, at least 0.
    /// positions : (K, k) array
    ///     Positions of the ``k`` joints of the control, rad or m.
    /// velocities : (K, k) array, optional
    ///     Velocities, rad/s or m/s.
    /// accelerations : (K, k) array, optional
    ///     Accelerations, rad/s² or m/s²; require velocities.
    /// start : float, optional
    ///     Simulation time of the start, s; default: the current time. Until a later start, the previous
    ///     command is held; for an earlier start, the points that have passed are skipped.
    ///
    /// Raises
    /// ------
    /// ControlError, ShapeError, InputError
    ///     As for :meth:`send`; also if ``times`` do not increase, or the last point is in the past.
    #[pyo3(signature = (control, times, positions, *, velocities=None, accelerations=None, start=None))]
    fn send_trajectory(
        &self,
        py: Python<'_>,
        control: &str,
        times: &Bound<'_, PyAny>,
        positions: &Bound<'_, PyAny>,
        velocities: Optional<'_, '_>,
        accelerations: Optional<'_, '_>,
        start: Option<f64>,
    ) -> PyResult<()> {
        let system = self.only("send_trajectory")?;
        self.send_trajectory_to(py, system, control, (start, times, positions), [velocities, accelerations])
    }

    /// Apply a wrench to a link or frame from the current time until the next wrench on it.
    ///
    /// The current time becomes the end of a step. With ``record_wrenches``, runs with an :class:`External`
    /// controller record the wrench in ``trace.wrenches["wrench_command"]``.
    ///
    /// Parameters
    /// ----------
    /// body : str
    ///     Name of a link or frame. The force acts at its origin, as for :class:`BodyWrench`.
    /// force : (3,) array, optional
    ///     Force, N; default: 0.
    /// torque : (3,) array, optional
    ///     Torque, N m; default: 0.
    /// frame : {"world", "body"}
    ///     Axes in which force and torque are given and remain constant: the axes of W, or those of ``body``.
    ///
    /// Raises
    /// ------
    /// FrameError, InputError, ShapeError, EngineError
    ///     If there is no such body, ``frame`` is unknown, a vector is not finite or not (3,), or the engine
    ///     is external; the run is unchanged.
    #[pyo3(signature = (body, force=None, torque=None, frame="world"))]
    fn wrench(
        &self,
        py: Python<'_>,
        body: &str,
        force: Optional<'_, '_>,
        torque: Optional<'_, '_>,
        frame: &str,
    ) -> PyResult<()> {
        let system = self.only("wrench")?;
        self.wrench_on(py, system, body, (force, torque, frame))
    }

    /// Names of the joints of each :class:`External` controller, by the name of the control.
    #[getter]
    fn external(&self, py: Python<'_>) -> PyResult<Py<PyDict>> {
        self.external_of(py, self.only("external")?)
    }

    /// Quantity that the gains of each control in :attr:`external` track, by the name of the control:
    /// ``position``, ``velocity`` or, without gains, ``effort``.
    #[getter]
    fn interfaces(&self, py: Python<'_>) -> PyResult<Py<PyDict>> {
        self.interfaces_of(py, self.only("interfaces")?)
    }

    /// Trigger an event that happens on command, at the current time.
    ///
    /// The current time becomes the end of a step; the event happens at the start of the next step.
    ///
    /// Parameters
    /// ----------
    /// name : str
    ///     Name of the event.
    ///
    /// Raises
    /// ------
    /// WorldError
    ///     If the event does not exist, has already happened or is not ``on_command``; the run is unchanged.
    fn trigger(&self, py: Python<'_>, name: &str) -> PyResult<()> {
        self.try_with(py, |stepper| stepper.trigger(name))
    }

    /// Names of the systems of the run; ``stepper[name]`` is the view of the system ``name``.
    #[getter]
    fn systems(&self) -> Vec<String> {
        self.systems.names.clone()
    }

    /// Events of the world that happened in the completed steps, in order of time.
    #[getter]
    fn events(&self, py: Python<'_>) -> PyResult<Vec<PyEventRecord>> {
        self.with(py, |stepper| self.systems.events(stepper))
    }

    /// Return the view of the system ``name``.
    ///
    /// Raises
    /// ------
    /// WorldError
    ///     If there is no such system.
    fn __getitem__(this: &Bound<'_, Self>, name: &str) -> PyResult<PySystemStepper> {
        let system = this.get().systems.find(this.py(), name)?;
        Ok(PySystemStepper { stepper: this.clone().unbind(), system })
    }

    /// Return the trace so far, with its last row at the current time.
    ///
    /// Returns
    /// -------
    /// Trace or WorldTrace
    ///     A copy, which does not change when the run continues.
    fn trace(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        let recording = self.try_with(py, |stepper| stepper.recording())?;
        let wall_s = self.run.lock(py)?.wall_s;
        let is_complete = self.with(py, |stepper| Some(stepper.time()) == stepper.duration())?;
        self.systems.wrap(py, recording, is_complete, wall_s)
    }

    /// End the run at the current time and return its trace, without copying the rows.
    ///
    /// Returns
    /// -------
    /// Trace or WorldTrace
    ///     Result of the run; a WorldTrace for a world of several systems.
    fn finish(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        let is_complete =
            self.with(py, |stepper| stepper.duration().is_none_or(|end| stepper.time() == end))?;
        self.end(py, &mut self.run.lock(py)?, is_complete)
    }

    /// Return a checkpoint, from which :meth:`Simulation.start` resumes with bit-identical results.
    ///
    /// Parameters
    /// ----------
    /// since : int or dict of int, optional
    ///     Index of the first row, as for :meth:`columns`. Only a checkpoint with all rows can be resumed.
    ///
    /// Returns
    /// -------
    /// Checkpoint
    ///
    /// Raises
    /// ------
    /// ControlError
    ///     If the state of a Python controller cannot be saved; the run is unchanged.
    /// InputError, WorldError
    ///     If ``since`` is invalid or names an unknown system.
    #[pyo3(signature = (since=Since::Every(0)), text_signature = "($self, since=0)")]
    fn checkpoint(&self, py: Python<'_>, since: Since) -> PyResult<PyCheckpoint> {
        let wall_s = self.run.lock(py)?.wall_s;
        let since = since.rows(py, &self.systems)?;
        self.with(py, |stepper| checkpoint_of(py, stepper, &self.systems.names, &since, wall_s))?
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let text = self.with(py, |stepper| match stepper.duration() {
            Some(end) => format!("<Stepper: at t = {} s of {} s>", short(stepper.time()), short(end)),
            None => format!("<Stepper: at t = {} s>", short(stepper.time())),
        });
        Ok(text.unwrap_or_else(|_| "<Stepper: ended or in use>".to_owned()))
    }
}
