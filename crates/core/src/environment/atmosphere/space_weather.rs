//! What the Sun does to the upper air.

use super::{AtmosphereError, SpaceWeatherTable};

/// Geomagnetic activity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MagneticActivity {
    /// Mean `Ap` of the day.
    Daily(f64),
    /// `Ap` of the day; `ap` of the three hours now, of those 3, 6 and 9 h ago; means of 12 to 33 h and of 36 to 57 h
    /// ago.
    History([f64; 7]),
}

/// Indices of one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpaceIndices {
    /// Solar flux at 10.7 cm of the previous day, 1e-22 W/(m² Hz).
    pub f107: f64,
    /// Its mean over 81 days about the day.
    pub f107a: f64,
    /// Geomagnetic activity.
    pub activity: MagneticActivity,
}

impl SpaceIndices {
    /// These indices, checked.
    ///
    /// # Errors
    /// [`AtmosphereError::Value`] for a flux that is not between 0 and 999.9, or an `Ap` outside of 0 to 400.
    pub fn new(f107: f64, f107a: f64, activity: MagneticActivity) -> Result<Self, AtmosphereError> {
        for (name, value) in [("f107", f107), ("f107a", f107a)] {
            if !is_flux(value) {
                return Err(AtmosphereError::Value { name, value, expected: FLUX });
            }
        }
        let indices: &[f64] = match &activity {
            MagneticActivity::Daily(ap) => std::slice::from_ref(ap),
            MagneticActivity::History(ap) => ap,
        };
        match indices.iter().find(|ap| !is_activity(**ap)) {
            None => Ok(Self { f107, f107a, activity }),
            Some(&value) => Err(AtmosphereError::Value { name: "ap", value, expected: ACTIVITY }),
        }
    }
}

pub(super) const FLUX: &str = "a flux above 0 and below 999.9 (which marks a gap), 1e-22 W/(m² Hz)";
pub(super) const ACTIVITY: &str = "an index from 0 to 400 (Ap, not Kp)";

/// The Sun has never been seen above 500 over a day.
pub(super) fn is_flux(value: f64) -> bool {
    value > 0.0 && value < 999.9
}

pub(super) fn is_activity(value: f64) -> bool {
    (0.0..=400.0).contains(&value)
}

/// Indices for a whole run.
#[derive(Clone, Debug, PartialEq)]
pub enum SpaceWeather {
    /// The same all the time.
    Constant(SpaceIndices),
    /// Day by day.
    Table(SpaceWeatherTable),
}
