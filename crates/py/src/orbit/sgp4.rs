//! Orbits of element sets.

use super::{PyOrbit, base};
use crate::errors::{IntoPython, fields, plain, raise};
use onorbit_core::orbit::{EarthModel, MeanElements, Orbit, OrbitError, Sgp4};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString, PyTuple};
use std::collections::HashMap;
use std::sync::Arc;

/// The orbit of a two-line element set by SGP4 (improved mode); time zero is the epoch of the set.
///
/// ``gravity`` is ``wgs72`` (which published sets are fitted with), ``wgs72old`` or ``wgs84``. Axes are TEME; position
/// and velocity are SGP4's own. A line that is not 69 columns of the right kind, or whose checksum is wrong, raises
/// ``ElementSetError``, naming line and column; what SGP4 itself refuses raises ``Sgp4Error`` with its ``code``.
#[pyclass(name = "Sgp4", extends = PyOrbit, frozen, module = "onorbit_rs")]
pub(crate) struct PySgp4 {
    sgp4: Arc<Sgp4>,
}

fn earth_model(py: Python<'_>, name: &str) -> PyResult<EarthModel> {
    match EarthModel::ALL.iter().find(|(known, _)| *known == name) {
        Some((_, model)) => Ok(*model),
        None => {
            let message = format!("gravity is '{name}'; there are 'wgs72', 'wgs72old' and 'wgs84'");
            Err(raise(py, "InputError", &message, &fields!(py, "name": "gravity", "got": name)))
        }
    }
}

fn wrap(
    py: Python<'_>,
    elements: Result<MeanElements, OrbitError>,
    model: EarthModel,
    made: (&str, &Bound<'_, PyTuple>, &Bound<'_, PyDict>),
) -> PyResult<PyClassInitializer<PySgp4>> {
    let sgp4 = elements.map(|elements| Sgp4::new(elements, model));
    let sgp4 = Arc::new(sgp4.map_err(|error| error.into_python(py))?);
    let orbit = base(Arc::clone(&sgp4) as Arc<dyn Orbit>, made.0, made.1, made.2)?;
    Ok(PyClassInitializer::from(orbit).add_subclass(PySgp4 { sgp4 }))
}

#[pymethods]
impl PySgp4 {
    #[new]
    #[pyo3(signature = (line1, line2, *, gravity="wgs72", check_checksum=true))]
    fn new(
        py: Python<'_>,
        line1: &str,
        line2: &str,
        gravity: &str,
        check_checksum: bool,
    ) -> PyResult<PyClassInitializer<Self>> {
        let model = earth_model(py, gravity)?;
        let elements = MeanElements::from_tle(line1, line2, check_checksum).map_err(OrbitError::from);
        let arguments = (line1, line2).into_pyobject(py)?;
        let keywords = fields!(py, "gravity": gravity, "check_checksum": check_checksum);
        wrap(py, elements, model, ("Sgp4", &arguments, &keywords))
    }

    /// From a CCSDS Orbit Mean-Elements Message: a mapping of its keywords, or its text (JSON, XML or KVN).
    #[staticmethod]
    #[pyo3(signature = (message, *, gravity="wgs72"))]
    fn from_omm<'py>(
        py: Python<'py>,
        message: &Bound<'py, PyAny>,
        gravity: &str,
    ) -> PyResult<Bound<'py, Self>> {
        let model = earth_model(py, gravity)?;
        let entries = if message.is_instance_of::<PyString>() {
            py.import("onorbit_rs.omm")?.getattr("entries")?.call1((message,))?
        } else {
            message.clone()
        };
        let mut texts = HashMap::new();
        for item in entries.call_method0("items").and_then(|items| items.try_iter()).map_err(|_| {
            plain(py, "ElementSetError", "an OMM is a mapping of its keywords, or its text: this is neither")
        })? {
            let (key, value): (String, Bound<'_, PyAny>) = item?.extract()?;
            if !value.is_none() {
                texts.insert(key, value.str()?.to_string());
            }
        }
        let elements = MeanElements::from_omm(|key| texts.get(key).cloned()).map_err(OrbitError::from);
        let arguments =
            (PyDict::from_sequence(texts.clone().into_pyobject(py)?.items().as_any())?,).into_pyobject(py)?;
        let keywords = fields!(py, "gravity": gravity);
        Bound::new(py, wrap(py, elements, model, ("Sgp4.from_omm", &arguments, &keywords))?)
    }

    /// Catalogue number.
    #[getter]
    fn satellite(&self) -> u32 {
        self.sgp4.elements().satellite
    }

    /// Epoch of the set, which is time zero: ISO 8601, UTC.
    #[getter]
    fn epoch(&self) -> String {
        self.sgp4.elements().epoch.to_string()
    }

    /// Epoch as a Julian date (UTC) of midnight and the part of the day since.
    #[getter]
    fn julian_date(&self) -> (f64, f64) {
        self.sgp4.elements().epoch.julian_date()
    }

    /// Period of the mean motion, s.
    #[getter]
    fn period(&self) -> f64 {
        self.sgp4.period()
    }

    fn __repr__(&self) -> String {
        let elements = self.sgp4.elements();
        format!(
            "<Sgp4: satellite {}, epoch {}, period {:.1} s>",
            elements.satellite,
            elements.epoch,
            self.sgp4.period()
        )
    }
}
