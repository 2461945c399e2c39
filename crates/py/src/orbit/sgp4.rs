//! Orbits of element sets, propagated by SGP4.

use super::reference::Satrec;
use super::{PyOrbit, base};
use crate::arrays::type_name;
use crate::errors::{IntoPython, fields, plain, raise};
use onorbit_core::orbit::sgp4::Epoch;
use onorbit_core::orbit::{EarthModel, MeanElements, Orbit, OrbitError, Sgp4};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString, PyTuple};
use std::collections::HashMap;
use std::sync::Arc;

/// Orbit of a two-line element set, propagated by SGP4 in improved mode.
///
/// Time zero is the epoch of the element set. Position and velocity are those of SGP4, in TEME axes.
///
/// Parameters
/// ----------
/// line1 : str or Satrec
///     First line, or a ``Satrec`` of PyPI's ``sgp4``, from which the epoch, the elements (bit for bit) and
///     the gravity constants are copied.
/// line2 : str, optional
///     Second line; omitted with a ``Satrec``.
/// gravity : {"wgs72", "wgs72old", "wgs84"}, optional
///     Gravity constants. The default is ``wgs72``, with which published element sets are fitted.
/// check_checksum : bool
///     If True, a wrong checksum raises an error.
/// propagator : {"native", "reference"}
///     With ``reference``, PyPI's ``sgp4`` reads and propagates the element set instead of the SGP4 of the
///     engine, as an independent check; each state then requires calls to Python.
///
/// Raises
/// ------
/// ElementSetError
///     If a line does not have 69 valid columns or its checksum is wrong (the message names the line and, if
///     its length is right, the column), if the lines belong to two satellites, or if an element is out of
///     range; also for a ``Satrec`` with other gravity constants, or in AFSPC mode unless ``propagator`` is
///     ``reference``.
/// Sgp4Error
///     If SGP4 rejects an element set or a time; ``code`` is the error code.
/// InputError
///     If the arguments are neither two lines nor a ``Satrec`` alone, or a choice is unknown.
#[pyclass(name = "Sgp4", extends = PyOrbit, frozen, module = "onorbit_rs")]
pub(super) struct PySgp4 {
    sgp4: Arc<Sgp4>,
}

/// Returns the gravity constants with this name.
fn earth_model(py: Python<'_>, name: &str) -> PyResult<EarthModel> {
    match EarthModel::ALL.iter().find(|(known, _)| *known == name) {
        Some((_, model)) => Ok(*model),
        None => {
            let message = format!("gravity is '{name}'; the choices are 'wgs72', 'wgs72old' and 'wgs84'");
            Err(raise(py, "InputError", &message, &fields!(py, "name": "gravity", "got": name)))
        }
    }
}

/// Returns true if the argument `propagator` selects the reference implementation.
fn is_reference(py: Python<'_>, propagator: &str) -> PyResult<bool> {
    match propagator {
        "native" => Ok(false),
        "reference" => Ok(true),
        other => {
            let message = format!("propagator is '{other}'; the choices are 'native' and 'reference'");
            Err(raise(py, "InputError", &message, &fields!(py, "name": "propagator", "got": other)))
        }
    }
}

/// Creates the Python object of an orbit; if `reference` is given, it computes the states instead of the
/// engine.
fn wrap(
    sgp4: Sgp4,
    reference: Option<Satrec>,
    (constructor, arguments, keywords): (&str, &Bound<'_, PyTuple>, &Bound<'_, PyDict>),
) -> PyResult<PyClassInitializer<PySgp4>> {
    let sgp4 = match reference {
        Some(satrec) => sgp4.with_external(Arc::new(satrec)),
        None => sgp4,
    };
    let sgp4 = Arc::new(sgp4);
    let orbit = base(Arc::clone(&sgp4) as Arc<dyn Orbit>, constructor, arguments, keywords)?;
    Ok(PyClassInitializer::from(orbit).add_subclass(PySgp4 { sgp4 }))
}

/// Returns the mean elements of a `Satrec`; `None` if its epoch is not a valid date.
fn mean_elements(satrec: &Bound<'_, PyAny>) -> PyResult<Option<MeanElements>> {
    let number = |name: &str| satrec.getattr(name)?.extract::<f64>();
    let Some(epoch) = Epoch::of_julian_date(number("jdsatepoch")?, number("jdsatepochF")?) else {
        return Ok(None);
    };
    Ok(Some(MeanElements {
        satellite: satrec.getattr("satnum")?.extract()?,
        epoch,
        drag_term: number("bstar")?,
        inclination: number("inclo")?,
        raan: number("nodeo")?,
        eccentricity: number("ecco")?,
        argument_of_perigee: number("argpo")?,
        mean_anomaly: number("mo")?,
        mean_motion: number("no_kozai")?,
    }))
}

