//! Rotation of the Earth, time scales, and positions of the Sun and the Moon.
//!
//! `I` has inertial axes; `F` is fixed in the rotating Earth (ITRF, or a simple substitute for it).

mod arrays;
mod axes;
mod chebyshev;
mod epoch;
mod error;
mod geodetic;
mod moon_table;
mod nutation_table;
mod orientation;
mod parameters;
mod parameters_file;
mod precession;
mod rotation;
mod series;
mod spice;
mod sun_moon;
mod sun_moon_series;
mod sun_table;

use nalgebra::{Matrix3, Vector3};
use std::sync::Arc;

pub use axes::Axes;
pub use epoch::Epoch;
pub use error::EarthError;
pub use geodetic::{Ellipsoid, Geodetic, WGS84};
use orientation::Orientation;
pub use parameters::{EarthParameterRow, EarthParameters};
pub use rotation::ROTATION_RATE;
pub use spice::{SpiceKernel, SpiceSegment};
use sun_moon::SunMoon;

/// Model of the Earth in a run: rotation, and positions of the Sun and the Moon, as functions of time.
///
/// The methods that evaluate many instants are in `arrays.rs`.
#[derive(Clone, Debug, PartialEq)]
pub struct Earth {
    rotation: Rotation,
    sun_moon: Option<SunMoon>,
}

#[derive(Clone, Debug, PartialEq)]
enum Rotation {
    /// Uniform rotation about z of `I`; `inertial` defines the axes of `I` for the positions of Sun and Moon.
    AboutZ { angle: f64, rate: f64, inertial: Option<Box<Orientation>> },
    /// Rotation according to IAU 2006/2000A, with the Earth-orientation parameters that the user supplies.
    Iau2006(Box<Orientation>),
}

impl Earth {
    /// Creates an Earth that rotates uniformly about z of `I` at `rate`, rad/s; at time zero, `F` is rotated
    /// from `I` by `angle`, rad.
    pub fn about_z(angle: f64, rate: f64) -> Self {
        Self { rotation: Rotation::AboutZ { angle, rate, inertial: None }, sun_moon: None }
    }

    /// Creates an Earth that rotates according to IAU 2006/2000A, with GCRF axes and time zero at `epoch`.
    /// Its pole is accurate to 2 mas (6 cm on the ground).
    ///
    /// # Errors
    /// [`EarthError::Parameter`] and [`EarthError::ShortTable`] for invalid parameters;
    /// [`EarthError::OutsideSpan`] if the table of parameters does not contain the epoch.
    pub fn new(epoch: Epoch, parameters: &EarthParameters) -> Result<Self, EarthError> {
        let orientation = Orientation::new(epoch, Axes::Gcrf, parameters, epoch.series_span())?;
        let earth = Self {
            rotation: Rotation::Iau2006(Box::new(orientation)),
            sun_moon: Some(SunMoon::new(epoch, None)),
        };
        earth.covers(0.0)?;
        Ok(earth)
    }

    /// Returns the same Earth with time zero at `epoch`, without a kernel: the positions of Sun and Moon come
    /// from series. An Earth with uniform rotation then has GCRF axes. For an Earth of IAU 2006, `epoch` must
    /// be the epoch it was created with, because its rotation is not recomputed.
    pub fn with_epoch(mut self, epoch: Epoch) -> Self {
        if let Rotation::AboutZ { inertial, .. } = &mut self.rotation {
            *inertial = Some(Box::new(Orientation::of_axes(epoch, epoch.series_span())));
        }
        Self { sun_moon: Some(SunMoon::new(epoch, None)), ..self }
    }

