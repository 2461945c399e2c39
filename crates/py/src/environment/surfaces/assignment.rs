//! Assignment of surfaces to the bodies of systems.

use super::{Any, PySurface, SurfaceKind};
use crate::arrays::type_name;
use crate::environment::target::{self, Target};
use crate::errors::{IntoPython, fields, raise};
use onorbit_core::environment::surfaces::{Covering, Optics, SurfaceError, Surfaces};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyMapping};

/// Assignment of surfaces to bodies.
pub(crate) enum SurfaceAssignment {
    /// Surfaces that were declared with each system, or else the faces of its visual geometry.
    Declared,
    All(SurfaceKind),
    Named(Vec<(String, SurfaceKind)>),
}

impl SurfaceAssignment {
    /// Reads ``None``, one surface, or a dict from names to surfaces.
    pub(crate) fn new(surfaces: Option<Any<'_, '_>>) -> PyResult<Self> {
        let Some(surfaces) = surfaces else { return Ok(Self::Declared) };
        let kind = |value: Any<'_, '_>| match value.cast::<PySurface>() {
            Ok(surface) => Ok(surface.get().kind.clone()),
            Err(_) => {
                let got = type_name(value);
                let message = format!(
                    "a surface is of type {got}; expected Faces, Plates or Cannonball, or a dict \
                     from names of bodies to these"
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

    /// Returns the surfaces on the given systems. If bodies have no faces because they have no visual
    /// geometry, a warning lists them. It is an error if no body of any system has a surface.
    pub(crate) fn on_with_warning(
        &self,
        py: Python<'_>,
        targets: &[Target<'_>],
        effect: &str,
    ) -> PyResult<Surfaces> {
        let (mut coverings, mut by_shape) = (Vec::new(), Vec::new());
        for (system, target) in targets.iter().enumerate() {
            let (own, is_by_shape) = self.on_system(py, targets, system)?;
            coverings.extend(own);
            by_shape.extend(is_by_shape.then_some((system, target)));
        }
        if coverings.is_empty() && targets.len() == 1 {
            let body = "the robot".to_owned();
            return Err(SurfaceError::NoShape { body }.into_python(py));
        }
        let counts: Vec<usize> = targets.iter().map(|target| target.model.nodes().len()).collect();
        let surfaces = Surfaces::new(coverings, &counts).map_err(|error| error.into_python(py))?;
        let bare: Vec<String> = by_shape
            .into_iter()
            .flat_map(|(system, target)| {
                let path = move |body: &str| path_of(targets, target, body);
                surfaces.uncovered(system, target.model).into_iter().map(path)
            })
            .collect();
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

    /// Returns the surfaces on the system with this index, and true if they are the faces of all of its
    /// bodies.
    fn on_system(
        &self,
        py: Python<'_>,
        targets: &[Target<'_>],
        system: usize,
    ) -> PyResult<(Vec<Covering>, bool)> {
        let target = &targets[system];
        match self {
            Self::Declared => match target.surfaces {
                Some(own) => own.on_robot(py, targets, system),
                None => SurfaceKind::default().on_all(py, targets, system),
            },
            Self::Named(named) if targets.len() > 1 => {
                let (mut coverings, mut is_by_shape) = (Vec::new(), false);
                for (path, kind) in named {
                    if target::named(targets, path) == Some(system) {
                        let (all, is_faces) = kind.on_all(py, targets, system)?;
                        coverings.extend(all);
                        is_by_shape |= is_faces;
                    } else if target::named(targets, path).is_none() {
                        let (owner, frame) = target::frame_at(py, targets, path)?;
                        if owner == system {
                            coverings.push(kind.on(py, (system, target.model), frame)?);
                        }
                    }
                }
                Ok((coverings, is_by_shape))
            }
            Self::All(kind) if targets.len() > 1 && !kind.is_faces() => {
                let message = format!(
                    "surfaces is the surface of a single body, but the world has {} systems; name the system \
                     that has this surface, such as surfaces={{'{}': …}}",
                    targets.len(),
                    targets[0].name
                );
                Err(raise(py, "EffectError", &message, &fields!(py, "name": "surfaces")))
            }
            _ => self.on_robot(py, targets, system),
        }
    }

    /// Returns the surfaces on the system with this index, and true if they are the faces of all of its
    /// bodies. The keys of a dict are names of links, without the name of the system.
    pub(crate) fn on_robot(
        &self,
        py: Python<'_>,
        targets: &[Target<'_>],
        system: usize,
    ) -> PyResult<(Vec<Covering>, bool)> {
        match self {
            Self::Declared => SurfaceKind::default().on_all(py, targets, system),
            Self::All(kind) => kind.on_all(py, targets, system),
            Self::Named(named) => {
                let alone = &targets[system..=system];
                let covering = |(path, kind): &(String, SurfaceKind)| {
                    let (_, frame) = target::frame_at(py, alone, path)?;
                    kind.on(py, (system, alone[0].model), frame)
                };
                Ok((named.iter().map(covering).collect::<PyResult<_>>()?, false))
            }
        }
    }
}

impl Default for SurfaceKind {
    /// Returns the default surface of a body: the faces of its visual geometry.
    fn default() -> Self {
        Self::Faces { drag_coefficient: 2.2, optics: Optics::default() }
    }
}

impl SurfaceKind {
    fn is_faces(&self) -> bool {
        matches!(self, Self::Faces { .. })
    }

    /// Returns this surface on all bodies of a system, and true if the surface consists of their faces. Any
    /// other surface requires a robot with a single body.
    fn on_all(
        &self,
        py: Python<'_>,
        targets: &[Target<'_>],
        system: usize,
    ) -> PyResult<(Vec<Covering>, bool)> {
        let target @ Target { model, .. } = &targets[system];
        if let Self::Faces { drag_coefficient, optics } = self {
            let faces = Covering::from_shapes(system, model, *drag_coefficient, *optics);
            return Ok((faces.map_err(|error| error.into_python(py))?, true));
        }
        let (count, base) = (model.nodes().len(), &model.body_frame(0).name);
        if count == 1 {
            let frame = model.frame(base).map_err(|error| error.into_python(py))?;
            return Ok((vec![self.on(py, (system, model), frame)?], false));
        }
        let robot =
            if targets.len() == 1 { "the robot".to_owned() } else { format!("system '{}'", target.name) };
        let message = format!(
            "surfaces is the surface of a single body, but {robot} has {count} bodies; name the one with this \
             surface, such as surfaces={{'{0}': …}} (in YAML bodies: {{{0}: …}})",
            path_of(targets, target, base)
        );
        Err(raise(py, "EffectError", &message, &fields!(py, "name": "surfaces")))
    }
}

/// Returns the path `SYSTEM/BODY` of a body, or only its name if there is a single system.
fn path_of(targets: &[Target<'_>], target: &Target<'_>, body: &str) -> String {
    if targets.len() == 1 { body.to_owned() } else { format!("{}/{body}", target.name) }
}

/// Returns the given surfaces, if any; a dict is copied, because it may be modified later.
pub(crate) fn copied<'py>(surfaces: Option<Any<'_, 'py>>) -> PyResult<Option<Bound<'py, PyAny>>> {
    let Some(surfaces) = surfaces else { return Ok(None) };
    Ok(Some(match surfaces.cast::<PyMapping>() {
        Ok(named) => PyDict::from_sequence(named.items()?.as_any())?.into_any(),
        Err(_) => surfaces.clone(),
    }))
}
