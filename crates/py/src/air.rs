//! Models of the air.

use crate::arrays::{Input, fresh, wrong_shape, zeros};
use crate::earth::PyEarth;
use crate::errors::{IntoPython, LARGEST_TABLE, fields, in_file, plain, raise, unreadable};
use crate::interrupt::in_pieces;
use crate::made::{Made, absolute};
use onorbit_core::earth::Earth;
use onorbit_core::environment::atmosphere::{
    Atmosphere, ConstantAtmosphere, ExponentialAtmosphere, HarrisPriester, Layer, MagneticActivity,
    Nrlmsise00, SpaceIndices, SpaceWeather, SpaceWeatherTable, densities_at, densities_over,
};
use onorbit_core::text_file::read_text;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use std::path::PathBuf;
use std::sync::Arc;

type Any<'a, 'py> = &'a Bound<'py, PyAny>;

/// A model of the air's density.
#[pyclass(name = "Atmosphere", subclass, frozen, module = "onorbit_rs")]
pub(crate) struct PyAtmosphere {
    pub(crate) air: Arc<dyn Atmosphere>,
    made: Made,
}

impl PyAtmosphere {
    /// Air that `class` makes of `keywords`.
    fn of(
        air: impl Atmosphere + 'static,
        class: &str,
        keywords: &Bound<'_, PyDict>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let made = Made::by(class, keywords)?;
        Ok(PyClassInitializer::from(Self { air: Arc::new(air), made }))
    }
}

/// The Earth given, or one that stands still where a model does not look at it.
fn earth_or_still(earth: Option<&Bound<'_, PyEarth>>) -> Arc<Earth> {
    earth.map_or_else(|| Arc::new(Earth::about_z(0.0, 0.0)), |earth| Arc::clone(&earth.get().earth))
}

#[pymethods]
impl PyAtmosphere {
    /// Density, kg/m³, at geodetic ``altitude`` (m), ``latitude`` and ``longitude`` (rad) on WGS84, ``t`` s of simulation;
    /// numbers or arrays that broadcast. Models that follow the Sun or the date need an ``earth`` with an epoch.
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
        let (out, earth) = (zeros(py, &shape)?, earth_or_still(earth));
        let places = [altitude.data(), latitude.data(), longitude.data(), t.data()];
        let to = fresh(&out);
        in_pieces(py, to.len(), 1024, |range| {
            let places = places.map(|values| &values[range.clone()]);
            densities_over(&*self.air, &earth, places, &mut to[range])
        })?;
        scalar_or_array(out.into_any(), &shape)
    }

    /// Density, kg/m³, at ``r`` (3,) or (N, 3) from the Earth's centre, inertial axes, m, at ``t`` s of simulation, a number or
    /// (N,), as ``earth`` turns.
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
        let ([_, t], both) = broadcast(["r", "t"], [out.as_any(), t.unwrap_or(&zero)])?;
        if both != shape {
            return Err(wrong_shape(py, "t", "that of the positions or a number", &both));
        }
        let (to, earth) = (fresh(&out), Arc::clone(&earth.get().earth));
        let (positions, times) = (r.data(), t.data());
        in_pieces(py, to.len(), 1024, |range| {
            let places = &positions[3 * range.start..3 * range.end];
            densities_at(&*self.air, &earth, places, &times[range.clone()], &mut to[range])
        })?;
        scalar_or_array(out.into_any(), &shape)
    }

    fn __repr__(&self) -> String {
        format!("<{}>", self.air.name())
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, Py<PyTuple>)> {
        self.made.again(py)
    }
}

