//! Gravity of the Sun and the Moon.

use crate::environment::{Kind, PyEffect};
use crate::errors::{fields, raise};
use onorbit_core::gravity::Luminary;
use pyo3::prelude::*;

/// Gravity of the Sun or the Moon, as a perturbation of the motion around the Earth.
///
/// The acceleration at the position ``r``, relative to that of the Earth's centre, is ``μ [(s - r)/|s - r|³ -
/// s/|s|³]``. ``μ`` is the gravitational parameter of the third body and ``s`` its position; both positions
/// are from the Earth's centre.
///
/// The effect requires an orbit around the Earth, and an ``earth`` with an epoch.
///
/// Parameters
/// ----------
/// body : {"sun", "moon"}
///     Name of the third body.
///
/// Raises
/// ------
/// EffectError
///     If ``body`` is any other name.
#[pyclass(name = "ThirdBody", extends = PyEffect, frozen, module = "onorbit_rs")]
pub(super) struct PyThirdBody {
    body: Luminary,
}

#[pymethods]
impl PyThirdBody {
    #[new]
    fn new(py: Python<'_>, body: &str) -> PyResult<PyClassInitializer<Self>> {
        let Some(body) = Luminary::ALL.into_iter().find(|known| known.name() == body) else {
            let message = format!("body is '{body}'; the choices are 'sun' and 'moon'");
            return Err(raise(py, "EffectError", &message, &fields!(py, "name": "body", "got": body)));
        };
        let keywords = fields!(py, "body": body.name());
        Ok(PyEffect::new(Kind::ThirdBody(body), "ThirdBody", &keywords)?.add_subclass(Self { body }))
    }

    /// Name of the third body, ``sun`` or ``moon``.
    #[getter]
    fn body(&self) -> &'static str {
        self.body.name()
    }

    /// Gravitational parameter of the third body, m³/s².
    #[getter]
    fn mu(&self) -> f64 {
        self.body.mu()
    }

    fn __repr__(&self) -> String {
        format!("ThirdBody('{}')", self.body.name())
    }
}
