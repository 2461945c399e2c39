//! The class `Earth`: epoch, rotation of the Earth, and positions of the Sun and the Moon.

mod inputs;

use crate::arrays::{Input, fresh, shape_text, times, wrong_shape, zeros};
use crate::errors::{IntoPython, fields, raise};
use crate::interrupt::in_pieces;
use crate::pickling::{ConstructorCall, Reduced};
use onorbit_core::earth::{Axes, Earth, EarthError};
use onorbit_core::orbit::Orbit;
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use std::path::PathBuf;
use std::sync::Arc;

type Any<'a, 'py> = &'a Bound<'py, PyAny>;

/// Epoch of a run, orientation of the Earth, and positions of the Sun and the Moon.
///
/// UT1 and polar motion are measured quantities that the user supplies as constants or as a table. By default
/// they are zero.
///
/// Parameters
/// ----------
/// epoch : str or datetime, optional
///     Time zero: text with its time scale, such as ``2024-03-01T12:00:00 UTC`` (or ``Z``, TAI, TT, TDB), or
///     a ``datetime`` with a time zone. ``iau2006`` requires an epoch.
/// rotation : {"iau2006", "about_z"}
///     ``iau2006`` is the precession of IAU 2006 with the nutation of 2000A (accurate to 2 mas); ``about_z``
///     is a uniform rotation about z. Without an epoch, ``about_z`` provides no positions of the Sun and the
///     Moon.
/// ut1_minus_utc : float, optional
///     UT1 - UTC for ``iau2006``, constant during the run, s; default: 0.
/// polar_motion : (2,) array, optional
///     Coordinates ``(x_p, y_p)`` of the pole for ``iau2006``, constant during the run, rad; default: 0.
/// eop : path or (N, 4) array, optional
///     Table of Earth orientation parameters, which replaces ``ut1_minus_utc`` and ``polar_motion``: a file
///     (``finals2000A`` or ``eopc04`` of the IERS, or CSV with the header
///     ``mjd,x_arcsec,y_arcsec,ut1_minus_utc_s``), or rows of MJD (UTC), coordinates of the pole, rad, and
///     UT1 - UTC, s.
/// angle : float, optional
///     Rotation angle at time zero for ``about_z``, rad; default: 0.
/// rate : float, optional
///     Angular velocity for ``about_z``, rad/s; default: that of the Earth.
/// ephemeris : path, optional
///     SPICE kernel for the Sun and the Moon, such as ``de440s.bsp``, read by PyPI's jplephem. By default the
///     positions are computed from analytic series, whose directions differ from JPL's DE421 by at most 2″
///     (Sun) and 10″ (Moon) from 1900 to 2050.
/// axes : {"GCRF", "TEME"}
///     Inertial axes used by the methods; a run uses the axes of its orbit.
///
/// Raises
/// ------
/// EarthError, ShapeError, NotFoundError, ReadError
///     If an argument is invalid or does not apply to the chosen ``rotation``, if an array has the wrong
///     shape, or if a file does not exist or cannot be read.
#[pyclass(name = "Earth", frozen, module = "onorbit_rs")]
pub(crate) struct PyEarth {
    pub(crate) earth: Arc<Earth>,
    constructor_call: ConstructorCall,
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
        let epoch = epoch.map(inputs::epoch).transpose()?;
        let earth = match rotation {
            "iau2006" if angle.is_some() || rate.is_some() => {
                let message = "angle or rate is given for rotation 'iau2006', but both apply only to 'about_z'; \
                               omit them";
                return Err(raise(py, "EarthError", message, &fields!(py,)));
            }
            "iau2006" => {
                let what = "rotation 'iau2006'";
                let epoch = epoch.ok_or_else(|| EarthError::NeedsEpoch { what }.into_python(py))?;
                let parameters = inputs::earth_parameters(py, eop, ut1_minus_utc, polar_motion)?;
                Earth::new(epoch, &parameters).map_err(|error| error.into_python(py))?
            }
            "about_z" if eop.is_some() || ut1_minus_utc.is_some() || polar_motion.is_some() => {
                let message = "eop, ut1_minus_utc or polar_motion is given for rotation 'about_z', but all \
                               three apply only to 'iau2006'; give angle and rate instead";
                return Err(raise(py, "EarthError", message, &fields!(py,)));
            }
            "about_z" => inputs::about_z(py, angle, rate, epoch)?,
            other => return Err(unknown(py, "rotation", other, "'iau2006' and 'about_z'")),
        };
        let earth = match ephemeris {
            Some(path) => {
                let kernel = inputs::spice_kernel(py, path)?;
                earth.with_kernel(kernel).map_err(|error| error.into_python(py))?
            }
            None => earth,
        };
        let earth = match axes {
            "GCRF" => earth,
            "TEME" => earth.in_axes(Axes::Teme),
            other => return Err(unknown(py, "axes", other, "'GCRF' and 'TEME'")),
        };
        let constructor_call = ConstructorCall::with_keywords("Earth", &keywords)?;
        Ok(Self { earth: Arc::new(earth), constructor_call })
    }

    /// Epoch of time zero as ISO 8601 text in UTC (TAI before 1972); None without an epoch.
    #[getter]
    fn epoch(&self) -> Option<String> {
        self.earth.epoch().map(|epoch| epoch.to_string())
    }

    /// Inertial axes used by the methods: ``GCRF`` or ``TEME``; None for rotation about z without an epoch.
    #[getter]
    fn axes(&self) -> Option<&'static str> {
        self.earth.axes().map(Axes::name)
    }

    /// Return the rotation matrix from inertial axes (:attr:`axes`) to Earth-fixed axes.
    ///
    /// Earth-fixed axes are ITRF axes for ``iau2006`` and uniformly rotating axes for ``about_z``.
    ///
    /// Parameters
    /// ----------
    /// t : float or (T,) array
    ///     Simulation time, s.
    ///
    /// Returns
    /// -------
    /// (3, 3) or (T, 3, 3) array
    ///     Rotation matrix ``rot_fi``, dimensionless: ``rot_fi @ r`` has Earth-fixed components if ``r`` has
    ///     inertial components.
    ///
    /// Raises
    /// ------
    /// EarthError
    ///     If a time is not finite or outside the table of orientation parameters.
    fn rotation<'py>(&self, py: Python<'py>, t: Any<'_, 'py>) -> PyResult<Bound<'py, PyAny>> {
        self.at(py, t, &[3, 3], Earth::rotations)
    }

    /// Return the angular velocity of the Earth relative to inertial axes.
    ///
    /// Parameters
    /// ----------
    /// t : float or (T,) array
    ///     Simulation time, s.
    ///
    /// Returns
    /// -------
    /// (3,) or (T, 3) array
    ///     Angular velocity, inertial axes, rad/s.
    ///
    /// Raises
    /// ------
    /// EarthError
    ///     If a time is not finite or outside the table of orientation parameters.
    fn angular_velocity<'py>(&self, py: Python<'py>, t: Any<'_, 'py>) -> PyResult<Bound<'py, PyAny>> {
        self.at(py, t, &[3], Earth::angular_velocities)
    }

    /// Return the geometric position of the Sun, without correction for light time and aberration.
    ///
    /// Parameters
    /// ----------
    /// t : float or (T,) array
    ///     Simulation time, s.
    ///
    /// Returns
    /// -------
    /// (3,) or (T, 3) array
    ///     Position from the Earth's centre, inertial axes, m.
    ///
    /// Raises
    /// ------
    /// EarthError
    ///     If the Earth has no epoch, or a time is not finite, outside 1900 to 2100, or outside the kernel.
    fn sun<'py>(&self, py: Python<'py>, t: Any<'_, 'py>) -> PyResult<Bound<'py, PyAny>> {
        self.at(py, t, &[3], Earth::suns)
    }

    /// Return the geometric position of the Moon, without correction for light time and aberration.
    ///
    /// Parameters
    /// ----------
    /// t : float or (T,) array
    ///     Simulation time, s.
    ///
    /// Returns
    /// -------
    /// (3,) or (T, 3) array
    ///     Position from the Earth's centre, inertial axes, m.
    ///
    /// Raises
    /// ------
    /// EarthError
    ///     If the Earth has no epoch, or a time is not finite, outside 1900 to 2100, or outside the kernel.
    fn moon<'py>(&self, py: Python<'py>, t: Any<'_, 'py>) -> PyResult<Bound<'py, PyAny>> {
        self.at(py, t, &[3], Earth::moons)
    }

    /// Convert a position from inertial to Earth-fixed axes.
    ///
    /// Parameters
    /// ----------
    /// t : float or (T,) array
    ///     Simulation time, s.
    /// r : (3,) or (T, 3) array
    ///     Position from the Earth's centre, inertial axes, m.
    ///
    /// Returns
    /// -------
    /// (3,) or (T, 3) array
    ///     Position from the Earth's centre, Earth-fixed axes, m.
    ///
    /// Raises
    /// ------
    /// EarthError, ShapeError
    ///     If a time is not finite or outside the table of orientation parameters, or if the shapes do not
    ///     match.
    fn to_fixed<'py>(
        &self,
        py: Python<'py>,
        t: Any<'_, 'py>,
        r: Any<'_, 'py>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let r = Input::new(r, "r")?;
        self.of(py, t, &r, Earth::to_fixed)
    }

    /// Return the geodetic coordinates of a position.
    ///
    /// Parameters
    /// ----------
    /// t : float or (T,) array
    ///     Simulation time, s.
    /// r : (3,) or (T, 3) array
    ///     Position from the Earth's centre, inertial axes, m.
    ///
    /// Returns
    /// -------
    /// latitude, longitude : float or (T,) array
    ///     Geodetic coordinates on WGS84, rad.
    /// altitude : float or (T,) array
    ///     Altitude above WGS84, m.
    ///
    /// Raises
    /// ------
    /// EarthError, ShapeError
    ///     If a time is not finite or outside the table of orientation parameters, a position is not finite
    ///     or too close to the Earth's centre, or the shapes do not match.
    fn geodetic<'py>(
        &self,
        py: Python<'py>,
        t: Any<'_, 'py>,
        r: Any<'_, 'py>,
    ) -> PyResult<Bound<'py, PyTuple>> {
        let r = Input::new(r, "r")?;
        let coordinates = self.of(py, t, &r, Earth::geodetics)?;
        let part = |k: usize| coordinates.get_item((py.Ellipsis(), k));
        PyTuple::new(py, [part(0)?, part(1)?, part(2)?])
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        self.constructor_call.reduce(py)
    }

    fn __repr__(&self) -> String {
        let epoch = self.epoch().map_or("no epoch".to_owned(), |epoch| format!("epoch {epoch}"));
        format!("<Earth: {epoch}, {}>", self.axes().unwrap_or("about z"))
    }
}