    /// Returns the same Earth with the positions of Sun and Moon from a SPICE kernel.
    ///
    /// # Errors
    /// [`EarthError::NeedsEpoch`] without an epoch; [`EarthError::OutsideSpan`] if the epoch is outside the
    /// span of the kernel, which consists of whole intervals of eight days.
    pub fn with_kernel(self, kernel: SpiceKernel) -> Result<Self, EarthError> {
        let what = "the SPICE kernel of Sun and Moon";
        let epoch = self.epoch().ok_or(EarthError::NeedsEpoch { what })?;
        let sun_moon = SunMoon::new(epoch, Some(Arc::new(kernel)));
        check_span(what, 0.0, epoch, sun_moon.span)?;
        Ok(Self { sun_moon: Some(sun_moon), ..self })
    }

    /// Returns the same Earth with the inertial axes `axes`. A uniform rotation without an epoch is
    /// compatible with any axes and does not change.
    pub fn in_axes(&self, axes: Axes) -> Self {
        let rotation = match &self.rotation {
            Rotation::AboutZ { angle, rate, inertial } => {
                let inertial = inertial.as_ref().map(|inertial| Box::new(inertial.in_axes(axes)));
                Rotation::AboutZ { angle: *angle, rate: *rate, inertial }
            }
            Rotation::Iau2006(orientation) => Rotation::Iau2006(Box::new(orientation.in_axes(axes))),
        };
        Self { rotation, sun_moon: self.sun_moon.as_ref().map(SunMoon::with_empty_cache) }
    }

    /// Returns the axes of `I`; `None` for a uniform rotation without an epoch, which is compatible with any
    /// axes.
    pub fn axes(&self) -> Option<Axes> {
        match &self.rotation {
            Rotation::AboutZ { inertial, .. } => inertial.as_ref().map(|inertial| inertial.axes()),
            Rotation::Iau2006(orientation) => Some(orientation.axes()),
        }
    }

    /// Returns the epoch, which is time zero of the run; `None` if none was given.
    pub fn epoch(&self) -> Option<Epoch> {
        self.sun_moon.as_ref().map(|sun_moon| sun_moon.epoch)
    }

    /// Checks that the rotation of the Earth is known at simulation time `t`, s.
    ///
    /// # Errors
    /// [`EarthError::NotFinite`] for `t`; with an epoch, [`EarthError::OutsideSpan`] outside the table of
    /// parameters or outside the years 1900 to 2100.
    pub fn covers(&self, t: f64) -> Result<(), EarthError> {
        if !t.is_finite() {
            return Err(EarthError::NotFinite { name: "time", value: t });
        }
        let Some(epoch) = self.epoch() else { return Ok(()) };
        let table = match &self.rotation {
            Rotation::AboutZ { .. } => None,
            Rotation::Iau2006(orientation) => orientation.parameters().span(),
        };
        check_span("the rotation of the Earth", t, epoch, epoch.series_span())?;
        table.map_or(Ok(()), |span| check_span("the table of Earth-orientation parameters", t, epoch, span))
    }

    /// Checks that an orbit in `axes` with time zero at `epoch` is compatible with this Earth. An orbit or an
    /// Earth without an epoch is compatible with any epoch.
    ///
    /// # Errors
    /// [`EarthError::OtherAxes`] for different axes, and [`EarthError::OtherEpoch`] for epochs more than a
    /// millisecond apart.
    pub fn check_orbit(&self, axes: Axes, epoch: Option<Epoch>) -> Result<(), EarthError> {
        if let Some(own) = self.axes().filter(|own| *own != axes) {
            return Err(EarthError::OtherAxes { orbit: axes.name(), run: own.name() });
        }
        match (epoch, self.epoch()) {
            (Some(orbit), Some(run)) if orbit.since(run).abs() > 1e-3 => {
                Err(EarthError::OtherEpoch { orbit: orbit.to_string(), run: run.to_string() })
            }
            _ => Ok(()),
        }
    }

