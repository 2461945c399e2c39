//! NRLMSISE-00 atmosphere, and the space weather on which it depends.

use super::{Any, PyAtmosphere};
use crate::arrays::fixed;
use crate::errors::{IntoPython, LARGEST_TABLE, fields, in_file, raise, unreadable};
use crate::pickling::absolute;
use onorbit_core::environment::atmosphere::{
    MagneticActivity, Nrlmsise00, SpaceIndices, SpaceWeather, SpaceWeatherTable,
};
use onorbit_core::text_file::read_text;
use pyo3::prelude::*;
use std::path::{Path, PathBuf};

/// NRLMSISE-00 atmosphere, whose density includes anomalous oxygen.
///
/// The model requires an ``earth`` with an epoch, and space weather: either the constants ``f107``, ``f107a``
/// and ``ap``, or a table. A value or day that is missing in the table raises ``EffectError`` when it is
/// needed.
///
/// Parameters
/// ----------
/// f107 : float, optional
///     Solar flux F10.7 of the previous day, 1e-22 W/(m² Hz).
/// f107a : float, optional
///     Mean of F10.7 over 81 days centred on the day, 1e-22 W/(m² Hz).
/// ap : float or (7,) array, optional
///     Geomagnetic index: either the daily mean, or a history that consists of the daily mean, the 3-hour
///     indices at the time and 3, 6 and 9 h before, and the means of 12-33 h and of 36-57 h before.
/// table : path, optional
///     CSV file with one row per day and the columns ``DATE, AP_AVG, F10.7_OBS, F10.7_OBS_CENTER81``, and
///     ``AP1`` to ``AP8`` for the three-hourly history (``SW-All.csv`` of CelesTrak).
/// three_hourly : bool
///     If False, only the daily mean of the geomagnetic index in the table is used.
///
/// Raises
/// ------
/// EffectError, ShapeError, NotFoundError, ReadError
///     If the space weather is incomplete, given twice or invalid, or the table does not exist or cannot be
///     read.
#[pyclass(name = "Nrlmsise00", extends = PyAtmosphere, frozen, module = "onorbit_rs")]
pub(super) struct PyNrlmsise00;

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
                    Some(_) => {
                        "space weather is given both as numbers and as a table; omit either f107, f107a and \
                         ap, or table"
                            .to_owned()
                    }
                    None => format!(
                        "the space weather lacks {}; give f107, f107a and ap, or a table of space weather",
                        missing.join(", ")
                    ),
                };
                return Err(raise(py, "EffectError", &message, &fields!(py, "name": "f107, f107a, ap")));
            }
        };
        let atmosphere = Nrlmsise00::new(weather);
        Ok(PyAtmosphere::new(atmosphere, "Nrlmsise00", &keywords)?.add_subclass(Self))
    }
}

/// Reads the daily mean or the history of the geomagnetic index.
fn activity(ap: Any<'_, '_>) -> PyResult<MagneticActivity> {
    if let Ok(daily) = ap.extract::<f64>() {
        return Ok(MagneticActivity::Daily(daily));
    }
    fixed::<7>(ap, "ap", &[7]).map(MagneticActivity::History)
}

/// Reads a CSV file of space weather; without `three_hourly`, only the daily means of the geomagnetic index.
fn read_table(py: Python<'_>, path: &Path, three_hourly: bool) -> PyResult<SpaceWeatherTable> {
    let text = read_text(path, LARGEST_TABLE)
        .map_err(|error| unreadable(py, path, "space weather table", &error))?;
    let table = SpaceWeatherTable::from_csv(&text)
        .map_err(|error| in_file(py, path, error))?
        .named(format!("the table {}", path.display()));
    Ok(if three_hourly { table } else { table.daily() })
}
