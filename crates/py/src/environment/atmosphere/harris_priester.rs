//! Harris-Priester atmosphere.

use super::PyAtmosphere;
use crate::errors::{IntoPython, fields};
use onorbit_core::environment::atmosphere::HarrisPriester;
use pyo3::prelude::*;

/// Harris-Priester atmosphere from 100 to 1000 km for mean solar activity.
///
/// The density is ``ρm + (ρM - ρm) cosⁿ(ψ/2)``, where ψ is the angle from the apex of the diurnal bulge,
/// ``ρM`` the density at the apex and ``ρm`` the density on the opposite side. The model requires an
/// ``earth`` with an epoch, and raises ``EffectError`` below 100 km and above 1000 km.
///
/// Parameters
/// ----------
/// exponent : float
///     Exponent ``n``: from 2 for low inclinations to 6 for polar orbits.
/// lag : float
///     Angle by which the apex of the bulge lies east of the Sun, rad.
///
/// Raises
/// ------
/// EffectError
///     If ``exponent`` is not between 2 and 6, or ``lag`` is not between -π and π.
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
