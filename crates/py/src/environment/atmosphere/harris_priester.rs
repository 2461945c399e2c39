//! Harris-Priester atmosphere.

use super::PyAtmosphere;
use crate::errors::{IntoPython, fields};
use onorbit_core::environment::atmosphere::HarrisPriester;
use pyo3::prelude::*;

/// Harris-Priester atmosphere from 100 to 1000 km for mean solar activity.
///
/// The density is ``ρm + (ρM - ρm) cosⁿ(ψ/2)``, with ψ the angle from the apex of the diurnal bulge, ``ρM``
/// the density at the apex and ``ρm`` that opposite it. The model requires an ``earth`` with an epoch, and
/// raises ``EffectError`` outside its range of altitudes.
///
/// Parameters
/// ----------
/// exponent : float
///     ``n``: from 2 for low inclinations to 6 for polar orbits.
/// lag : float
///     Angle by which the bulge follows the Sun to the east, rad.
#[pyclass(name = "HarrisPriester", extends = PyAtmosphere, frozen, module = "onorbit_rs")]
pub(super) struct PyHarrisPriester;

#[pymethods]
impl PyHarrisPriester {
    #[new]
    #[pyo3(signature = (*, exponent=4.0, lag=std::f64::consts::FRAC_PI_6))]
    fn new(py: Python<'_>, exponent: f64, lag: f64) -> PyResult<PyClassInitializer<Self>> {
        let atmosphere = HarrisPriester::new(exponent, lag).map_err(|error| error.into_python(py))?;
        let keywords = fields!(py, "exponent": exponent, "lag": lag);
        Ok(PyAtmosphere::new(atmosphere, "HarrisPriester", &keywords)?.add_subclass(Self))
    }
}