/// Arrays of one shape.
fn broadcast<'py, const N: usize>(
    names: [&str; N],
    values: [Any<'_, 'py>; N],
) -> PyResult<([Input<'py>; N], Vec<usize>)> {
    let py = values[0].py();
    for (value, name) in values.iter().zip(names) {
        Input::new(value, name)?; // refuses by name what is no number
    }
    let numpy = py.import("numpy")?;
    let together = numpy.call_method1("broadcast_arrays", pyo3::types::PyTuple::new(py, values)?);
    let together: Vec<Bound<'py, PyAny>> = together.and_then(|arrays| arrays.extract()).map_err(|_| {
        plain(py, "ShapeError", &format!("{} do not broadcast to one shape", names.join(", ")))
    })?;
    let shape: Vec<usize> = together[0].getattr("shape")?.extract()?;
    let mut inputs = Vec::with_capacity(N);
    for (array, name) in together.iter().zip(names) {
        // one-dimensional even for a number: Input keeps that
        inputs.push(Input::new(&numpy.call_method1("ravel", (array,))?, name)?);
    }
    let inputs = <[Input<'py>; N]>::try_from(inputs).unwrap_or_else(|_| unreachable!("one per name"));
    Ok((inputs, shape))
}

/// A plain number for shape `()`.
fn scalar_or_array<'py>(array: Bound<'py, PyAny>, shape: &[usize]) -> PyResult<Bound<'py, PyAny>> {
    if shape.is_empty() { array.call_method0("item") } else { Ok(array) }
}

/// Air of one ``density`` everywhere, kg/m³.
#[pyclass(name = "ConstantAtmosphere", extends = PyAtmosphere, frozen, module = "onorbit_rs")]
pub(crate) struct PyConstantAtmosphere;

#[pymethods]
impl PyConstantAtmosphere {
    #[new]
    fn new(py: Python<'_>, density: f64) -> PyResult<PyClassInitializer<Self>> {
        let air = ConstantAtmosphere::new(density).map_err(|error| error.into_python(py))?;
        let keywords = fields!(py, "density": density);
        Ok(PyAtmosphere::of(air, "ConstantAtmosphere", &keywords)?.add_subclass(Self))
    }
}

/// Air that thins out exponentially: ``density`` kg/m³ at ``altitude`` m above WGS84, by e every ``scale_height`` m.
///
/// Without arguments the 28 layers of Vallado's table 8-4 (2013), 0 to 1000 km and above, moderate solar activity.
#[pyclass(name = "ExponentialAtmosphere", extends = PyAtmosphere, frozen, module = "onorbit_rs")]
pub(crate) struct PyExponentialAtmosphere;

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
        let air = match (density, altitude, scale_height) {
            (None, None, None) => Ok(ExponentialAtmosphere::table()),
            (Some(density), Some(base), Some(scale_height)) => {
                ExponentialAtmosphere::new(vec![Layer { base, density, scale_height }])
            }
            _ => {
                let message = "density, altitude and scale_height belong together: give all three, or none for the table";
                return Err(raise(
                    py,
                    "EffectError",
                    message,
                    &fields!(py, "name": "density, altitude, scale_height"),
                ));
            }
        };
        let air = air.map_err(|error| error.into_python(py))?;
        let keywords = fields!(py, "density": density, "altitude": altitude, "scale_height": scale_height);
        Ok(PyAtmosphere::of(air, "ExponentialAtmosphere", &keywords)?.add_subclass(Self))
    }
}

/// Harris and Priester's air, 100 to 1000 km, mean solar activity: a bulge that follows the Sun ``lag`` rad to the east.
///
/// Density is ``ρm + (ρM - ρm) cosⁿ(ψ/2)``, ``n`` the ``exponent``: 2 for low inclinations to 6 for polar orbits, ψ the angle from
/// the bulge. Needs an earth with an epoch. Beyond its layers it raises ``EffectError``.
#[pyclass(name = "HarrisPriester", extends = PyAtmosphere, frozen, module = "onorbit_rs")]
pub(crate) struct PyHarrisPriester;

#[pymethods]
impl PyHarrisPriester {
    #[new]
    #[pyo3(signature = (*, exponent=4.0, lag=std::f64::consts::FRAC_PI_6))]
    fn new(py: Python<'_>, exponent: f64, lag: f64) -> PyResult<PyClassInitializer<Self>> {
        let air = HarrisPriester::new(exponent, lag).map_err(|error| error.into_python(py))?;
        let keywords = fields!(py, "exponent": exponent, "lag": lag);
        Ok(PyAtmosphere::of(air, "HarrisPriester", &keywords)?.add_subclass(Self))
    }
}

