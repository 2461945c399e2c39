//! Position and instant at which an atmosphere model is evaluated.

use super::error::AtmosphereError;
use crate::earth::{Earth, Geodetic, WGS84};
use nalgebra::Vector3;
use std::f64::consts::FRAC_PI_2;

/// Point outside the Earth at one instant.
#[derive(Clone, Copy, Debug)]
pub struct AtmospherePoint<'a> {
    /// Earth, which defines the rotation between inertial and Earth-fixed axes.
    pub earth: &'a Earth,
    /// Simulation time, s.
    pub time: f64,
    /// Latitude, longitude (rad) and altitude (m) on WGS84.
    pub geodetic: Geodetic,
    /// Position from the Earth's centre, axes of `I`, m.
    pub position: Vector3<f64>,
    /// Upward unit normal of the ellipsoid, axes of `I`.
    pub up: Vector3<f64>,
}

impl<'a> AtmospherePoint<'a> {
    /// Creates the point at `position` (from the Earth's centre, axes of `I`, m) and at simulation time
    /// `time`, s.
    ///
    /// # Errors
    /// [`AtmosphereError::BelowSurface`] for a position inside the Earth; [`AtmosphereError::Earth`] if the
    /// geodetic coordinates of the position are undefined.
    pub fn new(earth: &'a Earth, time: f64, position: &Vector3<f64>) -> Result<Self, AtmosphereError> {
        let rot_fi = earth.rot_fi(time);
        let geodetic = Geodetic::of(&(rot_fi * position), &WGS84)?;
        Self { earth, time, geodetic, position: *position, up: rot_fi.tr_mul(&up(&geodetic)) }.above_surface()
    }

    /// Computes the point with the given geodetic coordinates at simulation time `time`, s.
    ///
    /// # Errors
    /// [`AtmosphereError::BelowSurface`] for a negative altitude; [`AtmosphereError::Value`] for a latitude
    /// outside ±π/2.
    pub fn at(earth: &'a Earth, time: f64, geodetic: Geodetic) -> Result<Self, AtmosphereError> {
        let value = geodetic.latitude;
        if !(-FRAC_PI_2..=FRAC_PI_2).contains(&value) {
            let expected = "an angle from -π/2 to π/2 rad (45° is 0.785)";
            return Err(AtmosphereError::Value { name: "latitude", value, expected });
        }
        let rot_fi = earth.rot_fi(time);
        let (position, up) = (rot_fi.tr_mul(&geodetic.position(&WGS84)), rot_fi.tr_mul(&up(&geodetic)));
        Self { earth, time, geodetic, position, up }.above_surface()
    }

    /// Returns the point `height` m above this point.
    pub(super) fn raised(&self, height: f64) -> Self {
        let geodetic = Geodetic { altitude: self.geodetic.altitude + height, ..self.geodetic };
        Self { geodetic, position: self.position + self.up * height, ..*self }
    }

    fn above_surface(self) -> Result<Self, AtmosphereError> {
        let altitude = self.geodetic.altitude;
        if altitude >= 0.0 { Ok(self) } else { Err(AtmosphereError::BelowSurface { altitude }) }
    }
}

/// Returns the upward unit normal of the ellipsoid in Earth-fixed axes `F`.
fn up(geodetic: &Geodetic) -> Vector3<f64> {
    let ((slat, clat), (slon, clon)) = (geodetic.latitude.sin_cos(), geodetic.longitude.sin_cos());
    // (cos φ cos λ, cos φ sin λ, sin φ)
    Vector3::new(clat * clon, clat * slon, slat)
}
