//! The gravity of a run: its planet's field among the effects.

use crate::arrays::{Input, fresh, shape_text, whole, wrong_shape, zeros};
use crate::environment::PyEffect;
use crate::errors::{IntoPython, fields, plain, raise};
use crate::interrupt::{abandonable, in_pieces};
use onorbit_core::earth::{Earth, EarthError};
use onorbit_core::gravity::{Coefficients, Gravity, GravityError, GravityField};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use std::path::PathBuf;
use std::sync::Arc;

type Any<'a, 'py> = &'a Bound<'py, PyAny>;

/// What of these effects is gravity beside the point mass `mu` of the orbit's planet; none where nothing is.
pub(crate) fn gravity_of(
    py: Python<'_>,
    effects: &[Bound<'_, PyEffect>],
    mu: Option<f64>,
    earth: Option<&Arc<Earth>>,
) -> PyResult<Option<Gravity>> {
    let mut fields = effects.iter().filter_map(|effect| effect.get().field());
    let field = fields.next();
    if let (Some(field), Some(other)) = (field, fields.next()) {
        let message =
            format!("two gravity fields are given, {} and {}: a planet has one", field.name(), other.name());
        return Err(plain(py, "GravityError", &message));
    }
    let bodies: Vec<_> = effects.iter().filter_map(|effect| effect.get().luminary()).collect();
    let gravity = match (field, mu) {
        (Some(field), mu) => {
            let gravity = Gravity::of_field(Arc::clone(field), earth.cloned());
            gravity.and_then(|gravity| mu.map_or(Ok(()), |mu| gravity.check_orbit(mu)).map(|()| gravity))
        }
        (None, _) if bodies.is_empty() => return Ok(None),
        (None, Some(mu)) => Ok(Gravity::point_mass(mu)),
        (None, None) => {
            let message = "a third body needs an orbit around a planet: give one, or give the path its mu";
            return Err(plain(py, "OrbitError", message));
        }
    };
    let with_bodies = gravity.and_then(|gravity| {
        bodies.iter().try_fold(gravity, |gravity, body| {
            let earth = earth.ok_or(EarthError::NeedsEpoch { what: "the pull of a third body" })?;
            gravity.with(*body, earth)
        })
    });
    with_bodies.map(Some).map_err(|error| error.into_python(py))
}

/// A planet's gravity field: all of it but the point mass, whose ``mu`` it brings along.
///
/// ``model`` is ``egm2008`` (tide-free) or ``jgm3`` (with the permanent tide), both to degree and order 70; ``order`` is ``degree`` where not given. As one of
/// the effects of a simulation it acts on every body; the planet turns as the simulation's ``earth`` says. A field of
/// order 0 may do without, its axis is then z. Positions are from the planet's centre in axes fixed in the planet.
#[pyclass(name = "GravityField", extends = PyEffect, frozen, module = "onorbit_rs")]
pub(crate) struct PyGravityField {
    field: Arc<GravityField>,
    /// Constructor, arguments and keywords that make it again.
    made: Py<PyTuple>,
}

impl PyGravityField {
    fn wrap(
        py: Python<'_>,
        field: Result<GravityField, GravityError>,
        constructor: &str,
        keywords: &Bound<'_, PyDict>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let field = Arc::new(field.map_err(|error| error.into_python(py))?);
        let made = (constructor, PyTuple::empty(py), keywords).into_pyobject(py)?.unbind();
        let effect = PyEffect::of_field(Arc::clone(&field));
        Ok(PyClassInitializer::from(effect).add_subclass(Self { field, made }))
    }
}

#[pymethods]
impl PyGravityField {
    #[new]
    #[pyo3(signature = (model, *, degree=36, order=None))]
    fn new(
        py: Python<'_>,
        model: &str,
        #[pyo3(from_py_with = degree_of)] degree: usize,
        #[pyo3(from_py_with = order_of)] order: Option<usize>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let keywords = fields!(py, "model": model, "degree": degree, "order": order);
        Self::wrap(
            py,
            GravityField::bundled(model, degree, order.unwrap_or(degree)),
            "GravityField",
            &keywords,
        )
    }

    /// Zonal harmonics alone, in closed form: ``J2`` to ``J<degree>`` of the Earth (EGM2008), ``degree`` 2 to 6; or those in
    /// ``j``, ``J2`` and on, not normalised, of a planet with ``mu``, m³/s², for the reference ``radius``, m.
    #[staticmethod]
    #[pyo3(signature = (degree=None, *, j=None, mu=None, radius=None))]
    fn zonal<'py>(
        py: Python<'py>,
        #[pyo3(from_py_with = some_degree)] degree: Option<usize>,
        j: Option<Any<'_, 'py>>,
        mu: Option<f64>,
        radius: Option<f64>,
    ) -> PyResult<Bound<'py, Self>> {
        let (field, keywords) = match (degree, j, mu, radius) {
            (degree, None, None, None) => {
                let degree = degree.unwrap_or(6);
                (GravityField::zonal(degree), fields!(py, "degree": degree))
            }
            (None, Some(j), Some(mu), Some(radius)) => {
                let input = Input::new(j, "j")?;
                (
                    GravityField::zonals(mu, radius, input.data()),
                    fields!(py, "j": j, "mu": mu, "radius": radius),
                )
            }
            _ => {
                return Err(plain(
                    py,
                    "GravityError",
                    "give a degree, for the Earth, or all of j, mu and radius",
                ));
            }
        };
        Bound::new(py, Self::wrap(py, field, "GravityField.zonal", &keywords)?)
    }

    /// A model in a ``.gfc`` file (ICGEM), to the degree of the file where none is given.
    #[staticmethod]
    #[pyo3(signature = (path, *, degree=None, order=None))]
    fn from_gfc<'py>(
        py: Python<'py>,
        path: PathBuf,
        #[pyo3(from_py_with = some_degree)] degree: Option<usize>,
        #[pyo3(from_py_with = order_of)] order: Option<usize>,
    ) -> PyResult<Bound<'py, Self>> {
        let keywords = fields!(py, "path": &path, "degree": degree, "order": order);
        let field = abandonable(py, move || GravityField::from_gfc(&path, degree, order))?;
        Bound::new(py, Self::wrap(py, field, "GravityField.from_gfc", &keywords)?)
    }

    /// From fully normalised coefficients ``c`` and ``s``, both (n, n), ``c[degree, order]``; ``c[0, 0]`` is taken for 1.
    ///
    /// ``mu`` in m³/s², reference ``radius`` in m.
    #[staticmethod]
    #[pyo3(signature = (c, s, *, mu, radius, degree=None, order=None))]
    fn from_coefficients<'py>(
        py: Python<'py>,
        c: Any<'_, 'py>,
        s: Any<'_, 'py>,
        mu: f64,
        radius: f64,
        #[pyo3(from_py_with = some_degree)] degree: Option<usize>,
        #[pyo3(from_py_with = order_of)] order: Option<usize>,
    ) -> PyResult<Bound<'py, Self>> {
        let keywords = fields!(
            py, "c": c, "s": s, "mu": mu, "radius": radius, "degree": degree, "order": order,
        );
        let (c, s) = (Input::new(c, "c")?, Input::new(s, "s")?);
        let size = c.shape().first().copied().unwrap_or(0);
        for (input, name) in [(&c, "c"), (&s, "s")] {
            if size == 0 || input.shape() != [size, size] {
                return Err(wrong_shape(py, name, &shape_text(&[size, size]), input.shape()));
            }
        }
        let degree = degree.unwrap_or(size - 1);
        let order = order.unwrap_or(degree);
        let field = Coefficients::new("coefficients", mu, radius, size - 1, c.data(), s.data())
            .and_then(|coefficients| GravityField::new(&coefficients, degree, order));
        Bound::new(py, Self::wrap(py, field, "GravityField.from_coefficients", &keywords)?)
    }

    /// Name of the model.
    #[getter]
    fn name(&self) -> &str {
        self.field.name()
    }

    /// Gravitational parameter that goes with the coefficients, m³/s².
    #[getter]
    fn mu(&self) -> f64 {
        self.field.mu()
    }

    /// Reference radius, m.
    #[getter]
    fn radius(&self) -> f64 {
        self.field.radius()
    }

    /// Highest degree.
    #[getter]
    fn degree(&self) -> usize {
        self.field.degree()
    }

    /// Highest order.
    #[getter]
    fn order(&self) -> usize {
        self.field.order()
    }

    /// Acceleration at ``r`` (3,) or (N, 3), m, both in axes fixed in the planet: m/s², without that of the point mass.
    fn acceleration<'py>(&self, py: Python<'py>, r: Any<'_, 'py>) -> PyResult<Bound<'py, PyAny>> {
        self.at_each(py, r, &[3], GravityField::accelerations)
    }

    /// Gradient of the acceleration at ``r`` (3,) or (N, 3), m: (3, 3) or (N, 3, 3), 1/s², symmetric and without trace.
    fn gradient<'py>(&self, py: Python<'py>, r: Any<'_, 'py>) -> PyResult<Bound<'py, PyAny>> {
        self.at_each(py, r, &[3, 3], GravityField::gradients)
    }

    fn __repr__(&self) -> String {
        let Self { field, .. } = self;
        format!("<GravityField: {}, degree {}, order {}>", field.name(), field.degree(), field.order())
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, Py<PyTuple>)> {
        Ok((py.import("onorbit_rs.rebuild")?.getattr("rebuild")?, self.made.clone_ref(py)))
    }
}

