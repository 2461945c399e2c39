//! The Earth as the inertial axes see it: how it turns.
//!
//! `I` has inertial axes, `F` is fixed in the turning Earth (ITRF, or a stand-in for it).

use nalgebra::{Matrix3, Vector3};

/// Rate of the Earth's rotation, rad/s.
///
/// Source: IERS Conventions (2010), Technical Note 36, equation 5.15: `2π 1.002 737 811 911 354 48` a day of UT1.
pub const ROTATION_RATE: f64 = 7.292_115_146_706_979e-5;

/// The turning Earth during a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Earth {
    angle: f64,
    rate: f64,
}

impl Earth {
    /// An Earth that turns evenly about z of `I`: by `angle`, rad, at the start of the run, at `rate`, rad/s.
    pub fn about_z(angle: f64, rate: f64) -> Self {
        Self { angle, rate }
    }

    /// Takes `I` components to `F` components, at `t` seconds of simulation.
    pub fn rot_fi(&self, t: f64) -> Matrix3<f64> {
        let (s, c) = (self.angle + self.rate * t).sin_cos();
        Matrix3::new(c, s, 0.0, -s, c, 0.0, 0.0, 0.0, 1.0)
    }

    /// Angular velocity of `F` in `I`, axes of `I`, rad/s.
    pub fn angular_velocity(&self, _t: f64) -> Vector3<f64> {
        Vector3::z() * self.rate
    }
}

/// TEMPORARY
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum EarthError {
    /// TEMPORARY
    #[error("{what} needs an epoch")]
    NeedsEpoch {
        /// x
        what: &'static str,
    },
}
/// x
pub struct Ellipsoid;
/// x
pub const WGS84: Ellipsoid = Ellipsoid;

/// TEMPORARY
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Geodetic {
    /// x
    pub latitude: f64,
    /// x
    pub longitude: f64,
    /// x
    pub altitude: f64,
}

impl Geodetic {
    /// TEMPORARY
    pub fn of(r: &Vector3<f64>, _: &Ellipsoid) -> Result<Self, EarthError> {
        let (a, f) = (6_378_137.0, 1.0 / 298.257_223_563);
        let e2 = f * (2.0 - f);
        let p = r.x.hypot(r.y);
        let mut lat = r.z.atan2(p * (1.0 - e2));
        for _ in 0..6 {
            let n: f64 = a / (1.0 - e2 * lat.sin().powi(2)).sqrt();
            lat = (r.z + e2 * n * lat.sin()).atan2(p);
        }
        let n: f64 = a / (1.0 - e2 * lat.sin().powi(2)).sqrt();
        let altitude = p * lat.cos() + r.z * lat.sin() - a * a / n;
        Ok(Self { latitude: lat, longitude: r.y.atan2(r.x), altitude })
    }
    /// TEMPORARY
    pub fn position(&self, _: &Ellipsoid) -> Vector3<f64> {
        let (a, f) = (6_378_137.0, 1.0 / 298.257_223_563);
        let e2 = f * (2.0 - f);
        let (s, c) = self.latitude.sin_cos();
        let n: f64 = a / (1.0_f64 - e2 * s * s).sqrt();
        let h = self.altitude;
        Vector3::new((n + h) * c * self.longitude.cos(), (n + h) * c * self.longitude.sin(), (n * (1.0 - e2) + h) * s)
    }
}

impl Earth {
    /// TEMPORARY
    pub fn sun(&self, _t: f64) -> Result<Vector3<f64>, EarthError> {
        Err(EarthError::NeedsEpoch { what: "the Sun" })
    }
    /// TEMPORARY
    pub fn utc(&self, _t: f64) -> Result<(i64, f64), EarthError> {
        Err(EarthError::NeedsEpoch { what: "UTC" })
    }
}
