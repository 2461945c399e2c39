//! The turning Earth, and the sky above it.

use crate::arrays::{Input, fixed, fresh, wrong_shape, zeros};
use crate::errors::{IntoPython, LARGEST_TABLE, fields, in_file, raise, unreadable};
use crate::interrupt::in_pieces;
use crate::orbit::times;
use onorbit_core::earth::{
    Axes, Earth, EarthError, EarthParameters, Epoch, Kernel, KernelSegment, ROTATION_RATE,
};
use onorbit_core::orbit::Orbit;
use onorbit_core::text_file::read_text;
use pyo3::prelude::*;
use pyo3::types::{PyString, PyTuple};
use std::path::PathBuf;
use std::sync::Arc;

type Any<'a, 'py> = &'a Bound<'py, PyAny>;

/// When a run takes place, how the Earth turns meanwhile, and where Sun and Moon are.
///
/// ``epoch`` is time zero: text with its time scale, ``2024-03-01T12:00:00 UTC`` (or ``Z``, TAI, TT, TDB), or an aware
/// ``datetime``. ``rotation`` is ``iau2006`` (precession of IAU 2006, nutation of 2000A to 2 mas), or ``about_z``: evenly
/// about z by ``angle``, rad, at time zero and ``rate``, rad/s; without an epoch it has no Sun and no Moon. UT1 and the pole
/// are measured, so they come from you: ``ut1_minus_utc``, s, and ``polar_motion`` (2,), rad, constant through the run; or
/// ``eop``, a file (the IERS' ``finals2000A`` or ``eopc04``, or lines below ``mjd,x_arcsec,y_arcsec,ut1_minus_utc_s``) or
/// rows (N, 4) of MJD (UTC), the pole, rad, and UT1-UTC, s. Sun and Moon are those of a short analytic series (2″ and 10″ of
/// JPL's DE421 over 1900-2050), or of a SPICE kernel, ``ephemeris`` (``de440s.bsp``), read by PyPI's jplephem. ``axes`` of what is asked here: ``GCRF`` or ``TEME``; a run takes
/// its orbit's.
#[pyclass(name = "Earth", frozen, module = "onorbit_rs")]
pub(crate) struct PyEarth {
    pub(crate) earth: Arc<Earth>,
    /// Arguments and keywords that make it again.
    made: Py<PyTuple>,
}

