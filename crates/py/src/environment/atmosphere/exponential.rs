//! Exponential atmosphere.

use super::PyAtmosphere;
use crate::errors::{IntoPython, fields, raise};
use onorbit_core::environment::atmosphere::{ExponentialAtmosphere, Layer};
use pyo3::prelude::*;

/// Atmosphere whose density decreases exponentially with altitude.
///
/// Without arguments, the atmosphere has the 28 layers of Vallado's table 8-4 (2013) for moderate solar
/// activity; the lowest begins at 0 km, and the highest at 1000 km has no upper bound.
///
/// Parameters
/// ----------
/// density : float, optional
///     Density at ``altitude``, kg/m³.
/// altitude : float, optional
///     Reference altitude above WGS84, m.
/// scale_height : float, optional
///     Altitude difference over which the density decreases by the factor e, m.
///
/// Raises
/// ------
/// EffectError
///     If only some of the arguments are given, or an argument is outside its range.
#[pyclass(name = "ExponentialAtmosphere", extends = PyAtmosphere, frozen, module = "onorbit_rs")]
pub(super) struct PyExponentialAtmosphere;

#[pymethods]
impl PyExponentialAtmosphere {
    #[new]
    #[pyo3(signature = (*, density=None, altitude=None, scale_height=None))]
    fn new(
        py: Python<'_>,
        density: Option<f64>,
        altitude: Option<f64>,
        scale_height: Option<f64>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let atmosphere = match (density, altitude, scale_height) {
            (None, None, None) => Ok(ExponentialAtmosphere::table()),
            (Some(density), Some(base), Some(scale_height)) => {
                ExponentialAtmosphere::new(vec![Layer { base, density, scale_height }])
            }
            _ => {
                let message = "only some of density, altitude and scale_height are given; give all three, or \
                               none of them to use the table of layers";
                return Err(raise(
                    py,
                    "EffectError",
                    message,
                    &fields!(py, "name": "density, altitude, scale_height"),
                ));
            }
        };
        let atmosphere = atmosphere.map_err(|error| error.into_python(py))?;
        let keywords = fields!(py, "density": density, "altitude": altitude, "scale_height": scale_height);
        Ok(PyAtmosphere::new(atmosphere, "ExponentialAtmosphere", &keywords)?.add_subclass(Self))
    }
}
