//! Names and models of the systems of a run, and the view of a single system.

use super::event_record::PyEventRecord;
use super::trace::PyWorldTrace;
use crate::arrays::constant;
use crate::errors::{fields, raise};
use crate::stepper::PyStepper;
use crate::trace::PyTrace;
use numpy::PyArrayDyn;
use onorbit_core::model::Model;
use onorbit_core::number_text;
use onorbit_core::simulation::{Recording, Simulation, Stepper};
use pyo3::exceptions::PyAttributeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::Arc;

/// Returns the index of the system `name` in `names`; an unknown name is an error.
pub(super) fn find(py: Python<'_>, names: &[String], name: &str) -> PyResult<usize> {
    names.iter().position(|known| known == name).ok_or_else(|| {
        let message = format!("there is no system '{name}'; {}", number_text::names(names, "system"));
        raise(py, "WorldError", &message, &fields!(py, "name": name))
    })
}

/// Returns the error for an attribute that the `owner` (the stepper or the trace of a world of several
/// systems) does not have, but that the steppers or traces of its systems have.
pub(super) fn attribute_of_systems(names: &[String], owner: &str, attribute: &str) -> PyErr {
    let examples: Vec<String> = names.iter().map(|name| format!("{owner}[\"{name}\"].{attribute}")).collect();
    PyAttributeError::new_err(format!(
        "the {owner} has no attribute '{attribute}', because the world has several systems; use {}",
        examples.join(" or ")
    ))
}

type Optional<'a, 'py> = Option<&'a Bound<'py, PyAny>>;

/// Names and models of the systems of a run.
pub(crate) struct Systems {
    pub(crate) names: Vec<String>,
    pub(crate) models: Vec<Arc<Model>>,
}

impl Systems {
    /// Returns the names and models of the systems of a simulation.
    pub(crate) fn of(simulation: &Simulation) -> Self {
        let systems = &simulation.systems;
        Self {
            names: systems.iter().map(|system| system.name.clone()).collect(),
            models: systems.iter().map(|system| Arc::clone(&system.model)).collect(),
        }
    }

    /// Returns the index of the system `name`; an unknown name is an error.
    pub(crate) fn find(&self, py: Python<'_>, name: &str) -> PyResult<usize> {
        find(py, &self.names, name)
    }

    /// Returns the events of a run that have happened so far.
    pub(crate) fn events(&self, stepper: &Stepper<'_>) -> Vec<PyEventRecord> {
        stepper.events().into_iter().map(|record| PyEventRecord::of(record, &self.names)).collect()
    }

    /// Returns an error if there are several systems. The `owner`, a stepper or a trace, then does not have
    /// the `attribute`; the steppers or traces of the systems have it.
    pub(crate) fn only(&self, owner: &str, attribute: &str) -> PyResult<()> {
        if self.names.len() == 1 {
            return Ok(());
        }
        Err(attribute_of_systems(&self.names, owner, attribute))
    }

    /// Converts a recording to the trace of the only system or, for several systems, to the trace of a world.
    /// `wall_s` is the wall-clock time of the run, s.
    pub(crate) fn wrap(
        &self,
        py: Python<'_>,
        recording: Recording,
        is_complete: bool,
        wall_s: f64,
    ) -> PyResult<Py<PyAny>> {
        let Recording { systems, events, groups } = recording;
        let names: Arc<[String]> = self.names.clone().into();
        let traces = systems.into_iter().zip(&self.models).enumerate();
        let traces = traces.map(|(system, (trace, model))| {
            let own = events.iter().filter(|record| record.systems.contains(&system)).cloned().collect();
            let (model, names) = (Arc::clone(model), Arc::clone(&names));
            Py::new(py, PyTrace { trace, model, events: own, names, is_complete, wall_s })
        });
        let mut traces = traces.collect::<PyResult<Vec<_>>>()?;
        if traces.len() == 1 {
            return Ok(traces.remove(0).into_any());
        }
        let world = PyWorldTrace::new(self.names.clone(), traces, (events, groups), (is_complete, wall_s));
        Ok(Py::new(py, world)?.into_any())
    }
}