#[pymethods]
impl PyEarth {
    #[new]
    #[pyo3(signature = (
        epoch=None, *, rotation="iau2006", ut1_minus_utc=None, polar_motion=None, eop=None, angle=None, rate=None,
        ephemeris=None, axes="GCRF",
    ))]
    fn new(
        py: Python<'_>,
        epoch: Option<Any<'_, '_>>,
        rotation: &str,
        ut1_minus_utc: Option<f64>,
        polar_motion: Option<Any<'_, '_>>,
        eop: Option<Any<'_, '_>>,
        angle: Option<f64>,
        rate: Option<f64>,
        ephemeris: Option<PathBuf>,
        axes: &str,
    ) -> PyResult<Self> {
        let keywords = fields!(
            py, "epoch": epoch, "rotation": rotation, "ut1_minus_utc": ut1_minus_utc, "polar_motion": polar_motion,
            "eop": eop, "angle": angle, "rate": rate,
            "ephemeris": &ephemeris, "axes": axes,
        );
        let refuse = |message: &str| raise(py, "EarthError", message, &fields!(py,));
        let epoch = epoch.map(instant).transpose()?;
        let earth = match rotation {
            "iau2006" if angle.is_some() || rate.is_some() => {
                return Err(refuse("angle and rate are for rotation 'about_z': 'iau2006' knows its own"));
            }
            "iau2006" => {
                let parameters = match (eop, ut1_minus_utc, polar_motion) {
                    (Some(table), None, None) => table_of(table)?,
                    (Some(_), ..) => {
                        return Err(refuse("give eop, or ut1_minus_utc and polar_motion, not both"));
                    }
                    (None, ut1_minus_utc, pole) => EarthParameters::Constant {
                        ut1_minus_utc: ut1_minus_utc.unwrap_or(0.0),
                        polar_motion: pole
                            .map_or(Ok([0.0; 2]), |pole| fixed::<2>(pole, "polar_motion", &[2]))?,
                    },
                };
                let what = "rotation 'iau2006'";
                let epoch = epoch.ok_or_else(|| EarthError::NeedsEpoch { what }.into_python(py))?;
                Earth::new(epoch, &parameters).map_err(|error| error.into_python(py))?
            }
            "about_z" if eop.is_some() || ut1_minus_utc.is_some() || polar_motion.is_some() => {
                return Err(refuse(
                    "UT1 and the pole are for rotation 'iau2006': 'about_z' takes angle and rate",
                ));
            }
            "about_z" => {
                let (angle, rate) = (angle.unwrap_or(0.0), rate.unwrap_or(ROTATION_RATE));
                for (name, value) in [("angle", angle), ("rate", rate)] {
                    if !value.is_finite() {
                        return Err(EarthError::NotFinite { name, value }.into_python(py));
                    }
                }
                let earth = Earth::about_z(angle, rate);
                match epoch {
                    Some(epoch) => earth.with_epoch(epoch),
                    None => earth,
                }
            }
            other => {
                let message = format!("rotation is '{other}'; there are 'iau2006' and 'about_z'");
                return Err(raise(
                    py,
                    "EarthError",
                    &message,
                    &fields!(py, "name": "rotation", "got": other),
                ));
            }
        };
        let earth = match ephemeris {
            Some(path) => earth.with_kernel(kernel_of(py, path)?).map_err(|error| error.into_python(py))?,
            None => earth,
        };
        let earth = match axes {
            "GCRF" => earth,
            "TEME" => earth.in_axes(Axes::Teme),
            other => {
                let message = format!("axes is '{other}'; there are 'GCRF' and 'TEME'");
                return Err(raise(py, "EarthError", &message, &fields!(py, "name": "axes", "got": other)));
            }
        };
        let made = ("Earth", PyTuple::empty(py), keywords).into_pyobject(py)?.unbind();
        Ok(Self { earth: Arc::new(earth), made })
    }

    /// Time zero: ISO 8601, UTC (TAI before 1972); None where there is none.
    #[getter]
    fn epoch(&self) -> Option<String> {
        self.earth.epoch().map(|epoch| epoch.to_string())
    }

    /// Inertial axes of what is asked here: ``GCRF`` or ``TEME``; None for one that turns about z without an epoch.
    #[getter]
    fn axes(&self) -> Option<&'static str> {
        self.earth.axes().map(Axes::name)
    }

    /// ``rot_fi`` at ``t`` s: (3, 3), or (T, 3, 3) for (T,) times; takes inertial components to Earth-fixed ones (ITRF).
    fn rotation<'py>(&self, py: Python<'py>, t: Any<'_, 'py>) -> PyResult<Bound<'py, PyAny>> {
        self.at(py, t, &[3, 3], Earth::rotations)
    }

    /// Angular velocity of the Earth, inertial axes, at ``t`` s: (3,) or (T, 3), rad/s.
    fn angular_velocity<'py>(&self, py: Python<'py>, t: Any<'_, 'py>) -> PyResult<Bound<'py, PyAny>> {
        self.at(py, t, &[3], Earth::angular_velocities)
    }

    /// The Sun's centre from the Earth's, inertial axes, at ``t`` s: (3,) or (T, 3), m; without light time and aberration.
    fn sun<'py>(&self, py: Python<'py>, t: Any<'_, 'py>) -> PyResult<Bound<'py, PyAny>> {
        self.at(py, t, &[3], Earth::suns)
    }

    /// The Moon's centre from the Earth's, inertial axes, at ``t`` s: (3,) or (T, 3), m.
    fn moon<'py>(&self, py: Python<'py>, t: Any<'_, 'py>) -> PyResult<Bound<'py, PyAny>> {
        self.at(py, t, &[3], Earth::moons)
    }

    /// Earth-fixed position of ``r`` (3,) or (T, 3), m from the Earth's centre in inertial axes, at ``t`` s.
    fn to_fixed<'py>(
        &self,
        py: Python<'py>,
        t: Any<'_, 'py>,
        r: Any<'_, 'py>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let r = Input::new(r, "r")?;
        self.of(py, t, &r, Earth::to_fixed)
    }

    /// Latitude, longitude (rad) and altitude (m) above WGS84 of ``r`` (3,) or (T, 3), m from the Earth's centre in
    /// inertial axes, at ``t`` s: three numbers, or three (T,).
    fn geodetic<'py>(
        &self,
        py: Python<'py>,
        t: Any<'_, 'py>,
        r: Any<'_, 'py>,
    ) -> PyResult<Bound<'py, PyTuple>> {
        let r = Input::new(r, "r")?;
        let places = self.of(py, t, &r, Earth::geodetics)?;
        let part = |k: usize| places.get_item((py.Ellipsis(), k));
        PyTuple::new(py, [part(0)?, part(1)?, part(2)?])
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, Py<PyTuple>)> {
        Ok((py.import("onorbit_rs.rebuild")?.getattr("rebuild")?, self.made.clone_ref(py)))
    }

    fn __repr__(&self) -> String {
        let epoch = self.epoch().map_or("no epoch".to_owned(), |epoch| format!("epoch {epoch}"));
        format!("<Earth: {epoch}, {}>", self.axes().unwrap_or("about z"))
    }
}

