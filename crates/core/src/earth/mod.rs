//! The Earth as the inertial axes see it: when, how it turns, and where Sun and Moon are.
//!
//! `I` has inertial axes, `F` is fixed in the turning Earth (ITRF, or a stand-in for it).

mod epoch;
mod error;
mod geodetic;
mod kernel;
mod many;
mod moon_table;
mod nutation_table;
mod orientation;
mod parameters;
mod parameters_file;
mod pieces;
mod precession;
mod rotation;
mod series;
mod sky;
mod sun_table;

use nalgebra::{Matrix3, Vector3};
use std::sync::Arc;

pub use epoch::Epoch;
pub use error::EarthError;
pub use geodetic::{Ellipsoid, Geodetic, WGS84};
pub use kernel::{Kernel, KernelSegment};
use orientation::Orientation;
pub use parameters::{EarthParameterRow, EarthParameters};
use sky::Sky;

/// Rate of the Earth's rotation, rad/s.
///
/// Source: IERS Conventions (2010), Technical Note 36, equation 5.15: `2π 1.002 737 811 911 354 48` a day of UT1.
pub const ROTATION_RATE: f64 = 7.292_115_146_706_979e-5;

/// Inertial axes that an orbit is given in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Axes {
    /// Geocentric celestial reference frame; for other planets any axes that do not turn.
    #[default]
    Gcrf,
    /// True equator, mean equinox of date: SGP4's; a third of a degree from GCRF in 2024, and growing.
    Teme,
}

impl Axes {
    /// `GCRF` or `TEME`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Gcrf => "GCRF",
            Self::Teme => "TEME",
        }
    }
}

/// The turning Earth during a run; every answer depends on the time alone.
#[derive(Clone, Debug, PartialEq)]
pub struct Earth {
    turning: Turning,
    sky: Option<Sky>,
}

#[derive(Clone, Debug, PartialEq)]
enum Turning {
    /// Evenly about z of `I`, whose axes matter to the sky.
    AboutZ { angle: f64, rate: f64, inertial: Option<Box<Orientation>> },
    /// As the IERS has it.
    Iau2006(Box<Orientation>),
}

impl Earth {
    /// An Earth that turns evenly about z of `I`: by `angle`, rad, at the start of the run, at `rate`, rad/s.
    pub fn about_z(angle: f64, rate: f64) -> Self {
        Self { turning: Turning::AboutZ { angle, rate, inertial: None }, sky: None }
    }

    /// The Earth of IAU 2006 and 2000A from `epoch` on, in GCRF axes: its pole to 2 mas (6 cm on the ground).
    ///
    /// # Errors
    /// [`EarthError::Parameter`] and its kin for parameters that cannot be true, [`EarthError::OutsideSpan`] where
    /// their table does not hold the epoch.
    pub fn new(epoch: Epoch, parameters: &EarthParameters) -> Result<Self, EarthError> {
        let orientation = Orientation::new(epoch, Axes::Gcrf, parameters, years(epoch))?;
        let earth =
            Self { turning: Turning::Iau2006(Box::new(orientation)), sky: Some(Sky::new(epoch, None)) };
        earth.covers(0.0)?;
        Ok(earth)
    }

    /// The same Earth with time zero at `epoch`: one that turns about z gets a Sun and a Moon, in GCRF axes.
    pub fn with_epoch(mut self, epoch: Epoch) -> Self {
        if let Turning::AboutZ { inertial, .. } = &mut self.turning {
            *inertial = Some(Box::new(Orientation::of_axes(epoch, years(epoch))));
        }
        Self { sky: Some(Sky::new(epoch, None)), ..self }
    }

    /// The same Earth with Sun and Moon as a kernel has them.
    ///
    /// # Errors
    /// [`EarthError::NeedsEpoch`]; [`EarthError::OutsideSpan`] where the kernel does not hold it, with eight days at least.
    pub fn with_kernel(self, kernel: Kernel) -> Result<Self, EarthError> {
        let what = "a kernel of Sun and Moon";
        let epoch = self.epoch().ok_or(EarthError::NeedsEpoch { what })?;
        let sky = Sky::new(epoch, Some(Arc::new(kernel)));
        within(what, 0.0, epoch, sky.span)?;
        Ok(Self { sky: Some(sky), ..self })
    }

    /// The same Earth seen in other axes.
    pub fn in_axes(&self, axes: Axes) -> Self {
        let turning = match &self.turning {
            Turning::AboutZ { angle, rate, inertial } => {
                let inertial = inertial.as_ref().map(|inertial| Box::new(inertial.in_axes(axes)));
                Turning::AboutZ { angle: *angle, rate: *rate, inertial }
            }
            Turning::Iau2006(orientation) => Turning::Iau2006(Box::new(orientation.in_axes(axes))),
        };
        Self { turning, sky: self.sky.as_ref().map(Sky::anew) }
    }

    /// Axes of `I`; none for an Earth that turns about z without an epoch, whatever they are.
    pub fn axes(&self) -> Option<Axes> {
        match &self.turning {
            Turning::AboutZ { inertial, .. } => inertial.as_ref().map(|inertial| inertial.axes()),
            Turning::Iau2006(orientation) => Some(orientation.axes()),
        }
    }

