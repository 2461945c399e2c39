//! Atmosphere models.

mod constant;
mod exponential;
mod harris_priester;
mod nrlmsise00;

use crate::arrays::{Input, fresh, wrong_shape, zeros};
use crate::earth::PyEarth;
use crate::errors::plain;
use crate::interrupt::in_pieces;
use crate::pickling::{ConstructorCall, Reduced};
use onorbit_core::earth::Earth;
use onorbit_core::environment::atmosphere::{Atmosphere, densities_at, densities_over};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use std::sync::Arc;

type Any<'a, 'py> = &'a Bound<'py, PyAny>;

pub(super) fn add_classes(m: &Bound<'_, PyModule>) -> PyResult<()> {
    m.add_class::<PyAtmosphere>()?;
    m.add_class::<constant::PyConstantAtmosphere>()?;
    m.add_class::<exponential::PyExponentialAtmosphere>()?;
    m.add_class::<harris_priester::PyHarrisPriester>()?;
    m.add_class::<nrlmsise00::PyNrlmsise00>()
}

/// Base class of atmosphere models, which compute the density for :class:`Drag`.
#[pyclass(name = "Atmosphere", subclass, frozen, module = "onorbit_rs")]
pub(crate) struct PyAtmosphere {
    pub(super) atmosphere: Arc<dyn Atmosphere>,
    constructor_call: ConstructorCall,
}

impl PyAtmosphere {
    /// Creates the base object of an atmosphere, with the class and keywords used to pickle it.
    fn new(
        atmosphere: impl Atmosphere + 'static,
        class: &str,
        keywords: &Bound<'_, PyDict>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let constructor_call = ConstructorCall::with_keywords(class, keywords)?;
        Ok(PyClassInitializer::from(Self { atmosphere: Arc::new(atmosphere), constructor_call }))
    }
}

/// Returns the given Earth or, if none is given, an Earth without rotation and epoch, which suffices for
/// models that depend neither on the Sun nor on the date.
fn earth_or_fixed(earth: Option<&Bound<'_, PyEarth>>) -> Arc<Earth> {
    earth.map_or_else(|| Arc::new(Earth::about_z(0.0, 0.0)), |earth| Arc::clone(&earth.get().earth))
}

