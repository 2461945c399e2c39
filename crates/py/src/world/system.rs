//! The class `System`: one spacecraft of a world.

use super::robot_settings::{RobotSettings, initial_state};
use crate::arrays::names_in;
use crate::environment::SurfaceAssignment;
use crate::model::PyModel;
use crate::model::closed_loop::{loops_in, with_loops};
use crate::pickling::{ConstructorCall, Reduced, deep_copy};
use crate::reference::Around;
use onorbit_core::model::Loop;
use onorbit_core::world::System;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::Arc;

/// System of a world: one spacecraft with its model, initial state and controllers.
///
/// Parameters
/// ----------
/// name : str
///     Name, unique in the world: a letter, followed by letters, digits, ``_`` and ``-``.
/// model : Model
///     Model of the robot.
/// q : (nq,) array
///     Initial configuration, m and rad.
/// v : (nv,) array
///     Initial velocity, m/s and rad/s.
/// controller : control law, object or list of Control, optional
///     Control law for all joints, an object with ``update(t, state)`` that returns joint torques (n,), N m
///     or N, or several controls. After a capture, control laws still use the model of this system alone,
///     unless it ``knows`` the other system.
/// reference : Reference or JointReference, optional
///     Reference of the controller.
/// tool : str, optional
///     Frame that tracks the reference; default: the tool of the controller.
/// control_period : float, optional
///     Time between calls of the controller, s; default: every step.
/// enforce_limits : bool
///     If True, position limits of joints are rigid stops.
/// restitution : float
///     Coefficient of restitution of the stops, 0 to 1.
/// reference_start_tolerance : (float, float), optional
///     Permitted initial deviation of the tool from its reference, m and rad; default: (0.05, 0.1).
/// actuators : list of Brake, optional
///     Brakes of joints.
/// surfaces : Surface or dict of str to Surface, optional
///     Surfaces of the bodies, used by ``Drag`` and ``RadiationPressure`` effects that have no ``surfaces``,
///     in the form described for ``Drag``; the keys of a dict are names of links. Default: ``Faces()``.
/// knows : list of str, optional
///     Names of other systems whose models the controllers know. While such a system is connected to this
///     one, laws that use a model use the model of the connected tree, in which the joints of the other
///     system have no motor torque.
/// loops : list of Loop, optional
///     Closed loops of the robot, in addition to those of the model.
///
/// Raises
/// ------
/// ShapeError, DtypeError, EffectError, ModelError, FrameError
///     If ``q`` or ``v`` is not a vector, ``knows`` is not a list of names, or ``surfaces`` or ``loops`` is
///     invalid. Other invalid arguments raise an error when the ``World`` is constructed.
#[pyclass(name = "System", frozen, module = "onorbit_rs")]
pub(crate) struct PySystem {
    /// Name of the system.
    #[pyo3(get)]
    pub(super) name: String,
    /// Model of the robot with its loops.
    #[pyo3(get)]
    pub(super) model: Py<PyModel>,
    q: Vec<f64>,
    v: Vec<f64>,
    pub(super) settings: RobotSettings,
    pub(super) surfaces: Option<SurfaceAssignment>,
    /// Surfaces as given in Python.
    given_surfaces: Option<Py<PyAny>>,
    pub(super) knows: Vec<String>,
}

#[pymethods]
impl PySystem {
    #[new]
    #[pyo3(signature = (
        name, model, q, v, *, controller=None, reference=None, tool=None, control_period=None, enforce_limits=false,
        restitution=0.0, reference_start_tolerance=None, actuators=None, surfaces=None, knows=None,
        loops=None,
    ))]
    fn new(
        py: Python<'_>,
        name: String,
        model: Py<PyModel>,
        q: &Bound<'_, PyAny>,
        v: &Bound<'_, PyAny>,
        controller: Option<Py<PyAny>>,
        reference: Option<Py<PyAny>>,
        tool: Option<Py<PyAny>>,
        control_period: Option<f64>,
        enforce_limits: bool,
        restitution: f64,
        reference_start_tolerance: Option<Py<PyAny>>,
        actuators: Option<Py<PyAny>>,
        surfaces: Option<&Bound<'_, PyAny>>,
        knows: Option<&Bound<'_, PyAny>>,
        loops: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let model = match loops.map(loops_in).transpose()? {
            Some(loops) if !loops.is_empty() => Py::new(py, with_loops(model.bind(py), loops)?)?,
            _ => model,
        };
        let names = |knows| names_in(knows, "knows", "names of other systems", "target");
        let knows = knows.map_or(Ok(Vec::new()), names)?;
        let given_surfaces = deep_copy(surfaces)?.map(Bound::unbind);
        let surfaces = surfaces.map(|surfaces| SurfaceAssignment::new(Some(surfaces))).transpose()?;
        let (q, v) = initial_state(py, &model.get().model, q, v)?;
        let settings = RobotSettings {
            controller,
            reference,
            tool,
            control_period,
            enforce_limits,
            restitution,
            reference_start_tolerance,
            actuators,
        };
        Ok(Self { name, model, q, v, settings, surfaces, given_surfaces, knows })
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        let arguments = (&self.name, &self.model, &self.q, &self.v);
        ConstructorCall::new("System", arguments, &self.keywords(py)?)?.reduce(py)
    }

    fn __repr__(&self) -> String {
        format!("<System '{}': {}>", self.name, self.model.get().model.name())
    }
}

impl PySystem {
    /// Returns the keyword arguments of the constructor.
    fn keywords<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let keywords = PyDict::new(py);
        self.settings.write_to(&keywords)?;
        keywords.set_item("surfaces", &self.given_surfaces)?;
        keywords.set_item("knows", &self.knows)?;
        Ok(keywords)
    }

    /// Returns a copy of the system whose robot has additional closed loops.
    pub(super) fn with_loops(&self, py: Python<'_>, loops: Vec<Loop>) -> PyResult<Py<Self>> {
        let model = Py::new(py, with_loops(self.model.bind(py), loops)?)?;
        let arguments = (&self.name, model, &self.q, &self.v);
        let system = py.get_type::<Self>().call(arguments, Some(&self.keywords(py)?))?;
        Ok(system.cast_into::<Self>()?.unbind())
    }

    /// Returns the system of the core. Its references and controls may refer to the objects in `around`.
    pub(super) fn system(&self, py: Python<'_>, around: &Around<'_>) -> PyResult<System> {
        let model = self.model.get();
        let mut system = System::new(&self.name, Arc::clone(&model.model), self.q.clone(), self.v.clone());
        self.settings.apply(py, model, around, &mut system)?;
        Ok(system)
    }
}
