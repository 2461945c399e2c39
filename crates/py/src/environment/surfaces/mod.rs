//! Surfaces of bodies for drag and radiation pressure. They are assigned to a robot when the simulation is
//! constructed.

mod assignment;
mod cannonball;
mod faces;
mod plates;

pub(crate) use assignment::SurfaceAssignment;
pub(super) use assignment::copied;

use crate::errors::IntoPython;
use crate::pickling::{ConstructorCall, Reduced};
use onorbit_core::environment::BodyIndex;
use onorbit_core::environment::surfaces::{Covering, Optics, Surface};
use onorbit_core::model::Model;
use pyo3::prelude::*;
use pyo3::types::PyDict;

type Any<'a, 'py> = &'a Bound<'py, PyAny>;

pub(super) fn add_classes(m: &Bound<'_, PyModule>) -> PyResult<()> {
    m.add_class::<PySurface>()?;
    m.add_class::<cannonball::PyCannonball>()?;
    m.add_class::<faces::PyFaces>()?;
    m.add_class::<plates::PyPlates>()
}

/// Base class of the surfaces of bodies for ``Drag`` and ``RadiationPressure``.
#[pyclass(name = "Surface", subclass, frozen, module = "onorbit_rs")]
struct PySurface {
    kind: SurfaceKind,
    constructor_call: ConstructorCall,
}

#[pymethods]
impl PySurface {
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        self.constructor_call.reduce(py)
    }
}

impl PySurface {
    /// Creates the base object of a surface, with the class and keywords used to pickle it.
    fn new(
        kind: SurfaceKind,
        class: &str,
        keywords: &Bound<'_, PyDict>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let constructor_call = ConstructorCall::with_keywords(class, keywords)?;
        Ok(PyClassInitializer::from(Self { kind, constructor_call }))
    }
}

/// Surface that is not yet assigned to a robot.
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
    /// Returns the surface on the body to which a frame is fixed. `frame` is the index of the frame in
    /// `model`, and `system` the index of the system.
    fn on(&self, py: Python<'_>, (system, model): (usize, &Model), frame: usize) -> PyResult<Covering> {
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
        let body = BodyIndex { system, body: frame.body };
        Ok(Covering { body, surface: surface.map_err(|error| error.into_python(py))? })
    }
}

/// Checks the fractions of specularly and diffusely reflected light, and returns the optical coefficients.
fn optics(py: Python<'_>, specular: f64, diffuse: f64) -> PyResult<Optics> {
    Optics::new(specular, diffuse).map_err(|error| error.into_python(py))
}
