//! Effects of the environment. Names of systems and bodies are resolved when the simulation is constructed.

mod atmosphere;
mod body_wrench;
mod drag;
mod gravity_gradient;
mod radiation_pressure;
mod surfaces;
mod target;
mod user;

use crate::arrays::list_of;
use crate::errors::IntoPython;
use crate::pickling::ConstructorCall;
use nalgebra::Vector3;
use onorbit_core::environment::atmosphere::Atmosphere;
use onorbit_core::environment::{BodyWrench, Drag, Effect, GravityGradient, RadiationPressure};
use onorbit_core::gravity::{GravityField, Luminary};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use std::sync::Arc;

pub(crate) use surfaces::SurfaceAssignment;
pub(crate) use target::Target;

type Any<'a, 'py> = &'a Bound<'py, PyAny>;

pub(crate) fn add_classes(m: &Bound<'_, PyModule>) -> PyResult<()> {
    m.add_class::<PyEffect>()?;
    m.add_class::<user::PyBodies>()?;
    m.add_class::<gravity_gradient::PyGravityGradient>()?;
    m.add_class::<body_wrench::PyBodyWrench>()?;
    m.add_class::<drag::PyDrag>()?;
    m.add_class::<radiation_pressure::PyRadiationPressure>()?;
    atmosphere::add_classes(m)?;
    surfaces::add_classes(m)
}

/// Base class of environment effects, which act on the bodies of a simulation.
///
/// The argument ``environment`` of a simulation is a list of effects. A subclass written in Python must define
/// ``wrenches(t, bodies)``, which returns a (K, 6) array: for each of the K bodies of ``bodies``
/// (:class:`BodyStates`) the force through its centre of mass, N, and the torque about its centre of mass, N m,
/// both in W axes. It may also define ``event_times()``, which returns the simulation times, s, at which the
/// wrenches are discontinuous; steps end at these times.
///
/// ``wrenches`` is called at every stage of a step, so that the integrator keeps its order, and for recorded
/// rows: with RK4, four to five times per step. A call takes about 10 us. Steps may be computed more than once;
/// the result must therefore depend only on the arguments. An exception in ``wrenches`` ends the run, and
/// ``run`` raises it unchanged.
///
/// Parameters
/// ----------
/// arguments, keywords : any
///     Arguments of the constructor of a subclass. This class ignores them.
///
/// Examples
/// --------
/// >>> import numpy as np
/// >>> import onorbit_rs as oo
/// >>> class Damping(oo.Effect):
/// ...     def wrenches(self, t, bodies):
/// ...         return np.hstack([-0.1 * bodies.velocity, -0.5 * bodies.angular_velocity])
#[pyclass(name = "Effect", subclass, frozen, module = "onorbit_rs")]
pub(crate) struct PyEffect {
    kind: Kind,
    /// Call that reconstructs the effect from a pickle; `None` for an effect written in Python.
    constructor_call: Option<ConstructorCall>,
}

#[pymethods]
impl PyEffect {
    #[new]
    #[pyo3(signature = (*arguments, **keywords))]
    fn of_subclass(arguments: &Bound<'_, PyTuple>, keywords: Option<&Bound<'_, PyDict>>) -> Self {
        let _ = (arguments, keywords); // those of the subclass
        Self { kind: Kind::User, constructor_call: None }
    }

    fn __reduce_ex__<'py>(this: &Bound<'py, Self>, _protocol: i32) -> PyResult<Bound<'py, PyAny>> {
        let py = this.py();
        if let Some(call) = &this.get().constructor_call {
            return call.reduce(py)?.into_pyobject(py).map(Bound::into_any);
        }
        let (class, attributes) = (this.get_type(), this.getattr_opt("__dict__")?);
        let create = py.import("copyreg")?.getattr("__newobj__")?;
        (create, (class,), attributes).into_pyobject(py).map(Bound::into_any)
    }
}

