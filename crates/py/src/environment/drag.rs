//! Atmospheric drag.

use super::atmosphere::PyAtmosphere;
use super::surfaces::{SurfaceAssignment, copied};
use super::{Any, Kind, PyEffect};
use crate::errors::fields;
use pyo3::prelude::*;
use std::sync::Arc;

/// Drag on every face in an atmosphere that rotates with the Earth, and the resulting torque.
///
/// The force on a face is ``-½ ρ C_D A (n·u)₊ u``, where ``C_D`` is the drag coefficient, ``A`` the area of
/// the face, ``n`` its outward normal, ``u`` the velocity of its centroid relative to the atmosphere, and
/// ``(n·u)₊`` is ``max(n·u, 0)``. The force on a cannonball is ``-½ ρ C_D A |u| u`` at its centre of mass.
/// The effect requires an orbit and an ``earth``. The density ``ρ`` is computed at the point of a grid with a
/// spacing of 128 m that is nearest to the base, and is extrapolated from there with the scale height over at
/// most 160 m; the relative error is at most 1e-4 where the model is smooth. At larger distances, the model
/// is evaluated at each body.
///
/// Parameters
/// ----------
/// atmosphere : Atmosphere
///     Model of the density.
/// surfaces : Surface or dict of str to Surface, optional
///     Surfaces of the bodies: ``Faces`` for all bodies, any surface for a robot with a single body, or a
///     dict by link or frame, in which bodies that are not listed have no drag. In a world of several systems
///     the keys are ``SYSTEM/LINK``, or ``SYSTEM`` for all bodies of that system. Default: the surfaces of
///     each ``System`` or, if none are given, ``Faces()``: the visual geometry with C_D = 2.2. Bodies without
///     visual geometry then have no drag, and a warning is issued.
///
/// Raises
/// ------
/// EffectError, DtypeError
///     If the dict of surfaces is empty, or a value is not a surface.
#[pyclass(name = "Drag", extends = PyEffect, frozen, module = "onorbit_rs")]
pub(super) struct PyDrag;

#[pymethods]
impl PyDrag {
    #[new]
    #[pyo3(signature = (atmosphere, *, surfaces=None))]
    fn new(
        atmosphere: &Bound<'_, PyAtmosphere>,
        surfaces: Option<Any<'_, '_>>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let keywords = fields!(atmosphere.py(), "atmosphere": atmosphere, "surfaces": copied(surfaces)?);
        let atmosphere = Arc::clone(&atmosphere.get().atmosphere);
        let kind = Kind::Drag { atmosphere, surfaces: SurfaceAssignment::new(surfaces)? };
        Ok(PyEffect::new(kind, "Drag", &keywords)?.add_subclass(Self))
    }
}