type AtTimes = fn(&Earth, &[f64], &mut [f64]) -> Result<(), EarthError>;
type OfPositions = fn(&Earth, &[f64], &[f64], &mut [f64]) -> Result<(), EarthError>;

impl PyEarth {
    /// The Earth in the axes of an orbit.
    pub(crate) fn beneath(&self, orbit: Option<&dyn Orbit>) -> Arc<Earth> {
        match orbit {
            Some(orbit) if self.earth.axes().is_some_and(|axes| axes != orbit.axes()) => {
                Arc::new(self.earth.in_axes(orbit.axes()))
            }
            _ => Arc::clone(&self.earth),
        }
    }

    fn at<'py>(
        &self,
        py: Python<'py>,
        t: Any<'_, 'py>,
        tail: &[usize],
        fill: AtTimes,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (times, shape) = times(t)?;
        let result = zeros(py, &[&shape, tail].concat())?;
        let into = fresh(&result);
        let width = tail.iter().product::<usize>();
        in_pieces(py, times.len(), 4096, |range| {
            fill(&self.earth, &times[range.clone()], &mut into[width * range.start..width * range.end])
        })?;
        Ok(result.into_any())
    }

    fn of<'py>(
        &self,
        py: Python<'py>,
        t: Any<'_, 'py>,
        r: &Input<'py>,
        fill: OfPositions,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (times, shape) = times(t)?;
        let expected = [shape.as_slice(), &[3]].concat();
        if r.shape() != expected {
            return Err(wrong_shape(py, "r", &crate::arrays::shape_text(&expected), r.shape()));
        }
        let result = zeros(py, &expected)?;
        let (positions, into) = (r.data(), fresh(&result));
        in_pieces(py, times.len(), 4096, |range| {
            let places = 3 * range.start..3 * range.end;
            fill(&self.earth, &times[range], &positions[places.clone()], &mut into[places])
        })?;
        Ok(result.into_any())
    }
}

/// An epoch from text or an aware ``datetime``.
fn instant(epoch: Any<'_, '_>) -> PyResult<Epoch> {
    let py = epoch.py();
    let text = if epoch.is_instance_of::<PyString>() {
        epoch.to_string()
    } else {
        let datetime = py.import("datetime")?;
        if !epoch.is_instance(&datetime.getattr("datetime")?)? {
            return Err(EarthError::Epoch { text: epoch.repr()?.to_string() }.into_python(py));
        }
        if epoch.call_method0("utcoffset")?.is_none() {
            let message = format!(
                "epoch is {}, which names no time zone: give it one, such as tzinfo=datetime.UTC",
                epoch.repr()?
            );
            return Err(raise(py, "EarthError", &message, &fields!(py, "name": "epoch", "got": epoch)));
        }
        let utc = epoch.call_method1("astimezone", (datetime.getattr("timezone")?.getattr("utc")?,))?;
        utc.call_method1("strftime", ("%Y-%m-%dT%H:%M:%S.%f UTC",))?.to_string()
    };
    Epoch::parse(&text).map_err(|error| error.into_python(py))
}

/// Earth-orientation parameters from a file, or from rows.
fn table_of(eop: Any<'_, '_>) -> PyResult<EarthParameters> {
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

/// Sun and Moon of a SPICE kernel; Python's `jplephem` reads it.
fn kernel_of(py: Python<'_>, path: PathBuf) -> PyResult<Kernel> {
    type Parts<'py> = Vec<(f64, f64, f64, Bound<'py, PyAny>)>;
    let read = py.import("onorbit_rs.kernel")?.getattr("segments")?;
    let (sun, moon): (Parts<'_>, Parts<'_>) = read.call1((path,))?.extract()?;
    let segments = |parts: Parts<'_>| {
        let segment = |(sign, start, length, array): (f64, f64, f64, Bound<'_, PyAny>)| {
            let array = Input::new(&array, "coefficients")?;
            let count = array.shape().last().copied().unwrap_or(0);
            Ok(KernelSegment { sign, start, length, count, coefficients: array.data().to_vec() })
        };
        parts.into_iter().map(segment).collect::<PyResult<Vec<_>>>()
    };
    Kernel::new(segments(sun)?, segments(moon)?).map_err(|error| error.into_python(py))
}