/// Parameters of an effect, with names of bodies that are not yet resolved in the systems of a simulation.
pub(crate) enum Kind {
    /// Effect written in Python.
    User,
    GravityGradient,
    /// Field of the planet, which [`crate::gravity::gravity_of`] adds to the gravity of the run.
    GravityField(Arc<GravityField>),
    /// Sun or Moon, which [`crate::gravity::gravity_of`] adds to the gravity of the run.
    ThirdBody(Luminary),
    BodyWrench {
        frame: String,
        force: Vector3<f64>,
        torque: Vector3<f64>,
        start: f64,
        end: f64,
    },
    Drag {
        atmosphere: Arc<dyn Atmosphere>,
        surfaces: SurfaceAssignment,
    },
    RadiationPressure {
        surfaces: SurfaceAssignment,
        flux: f64,
        earth_radius: Option<f64>,
    },
}

/// Reads the list of effects given as ``environment``.
pub(crate) fn effects<'py>(environment: Option<Any<'_, 'py>>) -> PyResult<Vec<Bound<'py, PyEffect>>> {
    environment.map_or_else(
        || Ok(Vec::new()),
        |value| list_of(value, "environment", "effects, such as [oo.GravityGradient()]"),
    )
}

impl PyEffect {
    /// Creates the base object of an effect, with the constructor and keywords used to pickle it.
    pub(crate) fn new(
        kind: Kind,
        constructor: &str,
        keywords: &Bound<'_, PyDict>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let constructor_call = ConstructorCall::with_keywords(constructor, keywords)?;
        Ok(PyClassInitializer::from(Self { kind, constructor_call: Some(constructor_call) }))
    }

    /// Returns the gravity field if the effect is a gravity field, otherwise `None`.
    pub(crate) fn field(&self) -> Option<&Arc<GravityField>> {
        match &self.kind {
            Kind::GravityField(field) => Some(field),
            _ => None,
        }
    }

    /// Returns the Sun or the Moon if the effect is the gravity of one of them, otherwise `None`.
    pub(crate) fn luminary(&self) -> Option<Luminary> {
        match &self.kind {
            Kind::ThirdBody(body) => Some(*body),
            _ => None,
        }
    }

    /// Returns true if the effect is a part of gravity. Only such effects can act on a numerical orbit.
    pub(crate) fn is_gravity(&self) -> bool {
        matches!(self.kind, Kind::GravityField(_) | Kind::ThirdBody(_))
    }

    /// Returns the effect with the names of its bodies resolved in the given systems; `None` for a part of
    /// gravity.
    pub(crate) fn on(this: &Bound<'_, Self>, targets: &[Target<'_>]) -> PyResult<Option<Arc<dyn Effect>>> {
        let py = this.py();
        Ok(Some(match &this.get().kind {
            Kind::User => Arc::new(user::PythonEffect::new(this, targets)?),
            Kind::GravityField(_) | Kind::ThirdBody(_) => return Ok(None),
            Kind::GravityGradient => Arc::new(GravityGradient),
            Kind::BodyWrench { frame, force, torque, start, end } => {
                let (system, frame) = target::frame_at(py, targets, frame)?;
                let wrench = BodyWrench::on_frame(targets[system].model, frame, *force, *torque)
                    .and_then(|wrench| wrench.during(*start, *end))
                    .map_err(|error| error.into_python(py))?;
                Arc::new(wrench.on_system(system))
            }
            Kind::Drag { atmosphere, surfaces } => {
                Arc::new(Drag::new(Arc::clone(atmosphere), surfaces.on_with_warning(py, targets, "drag")?))
            }
            Kind::RadiationPressure { surfaces, flux, earth_radius } => {
                let pressure =
                    RadiationPressure::new(surfaces.on_with_warning(py, targets, "radiation pressure")?)
                        .with_flux(*flux)
                        .and_then(|pressure| pressure.with_shadow(*earth_radius))
                        .map_err(|error| error.into_python(py))?;
                Arc::new(pressure)
            }
        }))
    }
}
