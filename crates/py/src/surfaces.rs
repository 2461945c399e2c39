//! What bodies show to wind and light; bound to a robot when the simulation is made.

use crate::arrays::{Input, type_name, wrong_shape};
use crate::errors::{IntoPython, fields, raise};
use crate::made::Made;
use onorbit_core::environment::surfaces::{Covering, Optics, Surface, SurfaceError, Surfaces};
use onorbit_core::model::Model;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyMapping, PyTuple};

type Any<'a, 'py> = &'a Bound<'py, PyAny>;

/// What a body shows to wind and light; given to ``Drag`` and ``RadiationPressure``.
#[pyclass(name = "Surface", subclass, frozen, module = "onorbit_rs")]
pub(crate) struct PySurface {
    kind: SurfaceKind,
    made: Made,
}

#[pymethods]
impl PySurface {
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, Py<PyTuple>)> {
        self.made.again(py)
    }
}

/// Surfaces as they are now: a dict of them may change later.
pub(crate) fn kept<'py>(surfaces: Option<Any<'_, 'py>>) -> PyResult<Option<Bound<'py, PyAny>>> {
    let Some(surfaces) = surfaces else { return Ok(None) };
    Ok(Some(match surfaces.cast::<PyMapping>() {
        Ok(named) => PyDict::from_sequence(named.items()?.as_any())?.into_any(),
        Err(_) => surfaces.clone(),
    }))
}

/// A surface before it is on a robot.
#[derive(Clone)]
pub(crate) enum SurfaceKind {
    Cannonball {
        area: f64,
        drag_coefficient: f64,
        reflectivity: f64,
    },
    Faces {
        drag_coefficient: f64,
        optics: Optics,
    },
    Plates {
        areas: Vec<f64>,
        normals: Vec<[f64; 3]>,
        centroids: Vec<[f64; 3]>,
        drag_coefficient: f64,
        optics: Optics,
    },
}

impl SurfaceKind {
    /// The surface of the body that `frame` is fixed to.
    fn on(&self, py: Python<'_>, model: &Model, frame: usize) -> PyResult<Covering> {
        let frame = &model.frames()[frame];
        let surface = match self {
            Self::Cannonball { area, drag_coefficient, reflectivity } => {
                Surface::cannonball(*area, *drag_coefficient, *reflectivity)
            }
            Self::Faces { drag_coefficient, optics } => {
                Surface::from_shapes(model, frame.body, *drag_coefficient, *optics)
            }
            Self::Plates { areas, normals, centroids, drag_coefficient, optics } => {
                Surface::plates(model, frame, areas, normals, centroids, *drag_coefficient, *optics)
            }
        };
        Ok(Covering { body: frame.body, surface: surface.map_err(|error| error.into_python(py))? })
    }
}

/// Which body shows what.
pub(crate) enum Spread {
    All(SurfaceKind),
    Named(Vec<(String, SurfaceKind)>),
}

impl Spread {
    /// From ``None``, one surface, or a mapping from names to surfaces.
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
                    "surfaces holds {got}; Faces, Plates or Cannonball is needed, or a dict of them by body"
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
            Ok(named) if named.is_empty()? => Err(SurfaceError::Nothing.into_python(surfaces.py())),
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

    /// As [`Spread::on`], with a warning where the faces of the whole robot leave bodies out.
    pub(crate) fn told_on(&self, py: Python<'_>, model: &Model, effect: &str) -> PyResult<Surfaces> {
        let surfaces = self.on(py, model)?;
        let bare =
            if matches!(self, Self::All(SurfaceKind::Faces { .. })) { surfaces.bare(model) } else { vec![] };
        if !bare.is_empty() {
            let bodies = bare.join(", ");
            let message = format!(
                "{effect} does not act on {bodies}: no visual geometry to take faces from; cover each body by name, or \
                 give the links shapes"
            );
            py.import("warnings")?.call_method1("warn", (message,))?;
        }
        Ok(surfaces)
    }

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
                    "the robot has {count} bodies: say which one shows this surface, such as surfaces={{'{0}': …}} (in YAML bodies: \
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
        Surfaces::new(coverings, count).map_err(|error| error.into_python(py))
    }
}

fn optics(py: Python<'_>, specular: f64, diffuse: f64) -> PyResult<Optics> {
    Optics::new(specular, diffuse).map_err(|error| error.into_python(py))
}

/// The same from all sides, at the centre of mass, so without torque: ``area`` m² across the stream, ``drag_coefficient`` C_D and
/// ``reflectivity`` C_R (1 absorbs all light, 2 is a flat mirror that faces the Sun).
#[pyclass(name = "Cannonball", extends = PySurface, frozen, module = "onorbit_rs")]
pub(crate) struct PyCannonball;

