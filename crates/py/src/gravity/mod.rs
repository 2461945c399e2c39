//! Gravity of a run: the point mass of the planet, and the gravity effects of its environment.

mod field;
mod third_body;

use crate::environment::PyEffect;
use crate::errors::{IntoPython, plain};
use onorbit_core::earth::{Earth, EarthError};
use onorbit_core::gravity::Gravity;
use pyo3::prelude::*;
use std::sync::Arc;

type Any<'a, 'py> = &'a Bound<'py, PyAny>;

pub(crate) fn add_classes(m: &Bound<'_, PyModule>) -> PyResult<()> {
    m.add_class::<field::PyGravityField>()?;
    m.add_class::<third_body::PyThirdBody>()
}

/// Returns the gravity of the run: its gravity effects and the point mass of the planet, with the `mu` of the
/// gravity field or, without a field, of the orbit, m³/s². Returns `None` if there are no gravity effects.
pub(crate) fn gravity_of(
    py: Python<'_>,
    effects: &[Bound<'_, PyEffect>],
    mu: Option<f64>,
    earth: Option<&Arc<Earth>>,
) -> PyResult<Option<Gravity>> {
    let fields: Vec<_> = effects.iter().filter_map(|effect| effect.get().field()).collect();
    if fields.len() > 1 {
        let names: Vec<&str> = fields.iter().map(|field| field.name()).collect();
        let message =
            format!("{} gravity fields are given: {}; give only one", fields.len(), names.join(", "));
        return Err(plain(py, "GravityError", &message));
    }
    let field = fields.first().copied();
    let bodies: Vec<_> = effects.iter().filter_map(|effect| effect.get().luminary()).collect();
    let gravity = match (field, mu) {
        (Some(field), mu) => {
            let gravity = Gravity::of_field(Arc::clone(field), earth.cloned());
            gravity.and_then(|gravity| mu.map_or(Ok(()), |mu| gravity.check_orbit(mu)).map(|()| gravity))
        }
        (None, _) if bodies.is_empty() => return Ok(None),
        (None, Some(mu)) => Ok(Gravity::point_mass(mu)),
        (None, None) => {
            let message = "a third body is given without an orbit around a planet; set an orbit, or the mu \
                           of a custom path";
            return Err(plain(py, "OrbitError", message));
        }
    };
    let with_bodies = gravity.and_then(|gravity| {
        bodies.iter().try_fold(gravity, |gravity, body| {
            let earth = earth.ok_or(EarthError::NeedsEpoch { what: "the gravity of a third body" })?;
            gravity.with(*body, earth)
        })
    });
    with_bodies.map(Some).map_err(|error| error.into_python(py))
}
