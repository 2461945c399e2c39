//! Effects of the environment; a body's name is looked up when the simulation is made.

use crate::arrays::fixed;
use crate::errors::{IntoPython, fields, raise};
use nalgebra::Vector3;
use onorbit_core::environment::{BodyWrench, Effect, GravityGradient};
use onorbit_core::gravity::{GravityField, Luminary};
use onorbit_core::model::Model;
use pyo3::prelude::*;
use std::sync::Arc;

type Any<'a, 'py> = &'a Bound<'py, PyAny>;

/// What acts on the bodies beside gravity.
#[pyclass(name = "Effect", subclass, frozen, module = "onorbit_rs")]
pub(crate) struct PyEffect {
    kind: Kind,
}

enum Kind {
    GravityGradient,
    /// Part of the gravity of the run: see [`crate::gravity::gravity_of`].
    GravityField(Arc<GravityField>),
    /// Likewise.
    ThirdBody(Luminary),
    BodyWrench {
        frame: String,
        force: Vector3<f64>,
        torque: Vector3<f64>,
        start: f64,
        end: f64,
    },
}

impl PyEffect {
    /// The field of a planet as one of the effects.
    pub(crate) fn of_field(field: Arc<GravityField>) -> Self {
        Self { kind: Kind::GravityField(field) }
    }

    /// The field, if it is one.
    pub(crate) fn field(&self) -> Option<&Arc<GravityField>> {
        match &self.kind {
            Kind::GravityField(field) => Some(field),
            _ => None,
        }
    }

    /// The Sun or the Moon, if it is the pull of one.
    pub(crate) fn luminary(&self) -> Option<Luminary> {
        match &self.kind {
            Kind::ThirdBody(body) => Some(*body),
            _ => None,
        }
    }

    /// The effect on a given robot; none where it is part of gravity.
    pub(crate) fn on(&self, py: Python<'_>, model: &Model) -> PyResult<Option<Arc<dyn Effect>>> {
        Ok(Some(match &self.kind {
            Kind::GravityField(_) | Kind::ThirdBody(_) => return Ok(None),
            Kind::GravityGradient => Arc::new(GravityGradient),
            Kind::BodyWrench { frame, force, torque, start, end } => {
                let frame = model.frame(frame).map_err(|error| error.into_python(py))?;
                let wrench = BodyWrench::on_frame(model, frame, *force, *torque)
                    .and_then(|wrench| wrench.during(*start, *end))
                    .map_err(|error| error.into_python(py))?;
                Arc::new(wrench)
            }
        }))
    }
}

/// Gravity-gradient torque ``3μ/r³ r̂ × I r̂`` of each body about its own centre of mass; needs an orbit.
#[pyclass(name = "GravityGradient", extends = PyEffect, frozen, module = "onorbit_rs")]
pub(crate) struct PyGravityGradient;

#[pymethods]
impl PyGravityGradient {
    #[new]
    fn new() -> PyClassInitializer<Self> {
        PyClassInitializer::from(PyEffect { kind: Kind::GravityGradient }).add_subclass(Self)
    }

    fn __repr__(&self) -> &'static str {
        "GravityGradient()"
    }
}

/// The pull of the ``sun`` or the ``moon``, on robot and reference alike: ``μ [(s - r)/|s - r|³ - s/|s|³]``.
///
/// Needs an orbit around the Earth, and an ``earth`` with an epoch.
#[pyclass(name = "ThirdBody", extends = PyEffect, frozen, module = "onorbit_rs")]
pub(crate) struct PyThirdBody {
    body: Luminary,
}

#[pymethods]
impl PyThirdBody {
    #[new]
    fn new(py: Python<'_>, body: &str) -> PyResult<PyClassInitializer<Self>> {
        let Some(body) = Luminary::ALL.into_iter().find(|known| known.name() == body) else {
            let message = format!("third body is '{body}'; there are 'sun' and 'moon'");
            return Err(raise(py, "EffectError", &message, &fields!(py, "name": "body", "got": body)));
        };
        Ok(PyClassInitializer::from(PyEffect { kind: Kind::ThirdBody(body) }).add_subclass(Self { body }))
    }

    /// ``sun`` or ``moon``.
    #[getter]
    fn body(&self) -> &'static str {
        self.body.name()
    }

    /// Its gravitational parameter, m³/s².
    #[getter]
    fn mu(&self) -> f64 {
        self.body.mu()
    }

    fn __repr__(&self) -> String {
        format!("ThirdBody('{}')", self.body.name())
    }
}

/// A constant wrench on a body, in the axes of the named link or frame and at its origin.
///
/// ``force`` (3,) N, ``torque`` (3,) N m, on from ``start`` until ``end``, s of simulation, both hit exactly
/// (from the beginning, to the end of the run where None).
#[pyclass(name = "BodyWrench", extends = PyEffect, frozen, module = "onorbit_rs")]
pub(crate) struct PyBodyWrench;

#[pymethods]
impl PyBodyWrench {
    #[new]
    #[pyo3(signature = (body, *, force=None, torque=None, start=None, end=None))]
    fn new(
        py: Python<'_>,
        body: String,
        force: Option<Any<'_, '_>>,
        torque: Option<Any<'_, '_>>,
        start: Option<f64>,
        end: Option<f64>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let (start, end) = (start.unwrap_or(f64::NEG_INFINITY), end.unwrap_or(f64::INFINITY));
        let vector = |value: Option<Any<'_, '_>>, name| {
            Ok::<_, PyErr>(Vector3::from(value.map_or(Ok([0.0; 3]), |value| fixed::<3>(value, name, &[3]))?))
        };
        let (force, torque) = (vector(force, "force")?, vector(torque, "torque")?);
        // times are wrong or right for any body
        BodyWrench::new(0, force, torque)
            .and_then(|wrench| wrench.during(start, end))
            .map_err(|error| error.into_python(py))?;
        let kind = Kind::BodyWrench { frame: body, force, torque, start, end };
        Ok(PyClassInitializer::from(PyEffect { kind }).add_subclass(Self))
    }
}