#[pymethods]
impl PyCannonball {
    #[new]
    #[pyo3(signature = (area, *, drag_coefficient=2.2, reflectivity=1.0))]
    fn new(
        py: Python<'_>,
        area: f64,
        drag_coefficient: f64,
        reflectivity: f64,
    ) -> PyResult<PyClassInitializer<Self>> {
        Surface::cannonball(area, drag_coefficient, reflectivity).map_err(|error| error.into_python(py))?;
        let keywords =
            fields!(py, "area": area, "drag_coefficient": drag_coefficient, "reflectivity": reflectivity);
        let kind = SurfaceKind::Cannonball { area, drag_coefficient, reflectivity };
        let made = Made::by("Cannonball", &keywords)?;
        Ok(PyClassInitializer::from(PySurface { kind, made }).add_subclass(Self))
    }
}

/// The faces of a link's visual geometry: boxes, cylinders and balls exactly, capsules to 2 %; meshes are refused.
///
/// Each face feels wind and light at its own angle and centroid, so that there is a torque; none shadows another. ``specular`` and
/// ``diffuse`` are the shares of light sent back as by a mirror and a matt wall, the rest is absorbed.
#[pyclass(name = "Faces", extends = PySurface, frozen, module = "onorbit_rs")]
pub(crate) struct PyFaces;

#[pymethods]
impl PyFaces {
    #[new]
    #[pyo3(signature = (*, drag_coefficient=2.2, specular=0.0, diffuse=0.0))]
    fn new(
        py: Python<'_>,
        drag_coefficient: f64,
        specular: f64,
        diffuse: f64,
    ) -> PyResult<PyClassInitializer<Self>> {
        Surface::cannonball(0.0, drag_coefficient, 0.0).map_err(|error| error.into_python(py))?;
        let kind = SurfaceKind::Faces { drag_coefficient, optics: optics(py, specular, diffuse)? };
        let keywords =
            fields!(py, "drag_coefficient": drag_coefficient, "specular": specular, "diffuse": diffuse);
        let made = Made::by("Faces", &keywords)?;
        Ok(PyClassInitializer::from(PySurface { kind, made }).add_subclass(Self))
    }
}

/// Flat plates, each seen from the side of its normal: ``areas`` (N,) m², ``normals`` (N, 3) of any length and ``centroids`` (N, 3) m in
/// the axes and from the origin of the link or frame they are given to; a thin panel is two of them. Coefficients as ``Faces``.
#[pyclass(name = "Plates", extends = PySurface, frozen, module = "onorbit_rs")]
pub(crate) struct PyPlates;

#[pymethods]
impl PyPlates {
    #[new]
    #[pyo3(signature = (areas, normals, centroids, *, drag_coefficient=2.2, specular=0.0, diffuse=0.0))]
    fn new(
        py: Python<'_>,
        areas: Any<'_, '_>,
        normals: Any<'_, '_>,
        centroids: Any<'_, '_>,
        drag_coefficient: f64,
        specular: f64,
        diffuse: f64,
    ) -> PyResult<PyClassInitializer<Self>> {
        let areas = Input::new(areas, "areas")?;
        if areas.shape().len() != 1 {
            return Err(wrong_shape(py, "areas", "(N,)", areas.shape()));
        }
        let (normals, centroids) = (rows(normals, "normals")?, rows(centroids, "centroids")?);
        let keywords =
            fields!(py, "drag_coefficient": drag_coefficient, "specular": specular, "diffuse": diffuse);
        keywords.set_item("areas", areas.data())?;
        keywords.set_item("normals", normals.clone())?;
        keywords.set_item("centroids", centroids.clone())?;
        let (areas, optics) = (areas.data().to_vec(), optics(py, specular, diffuse)?);
        // plates are wrong or right on any robot
        let model =
            Model::rigid_body(1.0, nalgebra::Matrix3::identity()).map_err(|error| error.into_python(py))?;
        let kind = SurfaceKind::Plates { areas, normals, centroids, drag_coefficient, optics };
        kind.on(py, &model, 0)?;
        let made = Made::by("Plates", &keywords)?;
        Ok(PyClassInitializer::from(PySurface { kind, made }).add_subclass(Self))
    }
}

/// `(N, 3)`.
fn rows(value: Any<'_, '_>, name: &str) -> PyResult<Vec<[f64; 3]>> {
    let input = Input::new(value, name)?;
    match input.shape() {
        [_, 3] => Ok(input.data().chunks_exact(3).map(|row| [row[0], row[1], row[2]]).collect()),
        other => Err(wrong_shape(value.py(), name, "(N, 3)", other)),
    }
}

pub(crate) fn add_classes(m: &Bound<'_, PyModule>) -> PyResult<()> {
    m.add_class::<PySurface>()?;
    m.add_class::<PyCannonball>()?;
    m.add_class::<PyFaces>()?;
    m.add_class::<PyPlates>()
}