#[pymethods]
impl PyAtmosphere {
    /// Return the density at geodetic coordinates. Array arguments are broadcast to a common shape.
    ///
    /// Parameters
    /// ----------
    /// altitude : float or array
    ///     Altitude above WGS84, m.
    /// latitude, longitude : float or array, optional
    ///     Geodetic coordinates on WGS84, rad; default: 0.
    /// t : float or array, optional
    ///     Simulation time, s; default: 0.
    /// earth : Earth, optional
    ///     Earth with an epoch, required by models that depend on the Sun or the date.
    ///
    /// Returns
    /// -------
    /// float or array
    ///     Density, kg/m³.
    ///
    /// Raises
    /// ------
    /// EffectError, EarthError, ShapeError
    ///     If a point is outside the range of the model, the ``earth`` does not cover a time, or the shapes
    ///     of the arguments cannot be broadcast.
    #[pyo3(signature = (altitude, latitude=None, longitude=None, t=None, *, earth=None))]
    fn density<'py>(
        &self,
        py: Python<'py>,
        altitude: Any<'_, 'py>,
        latitude: Option<Any<'_, 'py>>,
        longitude: Option<Any<'_, 'py>>,
        t: Option<Any<'_, 'py>>,
        earth: Option<&Bound<'py, PyEarth>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let zero = 0.0_f64.into_pyobject(py)?.into_any();
        let [latitude, longitude, t] = [latitude, longitude, t].map(|value| value.unwrap_or(&zero));
        let ([altitude, latitude, longitude, t], shape) =
            broadcast(["altitude", "latitude", "longitude", "t"], [altitude, latitude, longitude, t])?;
        let (out, earth) = (zeros(py, &shape)?, earth_or_fixed(earth));
        let points = [altitude.data(), latitude.data(), longitude.data(), t.data()];
        let to = fresh(&out);
        in_pieces(py, to.len(), 1024, |range| {
            let points = points.map(|values| &values[range.clone()]);
            densities_over(&*self.atmosphere, &earth, points, &mut to[range])
        })?;
        scalar_or_array(out.into_any(), &shape)
    }

    /// Return the density at positions in inertial axes.
    ///
    /// Parameters
    /// ----------
    /// r : (3,) or (N, 3) array
    ///     Position from the Earth's centre, inertial axes, m.
    /// t : float or (N,) array, optional
    ///     Simulation time, s; default: 0.
    /// earth : Earth
    ///     Orientation of the Earth, with an epoch for models that depend on the Sun or the date.
    ///
    /// Returns
    /// -------
    /// float or (N,) array
    ///     Density, kg/m³.
    ///
    /// Raises
    /// ------
    /// EffectError, EarthError, ShapeError
    ///     If a point is outside the range of the model, the ``earth`` does not cover a time, or the shape of
    ///     ``t`` does not match that of ``r``.
    #[pyo3(signature = (r, t=None, *, earth))]
    fn density_at<'py>(
        &self,
        py: Python<'py>,
        r: Any<'_, 'py>,
        t: Option<Any<'_, 'py>>,
        earth: &Bound<'py, PyEarth>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let r = Input::new(r, "r")?;
        let shape = match r.shape() {
            [3] => vec![],
            [n, 3] => vec![*n],
            other => return Err(wrong_shape(py, "r", "(3,) or (N, 3)", other)),
        };
        let out = zeros(py, &shape)?;
        let zero = 0.0_f64.into_pyobject(py)?.into_any();
        let given = t.unwrap_or(&zero);
        let ([_, t], both) = broadcast(["r", "t"], [out.as_any(), given])?;
        if both != shape {
            let expected = match shape[..] {
                [n] => format!("a number or ({n},), one time per position"),
                _ => "a number".to_owned(),
            };
            return Err(wrong_shape(py, "t", &expected, Input::new(given, "t")?.shape()));
        }
        let (to, earth) = (fresh(&out), Arc::clone(&earth.get().earth));
        let (positions, times) = (r.data(), t.data());
        in_pieces(py, to.len(), 1024, |range| {
            let rows = &positions[3 * range.start..3 * range.end];
            densities_at(&*self.atmosphere, &earth, rows, &times[range.clone()], &mut to[range])
        })?;
        scalar_or_array(out.into_any(), &shape)
    }

    fn __repr__(&self) -> String {
        format!("<{}>", self.atmosphere.name())
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        self.constructor_call.reduce(py)
    }
}

/// Broadcasts arrays to a common shape, and returns them flattened together with that shape.
fn broadcast<'py, const N: usize>(
    names: [&str; N],
    values: [Any<'_, 'py>; N],
) -> PyResult<([Input<'py>; N], Vec<usize>)> {
    let py = values[0].py();
    for (value, name) in values.iter().zip(names) {
        Input::new(value, name)?; // names the argument that is not numeric
    }
    let numpy = py.import("numpy")?;
    let together = numpy.call_method1("broadcast_arrays", PyTuple::new(py, values)?);
    let together: Vec<Bound<'py, PyAny>> = together.and_then(|arrays| arrays.extract()).map_err(|_| {
        let message = format!(
            "the shapes of {} do not match; give numbers, or arrays with one value per point",
            names.join(", ")
        );
        plain(py, "ShapeError", &message)
    })?;
    let shape: Vec<usize> = together[0].getattr("shape")?.extract()?;
    let mut inputs = Vec::with_capacity(N);
    for (array, name) in together.iter().zip(names) {
        // `ravel` makes a number one-dimensional
        inputs.push(Input::new(&numpy.call_method1("ravel", (array,))?, name)?);
    }
    let inputs = <[Input<'py>; N]>::try_from(inputs).unwrap_or_else(|_| unreachable!("one per name"));
    Ok((inputs, shape))
}

/// Returns a number if the shape is `()`, otherwise the array.
fn scalar_or_array<'py>(array: Bound<'py, PyAny>, shape: &[usize]) -> PyResult<Bound<'py, PyAny>> {
    if shape.is_empty() { array.call_method0("item") } else { Ok(array) }
}