/// One of the functions that fill rows.
type Fill = fn(&GravityField, &[f64], &mut [f64]) -> Result<(), GravityError>;

impl PyGravityField {
    fn at_each<'py>(
        &self,
        py: Python<'py>,
        r: Any<'_, 'py>,
        tail: &[usize],
        fill: Fill,
    ) -> PyResult<Bound<'py, PyAny>> {
        let input = Input::new(r, "r")?;
        let shape: Vec<usize> = match input.shape() {
            [3] => tail.to_vec(),
            [n, 3] => std::iter::once(*n).chain(tail.iter().copied()).collect(),
            other => return Err(wrong_shape(py, "r", "(3,) or (N, 3)", other)),
        };
        let out = zeros(py, &shape)?;
        let (positions, to) = (input.data(), fresh(&out));
        let (rows, width) = (positions.len() / 3, tail.iter().product::<usize>());
        in_pieces(py, rows, 256, |range| {
            let (from, into) = (3 * range.start..3 * range.end, width * range.start..width * range.end);
            fill(&self.field, &positions[from], &mut to[into])
        })?;
        Ok(out.into_any())
    }
}

fn degree_of(value: Any<'_, '_>) -> PyResult<usize> {
    degree_or_order(value, "degree")
}

fn some_degree(value: Any<'_, '_>) -> PyResult<Option<usize>> {
    if value.is_none() { Ok(None) } else { degree_of(value).map(Some) }
}

fn order_of(value: Any<'_, '_>) -> PyResult<Option<usize>> {
    if value.is_none() { Ok(None) } else { degree_or_order(value, "order").map(Some) }
}

fn degree_or_order(value: Any<'_, '_>, name: &str) -> PyResult<usize> {
    let number = whole(value, name)?;
    usize::try_from(number).map_err(|_| {
        let message = format!("{name} is {number}, it must be zero or positive");
        raise(value.py(), "GravityError", &message, &fields!(value.py(), "name": name, "got": number))
    })
}