/// Returns the error for an argument that is not one of the choices, which the text `known` lists.
fn unknown(py: Python<'_>, name: &str, got: &str, known: &str) -> PyErr {
    let message = format!("{name} is '{got}'; the choices are {known}");
    raise(py, "EarthError", &message, &fields!(py, "name": name, "got": got))
}

/// Function of the core that computes a quantity at each of the given times.
type AtTimes = fn(&Earth, &[f64], &mut [f64]) -> Result<(), EarthError>;
/// Function of the core that computes three numbers from each position and its time.
type OfPositions = fn(&Earth, &[f64], &[f64], &mut [f64]) -> Result<(), EarthError>;

impl PyEarth {
    /// Returns the Earth with the inertial axes of an orbit. Without an orbit, or if the Earth has no
    /// inertial axes, the Earth is unchanged.
    pub(crate) fn in_axes_of(&self, orbit: Option<&dyn Orbit>) -> Arc<Earth> {
        match orbit {
            Some(orbit) if self.earth.axes().is_some_and(|axes| axes != orbit.axes()) => {
                Arc::new(self.earth.in_axes(orbit.axes()))
            }
            _ => Arc::clone(&self.earth),
        }
    }

    /// Evaluates a quantity at one time or at an array of times.
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

    /// Computes three numbers from the position at one time, or from each position of an array.
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
            return Err(wrong_shape(py, "r", &shape_text(&expected), r.shape()));
        }
        let result = zeros(py, &expected)?;
        let (positions, into) = (r.data(), fresh(&result));
        in_pieces(py, times.len(), 4096, |range| {
            let rows = 3 * range.start..3 * range.end;
            fill(&self.earth, &times[range], &positions[rows.clone()], &mut into[rows])
        })?;
        Ok(result.into_any())
    }
}
