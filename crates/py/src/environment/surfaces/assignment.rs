//! Assignment of surfaces to the bodies of a robot.

use super::{Any, PySurface, SurfaceKind};
use crate::arrays::type_name;
use crate::errors::{IntoPython, fields, raise};
use onorbit_core::environment::surfaces::{Optics, SurfaceError, Surfaces};
use onorbit_core::model::Model;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyMapping};

/// Assignment of surfaces to bodies.
pub(crate) enum SurfaceAssignment {
    All(SurfaceKind),
    Named(Vec<(String, SurfaceKind)>),
}

impl SurfaceAssignment {
    /// Reads ``None``, one surface, or a mapping from names to surfaces.
    pub(crate) fn new(surfaces: Option<Any<'_, '_>>) -> PyResult<Self> {
        let Some(surfaces) = surfaces else {
            let optics = Optics::default();
            return Ok(Self::All(SurfaceKind::Faces { drag_coefficient: 2.2, optics }));
        };
        let kind = |value: Any<'_, '_>| match value.cast::<PySurface>() {
            Ok(surface) => Ok(surface.get().kind.clone()),
            Err(_) => {
                let got = type_name(value);
                let message = format!(
                    "surfaces holds {got}; expected Faces, Plates or Cannonball, or a dict of them by body"
                );
                Err(raise(
                    value.py(),
                    "DtypeError",
                    &message,
                    &fields!(value.py(), "name": "surfaces", "got": got),
                ))
            }
        };
        match surfaces.cast::<PyMapping>() {
            Ok(named) if named.is_empty()? => Err(SurfaceError::NoSurfaces.into_python(surfaces.py())),
            Ok(named) => {
                let entry = |item: Bound<'_, PyAny>| {
                    let (name, value): (String, Bound<'_, PyAny>) = item.extract()?;
                    Ok((name, kind(&value)?))
                };
                Ok(Self::Named(named.items()?.iter().map(entry).collect::<PyResult<_>>()?))
            }
            Err(_) => kind(surfaces).map(Self::All),
        }
    }

    /// Returns the surfaces on a given robot; warns if bodies without visual geometry have no faces.
    pub(crate) fn on_with_warning(&self, py: Python<'_>, model: &Model, effect: &str) -> PyResult<Surfaces> {
        let surfaces = self.on(py, model)?;
        let bare = if matches!(self, Self::All(SurfaceKind::Faces { .. })) {
            surfaces.uncovered(model)
        } else {
            vec![]
        };
        if !bare.is_empty() {
            let bodies = bare.join(", ");
            let message = format!(
                "{effect} does not act on bodies without visual geometry: {bodies}; assign surfaces to these \
                 bodies by name, or add visual shapes to their links"
            );
            py.import("warnings")?.call_method1("warn", (message,))?;
        }
        Ok(surfaces)
    }

    /// Returns the surfaces on a given robot.
    fn on(&self, py: Python<'_>, model: &Model) -> PyResult<Surfaces> {
        let count = model.nodes().len();
        let coverings = match self {
            Self::All(SurfaceKind::Faces { drag_coefficient, optics }) => {
                let surfaces = Surfaces::from_shapes(model, *drag_coefficient, *optics);
                return surfaces.map_err(|error| error.into_python(py));
            }
            Self::All(kind) if count == 1 => {
                let base = model.frame(&model.body_frame(0).name).map_err(|error| error.into_python(py))?;
                vec![kind.on(py, model, base)?]
            }
            Self::All(_) => {
                let message = format!(
                    "the robot has {count} bodies; name the one with this surface, such as \
                     surfaces={{'{0}': …}} (in YAML bodies: \
                     {{{0}: …}})",
                    model.body_frame(0).name
                );
                return Err(raise(py, "EffectError", &message, &fields!(py, "name": "surfaces")));
            }
            Self::Named(named) => named
                .iter()
                .map(|(name, kind)| {
                    let frame = model.frame(name).map_err(|error| error.into_python(py))?;
                    kind.on(py, model, frame)
                })
                .collect::<PyResult<_>>()?,
        };
        Surfaces::new(coverings, &[count]).map_err(|error| error.into_python(py))
    }
}

/// Returns a copy of the surfaces, because a dict may be modified later.
pub(crate) fn copied<'py>(surfaces: Option<Any<'_, 'py>>) -> PyResult<Option<Bound<'py, PyAny>>> {
    let Some(surfaces) = surfaces else { return Ok(None) };
    Ok(Some(match surfaces.cast::<PyMapping>() {
        Ok(named) => PyDict::from_sequence(named.items()?.as_any())?.into_any(),
        Err(_) => surfaces.clone(),
    }))
}
