//! Epoch, orientation parameters and ephemerides of the Earth, read from Python arguments.

use crate::arrays::{Input, fixed, wrong_shape};
use crate::errors::{IntoPython, LARGEST_TABLE, fields, in_file, raise, unreadable};
use onorbit_core::earth::{
    Earth, EarthError, EarthParameters, Epoch, ROTATION_RATE, SpiceKernel, SpiceSegment,
};
use onorbit_core::text_file::read_text;
use pyo3::prelude::*;
use pyo3::types::PyString;
use std::path::PathBuf;

type Any<'a, 'py> = &'a Bound<'py, PyAny>;

/// Reads an epoch from text or from a `datetime` with a time zone.
pub(super) fn epoch(epoch: Any<'_, '_>) -> PyResult<Epoch> {
    let py = epoch.py();
    let text = if epoch.is_instance_of::<PyString>() {
        epoch.to_string()
    } else {
        let datetime = py.import("datetime")?;
        if !epoch.is_instance(&datetime.getattr("datetime")?)? {
            let fault = "it is neither a str nor a datetime".to_owned();
            return Err(EarthError::Epoch { text: epoch.repr()?.to_string(), fault }.into_python(py));
        }
        if epoch.call_method0("utcoffset")?.is_none() {
            let message = format!(
                "epoch {} has no time zone; set a time zone, such as tzinfo=datetime.UTC",
                epoch.repr()?
            );
            return Err(raise(py, "EarthError", &message, &fields!(py, "name": "epoch", "got": epoch)));
        }
        let utc = epoch.call_method1("astimezone", (datetime.getattr("timezone")?.getattr("utc")?,))?;
        utc.call_method1("strftime", ("%Y-%m-%dT%H:%M:%S.%f UTC",))?.to_string()
    };
    Epoch::parse(&text).map_err(|error| error.into_python(py))
}

/// Reads Earth orientation parameters from the table `eop`, or from UT1 - UTC, s, and polar motion, rad,
/// which are zero by default. A table together with either of the others is an error.
pub(super) fn earth_parameters(
    py: Python<'_>,
    eop: Option<Any<'_, '_>>,
    ut1_minus_utc: Option<f64>,
    polar_motion: Option<Any<'_, '_>>,
) -> PyResult<EarthParameters> {
    match (eop, ut1_minus_utc, polar_motion) {
        (Some(table), None, None) => parameter_table(table),
        (Some(_), ..) => {
            let message = "eop is given together with ut1_minus_utc or polar_motion, which eop replaces; omit \
                           either eop or the other two";
            Err(raise(py, "EarthError", message, &fields!(py,)))
        }
        (None, ut1_minus_utc, pole) => {
            let ut1_minus_utc = ut1_minus_utc.unwrap_or(0.0);
            let polar_motion = pole.map_or(Ok([0.0; 2]), |pole| fixed::<2>(pole, "polar_motion", &[2]))?;
            Ok(EarthParameters::Constant { ut1_minus_utc, polar_motion })
        }
    }
}

/// Creates an Earth that rotates uniformly about z, from `angle`, rad (default: 0), at `rate`, rad/s
/// (default: that of the Earth).
pub(super) fn about_z(
    py: Python<'_>,
    angle: Option<f64>,
    rate: Option<f64>,
    epoch: Option<Epoch>,
) -> PyResult<Earth> {
    let (angle, rate) = (angle.unwrap_or(0.0), rate.unwrap_or(ROTATION_RATE));
    for (name, value) in [("angle", angle), ("rate", rate)] {
        if !value.is_finite() {
            return Err(EarthError::NotFinite { name, value }.into_python(py));
        }
    }
    let earth = Earth::about_z(angle, rate);
    Ok(match epoch {
        Some(epoch) => earth.with_epoch(epoch),
        None => earth,
    })
}

/// Reads Earth orientation parameters from a file, or from rows (N, 4) with MJD (UTC), pole coordinates, rad,
/// and UT1 - UTC, s.
fn parameter_table(eop: Any<'_, '_>) -> PyResult<EarthParameters> {
    let py = eop.py();
    if let Ok(path) = eop.extract::<PathBuf>() {
        let text = read_text(&path, LARGEST_TABLE)
            .map_err(|error| unreadable(py, &path, "Earth-orientation table", &error))?;
        return EarthParameters::read(&text).map_err(|error| in_file(py, &path, error));
    }
    let rows = Input::new(eop, "eop")?;
    let [_, 4] = rows.shape() else { return Err(wrong_shape(py, "eop", "(N, 4)", rows.shape())) };
    Ok(EarthParameters::from_rows(rows.data().as_chunks().0))
}

/// Reads the positions of Sun and Moon from a SPICE kernel with PyPI's `jplephem`.
pub(super) fn spice_kernel(py: Python<'_>, path: PathBuf) -> PyResult<SpiceKernel> {
    type Parts<'py> = Vec<(f64, f64, f64, Bound<'py, PyAny>)>;
    let read = py.import("onorbit_rs.ephemeris.spice")?.getattr("segments")?;
    let (sun, moon): (Parts<'_>, Parts<'_>) = read.call1((path,))?.extract()?;
    let segments = |parts: Parts<'_>| {
        let segment = |(sign, start, length, array): (f64, f64, f64, Bound<'_, PyAny>)| {
            let array = Input::new(&array, "coefficients")?;
            let count = array.shape().last().copied().unwrap_or(0);
            Ok(SpiceSegment { sign, start, length, count, coefficients: array.data().to_vec() })
        };
        parts.into_iter().map(segment).collect::<PyResult<Vec<_>>>()
    };
    SpiceKernel::new(segments(sun)?, segments(moon)?).map_err(|error| error.into_python(py))
}