/// NRLMSISE-00, anomalous oxygen included; needs an earth with an epoch and space weather.
///
/// Either constants: ``f107`` of the previous day and its 81-day mean ``f107a``, both 1e-22 W/(m² Hz), and ``ap``, the day's mean or
/// (7,): the day, the 3 h now, 3, 6 and 9 h ago, means of 12-33 h and 36-57 h ago. Or ``table``: a CSV file with a row per day and
/// the columns ``DATE, AP_AVG, F10.7_OBS, F10.7_OBS_CENTER81`` and ``AP1`` to ``AP8`` for the three-hourly history (CelesTrak's
/// ``SW-All.csv``); ``three_hourly=False`` reads the day's mean alone. A missing value or day raises ``EffectError``.
#[pyclass(name = "Nrlmsise00", extends = PyAtmosphere, frozen, module = "onorbit_rs")]
pub(crate) struct PyNrlmsise00;

#[pymethods]
impl PyNrlmsise00 {
    #[new]
    #[pyo3(signature = (*, f107=None, f107a=None, ap=None, table=None, three_hourly=true))]
    fn new(
        py: Python<'_>,
        f107: Option<f64>,
        f107a: Option<f64>,
        ap: Option<Any<'_, '_>>,
        table: Option<PathBuf>,
        three_hourly: bool,
    ) -> PyResult<PyClassInitializer<Self>> {
        let keywords = fields!(py, "f107": f107, "f107a": f107a, "three_hourly": three_hourly);
        keywords.set_item("table", table.as_deref().map(absolute))?;
        let weather = match (f107, f107a, ap, table) {
            (None, None, None, Some(path)) => SpaceWeather::Table(read_table(py, &path, three_hourly)?),
            (Some(f107), Some(f107a), Some(ap), None) => {
                let activity = activity(ap)?;
                match &activity {
                    MagneticActivity::Daily(daily) => keywords.set_item("ap", daily)?,
                    MagneticActivity::History(history) => keywords.set_item("ap", history)?,
                }
                let indices = SpaceIndices::new(f107, f107a, activity);
                SpaceWeather::Constant(indices.map_err(|error| error.into_python(py))?)
            }
            (f107, f107a, ap, table) => {
                let missing = [("f107", f107.is_none()), ("f107a", f107a.is_none()), ("ap", ap.is_none())];
                let missing: Vec<_> =
                    missing.iter().filter(|(_, missing)| *missing).map(|(name, _)| *name).collect();
                let message = match table {
                    Some(_) => "space weather is given twice: by numbers and by a table; give one".to_owned(),
                    None => format!(
                        "space weather is missing {}: give f107, f107a and ap, or a table",
                        missing.join(", ")
                    ),
                };
                return Err(raise(py, "EffectError", &message, &fields!(py, "name": "f107, f107a, ap")));
            }
        };
        let air = Nrlmsise00::new(weather);
        Ok(PyAtmosphere::of(air, "Nrlmsise00", &keywords)?.add_subclass(Self))
    }
}

/// A day's mean, or the history.
fn activity(ap: Any<'_, '_>) -> PyResult<MagneticActivity> {
    if let Ok(daily) = ap.extract::<f64>() {
        return Ok(MagneticActivity::Daily(daily));
    }
    crate::arrays::fixed::<7>(ap, "ap", &[7]).map(MagneticActivity::History)
}

fn read_table(py: Python<'_>, path: &std::path::Path, three_hourly: bool) -> PyResult<SpaceWeatherTable> {
    let text = read_text(path, LARGEST_TABLE)
        .map_err(|error| unreadable(py, path, "space weather table", &error))?;
    let table = SpaceWeatherTable::from_csv(&text)
        .map_err(|error| in_file(py, path, error))?
        .named(format!("the table {}", path.display()));
    Ok(if three_hourly { table } else { table.daily() })
}

pub(crate) fn add_classes(m: &Bound<'_, PyModule>) -> PyResult<()> {
    m.add_class::<PyAtmosphere>()?;
    m.add_class::<PyConstantAtmosphere>()?;
    m.add_class::<PyExponentialAtmosphere>()?;
    m.add_class::<PyHarrisPriester>()?;
    m.add_class::<PyNrlmsise00>()
}