    /// Time zero of the run.
    pub fn epoch(&self) -> Option<Epoch> {
        self.sky.as_ref().map(|sky| sky.epoch)
    }

    /// Whether all that turns the Earth is known at `t` seconds of simulation; asked once before a run.
    ///
    /// # Errors
    /// [`EarthError::OutsideSpan`] outside of the table of parameters, or of the years 1900 to 2100.
    pub fn covers(&self, t: f64) -> Result<(), EarthError> {
        if !t.is_finite() {
            return Err(EarthError::NotFinite { name: "time", value: t });
        }
        let Some(epoch) = self.epoch() else { return Ok(()) };
        let table = match &self.turning {
            Turning::AboutZ { .. } => None,
            Turning::Iau2006(orientation) => orientation.parameters().span(),
        };
        within("the years of the series", t, epoch, years(epoch))?;
        table.map_or(Ok(()), |span| within("the Earth-orientation table", t, epoch, span))
    }

    /// Whether an orbit in `axes`, whose time zero is `epoch`, is one around this Earth.
    ///
    /// # Errors
    /// [`EarthError::OtherAxes`], and [`EarthError::OtherEpoch`] for epochs more than a millisecond apart.
    pub fn fits(&self, axes: Axes, epoch: Option<Epoch>) -> Result<(), EarthError> {
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

    /// Takes `I` components to `F` components, at `t` seconds of simulation.
    ///
    /// Where the Earth does not [cover](Self::covers) `t`, parameters and pole are those of the nearest time it does.
    pub fn rot_fi(&self, t: f64) -> Matrix3<f64> {
        match &self.turning {
            Turning::AboutZ { angle, rate, .. } => rotation::r3(angle + rate * t),
            Turning::Iau2006(orientation) => orientation.rot_fi(t),
        }
    }

    /// Angular velocity of `F` in `I`, axes of `I`, rad/s.
    pub fn angular_velocity(&self, t: f64) -> Vector3<f64> {
        match &self.turning {
            Turning::AboutZ { rate, .. } => Vector3::z() * *rate,
            Turning::Iau2006(orientation) => orientation.angular_velocity(t),
        }
    }

    /// Position of the Sun's centre from the Earth's, axes of `I`, m: where it is at `t`, without light time.
    ///
    /// Within 2″ and 4e-6 of its distance of JPL's DE421, 1900 to 2050, where no kernel is given.
    ///
    /// # Errors
    /// [`EarthError::NeedsEpoch`]; [`EarthError::OutsideSpan`] outside of 1900 to 2100.
    pub fn sun(&self, t: f64) -> Result<Vector3<f64>, EarthError> {
        let sky = self.sky_at("the Sun", t)?;
        Ok(sky.sun(t, |t| self.rot_ig(t)))
    }

    /// Position of the Moon's centre from the Earth's, axes of `I`, m; likewise.
    ///
    /// Within 10″ and 3e-5 of its distance of JPL's DE421, 1900 to 2050, where no kernel is given.
    ///
    /// # Errors
    /// As [`Earth::sun`].
    pub fn moon(&self, t: f64) -> Result<Vector3<f64>, EarthError> {
        let sky = self.sky_at("the Moon", t)?;
        Ok(sky.moon(t, |t| self.rot_ig(t)))
    }

    /// Modified Julian date of UTC, and seconds since its midnight; with the leap seconds of the epoch.
    ///
    /// # Errors
    /// [`EarthError::NeedsEpoch`].
    pub fn utc(&self, t: f64) -> Result<(i64, f64), EarthError> {
        self.sky.as_ref().map(|sky| sky.utc(t)).ok_or(EarthError::NeedsEpoch { what: "UTC" })
    }

    fn sky_at(&self, what: &'static str, t: f64) -> Result<&Sky, EarthError> {
        let sky = self.sky.as_ref().ok_or(EarthError::NeedsEpoch { what })?;
        within(what, t, sky.epoch, sky.span).map(|()| sky)
    }

    /// Takes GCRF components to those of `I`.
    fn rot_ig(&self, t: f64) -> Matrix3<f64> {
        match &self.turning {
            Turning::AboutZ { inertial, .. } => {
                inertial.as_ref().map_or_else(Matrix3::identity, |inertial| inertial.rot_ig(t))
            }
            Turning::Iau2006(orientation) => orientation.rot_ig(t),
        }
    }
}

/// The years 1900 to 2100, s of simulation.
fn years(epoch: Epoch) -> (f64, f64) {
    let since = epoch.since(Epoch::default());
    (-36_525.0 * epoch::DAY - since, 36_525.0 * epoch::DAY - since)
}

/// Refuses an instant outside of what is known.
fn within(what: &'static str, t: f64, epoch: Epoch, (from, to): (f64, f64)) -> Result<(), EarthError> {
    if (from..=to).contains(&t) {
        return Ok(());
    }
    let text = |t| epoch.after(t).to_string();
    let (from, to, epoch) = (text(from), text(to), epoch.to_string());
    Err(EarthError::OutsideSpan { what, time: t, epoch, from, to })
}
