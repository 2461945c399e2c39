//! Gravity field of a planet.

use super::Any;
use crate::arrays::{Input, fresh, shape_text, whole, wrong_shape, zeros};
use crate::environment::{Kind, PyEffect};
use crate::errors::{IntoPython, fields, plain, raise};
use crate::interrupt::{abandonable, in_pieces};
use onorbit_core::gravity::{Coefficients, GravityError, GravityField};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;
use std::sync::Arc;

/// Gravity field of a planet, excluding its point mass.
///
/// As an effect of a simulation, the field acts on every body. Its ``mu`` is then used instead of the orbit's
/// value; if the relative difference of the two exceeds 1e-5, the simulation raises ``GravityError``. The
/// orientation of the planet is that of the simulation's ``earth``. A field of order 0 does not require an
/// ``earth``; without one, the axis of the field is z. Positions are from the planet's centre in planet-fixed
/// axes.
///
/// Parameters
/// ----------
/// model : {"egm2008", "jgm3"}
///     Bundled model to degree and order 70: EGM2008 (tide-free) or JGM-3 (with the permanent tide).
/// degree : int
///     Highest degree, from 2 to 70.
/// order : int, optional
///     Highest order; default: ``degree``.
///
/// Raises
/// ------
/// GravityError
///     If there is no such model, or if degree or order is out of range.
#[pyclass(name = "GravityField", extends = PyEffect, frozen, module = "onorbit_rs")]
pub(super) struct PyGravityField {
    field: Arc<GravityField>,
}

impl PyGravityField {
    fn wrap(
        py: Python<'_>,
        field: Result<GravityField, GravityError>,
        constructor: &str,
        keywords: &Bound<'_, PyDict>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let field = Arc::new(field.map_err(|error| error.into_python(py))?);
        let effect = PyEffect::new(Kind::GravityField(Arc::clone(&field)), constructor, keywords)?;
        Ok(effect.add_subclass(Self { field }))
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

    /// Return a field with zonal harmonics only. It is evaluated in closed form.
    ///
    /// Parameters
    /// ----------
    /// degree : int, optional
    ///     Highest degree, 2 to 6, of the Earth's zonal harmonics (EGM2008); default: 6.
    /// j : (k,) array, optional
    ///     Unnormalised zonal coefficients J2, J3 and so on, up to J6; may be given instead of ``degree``.
    /// mu : float, optional
    ///     Gravitational parameter of the planet to which ``j`` belongs, m³/s²; required with ``j``.
    /// radius : float, optional
    ///     Reference radius to which ``j`` refers, m; required with ``j``.
    ///
    /// Returns
    /// -------
    /// GravityField
    ///
    /// Raises
    /// ------
    /// GravityError
    ///     If ``degree`` is out of range, if a number is invalid, if ``degree`` is given together with any of
    ///     ``j``, ``mu`` and ``radius``, or if only some of these three are given.
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
                    "the arguments do not determine the zonal field; give only degree (for the Earth), or all \
                     of j, mu and radius",
                ));
            }
        };
        Bound::new(py, Self::wrap(py, field, "GravityField.zonal", &keywords)?)
    }

    /// Read a field from a ``.gfc`` file (ICGEM format).
    ///
    /// Parameters
    /// ----------
    /// path : path
    ///     Path of the file.
    /// degree : int, optional
    ///     Highest degree; default: the degree of the file.
    /// order : int, optional
    ///     Highest order; default: ``degree``.
    ///
    /// Returns
    /// -------
    /// GravityField
    ///
    /// Raises
    /// ------
    /// NotFoundError, ReadError, GravityError
    ///     If the file does not exist or cannot be read, or if its content, the degree or the order is
    ///     invalid.
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

    /// Return a field with the given fully normalised coefficients.
    ///
    /// Parameters
    /// ----------
    /// c, s : (n, n) array
    ///     Coefficients ``c[degree, order]`` and ``s[degree, order]`` to degree n - 1; ``c[0, 0]`` is treated
    ///     as 1.
    /// mu : float
    ///     Gravitational parameter, m³/s².
    /// radius : float
    ///     Reference radius, m.
    /// degree : int, optional
    ///     Highest degree; default: the degree of the arrays.
    /// order : int, optional
    ///     Highest order; default: ``degree``.
    ///
    /// Returns
    /// -------
    /// GravityField
    ///
    /// Raises
    /// ------
    /// GravityError, ShapeError
    ///     If a number, the degree or the order is invalid, or if the arrays are not square and of equal
    ///     size.
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

    /// Gravitational parameter of the coefficients, m³/s².
    #[getter]
    fn mu(&self) -> f64 {
        self.field.mu()
    }

    /// Reference radius, m.
    #[getter]
    fn radius(&self) -> f64 {
        self.field.radius()
    }

    /// Highest degree of the field.
    #[getter]
    fn degree(&self) -> usize {
        self.field.degree()
    }

    /// Highest order of the field.
    #[getter]
    fn order(&self) -> usize {
        self.field.order()
    }

    /// Return the gravitational acceleration due to the field, excluding the point mass.
    ///
    /// Parameters
    /// ----------
    /// r : (3,) or (N, 3) array
    ///     Position from the planet's centre, planet-fixed axes, m.
    ///
    /// Returns
    /// -------
    /// (3,) or (N, 3) array
    ///     Acceleration, planet-fixed axes, m/s².
    ///
    /// Raises
    /// ------
    /// GravityError
    ///     If a position is not finite, or is closer to the centre than 0.996 of the reference radius.
    /// ShapeError
    ///     If ``r`` has another shape.
    fn acceleration<'py>(&self, py: Python<'py>, r: Any<'_, 'py>) -> PyResult<Bound<'py, PyAny>> {
        self.at_each(py, r, &[3], GravityField::accelerations)
    }

    /// Return the gradient of :meth:`acceleration` with respect to the position. It is symmetric with zero
    /// trace.
    ///
    /// Parameters
    /// ----------
    /// r : (3,) or (N, 3) array
    ///     Position from the planet's centre, planet-fixed axes, m.
    ///
    /// Returns
    /// -------
    /// (3, 3) or (N, 3, 3) array
    ///     Gradient, planet-fixed axes, 1/s².
    ///
    /// Raises
    /// ------
    /// GravityError
    ///     If a position is not finite, or is closer to the centre than 0.996 of the reference radius.
    /// ShapeError
    ///     If ``r`` has another shape.
    fn gradient<'py>(&self, py: Python<'py>, r: Any<'_, 'py>) -> PyResult<Bound<'py, PyAny>> {
        self.at_each(py, r, &[3, 3], GravityField::gradients)
    }

    fn __repr__(&self) -> String {
        let Self { field, .. } = self;
        format!("<GravityField: {}, degree {}, order {}>", field.name(), field.degree(), field.order())
    }
}

/// Function of the core that computes one row of results per position.
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

/// Reads the argument `name`, a degree or an order. Negative values are an error.
fn degree_or_order(value: Any<'_, '_>, name: &str) -> PyResult<usize> {
    let number = whole(value, name)?;
    usize::try_from(number).map_err(|_| {
        let least = if name == "degree" { 2 } else { 0 };
        let message = format!("{name} is {number}; it must be at least {least}");
        raise(value.py(), "GravityError", &message, &fields!(value.py(), "name": name, "got": number))
    })
}
