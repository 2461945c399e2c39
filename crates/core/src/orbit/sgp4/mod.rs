//! Orbits of published element sets by SGP4, improved mode.
//!
//! Source of the theory: Vallado, Crawford, Hujsak and Kelso, Revisiting Spacetrack Report #3,
//! AIAA 2006-6753. The `sgp4` crate evaluates it; what it leaves to its user is here: Earth models of the
//! reference code, its error numbers 2 and 6, and an acceleration.

mod elements;
mod epoch;
mod error;
mod tle;

use nalgebra::Vector3;
use sgp4::{Constants, Geopotential, MinutesSinceEpoch};
use std::f64::consts::PI;

use super::error::finite;
use super::{Axes, Orbit, OrbitError, OrbitState};
pub use elements::MeanElements;
pub use epoch::Epoch;
pub use error::{ElementSetError, Sgp4Error};

/// Earth model of an element set; published sets are fitted with [`EarthModel::Wgs72`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum EarthModel {
    /// WGS-72 with the rounded constants of Spacetrack Report #3.
    Wgs72Old,
    /// WGS-72.
    #[default]
    Wgs72,
    /// WGS-84.
    Wgs84,
}

impl EarthModel {
    /// Every model with its name.
    pub const ALL: [(&'static str, Self); 3] =
        [("wgs72old", Self::Wgs72Old), ("wgs72", Self::Wgs72), ("wgs84", Self::Wgs84)];

    /// Gravitational parameter, m³/s².
    pub fn mu(self) -> f64 {
        match self {
            Self::Wgs72Old => 3.986_007_996_4e14,
            Self::Wgs72 => 3.986_008e14,
            Self::Wgs84 => 3.986_005e14,
        }
    }

    /// Constants of AIAA 2006-6753; `kₑ = 60 √(μ/aₑ³)` in Earth radii and minutes.
    fn geopotential(self) -> Geopotential {
        let ke = |g: Geopotential| 60.0 * (self.mu() * 1e-9 / g.ae.powi(3)).sqrt();
        match self {
            Self::Wgs72Old => Geopotential { ke: 0.074_366_916_1, ..sgp4::WGS72 },
            Self::Wgs72 => Geopotential { ke: ke(sgp4::WGS72), ..sgp4::WGS72 },
            Self::Wgs84 => Geopotential { ke: ke(sgp4::WGS84), ..sgp4::WGS84 },
        }
    }
}

/// Furthest from the epoch, s: a hundred years, when the elements mean nothing any more.
const LONGEST_TIME: f64 = 100.0 * 365.25 * 86_400.0;

/// Step of the differences that give the acceleration, s.
const STEP: f64 = 30.0;

/// Weights of the central sixth-order second difference, times 180.
const WEIGHTS: [f64; 4] = [-490.0, 270.0, -27.0, 2.0];

/// The orbit of an element set; simulation time zero is its epoch, axes are TEME.
///
/// Position and velocity are SGP4's own, as published. Its velocity is not exactly the derivative of its
/// position (2 cm/s on circular low orbits, 1 m/s at eccentricity 0.19). The acceleration is the second derivative of the *position*, by
/// sixth-order central differences over ±90 s: good to 1e-7 m/s².
#[derive(Clone, Debug)]
pub struct Sgp4 {
    elements: MeanElements,
    model: EarthModel,
    geopotential: Geopotential,
    constants: Constants,
}

impl Sgp4 {
    /// Prepares an element set.
    ///
    /// # Errors
    /// [`Sgp4Error::MeanMotion`] when the elements' mean motion comes out negative.
    pub fn new(elements: MeanElements, model: EarthModel) -> Result<Self, OrbitError> {
        let geopotential = model.geopotential();
        let mean = brouwer(&elements, &geopotential)?;
        let constants = Constants::new(
            geopotential,
            sgp4::iau_epoch_to_sidereal_time,
            elements.epoch.julian_years(),
            elements.drag_term,
            mean,
        )
        .map_err(|error| Sgp4Error::MeanEccentricity { time: 0.0, eccentricity: error.0 })?;
        Ok(Self { elements, model, geopotential, constants })
    }

    /// The element set.
    pub fn elements(&self) -> &MeanElements {
        &self.elements
    }

    /// Earth model in use.
    pub fn earth_model(&self) -> EarthModel {
        self.model
    }

    /// Period of the mean motion, s.
    pub fn period(&self) -> f64 {
        86_400.0 / self.elements.mean_motion_rev_day
    }

    /// SGP4's position (m) and velocity (m/s) at `t`, below the surface too.
    fn propagate(&self, t: f64) -> Result<(Vector3<f64>, Vector3<f64>), Sgp4Error> {
        let at = self.constants.propagate(MinutesSinceEpoch(t / 60.0)).map_err(|error| match error {
            sgp4::Error::OutOfRangeEccentricity { eccentricity, .. } => {
                Sgp4Error::MeanEccentricity { time: t, eccentricity }
            }
            sgp4::Error::OutOfRangePerturbedEccentricity { eccentricity, .. } => {
                Sgp4Error::PerturbedEccentricity { time: t, eccentricity }
            }
            sgp4::Error::NegativeSemiLatusRectum { .. } => Sgp4Error::SemiLatusRectum { time: t },
        })?;
        let (r, v) = (Vector3::from(at.position) * 1e3, Vector3::from(at.velocity) * 1e3);
        if r.iter().chain(v.iter()).all(|x| x.is_finite()) {
            Ok((r, v))
        } else {
            // the one way to no number: a power of a mean motion that is not positive
            Err(Sgp4Error::MeanMotion { time: t, mean_motion: f64::NAN })
        }
    }

    /// Second derivative of the position over steps of `h`, m/s².
    fn acceleration(&self, t: f64, r: &Vector3<f64>, h: f64) -> Result<Vector3<f64>, Sgp4Error> {
        // r̈ ≈ Σ wₖ (r(t + k h) + r(t - k h))/(180 h²)
        let mut sum = r * WEIGHTS[0];
        for (k, weight) in WEIGHTS.iter().enumerate().skip(1) {
            let away = k as f64 * h;
            sum += (self.propagate(t + away)?.0 + self.propagate(t - away)?.0) * *weight;
        }
        Ok(sum / (180.0 * h * h))
    }
}

/// Brouwer's mean motion in place of Kozai's; operation by operation as the reference code, since its last digit
/// tells after two thousand revolutions.
///
/// `n = n₀/(1 + δ₀)`, `δ₀ = d/a₀²`, `a₀ = a₁ (1 - δ₁² - δ₁ (1/3 + 134 δ₁²/81))`, `δ₁ = d/a₁²`,
/// `a₁ = (kₑ/n₀)^{2/3}`, `d = ¾ J₂ (3 cos²i - 1)/(1 - e²)^{3/2}`.
fn brouwer(elements: &MeanElements, model: &Geopotential) -> Result<sgp4::Orbit, Sgp4Error> {
    let (inclination, eccentricity) = (elements.inclination_deg.to_radians(), elements.eccentricity);
    let n = elements.mean_motion_rev_day / (1440.0 / (2.0 * PI)); // rad/min
    let (cos, p) = (inclination.cos(), 1.0 - eccentricity * eccentricity);
    let a1 = (model.ke / n).powf(2.0 / 3.0);
    let d = 0.75 * model.j2 * (3.0 * (cos * cos) - 1.0) / (p.sqrt() * p);
    let d1 = d / (a1 * a1);
    let a0 = a1 * (1.0 - d1 * d1 - d1 * (1.0 / 3.0 + 134.0 * d1 * d1 / 81.0));
    let mean_motion = n / (1.0 + d / (a0 * a0));
    if mean_motion > 0.0 {
        Ok(sgp4::Orbit {
            inclination,
            right_ascension: elements.raan_deg.to_radians(),
            eccentricity,
            argument_of_perigee: elements.argument_of_perigee_deg.to_radians(),
            mean_anomaly: elements.mean_anomaly_deg.to_radians(),
            mean_motion,
        })
    } else {
        Err(Sgp4Error::MeanMotion { time: 0.0, mean_motion: mean_motion * (720.0 / PI) })
    }
}

impl Orbit for Sgp4 {
    fn mu(&self) -> Option<f64> {
        Some(self.model.mu())
    }

    fn axes(&self) -> Axes {
        Axes::Teme
    }

    fn velocity_source(&self) -> &'static str {
        "SGP4's own velocity (not exactly the derivative of its position)"
    }

    /// # Errors
    /// [`OrbitError::Sgp4`], and [`OrbitError::TimeOutOfRange`] a hundred years from the epoch.
    fn state(&self, t: f64) -> Result<OrbitState, OrbitError> {
        if finite("time", t)?.abs() > LONGEST_TIME {
            return Err(OrbitError::TimeOutOfRange { time: t, epoch: 0.0, limit: LONGEST_TIME });
        }
        let (position, velocity) = self.propagate(t)?;
        let (distance, radius) = (position.norm(), self.geopotential.ae * 1e3);
        if distance < radius {
            return Err(Sgp4Error::Decayed { time: t, distance, radius }.into());
        }
        // where the elements fail within 90 s, a shorter reach will do
        let acceleration = self
            .acceleration(t, &position, STEP)
            .or_else(|_| self.acceleration(t, &position, STEP / 16.0))?;
        Ok(OrbitState { position, velocity, acceleration })
    }
}
