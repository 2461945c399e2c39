//! Radiation pressure of sunlight.

use super::surfaces::{SurfaceAssignment, copied};
use super::{Any, Kind, PyEffect};
use crate::errors::{IntoPython, fields};
use onorbit_core::environment::{RadiationPressure, SHADOW_RADIUS, SOLAR_FLUX};
use pyo3::prelude::*;

/// Radiation pressure of sunlight on every face, with the resulting torque and the Earth's shadow.
///
/// The force on a sunlit face with area ``A``, outward normal ``n`` and fractions ``ρs`` and ``ρd`` of
/// specular and diffuse reflection is ``-P A cos θ [(1 - ρs) ŝ + 2 (ρs cos θ + ρd/3) n]``, with ``cos θ =
/// n·ŝ``. The force on a cannonball with the coefficient ``C_R`` is ``-P C_R A ŝ``. The unit vector ``ŝ``
/// points to the Sun. ``P = ν (flux/c) (1 au/d)²`` is the pressure, with the speed of light ``c``, the
/// distance ``d`` from the Sun and the fraction ``ν`` of the solar disc that the Earth does not occult. Light
/// reflected or emitted by the Earth is neglected. The effect requires an orbit and an ``earth`` with an
/// epoch.
///
/// Parameters
/// ----------
/// surfaces : Surface or dict of str to Surface, optional
///     Surfaces of the bodies, as for ``Drag``.
/// flux : float
///     Solar flux at 1 au, W/m².
/// shadow : bool
///     If False, the shadow of the Earth (umbra and penumbra) is neglected.
/// earth_radius : float
///     Radius of the Earth used for its shadow, m.
///
/// Raises
/// ------
/// EffectError, DtypeError
///     If a number is outside its range, the dict of surfaces is empty, or a value is not a surface.
#[pyclass(name = "RadiationPressure", extends = PyEffect, frozen, module = "onorbit_rs")]
pub(super) struct PyRadiationPressure;

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
        keywords.set_item("surfaces", copied(surfaces)?)?;
        let earth_radius = shadow.then_some(earth_radius);
        let kind =
            Kind::RadiationPressure { surfaces: SurfaceAssignment::new(surfaces)?, flux, earth_radius };
        Ok(PyEffect::new(kind, "RadiationPressure", &keywords)?.add_subclass(Self))
    }
}