/// Creates an orbit with the epoch, elements and gravity constants of a `Satrec`.
fn of_satrec(
    satrec: &Bound<'_, PyAny>,
    propagator: &str,
    by_reference: bool,
) -> PyResult<PyClassInitializer<PySgp4>> {
    let py = satrec.py();
    let read = py.import("onorbit_rs.ephemeris.satrec")?.getattr("read")?.call1((satrec, by_reference))?;
    let (elements, gravity): (Bound<'_, PyAny>, String) = read.extract()?;
    let model = earth_model(py, &gravity)?;
    let set = mean_elements(&elements)?.ok_or_else(|| {
        plain(py, "ElementSetError", "the Satrec has no epoch; initialise it with twoline2rv or sgp4init")
    })?;
    let set = set.checked().map_err(|error| OrbitError::from(error).into_python(py))?;
    let reference =
        by_reference.then(|| Satrec::new(py, "of_elements", (&elements, &gravity))).transpose()?;
    let keywords = fields!(py, "propagator": propagator);
    let call = ("Sgp4", &(&elements,).into_pyobject(py)?, &keywords);
    wrap(Sgp4::new(set, model), reference, call)
}

#[pymethods]
impl PySgp4 {
    #[new]
    #[pyo3(signature = (line1, line2=None, *, gravity=None, check_checksum=true, propagator="native"))]
    fn new(
        line1: &Bound<'_, PyAny>,
        line2: Option<&str>,
        gravity: Option<&str>,
        check_checksum: bool,
        propagator: &str,
    ) -> PyResult<PyClassInitializer<Self>> {
        let (py, by_reference) = (line1.py(), is_reference(line1.py(), propagator)?);
        let (line1, line2) = match (line1.cast::<PyString>(), line2) {
            (Ok(line1), Some(line2)) => (&*line1.to_cow()?, line2),
            (Err(_), None) if gravity.is_none() => return of_satrec(line1, propagator, by_reference),
            _ => {
                let message = "the arguments are neither two lines of text nor a Satrec alone; give the two lines of \
                     an element set, or only a Satrec, which includes its gravity constants";
                return Err(raise(py, "InputError", message, &fields!(py, "name": "line1")));
            }
        };
        let gravity = gravity.unwrap_or("wgs72");
        let model = earth_model(py, gravity)?;
        let elements = MeanElements::from_tle(line1, line2, check_checksum).map_err(OrbitError::from);
        let sgp4 = Sgp4::new(elements.map_err(|error| error.into_python(py))?, model);
        let satrec =
            by_reference.then(|| Satrec::new(py, "of_lines", (line1, line2, gravity))).transpose()?;
        let arguments = (line1, line2).into_pyobject(py)?;
        let keywords =
            fields!(py, "gravity": gravity, "check_checksum": check_checksum, "propagator": propagator);
        wrap(sgp4, satrec, ("Sgp4", &arguments, &keywords))
    }

    /// Return the orbit of a CCSDS Orbit Mean-Elements Message.
    ///
    /// Parameters
    /// ----------
    /// message : mapping or str
    ///     Keywords of the message, or its text (JSON, XML, CSV or KVN).
    /// gravity, propagator
    ///     As for the constructor.
    ///
    /// Returns
    /// -------
    /// Sgp4
    ///
    /// Raises
    /// ------
    /// ElementSetError
    ///     If the message cannot be read or lacks a keyword, or if an entry is invalid.
    /// InputError
    ///     If ``gravity`` or ``propagator`` is unknown.
    #[staticmethod]
    #[pyo3(signature = (message, *, gravity="wgs72", propagator="native"))]
    fn from_omm<'py>(
        py: Python<'py>,
        message: &Bound<'py, PyAny>,
        gravity: &str,
        propagator: &str,
    ) -> PyResult<Bound<'py, Self>> {
        let (model, by_reference) = (earth_model(py, gravity)?, is_reference(py, propagator)?);
        let entries = if message.is_instance_of::<PyString>() {
            py.import("onorbit_rs.ephemeris.omm")?.getattr("entries")?.call1((message,))?
        } else {
            message.clone()
        };
        let mut texts = HashMap::new();
        for item in entries.call_method0("items").and_then(|items| items.try_iter()).map_err(|_| {
            let got = type_name(message);
            let text =
                format!("message is of type {got}; expected an OMM as text, or as a mapping of its keywords");
            plain(py, "ElementSetError", &text)
        })? {
            let (key, value): (String, Bound<'_, PyAny>) = item?.extract()?;
            if !value.is_none() {
                texts.insert(key, value.str()?.to_string());
            }
        }
        let elements = MeanElements::from_omm(|key| texts.get(key).cloned()).map_err(OrbitError::from);
        let sgp4 = Sgp4::new(elements.map_err(|error| error.into_python(py))?, model);
        let message = PyDict::from_sequence(texts.into_pyobject(py)?.items().as_any())?;
        let epoch = sgp4.elements().epoch.to_string();
        let satrec =
            by_reference.then(|| Satrec::new(py, "of_message", (&message, epoch, gravity))).transpose()?;
        let keywords = fields!(py, "gravity": gravity, "propagator": propagator);
        let call = ("Sgp4.from_omm", &(message,).into_pyobject(py)?, &keywords);
        Bound::new(py, wrap(sgp4, satrec, call)?)
    }

    /// Catalogue number of the satellite.
    #[getter]
    fn satellite(&self) -> u32 {
        self.sgp4.elements().satellite
    }

    /// Epoch of the element set, which is time zero: ISO 8601, UTC.
    #[getter]
    fn epoch(&self) -> String {
        self.sgp4.elements().epoch.to_string()
    }

    /// Epoch as a Julian date (UTC), days, in two parts: the date of midnight, and the fraction of the day.
    #[getter]
    fn julian_date(&self) -> (f64, f64) {
        self.sgp4.elements().epoch.julian_date()
    }

    /// Period of revolution, which corresponds to the mean motion, s.
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