    /// Returns the rotation from components in `I` to components in `F` at simulation time `t`, s.
    ///
    /// Outside the span that the Earth [covers](Self::covers), the parameters and the pole are those at the
    /// nearest end of the span.
    pub fn rot_fi(&self, t: f64) -> Matrix3<f64> {
        match &self.rotation {
            Rotation::AboutZ { angle, rate, .. } => rotation::r3(angle + rate * t),
            Rotation::Iau2006(orientation) => orientation.rot_fi(t),
        }
    }

    /// Returns the angular velocity of `F` with respect to `I` at simulation time `t`, s, axes of `I`, rad/s.
    pub fn angular_velocity(&self, t: f64) -> Vector3<f64> {
        match &self.rotation {
            Rotation::AboutZ { rate, .. } => Vector3::z() * *rate,
            Rotation::Iau2006(orientation) => orientation.angular_velocity(t),
        }
    }

    /// Returns the geometric position of the Sun from the Earth's centre at simulation time `t`, s, axes of
    /// `I`, m, without correction for light time.
    ///
    /// Without a kernel, direction and distance are within 2″ and 4e-6 of JPL's DE421 from 1900 to 2050.
    ///
    /// # Errors
    /// [`EarthError::NeedsEpoch`] without an epoch; [`EarthError::OutsideSpan`] outside 1900 to 2100 or
    /// outside the kernel.
    pub fn sun(&self, t: f64) -> Result<Vector3<f64>, EarthError> {
        let sun_moon = self.sun_moon_at("the position of the Sun", t)?;
        Ok(sun_moon.sun(t, |t| self.rot_ig(t)))
    }

    /// Returns the geometric position of the Moon from the Earth's centre at simulation time `t`, s, axes of
    /// `I`, m, without correction for light time.
    ///
    /// Without a kernel, direction and distance are within 10″ and 3e-5 of JPL's DE421 from 1900 to 2050.
    ///
    /// # Errors
    /// The errors of [`Earth::sun`].
    pub fn moon(&self, t: f64) -> Result<Vector3<f64>, EarthError> {
        let sun_moon = self.sun_moon_at("the position of the Moon", t)?;
        Ok(sun_moon.moon(t, |t| self.rot_ig(t)))
    }

    /// Returns the modified Julian date of UTC and the seconds since midnight at simulation time `t`, s; leap
    /// seconds after the epoch are not counted.
    ///
    /// # Errors
    /// [`EarthError::NeedsEpoch`] without an epoch.
    pub fn utc(&self, t: f64) -> Result<(i64, f64), EarthError> {
        self.sun_moon.as_ref().map(|sun_moon| sun_moon.utc(t)).ok_or(EarthError::NeedsEpoch { what: "UTC" })
    }

    fn sun_moon_at(&self, what: &'static str, t: f64) -> Result<&SunMoon, EarthError> {
        let sun_moon = self.sun_moon.as_ref().ok_or(EarthError::NeedsEpoch { what })?;
        check_span(what, t, sun_moon.epoch, sun_moon.span).map(|()| sun_moon)
    }

    /// Returns the rotation from GCRF components to components in `I` at simulation time `t`, s.
    fn rot_ig(&self, t: f64) -> Matrix3<f64> {
        match &self.rotation {
            Rotation::AboutZ { inertial, .. } => {
                inertial.as_ref().map_or_else(Matrix3::identity, |inertial| inertial.rot_ig(t))
            }
            Rotation::Iau2006(orientation) => orientation.rot_ig(t),
        }
    }
}

/// Returns an error unless the simulation time `t`, s, lies between `from` and `to`, the span in which the
/// quantity named `what` is known.
fn check_span(what: &'static str, t: f64, epoch: Epoch, (from, to): (f64, f64)) -> Result<(), EarthError> {
    if (from..=to).contains(&t) {
        return Ok(());
    }
    let text = |t| epoch.after(t).to_string();
    let (from, to, epoch) = (text(from), text(to), epoch.to_string());
    Err(EarthError::OutsideSpan { what, time: t, epoch, from, to })
}