/// View of one system of a run in a world, as returned by ``stepper[name]``.
#[pyclass(name = "SystemStepper", frozen, module = "onorbit_rs")]
pub(crate) struct PySystemStepper {
    pub(crate) stepper: Py<PyStepper>,
    pub(crate) system: usize,
}

#[pymethods]
impl PySystemStepper {
    /// Configuration at the current time as a read-only (nq,) array: base position in W, m; base quaternion
    /// xyzw; joint positions, rad or m.
    #[getter]
    fn q<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        self.stepper.get().state(py, self.system).map(|(q, _)| constant(py, &q))
    }

    /// Velocity at the current time as a read-only (nv,) array: base twist in base axes, m/s and rad/s; joint
    /// rates, rad/s or m/s.
    #[getter]
    fn v<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        self.stepper.get().state(py, self.system).map(|(_, v)| constant(py, &v))
    }

    /// Set the joint torques of this system, which are held from the current time until the next command.
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
        self.stepper.get().command_system(self.system, tau)
    }

    /// Send a command to the joints of an :class:`External` controller of this system; see
    /// :meth:`Stepper.send`.
    ///
    /// Parameters
    /// ----------
    /// control : str
    ///     Name of the control, a key of :attr:`external`.
    /// position : (k,) array, optional
    ///     Positions of the ``k`` joints of the control, rad or m.
    /// velocity : (k,) array, optional
    ///     Velocities, rad/s or m/s.
    /// effort : (k,) array, optional
    ///     Torques, N m (N for a prismatic joint).
    /// acceleration : (k,) array, optional
    ///     Accelerations, rad/s² or m/s².
    /// check_only : bool
    ///     If True, the command is checked but not sent.
    ///
    /// Raises
    /// ------
    /// ControlError, ShapeError, InputError
    ///     If the control or the command is invalid, as for :meth:`Stepper.send`.
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
        let values = [position, velocity, acceleration, effort];
        self.stepper.get().send_to(py, self.system, control, values, check_only)
    }

    /// Send a motion through points to the joints of an :class:`External` controller of this system; see
    /// :meth:`Stepper.send_trajectory`.
    ///
    /// Parameters
    /// ----------
    /// control : str
    ///     Name of the control, a key of :attr:`external`.
    /// times : (K,) array
    ///     Times of the ``K`` points after ``start``, s.
    /// positions : (K, k) array
    ///     Positions of the ``k`` joints of the control, rad or m.
    /// velocities : (K, k) array, optional
    ///     Velocities, rad/s or m/s.
    /// accelerations : (K, k) array, optional
    ///     Accelerations, rad/s² or m/s².
    /// start : float, optional
    ///     Simulation time of the start, s; default: the current time.
    ///
    /// Raises
    /// ------
    /// ControlError, ShapeError, InputError
    ///     If the control or the trajectory is invalid, as for :meth:`Stepper.send_trajectory`.
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
        let path = (start, times, positions);
        self.stepper.get().send_trajectory_to(py, self.system, control, path, [velocities, accelerations])
    }

    /// Apply a wrench to a link or frame of this system; see :meth:`Stepper.wrench`.
    ///
    /// Parameters
    /// ----------
    /// body : str
    ///     Name of a link or frame, at whose origin the force acts.
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
    ///     If the body or the wrench is invalid, as for :meth:`Stepper.wrench`.
    #[pyo3(signature = (body, force=None, torque=None, frame="world"))]
    fn wrench(
        &self,
        py: Python<'_>,
        body: &str,
        force: Optional<'_, '_>,
        torque: Optional<'_, '_>,
        frame: &str,
    ) -> PyResult<()> {
        self.stepper.get().wrench_on(py, self.system, body, (force, torque, frame))
    }

    /// Names of the joints of each :class:`External` controller of this system, by the name of the control.
    #[getter]
    fn external(&self, py: Python<'_>) -> PyResult<Py<PyDict>> {
        self.stepper.get().external_of(py, self.system)
    }

    /// Quantity that the gains of each :class:`External` controller of this system track, by the name of the
    /// control: ``position``, ``velocity`` or, without gains, ``effort``.
    #[getter]
    fn interfaces(&self, py: Python<'_>) -> PyResult<Py<PyDict>> {
        self.stepper.get().interfaces_of(py, self.system)
    }
}
