//! Effects of the environment; a body's name is looked up when the simulation is made.

use crate::air::PyAtmosphere;
use crate::arrays::{fixed, list_of};
use crate::errors::{IntoPython, fields, raise};
use crate::made::Made;
use crate::surfaces::{Spread, kept};
use nalgebra::Vector3;
use onorbit_core::environment::atmosphere::Atmosphere;
use onorbit_core::environment::{
    BodyWrench, Drag, Effect, GravityGradient, RadiationPressure, SHADOW_RADIUS, SOLAR_FLUX,
};
use onorbit_core::gravity::{GravityField, Luminary};
use onorbit_core::model::Model;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use std::sync::Arc;

type Any<'a, 'py> = &'a Bound<'py, PyAny>;

/// What acts on the bodies beside gravity.
#[pyclass(name = "Effect", subclass, frozen, module = "onorbit_rs")]
pub(crate) struct PyEffect {
    kind: Kind,
    /// Of a field the subclass knows.
    made: Option<Made>,
}

#[pymethods]
impl PyEffect {
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, Py<PyTuple>)> {
        match &self.made {
            Some(made) => made.again(py),
            None => Err(PyTypeError::new_err("this effect does not pickle")),
        }
    }
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
    Drag {
        atmosphere: Arc<dyn Atmosphere>,
        surfaces: Spread,
    },
    RadiationPressure {
        surfaces: Spread,
        flux: f64,
        earth_radius: Option<f64>,
    },
}

/// What a run's ``environment`` holds.
pub(crate) fn effects<'py>(environment: Option<Any<'_, 'py>>) -> PyResult<Vec<Bound<'py, PyEffect>>> {
    environment.map_or_else(
        || Ok(Vec::new()),
        |value| list_of(value, "environment", "effects, such as [oo.GravityGradient()],"),
    )
}

impl PyEffect {
    /// The field of a planet as one of the effects.
    pub(crate) fn of_field(field: Arc<GravityField>) -> Self {
        Self { kind: Kind::GravityField(field), made: None }
    }

    /// An effect that `class` makes of `keywords`.
    fn made(kind: Kind, class: &str, keywords: &Bound<'_, PyDict>) -> PyResult<PyClassInitializer<Self>> {
        Ok(PyClassInitializer::from(Self { kind, made: Some(Made::by(class, keywords)?) }))
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

    /// Whether it is part of gravity, which a reference may follow.
    pub(crate) fn is_gravity(&self) -> bool {
        matches!(self.kind, Kind::GravityField(_) | Kind::ThirdBody(_))
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
            Kind::Drag { atmosphere, surfaces } => {
                Arc::new(Drag::new(Arc::clone(atmosphere), surfaces.told_on(py, model, "drag")?))
            }
            Kind::RadiationPressure { surfaces, flux, earth_radius } => {
                let light = RadiationPressure::new(surfaces.told_on(py, model, "radiation pressure")?)
                    .with_flux(*flux)
                    .and_then(|light| light.with_shadow(*earth_radius))
                    .map_err(|error| error.into_python(py))?;
                Arc::new(light)
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
    fn new(py: Python<'_>) -> PyResult<PyClassInitializer<Self>> {
        let effect = PyEffect::made(Kind::GravityGradient, "GravityGradient", &PyDict::new(py))?;
        Ok(effect.add_subclass(Self))
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
        let keywords = fields!(py, "body": body.name());
        Ok(PyEffect::made(Kind::ThirdBody(body), "ThirdBody", &keywords)?.add_subclass(Self { body }))
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
        let keywords = fields!(py, "body": &body, "start": start, "end": end);
        let (start, end) = (start.unwrap_or(f64::NEG_INFINITY), end.unwrap_or(f64::INFINITY));
        let vector = |value: Option<Any<'_, '_>>, name| {
            Ok::<_, PyErr>(Vector3::from(value.map_or(Ok([0.0; 3]), |value| fixed::<3>(value, name, &[3]))?))
        };
        let (force, torque) = (vector(force, "force")?, vector(torque, "torque")?);
        // times are wrong or right for any body
        BodyWrench::new(0, force, torque)
            .and_then(|wrench| wrench.during(start, end))
            .map_err(|error| error.into_python(py))?;
        keywords.set_item("force", force.as_slice())?;
        keywords.set_item("torque", torque.as_slice())?;
        let kind = Kind::BodyWrench { frame: body, force, torque, start, end };
        Ok(PyEffect::made(kind, "BodyWrench", &keywords)?.add_subclass(Self))
    }
}

/// Drag of air that turns with the Earth, ``-½ ρ C_D A (n·u)₊ u`` on every face, with its torque; needs an orbit and an earth.
///
/// ``u`` is the velocity of the face's centroid in the air, a cannonball's that of the centre of mass. ``surfaces`` is ``Faces`` (the default,
/// with C_D 2.2: those of the robot's visual geometry), one surface for a robot of one body, or a dict of them by link; links left out
/// feel nothing. The density is computed on a grid of 128 m and follows the scale height from there: within 160 m wrong by at most 1e-4.
#[pyclass(name = "Drag", extends = PyEffect, frozen, module = "onorbit_rs")]
pub(crate) struct PyDrag;

#[pymethods]
impl PyDrag {
    #[new]
    #[pyo3(signature = (atmosphere, *, surfaces=None))]
    fn new(
        atmosphere: &Bound<'_, PyAtmosphere>,
        surfaces: Option<Any<'_, '_>>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let keywords = fields!(atmosphere.py(), "atmosphere": atmosphere, "surfaces": kept(surfaces)?);
        let atmosphere = Arc::clone(&atmosphere.get().air);
        let kind = Kind::Drag { atmosphere, surfaces: Spread::new(surfaces)? };
        Ok(PyEffect::made(kind, "Drag", &keywords)?.add_subclass(Self))
    }
}

/// The push of sunlight on every face, with its torque, and the Earth's shadow; needs an orbit and an earth with an epoch.
///
/// ``F = -P A cos θ [(1 - ρs) ŝ + 2 (ρs cos θ + ρd/3) n]``, a cannonball's ``-P C_R A ŝ``; ``P = ν (flux/c) (1 au/d)²``. ``flux`` is W/m² at
/// 1 au, ``surfaces`` as for ``Drag``. ``ν`` is the free share of the Sun's disc behind an Earth of ``earth_radius`` m: umbra, penumbra
/// and full light; ``shadow=False`` leaves it out. Light from the Earth is left out.
#[pyclass(name = "RadiationPressure", extends = PyEffect, frozen, module = "onorbit_rs")]
pub(crate) struct PyRadiationPressure;

#[pymethods]
impl PyRadiationPressure {
    #[new]
    #[pyo3(signature = (*, surfaces=None, flux=SOLAR_FLUX, shadow=true, earth_radius=SHADOW_RADIUS))]
    fn new(
        py: Python<'_>,
        surfaces: Option<Any<'_, '_>>,
        flux: f64,
        shadow: bool,
        earth_radius: f64,
    ) -> PyResult<PyClassInitializer<Self>> {
        RadiationPressure::check(flux, earth_radius).map_err(|error| error.into_python(py))?;
        let keywords = fields!(py, "flux": flux, "shadow": shadow, "earth_radius": earth_radius);
        keywords.set_item("surfaces", kept(surfaces)?)?;
        let earth_radius = shadow.then_some(earth_radius);
        let kind = Kind::RadiationPressure { surfaces: Spread::new(surfaces)?, flux, earth_radius };
        Ok(PyEffect::made(kind, "RadiationPressure", &keywords)?.add_subclass(Self))
    }
}
